//! The greatest rates along planned rows that overrides and limits allow.
//!
//! ```text
//! greatest rate of each row   ==  the feed allows so much, and the limits at an unchanging rate
//! least of the neighbours     --  so that the rate has room to change before the row
//! backward, then forward      \/  it changes only as fast as the accelerations allow
//! mean of the neighbours      ..  it has no corners
//! ```
//!
//! These are floats with margins. The rows that follow from them are checked exactly.

use super::rates::Rates;
use super::track::Track;
use crate::row::Row;
use carrystep_core::Segment;
use carrystep_plan::exact::ExactLimits;

/// The part of a limit that a rate above 1 may use; each try uses less.
const PARTS: [f64; 4] = [0.9, 0.7, 0.45, 0.2];
/// The part of a speed that may be used where the rate is not the same everywhere.
const NEARLY: f64 = 0.995;
/// By how much the acceleration and the jerk of a spline through samples may overshoot those of the
/// motion, where the jerk changes between the samples: 1.04 and 1.55 were found.
const OVERSHOOT: [f64; 2] = [1.05, 1.6];
/// The greatest change of the rate from one row to the next, as a part of the rate.
const STEEPEST: f64 = 0.25;

/// Rows at the end of a window in which the rate is at most [`SAFE`], so that the plan can go on there.
const TAIL: usize = 48;

/// An unchanging rate of so much keeps all limits, whatever the plan does: its cube is 1 / 1.6.
const SAFE: f64 = 0.85;

/// Number of tries: each allows less than the one before.
pub(super) const TRIES: usize = PARTS.len();

/// What decides the rates.
#[derive(Debug, Clone)]
pub(super) struct Rules {
    pub limits: Vec<ExactLimits>,
    /// Of each motor, mm/s for a speed of one unit per tick; 0 for all but the first motor of a
    /// letter; `None` for rotary ones.
    pub linear: Vec<Option<f64>>,
    /// Factors of the feed and of rapid moves.
    pub feed: f64,
    pub rapid: f64,
    /// Rows at each side over which rates are averaged.
    pub width: usize,
}

/// A motor at one tick: speed and acceleration.
#[derive(Debug, Clone, Copy)]
struct Instant {
    speed: f64,
    acceleration: f64,
}

fn instant(one: &Segment, tick: f64) -> Instant {
    let [v, a, j] = [one.v, one.a, one.j].map(|value| value as f64);
    let speed = v + (2.0 * tick - 1.0) / 2.0 * a + (3.0 * tick * tick - 6.0 * tick + 2.0) / 6.0 * j;
    Instant { speed, acceleration: a + (tick - 1.0) * j }
}

impl Rules {
    /// The rates of the rows from `first` up to `end`. Behind `end` the motion rests if `ends` is
    /// true; otherwise the rate there is at most 1.
    pub fn target(
        &self,
        track: &Track,
        (first, end, ends): (u64, u64, bool),
        attempt: usize,
    ) -> Rates {
        let part = PARTS[attempt.min(TRIES - 1)];
        let width = self.width * (attempt + 1);
        let rows = (first..end).filter_map(|number| track.row(number));
        let most: Vec<f64> = rows.clone().map(|row| self.most(row, part)).collect();
        let count = most.len();
        let around =
            |index: usize, by: usize| index.saturating_sub(by)..(index + by + 1).min(count);
        let least = |index| most[around(index, width + 1)].iter().copied().fold(f64::MAX, f64::min);
        let mut rates: Vec<f64> = (0..count).map(least).collect();
        let tail = if ends { count } else { count.saturating_sub(TAIL + 2 * width) };
        let safe = if self.feed < 1.0 || self.rapid < 1.0 { SAFE } else { 1.0 };
        rates.iter_mut().skip(tail).for_each(|rate| *rate = rate.min(safe));
        let rows: Vec<&Row> = rows.collect();
        for index in (1..count).rev() {
            let change = self.change(rows[index - 1], rates[index], -1.0, part);
            rates[index - 1] = rates[index - 1].min(rates[index] + change);
        }
        for index in 1..count {
            let change = self.change(rows[index - 1], rates[index - 1], 1.0, part);
            rates[index] = rates[index].min(rates[index - 1] + change);
        }
        let mean = |index| {
            let near = &rates[around(index, width)];
            near.iter().sum::<f64>() / near.len() as f64
        };
        Rates { first, values: (0..count).map(mean).collect() }
    }

    /// The greatest unchanging rate in a row.
    fn most(&self, row: &Row, part: f64) -> f64 {
        let end = f64::from(row.ticks);
        let mut most = f64::MAX;
        let mut square = 0.0_f64;
        let mut turns = false;
        let places = [0.0, 0.25, 0.5, 0.75, 1.0].map(|part| part * end);
        for place in places {
            let mut sum = 0.0;
            let motors = self.limits.iter().zip(&self.linear).zip(&row.segments);
            for ((limits, linear), one) in motors {
                let Instant { speed, acceleration } = instant(one, place);
                let (speed, acceleration) = (speed.abs(), acceleration.abs());
                let [bends, jerks] = OVERSHOOT;
                // A rate of 1 and less may use the whole limit.
                let part = |rate: f64| if rate > 1.0 { part } else { 1.0 };
                let jerk = limits.jerk.map_or(f64::MAX, |jerk| jerk as f64);
                let free = |limit: f64, value: f64, root: f64| {
                    let rate = (limit / value).powf(root);
                    (limit * part(rate) / value).powf(root)
                };
                most = most
                    .min(limits.speed as f64 * NEARLY / speed)
                    .min(free(limits.acceleration as f64 / bends, acceleration, 0.5))
                    .min(free(jerk / jerks, (one.j as f64).abs(), 1.0 / 3.0));
                match linear {
                    Some(unit) => sum += (speed * unit).powi(2),
                    None => turns |= speed > 0.0,
                }
            }
            square = square.max(sum);
        }
        if row.feed.is_infinite() {
            return if self.rapid < 1.0 { most.min(self.rapid) } else { 1.0 };
        }
        // Where the motion is slower than the feed, it need not be slowed down as much.
        let path = square.sqrt();
        let free = if turns || path == 0.0 { 0.0 } else { row.feed * self.feed / path * NEARLY };
        let feed = if self.feed > 1.0 { (self.feed * NEARLY).max(1.0) } else { self.feed };
        let most = most.min(free.max(feed)).min(feed.max(1.0));
        // The plan's own rows are lawful.
        if self.feed < 1.0 { most } else { most.max(1.0) }
    }

    /// By how much the rate may change from one row to the next where it is `rate` at the end of a
    /// row: upward in the direction of time with `way` 1, against it with -1.
    fn change(&self, row: &Row, rate: f64, way: f64, part: f64) -> f64 {
        let ticks = f64::from(row.ticks);
        let motors = self.limits.iter().zip(&row.segments).map(|(limits, one)| {
            let Instant { speed, acceleration } = instant(one, ticks);
            let used = way * speed.signum() * acceleration * rate * rate;
            let left = limits.acceleration as f64 * part - used;
            (left * ticks / (speed.abs() * rate)).max(0.0)
        });
        motors.fold(STEEPEST * rate, f64::min)
    }
}
