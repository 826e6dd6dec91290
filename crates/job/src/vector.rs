//! Points and directions of N coordinates, and the few operations on them that planning needs.

/// A point, a difference of points, or one of their derivatives: one number for each coordinate.
pub(crate) type Point<const N: usize> = [f64; N];

/// a + s b.
#[inline]
pub(crate) fn plus<const N: usize>(a: &Point<N>, s: f64, b: &Point<N>) -> Point<N> {
    std::array::from_fn(|i| a[i] + s * b[i])
}

/// b - a.
#[inline]
pub(crate) fn from_to<const N: usize>(a: &Point<N>, b: &Point<N>) -> Point<N> {
    std::array::from_fn(|i| b[i] - a[i])
}

/// The scalar product.
#[inline]
pub(crate) fn dot<const N: usize>(a: &Point<N>, b: &Point<N>) -> f64 {
    (0..N).map(|i| a[i] * b[i]).sum()
}

/// The Euclidean length.
#[inline]
pub(crate) fn norm<const N: usize>(a: &Point<N>) -> f64 {
    dot(a, a).sqrt()
}

/// The sum of points with weights, the first weight for the first point.
#[inline]
pub(crate) fn weighted<const N: usize>(weights: &[f64], points: &[Point<N>]) -> Point<N> {
    let mut sum = [0.0; N];
    for (weight, point) in weights.iter().zip(points) {
        for (total, x) in sum.iter_mut().zip(point) {
            *total += weight * x;
        }
    }
    sum
}
