//! Runs the same random programs and events at every stage and compares the outputs with the model
//! in every clock.

use crate::stages::{self, Stages};
use carrystep_simulators::Level;
use carrystep_simulators::engine::replay::{self, Recording};
use carrystep_tests::{effort, engine_programs};
use carrystep_tools::{ice40, kept};
use proptest::strategy::{Strategy as _, ValueTree as _};
use proptest::test_runner::{Config, TestRunner};

/// The greatest number of clocks of a program in Verilator, and in Icarus, which is a hundred times
/// slower. The shipped engine takes a start only after 1 ms with power, which is 80 000 clocks.
const LONG: u64 = 120_000;
const SHORT: u64 = 5_000;

/// Runs random programs of at most `most` clocks each until they have taken `clocks` clocks in all.
/// Returns the numbers of edges and stops.
fn assert_same(stages: &Stages, level: Level, most: u64, clocks: u64) -> (u32, u32) {
    let netlist = stages.netlist.simulated().expect("models of its cells");
    let bitstream = ice40::simulated(&stages.read_back).expect("models of its memories");
    let texts = [("Verilog", &stages.verilog), ("netlist", &netlist), ("bitstream", &bitstream)];
    let mut runner = TestRunner::new(Config::default());
    let (mut run, mut edges, mut faults) = (0, 0, 0);
    while run < clocks {
        let (program, events) = engine_programs::program(stages.build.axes())
            .new_tree(&mut runner)
            .expect("a program")
            .current();
        let recording = Recording::new(&stages.build, &program, &events, most);
        for (stage, text) in texts {
            let difference = replay::difference(level, text, &recording).expect("the tools");
            assert_eq!(
                difference, None,
                "the {stage} in {level} is not the model: {program:?} {events:?}"
            );
        }
        run += recording.clocks;
        for pair in recording.outputs.windows(2) {
            edges += (pair[1].1.step & !pair[0].1.step).count_ones();
            faults += u32::from(pair[1].1.fault.is_some() && pair[0].1.fault.is_none());
        }
    }
    effort::say(&format!("three stages in {level}: {run} clocks, {edges} edges, {faults} stops"));
    kept::say();
    (edges, faults)
}

fn assert_same_in_verilator(stages: &Stages) {
    let (edges, faults) = assert_same(stages, Level::Verilator, LONG, effort::clocks(1_000_000));
    assert!(edges > 0 && faults > 0, "lock-step over nothing proves nothing");
}

#[test]
fn all_stages_have_equal_outputs_in_every_clock() {
    assert_same_in_verilator(stages::hurried());
}

#[test]
fn all_stages_of_the_exported_verilog_have_equal_outputs_in_every_clock() {
    assert_same_in_verilator(stages::shipped());
}

/// Icarus simulates undefined values; none of them may reach a pin.
#[test]
fn no_undefined_value_reaches_the_pins() {
    assert_same(stages::hurried(), Level::Icarus, SHORT, 3 * SHORT);
}
