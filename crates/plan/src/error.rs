//! The errors of planning: why a file cannot be planned.
//!
//! The messages are part of the command's interface: transcripts in tests/ quote them.

use carrystep_files::{TooManyAxes, Unit};
use carrystep_profile::LimitRefusal;
use thiserror::Error;

/// A move that cannot be done as requested, and what to change. `index` counts moves from 0; the
/// messages count them from 1.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum PlanError {
    /// The machine file has more axes than the gateware that plans are made for.
    #[error(transparent)]
    Axes(#[from] TooManyAxes),
    /// A limit of an axis forbids the move.
    #[error("move {}, axis {axis}: {}", index + 1, refused(refusal, unit, *least_time))]
    Refused {
        /// The move, counted from 0.
        index: usize,
        /// The axis that needs the longest time.
        axis: String,
        /// The limit with the wanted and the available value, in steps and seconds.
        refusal: LimitRefusal,
        /// The unit in which the message gives the values.
        unit: Unit,
        /// Least time in which all axes can do the move, seconds, rounded up to whole ticks; `None`
        /// if no time works.
        least_time: Option<f64>,
    },
    /// The time is not a whole number of ticks. At phase zero the last pulse is due at the very end
    /// of the move, which must therefore be the end of a tick.
    #[error(
        "move {}: time = {seconds} s is not a whole number of ticks of {tick_ns} ns, which phase = \"zero\" needs; take {rounded} s, or phase = \"half\"",
        index + 1
    )]
    NotWholeTicks {
        /// The move, counted from 0.
        index: usize,
        /// The requested time, seconds.
        seconds: f64,
        /// Length of a tick, ns.
        tick_ns: u64,
        /// The next longer time that works, seconds.
        rounded: f64,
    },
    /// The move has more than 2^42 ticks.
    #[error("move {}: {seconds} s is over 2^42 ticks of {tick_ns} ns; raise the limits that make it slow, or split it", index + 1)]
    TooLong {
        /// The move, counted from 0.
        index: usize,
        /// Its time, seconds.
        seconds: f64,
        /// Length of a tick, ns.
        tick_ns: u64,
    },
    /// The move is so slow that it needs too many segments, or that the gateware cannot place its
    /// edges.
    #[error("move {}, axis {axis}: {}", index + 1, too_slow(*broken, least_speed, *longest))]
    TooSlow {
        /// The move, counted from 0.
        index: usize,
        /// The name of the axis.
        axis: String,
        /// [`Broken::Slow`] or [`Broken::Segments`].
        broken: Broken,
        /// The least speed limit with which slow edges can be placed, as text in the unit of the
        /// axis.
        least_speed: String,
        /// The longest time that works, seconds, in whole ticks; `None` if none was found.
        longest: Option<f64>,
    },
    /// The integers break a rule of the exact check. This is a bug in the planner, and no plan is
    /// returned.
    #[error("move {}, axis {axis}: the plan breaks its own rule: {broken}; please report this move", index + 1)]
    Broken {
        /// The move, counted from 0.
        index: usize,
        /// The name of the axis.
        axis: String,
        /// The rule that is broken.
        broken: Broken,
    },
}

/// The rules of the exact check, and the reasons for which no integers were found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum Broken {
    /// V has the wrong sign within a move.
    #[error("the speed changes sign")]
    Sign,
    /// V is half a step per tick or more.
    #[error("half a step per tick is reached")]
    Overspeed,
    /// V exceeds `speed_limit`.
    #[error("speed_limit is passed")]
    Speed,
    /// A exceeds `accel_limit`.
    #[error("accel_limit is passed")]
    Acceleration,
    /// J exceeds `jerk_limit`.
    #[error("jerk_limit is passed")]
    Jerk,
    /// The start speed exceeds `start_speed`.
    #[error("start_speed is passed")]
    StartSpeed,
    /// The segments do not add up to the commanded distance or to the ticks of the move.
    #[error("it does not land exactly")]
    Landing,
    /// The speed limit is so low that the edges of slow pulses cannot be placed.
    #[error("pulses come too slowly")]
    Slow,
    /// More than 2^17 segments are needed.
    #[error("more than 131072 segments are needed")]
    Segments,
    /// A number exceeds the range of its register.
    #[error("a number is out of range")]
    Range,
}

impl PlanError {
    /// The move of the error, counted from 0; [`carrystep_files::MoveFile::move_error`] shows its
    /// place in the file. `None` if the error concerns the whole file.
    pub const fn move_index(&self) -> Option<usize> {
        match self {
            Self::Axes(_) => None,
            Self::Refused { index, .. }
            | Self::NotWholeTicks { index, .. }
            | Self::TooLong { index, .. }
            | Self::TooSlow { index, .. }
            | Self::Broken { index, .. } => Some(*index),
        }
    }
}

fn refused(refusal: &LimitRefusal, unit: &Unit, least_time: Option<f64>) -> String {
    let LimitRefusal { limit, wanted, available, .. } = refusal;
    let seconds = limit.seconds();
    let has = unit.both(*available, seconds);
    match least_time {
        None => format!("needs a {limit} over {has}; raise it, or take another profile"),
        Some(least) if wanted.is_finite() => {
            let needs = unit.both(*wanted, seconds);
            // Both numbers may look the same when they are printed with six digits.
            let needs = if needs == has { format!("a little more than {needs}") } else { needs };
            format!("needs {needs}, over {limit} {has}; at least {least} s would do")
        }
        Some(least) => format!(
            "no {} would do, {limit} is {has}; at least {least} s would do",
            unit.per(seconds)
        ),
    }
}

fn too_slow(broken: Broken, least_speed: &str, longest: Option<f64>) -> String {
    match (broken, longest) {
        (Broken::Segments, Some(longest)) => {
            format!("so slow that it needs over 131072 segments; at most {longest} s would do")
        }
        (Broken::Segments, None) => {
            "so slow that it needs over 131072 segments; raise the limits that make it slow"
                .to_owned()
        }
        (_, Some(longest)) => format!("too slow to place its edges; at most {longest} s would do"),
        (_, None) => format!(
            "too slow to place its edges: that needs a speed_limit of {least_speed}, or one just over the \
             speed of the move"
        ),
    }
}
