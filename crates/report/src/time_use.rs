//! Where the time goes: seconds of each cause, and the lines that take most of them.
//!
//! The names of the fields are part of `--json` and may not change.

use crate::axis::AxisSetup;
use crate::bound::Bound;
use crate::lines::LineTicks;
use schemars::JsonSchema;
use serde::Serialize;

/// Most entries of lines for a cause.
const MOST_LINES: usize = 5;

/// Where the time of a plan goes.
#[derive(Debug, Clone, PartialEq, JsonSchema, Serialize)]
pub struct TimeUse {
    /// Each cause that takes time, the longest first.
    pub causes: Vec<TimeOf>,
    /// How many neighbouring lines (in a move file: moves) are counted together. It is 1 up to
    /// 1023 lines.
    pub lines_together: u64,
    /// Seconds of motion by the greatest distance of the planned curve from the programmed path in
    /// a row, as a part of the tolerance: from 0 to 1/40, from 1/40 to 2/40, and so on. Rows at
    /// rest are left out. Empty for move files.
    pub distance_seconds: Vec<f64>,
}

/// The time of one cause.
#[derive(Debug, Clone, PartialEq, JsonSchema, Serialize)]
pub struct TimeOf {
    /// What binds: `feed`, `speed`, `acceleration` or `jerk` of an axis, `tolerance`, `stop` (rests
    /// and the ramps to and from them), `given_time` (the time that the move file gives).
    pub cause: &'static str,
    /// The axis, if it is a limit of an axis.
    pub axis: Option<String>,
    /// Time in s.
    pub seconds: f64,
    /// Part of the whole time, percent.
    pub percent: f64,
    /// The lines (in a move file: moves) with most of this time, the longest first; at most five.
    pub lines: Vec<LinesOf>,
}

/// Neighbouring lines and their time.
#[derive(Debug, Clone, PartialEq, JsonSchema, Serialize)]
pub struct LinesOf {
    /// The first line, from 1; 0 is the time before any line.
    pub from: u64,
    /// The last line.
    pub to: u64,
    /// Their time in s.
    pub seconds: f64,
}

impl TimeUse {
    pub(crate) fn new(
        axes: &[AxisSetup],
        lines: &LineTicks,
        tick_seconds: f64,
        distance_seconds: Vec<f64>,
    ) -> Self {
        let together = lines.together();
        let groups = lines.groups();
        let all: u64 = groups.iter().flatten().sum();
        let of = |(cause, bound): (usize, Bound)| {
            let ticks: u64 = groups.iter().map(|group| group[cause]).sum();
            let mut most: Vec<(usize, u64)> = groups
                .iter()
                .enumerate()
                .map(|(number, group)| (number, group[cause]))
                .filter(|(_, ticks)| *ticks > 0)
                .collect();
            most.sort_by_key(|&(number, ticks)| (std::cmp::Reverse(ticks), number));
            most.truncate(MOST_LINES);
            let lines = most.into_iter().map(|(number, ticks)| {
                let from = number as u64 * together;
                let (to, seconds) = (from + together - 1, ticks as f64 * tick_seconds);
                LinesOf { from: if together > 1 { from.max(1) } else { from }, to, seconds }
            });
            (ticks > 0).then(|| TimeOf {
                cause: bound.name(),
                axis: bound.axis().map(|axis| axes[axis].name.clone()),
                seconds: ticks as f64 * tick_seconds,
                percent: 100.0 * ticks as f64 / all as f64,
                lines: lines.collect(),
            })
        };
        let mut causes: Vec<TimeOf> = Bound::all(axes.len()).enumerate().filter_map(of).collect();
        causes.sort_by(|a, b| b.seconds.total_cmp(&a.seconds));
        Self { causes, lines_together: together, distance_seconds }
    }
}
