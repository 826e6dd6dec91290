//! The engine as a user sees it: its Verilog, its refusals, and moves that run on it.

use crate::command::{Folder, edit};
use serde_json::Value;

/// One axis with a tick that is long enough for six. Every line is unique.
const MACHINE: &str = r#"[machine]
clock_hz = 80_000_000
tick_ns = 1000
phases = 16

[machine.guard]
watchdog_ms = 50
enable_ms = 0.1
debounce_us = 100
estop = "low"
limits = "each"
limit_level = "low"
limit_stop = "freeze"

[[machine.axis]]
name = "x"
steps_per_unit = 5
start_speed = 200
speed_limit = 1000
accel_limit = 5000
stop_accel = 20_000
driver = "a4988"
"#;

const MOVES: &str = r#"
[[move]]
profile = "ranade"
to = { x = 2 }

[[move]]
profile = "trapezoid"
time = 0.05
to = { x = -1.3 }
"#;

/// A move of three steps, which Rust-HDL simulates quickly.
const SHORT: &str = r#"
[[move]]
profile = "constant"
time = 0.002
to = { x = 0.4 }

[[move]]
profile = "constant"
time = 0.001
to = { x = -0.2 }
"#;

const WRITE: &str = "verilog --machine m.toml --core engine --out out";

fn with_machine(text: impl AsRef<[u8]>) -> Folder {
    let folder = Folder::new();
    folder.write("m.toml", text);
    folder
}

#[test]
fn the_verilog_says_what_its_guard_does() {
    let folder = with_machine(MACHINE);
    let ran = folder.run(WRITE);
    assert_eq!((ran.status, ran.stderr.as_str()), (0, ""));
    let files =
        ["v", "vlt", "veo", "xdc", "sdc"].map(|kind| format!("out/carrystep_engine.{kind}"));
    let said: String = files.iter().map(|file| format!("wrote {file}\n")).collect();
    assert_eq!(ran.stdout, said);
    let mut found = files.to_vec();
    found.extend(["m.toml", "out"].map(str::to_owned));
    found.sort();
    assert_eq!(folder.files(), found);
    let text = std::fs::read_to_string(folder.path("out/carrystep_engine.v")).unwrap();
    for line in [
        "// Made from    m.toml",
        "// Guard        counts in rounds of 16 ticks, 16 us",
        "//   watchdog   50 to 50.017 ms without a valid frame of the host: ramp",
        "//   enable     0.112 to 0.129 ms from ENABLE to the first start",
        "//   e-stop     active low: freeze",
        "//   limits     one per axis, active low, debounced for 112 to 129 us: freeze",
        "//   axis 0     ramps by 100000 steps/s^2",
    ] {
        assert!(text.lines().any(|found| found == line), "no line {line} in\n{}", &text[..2000]);
    }
    let none = MACHINE
        .replace("watchdog_ms = 50", "watchdog_ms = 0")
        .replace("enable_ms = 0.1", "enable_ms = 0");
    let folder = with_machine(none.replace("\"each\"", "\"none\""));
    assert_eq!(folder.run(WRITE).status, 0);
    let text = std::fs::read_to_string(folder.path("out/carrystep_engine.v")).unwrap();
    for line in [
        "//   watchdog   none",
        "//   enable     no time from ENABLE to the first start",
        "//   limits     none",
    ] {
        assert!(text.lines().any(|found| found == line), "{line}");
    }
}

#[test]
fn the_document_has_the_guard_as_counted() {
    let ran = with_machine(MACHINE).run(&format!("{WRITE} --json"));
    let document: Value = serde_json::from_str(&ran.stdout).unwrap();
    let names =
        |value: &Value| value.as_object().unwrap().keys().cloned().collect::<Vec<_>>().join(" ");
    assert_eq!(names(&document), "files guard passed schema tick_note tick_ns top");
    assert_eq!(
        names(&document["guard"]),
        "debounce_us enable_ms estop limit_level limit_stop limits round_us stop_accel_steps_per_s2 watchdog_ms"
    );
    assert_eq!(document["top"], "carrystep_engine");
    assert_eq!(
        document["guard"]["watchdog_ms"],
        serde_json::json!({ "least": 50.0, "most": 50.017 })
    );
    assert_eq!(document["guard"]["limits"], "each");
}

#[test]
fn impossible_builds_are_refused_and_leave_no_file() {
    let rows = [
        ("phases = 16", "phases = ^5", "5 phases: a tick has 1, 4 or 16 phases"),
        ("clock_hz = 80_000_000", "clock_hz = ^84_000_000", ""),
        (
            "speed_limit = 1000",
            "speed_limit = ^97_000",
            "over what the driver's step_high and step_low allow",
        ),
        (
            "driver = \"a4988\"",
            "driver = \"a4988\"\nstep_high_ns = ^9_000_000",
            "step_high_ns = 9000000 ns is 720000 clocks",
        ),
        ("watchdog_ms = 50", "watchdog_ms = ^5000", "at most 4192.256 can be counted"),
        ("enable_ms = 0.1", "enable_ms = ^-0.1", "must be zero or more"),
        ("debounce_us = 100", "debounce_us = ^nan", "not a usable number"),
        ("estop = \"low\"", "estop = ^\"none\"", "unknown variant `none`"),
        ("limits = \"each\"", "limits = ^3", "expected a word in quotes"),
        ("limit_stop = \"freeze\"", "^limits_stop = \"freeze\"", "unknown field `limits_stop`"),
        ("stop_accel = 20_000", "stop_accel = ^0", "stop_accel = 0: must be over zero"),
        ("stop_accel = 20_000", "stop_accel = ^1e20", "not from 2^-64 to 1/4 step per tick^2"),
    ];
    for (old, new, says) in rows {
        let (text, place) = edit(MACHINE, old, new);
        let folder = with_machine(text);
        let says = if says.is_empty() {
            "84 clocks per tick do not divide into 16 equal phases"
        } else {
            says
        };
        let ran = folder.run(WRITE);
        ran.refuses(says);
        // If clock, tick and phases do not fit together, the error points at all of them.
        let place = if says.contains("do not divide") { (4, 10) } else { place };
        ran.refuses_at("m.toml", place, says);
        assert_eq!(folder.files(), ["m.toml"]);
    }
}

#[test]
fn a_schedule_that_does_not_fit_is_refused_with_the_arithmetic() {
    let axis = MACHINE.split_once("[[machine.axis]]").unwrap().1;
    let six: String = (1..6)
        .map(|i| format!("[[machine.axis]]{}", axis.replace("\"x\"", &format!("\"x{i}\""))))
        .collect();
    let text = format!("{MACHINE}{six}").replace("80_000_000", "48_000_000");
    let folder = with_machine(&text);
    folder.run(WRITE).refuses(
        "m.toml: 6 axes need 13 clocks each and two to close the tick, 80 in all, but a tick of 1000 ns at 48000000 Hz has \
         48: a tick of 2000 ns, a clock of 80000000 Hz or fewer axes would do; the parallel core holds it as it is: \
         `--core parallel`",
    );
    folder.write("move.toml", format!("{text}{MOVES}"));
    let simulate = "simulate move.toml --core engine --vcd a.vcd --csv a.csv";
    folder.run(simulate).refuses("move.toml: 6 axes need 13 clocks each");
    // The engine is what is meant where no core is named; all that is said would do.
    for command in [
        "simulate move.toml",
        "simulate move.toml --json",
        "simulate move.toml --level verilator",
        "verilog --machine m.toml --out out",
    ] {
        let ran = folder.run(command);
        ran.refuses("a tick of 2000 ns, a clock of 80000000 Hz or fewer axes would do");
        ran.refuses("`--core parallel`");
    }
    assert_eq!(folder.files(), ["m.toml", "move.toml"]);
    assert_eq!(folder.run("verilog --machine m.toml --core parallel --out out").status, 0);
    assert_eq!(folder.run("simulate move.toml --core parallel").status, 0);
    for (old, new) in [("tick_ns = 1000", "tick_ns = 2000"), ("48_000_000", "80_000_000")] {
        folder.write("other.toml", text.replace(old, new) + MOVES);
        assert_eq!(folder.run("simulate other.toml").status, 0, "{new}");
    }
}

#[test]
fn phases_of_one_clock_are_refused_by_the_engine_with_what_would_do() {
    let text = MACHINE.replace("80_000_000", "16_000_000") + MOVES;
    let folder = Folder::with_move(&text);
    folder.run("simulate move.toml").refuses(
        "move.toml: 16 phases in the 16 clocks of a tick: an engine needs 2 clocks in each; a tick of 2000 ns, a clock of \
         32000000 Hz or fewer phases would do; the parallel core holds it as it is: `--core parallel`",
    );
    assert_eq!(folder.run("simulate move.toml --core parallel").status, 0);
    for (old, new) in [
        ("tick_ns = 1000", "tick_ns = 2000"),
        ("16_000_000", "32_000_000"),
        ("phases = 16", "phases = 4"),
    ] {
        folder.write("other.toml", text.replace(old, new));
        assert_eq!(folder.run("simulate other.toml").status, 0, "{new}");
    }
}

#[test]
fn the_engine_is_what_runs_where_no_core_is_named() {
    let folder = Folder::with_move(format!("{MACHINE}{MOVES}"));
    folder.write(
        "sweep.toml",
        format!("move_file = '''\n{MACHINE}{MOVES}'''\n[vary]\nnothing = [1]\n"),
    );
    let core = |arguments: &str| {
        let ran = folder.run(&format!("{arguments} --json"));
        assert_eq!(ran.status, 0, "{arguments}: {}", ran.stderr);
        serde_json::from_str::<Value>(&ran.stdout).unwrap()["core"].clone()
    };
    for (command, written) in [
        ("demo --out demo", Some("demo")),
        ("simulate move.toml", None),
        ("sweep sweep.toml", None),
    ] {
        assert_eq!(core(command), "engine", "{command}");
        assert_eq!(core(&format!("{command} --core engine")), "engine", "{command}");
        if let Some(out) = written {
            assert!(folder.files().contains(&format!("{out}/carrystep_engine.v")));
            assert!(!folder.files().contains(&format!("{out}/carrystep_parallel_6.v")));
        }
        assert_eq!(core(&format!("{command} --core parallel")), "parallel", "{command}");
    }
    assert!(folder.files().contains(&"demo/carrystep_parallel_6.v".to_owned()));
    assert_eq!(
        folder.run("verilog --out hdl").stdout,
        folder.run("verilog --core engine --out hdl").stdout
    );
    assert!(folder.files().contains(&"hdl/carrystep_engine.v".to_owned()));
}

#[test]
fn nine_axes_are_too_many_for_any_core_and_seven_for_the_parallel_one() {
    let (head, axis) = MACHINE.split_once("[[machine.axis]]").unwrap();
    let axes = |count: usize| {
        let axis = |i| format!("[[machine.axis]]{}", axis.replace("\"x\"", &format!("\"x{i}\"")));
        format!("{head}{}", (0..count).map(axis).collect::<String>())
    };
    let folder = with_machine(axes(9));
    for core in ["engine", "parallel"] {
        let ran = folder.run(&format!("verilog --machine m.toml --core {core} --out out"));
        ran.refuses_at("m.toml", (15 + 8 * 8, 1), "9 axes: an engine drives at most 8");
    }
    folder.write("m.toml", axes(7));
    let parallel = "verilog --machine m.toml --core parallel --out out";
    folder.run(parallel).refuses("m.toml: 7 axes: the parallel gateware drives at most 6");
    // Seven time slots do not fit into 80 clocks, and no other core is offered for them.
    let engine = folder.run("verilog --machine m.toml --out out");
    engine.refuses("m.toml: 7 axes need 13 clocks each and two to close the tick, 93 in all");
    engine.refuses("a tick of 1200 ns, a clock of 96000000 Hz or fewer axes would do");
    assert!(!engine.stderr.contains("--core"), "{}", engine.stderr);
    folder
        .write("move.toml", format!("machine_file = \"m.toml\"\n{}", MOVES.replace("x =", "x0 =")));
    folder.run("plan move.toml").refuses_at(
        "move.toml",
        (1, 16),
        "7 axes: moves are planned for at most 6",
    );
    assert_eq!(folder.files(), ["m.toml", "move.toml"]);
    folder
        .run("verilog --core serial --out out")
        .refuses("invalid value 'serial' for '--core <CORE>'");
}

/// The report of a run, and its waveform.
fn run(folder: &Folder, more: &str) -> (Value, String) {
    let ran = folder.run(&format!("simulate move.toml --vcd a.vcd --json {more}"));
    assert_eq!((ran.status, ran.stderr.as_str()), (0, ""), "{more}: {}", ran.stdout);
    (
        serde_json::from_str(&ran.stdout).unwrap(),
        std::fs::read_to_string(folder.path("a.vcd")).unwrap(),
    )
}

#[test]
fn moves_on_the_engine_have_the_pulses_of_the_parallel_core() {
    for (moves, level) in [(MOVES, "model"), (SHORT, "rust-hdl")] {
        let folder = Folder::with_move(format!("{MACHINE}{moves}"));
        let (parallel, _) = run(&folder, "--core parallel");
        let (engine, waves) = run(&folder, "--core engine");
        assert_eq!((&parallel["core"], &parallel["level"]), (&"parallel".into(), &"fast".into()));
        assert_eq!((&engine["core"], &engine["level"]), (&"engine".into(), &"fast".into()));
        let (same, same_waves) = run(&folder, &format!("--core engine --level {level}"));
        assert_eq!(
            (&same["check"], &same["clocks"], &same_waves),
            (&engine["check"], &engine["clocks"], &waves)
        );
        assert_eq!(
            (&engine["faults"], &engine["positions"]),
            (&parallel["faults"], &parallel["positions"])
        );
        // The engine starts later; after that everything is equal.
        assert!(engine["check"]["origin_ps"].as_u64() > parallel["check"]["origin_ps"].as_u64());
        assert_eq!(engine["check"]["axes"], parallel["check"]["axes"]);
        let checked = folder.run("check a.vcd move.toml");
        assert_eq!(checked.status, 0, "{}", checked.stdout);
    }
}

#[test]
fn missing_verilator_is_reported_with_its_installation() {
    let folder = Folder::with_move(format!("{MACHINE}{MOVES}"));
    let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_carrystep"));
    command
        .args("simulate move.toml --core engine --level verilator --vcd a.vcd".split(' '))
        .env("PATH", "");
    let ran = folder.output(&mut command);
    assert_eq!((ran.status, ran.stdout.as_str()), (3, ""));
    assert!(ran.stderr.contains("sudo apt-get install verilator"), "{}", ran.stderr);
    assert_eq!(folder.files(), ["move.toml"]);
}
