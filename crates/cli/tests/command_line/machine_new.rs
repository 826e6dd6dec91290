//! `carrystep machine new`: the file that it writes can be read, planned and simulated; missing
//! values are named or asked for.

use crate::command::{Folder, Ran};
use std::process::Command;

fn new(folder: &Folder, options: &str) -> Ran {
    folder.run(&format!("machine new m.toml {options}"))
}

const BELT: &str = "unit=mm,lead=40,steps_per_rev=200,microsteps=16,speed_limit=200,accel_limit=3000,driver=tmc2209";

/// A move of every axis of the file can be planned, and its pulses pass the check on both cores.
fn moves(folder: &Folder, axes: &[&str]) {
    let to: Vec<String> = axes.iter().map(|axis| format!("{axis} = 1.5")).collect();
    let back: Vec<String> = axes.iter().map(|axis| format!("{axis} = -0.7")).collect();
    let text = format!(
        "machine_file = \"m.toml\"\n[[move]]\nprofile = \"trapezoid\"\nto = {{ {} }}\n[[move]]\nprofile = \"ranade\"\nto = {{ {} }}\n",
        to.join(", "),
        back.join(", ")
    );
    folder.write("move.toml", text);
    for command in ["plan move.toml", "simulate move.toml", "simulate move.toml --core parallel"] {
        let ran = folder.run(command);
        assert_eq!(ran.status, 0, "{command}: {}{}", ran.stdout, ran.stderr);
    }
}

#[test]
fn written_machine_files_plan_and_pass_for_many_options() {
    let rows: [(String, &[&str], &[&str]); 5] = [
        (format!("--board icebreaker --limits each --axis x,{BELT}"), &["x"], &["clock_hz = 37500000", "tick_ns = 2560"]),
        (
            format!("--board icestick --limits one --axis x,{BELT} --axis z,unit=mm,steps_per_unit=400,speed_limit_per_min=900,accel_limit=500,driver=drv8825"),
            &["x", "z"],
            &["speed_limit_per_min = 900    # mm/min", "limits = \"one\""],
        ),
        (
            format!("--clock-hz 27000000 --limits none --axis x,{BELT} --axis y,{BELT} --axis a,unit=deg,lead=360,steps_per_rev=200,microsteps=8,start_speed=20,speed_limit=720,accel_limit=4000,jerk_limit=9e5,driver=dm542"),
            &["x", "y", "a"],
            &["phases = 4", "tick_ns = 4000", "in 16 phases it would be 16000"],
        ),
        (
            "--clock-hz 100000000 --limits pair --axis s,steps_per_unit=1,speed_limit=20000,accel_limit=50000,step_high_ns=500,step_low_ns=600,dir_setup_ns=100,dir_hold_ns=100".to_owned(),
            &["s"],
            &["tick_ns = 320", "step_low_ns = 600"],
        ),
        (format!("--clock-hz 48000000 --limits none --axis x,{BELT} --axis y,{BELT} --axis z,{BELT} --axis a,{BELT}"), &["x", "y", "z", "a"], &["tick_ns = 2000"]),
    ];
    for (options, axes, lines) in rows {
        let folder = Folder::new();
        let ran = new(&folder, &options);
        assert_eq!(ran.status, 0, "{options}: {}", ran.stderr);
        assert_eq!(folder.files(), ["m.toml"]);
        let text = std::fs::read_to_string(folder.path("m.toml")).unwrap();
        for line in lines {
            assert!(text.contains(line), "{line} is not in:\n{text}");
        }
        moves(&folder, axes);
        if let Some(board) =
            options.strip_prefix("--board ").and_then(|rest| rest.split(' ').next())
        {
            assert_eq!(
                folder.run(&format!("verilog --board {board} --machine m.toml --out out")).status,
                0
            );
        }
    }
}

#[test]
fn existing_file_is_replaced_only_with_force() {
    let folder = Folder::new();
    folder.write("m.toml", "mine");
    let options = format!("--clock-hz 50000000 --limits none --axis x,{BELT}");
    new(&folder, &options).refuses("m.toml is there already");
    assert_eq!(std::fs::read_to_string(folder.path("m.toml")).unwrap(), "mine");
    assert_eq!(new(&folder, &format!("{options} --force")).status, 0);
    moves(&folder, &["x"]);
}

#[test]
fn missing_options_without_a_terminal_are_named_and_nothing_is_written() {
    let folder = Folder::new();
    let ran = new(&folder, "--axis x,lead=40,speed_limit=3");
    for says in [
        "--board BOARD, or --clock-hz HZ",
        "--limits pair, each, one or none",
        "of axis x: lead, steps_per_rev, microsteps; or steps_per_unit",
        "of axis x: accel_limit",
        "of axis x: driver; or step_high_ns, step_low_ns, dir_setup_ns, dir_hold_ns",
    ] {
        ran.refuses(says);
    }
    assert!(!ran.stderr.contains("speed_limit_per_min"), "{}", ran.stderr);
    folder.run("machine new m.toml").refuses("--axis NAME,KEY=VALUE,... for each axis");
    let whole = "--clock-hz 50000000 --limits none --axis";
    for (axis, says) in [
        (format!("x,{BELT},colour=red"), "an axis has no key \"colour\"; its keys are unit, "),
        (format!("x,{BELT},unit=cm"), "unit is given twice"),
        (format!("x,{}", BELT.replace("tmc2209", "tmc9999")), "no driver is called 'tmc9999'"),
        (
            format!("x,{}", BELT.replace("200,micro", "fast,micro")),
            "steps_per_rev = fast: a number is expected",
        ),
        (format!("x,{BELT},7"), "\"7\" is not KEY=VALUE"),
        // Errors that only the reader of machine files detects point at the line that would have
        // been written.
        (format!("9x,{BELT}"), "\"9x\" cannot name an axis"),
        (format!("x,{BELT},start_speed=1e5"), "start_speed is over speed_limit"),
        (format!("x,{BELT},steps_per_unit=3"), "both steps_per_unit and lead are given"),
    ] {
        new(&folder, &format!("{whole} {axis}")).refuses(says);
    }
    new(&folder, &format!("--board atlantis --limits none --axis x,{BELT}"))
        .refuses("no board is called 'atlantis'");
    let many: String = (0..9).map(|i| format!("--axis x{i},{BELT} ")).collect();
    new(&folder, &format!("--clock-hz 50000000 --limits none {}", many.trim_end()))
        .refuses("an engine drives at most 8");
}

#[test]
fn json_document_states_what_was_written() {
    let folder = Folder::new();
    let ran = new(&folder, &format!("--board icebreaker --limits each --axis x,{BELT} --json"));
    let json: serde_json::Value = serde_json::from_str(&ran.stdout).unwrap();
    assert_eq!(
        (&json["passed"], &json["file"], &json["tick_ns"]),
        (&true.into(), &"m.toml".into(), &2560.into())
    );
    let board = folder.run("verilog --board icebreaker --machine m.toml --out out --json");
    let board: serde_json::Value = serde_json::from_str(&board.stdout).unwrap();
    assert_eq!(json["build_id"], board["build_id"]);
}

#[cfg(unix)]
#[test]
fn questions_on_a_terminal_are_repeated_after_invalid_answers() {
    let folder = Folder::new();
    let mut command = Command::new(env!("CARGO_BIN_EXE_carrystep"));
    command.args(["machine", "new", "m.toml"]).current_dir(folder.path(""));
    let mut screen = crate::terminal::Screen::start(&mut command);
    for (question, answer) in [
        ("Board (see `carrystep boards`), or the FPGA's clock in MHz [80]: ", "atlantis"),
        ("no board is called 'atlantis'", "icebreaker"),
        ("none [each]: ", "some"),
        ("one of pair, each, one, none is expected", "one"),
        ("blanks between [x y z]: ", "x z"),
        ("Axis x: unit of length [mm]: ", ""),
        ("Axis x: mm that one turn of the motor moves", "40"),
        ("full steps of a turn [200]: ", ""),
        ("microsteps of the driver [16]: ", "sixteen"),
        ("a number is expected", "8"),
        ("Axis x: greatest speed in mm/s", "6000/min"),
        ("Axis x: greatest acceleration in mm/s^2", "2000"),
        ("Axis x: driver", "tmc2209"),
        ("Axis z: unit of length", "in"),
        ("Axis z: in that one turn", "0.2"),
        ("full steps", ""),
        ("microsteps", ""),
        ("greatest speed in in/s", "1"),
        ("greatest acceleration in in/s^2", "10"),
        ("driver", ""),
    ] {
        screen.waits_for(question);
        screen.types(&format!("{answer}\n"));
    }
    screen.waits_for("wrote m.toml: axes x, z, 37.5 MHz, ticks of 2560 ns in 16 phases");
    assert!(screen.ends().success());
    let text = std::fs::read_to_string(folder.path("m.toml")).unwrap();
    for line in [
        "speed_limit_per_min = 6000",
        "microsteps = 8 ",
        "limits = \"one\"",
        "unit = \"in\"",
        "driver = \"a4988\"",
    ] {
        assert!(text.contains(line), "{line} is not in:\n{text}");
    }
    moves(&folder, &["x", "z"]);
}
