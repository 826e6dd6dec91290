//! How fast the simulation is; run with `cargo test --release -p carrystep-hdl --test speed -- --ignored --nocapture`.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "clippy.toml's allowance reaches unit tests only")]

use carrystep_hdl::{AxisSim, SixAxisSim};
use carrystep_spec::ports::Inputs;
use carrystep_spec::{AXES, Build, PinTiming, Segment, StartPhase, Timebase};
use std::time::Instant;

const STEADY: Segment = Segment { ticks: u32::MAX, v: 1 << 60, a: 0, j: 0, last: true };

#[test]
#[ignore = "a measurement"]
fn six_axis_clocks_per_second() {
    let timebase = Timebase::new(48_000_000, 1000, 16).unwrap();
    let pins = [PinTiming { width: 5, gap: 5, setup: 1, hold: 1 }; AXES];
    let mut core = SixAxisSim::new(&Build { timebase, phase: StartPhase::Half, pins }).unwrap();
    for axis in 0..6 {
        core.settle(&Inputs { segment: Some((axis, STEADY)), ..Inputs::default() });
        core.clock();
    }
    core.settle(&Inputs { start: Some(0x3f), ..Inputs::default() });
    core.clock();
    let (clocks, start) = (480_000, Instant::now());
    let mut position = 0;
    for _ in 0..clocks {
        position = core.settle(&Inputs::default()).position[5];
        core.clock();
    }
    println!("six axes: {:.0} clocks/s, {position} steps", f64::from(clocks) / start.elapsed().as_secs_f64());
}

#[test]
#[ignore = "a measurement"]
fn axis_ticks_per_second() {
    let mut axis = AxisSim::new(16, StartPhase::Half).unwrap();
    assert!(axis.offer(&STEADY));
    axis.tick(true);
    let (ticks, start) = (400_000, Instant::now());
    let steps = (0..ticks).filter(|_| axis.tick(false).crossed).count();
    let seconds = start.elapsed().as_secs_f64();
    println!("one axis: {:.0} ticks/s of 5 clocks, {steps} steps", f64::from(ticks) / seconds);
}
