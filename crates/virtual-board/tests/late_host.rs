//! `virtual-board --fast`: delays of a host in real time do not delay it in the board's time.
#![cfg(unix)]

use crate::support::link::device::on_the_line;
use crate::support::{self, CLOCK_HZ, MS, build};
use carrystep_core::link::Uart;
use carrystep_link::Line as _;
use carrystep_link::line::serial::SerialLine;
use carrystep_link::registers::{CONTROL, END, OPEN, POSITION, SEGMENT, START, WRITE};
use carrystep_link::{Answer, frame};
use carrystep_virtual_board::{KEPT, ModelBoard, Pace, RealTimeBoard, SimulatedBoard, Terminal};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Number of segments of 600 ticks of 2 us: 1.2 ms and 150 steps each.
const SEGMENTS: u32 = 200;
const WORDS: [u32; 6] = [599, 0, 0x4000_0000, 0, 0, 0];
const STEPS: i32 = 150;
const SESSION: [u8; 2] = [0x2b, 0x1a];

/// A host that sends one request at a time, and waits for `delay` before each.
struct LateHost {
    line: SerialLine,
    next: u8,
    delay: Duration,
}

impl LateHost {
    fn ask(&mut self, content: &[u8]) -> Answer {
        let (mut out, mut came) = (on_the_line(content), Vec::new());
        let begin = Instant::now();
        while begin.elapsed() < Duration::from_secs(20) {
            let mut into = [0; 64];
            let done = self.line.exchange(&out, &mut into).unwrap();
            out.drain(..done.sent);
            for &byte in &into[..done.received] {
                match byte {
                    END if came.is_empty() => {}
                    END => return Answer::from_bytes(&support::unescaped(&came)).unwrap(),
                    byte => came.push(byte),
                }
            }
        }
        panic!("no answer to {content:02x?}")
    }

    fn write(&mut self, address: u8, words: &[u32]) -> Answer {
        let head = [self.next, WRITE | address, SESSION[0], SESSION[1]];
        let content: Vec<u8> =
            head.into_iter().chain(words.iter().flat_map(|word| word.to_le_bytes())).collect();
        self.next = self.next.wrapping_add(1);
        let answer = self.ask(&content);
        assert_eq!((answer.next, answer.fault), (self.next, false), "{answer:?}");
        answer
    }

    /// Reads the state as the owner.
    fn look(&mut self) -> Answer {
        self.ask(&[0, POSITION, SESSION[0], SESSION[1]])
    }

    fn segment(&mut self, number: u32) {
        let last = u32::from(number + 1 == SEGMENTS);
        self.write(frame::of_axis(SEGMENT, 0), &[&WORDS[..], &[0, last]].concat());
    }

    /// Sends one segment for each read of the queue, like a host that has other work to do.
    fn run(&mut self) -> Answer {
        self.ask(&[&[0, WRITE | OPEN], &SESSION[..], &[0; 4]].concat());
        self.write(CONTROL, &[1]);
        while !self.look().ready {}
        let mut sent = 7;
        (0..sent).for_each(|number| self.segment(number));
        self.write(START, &[1]);
        loop {
            std::thread::sleep(self.delay);
            let answer = self.look();
            assert!(!answer.fault, "segment {sent}: {answer:?}");
            if answer.idle {
                assert_eq!(sent, SEGMENTS);
                return answer;
            }
            if sent < SEGMENTS && answer.free > 0 {
                self.segment(sent);
                sent += 1;
            }
        }
    }
}

#[test]
fn host_delayed_in_real_time_is_never_late_for_a_fast_board() {
    let uart = Uart::new(CLOCK_HZ, 3_000_000).unwrap();
    let terminal = Terminal::new().unwrap();
    let port = terminal.name().to_owned();
    let is_over = AtomicBool::new(false);
    std::thread::scope(|scope| {
        let board = scope.spawn(|| {
            let mut real_time = RealTimeBoard::new(
                ModelBoard::new(&build(), uart),
                terminal,
                Pace::fast(CLOCK_HZ, 25 * MS),
                CLOCK_HZ,
            );
            let mut least = usize::MAX;
            while !is_over.load(Ordering::Relaxed) {
                real_time.step(&mut ()).unwrap();
                let waits = support::Kind::least_waiting(&real_time.board)
                    .filter(|_| real_time.board.alone().is_some());
                least = least.min(waits.unwrap_or(usize::MAX));
            }
            least
        });
        let _over = Over(&is_over);
        let mut host = LateHost {
            line: SerialLine::open(&port, 3_000_000).unwrap(),
            next: 0,
            delay: Duration::from_millis(30),
        };
        assert_eq!(host.run().data.cast_signed(), STEPS * SEGMENTS as i32);
        drop(_over);
        // The transmission itself may use up one of the kept segments.
        let least = board.join().unwrap();
        assert!((KEPT - 1..=KEPT).contains(&least), "{least} segments waited");
    });
}

/// Sets the flag when it is dropped.
struct Over<'a>(&'a AtomicBool);

impl Drop for Over<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}
