//! Machines with two crossed belts at the command line: from the program to the pins of `simulate` and
//! of a board, homing, jogs, senders, and what is refused.

use crate::command::{Folder, Ran};
use crate::gantries::{on, pins, positions};
use crate::sender::{Sender, Served};
use crate::virtual_boards::{Board, passed};

const MACHINE: &str = r#"[machine]
clock_hz = 24_000_000
tick_ns = 2000
kinematics = "corexy"

[machine.guard]
watchdog_ms = 4000
debounce_us = 100
limits = "one"

[machine.link]
baud = 1_500_000

[[machine.axis]]
name = "x"
unit = "mm"
steps_per_unit = 80
speed_limit = 50
accel_limit = 1000
driver = "tmc2209"
travel = [-1, 50]
home = { toward = "min", seek_speed = 20, slow_speed = 2, move_off = 3, pull_off = 1, position = 0 }

[[machine.axis]]
name = "y"
unit = "mm"
steps_per_unit = 80
speed_limit = 60
accel_limit = 900
driver = "tmc2209"
travel = [-1, 40]
home = { toward = "max", seek_speed = 20, slow_speed = 2, move_off = 3, pull_off = 1, position = 40 }

[[machine.axis]]
name = "z"
unit = "mm"
steps_per_unit = 80
speed_limit = 20
accel_limit = 500
driver = "tmc2209"
"#;

const JOB: &str =
    "G21 G90 G64 P0.02 F1500\nG1 X4 Y2\nG3 X2 Y4 I-2\nG1 X9 Y11\nG0 Y1.5\nG1 X2 Y1 Z1 F900\nM2\n";

fn folder() -> Folder {
    let folder = Folder::new();
    folder.write("machine.toml", MACHINE);
    folder.write("job.ngc", JOB);
    folder
}

fn json(ran: &Ran) -> serde_json::Value {
    passed(ran);
    serde_json::from_str(&ran.stdout).unwrap()
}

#[test]
fn pulses_of_crossed_belts_are_those_of_simulate_on_a_board_and_pass_the_check() {
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
    for (axis, least) in [("x", 2500), ("y", 1000), ("z", 80)] {
        for pin in ["step", "dir"] {
            let of = (axis.to_owned(), pin.to_owned());
            assert_eq!(simulated.get(&of), run.get(&of), "{pin} of {axis}");
        }
        let rises = run[&(axis.to_owned(), "step".to_owned())].iter();
        let rises = rises.filter(|(_, level)| *level == '1').count();
        assert!((least..2 * least).contains(&rises), "{axis}: {rises}");
    }
    // A capture of the belts is none of a machine whose motors are x and y.
    let cartesian = MACHINE.replace("kinematics = \"corexy\"\n", "").replace("home =", "# home =");
    folder.write("cartesian.toml", cartesian);
    let ran = folder.run("check b.vcd job.ngc --machine cartesian.toml");
    assert_ne!(ran.status, 0, "{}", ran.stdout);
}

#[test]
fn probe_of_crossed_belts_trips_at_the_place_of_the_tool() {
    let folder = folder();
    let inputs = "[machine.inputs]\nprobe = \"low\"\n\n[[machine.axis]]";
    let machine = MACHINE.replace("home =", "# home =").replace("travel =", "# travel =").replacen(
        "[[machine.axis]]",
        inputs,
        1,
    );
    folder.write("machine.toml", machine);
    let job = "G21 G90 F1200\nG1 X4 Y2\nG38.2 X-6 F100\nG1 X[#5061 + 1] F300\nM2\n";
    folder.write("job.ngc", job);
    // The probe closes where the tool is at x = -2.5 mm.
    let board = Board::new(&folder, "--fast --probe x=-200");
    let ran = folder.run(&format!("run job.ngc --machine machine.toml --port {}", board.port));
    passed(&ran);
    assert!(
        ran.stderr.contains("line 3: the probe has tripped at machine x -2.49"),
        "{}",
        ran.stderr
    );
    let [x, y, z] = positions(&folder, &board)[..] else { panic!("three motors") };
    // The tool has come back by 1 mm, to x = -1.5 and y = 2; the motors are at x + y and x - y.
    assert!((40..=41).contains(&x), "{x}");
    assert_eq!((x - y, z), (320, 0));
}

#[test]
fn plan_shows_places_of_letters_and_limits_of_motors() {
    let folder = folder();
    let told = json(&folder.run("plan job.ngc --machine machine.toml --at x=1,y=1 --json"));
    assert_eq!(told["kinematics"], "corexy");
    let axes = told["axes"].as_array().unwrap();
    let near = |value: &serde_json::Value, wanted: f64| {
        assert!((value.as_f64().unwrap() - wanted).abs() < 0.03, "{value}, {wanted}");
    };
    near(&axes[0]["least"], 1.0);
    near(&axes[0]["greatest"], 9.0);
    near(&axes[1]["least"], 1.0);
    near(&axes[1]["greatest"], 11.0);
    // The motors begin at x + y = 2 mm and x - y = 0, and both have the least limits.
    assert_eq!([&axes[0], &axes[1]].map(|axis| axis["start_steps"].as_i64().unwrap()), [160, 0]);
    for axis in &axes[..2] {
        assert_eq!(axis["speed_limit_steps_per_s"], 4000.0);
        assert!(axis["speed_steps_per_s"].as_f64().unwrap() <= 4000.0);
        assert_eq!(axis["acceleration_limit_steps_per_s2"], 72_000.0);
    }
    let text = folder.run("plan job.ngc --machine machine.toml").stdout;
    assert!(text.contains("crossed belts: from and to are those of x and y"), "{text}");
}

#[test]
fn report_of_crossed_belts_draws_the_tool_and_names_the_motors() {
    let folder = folder();
    passed(&folder.run("plan job.ngc --machine machine.toml --report page.html"));
    let page = std::fs::read_to_string(folder.path("page.html")).unwrap();
    for text in ["motor x: x + y", "motor y: x - y", "axis z"] {
        assert!(page.contains(text), "{text}");
    }
    let from = page.find("\"path\":{").unwrap();
    let list = |key: &str| -> Vec<f64> {
        let from = from + page[from..].find(&format!("\"{key}\":[")).unwrap() + key.len() + 4;
        let to = from + page[from..].find(']').unwrap();
        page[from..to].split(',').map(|value| value.parse().unwrap()).collect()
    };
    for (key, most) in [("x", 9.0), ("y", 11.0)] {
        let greatest = list(key).into_iter().fold(f64::MIN, f64::max);
        assert!((greatest - most).abs() < 0.05, "{key}: {greatest}");
    }
    let fastest = list("speed").into_iter().fold(f64::MIN, f64::max);
    // Along y at G0, at the limit of both motors.
    assert!((40.0..=50.0).contains(&fastest), "{fastest}");
}

#[test]
fn crossed_belts_home_twice_jog_run_and_are_known_to_status() {
    let folder = folder();
    // The switches are 10 mm below in x and 5 mm above in y.
    let board = Board::new(&folder, "--min x=-800 --max y=400 --fast");
    for _ in 0..2 {
        let told = json(&on(&folder, &board, "home --json"));
        let places: Vec<f64> = told["axes"]
            .as_array()
            .unwrap()
            .iter()
            .map(|axis| axis["machine"].as_f64().unwrap())
            .collect();
        for (place, wanted) in places.iter().zip([1.0, 39.0]) {
            assert!((place - wanted).abs() < 0.02, "{places:?}");
        }
    }
    // One letter alone: the other one keeps its place.
    let ran = on(&folder, &board, "home x");
    passed(&ran);
    let place = || {
        let told = json(&on(&folder, &board, "status --json"));
        [0, 1].map(|axis| told["axes"][axis]["machine"].as_f64().unwrap())
    };
    let before = place();
    assert!((before[0] - 1.0).abs() < 0.02 && (before[1] - 39.0).abs() < 0.02, "{before:?}");
    let motors = positions(&folder, &board);
    passed(&on(&folder, &board, "jog y -30"));
    let moved = positions(&folder, &board);
    assert_eq!([moved[0] - motors[0], moved[1] - motors[1]], [-2400, 2400]);
    passed(&on(&folder, &board, "jog --axis x=5,y=-2"));
    let after = place();
    assert!((after[0] - before[0] - 5.0).abs() < 1e-9, "{after:?}");
    assert!((after[1] - before[1] + 32.0).abs() < 1e-9, "{after:?}");
    let ran = on(&folder, &board, "jog x 45");
    assert!(ran.stderr.contains("x would go to 51"), "{}", ran.stderr);
    let ran = on(&folder, &board, "jog y 34");
    assert!(ran.stderr.contains("beyond its travel of -1 to 40 mm"), "{}", ran.stderr);
    passed(&on(&folder, &board, "run job.ngc"));
    let end = place();
    assert!((end[0] - 2.0).abs() < 0.02 && (end[1] - 1.0).abs() < 0.02, "{end:?}");
    board.end();
}

#[test]
fn limit_switch_stops_the_tool_at_45_degrees_and_guards_the_letters_behind_it() {
    let folder = folder();
    let open = MACHINE.replace("home =", "# home =").replace("travel", "# travel");
    folder.write("machine.toml", open);
    let board = Board::new(&folder, "--min x=-800 --fast");
    // At 45 degrees the motor of x rests.
    folder.write("into.ngc", "G21 G90 F1200\nG1 X-20 Y20\nM2\n");
    let ran = on(&folder, &board, "run into.ngc");
    assert_ne!(ran.status, 0);
    let says = "limit, axis x moving back and y moving forward";
    assert!(ran.stdout.contains(says), "{}", ran.stdout);
    let at = positions(&folder, &board);
    assert!(at[0] == 0 && at[1] < -1600 && at[1] > -1800, "{at:?}");
    let ran = on(&folder, &board, "jog y 1");
    let says = "the limit switch of axis y is closed, and the axis would move further forward";
    assert!(ran.stderr.contains(says), "{}", ran.stderr);
    let ran = on(&folder, &board, "jog x -1");
    assert!(ran.stderr.contains("axis x is closed"), "{}", ran.stderr);
    passed(&on(&folder, &board, "stop --clear"));
    passed(&on(&folder, &board, "jog x 4"));
    passed(&on(&folder, &board, "jog y 1"));
    board.end();
}

#[test]
fn sender_homes_and_moves_crossed_belts() {
    let folder = folder();
    let board = Board::new(&folder, "--min x=-800 --max y=400 --fast");
    let served = Served::with(&folder, &format!("--port {}", board.port));
    let mut sender = Sender::tcp(&served);
    sender.done("$H");
    let [x, y, _] = sender.place()[..] else { panic!("three letters") };
    assert!((x - 1.0).abs() < 0.02 && (y - 39.0).abs() < 0.02, "{x} {y}");
    let before = positions(&folder, &board);
    sender.simple("G21 G91\nG1 X2 Y-3 F900");
    let [to_x, to_y, _] = sender.place()[..] else { panic!("three letters") };
    assert!((to_x - x - 2.0).abs() < 0.01 && (to_y - y + 3.0).abs() < 0.01, "{to_x} {to_y}");
    let after = positions(&folder, &board);
    // x + y falls by 1 mm, and x - y rises by 5 mm.
    for (motor, wanted) in [(0, -80), (1, 400)] {
        assert!((after[motor] - before[motor] - wanted).abs() <= 1, "{before:?} {after:?}");
    }
    sender.send("G1 X60\n");
    sender.until(|line| line == "error:15" || line.starts_with("ALARM"));
    assert_eq!(served.interrupt().0, 0);
    board.end();
}

#[test]
fn linuxcnc_refuses_crossed_belts_by_name() {
    let folder = folder();
    let ran = folder.run("linuxcnc --machine machine.toml --out out --port /dev/ttyUSB0");
    assert!(ran.stderr.contains("kinematics = \"corexy\""), "{}", ran.stderr);
}

#[test]
fn shipped_machine_plans_and_simulates() {
    let folder = folder();
    let shipped = concat!(env!("CARGO_MANIFEST_DIR"), "/../../sim/corexy.toml");
    passed(&folder.run(&format!("simulate job.ngc --machine {shipped}")));
}
