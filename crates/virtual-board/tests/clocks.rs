//! A board whose clock is not the host's: the reported difference is true within its bound, and a
//! program that runs for ten minutes never runs dry.
#![allow(clippy::print_stderr, reason = "figures, for the page of longer runs")]

use crate::repeats;
use crate::support::wire::Faults;
use crate::support::{CLOCK_HZ, Died, End, SESSION, asked, build};
use carrystep_core::link::Uart;
use carrystep_link::{
    Clock, ClockDifference, Ended, Exchanged, Host, Line, Moment, Patience, Segment, SegmentSource,
    Wish,
};
use carrystep_virtual_board::ModelBoard;

/// The board's end of the line, with a host whose clock is slower than the board's by some ppm.
#[derive(Clone)]
struct Skewed {
    end: End<ModelBoard>,
    ppm: i64,
}

impl Clock for Skewed {
    fn milliseconds(&mut self) -> u32 {
        (self.moment().us / 1000) as u32
    }

    fn moment(&mut self) -> Moment {
        let million = 1_000_000;
        let cycles =
            u128::from(carrystep_virtual_board::SimulatedBoard::cycle(&self.end.0.borrow().board));
        let rate = u128::from(CLOCK_HZ) * u128::from((million + self.ppm).unsigned_abs());
        let us = cycles * million.unsigned_abs() as u128 * million.unsigned_abs() as u128 / rate;
        Moment { us: us as u64, resolution_us: 1 }
    }
}

impl Line for Skewed {
    type Error = Died;

    fn exchange(&mut self, out: &[u8], into: &mut [u8]) -> Result<Exchanged, Died> {
        self.end.exchange(out, into)
    }
}

/// Six axes that go forward and back slowly, in segments of 100 ms.
struct Slow {
    left: [u64; 6],
    start: Option<u8>,
}

impl SegmentSource for Slow {
    fn segment(&mut self, axis: u8) -> Option<Segment> {
        let left = self.left.get_mut(usize::from(axis))?;
        *left = left.checked_sub(1)?;
        let v = if *left % 2 == 0 { 1 << 50 } else { -(1 << 50) };
        Some(Segment { ticks: 50_000, v, a: 0, j: 0, last: *left == 0 })
    }

    fn start(&mut self) -> Option<u8> {
        self.start.take()
    }
}

/// Streams for `CARRYSTEP_CLOCK_SECONDS` of the board's time; `usual` if it is not set.
fn compares(ppm: i64, usual: u64) {
    let uart = Uart::new(CLOCK_HZ, 3_000_000).unwrap();
    let seconds = asked("CARRYSTEP_CLOCK_SECONDS", usual);
    let end = End::<ModelBoard>::new(uart, Faults::default(), 1);
    let host = Skewed { end: end.clone(), ppm };
    let id = uart.build_id(&build()).0;
    let mut host: Host<_, _> =
        Host::connect(host.clone(), host, Some(id), Patience::default()).unwrap();
    host.open(SESSION).unwrap();
    host.enable().unwrap();
    let program = Slow { left: [seconds * 10; 6], start: Some(0b11_1111) };
    let mut looks = 0_u64;
    let ended = host.stream(program, |progress| {
        end.0.borrow_mut().handed_over = progress.handed_over;
        looks += 1;
        // The host has other work to do, which also makes this test fast.
        end.wait(49);
        Wish::GoOn
    });
    assert_eq!(ended, Ok(Ended::Done));
    let ClockDifference { ppm: found, bound } = host.clock_difference().unwrap();
    let least = end.0.borrow().least_waiting;
    eprintln!(
        "FIGURES clock off by {ppm} ppm: {found:.2} +- {bound:.2} ppm after {seconds} s, {looks} exchanges, at least {least} segments waiting"
    );
    assert!((found - ppm as f64).abs() <= bound, "{found} +- {bound}, is {ppm}");
    assert!(bound * (seconds as f64) < 3000.0, "{bound} ppm are no result");
    assert!((1..=7).contains(&least), "{least}");
    let ticks = host.tick().unwrap();
    assert!(ticks as u64 >= seconds * 500_000, "{ticks}");
}

#[test]
fn difference_of_a_fast_board_is_reported_within_its_bound() {
    compares(200, repeats::part(600, 2));
}

#[test]
fn difference_of_a_slow_board_is_reported_within_its_bound() {
    compares(-200, repeats::part(600, 5));
}
