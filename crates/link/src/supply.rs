//! Checks before any motion whether a line can carry a program in time, and whether the gateware can
//! take it in time.
//!
//! ```text
//! queue     of n places: segments 0 .. n - 1 are queued before the start; when segment k begins
//!           to run, the place of segment k + n becomes free
//! line      transmits one frame at a time, the most urgent first, for as long as the line needs
//!           or the gateware, whichever is slower; segments of several axes with the same begin
//!           and end are one frame
//! axis      |  k  | k + 1 | ... |  |  k + n           segment k + n must have arrived
//!                                  ^                  before this moment
//! ```

use crate::command::{Command, OutputChange, Segment, WideSegment};
use crate::frame::{Body, Request};
use crate::pace::LinkPace;
use crate::slip;
use carrystep_core::Timebase;
use core::fmt;
use std::collections::VecDeque;
use std::vec::Vec;
use thiserror::Error;

/// Bits per byte on a UART: a start bit, eight data bits, a stop bit.
const BITS_OF_BYTE: u64 = 10;

/// Time that a segment takes of the gateware, in percent of that of its frame. The rest is for reads:
/// three axes on a tick of 80 us need 75 % of the gateware for their segments alone, and the host
/// keeps up; on one of 90 us they need 83 %, and the queues run dry.
const WITH_READS_PERCENT: u64 = 125;

/// A program that this line cannot carry in time, or that the gateware cannot take in time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error(
    "{bottleneck} too slow for this move: axis {axis} would run dry {at_ms} ms after the start, \
     its next segment {late_us} us late; take {}, a larger fit_ns, or fewer axes at once",
    bottleneck.remedy()
)]
pub struct Starved {
    /// Number of the axis whose queue would run empty, from 0.
    pub axis: u8,
    /// Time when it would, ms after the start of the program.
    pub at_ms: u64,
    /// Delay of the axis' next segment, us, rounded up.
    pub late_us: u64,
    /// What is too slow for that segment.
    pub bottleneck: Bottleneck,
}

/// What limits how many segments come in a second.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Bottleneck {
    /// The line.
    Line {
        /// Its baud rate, bits per second.
        baud: u32,
    },
    /// The gateware, which stores a word of an axis in a tick.
    Tick {
        /// Its tick, ns.
        ns: u64,
    },
}

impl Bottleneck {
    /// What makes it faster, with its article.
    pub const fn remedy(self) -> &'static str {
        match self {
            Self::Line { .. } => "a higher baud rate",
            Self::Tick { .. } => "a shorter tick",
        }
    }
}

impl fmt::Display for Bottleneck {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line { baud } => write!(f, "{baud} baud are"),
            Self::Tick { ns } => write!(f, "a tick of {ns} ns is"),
        }
    }
}

/// A segment to be transmitted: when its queue place becomes free, and when it must have arrived,
/// ns.
#[derive(Debug)]
struct Job {
    place: u64,
    due: u64,
    segment: Segment,
    outputs: OutputChange,
}

/// Checks that a UART at this baud rate delivers each segment before its axis needs it, and that a
/// gateware with this clock takes them in time, provided that the host is never late.
///
/// # Errors
/// [`Starved`] gives the first axis whose queue would run empty.
pub fn check(
    commands: &[Command],
    axes: u8,
    timebase: Timebase,
    queue: usize,
    baud: u32,
) -> Result<(), Starved> {
    let mut supply = Supply::new(axes, timebase, queue, baud);
    commands.iter().try_for_each(|command| supply.add(command))?;
    supply.finish()
}

/// The same check for a program of any length, command by command.
#[derive(Debug)]
pub struct Supply {
    timebase: Timebase,
    /// Number of segments that the queue of an axis holds.
    queue: usize,
    /// No segment is sent while those that wait last so long, ns.
    enough: u64,
    baud: u32,
    pace: LinkPace,
    axes: Vec<Axis>,
    /// What changes with the next segment of axis 0.
    outputs: OutputChange,
    /// The time until which the line is busy, ns.
    now: u64,
}

/// The segments of an axis that have not been transmitted.
#[derive(Debug, Default)]
struct Axis {
    /// The tick at which the next segment begins.
    tick: u64,
    /// Number of segments so far.
    count: usize,
    /// When the last segments begin, ns: from the one whose begin lets the last one be sent.
    begins: VecDeque<u64>,
    jobs: VecDeque<Job>,
}

impl Supply {
    /// A check of a build with so many axes, with this clock and tick and queues of `queue`
    /// segments, on a line of `baud` bits per second.
    pub fn new(axes: u8, timebase: Timebase, queue: usize, baud: u32) -> Self {
        let axes = (0..axes).map(|_| Axis::default()).collect();
        let pace = LinkPace::new(timebase.clock_hz(), timebase.tick_ns(), baud);
        let (outputs, enough) = (OutputChange::NONE, u64::MAX);
        Self { timebase, queue, enough, baud, pace, axes, outputs, now: 0 }
    }

    /// The same for a source that [does not fill](crate::SegmentSource::may_send) the queues: it
    /// sends no segment while those that wait last for `ns` ns.
    #[must_use]
    pub fn with_enough(self, ns: u64) -> Self {
        Self { enough: ns, ..self }
    }

    /// Adds the next command of the program.
    ///
    /// # Errors
    /// [`Starved`] as soon as it is known that the queue of an axis would run empty.
    pub fn add(&mut self, command: &Command) -> Result<(), Starved> {
        let (number, segment) = match *command {
            Command::Segment { axis, segment } => (axis, segment),
            Command::Outputs(change) => {
                self.outputs = self.outputs.then(change);
                return Ok(());
            }
            Command::Start { .. } => return Ok(()),
        };
        let none = OutputChange::NONE;
        let outputs = if number == 0 { core::mem::take(&mut self.outputs) } else { none };
        let Some(axis) = self.axes.get_mut(usize::from(number)) else { return Ok(()) };
        let due = axis.tick.saturating_mul(self.timebase.tick_ns());
        axis.tick = axis.tick.saturating_add(segment.ticks.into());
        axis.begins.push_back(due);
        axis.count += 1;
        // Those behind the segment that runs wait: fewer than the queue has places, and less than
        // is enough.
        let begins = &mut axis.begins;
        while begins.len() > self.queue + 1
            || begins.get(1).is_some_and(|next| due - next >= self.enough)
        {
            begins.pop_front();
        }
        // The first segments are in the queue before the start.
        let is_first = begins.len() == axis.count;
        if let Some(&place) = begins.front()
            && !(is_first && begins.len() <= self.queue && due - place < self.enough)
        {
            axis.jobs.push_back(Job { place, due, segment, outputs });
        }
        // Which axis is next is known when the next job of each axis is.
        while self.axes.iter().all(|axis| !axis.jobs.is_empty()) {
            self.transmit()?;
        }
        Ok(())
    }

    /// Ends the program.
    ///
    /// # Errors
    /// [`Starved`] gives the first axis whose queue would run empty.
    pub fn finish(mut self) -> Result<(), Starved> {
        while self.axes.iter().any(|axis| !axis.jobs.is_empty()) {
            self.transmit()?;
        }
        Ok(())
    }

    /// Transmits the most urgent of the next segments, and those that share its frame.
    fn transmit(&mut self) -> Result<(), Starved> {
        let axes = &self.axes;
        let heads = || (0..).zip(axes).filter_map(|(at, axis)| Some((at, axis.jobs.front()?)));
        let Some(soonest) = heads().map(|(_, job)| job.place).min() else { return Ok(()) };
        let now = self.now.max(soonest);
        let placed = heads().filter(|(_, job)| job.place <= now);
        let Some((axis, first)) = placed.min_by_key(|(_, job)| job.due) else { return Ok(()) };
        let (due, segment) = (first.due, first.segment);
        let mut wide =
            WideSegment { ticks: segment.ticks, last: segment.last, ..WideSegment::default() };
        for ((number, axis), cubic) in (0..).zip(&mut self.axes).zip(&mut wide.cubics) {
            let joins = axis.jobs.front().is_some_and(|job| {
                let same = (job.segment.ticks, job.segment.last) == (segment.ticks, segment.last);
                same && job.due == due && job.place <= now
            });
            if joins
                && let Some(Job { segment: Segment { v, a, j, .. }, outputs, .. }) =
                    axis.jobs.pop_front()
            {
                wide.outputs = wide.outputs.then(outputs);
                wide.mask |= 1_u8 << number;
                *cubic = [v, a, j];
            }
        }
        let body = if wide.mask.is_power_of_two() {
            Body::Segment { axis, segment, outputs: wide.outputs }
        } else {
            Body::Segments(wide)
        };
        let request = Request { sequence: 0, session: 0, body };
        let bits = BITS_OF_BYTE * slip::encode(request.to_bytes().as_slice()).count() as u64;
        let line = (bits * 1_000_000_000).div_ceil(u64::from(self.baud.max(1)));
        let clocks = self.pace.clocks(&request.body) * WITH_READS_PERCENT / 100;
        let gateware = self.timebase.clock_to_ps(clocks).div_ceil(1000);
        self.now = now.saturating_add(line.max(gateware));
        if self.now > due {
            let late_us = (self.now - due).div_ceil(1000);
            let bottleneck = match gateware > line {
                true => Bottleneck::Tick { ns: self.timebase.tick_ns() },
                false => Bottleneck::Line { baud: self.baud },
            };
            return Err(Starved { axis, at_ms: due / 1_000_000, late_us, bottleneck });
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::command::Segment;

    /// A clock of 80 MHz and a tick of 2 us.
    fn clock() -> Timebase {
        Timebase::new(80_000_000, 2000, 4).unwrap()
    }

    /// A program of `count` segments of `ticks` ticks for each of six axes.
    fn even(count: u32, ticks: u32) -> Vec<Command> {
        let segment = |last| Segment { ticks, v: 1, a: 0, j: 0, last };
        let of =
            |k| (0..6).map(move |axis| Command::Segment { axis, segment: segment(k + 1 == count) });
        (0..count).flat_map(of).collect()
    }

    #[test]
    fn six_axes_need_a_line_of_their_data_rate() {
        // 500 segments per second of six axes with common ticks: 500 x 166 bytes x 10 bits =
        // 0.83 Mbit/s.
        let dense = even(1000, 1000);
        assert_eq!(check(&dense, 6, clock(), 7, 921_600), Ok(()));
        assert_eq!(check(&even(1000, 500), 6, clock(), 7, 3_000_000), Ok(()));
        let starved = check(&dense, 6, clock(), 7, 800_000).unwrap_err();
        assert!(starved.late_us > 0 && starved.at_ms > 14, "{starved}");
    }

    #[test]
    fn segments_without_common_ticks_need_a_frame_each() {
        // 6 x 500 x 46 bytes x 10 bits = 1.4 Mbit/s.
        let mut apart = even(1000, 1000);
        for command in &mut apart {
            if let Command::Segment { axis, segment } = command {
                segment.ticks += u32::from(*axis);
            }
        }
        assert_eq!(check(&apart, 6, clock(), 7, 1_600_000), Ok(()));
        assert!(check(&apart, 6, clock(), 7, 921_600).is_err());
    }

    /// A burst of short segments behind long ones: what waits has to last until it is over.
    #[test]
    fn less_that_waits_carries_a_program_over_less() {
        let mut burst = even(100, 5000);
        for command in &mut burst[180..420] {
            if let Command::Segment { segment, .. } = command {
                segment.ticks = 1000;
            }
        }
        let with = |ms: u64| {
            let mut supply = Supply::new(6, clock(), 31, 500_000).with_enough(ms * 1_000_000);
            burst.iter().try_for_each(|command| supply.add(command))?;
            supply.finish()
        };
        assert_eq!(with(1000), check(&burst, 6, clock(), 31, 500_000));
        assert_eq!((with(1000), with(100)), (Ok(()), Ok(())));
        assert!(with(20).is_err());
    }

    #[test]
    fn gateware_with_a_long_tick_is_slower_than_its_line() {
        let slow = Timebase::new(80_000_000, 50_000, 4).unwrap();
        let starved = check(&even(1000, 60), 6, slow, 7, 3_000_000).unwrap_err();
        assert_eq!(starved.bottleneck, Bottleneck::Tick { ns: 50_000 });
        let said = std::format!("{starved}");
        assert!(said.starts_with("a tick of 50000 ns is too slow for this move"), "{said}");
        assert!(said.contains("take a shorter tick"), "{said}");
        // The engine stores a word of a segment in a tick: 63 ticks for one of six axes.
        assert_eq!(check(&even(1000, 100), 6, slow, 7, 3_000_000), Ok(()));
    }

    #[test]
    fn segments_queued_before_the_start_need_no_line_time() {
        assert_eq!(check(&even(7, 1), 6, clock(), 7, 300), Ok(()));
        assert!(check(&even(8, 1), 6, clock(), 7, 300).is_err());
        assert_eq!(check(&[], 6, clock(), 7, 0), Ok(()));
    }
}
