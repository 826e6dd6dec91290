//! Why a file cannot be planned.

use carrystep_files::{TooManyAxes, Unit};
use carrystep_profile::Refusal;
use thiserror::Error;

/// A move that cannot be done as asked, and what to do. `index` counts moves from 0, messages from 1.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum PlanError {
    /// The gateware that plans are made for has fewer axes.
    #[error(transparent)]
    Axes(#[from] TooManyAxes),
    /// A limit of an axis forbids it.
    #[error("move {}, axis {axis}: {}", index + 1, refused(refusal, unit, *least_time))]
    Refused {
        /// Which move.
        index: usize,
        /// The axis that needs most time.
        axis: String,
        /// Limit, wanted and available value, in steps.
        refusal: Refusal,
        /// The unit in which the message gives them.
        unit: Unit,
        /// Least time in which all axes can do the move, whole ticks, seconds; `None`: no time would do.
        least_time: Option<f64>,
    },
    /// At phase zero the last pulse is due at the very end, so that a tick must end there.
    #[error(
        "move {}: time = {seconds} s is not a whole number of ticks of {tick_ns} ns, which phase = \"zero\" needs; take {rounded} s, or phase = \"half\"",
        index + 1
    )]
    NotWholeTicks {
        /// Which move.
        index: usize,
        /// Time asked for, seconds.
        seconds: f64,
        /// Tick, ns.
        tick_ns: u64,
        /// The next time that would do, seconds.
        rounded: f64,
    },
    /// More ticks than a plan counts.
    #[error("move {}: {seconds} s is over 2^42 ticks of {tick_ns} ns; raise the limits that make it slow, or split it", index + 1)]
    TooLong {
        /// Which move.
        index: usize,
        /// Its time, seconds.
        seconds: f64,
        /// Tick, ns.
        tick_ns: u64,
    },
    /// So slow that segments of 64 bits cannot do it, or the gateware cannot place its edges.
    #[error("move {}, axis {axis}: {}", index + 1, too_slow(*broken, least_speed, *longest))]
    TooSlow {
        /// Which move.
        index: usize,
        /// Which axis.
        axis: String,
        /// [`Broken::Slow`] or [`Broken::Segments`].
        broken: Broken,
        /// The least speed limit with which slow edges can be placed, in the unit of the axis.
        least_speed: String,
        /// The longest time that works, whole ticks, seconds; `None`: not even the least time does.
        longest: Option<f64>,
    },
    /// The integers do not keep a promise: the plan is not given out.
    #[error("move {}, axis {axis}: the plan breaks its own rule: {broken}; please report this move", index + 1)]
    Broken {
        /// Which move.
        index: usize,
        /// Which axis.
        axis: String,
        /// The rule.
        broken: Broken,
    },
}

/// What the exact check of the integers found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum Broken {
    /// V has the wrong sign within a move.
    #[error("the speed changes sign")]
    Sign,
    /// V is half a step per tick or more.
    #[error("half a step per tick is reached")]
    Overspeed,
    /// Over `speed_limit`.
    #[error("speed_limit is passed")]
    Speed,
    /// Over `accel_limit`.
    #[error("accel_limit is passed")]
    Acceleration,
    /// Over `jerk_limit`.
    #[error("jerk_limit is passed")]
    Jerk,
    /// Over `start_speed`.
    #[error("start_speed is passed")]
    StartSpeed,
    /// Not the commanded distance, or not the ticks of the move.
    #[error("it does not land exactly")]
    Landing,
    /// The speed limit is so low that edges of slow pulses cannot be placed.
    #[error("pulses come too slowly")]
    Slow,
    /// Over 2^17 segments.
    #[error("more than 131072 segments are needed")]
    Segments,
    /// A number that should fit does not.
    #[error("a number is out of range")]
    Range,
}

impl PlanError {
    /// The move that it is about, from 0: [`carrystep_files::MoveFile::move_error`] shows its place.
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

fn refused(refusal: &Refusal, unit: &Unit, least_time: Option<f64>) -> String {
    let Refusal { limit, wanted, available, .. } = refusal;
    let seconds = limit.seconds();
    let has = unit.both(*available, seconds);
    match least_time {
        None => format!("needs a {limit} over {has}; raise it, or take another profile"),
        Some(least) if wanted.is_finite() => {
            let needs = unit.both(*wanted, seconds);
            // Figures of six digits may be the same.
            let needs = if needs == has { format!("a little more than {needs}") } else { needs };
            format!("needs {needs}, over {limit} {has}; at least {least} s would do")
        }
        Some(least) => format!("no {} would do, {limit} is {has}; at least {least} s would do", unit.per(seconds)),
    }
}

fn too_slow(broken: Broken, least_speed: &str, longest: Option<f64>) -> String {
    match (broken, longest) {
        (Broken::Segments, Some(longest)) => {
            format!("so slow that it needs over 131072 segments; at most {longest} s would do")
        }
        (Broken::Segments, None) => {
            "so slow that it needs over 131072 segments; raise the limits that make it slow".to_owned()
        }
        (_, Some(longest)) => format!("too slow to place its edges; at most {longest} s would do"),
        (_, None) => format!(
            "too slow to place its edges: that needs a speed_limit of {least_speed}, or one just over the \
             speed of the move"
        ),
    }
}
