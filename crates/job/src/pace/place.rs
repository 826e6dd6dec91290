//! Places of the planned motion, and how the motion goes on from there.

use super::rates::Rates;
use super::track::Track;

/// Steps of the integration in a row.
const STEPS: u32 = 4;

/// A place on the track.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    /// The planned row.
    pub row: u64,
    /// Planned ticks behind its beginning.
    pub tick: f64,
}

impl Place {
    /// So many planned ticks further on.
    fn plus(self, track: &Track, ticks: f64) -> Self {
        let Self { mut row, tick } = self;
        let mut tick = tick + ticks;
        while let Some(length) = track.row(row).map(|row| f64::from(row.ticks)) {
            if tick < length {
                break;
            }
            tick -= length;
            row += 1;
        }
        Self { row, tick }
    }

    /// Planned ticks per tick.
    pub fn rate(self, track: &Track, rates: &Rates) -> f64 {
        let length = track.row(self.row).map_or(1.0, |row| f64::from(row.ticks));
        rates.rate(self.row, (self.tick / length).min(1.0))
    }

    /// Where the motion is so many ticks later, after Runge and Kutta.
    pub fn later(self, track: &Track, rates: &Rates, ticks: u32) -> Self {
        let step = f64::from(ticks) / f64::from(STEPS);
        (0..STEPS).fold(self, |at, _| {
            let rate = |by: f64| at.plus(track, by).rate(track, rates);
            let a = rate(0.0);
            let b = rate(a * step / 2.0);
            let c = rate(b * step / 2.0);
            let d = rate(c * step);
            at.plus(track, (a + 2.0 * b + 2.0 * c + d) / 6.0 * step)
        })
    }

    /// P of each motor from `base`, as floats in units of 2^-64 step.
    pub fn sample(self, track: &Track, base: &[i128]) -> Option<Vec<f64>> {
        let begin = track.at(self.row)?;
        let segments = track.segments(Some(self.row), base.len());
        let motors = begin.iter().zip(base).zip(&segments);
        Some(
            motors
                .map(|((&begin, &base), one)| {
                    let [v, a, j] = [one.v, one.a, one.j].map(|value| value as f64);
                    let n = self.tick;
                    let gone = n * (v + (n - 1.0) / 2.0 * (a + (n - 2.0) / 3.0 * j));
                    (begin - base) as f64 + gone
                })
                .collect(),
        )
    }
}
