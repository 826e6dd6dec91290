//! Tests how few segments a fit needs on the reference move: 20 000 steps from and to rest, with at
//! most 500 000 steps/s^2. The counts are upper bounds and may only be lowered.

#![allow(clippy::expect_used, reason = "clippy.toml's allowance reaches unit tests only")]

use carrystep_files::{MoveFile, SourceText};
use carrystep_plan::{PlannedAxis, plan};

/// Plans the reference move with a tolerance in ns. Only the seven-segment profile gets a jerk
/// limit, which the sine profile of the reference would exceed.
fn reference(profile: &str, fit_ns: u32) -> PlannedAxis {
    let jerk = if profile == "scurve" { "jerk_limit = 50_000_000\n" } else { "" };
    let text = format!(
        "[machine]\n[[machine.axis]]\nname = \"x\"\nsteps_per_unit = 1\nspeed_limit = 150_000\n\
         accel_limit = 500_000\n{jerk}step_high_ns = 100\nstep_low_ns = 100\ndir_setup_ns = 100\ndir_hold_ns = 100\n\
         [[move]]\nprofile = \"{profile}\"\nfit_ns = {fit_ns}\nto = {{ x = 20_000 }}\n"
    );
    let file =
        MoveFile::from_source(SourceText { path: "reference.toml".into(), text: text.into() })
            .expect("a move file");
    plan::<f64>(&file).expect("a plan").moves.remove(0).axes.remove(0)
}

/// Numbers of segments of the ramp up, of the cruise, and of the ramp down with its landing.
fn counts(axis: &PlannedAxis) -> [usize; 3] {
    let ends: Vec<u64> =
        axis.profile.breakpoints().iter().map(|t| (t * 1e6).round() as u64).collect();
    let mut counts = [0; 3];
    let mut tick = 0;
    for segment in &axis.segments {
        counts[ends.iter().filter(|&&end| end <= tick).count()] += 1;
        tick += u64::from(segment.ticks);
    }
    counts
}

fn assert_at_most(profile: &str, fit_ns: u32, most: usize) {
    let [up, cruise, down] = counts(&reference(profile, fit_ns));
    assert!(
        up <= most && down <= most && cruise == 1,
        "{profile} at {fit_ns} ns: {up} + {cruise} + {down}"
    );
}

#[test]
fn reference_ramps_last_as_long_as_published() {
    // The durations are whole ticks, and the move cruises for less than a millisecond. Ramps are
    // therefore up to 0.2 % shorter.
    for (profile, ramp, within) in [("logistic", 0.325_371, 1e-4), ("sine", 0.282_843, 5e-4)] {
        let axis = reference(profile, 1000);
        assert!(
            (axis.profile.breakpoints()[0] - ramp).abs() < within,
            "{profile}: {:?}",
            axis.profile
        );
    }
}

#[test]
fn one_microsecond_of_tolerance_takes_at_most_13_logistic_or_11_sine_segments_per_ramp() {
    assert_at_most("logistic", 1000, 13);
    assert_at_most("sine", 1000, 11);
}

#[test]
fn fifty_nanoseconds_of_tolerance_take_at_most_27_logistic_or_22_sine_segments_per_ramp() {
    assert_at_most("logistic", 50, 27);
    assert_at_most("sine", 50, 22);
}

#[test]
fn exact_profiles_ignore_the_fit_tolerance() {
    for profile in ["trapezoid", "scurve"] {
        assert_eq!(reference(profile, 1).segments, reference(profile, 100_000).segments);
    }
}
