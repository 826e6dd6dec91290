//! Any common clock works without a tick in the machine file, and the command states the chosen
//! tick. A board is not built at a clock that it was measured not to reach.

use crate::command::{Folder, GOOD};
use serde_json::Value;
use std::process::Command;

/// The moves of [`GOOD`] on a machine with this clock and without a tick.
fn at(mhz: u64) -> String {
    GOOD.replace("clock_hz = 48_000_000\ntick_ns = 1000\n", &format!("clock_hz = {mhz}_000_000\n"))
}

#[test]
fn common_clocks_use_and_report_the_shortest_tick() {
    for (mhz, tick_ns, proposed) in [
        (25, 1280, false),
        (27, 16_000, true),
        (50, 640, false),
        (100, 320, false),
        (125, 256, false),
    ] {
        let folder = Folder::with_move(at(mhz));
        let note =
            format!("tick_ns = {tick_ns}, the shortest at {mhz} MHz in 16 phases with 1 axis");
        let proposal = "16000 ns is long: `phases = 4` would allow 4000 ns";
        // The model executes each clock, so it runs at the slowest one only.
        let model = (mhz == 25).then_some("simulate move.toml --core engine --level model");
        let quick = ["plan move.toml", "simulate move.toml", "simulate move.toml --core parallel"];
        for command in quick.into_iter().chain(model) {
            let ran = folder.run(command);
            assert_eq!(ran.status, 0, "{command} at {mhz} MHz: {}{}", ran.stdout, ran.stderr);
            assert!(ran.stdout.contains(&note), "{command}: {}", ran.stdout);
            assert_eq!(ran.stdout.contains(proposal), proposed, "{command}: {}", ran.stdout);
            let json: Value =
                serde_json::from_str(&folder.run(&format!("{command} --json")).stdout).unwrap();
            assert_eq!(json["limits"]["tick_ns"], tick_ns);
            assert!(json["limits"]["tick_note"].as_str().unwrap().starts_with(&note), "{json}");
        }
        folder.write("machine.toml", at(mhz).split("[[move]]").next().unwrap());
        for core in ["engine", "parallel"] {
            let command = format!("verilog --machine machine.toml --core {core} --out out");
            assert!(folder.run(&command).stdout.contains(&note), "{core} at {mhz} MHz");
            let json: Value =
                serde_json::from_str(&folder.run(&format!("{command} --json")).stdout).unwrap();
            assert_eq!(json["tick_ns"], tick_ns);
        }
    }
}

#[test]
fn at_the_default_clock_the_tick_is_1_us_and_nothing_is_said() {
    for text in [at(80), at(80).replace("clock_hz = 80_000_000\n", "")] {
        let folder = Folder::with_move(text);
        let ran = folder.run("plan move.toml");
        assert!(
            ran.stdout.contains(" ticks of 1000 ns, ") && !ran.stdout.contains("shortest"),
            "{}",
            ran.stdout
        );
        let json: Value =
            serde_json::from_str(&folder.run("plan move.toml --json").stdout).unwrap();
        assert_eq!(
            (&json["limits"]["tick_ns"], &json["limits"]["tick_note"]),
            (&1000.into(), &Value::Null)
        );
    }
}

#[test]
fn a_tick_that_does_not_fit_is_refused_with_the_nearest_that_do() {
    let (text, says) = (
        at(25).replace("phases", "tick_ns = 1000\nphases"),
        "640 ns and 1280 ns are the nearest ticks",
    );
    Folder::with_move(text).run("plan move.toml").refuses_at("move.toml", (4, 10), says);
}

/// Runs a build without any tool on the path. A refusal must come before a tool is searched.
fn build(folder: &Folder, arguments: &str) -> crate::command::Ran {
    let mut command = Command::new(env!("CARGO_BIN_EXE_carrystep"));
    folder.output(command.env("PATH", "").arg("build").args(arguments.split(' ')))
}

#[test]
fn clock_that_a_board_does_not_reach_is_refused_with_the_proposed_clock() {
    let folder = Folder::new();
    let machine = at(48).split("[[move]]").next().unwrap().replacen(
        "[[machine",
        "[machine.guard]\nlimits = \"each\"\n[[machine",
        1,
    );
    folder.write("machine.toml", &machine);
    let ran = build(&folder, "--board icebreaker --machine machine.toml --out out");
    let measured = include_str!("../../../boards/data/measured.toml");
    let (_, icebreaker) = measured.split_once("[icebreaker]").unwrap();
    let (_, mhz) = icebreaker.split_once("nextpnr_mhz = ").unwrap();
    let mhz: f64 = mhz.lines().next().unwrap().parse().unwrap();
    ran.refuses(&format!(
        "machine.toml: icebreaker: nextpnr reaches {mhz} MHz with the shipped gateware, far less than the machine's 48 MHz"
    ));
    ran.refuses("37.5 MHz (ticks of 2560 ns in 16 phases)");
    assert_eq!(folder.files(), ["machine.toml"]);
    // With the option the build is tried and then fails because yosys is missing. The same happens
    // at the board's own clock and without a machine.
    folder.write("slow.toml", machine.replace("48_000_000", "37_500_000"));
    for arguments in [
        "--board icebreaker --machine machine.toml --out out --try-clock",
        "--board icebreaker --machine slow.toml --out out",
        "--board icebreaker --out out",
    ] {
        let ran = build(&folder, arguments);
        assert_eq!(ran.status, 3, "{arguments}: {}", ran.stderr);
    }
    let own = std::fs::read_to_string(folder.path("out/machine.toml")).unwrap();
    assert!(own.contains("clock_hz = 37500000\ntick_ns = 2560\n"), "{own}");
}
