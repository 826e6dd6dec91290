//! Tests of `[machine.inputs]`: the values in the gateware, and every kind of mistake.

use carrystep_core::engine::{Guard, InputRow, Latch, LatchSource};
use carrystep_files::{InputError, Machine, SourceText};
use std::fmt::Write as _;

fn read(axes: usize, keys: &str) -> Result<Machine, InputError> {
    let mut text = format!("[machine]\n[machine.inputs]\n{keys}\n");
    for axis in 0..axes {
        let rest = "steps_per_unit = 5\nspeed_limit = 1000\naccel_limit = 5000\ndriver = \"a4988\"";
        writeln!(text, "[[machine.axis]]\nname = \"x{axis}\"\n{rest}").unwrap();
    }
    Machine::from_source(&SourceText { path: "machine.toml".into(), text: text.into() })
}

fn guard(axes: usize, keys: &str) -> Guard {
    let machine = read(axes, keys).unwrap();
    machine.engine().check().unwrap();
    machine.guard
}

const fn row(exist: u8, low: u8) -> InputRow {
    InputRow { exist, low }
}

#[test]
fn without_keys_there_are_no_inputs() {
    let found = guard(1, "");
    assert_eq!(found.inputs, [row(0, 0); 2]);
    assert_eq!(found.latches, []);
    assert!(!found.has_interlock());
}

#[test]
fn each_key_is_an_input_of_its_row() {
    assert_eq!(guard(1, "probe = \"low\"").inputs, [row(1, 1), row(0, 0)]);
    let found = guard(1, "interlock = \"high\"");
    assert_eq!(found.inputs, [row(0, 0), row(1, 0)]);
    assert!(found.has_interlock());
    let general = ["high", "low", "low", "high", "low"];
    let found = guard(4, &format!("probe = \"high\"\ngeneral = {general:?}"));
    assert_eq!(found.inputs, [row(0b1111, 0b1100), row(0b0110, 0b0010)]);
    let most = guard(
        6,
        "general = [\"low\", \"low\", \"low\", \"low\", \"low\", \"low\", \"low\", \"low\"]",
    );
    assert_eq!(most.inputs, [row(0b1_1110, 0b1_1110); 2]);
}

#[test]
fn latch_has_its_edge_and_its_looks() {
    assert_eq!(guard(1, "latch = \"rising\"").latches, [Latch::of_pin(false, 1)]);
    let found = guard(1, "latch = \"falling\"\nlatch_looks = 16");
    assert_eq!(found.latches, [Latch::of_pin(true, 16)]);
}

#[test]
fn each_of_several_latches_has_its_pin_its_edge_and_its_looks() {
    let switch = |row, axis| LatchSource::Switch { row, axis };
    let found = guard(
        2,
        "probe = \"low\"\nlatches = [{ edge = \"rising\" }, { source = \"probe\", edge = \"falling\", \
         looks = 3 }, { source = \"limit_min\", axis = \"x1\", edge = \"rising\" }, \
         { source = \"limit_max\", axis = \"x0\", edge = \"falling\" }]",
    );
    assert_eq!(
        found.latches,
        [
            Latch::of_pin(false, 1),
            Latch { source: switch(2, 0), low: true, looks: 3 },
            Latch { source: switch(0, 1), low: false, looks: 1 },
            Latch { source: switch(1, 0), low: true, looks: 1 },
        ]
    );
    let one = "latches = [{ source = \"limit_min\", edge = \"rising\" }]\n[machine.guard]\nlimits = \"one\"";
    assert_eq!(guard(3, one).latches, [Latch { source: switch(0, 0), low: false, looks: 1 }]);
}

#[test]
fn rows_of_inputs_make_the_round_four_ticks_or_longer() {
    let short = "[machine.guard]\nwatchdog_ms = 0\nenable_ms = 0\ndebounce_us = 0";
    assert_eq!(guard(1, &format!("latch = \"rising\"\n{short}")).round, 2);
    assert_eq!(guard(1, &format!("probe = \"low\"\n{short}")).round, 4);
    assert_eq!(guard(1, "probe = \"low\"").round, guard(1, "").round);
}

#[test]
fn mistake_is_refused_at_its_place() {
    for (axes, keys, says, at) in [
        (1, "probe = \"open\"", "unknown variant `open`", (3, 9)),
        (1, "door = \"low\"", "unknown field `door`", (3, 1)),
        (1, "general = [\"low\"]", "1 general inputs: a machine of 1 axis has at most 0", (3, 11)),
        (
            3,
            "general = [\"low\", \"low\", \"low\", \"low\", \"high\"]",
            "5 general inputs: a machine of 3 axes has at most 4",
            (3, 11),
        ),
        (1, "latch_looks = 2", "latch_looks without latch", (3, 15)),
        (1, "latches = []", "0 latches: a machine has 1 to 4", (3, 11)),
        (
            1,
            "latch = \"rising\"\nlatches = [{ edge = \"rising\" }]",
            "latches besides latch or latch_looks",
            (4, 11),
        ),
        (1, "latches = [{ edge = \"rising\", looks = 0 }]", "looks = 0: it is from 1", (3, 39)),
        (
            1,
            "latches = [{ source = \"probe\", edge = \"rising\" }]",
            "a latch at the probe of a machine without one",
            (3, 12),
        ),
        (
            1,
            "latches = [{ source = \"limit_min\", edge = \"rising\" }]",
            "a latch at a limit of no axis",
            (3, 12),
        ),
        (
            1,
            "latches = [{ source = \"limit_max\", axis = \"y\", edge = \"rising\" }]",
            "no axis is called 'y'",
            (3, 43),
        ),
        (
            1,
            "latches = [{ source = \"limit_max\", axis = \"x0\", edge = \"rising\" }]\n\
             [machine.guard]\nlimits = \"each\"",
            "a latch at a limit that the machine does not have",
            (3, 12),
        ),
        (
            1,
            "latches = [{ axis = \"x0\", edge = \"rising\" }]",
            "a latch with an axis, which is no limit",
            (3, 12),
        ),
        (1, "latch = \"rising\"\nlatch_looks = 0", "latch_looks = 0: it is from 1 to 16", (4, 15)),
        (1, "latch = \"rising\"\nlatch_looks = 17", "latch_looks = 17: it is from", (4, 15)),
    ] {
        let error = read(axes, keys).unwrap_err();
        assert!(error.message.contains(says), "{keys}: {error}");
        assert_eq!(error.line_column(), Some(at), "{keys}");
    }
    let five = format!("latches = [{}]", ["{ edge = \"rising\" }"; 5].join(", "));
    let error = read(8, &five).unwrap_err();
    assert!(error.message.contains("5 latches: a machine has 1 to 4"), "{error}");
    let nine = format!("general = [{}]", ["\"low\""; 9].join(", "));
    let error = read(8, &nine).unwrap_err();
    assert!(error.message.contains("9 general inputs: a machine of 8 axes has at most 8"));
}
