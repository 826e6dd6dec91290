//! Why a path cannot be planned. `line` is the source line of the element.

use thiserror::Error;

/// A path that cannot be planned as it is, and what would do.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum JobError {
    /// The machine has no letters, or more than the planner takes.
    #[error("a machine of {0} axes: a job needs 1 to 6")]
    Axes(usize),
    /// The UART of the machine cannot carry the segments of its axes in time.
    #[error(
        "a line of {baud} baud is too slow for jobs of {axes} axes: each needs a segment every 16 \
         ms at least, and they take {least} baud"
    )]
    SlowLine {
        /// Number of axes.
        axes: usize,
        /// The baud rate of the machine.
        baud: u32,
        /// The least baud rate for so many axes.
        least: u32,
    },
    /// A point has a wrong number of coordinates.
    #[error("line {line}: {found} coordinates, the machine has {axes} axes")]
    Coordinates {
        /// The source line.
        line: u64,
        /// Number of coordinates.
        found: usize,
        /// Number of axes.
        axes: usize,
    },
    /// A number is not finite, or negative where it must not be.
    #[error("line {line}: {what} is {value}; {help}")]
    Number {
        /// The source line.
        line: u64,
        /// What the number is.
        what: &'static str,
        /// The number.
        value: f64,
        /// What would do.
        help: &'static str,
    },
    /// The radii at start and end of an arc differ.
    #[error(
        "line {line}: the arc's radius is {start} mm at its start and {end} mm at its end; \
         the centre must be equally far from both"
    )]
    Radii {
        /// The source line.
        line: u64,
        /// Radius at the start, mm.
        start: f64,
        /// Radius at the end, mm.
        end: f64,
    },
    /// The arc turns by no angle or in no plane.
    #[error("line {line}: an arc without radius, angle or plane")]
    Arc {
        /// The source line.
        line: u64,
    },
    /// A target leaves the travel of a motor.
    #[error("line {line}: {axis} would go to {steps} steps, beyond its travel of {low} to {high}")]
    Travel {
        /// The source line.
        line: u64,
        /// Name of the axis.
        axis: String,
        /// Where the path goes, steps.
        steps: i64,
        /// Lowest place, steps.
        low: i64,
        /// Highest place, steps.
        high: i64,
    },
    /// A target is further than the position register counts.
    #[error(
        "line {line}: {axis} would go beyond 2^31 steps; use fewer steps per unit or shorter moves"
    )]
    Far {
        /// The source line.
        line: u64,
        /// Name of the axis.
        axis: String,
    },
    /// The integers break a rule of the exact check. This is a bug in the planner; the segment is
    /// not given out.
    #[error(
        "line {line}, axis {axis}: the plan breaks its own rule: {rule}; please report this job"
    )]
    Broken {
        /// The source line.
        line: u64,
        /// Number of the axis.
        axis: usize,
        /// The rule that is broken.
        rule: Rule,
    },
    /// The planner was used after an error or after its end.
    #[error("the planner has ended; make a new one for the next job")]
    Ended,
}

/// A rule of the exact check.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum Rule {
    /// V at an end or extreme.
    #[error("speed_limit is passed")]
    Speed,
    /// A at an end.
    #[error("accel_limit is passed")]
    Acceleration,
    /// J.
    #[error("jerk_limit is passed")]
    Jerk,
    /// A jump of A at a boundary.
    #[error("the acceleration jumps")]
    Jump,
    /// The integer position and the planned one.
    #[error("the position leaves the plan")]
    Position,
    /// An edge near a reversal.
    #[error("DIR set-up or hold does not fit at a reversal")]
    Direction,
    /// The end of a run.
    #[error("it does not land exactly")]
    Landing,
    /// A value does not fit its register.
    #[error("a number is out of range")]
    Range,
}
