//! The page on accuracy compares this project with constant speeds for a fixed time, as grbl makes
//! them. This test computes that row of the table from the profiles.

use carrystep_core::ProfileKind;
use carrystep_profile::{Limits, kinds};
use carrystep_tests::pages::{grouped, says};

/// Duration of each constant speed, s: grbl's default, as the page says.
const SLICE: f64 = 0.01;

/// Steps of the reference move.
const STEPS: u32 = 20_000;

/// Greatest acceleration of the reference move, steps/s^2.
const ACCELERATION: f64 = 500_000.0;

/// How a move of constant speeds differs from its profile.
struct Differs {
    slices: usize,
    /// The greatest error of an edge, early or late, s.
    furthest: f64,
    rms: f64,
}

/// Each slice covers exactly the distance that the profile covers in it.
fn constant_speeds(kind: ProfileKind) -> Differs {
    let limits = Limits {
        start_speed: 0.0,
        speed: f64::INFINITY,
        acceleration: ACCELERATION,
        jerk: f64::INFINITY,
    };
    let steps = f64::from(STEPS);
    let time = kinds::least_time(kind, steps, &limits).expect("a time");
    let profile = kinds::whole(kind, steps, time, &limits).expect("a move");
    let slices = (time / SLICE).ceil() as usize;
    let knots: Vec<(f64, f64)> = (0..=slices)
        .map(|slice| (slice as f64 * SLICE).min(time))
        .map(|t| (t, profile.position(t)))
        .collect();
    // The edge of a step is due where the move has gone half a step more.
    let errors = (0..STEPS).map(|step| {
        let due = f64::from(step) + 0.5;
        let right = knots.partition_point(|&(_, position)| position < due);
        let ((t0, x0), (t1, x1)) = (knots[right - 1], knots[right]);
        t0 + (due - x0) / (x1 - x0) * (t1 - t0) - profile.crossing(due)
    });
    let (furthest, squares) = errors.fold((0.0_f64, 0.0), |(furthest, squares), error| {
        (furthest.max(error.abs()), squares + error * error)
    });
    Differs { slices, furthest, rms: (squares / steps).sqrt() }
}

#[test]
fn accuracy_page_gives_the_error_of_constant_speeds() {
    let [sine, logistic] = [ProfileKind::Sine, ProfileKind::Logistic].map(constant_speeds);
    let ms = |seconds: f64| seconds * 1e3;
    let most = sine.furthest.max(logistic.furthest);
    let [less, more] =
        if sine.rms < logistic.rms { [sine.rms, logistic.rms] } else { [logistic.rms, sine.rms] };
    says(
        "docs/accuracy.md",
        &[
            format!(
                "| constant speed for {} ms at a time | {} to {} | {:.1} ms | {:.2} to {:.2} ms |",
                ms(SLICE),
                sine.slices,
                logistic.slices,
                ms(most),
                ms(less),
                ms(more)
            ),
            format!("`ACCELERATION_TICKS_PER_SECOND` is {:.0}", 1.0 / SLICE),
            format!(
                "{} steps from rest to rest with at most {} steps/s^2",
                grouped(STEPS.into()),
                grouped(ACCELERATION as u64)
            ),
            format!("The same move of {} steps", grouped(STEPS.into())),
        ],
    );
}
