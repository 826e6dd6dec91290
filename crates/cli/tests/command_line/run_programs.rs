//! G-code programs on virtual boards: from the file to the capture, places at which a program waits,
//! where it begins, and what is refused before anything moves.

use crate::command::{Folder, Ran};
use crate::schemas;
use crate::stops::{drives, moving, said};
use crate::virtual_boards::{Board, document, passed};
use serde_json::Value;
use std::process::{Child, Command};
use std::time::Duration;

/// Three axes, of which x can be homed. The watchdog is long, because the computer that runs these
/// tests may be busy.
pub const MACHINE: &str = r#"[machine]
clock_hz = 24_000_000
tick_ns = 2000

[machine.guard]
watchdog_ms = 4000
debounce_us = 100

[machine.link]
baud = 1_500_000

[machine.outputs]
count = 2
spindle = 0

[[machine.axis]]
name = "x"
steps_per_unit = 80
speed_limit = 50
accel_limit = 1000
driver = "tmc2209"
travel = [-9, 20]

[[machine.axis]]
name = "y"
steps_per_unit = 80
speed_limit = 50
accel_limit = 1000
driver = "tmc2209"

[[machine.axis]]
name = "z"
steps_per_unit = 400
speed_limit = 20
accel_limit = 500
driver = "tmc2209"
"#;

/// The table of x with which it can be homed, on a machine with switches.
pub const HOME: &str = r#"travel = [-9, 20]
home = { toward = "min", seek_speed = 20, slow_speed = 2, max_travel = 30, pull_off = 1, position = 0 }
"#;

const JOB: &str = "G21 G90 F1500\nM3 S1000\nG1 X4 Y2\nG3 X2 Y4 I-2\nG0 Z1\nG1 X0 Y0 Z0\nM2\n";
pub const PAUSES: &str = "G21 G90 F1500\nG1 X4\nM0\nG1 Y3\nM6 T2\nG1 Z-1\nM2\n";

pub fn folder(job: &str) -> Folder {
    let folder = Folder::new();
    folder.write("machine.toml", MACHINE);
    folder.write("job.ngc", job);
    folder
}

pub fn run(folder: &Folder, board: &Board, options: &str) -> Ran {
    let options = format!("--machine machine.toml --port {} {options}", board.port);
    folder.run(&format!("run job.ngc {}", options.trim_end()))
}

/// Starts the program in the background.
pub fn begins(folder: &Folder, board: &Board) -> Child {
    drives(folder, "run job.ngc --machine machine.toml", &board.port)
}

pub fn status(folder: &Folder, board: &Board) -> Value {
    let ran = folder.run(&format!("status --port {} --machine machine.toml --json", board.port));
    serde_json::from_str(&ran.stdout).unwrap_or_default()
}

/// Waits until the program waits, and returns what for.
pub fn waits(folder: &Folder, board: &Board, child: &mut Child) -> String {
    loop {
        assert_eq!(child.try_wait().unwrap(), None, "it has ended: {}", said(child));
        if let Some(waits) = status(folder, board)["waits"].as_str() {
            return waits.to_owned();
        }
        std::thread::sleep(Duration::from_millis(5));
    }
}

pub fn resume(folder: &Folder, board: &Board) -> Ran {
    folder.run(&format!("resume --port {}", board.port))
}

/// The document of a run that has passed.
pub fn done(child: Child) -> Value {
    let output = child.wait_with_output().unwrap();
    let [told, said] = [&output.stdout, &output.stderr].map(|text| String::from_utf8_lossy(text));
    assert_eq!(output.status.code(), Some(0), "{told}{said}");
    schemas::check(&String::from_utf8(output.stdout).unwrap())
}

#[test]
fn program_reaches_the_pins_as_it_was_planned() {
    let folder = folder(JOB);
    let board = Board::new(&folder, "--vcd a.vcd --fast");
    let ran = run(&folder, &board, "");
    passed(&ran);
    let told = "7 lines, 0 waits, no soft limits, horizon 28 ms\nDONE\n";
    assert!(ran.stdout.ends_with(told), "{}", ran.stdout);
    assert!(
        ran.stderr.starts_with("warning: the queues of the board hold 28 ms"),
        "{}",
        ran.stderr
    );
    assert!(board.end().contains("\nx at 0\ny at 0\nz at 0\nwrote a.vcd\n"));
    // Every pulse in its clock, as `simulate` has it.
    passed(&folder.run("check a.vcd job.ngc --machine machine.toml"));
    folder.write("other.ngc", JOB.replace("G0 Z1", "G0 Z1.1"));
    assert_eq!(folder.run("check a.vcd other.ngc --machine machine.toml").status, 1);
}

#[test]
fn program_waits_at_pauses_until_it_is_resumed() {
    let folder = folder(PAUSES);
    let board = Board::new(&folder, "--fast");
    assert_eq!(resume(&folder, &board).status, 2);
    let mut child = begins(&folder, &board);
    let first = waits(&folder, &board, &mut child);
    assert_eq!(first, "pause in line 3 (M0, M1 or M60)");
    let found = status(&folder, &board);
    assert_eq!((&found["axes"][0]["position"], &found["idle"]), (&320.into(), &true.into()));
    let ran = resume(&folder, &board);
    passed(&ran);
    assert!(ran.stdout.contains("goes on"), "{}", ran.stdout);
    let second = waits_for_other(&folder, &board, &mut child, &first);
    assert_eq!(second, "tool change in line 5 (M6)");
    passed(&resume(&folder, &board));
    let told = done(child);
    assert_eq!((&told["program"]["waits"], &told["ended"]), (&2.into(), &"done".into()));
    assert!(board.end().contains("\nx at 320\ny at 240\nz at -400\n"));
}

/// Waits until the program waits for something else.
fn waits_for_other(folder: &Folder, board: &Board, child: &mut Child, first: &str) -> String {
    loop {
        let now = waits(folder, board, child);
        if now != first {
            return now;
        }
    }
}

#[test]
fn stop_while_the_program_waits_ends_it_at_rest() {
    let folder = folder(&PAUSES.replace("F1500", "F1500 M3 S1000"));
    // A ramp does not switch the outputs off on this machine: only the end of the program does.
    folder
        .write("machine.toml", MACHINE.replace("spindle = 0", "spindle = 0\nat_ramps = \"stay\""));
    let board = Board::new(&folder, "--fast --vcd a.vcd");
    let mut child = begins(&folder, &board);
    waits(&folder, &board, &mut child);
    passed(&folder.run(&format!("stop --port {} --machine machine.toml", board.port)));
    let told = document(child);
    assert_eq!((&told["ended"], &told["stopped_by"]), (&"stopped".into(), &"stop".into()));
    // The spindle does not stay on.
    assert_eq!(spindle(&folder, board), ["0", "1", "0"]);
    let board = Board::new(&folder, "--fast");
    let mut child = begins(&folder, &board);
    waits(&folder, &board, &mut child);
    passed(&folder.run(&format!("stop --port {} --machine machine.toml", board.port)));
    document(child);
    let found = status(&folder, &board);
    assert_eq!((&found["fault"], &found["axes"][0]["position"]), (&false.into(), &320.into()));
    // It begins where the machine is: x is there already.
    let mut child = begins(&folder, &board);
    waits(&folder, &board, &mut child);
    assert_eq!(status(&folder, &board)["axes"][0]["position"], 320);
    child.kill().unwrap();
    child.wait().unwrap();
}

#[test]
fn switch_that_opens_while_the_program_waits_is_reported() {
    let folder = folder(PAUSES);
    let mut board = Board::new(&folder, "--fast");
    let mut child = begins(&folder, &board);
    waits(&folder, &board, &mut child);
    board.press("estop 1");
    let told = document(child);
    assert_eq!((&told["ended"], &told["cause"]), (&"fault".into(), &"e-stop".into()));
}

#[test]
fn program_that_runs_twice_begins_where_it_ended() {
    let folder = folder("G91 G21 F1000\nG1 X2 Y-1\nM2\n");
    let board = Board::new(&folder, "--fast");
    passed(&run(&folder, &board, ""));
    passed(&run(&folder, &board, ""));
    assert!(board.end().contains("\nx at 320\ny at -160\nz at 0\n"));
}

#[test]
fn machine_that_can_be_homed_has_to_be() {
    let folder = folder("G21 F1000\nG1 X21\nM2\n");
    let switches = MACHINE
        .replace("debounce_us = 100", "debounce_us = 100\nlimits = \"pair\"")
        .replace("travel = [-9, 20]\n", HOME);
    folder.write("machine.toml", switches);
    let board = Board::new(&folder, "--fast --min x=-400");
    let ran = run(&folder, &board, "");
    assert_eq!(ran.status, 2);
    assert!(ran.stderr.contains("x is not homed"), "{}", ran.stderr);
    // Without its zero, nothing bounds the program.
    passed(&run(&folder, &board, "--unhomed"));
    passed(&folder.run(&format!("home --machine machine.toml --port {}", board.port)));
    // From now on, the soft limit holds, and the line is named.
    let ran = run(&folder, &board, "");
    assert_eq!(ran.status, 2);
    let why = "x would go to 21 mm, beyond its travel of -9 to 20 mm";
    assert!(ran.stderr.contains(why) && ran.stderr.contains("job.ngc:2"), "{}", ran.stderr);
    folder.write("job.ngc", "G21 F1000\nG1 X3\nM2\n");
    let ran = run(&folder, &board, "");
    passed(&ran);
    assert!(ran.stdout.contains("soft limits of x"), "{}", ran.stdout);
    // Machine zero is the switch at -400 steps.
    assert!(board.end().contains("\nx at -160\n"));
}

#[test]
fn mistakes_are_found_before_anything_moves() {
    let folder = folder("G21 F1000\nG1 X3\nG1 Q7\nM2\n");
    let board = Board::new(&folder, "--fast");
    let ran = run(&folder, &board, "");
    assert_eq!(ran.status, 2);
    assert!(ran.stderr.contains("job.ngc:3"), "{}", ran.stderr);
    folder.write("probe.ngc", "G21 F1000\nG1 X3\nG38.2 Z-1 F100\nM2\n");
    for (command, why) in [
        (
            "run probe.ngc --machine machine.toml",
            "line 3: G38 needs a probe, and the machine has none",
        ),
        ("run job.ngc", "a G-code program needs a machine"),
        ("run job.ngc --machine machine.toml --fit-ns 5", "--fit-ns is not available"),
        ("run none.ngc --machine machine.toml", "none.ngc"),
        ("run machine.toml --unhomed", "--unhomed is an option of G-code programs"),
        ("run machine.toml --tolerance 1", "--tolerance is an option of G-code programs"),
    ] {
        let ran = folder.run(&format!("{command} --port {}", board.port));
        assert_eq!(ran.status, 2, "{command}");
        assert!(ran.stderr.contains(why), "{command}: {}", ran.stderr);
    }
    assert!(board.end().contains("\nx at 0\ny at 0\nz at 0\n"));
}

/// A path of some 20 seconds, without a rest.
pub const LONG: &str = "G21 G90 G64 P0.02 F1800\nM3 S1000\no1 repeat [6]\nG1 X4 Y4\n\
    G3 X4 Y4 I-3 J1\nG1 X-4 Z0.4\nG1 X0 Y0 Z0\no1 endrepeat\nM2\n";

pub fn hold(folder: &Folder, board: &Board) -> Ran {
    folder.run(&format!("hold --port {}", board.port))
}

fn signal(child: &Child) {
    let pid = child.id().to_string();
    assert!(Command::new("kill").args(["-INT", &pid]).status().unwrap().success());
}

pub fn positions(found: &Value) -> Vec<i64> {
    let axes = found["axes"].as_array().unwrap();
    axes.iter().map(|axis| axis["position"].as_i64().unwrap()).collect()
}

/// Ends the board, and returns the levels of the spindle's output in its capture.
pub fn spindle(folder: &Folder, board: Board) -> Vec<String> {
    board.end();
    let vcd = std::fs::read_to_string(folder.path("a.vcd")).unwrap();
    let declared = vcd.lines().find(|line| line.contains(" output_0 ")).unwrap();
    let code = declared.split_whitespace().nth(3).unwrap();
    let levels = vcd.lines().filter(|line| line.get(1..) == Some(code));
    levels.map(|line| line[..1].to_owned()).collect()
}

#[test]
fn held_program_rests_on_its_path_and_goes_on() {
    let told = holds_and_goes_on(&folder(LONG));
    assert_eq!(told["program"]["cuts"], 0);
}

/// The queues last 124 ms. A fast board empties them while the hold is planned, except for three
/// segments: it refuses most cuts.
#[test]
fn hold_cuts_deep_queues() {
    let folder = folder(LONG);
    let deep = "[machine]\nqueue_depth = 31\ncuts = true\n";
    folder.write("machine.toml", MACHINE.replacen("[machine]\n", deep, 1));
    let told = holds_and_goes_on(&folder);
    assert_eq!(told["program"]["horizon_ms"], 124);
    assert!(told["program"]["cuts"].as_u64().is_some_and(|cuts| cuts <= 3));
}

/// Holds the program three times, and checks that it stays on its path.
fn holds_and_goes_on(folder: &Folder) -> Value {
    let board = Board::new(folder, "--vcd a.vcd --fast");
    assert_eq!(hold(folder, &board).status, 2);
    let mut child = begins(folder, &board);
    moving(folder, &mut child, &board.port);
    let mut earlier = Vec::new();
    for _ in 0..3 {
        let ran = hold(folder, &board);
        passed(&ran);
        assert!(ran.stdout.contains("was asked to bring its program to rest"), "{}", ran.stdout);
        assert!(waits(folder, &board, &mut child).starts_with("hold in line "));
        let rest = positions(&status(folder, &board));
        assert_eq!(rest, positions(&status(folder, &board)));
        assert_ne!(rest, earlier);
        earlier = rest;
        assert_eq!(hold(folder, &board).status, 2, "it rests already");
        passed(&resume(folder, &board));
        while status(folder, &board)["idle"] == true {}
    }
    let told = done(child);
    assert_eq!((&told["ended"], &told["program"]["waits"]), (&"done".into(), &3.into()));
    assert!(board.end().contains("\nx at 0\ny at 0\nz at 0\n"));
    let ran = folder.run("check a.vcd job.ngc --machine machine.toml --path-only");
    passed(&ran);
    // Without the holds, the times would be those of the plan.
    assert_eq!(folder.run("check a.vcd job.ngc --machine machine.toml").status, 1);
    told
}

#[test]
fn second_signal_ends_the_held_program_at_rest() {
    let folder = folder(LONG);
    let board = Board::new(&folder, "--vcd a.vcd --fast");
    let mut child = begins(&folder, &board);
    moving(&folder, &mut child, &board.port);
    signal(&child);
    waits(&folder, &board, &mut child);
    let rest = positions(&status(&folder, &board));
    signal(&child);
    let told = document(child);
    assert_eq!((&told["ended"], &told["stopped_by"]), (&"stopped".into(), &"interrupt".into()));
    let found = status(&folder, &board);
    assert_eq!((positions(&found), &found["fault"]), (rest, &false.into()));
    // The spindle was on, and is off.
    assert_eq!(spindle(&folder, board), ["0", "1", "0"]);
}

#[test]
fn third_signal_ramps_the_axes_down() {
    let folder = folder("G21 G90 F3000\nG1 X4000\nM2\n");
    // It takes 2.5 s to come to rest, so that all signals come while it slows down.
    let machine = MACHINE.replacen("accel_limit = 1000", "accel_limit = 20", 1);
    folder.write("machine.toml", machine);
    let board = Board::new(&folder, "--fast");
    let mut child = begins(&folder, &board);
    while positions(&moving(&folder, &mut child, &board.port))[0] < 8000 {}
    for _ in 0..3 {
        signal(&child);
        // Signals that come together are one.
        std::thread::sleep(Duration::from_millis(20));
    }
    let told = document(child);
    // A hold would have waited.
    assert_eq!((&told["ended"], &told["program"]["waits"]), (&"stopped".into(), &0.into()));
    assert_eq!(status(&folder, &board)["idle"], true);
}
