//! A curve thinned out for a picture: the least and the greatest value of each of many short stretches.

/// A point of a curve: time in s, and a value.
pub(crate) type Point = (f64, f64);

/// Keeps two points a stretch, however many are put in; what sticks out stays.
#[derive(Debug, Clone)]
pub(crate) struct Thin {
    stretch_s: f64,
    stretches: Vec<Option<[Point; 2]>>,
}

impl Thin {
    /// For times from 0 to `span_s`, in `count` stretches.
    pub(crate) fn new(span_s: f64, count: usize) -> Self {
        Self { stretch_s: span_s.max(f64::MIN_POSITIVE) / count as f64, stretches: vec![None; count] }
    }

    pub(crate) fn add(&mut self, point: Point) {
        // a cast to usize stops at its ends: early and late points go to the first and the last stretch
        let index = ((point.0 / self.stretch_s) as usize).min(self.stretches.len() - 1);
        match &mut self.stretches[index] {
            None => self.stretches[index] = Some([point, point]),
            Some([least, greatest]) => {
                if point.1 < least.1 {
                    *least = point;
                }
                if point.1 > greatest.1 {
                    *greatest = point;
                }
            }
        }
    }

    /// What is left, in order of time but for the two points of a stretch.
    pub(crate) fn points(&self) -> impl Iterator<Item = Point> + '_ {
        self.stretches.iter().flatten().flat_map(|&[least, greatest]| {
            let second = (least != greatest).then_some(greatest);
            std::iter::once(least).chain(second)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extremes_survive() {
        let mut thin = Thin::new(1.0, 10);
        for k in 0..10_000 {
            let t = f64::from(k) / 10_000.0;
            thin.add((t, if k == 4321 { 99.0 } else { t }));
        }
        thin.add((1.5, -3.0));
        let points: Vec<Point> = thin.points().collect();
        assert!(points.len() <= 20);
        assert!(points.contains(&(0.4321, 99.0)));
        assert!(points.contains(&(1.5, -3.0)));
    }
}
