//! A straight line: one profile for all axes, scaled by how far each of them goes.
//!
//! Every profile scales with its limits. So it is enough to give each axis those of the line, in its own steps: what
//! the axis with the least room for a step of its own leaves to all of them.

use carrystep_files::ProfileKind;
use carrystep_profile::{Limit, Limits, Real, Refusal};

/// Steps of an axis and what it can do.
type Travel<F> = (F, Limits<F>);

/// Gives every axis that moves the limits of the line, in its own steps.
pub(crate) fn share_limits<F: Real>(kind: ProfileKind, axes: &mut [Travel<F>]) {
    let line =
        [Limit::StartSpeed, Limit::Speed, Limit::Acceleration, Limit::Jerk].map(|limit| tightest(limit, kind, axes));
    let Some([start_speed, speed, acceleration, jerk]) = all(line.map(|found| found.map(|(_, per_step)| per_step)))
    else {
        return;
    };
    for (steps, limits) in axes.iter_mut().filter(|(steps, _)| !steps.is_zero()) {
        let n = *steps;
        *limits =
            Limits { start_speed: start_speed * n, speed: speed * n, acceleration: acceleration * n, jerk: jerk * n };
    }
}

/// A refusal on axis `on` of the line as one of the axis that leaves so little room, in its steps and by its limit.
pub(crate) fn blame<F: Real>(kind: ProfileKind, axes: &[Travel<F>], on: usize, refusal: Refusal) -> (usize, Refusal) {
    let Some((guilty, _)) = tightest(refusal.limit, kind, axes) else { return (on, refusal) };
    let wide = |x: F| x.to_f64().unwrap_or(f64::NAN);
    let scale = wide(axes[guilty].0) / wide(axes[on].0);
    let available = wide(value(refusal.limit, &axes[guilty].1));
    (guilty, Refusal { wanted: refusal.wanted * scale, available, ..refusal })
}

/// The axis with the least of a limit for each step that it takes, and that quotient.
fn tightest<F: Real>(limit: Limit, kind: ProfileKind, axes: &[Travel<F>]) -> Option<(usize, F)> {
    let moving = axes.iter().enumerate().filter(|(_, (steps, _))| !steps.is_zero());
    let rooms = moving.map(|(axis, (steps, limits))| (axis, value(limit, limits) / *steps));
    // A logistic curve is never at rest: where no start speed is stated, its own will do.
    let open = |room: &(usize, F)| limit == Limit::StartSpeed && kind == ProfileKind::Logistic && room.1.is_zero();
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
