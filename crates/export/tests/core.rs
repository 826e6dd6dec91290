//! The core as a file: ports, names, lint, synthesis, and that the committed one is fresh.
#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches unit tests only")]

use carrystep_export::{CORE_NAME, CORE_WAIVERS, six_axis_verilog, write_core};
use carrystep_spec::ports::{Direction, SIX_AXIS_PORTS};
use carrystep_spec::{AXES, Build, Machine, PinTiming, StartPhase, Timebase};
use std::path::Path;
use std::process::Command;

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");

fn build(clock_hz: u64, phases: u32) -> Build {
    let timebase = Timebase::new(clock_hz, 1000, phases).unwrap();
    let pins = [PinTiming { width: 96, gap: 5, setup: 2, hold: 7 }; AXES];
    Build { timebase, phase: StartPhase::Half, pins }
}

/// Runs a tool in a fresh folder that holds the core: whether it succeeded, and what it printed.
fn run(build: &Build, tool: &str, arguments: &[&str]) -> (bool, String) {
    let folder = tempfile::tempdir().unwrap();
    write_core(folder.path(), build, "a test").unwrap();
    let output = Command::new(tool).args(arguments).current_dir(&folder).output();
    let output = output.unwrap_or_else(|_| panic!("{tool} is not installed: `cargo xtask tools` installs it"));
    let text = String::from_utf8_lossy(&output.stdout) + String::from_utf8_lossy(&output.stderr);
    (output.status.success(), text.into_owned())
}

#[test]
fn ports_are_those_of_the_table() {
    let text = six_axis_verilog(&build(48_000_000, 16), "a test").unwrap();
    let (_, top) = text.split_once(&format!("module {CORE_NAME} (\n")).unwrap();
    let (list, _) = top.split_once("\n);").unwrap();
    let found: Vec<String> = list.lines().map(|line| line.split_whitespace().collect::<Vec<_>>().join(" ")).collect();
    let expected = SIX_AXIS_PORTS.map(|port| {
        let way = if port.direction == Direction::Input { "input" } else { "output" };
        let range = if port.width == 1 { String::new() } else { format!("[{}:0] ", port.width - 1) };
        format!("{way} wire {range}{},", port.name)
    });
    let mut expected = expected.to_vec();
    expected[SIX_AXIS_PORTS.len() - 1].pop();
    assert_eq!(found, expected);
}

#[test]
fn equal_modules_are_one_and_nothing_is_called_after_its_place() {
    let text = six_axis_verilog(&build(48_000_000, 16), "a test").unwrap();
    let modules: Vec<&str> = text.lines().filter_map(|line| line.strip_prefix("module ")).collect();
    let names = ["tick", "sequencer", "step_edge", "axis", "shaper_w96_s5_d2_h7", "six_axis"];
    assert_eq!(modules, names.map(|name| format!("carrystep_{name} (")));
    assert!(!text.contains('$'));
}

#[test]
fn the_same_build_gives_the_same_text() {
    let build = build(20_000_000, 4);
    assert_eq!(six_axis_verilog(&build, "a").unwrap(), six_axis_verilog(&build, "a").unwrap());
}

#[test]
fn a_timing_that_cannot_be_counted_is_refused_and_nothing_is_written() {
    let mut build = build(48_000_000, 16);
    build.pins[3].gap = 0;
    let folder = tempfile::tempdir().unwrap();
    let error = write_core(folder.path(), &build, "a test").unwrap_err();
    assert!(error.to_string().contains("gap is 0 clocks"), "{error}");
    assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 0);
}

#[test]
fn verilator_has_nothing_to_say() {
    let (waivers, verilog) = (format!("{CORE_NAME}.vlt"), format!("{CORE_NAME}.v"));
    let arguments = ["--lint-only", "-Wall", "--top-module", CORE_NAME, &waivers, &verilog];
    for (clock_hz, phases) in [(48_000_000, 16), (20_000_000, 4), (16_000_000, 1)] {
        let (ok, said) = run(&build(clock_hz, phases), "verilator", &arguments);
        assert!(ok && said.is_empty(), "{said}");
    }
}

#[test]
fn yosys_finds_no_latch_and_no_undriven_wire() {
    let script = format!(
        "read_verilog {CORE_NAME}.v; hierarchy -check -top {CORE_NAME}; proc; check -assert; \
         select -assert-none t:$dlatch"
    );
    for (clock_hz, phases) in [(48_000_000, 16), (20_000_000, 4), (16_000_000, 1)] {
        let (ok, said) = run(&build(clock_hz, phases), "yosys", &["-q", "-p", &script]);
        assert!(ok && !said.contains("Warning"), "{said}");
    }
}

#[test]
fn the_committed_core_is_fresh() {
    let machine = Machine::load(&Path::new(ROOT).join("sim/six-axis.toml")).unwrap();
    let read = |extension| {
        let path = Path::new(ROOT).join("hdl-out/core").join(CORE_NAME).with_extension(extension);
        std::fs::read_to_string(path).unwrap()
    };
    let how = "run `cargo xtask generate`";
    assert!(read("v") == six_axis_verilog(&machine.build(), "sim/six-axis.toml").unwrap(), "{how}");
    assert!(read("vlt") == CORE_WAIVERS, "{how}");
}
