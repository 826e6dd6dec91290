//! Benchmark: the time to plan one move of six axes, and a file of a hundred, fits included. Run it with `cargo bench -p
//! carrystep-plan`.

#![allow(clippy::expect_used, reason = "clippy.toml's allowance reaches unit tests only")]

use carrystep_files::{MoveFile, SourceText};
use carrystep_plan::plan;
use std::fmt::Write;

fn main() {
    divan::main();
}

/// So many moves of six axes with up to 20 000 steps and a fit tolerance of one tick of 1 us, there
/// and back.
fn six_axes(profile: &str, moves: usize) -> MoveFile {
    let mut text = String::from("[machine]\n");
    for name in ["x", "y", "z", "a", "b", "c"] {
        writeln!(
            text,
            "[[machine.axis]]\nname = \"{name}\"\nsteps_per_unit = 1\nspeed_limit = 150_000\naccel_limit = 500_000\n\
             jerk_limit = 1e8\nstep_high_ns = 100\nstep_low_ns = 100\ndir_setup_ns = 100\ndir_hold_ns = 100"
        )
        .expect("a string takes it");
    }
    let there = "{ x = 20_000, y = -16_000, z = 500, a = 9_000, b = -12_000, c = 3_000 }";
    let back = "{ x = 0, y = 0, z = 0, a = 0, b = 0, c = 0 }";
    for to in [there, back].into_iter().cycle().take(moves) {
        writeln!(text, "[[move]]\nprofile = \"{profile}\"\nto = {to}").expect("a string takes it");
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
