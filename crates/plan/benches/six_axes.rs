//! Benchmark: the time to plan one move of six axes, fits included. Run it with `cargo bench -p
//! carrystep-plan`.

#![allow(clippy::expect_used, reason = "clippy.toml's allowance reaches unit tests only")]

use carrystep_files::{MoveFile, SourceText};
use carrystep_plan::plan;
use std::fmt::Write;

fn main() {
    divan::main();
}

/// A move of six axes with up to 20 000 steps and a fit tolerance of one tick of 1 us.
fn six_axes(profile: &str) -> MoveFile {
    let mut text = String::from("[machine]\n");
    for name in ["x", "y", "z", "a", "b", "c"] {
        writeln!(
            text,
            "[[machine.axis]]\nname = \"{name}\"\nsteps_per_unit = 1\nspeed_limit = 150_000\naccel_limit = 500_000\n\
             jerk_limit = 1e8\nstep_high_ns = 100\nstep_low_ns = 100\ndir_setup_ns = 100\ndir_hold_ns = 100"
        )
        .expect("a string takes it");
    }
    let to = "to = { x = 20_000, y = -16_000, z = 500, a = 9_000, b = -12_000, c = 3_000 }";
    writeln!(text, "[[move]]\nprofile = \"{profile}\"\n{to}").expect("a string takes it");
    MoveFile::from_source(SourceText { path: "bench.toml".into(), text: text.into() })
        .expect("a move file")
}

#[divan::bench(args = ["trapezoid", "scurve", "logistic", "sine"])]
fn one_move(bencher: divan::Bencher<'_, '_>, profile: &str) {
    let file = six_axes(profile);
    bencher.bench(|| plan::<f64>(&file).expect("a plan"));
}
