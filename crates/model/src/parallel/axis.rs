//! The accumulator of one axis: Ranade's speed-time accumulator (2009), extended to third order
//! (jerk) and fed by segments. [`tick`] must stay equal to the section "axis" of
//! docs/clock-by-clock.md.
//!
//! ```text
//!          +---+      +---+      +---+   carry
//!   J ---->| A |----->| V |----->| P |---------> a step, at phase q of its tick
//!          +---+ +J   +---+ +A   +---+ +V
//! ```
//!
//! In every tick V is added to P, A to V and J to A, and the carry of P is a step. A segment
//! replaces V, A and J when it starts; only additions of V ever change P.

use crate::parts::phase::{bisect, crosses};
pub use crate::parts::stage::Step;
use carrystep_core::Segment;

/// The registers of one axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AxisRegisters {
    /// Fraction of a step that the axis has travelled, in 2^-64 step.
    pub p: u64,
    /// Speed in 2^-64 step per tick; negative is backward.
    pub v: i64,
    /// Acceleration in 2^-64 step per tick^2.
    pub a: i64,
    /// Jerk in 2^-64 step per tick^3.
    pub j: i64,
    /// Remaining ticks of the running segment, the current tick included.
    pub left: u32,
    /// True while a segment is running.
    pub running: bool,
    /// True if the running segment is the last of its move.
    pub last: bool,
    /// The next segment, held until the running one ends or a start releases it.
    pub waiting: Option<Segment>,
}

/// The output of one tick.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct TickOutput {
    /// The step in this tick, if there is one.
    pub step: Option<Step>,
    /// Sign of the V that this tick added: -1, 0 or 1.
    pub sign: i8,
    /// True if the next V is not in the open interval (-2^63, 2^63).
    pub overspeed: bool,
    /// True if a segment that is not the last of its move ended and no segment was waiting.
    pub underrun: bool,
}

impl AxisRegisters {
    /// An axis at rest, with P = `start_value` (2^-64 step) and no segment waiting.
    pub const fn at_rest(start_value: u64) -> Self {
        Self {
            p: start_value,
            v: 0,
            a: 0,
            j: 0,
            left: 0,
            running: false,
            last: false,
            waiting: None,
        }
    }

    /// True in the last tick of the running segment.
    pub const fn ending(&self) -> bool {
        self.running && self.left == 1
    }

    /// True if a start in this tick would begin the waiting segment.
    pub const fn startable(&self) -> bool {
        self.waiting.is_some() && (!self.running || (self.ending() && self.last))
    }

    /// The same axis with V, A and J cleared and no running segment. P and the waiting segment
    /// stay.
    #[must_use]
    pub const fn stopped(self) -> Self {
        Self { v: 0, a: 0, j: 0, running: false, ..self }
    }
}

/// Executes one tick and returns the next state and the output. `go` starts the waiting segment if
/// the axis is [`AxisRegisters::startable`]. `phase_bits` is log2 of the number of phases per tick.
pub fn tick(state: AxisRegisters, go: bool, phase_bits: u32) -> (AxisRegisters, TickOutput) {
    let mut output = TickOutput {
        step: crosses(state.p, state.v)
            .then(|| Step { backward: state.v < 0, phase: bisect(state.p, state.v, phase_bits) }),
        sign: state.v.signum() as i8,
        ..TickOutput::default()
    };
    let moved = AxisRegisters { p: state.p.wrapping_add(state.v.cast_unsigned()), ..state };

    let ending = state.ending();
    let load = state.waiting.filter(|_| (ending && !state.last) || (state.startable() && go));
    let (next, speed) = if let Some(Segment { ticks, v, a, j, last }) = load {
        (
            AxisRegisters { v, a, j, left: ticks, running: true, last, waiting: None, ..moved },
            Some(v),
        )
    } else if state.running && !ending {
        let speed = state.v.checked_add(state.a);
        let next = AxisRegisters {
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
    // V must stay in (-2^63, 2^63): from half a step per tick on, direction and carry are
    // ambiguous.
    if speed.is_none_or(|v| v == i64::MIN) {
        output.overspeed = true;
        return (next.stopped(), output);
    }
    (next, output)
}
