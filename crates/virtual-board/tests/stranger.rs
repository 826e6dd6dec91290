//! A host written from docs/protocol.md alone; it shares no code with `crates/link`. It streams
//! moves of all axes with segments of different lengths over a line that loses answers, observes
//! the credits of the page, and lands exactly.

use carrystep_core::link::Uart;
use carrystep_core::{AXES, Build, EngineBuild, PinTiming, StartPhase, Timebase};
use carrystep_virtual_board::ModelBoard;
use std::collections::VecDeque;

const CLOCK_HZ: u64 = 48_000_000;
const MS: u64 = CLOCK_HZ / 1000;
/// "A random number."
const SESSION: [u8; 2] = [0x34, 0xdb];
const STEP: u64 = CLOCK_HZ / 10_000;

/// "The CRC-32 of Ethernet, zip and zlib."
fn crc(bytes: &[u8]) -> u32 {
    let step = |crc: u32| if crc & 1 == 1 { crc >> 1 ^ 0xedb8_8320 } else { crc >> 1 };
    !bytes.iter().fold(!0, |crc, &byte| (0..8).fold(crc ^ u32::from(byte), |crc, _| step(crc)))
}

/// "A frame ends with END. Inside a frame END is sent as DB DC and DB as DB DD. Send an END before
/// a frame too."
fn on_the_line(content: &[u8]) -> Vec<u8> {
    let mut line = vec![0xc0];
    for byte in content.iter().copied().chain(crc(content).to_le_bytes()) {
        match byte {
            0xc0 => line.extend([0xdb, 0xdc]),
            0xdb => line.extend([0xdb, 0xdd]),
            _ => line.push(byte),
        }
    }
    line.push(0xc0);
    line
}

/// "The answer."
#[derive(Debug, Clone, Copy)]
struct Answer {
    address: u8,
    next: u8,
    fault: bool,
    idle: bool,
    ready: bool,
    cause: u8,
    free: usize,
    refused: bool,
    written: bool,
    data: u32,
}

impl Answer {
    fn of(line: &[u8]) -> Option<Self> {
        let mut frame = Vec::new();
        let mut bytes = line.iter();
        while let Some(&byte) = bytes.next() {
            frame.push(match byte {
                0xdb => match bytes.next()? {
                    0xdc => 0xc0,
                    0xdd => 0xdb,
                    _ => return None,
                },
                _ => byte,
            });
        }
        let word = |at: usize| Some(u32::from_le_bytes(frame.get(at..at + 4)?.try_into().ok()?));
        if frame.len() != 16 || word(12)? != crc(&frame[..12]) {
            return None;
        }
        Some(Self {
            address: frame[1],
            next: frame[2],
            fault: frame[3] & 1 != 0,
            idle: frame[3] & 0x40 != 0,
            ready: frame[3] & 2 != 0,
            cause: frame[7] & 15,
            free: usize::from(frame[4]),
            written: frame[3] & 8 != 0,
            refused: frame[7] >> 4 != 0,
            data: word(8)?,
        })
    }
}

/// How the host counts the free queue places of an axis.
#[derive(Clone, Copy, PartialEq)]
enum Credits {
    /// As the page describes it.
    Page,
    /// The last `free` minus the segments unacknowledged now: the mistake that the page warns of.
    OnItsWayNow,
}

/// An unacknowledged write, and the axis of its segment.
struct Written {
    number: u8,
    axis: Option<usize>,
    line: Vec<u8>,
}

struct Stranger {
    board: ModelBoard,
    came: Vec<u8>,
    answers: u64,
    /// Number of answers lost per hundred.
    lost: u64,
    is_open: bool,
    random: u64,
    next: u8,
    under_way: VecDeque<Written>,
    credits: Credits,
    /// For each axis: `free` of its last answer, and the segments that this answer did not count.
    room: [(usize, usize); AXES],
    progress: u64,
    asked: Option<u64>,
    last: Option<Answer>,
    positions: [i32; AXES],
}

impl Stranger {
    fn new(lost: u64, credits: Credits) -> Self {
        let timebase = Timebase::new(CLOCK_HZ, 2000, 16).unwrap();
        let build = Build { timebase, phase: StartPhase::Half, pins: [PinTiming::SHORTEST; AXES] };
        let mut build = EngineBuild::minimal(&build, 1 << 45);
        build.guard.round = 1024;
        build.guard.watchdog = 49;
        Self {
            board: ModelBoard::new(&build, Uart::new(CLOCK_HZ, 3_000_000).unwrap()),
            came: Vec::new(),
            answers: 0,
            lost,
            is_open: false,
            random: 0x1234_5678_9abc_def1,
            next: 0,
            under_way: VecDeque::new(),
            credits,
            room: [(0, 0); AXES],
            progress: 0,
            asked: None,
            last: None,
            positions: [0; AXES],
        }
    }

    fn random(&mut self, below: u64) -> u64 {
        self.random ^= self.random << 13;
        self.random ^= self.random >> 7;
        self.random ^= self.random << 17;
        self.random % below
    }

    fn say(&mut self, line: &[u8]) {
        line.iter().for_each(|&byte| self.board.say(byte));
    }

    /// "At most eight reads without an answer": this host has one, and considers it lost after 2
    /// ms.
    fn read(&mut self, address: u8) {
        if self.asked.is_none_or(|asked| self.board.cycle() - asked > 2 * MS) {
            self.asked = Some(self.board.cycle());
            // Before OPEN a read without a session, then those of the owner, which feed the watchdog.
            let session = if self.is_open { &SESSION[..] } else { &[] };
            self.say(&on_the_line(&[&[0, address], session].concat()));
        }
    }

    fn write(&mut self, address: u8, words: &[u32], axis: Option<usize>) {
        let head = [self.next, address, SESSION[0], SESSION[1]];
        let content: Vec<u8> =
            head.into_iter().chain(words.iter().flat_map(|word| word.to_le_bytes())).collect();
        let line = on_the_line(&content);
        self.say(&line);
        if self.under_way.is_empty() {
            self.progress = self.board.cycle();
        }
        self.under_way.push_back(Written { number: self.next, axis, line });
        self.next = self.next.wrapping_add(1);
        if let Some(axis) = axis {
            self.room[axis].1 += 1;
        }
    }

    /// Number of segments that may be sent for an axis.
    fn may_send(&self, axis: usize) -> usize {
        let (free, uncounted) = self.room[axis];
        let under_way = self.under_way.iter().filter(|written| written.axis == Some(axis)).count();
        free.saturating_sub(if self.credits == Credits::Page { uncounted } else { under_way })
    }

    /// Advances by a tenth of a millisecond.
    fn pass(&mut self) {
        let end = self.board.cycle() + STEP;
        while self.board.cycle() < end {
            self.board.run(end, &mut ());
        }
        while let Some(byte) = self.board.next_byte() {
            if byte != 0xc0 {
                self.came.push(byte);
            } else if !self.came.is_empty() {
                let line = std::mem::take(&mut self.came);
                self.answers += 1;
                if self.random(100) >= self.lost {
                    self.hear(Answer::of(&line).expect("a frame"));
                }
            }
        }
        if !self.under_way.is_empty() && self.board.cycle() - self.progress > 40 * MS {
            self.again();
        }
    }

    /// "Send again from `next` on."
    fn again(&mut self) {
        self.progress = self.board.cycle();
        let lines: Vec<Vec<u8>> =
            self.under_way.iter().map(|written| written.line.clone()).collect();
        lines.iter().for_each(|line| self.say(line));
    }

    fn hear(&mut self, answer: Answer) {
        let executed = usize::from(
            answer.next.wrapping_sub(self.next.wrapping_sub(self.under_way.len() as u8)),
        );
        assert!(executed <= self.under_way.len(), "{answer:?}");
        self.under_way.drain(..executed);
        assert!(self.under_way.front().is_none_or(|written| written.number == answer.next));
        if executed > 0 {
            self.progress = self.board.cycle();
        }
        if !answer.written {
            self.asked = None;
        }
        let axis = usize::from(answer.address & 7);
        let least = if answer.written { 0xc0 } else { 0x18 };
        if answer.address >= least {
            let uncounted =
                self.under_way.iter().filter(|written| written.axis == Some(axis)).count();
            self.room[axis] = (answer.free, uncounted);
            if answer.written || answer.address & 0xf8 == 0x70 {
                self.positions[axis] = answer.data.cast_signed();
            }
        }
        assert!(!answer.refused, "no request is lost: {answer:?}, before: {:?}", self.last);
        self.last = Some(answer);
    }

    /// Advances, and reads the state from time to time, until the last answer satisfies `wish`.
    fn until(&mut self, wish: impl Fn(&Answer) -> bool) {
        for turn in 0_u32.. {
            if self.under_way.is_empty() && self.last.as_ref().is_some_and(&wish) {
                return;
            }
            if turn % 50 == 0 {
                self.read(0x70 + (turn / 50 % 6) as u8);
            }
            self.pass();
            assert!(turn < 200_000, "{:?}", self.last);
        }
    }
}

/// Random segments of one axis: ticks and V. All axes have the same total of ticks.
fn segments(stranger: &mut Stranger, axis: usize, ticks: u64) -> Vec<(u32, i64)> {
    let mut left = ticks;
    let mut segments = Vec::new();
    // Where answers are lost, the queues must last until they are repaired.
    let mean = (400 + 50 * stranger.lost) * (axis as u64 + 1);
    while left > 0 {
        let count = (mean / 2 + stranger.random(mean)).min(left);
        left -= count;
        let v = (1 << 58) + stranger.random(1 << 60) as i64;
        segments.push((count as u32, if axis.is_multiple_of(2) { v } else { -v }));
    }
    segments
}

/// Streams `moves` moves of `ticks` ticks. Returns the fault that ended them, if any, and the
/// number of segments.
fn streamed(lost: u64, credits: Credits, moves: usize, ticks: u64) -> (Option<u8>, usize) {
    let mut stranger = Stranger::new(lost, credits);
    for (address, wanted) in [(0, u32::from_le_bytes(*b"CSTP")), (1, 2), (4, AXES as u32)] {
        stranger.last = None;
        while stranger.last.is_none_or(|answer| answer.address != address) {
            stranger.read(address);
            (0..20).for_each(|_| stranger.pass());
        }
        assert_eq!(stranger.last.unwrap().data, wanted, "register {address:02x}");
    }
    // "OPEN has any sequence number and is not counted."
    stranger.last = None;
    while stranger.last.is_none_or(|answer| answer.address != 0xa5) {
        stranger.say(&on_the_line(&[0, 0xa5, SESSION[0], SESSION[1], 0, 0, 0, 0]));
        (0..20).for_each(|_| stranger.pass());
    }
    stranger.is_open = true;
    stranger.write(0xa0, &[1], None);
    stranger.until(|answer| answer.ready);
    let mut sums = [0_i128; AXES];
    let mut count = 0;
    for _ in 0..moves {
        let mut queues: Vec<VecDeque<(u32, i64)>> = Vec::new();
        for (axis, sum) in sums.iter_mut().enumerate() {
            let all = segments(&mut stranger, axis, ticks);
            *sum += all.iter().map(|&(ticks, v)| i128::from(ticks) * i128::from(v)).sum::<i128>();
            queues.push(all.into());
        }
        count += queues.iter().map(VecDeque::len).sum::<usize>();
        let mut sent = [0_u64; AXES];
        let mut started = false;
        while queues.iter().any(|queue| !queue.is_empty()) {
            // The axis whose sent segments last for the shortest time comes first.
            let able =
                (0..AXES).filter(|&axis| !queues[axis].is_empty() && stranger.may_send(axis) > 0);
            let axis =
                able.min_by_key(|&axis| sent[axis]).filter(|_| stranger.under_way.len() < 12);
            if let Some(axis) = axis {
                let (ticks, v) = queues[axis].pop_front().unwrap();
                sent[axis] += u64::from(ticks);
                let last = u32::from(queues[axis].is_empty());
                let words = [ticks - 1, v as u32, (v >> 32) as u32, 0, 0, 0, 0, last];
                stranger.write(0xc0 + axis as u8, &words, Some(axis));
                continue;
            }
            if !started && sent.iter().all(|&ticks| ticks > 0) {
                stranger.write(0xa1, &[0x3f], None);
                started = true;
            }
            // "An axis whose queue is full is asked by reading its POSITION."
            let full =
                (0..AXES).filter(|&axis| !queues[axis].is_empty() && stranger.may_send(axis) == 0);
            if let Some(axis) = full.min_by_key(|&axis| sent[axis]) {
                stranger.read(0x70 + axis as u8);
            }
            stranger.pass();
            if let Some(answer) = stranger.last.filter(|answer| answer.fault) {
                return (Some(answer.cause), count);
            }
        }
        stranger.until(|answer| answer.idle || answer.fault);
    }
    if let Some(answer) = stranger.last.filter(|answer| answer.fault) {
        return (Some(answer.cause), count);
    }
    // P starts at half a step: the position is the number of whole steps of that and of the sum of
    // V.
    for (axis, sum) in sums.into_iter().enumerate() {
        stranger.last = None;
        while stranger.last.is_none_or(|answer| answer.address != 0x70 + axis as u8) {
            stranger.read(0x70 + axis as u8);
            (0..20).for_each(|_| stranger.pass());
        }
        let steps = ((1_i128 << 63) + sum) >> 64;
        assert_eq!(i128::from(stranger.positions[axis]), steps, "axis {axis}");
        assert!(steps.abs() > 1000, "axis {axis}: {steps} steps");
    }
    (None, count)
}

#[test]
fn host_written_from_the_page_lands_exactly() {
    let (fault, count) = streamed(0, Credits::Page, 2, 180_000);
    assert_eq!(fault, None);
    assert!(count > 2000, "{count} segments");
}

/// A write whose answer was lost is acknowledged by an answer of another axis.
#[test]
fn lost_answers_do_not_overfill_a_queue() {
    let (fault, count) = streamed(10, Credits::Page, 1, 200_000);
    assert_eq!(fault, None);
    assert!(count > 500, "{count} segments");
}

#[test]
fn wrong_credits_overfill_a_queue() {
    let (fault, _) = streamed(10, Credits::OnItsWayNow, 1, 200_000);
    // Cause 2 is `protocol`.
    assert_eq!(fault, Some(2));
}
