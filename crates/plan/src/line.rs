//! A straight line: all axes follow one profile, scaled by the steps of each axis.
//!
//! Every profile scales with its limits. It is therefore enough to give each axis the limits of the
//! line in its own steps. A limit of the line is, for each kind of limit, the least quotient of an
//! axis' limit and the axis' steps.
//!
//! A new kind of limit has to be added to [`share_limits`] and to `value`.

use carrystep_core::ProfileKind;
use carrystep_profile::{Limit, LimitRefusal, Limits, Real};

/// The steps of an axis in this move, as a magnitude, and its limits in steps and seconds.
type Travel<F> = (F, Limits<F>);

/// Replaces the limits of every axis that moves by those of the line, in steps of that axis.
pub(crate) fn share_limits<F: Real>(kind: ProfileKind, axes: &mut [Travel<F>]) {
    let line = [Limit::StartSpeed, Limit::Speed, Limit::Acceleration, Limit::Jerk]
        .map(|limit| tightest(limit, kind, axes));
    let Some([start_speed, speed, acceleration, jerk]) =
        all(line.map(|found| found.map(|(_, per_step)| per_step)))
    else {
        return;
    };
    for (steps, limits) in axes.iter_mut().filter(|(steps, _)| !steps.is_zero()) {
        let n = *steps;
        *limits = Limits {
            start_speed: start_speed * n,
            speed: speed * n,
            acceleration: acceleration * n,
            jerk: jerk * n,
        };
    }
}

/// Converts a refusal on axis `on` of the line into one on the axis whose limit is the tightest, in
/// the steps of that axis and with its own limit as the available value.
pub(crate) fn blame<F: Real>(
    kind: ProfileKind,
    axes: &[Travel<F>],
    on: usize,
    refusal: LimitRefusal,
) -> (usize, LimitRefusal) {
    let Some((guilty, _)) = tightest(refusal.limit, kind, axes) else { return (on, refusal) };
    let wide = |x: F| x.to_f64().unwrap_or(f64::NAN);
    let scale = wide(axes[guilty].0) / wide(axes[on].0);
    let available = wide(value(refusal.limit, &axes[guilty].1));
    (guilty, LimitRefusal { wanted: refusal.wanted * scale, available, ..refusal })
}

/// Returns the axis with the least quotient of a limit and its steps, and that quotient.
fn tightest<F: Real>(limit: Limit, kind: ProfileKind, axes: &[Travel<F>]) -> Option<(usize, F)> {
    let moving = axes.iter().enumerate().filter(|(_, (steps, _))| !steps.is_zero());
    let rooms = moving.map(|(axis, (steps, limits))| (axis, value(limit, limits) / *steps));
    // A logistic profile has a start speed of its own: axes without a start speed in the file do
    // not restrict it, unless no axis has one.
    let open = |room: &(usize, F)| {
        limit == Limit::StartSpeed && kind == ProfileKind::Logistic && room.1.is_zero()
    };
    let least = |a: (usize, F), b: (usize, F)| if b.1 < a.1 { b } else { a };
    let stated = rooms.clone().filter(|room| !open(room)).reduce(least);
    stated.or_else(|| rooms.reduce(least))
}

fn value<F: Real>(limit: Limit, limits: &Limits<F>) -> F {
    match limit {
        Limit::StartSpeed => limits.start_speed,
        Limit::Speed => limits.speed,
        Limit::Acceleration => limits.acceleration,
        Limit::Jerk => limits.jerk,
    }
}

fn all<F: Copy>([a, b, c, d]: [Option<F>; 4]) -> Option<[F; 4]> {
    Some([a?, b?, c?, d?])
}
