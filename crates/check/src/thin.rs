//! Thins out a curve for a picture: keeps the least and the greatest value of many short stretches.

/// A point of a curve: time in s, and a value.
pub(crate) type Point = (f64, f64);

/// Keeps two points for each stretch of time, however many are added. Extreme values are kept.
#[derive(Debug, Clone)]
pub(crate) struct Thin {
    stretch_s: f64,
    stretches: Vec<Option<[Point; 2]>>,
}

impl Thin {
    /// Divides the times from 0 to `span_s` seconds into `count` stretches.
    pub(crate) fn new(span_s: f64, count: usize) -> Self {
        Self {
            stretch_s: span_s.max(f64::MIN_POSITIVE) / count as f64,
            stretches: vec![None; count],
        }
    }

    pub(crate) fn add(&mut self, point: Point) {
        // A cast to usize saturates: earlier and later points go to the first and the last stretch.
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

    /// The points that were kept, in order of time except for the two points of one stretch.
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
    fn extreme_values_are_kept() {
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
