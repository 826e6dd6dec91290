//! Finds the best cubic under constraints: a linear programme in three coefficients and the error,
//! solved by exchange.
//!
//! E. Remez (1934) keeps a set of points at which the error alternates and exchanges one of them
//! for the point with the greatest error until none is greater. With four points and bounds among
//! them this is the dual simplex method. It starts from an alternation, so that no first solution
//! has to be searched.
//!
//! The constants may be tuned: the caller judges the rounded integers, not the level that is found
//! here. The 4x4 matrix is inverted by hand: an exchange updates the inverse in place, and a
//! release of a library of linear algebra could change its roundings, and with them plans.

/// One linear constraint on the three unknowns x and the level: `at` x - `error` level <= `most`.
///
/// Two such rows, above and below, hold the cubic near a sample. A row with an `error` of 0 is a
/// bound, which holds whatever the level.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Row {
    /// Coefficients of the three unknowns.
    pub at: [f64; 3],
    /// The weight of the level in this row: 1 for a sample, 0 for a bound.
    pub error: f64,
    /// Right-hand side of the constraint.
    pub most: f64,
}

/// Three coefficients, and the greatest error that they leave.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Best {
    pub coefficients: [f64; 3],
    pub level: f64,
}

/// Exchanges after which a programme counts as infeasible; a usual one takes ten.
const ROUNDS: usize = 64;

/// The excess of a row that counts as float rounding.
const NOISE: f64 = 1e-9;

/// Returns the coefficients with the least level. `start` names four rows, by index, that
/// alternate: samples in order of time, above and below in turn. Returns `None` if the bounds
/// contradict each other, if the start rows are linearly dependent, or after 64 exchanges.
pub(crate) fn solve(rows: &[Row], start: [usize; 4]) -> Option<Best> {
    let mut basis = start;
    let mut inverse = invert(basis.map(|i| wide(&rows[i])))?;
    for _ in 0..ROUNDS {
        let most = basis.map(|i| rows[i].most);
        let z: [f64; 4] = std::array::from_fn(|r| dot(inverse[r], most));
        let excess = |row: &Row| dot(wide(row), z) - row.most;
        let (worst, excess) = rows
            .iter()
            .map(excess)
            .enumerate()
            .fold((0, NOISE), |best, now| if now.1 > best.1 { now } else { best });
        if excess <= NOISE {
            return Some(Best { coefficients: [z[0], z[1], z[2]], level: z[3] });
        }
        // Writes the entering row as a combination of the basis rows. The dual multipliers of the
        // basis are the last row of the inverse, negated.
        let entering = wide(&rows[worst]);
        let share: [f64; 4] =
            std::array::from_fn(|c| (0..4).map(|r| entering[r] * inverse[r][c]).sum());
        let ratio = |c: usize| -inverse[3][c] / share[c];
        let leaving =
            (0..4).filter(|&c| share[c] > 1e-12).min_by(|&a, &b| ratio(a).total_cmp(&ratio(b)))?;
        basis[leaving] = worst;
        for row in &mut inverse {
            let pivot = row[leaving] / share[leaving];
            for c in 0..4 {
                row[c] = if c == leaving { pivot } else { row[c] - share[c] * pivot };
            }
        }
    }
    None
}

fn wide(row: &Row) -> [f64; 4] {
    [row.at[0], row.at[1], row.at[2], -row.error]
}

fn dot(a: [f64; 4], b: [f64; 4]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
}

/// Inverts a matrix by Gauss-Jordan elimination with column pivots; `None` if it is singular.
fn invert(mut matrix: [[f64; 4]; 4]) -> Option<[[f64; 4]; 4]> {
    let mut inverse: [[f64; 4]; 4] =
        std::array::from_fn(|r| std::array::from_fn(|c| f64::from(u8::from(r == c))));
    for column in 0..4 {
        let pivot = (column..4)
            .max_by(|&a, &b| matrix[a][column].abs().total_cmp(&matrix[b][column].abs()))?;
        let value = matrix[pivot][column];
        if value == 0.0 || !value.is_finite() {
            return None;
        }
        matrix.swap(column, pivot);
        inverse.swap(column, pivot);
        matrix[column] = matrix[column].map(|x| x / value);
        inverse[column] = inverse[column].map(|x| x / value);
        let (held, held_inverse) = (matrix[column], inverse[column]);
        for r in (0..4).filter(|&r| r != column) {
            let factor = matrix[r][column];
            for c in 0..4 {
                matrix[r][c] -= factor * held[c];
                inverse[r][c] -= factor * held_inverse[c];
            }
        }
    }
    Some(inverse)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The two rows that bound the error at `s` on both sides, for coefficients of s, s^2 and s^3.
    fn point(s: f64, value: f64) -> [Row; 2] {
        [1.0, -1.0].map(|sign| Row {
            at: [s, s * s, s * s * s].map(|b| sign * b),
            error: 1.0,
            most: sign * value,
        })
    }

    fn samples(of: impl Fn(f64) -> f64) -> Vec<Row> {
        (1..=64).flat_map(|i| point(f64::from(i) / 64.0, of(f64::from(i) / 64.0))).collect()
    }

    #[test]
    fn a_sampled_cubic_is_recovered_exactly() {
        let best =
            solve(&samples(|s| 3.0 * s - 2.0 * s * s + s * s * s), [0, 43, 84, 127]).unwrap();
        assert!(best.level.abs() < 1e-12, "{best:?}");
        assert!((best.coefficients[1] + 2.0).abs() < 1e-9);
    }

    #[test]
    fn error_of_a_fitted_quartic_equals_the_chebyshev_bound() {
        // The cubic is 0 at s = 0, where the error is 0 too. The error curve is Chebyshev's T4 from
        // its first zero on, scaled to [0, 1]: its amplitude is (1 + cos(pi/8))^-4 / 8.
        let best = solve(&samples(|s| s.powi(4)), [0, 43, 84, 127]).unwrap();
        let theory = ((1.0 + (std::f64::consts::PI / 8.0).cos()) / 2.0).powi(-4) / 128.0;
        assert!((best.level / theory - 1.0).abs() < 5e-3, "{} {theory}", best.level);
    }

    #[test]
    fn bounds_hold_at_any_level_and_contradicting_bounds_give_none() {
        let mut rows = samples(|s| s);
        rows.push(Row { at: [1.0, 0.0, 0.0], error: 0.0, most: 0.25 });
        let best = solve(&rows, [0, 43, 84, 127]).unwrap();
        assert!(best.coefficients[0] <= 0.25 + 1e-9 && best.level > 0.01, "{best:?}");
        rows.push(Row { at: [-1.0, 0.0, 0.0], error: 0.0, most: -0.5 });
        assert_eq!(solve(&rows, [0, 43, 84, 127]), None);
    }
}
