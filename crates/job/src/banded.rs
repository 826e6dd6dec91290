//! Symmetric positive definite band matrices: factors and solutions.
//!
//! A row holds its diagonal element and the [`BAND`] elements before it. The factors are those of
//! Cholesky without square roots, L D L^T (Golub and Van Loan, Matrix Computations, section 4.3).

use crate::vector::Point;

/// Elements beside the diagonal.
pub(crate) const BAND: usize = 6;

/// Row i of a matrix: element k is that of column i - k.
pub(crate) type Row = [f64; BAND + 1];

/// Adds `weight` times the square of the sum of unknowns `first`, `first + 1`, ... with these
/// coefficients to the quadratic form of a matrix.
pub(crate) fn add_square(rows: &mut [Row], first: usize, coefficients: &[f64], weight: f64) {
    for (i, a) in coefficients.iter().enumerate() {
        for (k, b) in coefficients[..=i].iter().rev().enumerate() {
            rows[first + i][k] += weight * a * b;
        }
    }
}

/// Replaces a matrix by its factors: the inverse of D in element 0, L in the others. Elements of
/// columns before the first one must be 0.
pub(crate) fn factor(rows: &mut [Row]) {
    for i in 0..rows.len() {
        let mut row = rows[i];
        let reach = BAND.min(i);
        for k in (1..=reach).rev() {
            let column = rows[i - k];
            for m in k + 1..=reach {
                row[k] -= row[m] * column[m - k];
            }
        }
        for k in 1..=reach {
            let scaled = row[k] * rows[i - k][0];
            row[0] -= row[k] * scaled;
            row[k] = scaled;
        }
        row[0] = row[0].recip();
        rows[i] = row;
    }
}

/// The factors of N matrices side by side: element k of row i has one number for each matrix.
pub(crate) type Factors<const N: usize> = [[f64; N]; BAND + 1];

/// Solves N systems side by side, in place.
///
/// In both passes the term of the neighbour that was computed last comes last in a sum, so that the
/// other terms need not wait for it. Away from the ends, the compiler knows the number of terms.
pub(crate) fn solve<const N: usize>(factors: &[Factors<N>], x: &mut [Point<N>]) {
    for (i, factor) in factors.iter().enumerate() {
        let (earlier, now) = x.split_at_mut(i);
        let Some(value) = now.first_mut() else { return };
        match earlier.last_chunk::<BAND>() {
            Some(earlier) => {
                (1..=BAND).rev().for_each(|k| minus(value, &factor[k], &earlier[BAND - k]));
            }
            None => (1..=i).rev().for_each(|k| minus(value, &factor[k], &earlier[i - k])),
        }
    }
    for (value, factor) in x.iter_mut().zip(factors) {
        value.iter_mut().zip(&factor[0]).for_each(|(v, d)| *v *= d);
    }
    for i in (0..factors.len()).rev() {
        let (before, later) = x.split_at_mut(i + 1);
        let Some(value) = before.last_mut() else { return };
        let below = &factors[i + 1..];
        match (later.first_chunk::<BAND>(), below.first_chunk::<BAND>()) {
            (Some(later), Some(below)) => {
                (1..=BAND).rev().for_each(|k| minus(value, &below[k - 1][k], &later[k - 1]));
            }
            _ => {
                (1..=below.len()).rev().for_each(|k| minus(value, &below[k - 1][k], &later[k - 1]));
            }
        }
    }
}

/// Takes the products of two points' numbers from those of a third one.
#[inline]
fn minus<const N: usize>(from: &mut Point<N>, a: &Point<N>, b: &Point<N>) {
    (0..N).for_each(|i| from[i] -= a[i] * b[i]);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solution_fulfils_its_equations() {
        let n = 30;
        let mut rows = vec![[0.0; BAND + 1]; n];
        for i in 0..n - 2 {
            add_square(&mut rows, i, &[1.0, -2.0, 1.0], 1.0 + i as f64);
        }
        for i in 0..n - BAND {
            add_square(&mut rows, i, &[0.1, 0.2, 0.4, 0.7, 0.4, 0.2, 0.1], 0.3);
        }
        let right: Vec<Point<1>> = (0..n).map(|i| [(i * i % 7) as f64]).collect();
        let mut factors = rows.clone();
        factor(&mut factors);
        let factors: Vec<Factors<1>> = factors.iter().map(|row| row.map(|x| [x])).collect();
        let mut x = right.clone();
        solve(&factors, &mut x);
        for i in 0..n {
            let before: f64 = (0..=BAND.min(i)).map(|k| rows[i][k] * x[i - k][0]).sum();
            let after: f64 = (1..=BAND.min(n - 1 - i)).map(|k| rows[i + k][k] * x[i + k][0]).sum();
            assert!((before + after - right[i][0]).abs() < 1e-9, "{i}");
        }
    }
}
