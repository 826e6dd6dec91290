//! Benchmark: the time to plan one move of six axes, and a file of a hundred, fits included. Beside
//! it Ruckig (L. Berscheid and T. Kroeger, 2021) plans the same targets within the same limits,
//! from rest to rest in a common time. It returns float profiles; nothing of ours is left out.
//!
//!     cargo bench -p carrystep-plan

#![allow(clippy::expect_used, reason = "clippy.toml's allowance reaches unit tests only")]

use carrystep_files::{MoveFile, SourceText};
use carrystep_plan::plan;
use rsruckig::prelude::{InputParameter, Ruckig, ThrowErrorHandler, Trajectory};
use std::fmt::Write;

fn main() {
    divan::main();
}

/// Where each axis goes, in steps.
const TARGETS: [(&str, i32); 6] =
    [("x", 20_000), ("y", -16_000), ("z", 500), ("a", 9_000), ("b", -12_000), ("c", 3_000)];

/// The limits of each axis: steps/s, steps/s^2 and steps/s^3.
const LIMITS: [f64; 3] = [150e3, 500e3, 1e8];

/// So many moves of six axes with up to 20 000 steps and a fit tolerance of one tick of 1 us, there
/// and back.
fn six_axes(profile: &str, moves: usize) -> MoveFile {
    let mut text = String::from("[machine]\n");
    let [speed, acceleration, jerk] = LIMITS;
    for (name, _) in TARGETS {
        writeln!(
            text,
            "[[machine.axis]]\nname = \"{name}\"\nsteps_per_unit = 1\nspeed_limit = {speed}\n\
             accel_limit = {acceleration}\njerk_limit = {jerk}\nstep_high_ns = 100\n\
             step_low_ns = 100\ndir_setup_ns = 100\ndir_hold_ns = 100"
        )
        .expect("a string takes it");
    }
    for sign in [1, -1].into_iter().cycle().take(moves) {
        let to = TARGETS.map(|(name, steps)| format!("{name} = {}", sign * steps)).join(", ");
        writeln!(text, "[[move]]\nprofile = \"{profile}\"\nto = {{ {to} }}")
            .expect("a string takes it");
    }
    MoveFile::from_source(SourceText { path: "bench.toml".into(), text: text.into() })
        .expect("a move file")
}

const KINDS: [&str; 4] = ["trapezoid", "scurve", "logistic", "sine"];

#[divan::bench(args = KINDS)]
fn one_move(bencher: divan::Bencher<'_, '_>, profile: &str) {
    let file = six_axes(profile, 1);
    bencher.bench(|| plan::<f64>(&file).expect("a plan"));
}

#[divan::bench(args = KINDS)]
fn hundred_moves(bencher: divan::Bencher<'_, '_>, profile: &str) {
    let file = six_axes(profile, 100);
    bencher.bench(|| plan::<f64>(&file).expect("a plan"));
}

#[divan::bench]
fn one_move_by_ruckig(bencher: divan::Bencher<'_, '_>) {
    let mut ruckig = Ruckig::<6, ThrowErrorHandler>::new(None, 0.001);
    let mut input = InputParameter::<6>::new(None);
    let [speed, acceleration, jerk] = LIMITS;
    for (axis, (_, steps)) in TARGETS.into_iter().enumerate() {
        input.target_position[axis] = f64::from(steps);
        input.max_velocity[axis] = speed;
        input.max_acceleration[axis] = acceleration;
        input.max_jerk[axis] = jerk;
    }
    bencher.bench_local(|| {
        let mut trajectory = Trajectory::<6>::new(None);
        ruckig.calculate(&input, &mut trajectory).expect("a trajectory");
        trajectory
    });
}
