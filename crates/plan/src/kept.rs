//! Fits that are kept by the shape of a ramp and by the size of the tolerance beside its duration.
//!
//! In its own units, from 0 to 1 in time and in distance, a ramp of a shape is always the same
//! curve. A fit in these units therefore serves every ramp of the shape whose tolerance, as a part
//! of its duration, is at least that of the fit. `scaled.rs` turns it into the integers of a move
//! and judges these for that move; nothing here has to be trusted.
//!
//! A kept fit is computed from its [`Key`] alone and never from a move, so that plans do not depend
//! on the moves that were planned before. The constants may be tuned; they change segments, not
//! the tolerance.

use crate::corridor::{Corridor, JOINT};
use crate::demand::Clock;
use crate::fit::Fitter;
use crate::limits::ExactLimits;
use crate::own::Kept;
use crate::search::Search;
use crate::share::Piece;
use crate::units;
use carrystep_core::StartPhase;
use carrystep_profile::{OwnRamp, Shape};
use std::collections::BTreeMap;
use std::sync::{Arc, PoisonError, RwLock};

/// The greatest number of fits that a process keeps. A fit of an ordinary tolerance has 10 kB.
const MOST_KEPT: usize = 1024;

/// Bits of the mantissa by which tolerances are told apart: 32 steps in each octave, so that a fit
/// wastes at most 3 % of the tolerance, which is 0.8 % of the length of a segment.
const TOLERANCE_BITS: u32 = 5;

/// Bits of the mantissa by which the distances of ramps are told apart. The edges of a ramp are
/// where its steps are; near rest they are so far apart that a fit has to know their places.
const DISTANCE_BITS: u32 = 5;

/// The tolerances that are kept, as parts of the duration of a ramp. A ramp with a greater one has
/// few ticks, and one with a smaller one very many segments.
const TOLERANCES: std::ops::Range<f64> = 5e-11..2.5e-4;

/// The distances that are kept, steps.
const DISTANCES: std::ops::Range<f64> = 56.0..1e9;

/// The least number of steps of a kept ramp for each segment that it takes, roughly: the number of
/// segments grows with the inverse fourth root of the tolerance. A fit that knows each edge has
/// fewer segments where edges are few.
const EDGES: f64 = 4.0;

/// The part by which the top speed of a ramp is below the speed limit, if the limit does not
/// restrict its fit.
const BELOW: f64 = 1.0 / 256.0;

/// The part of the tolerance for which a fit is made. The rest is for breakpoints that are rounded
/// to ticks.
const SPARED: f64 = 0.995;

/// The least number of ticks of the ramp that is fitted for all others of its key.
const LEAST_TICKS: u64 = 1 << 14;

/// The least ratio of its ticks to its steps: its top speed must be below half a step per tick,
/// which is what the register of V holds.
const SLOW: f64 = 8.0;

/// A kept fit is searched more thoroughly than one of a single move: it serves many, and has a part
/// of the tolerance less.
const THOROUGH: Search = Search { full: 0.984, aim: 0.98, enough: 0.972, close: 400, to_end: true };

/// What else the fit may leave at a joint, as a fraction of the tolerance, if that saves a segment.
const OTHER_JOINTS: [f64; 2] = [0.9, 0.6];

/// The least length of a segment of that ramp, ticks.
const LEAST_LENGTH: u64 = 64;

/// What a kept fit is computed from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Key {
    shape: Shape,
    /// The leading bits of the tolerance as a part of the duration.
    tolerance: u64,
    /// The leading bits of the distance in steps.
    distance: u64,
    /// Whether the first edge is half a step from rest, and not a whole one.
    half: bool,
    /// Whether the speed limit is just above the top speed.
    capped: bool,
}

impl Key {
    /// The key for a ramp of `ticks` ticks with a tolerance in ticks, whose axis may travel
    /// `fastest` steps in a tick. `None` if no fit is kept for such a ramp.
    pub fn new(
        ramp: &OwnRamp,
        ticks: f64,
        tolerance: f64,
        phase: StartPhase,
        [top, fastest]: [f64; 2],
    ) -> Option<Self> {
        let part = tolerance / ticks;
        let edges = ramp.distance / EDGES;
        let kept = TOLERANCES.contains(&part)
            && DISTANCES.contains(&ramp.distance)
            && edges.powi(4) * part >= 1.0;
        kept.then(|| Self {
            shape: ramp.shape,
            tolerance: leading(part, TOLERANCE_BITS),
            distance: leading(ramp.distance, DISTANCE_BITS),
            half: phase == StartPhase::Half,
            capped: fastest < top * (1.0 + BELOW),
        })
    }

    /// The fit of this key. It is computed if this process does not keep it yet. `None` if the
    /// tolerance allows no fit of segments of a sensible length.
    pub fn kept(self) -> Option<Arc<Kept>> {
        static STORE: RwLock<BTreeMap<Key, Option<Arc<Kept>>>> = RwLock::new(BTreeMap::new());
        if let Some(kept) = STORE.read().unwrap_or_else(PoisonError::into_inner).get(&self) {
            return kept.clone();
        }
        let kept = self.fit().map(Arc::new);
        let mut store = STORE.write().unwrap_or_else(PoisonError::into_inner);
        if store.len() >= MOST_KEPT {
            store.clear();
        }
        store.insert(self, kept.clone());
        kept
    }

    /// Fits the shortest ramp of this key, with all places that its edges have in a longer one.
    fn fit(self) -> Option<Kept> {
        let distance = f64::from_bits(self.distance << (52 - DISTANCE_BITS));
        let ticks = ((distance * SLOW) as u64).next_power_of_two().max(LEAST_TICKS);
        let ramp = self.shape.ramp(ticks as f64, distance);
        let top = ramp.top_speed();
        let speed = units::toward_zero(if self.capped { top } else { top * (1.0 + BELOW) })?;
        let limits = ExactLimits {
            start_speed: units::toward_zero(ramp.speed(0.0))?,
            speed,
            acceleration: units::toward_zero(ramp.peak_acceleration())?,
            jerk: None,
            // That of a speed limit of a machine, for the same roundings.
            tolerance: speed / 1_000_000_000,
        };
        let seconds = 2.0 * ticks as f64;
        let longer = 1.0 + (-f64::from(DISTANCE_BITS)).exp2();
        let corridor = Corridor {
            profile: &*ramp,
            clock: Clock { ticks: 2 * ticks, last: 1.0, seconds, tick: 1.0 },
            phase: if self.half { StartPhase::Half } else { StartPhase::Zero },
            backward: false,
            pulses: (distance * longer + 1.0 - if self.half { 0.5 } else { 1.0 }) as u64,
            piece: Piece {
                first: 0,
                ticks,
                start: 0,
                units: units::nearest(distance)?,
                by_pulse: false,
            },
            rises: true,
            tolerance: f64::from_bits(self.tolerance << (52 - TOLERANCE_BITS))
                * ticks as f64
                * SPARED,
            bend: 0.0,
            joint: JOINT,
            longer,
        };
        let mut fitter =
            Fitter { corridor, limits: &limits, rows: Vec::new(), search: THOROUGH, keeps: false };
        let mut fitted = fitter.greedy(0);
        for joint in OTHER_JOINTS {
            // The last segment was divided, because it could not quite reach the end.
            let divided = matches!(&fitted[..], [.., a, b] if a.ticks.abs_diff(b.ticks) <= 8);
            if divided {
                fitter.corridor.joint = joint;
                let other = fitter.greedy(0);
                fitted = if other.len() < fitted.len() { other } else { fitted };
            }
        }
        let sensible = fitted.iter().all(|one| one.ticks >= LEAST_LENGTH);
        if sensible { Kept::of(&fitted, &fitter, &*ramp) } else { None }
    }
}

/// The sign, the exponent and the first `bits` of the mantissa of a float. The float of these bits
/// alone is at most `value`.
fn leading(value: f64, bits: u32) -> u64 {
    value.to_bits() >> (52 - bits)
}
