//! Speed, acceleration and jerk over time, as the least and the greatest value of each of many
//! equal stretches. When there are too many stretches, two neighbours become one.

use crate::split::part;
use carrystep_core::Segment;
use carrystep_plan::exact::speeds;

/// Most stretches.
const MOST: usize = 2048;

/// One stretch of time.
#[derive(Debug, Clone)]
struct Stretch {
    /// Least and greatest value of each curve.
    range: Vec<[f64; 2]>,
    /// Ticks of each cause.
    ticks: Vec<u64>,
}

impl Stretch {
    fn new(curves: usize, causes: usize) -> Self {
        Self { range: vec![[f64::INFINITY, f64::NEG_INFINITY]; curves], ticks: vec![0; causes] }
    }

    fn see(&mut self, curve: usize, value: f64) {
        let [low, high] = &mut self.range[curve];
        (*low, *high) = (low.min(value), high.max(value));
    }

    fn with(mut self, other: &Self) -> Self {
        for (mine, [low, high]) in self.range.iter_mut().zip(&other.range) {
            *mine = [mine[0].min(*low), mine[1].max(*high)];
        }
        for (mine, ticks) in self.ticks.iter_mut().zip(&other.ticks) {
            *mine += ticks;
        }
        self
    }
}

/// The curves of a plan: speed along the path, then speed, acceleration and jerk of each axis.
#[derive(Debug, Clone)]
pub(crate) struct Charts {
    scale: Vec<[f64; 3]>,
    causes: usize,
    /// Ticks of a stretch.
    width: u64,
    /// Ticks of the last stretch that are filled.
    filled: u64,
    stretches: Vec<Stretch>,
}

impl Charts {
    /// `scale` has for each axis the factors from V, A and J to its unit and seconds.
    pub fn new(scale: &[[f64; 3]], causes: usize) -> Self {
        Self { scale: scale.to_vec(), causes, width: 1, filled: 1, stretches: Vec::new() }
    }

    /// Ticks of a stretch.
    pub fn width(&self) -> u64 {
        self.width
    }

    /// Number of curves.
    fn curves(&self) -> usize {
        1 + 3 * self.scale.len()
    }

    /// Adds a row. Its speed along the path changes from the first value to the last one.
    pub fn add(&mut self, segments: &[Segment], ticks: u32, cause: usize, speed: [f64; 3]) {
        let mut done = 0;
        while done < ticks {
            if self.filled == self.width {
                self.next();
            }
            let now = u64::from(ticks - done).min(self.width - self.filled) as u32;
            let (curves, causes) = (self.curves(), self.causes);
            let at = |tick: u32| {
                let t = f64::from(tick) / f64::from(ticks);
                let [a, b, c] = speed;
                // The parabola through the three values.
                a + t * (4.0 * b - 3.0 * a - c) + t * t * (2.0 * (a + c) - 4.0 * b)
            };
            let ends = [at(done).max(0.0), at(done + now).max(0.0)];
            let Some(stretch) = self.stretches.last_mut() else { return };
            debug_assert_eq!((stretch.range.len(), stretch.ticks.len()), (curves, causes));
            stretch.ticks[cause] += u64::from(now);
            ends.into_iter().for_each(|value| stretch.see(0, value));
            for (axis, segment) in segments.iter().enumerate() {
                let [of_v, of_a, of_j] = self.scale[axis];
                let segment = part(segment, done, now);
                let first = 1 + 3 * axis;
                speeds(&segment).for_each(|v| stretch.see(first, v as f64 * of_v));
                let last = i128::from(segment.a) + i128::from(now - 1) * i128::from(segment.j);
                stretch.see(first + 1, segment.a as f64 * of_a);
                stretch.see(first + 1, last as f64 * of_a);
                stretch.see(first + 2, segment.j as f64 * of_j);
            }
            self.filled += u64::from(now);
            done += now;
        }
    }

    /// Begins a stretch.
    fn next(&mut self) {
        if self.stretches.len() == MOST {
            let mut pairs = std::mem::take(&mut self.stretches).into_iter();
            while let (Some(first), Some(second)) = (pairs.next(), pairs.next()) {
                self.stretches.push(first.with(&second));
            }
            self.width *= 2;
        }
        self.stretches.push(Stretch::new(self.curves(), self.causes));
        self.filled = 0;
    }

    /// The values of a curve: least and greatest of each stretch.
    pub fn curve(&self, curve: usize) -> impl Iterator<Item = [f64; 2]> {
        self.stretches.iter().map(move |stretch| stretch.range[curve])
    }

    /// The cause that takes most of each stretch.
    pub fn bounds(&self) -> impl Iterator<Item = usize> {
        self.stretches.iter().map(|stretch| {
            let most = stretch
                .ticks
                .iter()
                .enumerate()
                .max_by_key(|&(number, ticks)| (ticks, std::cmp::Reverse(number)));
            most.map_or(0, |(number, _)| number)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extreme_values_are_kept_however_long_it_lasts() {
        let mut charts = Charts::new(&[[1.0; 3]], 2);
        for row in 0..20_000 {
            let peak = row == 12_345;
            let j = if peak { 5 } else { 0 };
            let segment = Segment { ticks: 700, v: row, a: 0, j, last: false };
            charts.add(&[segment], 700, usize::from(peak), [row as f64; 3]);
        }
        let all = |curve| charts.curve(curve).reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]);
        assert!(charts.curve(0).count() <= MOST);
        let top = 12_345 + 699 * 698 / 2 * 5;
        assert_eq!(all(1), Some([0.0, f64::from(top)]));
        assert_eq!(all(2), Some([0.0, 699.0 * 5.0]));
        assert_eq!(all(3), Some([0.0, 5.0]));
        assert_eq!(charts.width(), 8192);
        // 14 000 000 ticks in stretches of 8192, of which the peak takes only a part of one.
        assert_eq!(charts.bounds().count(), 1709);
        assert!(charts.bounds().all(|bound| bound == 0));
        let second = charts.curve(0).nth(1).unwrap();
        assert_eq!(second, [8192.0_f64.div_euclid(700.0), 16383.0_f64.div_euclid(700.0)]);
    }
}
