//! What the page draws, as numbers for its script.

use crate::axis::AxisSetup;
use crate::bound::Bound;
use crate::charts::Charts;
use crate::lines::LineTicks;
use crate::trace::Trace;
use serde::Serialize;

/// What a recorder has kept for the page.
pub(crate) struct Kept<'a> {
    pub charts: Charts,
    pub trace: Trace,
    pub lines: &'a LineTicks,
    /// The axes that the path is drawn over.
    pub over: &'a [usize],
}

/// The drawing of a page. Its size is bounded.
#[derive(Debug, Clone, Serialize)]
pub struct Drawing {
    axes: Vec<AxisSetup>,
    /// All causes, in the order of the numbers below.
    causes: Vec<Cause>,
    charts: ChartValues,
    path: PathValues,
    lines: LineValues,
}

#[derive(Debug, Clone, Serialize)]
struct Cause {
    cause: &'static str,
    axis: Option<usize>,
}

/// Curves: the speed along the path, then speed, acceleration and jerk of each axis.
#[derive(Debug, Clone, Serialize)]
struct ChartValues {
    /// Seconds of a stretch.
    seconds: f64,
    low: Vec<Vec<f64>>,
    high: Vec<Vec<f64>>,
    /// The cause that takes most of each stretch.
    cause: Vec<usize>,
}

/// The path: each line from the point before to this one.
#[derive(Debug, Clone, Serialize)]
struct PathValues {
    /// The axes of x, y and z.
    over: Vec<usize>,
    /// Points; the first one is the start.
    x: Vec<f64>,
    y: Vec<f64>,
    z: Vec<f64>,
    /// Time at the end of each line, s.
    t: Vec<f64>,
    /// Mean speed of each line.
    speed: Vec<f64>,
    cause: Vec<usize>,
    line: Vec<u64>,
    /// Rows of the plan that the lines stand for.
    rows: u64,
    /// How far the planned motion is from the drawn lines at most, units.
    off: f64,
}

/// Seconds by lines of the file.
#[derive(Debug, Clone, Serialize)]
struct LineValues {
    together: u64,
    /// Group of lines, cause, seconds.
    seconds: Vec<(usize, usize, f64)>,
}

/// A value with six digits, which the page cannot show more of.
fn digits(value: f64) -> f64 {
    let text = format!("{value:.5e}");
    text.parse().unwrap_or(value)
}

impl Drawing {
    pub(crate) fn new(axes: &[AxisSetup], tick_seconds: f64, kept: &Kept<'_>) -> Self {
        let Kept { charts, trace, lines, over } = kept;
        let causes = Bound::all(axes.len());
        let causes =
            causes.map(|bound| Cause { cause: bound.name(), axis: bound.axis() }).collect();
        let curve = |end: usize| {
            let of = move |curve| charts.curve(curve).map(|range| digits(range[end])).collect();
            (0..=3 * axes.len()).map(of).collect()
        };
        // Places are rounded to a millionth of the size of the path.
        let step = 10_f64.powf((trace.size() * 1e-6).max(1e-9).log10().floor());
        let place = |k: usize| {
            let points = trace.strokes().iter().map(|stroke| stroke.end);
            let all = std::iter::once(trace.start()).chain(points);
            all.map(|point| digits_of_step(point[k], step)).collect()
        };
        let mut time = 0.0;
        let t = trace.strokes().iter().map(|stroke| {
            time += stroke.seconds;
            (time * 1e5).round() / 1e5
        });
        let path = PathValues {
            over: over.to_vec(),
            x: place(0),
            y: place(1),
            z: place(2),
            t: t.collect(),
            speed: trace.strokes().iter().map(|stroke| digits(stroke.speed())).collect(),
            cause: trace.strokes().iter().map(|stroke| stroke.cause).collect(),
            line: trace.strokes().iter().map(|stroke| stroke.line).collect(),
            rows: trace.rows(),
            off: trace.strokes().iter().map(|stroke| stroke.off).fold(0.0, f64::max),
        };
        let groups = lines.groups().iter().enumerate();
        let seconds = groups.flat_map(|(group, causes)| {
            let used = causes.iter().enumerate().filter(|(_, ticks)| **ticks > 0);
            used.map(move |(cause, &ticks)| (group, cause, digits(ticks as f64 * tick_seconds)))
        });
        Self {
            axes: axes.to_vec(),
            causes,
            charts: ChartValues {
                seconds: charts.width() as f64 * tick_seconds,
                low: curve(0),
                high: curve(1),
                cause: charts.bounds().collect(),
            },
            path,
            lines: LineValues { together: lines.together(), seconds: seconds.collect() },
        }
    }
}

/// A value rounded to a multiple of a power of ten, without a tail of digits.
fn digits_of_step(value: f64, step: f64) -> f64 {
    let decimals = (-step.log10().round()).max(0.0) as usize;
    let text = format!("{value:.decimals$}");
    text.parse().unwrap_or(value)
}
