//! Machines whose letter y has two motors, at the command line: from the program to the pins of
//! `simulate` and of a board, homing, and what is refused.

use crate::command::{Folder, Ran};
use crate::sender::{Sender, Served};
use crate::virtual_boards::{Board, passed};
use std::collections::BTreeMap;

const MACHINE: &str = r#"[machine]
clock_hz = 24_000_000
tick_ns = 2000

[machine.guard]
watchdog_ms = 4000
debounce_us = 100
limits = "pair"

[machine.link]
baud = 1_500_000

[[machine.axis]]
name = "x"
steps_per_unit = 80
speed_limit = 50
accel_limit = 1000
driver = "tmc2209"

[[machine.axis]]
name = "y"
steps_per_unit = 80
speed_limit = 50
accel_limit = 1000
driver = "tmc2209"
travel = [-1, 50]
home = { toward = "min", seek_speed = 20, slow_speed = 2, move_off = 3, pull_off = 1, position = 0, most_apart = 4 }

[[machine.axis]]
name = "y2"
letter = "y"
steps_per_unit = 80
speed_limit = 60
accel_limit = 900
driver = "a4988"
home = { toward = "min", seek_speed = 20, slow_speed = 2, move_off = 3, pull_off = 0.5, position = 0.5, most_apart = 5 }
"#;

const JOB: &str =
    "G21 G90 G64 P0.02 F1500\nG1 X4 Y2\nG3 X2 Y4 I-2\nG1 Y9\nG0 Y1\nG1 X0 Y1 F900\nM2\n";

fn folder() -> Folder {
    let folder = Folder::new();
    folder.write("machine.toml", MACHINE);
    folder.write("job.ngc", JOB);
    folder
}

pub fn on(folder: &Folder, board: &Board, command: &str) -> Ran {
    folder.run(&format!("{command} --machine machine.toml --port {}", board.port))
}

/// The changes of STEP and DIR of each axis in a capture by carrystep, ps since its start.
pub fn pins(vcd: &str) -> BTreeMap<(String, String), Vec<(u64, char)>> {
    let (mut names, mut scope, mut ps, mut origin) = (BTreeMap::new(), String::new(), 0, 0);
    let mut pins: BTreeMap<_, Vec<_>> = BTreeMap::new();
    for line in vcd.lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        match words[..] {
            ["$scope", _, name, ..] => scope = name.to_owned(),
            ["$var", _, "1", id, pin, ..] => {
                names.insert(id.to_owned(), (scope.clone(), pin.to_owned()));
            }
            ["carrystep", given, ..] if given.starts_with("origin_ps=") => {
                origin = given["origin_ps=".len()..].parse().unwrap();
            }
            [one] if one.starts_with('#') => ps = one[1..].parse().unwrap(),
            [one] if one.starts_with(['0', '1']) => {
                if let Some(pin) = names.get(&one[1..]).filter(|_| ps >= origin) {
                    let level = one.chars().next().unwrap();
                    pins.entry(pin.clone()).or_default().push((ps - origin, level));
                }
            }
            _ => {}
        }
    }
    pins
}

#[test]
fn both_motors_of_a_gantry_make_one_train_of_pulses_in_simulate_and_on_a_board() {
    let folder = folder();
    folder.write("machine.toml", MACHINE.replace("home =", "# home ="));
    let ran = folder.run("simulate job.ngc --machine machine.toml --vcd s.vcd");
    passed(&ran);
    let board = Board::new(&folder, "--vcd b.vcd --fast");
    passed(&folder.run(&format!("run job.ngc --machine machine.toml --port {}", board.port)));
    board.end();
    passed(&folder.run("check b.vcd job.ngc --machine machine.toml"));
    let [simulated, run] =
        ["s.vcd", "b.vcd"].map(|name| pins(&std::fs::read_to_string(folder.path(name)).unwrap()));
    let of = |pins: &BTreeMap<_, Vec<_>>, axis: &str, pin: &str| {
        pins.get(&(axis.to_owned(), pin.to_owned())).cloned().unwrap_or_default()
    };
    for pin in ["step", "dir"] {
        let first = of(&simulated, "y", pin);
        assert!(!first.is_empty());
        for (pins, what) in [(&simulated, "simulate"), (&run, "run")] {
            assert_eq!(of(pins, "y", pin), first, "{pin} of y in {what}");
            assert_eq!(of(pins, "y2", pin), first, "{pin} of y2 in {what}");
            assert_eq!(of(pins, "x", pin), of(&simulated, "x", pin), "{pin} of x in {what}");
        }
    }
    // The program goes to y = 9 and back to 1: 10 mm of 80 steps and a little more or less.
    let rises = of(&run, "y2", "step").iter().filter(|(_, level)| *level == '1').count();
    assert!((1350..1400).contains(&rises), "{rises}");
}

#[test]
fn report_of_a_gantry_counts_the_speed_of_the_tool_once() {
    let folder = folder();
    folder.write("two.toml", MACHINE.replace("accel_limit = 900", "accel_limit = 1000"));
    let (one, _) = MACHINE.rsplit_once("[[machine.axis]]").unwrap();
    folder.write("one.toml", one.replace(", most_apart = 4", ""));
    let [one, two] = ["one", "two"].map(|machine| {
        let ran = folder.run(&format!("plan job.ngc --machine {machine}.toml --json"));
        passed(&ran);
        let document: serde_json::Value = serde_json::from_str(&ran.stdout).unwrap();
        document["time_use"]["causes"].clone()
    });
    assert!(one.as_array().is_some_and(|causes| causes.len() > 2), "{one}");
    assert_eq!(one, two);
}

#[test]
fn gantry_homes_square_twice_jogs_and_runs() {
    let folder = folder();
    let board = Board::new(&folder, "--min y=-200 --min y2=-40 --fast");
    for _ in 0..2 {
        let ran = on(&folder, &board, "home");
        passed(&ran);
        // Each is 1 mm, 0.5 mm of the second, from its switch, and both are at 1 mm.
        let ends = |axis: &str, machine: &str| {
            let line = ran.stdout.lines().find(|line| line.split_whitespace().next() == Some(axis));
            assert!(line.is_some_and(|line| line.ends_with(machine)), "{}", ran.stdout);
        };
        ends("y", "1.0000 units");
        ends("y2", "1.0000 units");
    }
    passed(&on(&folder, &board, "jog y 1"));
    let ran = on(&folder, &board, "jog y2 1");
    assert!(ran.stderr.contains("'y2' is a motor of the letter y: name y"), "{}", ran.stderr);
    let ran = on(&folder, &board, "home y2");
    assert!(ran.stderr.contains("'y2' is a motor of the letter y: name y"), "{}", ran.stderr);
    passed(&on(&folder, &board, "run job.ngc"));
    let status = on(&folder, &board, "status").stdout;
    assert_eq!(status.matches("homed: at 1.0000 of the machine").count(), 2, "{status}");
    board.end();
}

/// z comes behind the second motor of y, so the number of its motor is not that of its letter.
const Z: &str = r#"
[[machine.axis]]
name = "z"
steps_per_unit = 80
speed_limit = 50
accel_limit = 1000
driver = "tmc2209"
"#;

/// The positions of the motors, steps.
pub fn positions(folder: &Folder, board: &Board) -> Vec<i64> {
    let told = on(folder, board, "status --json").stdout;
    let told: serde_json::Value = serde_json::from_str(&told).unwrap();
    let axes = told["axes"].as_array().unwrap().iter();
    axes.map(|axis| axis["position"].as_i64().unwrap()).collect()
}

#[test]
fn sender_homes_and_moves_both_motors_and_no_axis_into_its_closed_switch() {
    let folder = folder();
    // Four motors need a longer tick.
    let machine = (MACHINE.to_owned() + Z).replace("\"pair\"", "\"each\"");
    folder.write("machine.toml", machine.replace("tick_ns = 2000", "tick_ns = 4000"));
    let board = Board::new(&folder, "--min y=-200 --min y2=-40 --min z=-160 --fast");
    let served = Served::with(&folder, &format!("--port {}", board.port));
    let mut sender = Sender::tcp(&served);
    for _ in 0..2 {
        sender.done("$H");
        assert_eq!(sender.place(), [0.0, 1.0, 0.0]);
    }
    let before = positions(&folder, &board);
    sender.simple("G21 G91\nG1 X1 Y3 F900");
    assert_eq!(sender.place(), [1.0, 4.0, 0.0]);
    let moved = |after: Vec<i64>| before.iter().zip(after).map(|(a, b)| b - a).collect::<Vec<_>>();
    assert_eq!(moved(positions(&folder, &board)), [80, 240, 240, 0]);

    sender.send("G0 Z-4\n");
    sender.until(|line| line == "ALARM:1");
    sender.done("$X");
    let at = sender.place();
    assert!(at[2] < -2.0, "{at:?}");
    sender.send("G0 Z-1\n");
    sender.until(|line| line == "ALARM:1");
    let said = sender.next().unwrap();
    assert!(said.contains("the limit switch of axis z is closed"), "{said}");
    sender.done("$X");
    assert_eq!(sender.place(), at);
    sender.simple("G0 Z4 Y-1");
    assert_eq!(sender.place()[..2], [1.0, 3.0]);
    assert_eq!(moved(positions(&folder, &board))[1..3], [160, 160]);
    assert_eq!(served.interrupt().0, 0);
    board.end();
}

#[test]
fn dead_switch_of_one_side_is_named_and_the_program_is_refused_afterwards() {
    let folder = folder();
    let board = Board::new(&folder, "--min y=-200");
    let ran = on(&folder, &board, "home");
    assert_ne!(ran.status, 0);
    let says =
        "y2 moved further than the other motor of its letter, over most_apart (y2 by 4 units";
    assert!(ran.stderr.contains(says), "{}", ran.stderr);
    let ran = on(&folder, &board, "run job.ngc");
    assert!(ran.stderr.contains("y, y2 are not homed"), "{}", ran.stderr);
    board.end();
}

#[test]
fn linuxcnc_refuses_a_gantry_by_name() {
    let folder = folder();
    let ran = folder.run("linuxcnc --machine machine.toml --out out --port /dev/ttyUSB0");
    assert!(ran.stderr.contains("the letter y has several motors, 'y2' for one"), "{}", ran.stderr);
}
