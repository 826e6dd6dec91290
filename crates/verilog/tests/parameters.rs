//! Checks the parameters of the exported Verilog: all values share one text, and the elaboration
//! refuses values that are out of range.
#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches unit tests only")]

use carrystep_core::engine::LimitWiring;
use carrystep_core::link::{LineKind, Uart};
use carrystep_core::{AXES, Build, EngineBuild, PinTiming, StartPhase, Timebase};
use carrystep_hdl::parameters::PARAMETERS;
use carrystep_verilog::{
    ENGINE_NAME, engine_verilog, line_verilog, link_verilog, parallel_verilog,
};
use std::path::Path;
use std::process::Command;

fn build(clock_hz: u64, clocks: u32, start: StartPhase) -> Build {
    let timebase = Timebase::new(clock_hz, 1000, 16).unwrap();
    Build {
        timebase,
        phase: start,
        pins: [PinTiming {
            step_high: clocks,
            step_low: clocks + 1,
            dir_setup: 3,
            dir_hold: clocks,
        }; AXES],
    }
}

fn first() -> EngineBuild {
    EngineBuild::minimal(&build(80_000_000, 2, StartPhase::Half), 1 << 40)
}

fn second() -> EngineBuild {
    let mut second = EngineBuild::minimal(&build(96_000_000, 200, StartPhase::Zero), 1 << 50);
    second.pins[3] = PinTiming::SHORTEST;
    second.guard.limits = LimitWiring::Each;
    second.guard.round = 1024;
    (second.guard.watchdog, second.guard.enable, second.guard.debounce) = (4095, 17, 127);
    second.guard.limit_freezes = true;
    second.guard = second.guard.active_low(true);
    second
}

/// The modules in a Verilog text, without the values of their parameters.
fn without_values(text: &str) -> String {
    let (_, modules) = text.split_once("`default_nettype none").unwrap();
    let line = |line: &str| match line
        .trim_start()
        .strip_prefix("parameter ")
        .and_then(|rest| rest.split_once(" = "))
    {
        Some((declared, _)) => format!("parameter {declared}\n"),
        None => format!("{line}\n"),
    };
    modules.lines().map(line).collect()
}

#[test]
fn builds_differ_in_the_values_of_parameters_alone() {
    let (first, second) = (first(), second());
    let uart = |clock, baud| LineKind::Uart(Uart::new(clock, baud).unwrap());
    let lines = [uart(80_000_000, 1_000_000), uart(96_000_000, 3_000_000)];
    let parallel =
        [build(80_000_000, 2, StartPhase::Half), build(96_000_000, 200, StartPhase::Zero)];
    let pairs = [
        [&first, &second].map(|build| engine_verilog(build, "a test").unwrap()),
        [(&first, lines[0]), (&second, lines[1])]
            .map(|(build, line)| link_verilog(build, line, "a test").unwrap()),
        lines.map(|line| line_verilog(line, "a test").unwrap()),
        parallel.map(|build| parallel_verilog(&build, AXES, "a test").unwrap()),
    ];
    for [one, other] in pairs {
        assert_ne!(one, other);
        assert_eq!(without_values(&one), without_values(&other));
        // The text contains each module once.
        let mut modules: Vec<&str> =
            one.lines().filter(|line| line.starts_with("module ")).collect();
        let count = modules.len();
        modules.sort_unstable();
        modules.dedup();
        assert_eq!(modules.len(), count);
    }
}

/// Elaborates a top module with one parameter overridden in Icarus. Returns whether this succeeds,
/// and the messages of Icarus.
fn elaborated(folder: &Path, top: &str, parameter: &str, value: &str) -> (bool, String) {
    let change = format!("-P{top}.{parameter}={value}");
    let arguments = ["-g2005", "-s", top, &change, "-o", "out.vvp", "core.v"];
    let output = Command::new("iverilog").args(arguments).current_dir(folder).output();
    let output = output
        .unwrap_or_else(|_| panic!("iverilog is not installed: `cargo xtask tools` installs it"));
    let said = String::from_utf8_lossy(&output.stdout) + String::from_utf8_lossy(&output.stderr);
    (output.status.success(), said.into_owned())
}

#[test]
fn value_out_of_range_is_refused_by_name_and_the_ends_of_the_range_are_not() {
    let cases = [
        ("CLOCKS_PER_TICK", ["80", "65536"], ["65552", "81"], "clocks_per_tick_out_of_range"),
        ("CLOCKS_PER_TICK", ["80", "96"], ["64", "0"], "clocks_per_tick_too_few_for_the_axes"),
        ("STEP_HIGH_0", ["1", "65536"], ["0", "65537"], "step_high_out_of_range"),
        ("STEP_LOW_1", ["1", "65536"], ["0", "131073"], "step_low_out_of_range"),
        ("DIR_SETUP_2", ["1", "65536"], ["0", "65537"], "dir_setup_out_of_range"),
        ("DIR_HOLD_5", ["1", "65536"], ["0", "65537"], "dir_hold_out_of_range"),
        (
            "STOP_ACCEL_4",
            ["1", "4611686018427387904"],
            ["0", "4611686018427387905"],
            "stop_accel_out_of_range_4",
        ),
        ("ROUND_TICKS", ["2", "1024"], ["1", "2048"], "round_ticks_out_of_range"),
        ("ROUND_TICKS", ["4", "512"], ["3", "0"], "round_ticks_out_of_range"),
        ("WATCHDOG_ROUNDS", ["0", "4095"], ["4096", "65536"], "watchdog_rounds_out_of_range"),
        ("ENABLE_ROUNDS", ["0", "4095"], ["4096", "65536"], "enable_rounds_out_of_range"),
        ("DEBOUNCE_SAMPLES", ["1", "127"], ["0", "128"], "debounce_samples_out_of_range"),
        ("LIMITS", ["0", "3"], ["4", "5"], "limits_out_of_range"),
        (
            "EVENT_MEMORY",
            ["\"block\"", "\"distributed\""],
            ["\"ultra\"", "\"\""],
            "event_memory_out_of_range",
        ),
    ];
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("core.v"), engine_verilog(&first(), "a test").unwrap())
        .unwrap();
    let bits = PARAMETERS.iter().filter(|known| known.range == "0 or 1").map(|known| {
        let error = format!("{}_out_of_range", known.name.to_lowercase());
        (known.name, ["0", "1"], ["2", "3"], error)
    });
    let cases = cases.map(|(parameter, good, bad, error)| (parameter, good, bad, error.to_owned()));
    for (parameter, good, bad, error) in cases.into_iter().chain(bits) {
        for value in good {
            let (fine, said) = elaborated(folder.path(), ENGINE_NAME, parameter, value);
            assert!(fine, "{parameter} = {value}: {said}");
        }
        for value in bad {
            let (fine, said) = elaborated(folder.path(), ENGINE_NAME, parameter, value);
            assert!(
                !fine && said.contains(&format!("carrystep_error_{error}")),
                "{parameter} = {value}: {said}"
            );
        }
    }
    // The parameter of the UART.
    let line = LineKind::Uart(Uart::new(80_000_000, 1_000_000).unwrap());
    std::fs::write(folder.path().join("core.v"), line_verilog(line, "a test").unwrap()).unwrap();
    for (value, fits) in [("7", false), ("8", true), ("40000", true), ("40001", false)] {
        let (fine, said) = elaborated(folder.path(), "carrystep_uart", "BIT_CLOCKS", value);
        assert_eq!(fine, fits, "{value}: {said}");
    }
}
