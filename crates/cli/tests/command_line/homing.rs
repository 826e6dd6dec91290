//! `carrystep home` on virtual boards: in each wiring, from every start, twice; what it remembers;
//! and what is refused beside a limit.

use crate::command::{Folder, Ran, edit};
use crate::virtual_boards::{Board, passed};
use serde_json::Value;
use std::process::{Command, Stdio};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// Three axes. z homes first, toward its high end; then x and y home together.
const MACHINE: &str = r#"[machine]
clock_hz = 24_000_000
tick_ns = 2000

[machine.guard]
watchdog_ms = 100
debounce_us = 100
limits = "pair"

[machine.link]
baud = 1_500_000

[[machine.axis]]
name = "x"
steps_per_unit = 50
speed_limit = 100
accel_limit = 2000
driver = "a4988"
travel = [0, 20]
home = { toward = "min", seek_speed = 50, slow_speed = 5, pull_off = 1, position = 0 }

[[machine.axis]]
name = "y"
steps_per_unit = 50
speed_limit = 100
accel_limit = 2000
driver = "a4988"
home = { toward = "min", seek_speed = 40, slow_speed = 5, move_off = 3, max_travel = 30, pull_off = 2, position = -2.5 }

[[machine.axis]]
name = "z"
steps_per_unit = 100
speed_limit = 50
accel_limit = 1000
driver = "a4988"
travel = [-10, 0]
home = { toward = "max", seek_speed = 20, slow_speed = 2, move_off = 2, pull_off = 0.5, position = 0 }
"#;

/// Only one board runs at a time. A host that gets no answer for half a second gives up its board,
/// and boards use all available processor time.
static ONE: Mutex<()> = Mutex::new(());

fn alone() -> MutexGuard<'static, ()> {
    ONE.lock().unwrap_or_else(PoisonError::into_inner)
}

fn folder(limits: &str) -> Folder {
    let folder = Folder::new();
    folder.write("machine.toml", MACHINE.replace("\"pair\"", &format!("\"{limits}\"")));
    folder
}

/// The machine for a board that runs in real time and whose host may be delayed; y searches far.
fn patient(max_travel: &str) -> String {
    MACHINE
        .replace("watchdog_ms = 100", "watchdog_ms = 4000")
        .replace("max_travel = 30, ", max_travel)
}

/// Runs a command on the board of the machine.
fn on(folder: &Folder, board: &Board, command: &str) -> Ran {
    folder.run(&format!("{command} --machine machine.toml --port {}", board.port))
}

fn home(folder: &Folder, board: &Board, axes: &str) -> Value {
    let ran = on(folder, board, &format!("home {axes}--json"));
    passed(&ran);
    serde_json::from_str(&ran.stdout).unwrap()
}

fn axis<'a>(told: &'a Value, name: &str) -> &'a Value {
    told["axes"].as_array().unwrap().iter().find(|axis| axis["axis"] == name).unwrap()
}

/// The machine coordinates of all axes, as `status` reports them.
fn coordinates(folder: &Folder, board: &Board) -> Vec<Option<f64>> {
    let ran = on(folder, board, "status --json");
    passed(&ran);
    let told: Value = serde_json::from_str(&ran.stdout).unwrap();
    told["axes"].as_array().unwrap().iter().map(|axis| axis["machine"].as_f64()).collect()
}

#[test]
fn homing_finds_the_same_zero_in_each_wiring_from_every_start() {
    let _alone = alone();
    // x starts off its switch, y and z start on theirs.
    for limits in ["pair", "each", "one"] {
        let folder = folder(limits);
        let board = Board::new(&folder, "--fast --min x=-300 --max x=900 --min y=40 --max z=-30");
        let first = home(&folder, &board, "");
        for (name, switch, rests, place) in
            [("x", -300, 50, 1.0), ("y", 40, 100, -0.5), ("z", -30, -50, -0.5)]
        {
            let found = axis(&first, name);
            let edge = found["edge"].as_i64().unwrap();
            // The limit is accepted within two steps at the slow speed.
            assert!((edge - switch).abs() <= 2, "{limits}: {found}");
            assert_eq!(found["position"].as_i64(), Some(edge + rests), "{limits}: {found}");
            assert_eq!(found["machine"].as_f64(), Some(place), "{limits}: {found}");
        }
        assert_eq!(coordinates(&folder, &board), [Some(1.0), Some(-0.5), Some(-0.5)], "{limits}");
        let second = home(&folder, &board, "");
        for name in ["x", "y", "z"] {
            let [first, second] =
                [&first, &second].map(|told| axis(told, name)["edge"].as_i64().unwrap());
            assert!((first - second).abs() <= 1, "{limits}: {first}, then {second}");
        }
        passed(&on(&folder, &board, "jog x 2.5"));
        assert_eq!(coordinates(&folder, &board)[0], Some(3.5), "{limits}");
        // A single axis is homed by its name.
        let told = home(&folder, &board, "x ");
        assert_eq!(told["axes"].as_array().unwrap().len(), 1);
        assert_eq!(coordinates(&folder, &board), [Some(1.0), Some(-0.5), Some(-0.5)], "{limits}");
    }
}

#[test]
fn homing_ends_as_soon_as_the_axes_rest() {
    let _alone = alone();
    let folder = folder("pair");
    // In real time: the search may take 1000 steps at 2500 steps/s, and the switch is near.
    folder.write("machine.toml", patient("max_travel = 3000, "));
    let board = Board::new(&folder, "--min y=-100");
    let told = home(&folder, &board, "y ");
    let seconds = told["run_s"].as_f64().unwrap();
    // The planned search takes 75 s.
    assert!(seconds < 30.0, "{seconds}");
}

#[test]
fn machine_zero_is_forgotten_if_the_board_was_changed_or_moved() {
    let _alone = alone();
    let folder = folder("each");
    let switches = "--fast --min x=-100 --min y=-100 --max z=100";
    let board = Board::new(&folder, switches);
    home(&folder, &board, "");
    assert!(coordinates(&folder, &board).iter().all(Option::is_some));
    // A clear and a stop by this command change nothing.
    passed(&on(&folder, &board, "stop --clear"));
    assert!(coordinates(&folder, &board).iter().all(Option::is_some));
    // Another host, which does not know the file.
    let mut other = Command::new(env!("CARGO_BIN_EXE_carrystep"));
    let jog = ["jog", "x", "1", "--machine", "machine.toml", "--port", &board.port];
    let elsewhere = folder.path("elsewhere");
    other.args(jog).env("CARRYSTEP_STATE", elsewhere).current_dir(folder.path(""));
    assert!(other.stdout(Stdio::null()).status().unwrap().success());
    assert_eq!(coordinates(&folder, &board), [None, None, None]);
    home(&folder, &board, "y ");
    assert!(coordinates(&folder, &board)[1].is_some());
    // Axes without power do not keep their positions.
    passed(&on(&folder, &board, "stop --off"));
    assert_eq!(coordinates(&folder, &board), [None, None, None]);
    // Another machine file with another size of a step; the gateware is the same.
    home(&folder, &board, "y ");
    let half = [
        ("\"pair\"", "\"each\""),
        ("steps_per_unit = 50", "steps_per_unit = 25"),
        ("accel_limit = 2000", "accel_limit = 4000"),
    ];
    folder.write(
        "machine.toml",
        half.iter().fold(MACHINE.to_owned(), |text, (old, new)| text.replace(old, new)),
    );
    assert_eq!(coordinates(&folder, &board), [None, None, None]);
    drop(board);
    // A file that is incomplete, or of another kind.
    let kept = std::fs::read_dir(folder.state()).unwrap().map(|entry| entry.unwrap().path());
    for path in kept {
        std::fs::write(path, "{\"schema\": 1, \"port\"").unwrap();
    }
    let board = Board::new(&folder, switches);
    assert_eq!(coordinates(&folder, &board), [None, None, None]);
}

#[test]
fn a_board_that_was_restarted_is_not_homed() {
    let _alone = alone();
    let folder = folder("pair");
    // The axis is homed at register 0, where a restarted board also stands: 50 steps back to the
    // switch, and off again.
    folder.write("machine.toml", MACHINE.replace("pull_off = 1,", "pull_off = 1.02,"));
    let board = Board::new(&folder, "--fast --min x=-50");
    let told = home(&folder, &board, "x ");
    let port = board.port.clone();
    drop(board);
    // The system gives the next pseudo-terminal the same name as soon as it is free.
    let begin = std::time::Instant::now();
    let board = loop {
        let board = Board::new(&folder, "--fast --min x=-50");
        if board.port == port || begin.elapsed() > Duration::from_secs(2) {
            break board;
        }
    };
    assert_eq!(coordinates(&folder, &board)[0], None, "{told}");
}

#[test]
fn a_jog_further_into_a_limit_is_refused_and_one_away_is_not() {
    let _alone = alone();
    for limits in ["each", "pair"] {
        let folder = folder(limits);
        let board = Board::new(&folder, "--fast --min y=-100");
        let jog = |arguments: &str| on(&folder, &board, &format!("jog y {arguments}"));
        let clear = || passed(&on(&folder, &board, "stop --clear"));
        let ran = jog("-5");
        assert_eq!(ran.status, 1, "{}", ran.stderr);
        assert!(ran.stdout.contains("STOPPED by the machine: limit"), "{}", ran.stdout);
        clear();
        for _ in 0..2 {
            jog("-1").refuses(
                "the limit switch of axis y is closed, and the axis would move further back",
            );
        }
        // The axis moves away, but not as far as the switch needs to open.
        passed(&jog("1"));
        jog("-0.1").refuses("jog it forward until the switch is open");
        // A move file is refused as well.
        folder.write(
            "move.toml",
            "machine_file = \"machine.toml\"\n[[move]]\nprofile = \"trapezoid\"\nto = { y = -1 }\n",
        );
        folder
            .run(&format!("run move.toml --port {}", board.port))
            .refuses("the limit switch of axis y is closed");
        passed(&on(&folder, &board, "jog x 1"));
        passed(&jog("3"));
        passed(&jog("-1"));
        // After it has moved far enough away, the axis meets the limit again. Only --into-limit
        // then moves it toward the limit. On this board the axis can move beyond its switch.
        assert_eq!(jog("-5").status, 1);
        clear();
        jog("-0.1").refuses("--into-limit");
        let ran = jog("-0.1 --into-limit");
        // With two switches, a closed limit still stops an axis that moves toward it. With one
        // switch it is not seen.
        assert_eq!(
            ran.status,
            if limits == "pair" { 1 } else { 0 },
            "{}{}",
            ran.stdout,
            ran.stderr
        );
    }
}

#[test]
fn homing_without_a_switch_reports_axis_and_distance() {
    let _alone = alone();
    let folder = folder("each");
    let board = Board::new(&folder, "--fast --max z=100");
    let ran = on(&folder, &board, "home");
    assert_eq!((ran.status, ran.stdout.as_str()), (1, ""));
    // The distance is 20 units of travel and twice move_off, which is a ramp from full speed, the
    // debounce time and a hundredth of the travel.
    assert!(ran.stderr.starts_with("error: no limit was met: moved x by 2"), "{}", ran.stderr);
    assert!(
        ran.stderr.contains(", y by 30 units (1500 steps), which is max_travel"),
        "{}",
        ran.stderr
    );
    // Nothing else is wrong with the machine, and z can still be homed.
    passed(&on(&folder, &board, "jog x 1"));
}

#[cfg(unix)]
#[test]
fn homing_that_is_interrupted_comes_to_rest_and_can_begin_again() {
    let _alone = alone();
    let folder = folder("pair");
    // The board runs in real time, and the switch is far away.
    folder.write("machine.toml", patient("max_travel = 30000, "));
    let mut board = Board::new(&folder, "");
    let begin = || {
        let mut command = Command::new(env!("CARGO_BIN_EXE_carrystep"));
        command.args(["home", "y", "--machine", "machine.toml", "--json", "--port", &board.port]);
        command.env("CARRYSTEP_STATE", folder.state()).current_dir(folder.path(""));
        command.stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().unwrap();
        // The home command answers for the board as soon as it drives. A `status` that comes
        // earlier holds the port and makes the home command fail.
        while !on(&folder, &board, "status --json").stdout.contains("\"idle\": false") {
            if child.try_wait().unwrap().is_some() {
                child = command.spawn().unwrap();
            }
            std::thread::sleep(Duration::from_millis(200));
        }
        child
    };
    let told = |child: std::process::Child| -> Value {
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(1), "{}", String::from_utf8_lossy(&output.stderr));
        serde_json::from_slice(&output.stdout).unwrap()
    };
    let child = begin();
    assert!(
        Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success()
    );
    let first = told(child);
    assert_eq!((&first["ended"], &first["stopped_by"]), (&"stopped".into(), &"interrupt".into()));
    let child = begin();
    passed(&on(&folder, &board, "stop"));
    let second = told(child);
    assert_eq!((&second["ended"], &second["stopped_by"]), (&"stopped".into(), &"stop".into()));
    passed(&on(&folder, &board, "stop --clear"));
    let child = begin();
    board.press("estop 1");
    let third = told(child);
    assert_eq!((&third["ended"], &third["cause"]), (&"fault".into(), &"e-stop".into()));
}

#[test]
fn axes_that_cannot_home_are_refused_before_any_motion() {
    let _alone = alone();
    let folder = folder("pair");
    let board = Board::new(&folder, "--fast");
    on(&folder, &board, "home w").refuses("no axis is called 'w': the axes are x, y, z");
    let (odd, place) =
        edit(MACHINE, "slow_speed = 5, pull_off = 1", "slow_speed = ^60, pull_off = 1");
    folder.write("bad.toml", odd);
    let bad =
        |axes: &str| folder.run(&format!("home {axes}--machine bad.toml --port {}", board.port));
    bad("").refuses_at("bad.toml", place, "slow_speed is over seek_speed");
    let without =
        MACHINE.lines().filter(|line| !line.starts_with("home")).collect::<Vec<_>>().join("\n");
    folder.write("bad.toml", without);
    bad("").refuses("no axis of the machine has a home table");
    bad("x ").refuses("axis 'x' has no home table");
}
