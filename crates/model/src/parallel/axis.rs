//! One axis: Ranade's speed-time accumulator (2009), to third order, fed by segments.
//!
//! ```text
//!          +---+      +---+      +---+   carry
//!   J ---->| A |----->| V |----->| P |---------> a step, at phase q of its tick
//!          +---+ +J   +---+ +A   +---+ +V
//! ```
//!
//! Each tick adds; nothing else ever happens to P. A segment replaces V, A and J when it starts.

use crate::parts::phase::{bisect, crosses};
use carrystep_core::Segment;

/// The registers of one axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct State {
    /// Position in the step, 2^-64 step.
    pub p: u64,
    /// Speed, 2^-64 step per tick.
    pub v: i64,
    /// Acceleration, 2^-64 step per tick^2.
    pub a: i64,
    /// Jerk, 2^-64 step per tick^3.
    pub j: i64,
    /// Ticks left of the running segment.
    pub left: u32,
    /// A segment is running.
    pub running: bool,
    /// The running segment is the last of its move.
    pub last: bool,
    /// The segment that comes next.
    pub waiting: Option<Segment>,
}

/// A step: which way, and where in its tick.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Step {
    /// Against the direction of counting.
    pub backward: bool,
    /// 0 .. Q - 1.
    pub phase: u32,
}

/// What one tick brings forth.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Output {
    /// The step in this tick, if there is one.
    pub step: Option<Step>,
    /// Sign of the speed that was added: -1, 0 or 1.
    pub sign: i8,
    /// V would have left (-2^63, 2^63).
    pub overspeed: bool,
    /// The queue was dry after a segment not marked last.
    pub underrun: bool,
}

impl State {
    /// At rest, nothing waiting.
    pub const fn at_rest(start_value: u64) -> Self {
        Self { p: start_value, v: 0, a: 0, j: 0, left: 0, running: false, last: false, waiting: None }
    }

    /// The running segment is in its last tick.
    pub const fn ending(&self) -> bool {
        self.running && self.left == 1
    }

    /// A start in this tick would begin the waiting segment.
    pub const fn startable(&self) -> bool {
        self.waiting.is_some() && (!self.running || (self.ending() && self.last))
    }

    /// No motion and no cause for any.
    #[must_use]
    pub const fn stopped(self) -> Self {
        Self { v: 0, a: 0, j: 0, running: false, ..self }
    }
}

/// One tick: `state, go -> state, output`; `go` starts the waiting segment of an axis that is
/// [`State::startable`].
pub fn tick(state: State, go: bool, phase_bits: u32) -> (State, Output) {
    let mut output = Output {
        step: crosses(state.p, state.v)
            .then(|| Step { backward: state.v < 0, phase: bisect(state.p, state.v, phase_bits) }),
        sign: state.v.signum() as i8,
        ..Output::default()
    };
    let moved = State { p: state.p.wrapping_add(state.v.cast_unsigned()), ..state };

    let ending = state.ending();
    let load = state.waiting.filter(|_| (ending && !state.last) || (state.startable() && go));
    let (next, speed) = if let Some(Segment { ticks, v, a, j, last }) = load {
        (State { v, a, j, left: ticks, running: true, last, waiting: None, ..moved }, Some(v))
    } else if state.running && !ending {
        let speed = state.v.checked_add(state.a);
        let next = State {
            v: speed.unwrap_or(0),
            a: state.a.wrapping_add(state.j),
            left: state.left.wrapping_sub(1),
            ..moved
        };
        (next, speed)
    } else {
        output.underrun = ending && !state.last;
        (moved.stopped(), Some(0))
    };
    // abs(V) < 2^63, always: half a step per tick is where direction and carry lose their meaning.
    if speed.is_none_or(|v| v == i64::MIN) {
        output.overspeed = true;
        return (next.stopped(), output);
    }
    (next, output)
}
