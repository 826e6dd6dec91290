//! What the planner refuses of a path, element by element: numbers, places beyond travel, arcs.

use crate::element::Element;
use crate::error::JobError;
use crate::targets::Targets;
use crate::vector::Point;

/// Refuses what is not a positive finite number.
fn positive(value: f64, line: u64, what: &'static str, help: &'static str) -> Result<(), JobError> {
    if value.is_finite() && value > 0.0 {
        Ok(())
    } else {
        Err(JobError::Number { line, what, value, help })
    }
}

/// Refuses an element that cannot be planned.
pub(crate) fn refuse<const N: usize>(
    element: &Element,
    from: &Point<N>,
    targets: &Targets<N>,
    linear: usize,
) -> Result<(), JobError> {
    let line = element.line;
    let to: Point<N> = targets.coordinates(&element.to, line)?;
    targets.check(&to, line)?;
    if let Some(feed) = element.feed {
        positive(feed, line, "the feed", "give a feed above 0")?;
    }
    let help = "give a tolerance above 0, or let the path rest at each corner";
    positive(element.tolerance.linear, line, "the tolerance", help)?;
    positive(element.tolerance.rotary, line, "the rotary tolerance", help)?;
    let Some(arc) = &element.arc else { return Ok(()) };
    let [i, j] = arc.plane;
    if i == j || i >= linear || j >= linear {
        return Err(JobError::Arc { line });
    }
    let [start, end] = [from, &to].map(|p| (p[i] - arc.centre[0]).hypot(p[j] - arc.centre[1]));
    if !arc.angle.is_finite() || arc.angle == 0.0 || !start.is_finite() || start.min(end) <= 0.0 {
        return Err(JobError::Arc { line });
    }
    let differ = (start - end).abs();
    if differ > 0.5 || (differ > 0.005 && differ > 0.001 * start.max(end)) {
        return Err(JobError::Radii { line, start, end });
    }
    // The extremes of the letters and of sums and differences of two of them.
    let eighth = std::f64::consts::FRAC_PI_4;
    let first = (from[j] - arc.centre[1]).atan2(from[i] - arc.centre[0]);
    let (low, high) = (first.min(first + arc.angle), first.max(first + arc.angle));
    for turn in 0..8 {
        let angle = f64::from(turn) * eighth;
        let whole = ((low - angle) / std::f64::consts::TAU).ceil();
        if angle + whole * std::f64::consts::TAU <= high {
            let mut point = to;
            point[i] = arc.centre[0] + start * angle.cos();
            point[j] = arc.centre[1] + start * angle.sin();
            targets.check(&point, line)?;
        }
    }
    Ok(())
}
