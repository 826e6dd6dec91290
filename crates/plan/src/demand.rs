//! Determines how long a move takes, and the profile of each axis in that time.
//!
//! The rules of each kind of profile are in `kinds.rs` of the crate `profile`.

use crate::asked::Asked;
use crate::error::PlanError;
use crate::line;
use arrayvec::ArrayVec;
use bigdecimal::{BigDecimal, RoundingMode, ToPrimitive, Zero};
use carrystep_core::engine::SEGMENT_WORDS;
use carrystep_core::{AXES, StartPhase, Timebase};
use carrystep_files::{Machine, PathKind};
use carrystep_profile::{Constant, LimitRefusal, Limits, Real, SharedProfile, kinds};
use std::sync::Arc;

/// The greatest number of ticks of a move: 2^42, which is 1.1 x 10^6 s at 250 ns. Up to there the
/// closed forms stay inside an i128 and the segments fit in memory.
const MOST_TICKS: u64 = 1 << 42;

/// One entry for each axis of a machine whose moves are planned.
pub(crate) type PerAxis<T> = ArrayVec<T, AXES>;

/// The duration of a move.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Clock<F> {
    /// Whole ticks; the last one may be used only in part.
    pub ticks: u64,
    /// The fraction of the last tick that the move uses, above 0 and at most 1.
    pub last: F,
    /// Duration of the move, seconds.
    pub seconds: F,
    /// Length of a tick, seconds.
    pub tick: F,
}

impl<F: Real> Clock<F> {
    /// Seconds from the start of the move to the start of tick `n` (counted from 0), limited to the
    /// end of the move.
    pub fn at(&self, n: u64) -> F {
        (float::<F>(n) * self.tick).min(self.seconds)
    }
}

/// Converts a whole number to the nearest float.
pub(crate) fn float<F: Real>(n: u64) -> F {
    F::from(n).unwrap_or_else(F::nan)
}

/// Returns the common duration of all axes and the profile of each: in the given time, or without
/// one as fast as the limits allow, rounded up to whole ticks. `limits` are those of the axes.
///
/// # Errors
/// [`PlanError::Refused`], [`PlanError::NotWholeTicks`] or [`PlanError::TooLong`].
pub(crate) fn demand<F: Real>(
    machine: &Machine,
    limits: &[Limits<F>],
    Asked { index, moved }: Asked<'_>,
    time: Option<&BigDecimal>,
) -> Result<(Clock<F>, PerAxis<SharedProfile<F>>), PlanError> {
    let timebase = machine.timebase;
    let own: PerAxis<(F, Limits<F>)> = (limits.iter().zip(&moved.steps))
        .map(|(&limits, steps)| (float(steps.unsigned_abs()), limits))
        .collect();
    let straight = moved.path == PathKind::Straight;
    let mut axes = own.clone();
    if straight {
        line::share_limits(moved.profile, &mut axes);
    }
    let refused = |axis: usize, refusal: LimitRefusal, least_time| {
        let (axis, refusal) = if straight {
            line::blame(moved.profile, &own, axis, refusal)
        } else {
            (axis, refusal)
        };
        let carrystep_files::Axis { name, unit, .. } = &machine.axes[axis];
        PlanError::Refused { index, axis: name.clone(), refusal, unit: unit.clone(), least_time }
    };

    let mut least = F::zero();
    let mut fastest = PerAxis::new();
    for (axis, (steps, limits)) in axes.iter().enumerate() {
        if steps.is_zero() {
            fastest.push(None);
            continue;
        }
        let found = kinds::fastest(moved.profile, *steps, limits)
            .map_err(|refusal| refused(axis, refusal, None))?;
        least = least.max(found.time);
        fastest.push(Some(found));
    }
    let clock = match time {
        Some(time) => given(time, &timebase, machine.phase, index)?,
        None => whole(least, &timebase, index)?,
    };
    let rests = axes.iter().all(|(steps, _)| steps.is_zero());
    let clock = if rests && clock.ticks < LEAST_TICKS {
        let shortest = F::from(seconds(LEAST_TICKS, &timebase)).unwrap_or_else(F::nan);
        whole(shortest, &timebase, index)?
    } else {
        clock
    };

    // Where several axes refuse the time, the error names the slowest one: its least time works for
    // all axes.
    let mut worst: Option<(usize, LimitRefusal)> = None;
    let mut profiles: PerAxis<SharedProfile<F>> = PerAxis::new();
    for (axis, ((steps, limits), fastest)) in axes.iter().zip(&fastest).enumerate() {
        let Some(fastest) = fastest else {
            profiles.push(Arc::new(Constant::rest(clock.seconds)));
            continue;
        };
        match kinds::after(moved.profile, *steps, clock.seconds, limits, fastest) {
            Ok(profile) => profiles.push(profile),
            Err(refusal) => {
                if worst.is_none_or(|(_, other)| other.least_time < refusal.least_time) {
                    worst = Some((axis, refusal));
                }
            }
        }
    }
    match worst {
        None => Ok((clock, profiles)),
        Some((axis, refusal)) => {
            let ticks = whole(least, &timebase, index)?.ticks;
            Err(refused(axis, refusal, Some(seconds(ticks, &timebase))))
        }
    }
}

fn seconds(ticks: u64, timebase: &Timebase) -> f64 {
    (u128::from(ticks) * u128::from(timebase.tick_ns())) as f64 / 1e9
}

/// Fewest ticks of a move without distance, so that any number of them can follow each other. The
/// host sends the engine a segment of each axis in eight ticks, and the engine takes a start at one
/// strobe and follows it at a later one.
const LEAST_TICKS: u64 = SEGMENT_WORDS as u64 + 1 + 2;

/// Rounds `least` seconds up to whole ticks, at least one.
fn whole<F: Real>(least: F, timebase: &Timebase, index: usize) -> Result<Clock<F>, PlanError> {
    let tick = F::from(timebase.tick_seconds()).unwrap_or_else(F::nan);
    let exact = least / tick;
    let nearest = exact.round();
    // A time that differs from whole ticks only by float rounding does not cost another tick.
    let noise = F::epsilon() * float(8) * exact;
    let rounded = if (exact - nearest).abs() <= noise { nearest } else { exact.ceil() };
    let ticks = rounded.to_u64().unwrap_or(u64::MAX).max(1);
    if ticks > MOST_TICKS {
        let seconds = least.to_f64().unwrap_or(f64::NAN);
        return Err(PlanError::TooLong { index, seconds, tick_ns: timebase.tick_ns() });
    }
    let seconds = F::from(seconds(ticks, timebase)).unwrap_or_else(F::nan);
    Ok(Clock { ticks, last: F::one(), seconds, tick })
}

/// Converts the time of the file to ceil(T / h) ticks, in exact decimals.
fn given<F: Real>(
    time: &BigDecimal,
    timebase: &Timebase,
    phase: StartPhase,
    index: usize,
) -> Result<Clock<F>, PlanError> {
    let tick_ns = timebase.tick_ns();
    let ns = time * BigDecimal::from(1_000_000_000_u64);
    let float = |value: &BigDecimal| value.to_f64().and_then(F::from).unwrap_or_else(F::nan);
    let too_long =
        || PlanError::TooLong { index, seconds: time.to_f64().unwrap_or(f64::NAN), tick_ns };
    let tick = BigDecimal::from(tick_ns);
    // The decimal quotient may be rounded; the remainder is exact and corrects it.
    let mut full = (&ns / &tick).with_scale_round(0, RoundingMode::Floor);
    let mut rest = &ns - &full * &tick;
    if rest < BigDecimal::zero() {
        full -= 1;
        rest += &tick;
    } else if rest >= tick {
        full += 1;
        rest -= &tick;
    }
    let full = full.to_u64().filter(|&n| n < MOST_TICKS).ok_or_else(too_long)?;
    let partial = !rest.is_zero();
    let ticks = full + u64::from(partial);
    if partial && phase == StartPhase::Zero {
        return Err(PlanError::NotWholeTicks {
            index,
            seconds: time.to_f64().unwrap_or(f64::NAN),
            tick_ns,
            rounded: seconds(ticks, timebase),
        });
    }
    Ok(Clock {
        ticks,
        last: if partial { float(&rest) / float(&tick) } else { F::one() },
        seconds: float(time),
        tick: F::from(timebase.tick_seconds()).unwrap_or_else(F::nan),
    })
}
