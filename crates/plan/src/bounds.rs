//! Writes the limits of a stretch as rows of its linear programme. V, A, J and the speed jumps at
//! the start and the end of a move are linear in the three unknowns.
//!
//! `HELD` may be tuned: the exact check refuses a plan that exceeds a limit between these
//! positions.

use crate::cubic::steps;
use crate::exchange::Row;
use crate::limits::ExactLimits;

/// Positions within a stretch, as fractions of its length, at which the rows bound V. The exact
/// check later covers every tick.
const HELD: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];

/// Appends the bounds for the unknowns V n, A n^2 and J n^3, in steps, over `n` ticks. `scale` is
/// the weight of a row, chosen so that one unit of excess counts like one level.
pub(crate) fn bounds(
    rows: &mut Vec<Row>,
    n: f64,
    limits: &ExactLimits,
    [first, last]: [bool; 2],
    scale: f64,
) {
    let mut hold = |at: [f64; 3], most: f64| {
        rows.push(Row { at: at.map(|b| b * scale), error: 0.0, most: most * scale });
    };
    let speed = steps(limits.speed) * n;
    for part in HELD {
        let k = part * (n - 1.0);
        let at = [1.0, k / n, k * (k - 1.0) / (2.0 * n * n)];
        hold(at, speed);
        hold(at.map(|b| -b), 0.0);
    }
    let acceleration = steps(limits.acceleration) * n * n;
    for at in [[0.0, 1.0, -1.0 / n], [0.0, 1.0, (n - 1.0) / n]] {
        hold(at, acceleration);
        hold(at.map(|b| -b), acceleration);
    }
    if let Some(jerk) = limits.jerk {
        let jerk = steps(jerk) * n * n * n;
        hold([0.0, 0.0, 1.0], jerk);
        hold([0.0, 0.0, -1.0], jerk);
    }
    let jump = steps(limits.start_speed) * n;
    if first {
        hold([1.0, -0.5 / n, 1.0 / (3.0 * n * n)], jump);
    }
    if last {
        hold([1.0, 1.0 - 0.5 / n, 0.5 - (1.0 - 1.0 / (3.0 * n)) / n], jump);
    }
    if jump == 0.0 {
        // A move that starts at V = 0 can only accelerate there, and one that ends at V = 0 only
        // decelerate.
        if first {
            hold([0.0, -1.0, 0.0], 0.0);
        }
        if last {
            hold([0.0, 1.0, (n - 1.0) / n], 0.0);
        }
    }
}
