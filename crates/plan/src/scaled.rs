//! Gives a kept fit (`kept.rs`) the units of one move: its ticks, its distance and its limits.
//!
//! Breakpoints are rounded to ticks and coefficients to integers as in any other fit. The integers
//! are judged beside the curve of this move, with the tolerance of this move, before they are used
//! (`beside.rs`). If one segment fails, there is no scaled fit, and the piece is fitted as a curve
//! of its own.

use crate::bend::Wanted;
use crate::beside::{Laid, Size};
use crate::cubic::steps;
use crate::fit::Fitter;
use crate::fitted::Fitted;
use crate::kept::Key;
use crate::own::{Kept, Samples};
use carrystep_profile::Real;
use std::sync::Arc;

/// The fewest ticks of a segment. In a shorter one, rounding a breakpoint to a tick matters.
const LEAST_TICKS: u64 = 32;

/// The fraction of the tolerance that a segment may use whose samples stand for many edges. Where
/// each edge is a sample, the segment may use all of it.
const STANDING: f64 = 0.98;

/// The least tolerance, ticks. With a smaller one, most scaled fits fail at a breakpoint that was
/// rounded to a tick, and would have been made in vain.
const LEAST_TOLERANCE: f64 = 0.02;

/// How far the end of a ramp may be from the end of its piece, ticks: a breakpoint is rounded to
/// the nearest tick.
const ROUNDED: f64 = 0.5 + 1e-6;

/// Where the next segment begins, and which one it is.
#[derive(Debug, Clone, Copy)]
struct Next {
    /// The index of the segment in the kept fit.
    at: usize,
    /// Whether it is the last one of the piece.
    last: bool,
    /// First tick, counted from the start of the piece.
    first: u64,
    /// Distance from the start of the move, 2^-64 step.
    done: i128,
}

impl<F: Real> Fitter<'_, F> {
    /// Returns the kept fit of a piece that is a whole ramp, in the integers of this move. `None`
    /// if there is none, or if a segment of it fails.
    pub fn scaled(&self, done: i128) -> Option<Vec<Fitted>> {
        let (size, kept) = self.kept()?;
        self.scaled_from(&size, &kept, done)
    }

    fn scaled_from(&self, size: &Size, kept: &Kept, mut done: i128) -> Option<Vec<Fitted>> {
        let whole = kept.segments.len();
        let mut segments = Vec::with_capacity(whole);
        let mut first = 0;
        for index in 0..whole {
            let at = if size.rises { index } else { whole - 1 - index };
            let next = Next { at, last: index + 1 == whole, first, done };
            let fitted = self.scaled_segment(size, kept, next)?;
            first += fitted.ticks;
            done += fitted.distance;
            segments.push(fitted);
        }
        Some(segments)
    }

    /// The ramp that the piece is, and the fit that is kept for it. A piece that begins or ends
    /// elsewhere than a ramp has none.
    fn kept(&self) -> Option<(Size, Arc<Kept>)> {
        let corridor = &self.corridor;
        let [up, down] = corridor.profile.own_ramps()?;
        let (piece, clock, rises) = (corridor.piece, &corridor.clock, corridor.rises);
        let wide = |x: F| x.to_f64();
        let ramp = if rises { up } else { down };
        let ticks = ramp.duration / wide(clock.tick)?;
        let (rest, far, whole) = if rises {
            (0.0, piece.ticks as f64 - ticks, piece.first == 0)
        } else {
            let end = wide(clock.seconds)? / wide(clock.tick)? - piece.first as f64;
            (end, end - ticks, piece.first + piece.ticks == clock.ticks)
        };
        if !whole || far.abs() > ROUNDED || corridor.tolerance < LEAST_TOLERANCE {
            return None;
        }
        let far_end = if rises { piece.ticks as f64 } else { 0.0 };
        let top = corridor.speed(far_end);
        let key = Key::new(
            &ramp,
            ticks,
            corridor.tolerance,
            corridor.phase,
            [top, steps(self.limits.fastest())],
        );
        let kept = key?.kept()?;
        Some((Size { ticks, steps: ramp.distance, rest, rises }, kept))
    }

    fn scaled_segment(&self, size: &Size, kept: &Kept, next: Next) -> Option<Fitted> {
        let Next { at, last, first, done } = next;
        let one = &kept.segments[at];
        let (slow, fast) = (&kept.joints[at], &kept.joints[at + 1]);
        let joints = if size.rises { [slow, fast] } else { [fast, slow] };
        let piece = self.corridor.piece;
        let end = if last { piece.ticks } else { size.tick(joints[1].time).round() as u64 };
        let ticks = end.checked_sub(first).filter(|&ticks| ticks >= LEAST_TICKS)?;
        let [from, to] = [first, end].map(|tick| size.own(tick as f64) - slow.time);
        let [c1, c2, c3] = one.cubic;
        let units = |x: f64| (x * 2_f64.powi(64)) as i128;
        let rest = piece.start + piece.units - done;
        let place = units(size.steps * (one.place + to * (c1 + to * (c2 + to * c3))));
        let distance = if last {
            rest
        } else if size.rises {
            place - (done - piece.start)
        } else {
            rest - place
        };
        let opens = piece.first + first == 0;
        let ends = last && piece.first + piece.ticks == self.corridor.clock.ticks;
        let at_once = self.corridor.steps_at_once();
        let scale = size.steps / (size.ticks * size.ticks);
        let doubled = scale * (4.0 * c2 + 6.0 * c3 * (from + to));
        // As in `cubic`, the second try forbids A to change its sign.
        [false, true].into_iter().find_map(|one_way| {
            let wanted = Wanted {
                ticks,
                distance: distance.clamp(0, rest.max(0)),
                doubled_middle: units(if size.rises { doubled } else { -doubled }),
                jerk: units(scale / size.ticks * 6.0 * c3),
                one_way,
                least: i64::from(opens && at_once),
                first: opens,
            };
            let bend = wanted.within(self.limits);
            let fitted = Fitted { ticks, bend, distance: wanted.distance };
            let fitted = fitted.whole(self.corridor.backward, rest, ends)?;
            let found = fitted.found(self.limits, opens, at_once)?;
            let from_rest = if size.rises { done - piece.start } else { rest };
            let laid = Laid::new(first, ticks, steps(from_rest), found);
            let most = if matches!(one.samples, Samples::Standing(_)) { STANDING } else { 1.0 };
            let level = self.corridor.level(size, one, &laid);
            let level = level.max(self.corridor.beside(size, joints, &laid));
            (level <= most).then_some(fitted)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::corridor::{Corridor, JOINT};
    use crate::demand::Clock;
    use crate::limits::ExactLimits;
    use crate::search::QUICK;
    use crate::share::Piece;
    use crate::units;
    use carrystep_core::StartPhase;
    use carrystep_profile::{Limits, Profile, rule};

    const LIMITS: Limits<f64> =
        Limits { start_speed: 0.0, speed: 15e4, acceleration: 5e5, jerk: f64::INFINITY };

    /// Runs a test with the fitter of both ramps of a move of 20 000 steps at ticks of 1 us.
    fn ramps(profile: &dyn Profile<f64>, test: impl Fn(&Fitter<'_, f64>, i128)) {
        let tick = 1e-6;
        let seconds = profile.duration();
        let ticks = (seconds / tick).round() as u64;
        let per_tick = |x: f64, power| units::toward_zero(x * tick.powi(power)).unwrap();
        let speed = per_tick(LIMITS.speed, 1);
        let limits = ExactLimits {
            start_speed: per_tick(profile.speed(0.0), 1),
            speed,
            acceleration: per_tick(LIMITS.acceleration, 2),
            jerk: None,
            tolerance: speed / 1_000_000_000,
        };
        let up = (profile.breakpoints()[0] / tick).round() as u64;
        for rises in [true, false] {
            let first = if rises { 0 } else { ticks - up };
            let place = |tick_: u64| {
                units::nearest(profile.position((tick_ as f64 * tick).min(seconds))).unwrap()
            };
            let start = place(first);
            let units = place(first + up) - start;
            let corridor = Corridor {
                profile,
                clock: Clock { ticks, last: 1.0, seconds, tick },
                phase: StartPhase::Half,
                backward: false,
                pulses: 20_000,
                piece: Piece { first, ticks: up, start, units, by_pulse: false },
                rises,
                tolerance: 1.0,
                bend: steps(limits.acceleration),
                joint: JOINT,
                longer: 1.0,
            };
            let fitter =
                Fitter { corridor, limits: &limits, rows: Vec::new(), search: QUICK, keeps: true };
            test(&fitter, start);
        }
    }

    fn moves() -> [Box<dyn Profile<f64>>; 2] {
        [
            Box::new(rule::sine(20_000.0, 0.6, &LIMITS).unwrap()),
            Box::new(rule::logistic(20_000.0, 0.7, &LIMITS).unwrap()),
        ]
    }

    #[test]
    fn both_ramps_of_an_ordinary_move_have_a_scaled_fit() {
        for profile in moves() {
            ramps(&*profile, |fitter, start| {
                let segments = fitter.scaled(start).unwrap();
                let ticks: u64 = segments.iter().map(|one| one.ticks).sum();
                assert_eq!(ticks, fitter.corridor.piece.ticks);
                assert!(segments.len() < 20, "{}", segments.len());
            });
        }
    }

    #[test]
    fn a_kept_fit_that_is_not_that_of_the_curve_is_refused_wherever_it_is_wrong() {
        for profile in moves() {
            ramps(&*profile, |fitter, start| {
                let (size, kept) = fitter.kept().unwrap();
                assert!(fitter.scaled_from(&size, &kept, start).is_some());
                let mut refused = 0;
                for at in 0..kept.segments.len() {
                    // Bent, away from the limit of acceleration, so far that the cubic is four
                    // tolerances off in its middle.
                    let (from, to) = (kept.joints[at], kept.joints[at + 1]);
                    let mut bent = (*kept).clone();
                    bent.segments[at].cubic[1] -=
                        16.0 * to.speed / size.ticks / (to.time - from.time).powi(2);
                    refused += usize::from(fitter.scaled_from(&size, &bent, start).is_none());
                }
                // A segment with few edges may have none in its middle, and the limits of the
                // integers straighten others.
                assert!(2 * refused > kept.segments.len(), "{refused}");
                // The samples are those of the curve two tolerances later. A segment may have no
                // edge of its own, so those of all such segments are wrong together.
                let later = 2.0 / size.ticks;
                let mut at_edges = (*kept).clone();
                for at in 0..kept.segments.len() {
                    let mut moved = (*kept).clone();
                    match (&mut moved.segments[at].samples, &mut at_edges.segments[at].samples) {
                        (Samples::Standing(samples), _) => {
                            samples.iter_mut().for_each(|sample| sample.time += later);
                            assert!(fitter.scaled_from(&size, &moved, start).is_none(), "{at}");
                        }
                        (_, Samples::Edges(pulses)) => {
                            pulses.iter_mut().for_each(|(_, span)| span.delay(later));
                        }
                        _ => {}
                    }
                }
                assert!(fitter.scaled_from(&size, &at_edges, start).is_none());
            });
        }
    }
}
