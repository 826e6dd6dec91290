//! The commands that drive a board, run on a virtual board: moves from the file to the capture, and
//! all kinds of stops.

use crate::command::{Folder, Ran, edit};
use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::process::{Child, ChildStdout, Command, Stdio};
use std::time::Duration;

/// A machine with two axes. Its watchdog is long, because the computer that runs these tests may be
/// busy.
pub const MACHINE: &str = r#"[machine]
clock_hz = 24_000_000
tick_ns = 2000

[machine.guard]
watchdog_ms = 4000
debounce_us = 100

[machine.link]
baud = 1_500_000

[[machine.axis]]
name = "x"
steps_per_unit = 5
start_speed = 200
speed_limit = 1000
accel_limit = 5000
driver = "a4988"

[[machine.axis]]
name = "y"
steps_per_unit = 80
speed_limit = 50
accel_limit = 400
driver = "tmc2209"
"#;

const MOVES: &str = r#"machine_file = "machine.toml"

[[move]]
profile = "ranade"
to = { x = 20, y = -3 }

[[move]]
profile = "sine"
to = { x = -12.2 }
"#;

/// A move that takes longer than any test waits.
const LONG: &str =
    "machine_file = \"machine.toml\"\n[[move]]\nprofile = \"trapezoid\"\nto = { x = 1_000_000 }\n";

/// A running `carrystep virtual-board`.
pub struct Board {
    pub child: Child,
    said: BufReader<ChildStdout>,
    pub port: String,
}

impl Board {
    pub fn new(folder: &Folder, options: &str) -> Self {
        let mut command = Command::new(env!("CARGO_BIN_EXE_carrystep"));
        command
            .args(["virtual-board", "--machine", "machine.toml"])
            .args(options.split_whitespace());
        command.current_dir(folder.path("")).stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut child = command.spawn().unwrap();
        let mut said = BufReader::new(child.stdout.take().unwrap());
        let mut line = String::new();
        said.read_line(&mut line).unwrap();
        let (port, rest) = line.split_once(": ").expect(&line);
        assert!(rest.contains(" baud, build "), "{line}");
        Self { port: port.to_owned(), child, said }
    }

    pub fn press(&mut self, line: &str) {
        writeln!(self.child.stdin.as_mut().unwrap(), "{line}").unwrap();
    }

    /// Ends the board and returns its output.
    pub fn end(mut self) -> String {
        self.press("end");
        let mut said = String::new();
        self.said.read_to_string(&mut said).unwrap();
        assert!(self.child.wait().unwrap().success());
        said
    }
}

impl Drop for Board {
    fn drop(&mut self) {
        // If the test has come so far, the board has ended already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

pub fn folder() -> Folder {
    let folder = Folder::with_move(MOVES);
    folder.write("machine.toml", MACHINE);
    folder.write("long.toml", LONG);
    folder
}

#[track_caller]
pub fn passed(ran: &Ran) {
    assert_eq!(ran.status, 0, "{}{}", ran.stdout, ran.stderr);
}

/// Starts a run and waits until the board's capture of it has begun.
fn begin(folder: &Folder, board: &Board, file: &str) -> Child {
    let mut command = Command::new(env!("CARGO_BIN_EXE_carrystep"));
    command.args(["run", file, "--port", &board.port, "--json"]).current_dir(folder.path(""));
    command.env("CARRYSTEP_STATE", folder.state());
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    // No other command can ask the board while the run holds the port.
    while folder.begun_by(&board.child).is_none_or(|written| written == 0) {
        assert_eq!(child.try_wait().unwrap(), None, "it has ended");
        std::thread::sleep(Duration::from_millis(10));
    }
    child
}

pub fn document(child: Child) -> serde_json::Value {
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(1), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

#[test]
fn moves_reach_the_pins_of_a_board_as_they_were_planned() {
    let folder = folder();
    // The whole first move fits into the queues: in real time, a host may be late at any time.
    let (first, _) = MOVES.split_once("\n[[move]]\nprofile = \"sine\"").unwrap();
    folder.write("first.toml", first);
    folder.write("short.toml", first.replace("x = 20, y = -3", "x = 2, y = -0.2"));
    for (options, file, ends) in [
        ("", "first.toml", "x at 100\ny at -240"),
        ("--fast", "move.toml", "x at 39\ny at -240"),
        ("--fast --level verilator", "short.toml", "x at 10\ny at -16"),
    ] {
        let board = Board::new(&folder, &format!("--vcd a.vcd {options}"));
        let ran = folder.run(&format!("run {file} --port {}", board.port));
        passed(&ran);
        assert!(ran.stdout.ends_with("DONE\n"), "{}", ran.stdout);
        passed(&folder.run(&format!("status --port {} --machine machine.toml", board.port)));
        let said = board.end();
        assert!(said.contains(&format!("\n{ends}\nwrote a.vcd\n")), "{said}");
        passed(&folder.run(&format!("check a.vcd {file}")));
        // The check compares with these moves and detects other moves.
        folder.write("other.toml", MOVES.replace("x = 20", "x = 20.2"));
        assert_eq!(folder.run("check a.vcd other.toml").status, 1);
    }
}

#[test]
fn jogs_start_from_the_present_position_and_follow_moves() {
    let folder = folder();
    let board = Board::new(&folder, "--fast");
    let jog = |arguments: &str| {
        folder.run(&format!("jog {arguments} --machine machine.toml --port {}", board.port))
    };
    passed(&jog("x 3.1"));
    passed(&jog("y -0.5 --time 0.2"));
    passed(&jog("x -1"));
    assert!(board.end().contains("\nx at 11\ny at -40\n"));
}

#[cfg(unix)]
#[test]
fn an_interrupted_run_comes_to_rest_and_the_next_one_runs() {
    let folder = folder();
    let board = Board::new(&folder, "--fast --vcd a.vcd");
    let child = begin(&folder, &board, "long.toml");
    assert!(
        Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success()
    );
    let told = document(child);
    assert_eq!((&told["ended"], &told["passed"]), (&"stopped".into(), &false.into()));
    let position = told["axes"][0]["position"].as_i64().unwrap();
    assert!((1..5_000_000).contains(&position), "{told}");
    passed(&folder.run(&format!("run move.toml --port {}", board.port)));
    assert!(board.end().contains(&format!("\nx at {}\n", position + 39)));
}

#[cfg(unix)]
#[test]
fn killed_host_leaves_a_stopped_machine_that_reports_the_watchdog() {
    let folder = folder();
    folder.write("machine.toml", MACHINE.replace("watchdog_ms = 4000", "watchdog_ms = 400"));
    let board = Board::new(&folder, "--fast --vcd a.vcd");
    let mut child = begin(&folder, &board, "long.toml");
    let status = format!("status --port {} --machine machine.toml", board.port);
    assert!(folder.run(&status).stdout.contains("`carrystep run`"));
    child.kill().unwrap();
    child.wait().unwrap();
    // A fast board waits for its host, and continues by itself after a second without one.
    let mut alone = Duration::from_secs(2);
    let told = loop {
        std::thread::sleep(alone);
        alone *= 2;
        let ran = folder.run(&status);
        passed(&ran);
        if ran.stdout.contains("STOPPED") {
            break ran.stdout;
        }
    };
    assert!(["watchdog", "underrun"].iter().any(|cause| told.contains(cause)), "{told}");
    let run = format!("run move.toml --port {}", board.port);
    let ran = folder.run(&run);
    assert_eq!(ran.status, 1);
    assert!(ran.stderr.starts_with("error: the machine has stopped: "), "{}", ran.stderr);
    assert!(ran.stderr.contains("`carrystep stop --clear`"), "{}", ran.stderr);
    // The rest of the move waits in the queues, and as long as it does the drivers keep their
    // power.
    let stop = |options: &str| {
        folder.run(&format!("stop{options} --port {} --machine machine.toml", board.port))
    };
    let kept = stop(" --off");
    assert_eq!(kept.status, 1, "{}", kept.stderr);
    assert!(kept.stderr.contains("`carrystep stop --clear --off`"), "{}", kept.stderr);
    let ran = folder.run(&status);
    assert!(ran.stdout.contains("drivers powered while segments wait"), "{}", ran.stdout);
    let ran = stop(" --clear --off");
    passed(&ran);
    assert!(ran.stdout.contains("at rest; drivers without power"), "{}", ran.stdout);
    passed(&folder.run(&run));
}

#[test]
fn lost_board_is_reported() {
    let folder = folder();
    let mut board = Board::new(&folder, "--fast --vcd a.vcd");
    let child = begin(&folder, &board, "long.toml");
    board.child.kill().unwrap();
    let output = child.wait_with_output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!((output.status.code(), output.stdout.is_empty()), (Some(1), false), "{said}");
    assert!(said.starts_with("error: the line to the board is gone: "), "{said}");
    assert!(said.contains("; the board's watchdog ramps the axes down 400"), "{said}");
}

#[test]
fn limit_stop_is_reported_with_its_axis() {
    let folder = folder();
    let board = Board::new(&folder, "--fast --max y=100");
    let on = format!("--machine machine.toml --port {}", board.port);
    let ran = folder.run(&format!("jog y 5 {on}"));
    assert_eq!(ran.status, 1);
    assert!(ran.stdout.contains("STOPPED by the machine: limit, axis y"), "{}", ran.stdout);
    let ran = folder.run(&format!("jog x 1 {on}"));
    let says = "error: the machine has stopped: limit, from y; `carrystep stop --clear`, then jog that axis away";
    assert!(ran.stderr.starts_with(says), "{}", ran.stderr);
}

#[test]
fn e_stop_is_reported_and_latched_until_released_and_cleared() {
    let folder = folder();
    let mut board = Board::new(&folder, "--fast --vcd a.vcd");
    let child = begin(&folder, &board, "long.toml");
    board.press("estop 1");
    let told = document(child);
    assert_eq!((&told["ended"], &told["cause"]), (&"fault".into(), &"e-stop".into()));
    let stop =
        |options: &str| folder.run(&format!("stop --port {} --baud 1500000 {options}", board.port));
    let ran = stop("--clear");
    assert_eq!(ran.status, 1, "{}", ran.stdout);
    assert!(ran.stderr.contains("the e-stop is still pressed"), "{}", ran.stderr);
    let port = board.port.clone();
    board.press("estop 0");
    let ran = folder.run(&format!("stop --port {port} --baud 1500000 --clear"));
    passed(&ran);
    passed(&folder.run(&format!("run move.toml --port {port}")));
}

#[test]
fn impossible_virtual_boards_are_refused() {
    let folder = folder();
    let board = |machine: &str, options: &str| {
        folder.write("bad.toml", machine);
        folder.run(&format!("virtual-board --machine bad.toml{options}"))
    };
    let (odd, place) = edit(MACHINE, "baud = 1_500_000", "baud = ^2_900_000");
    board(&odd, "").refuses_at(
        "bad.toml",
        place,
        "the next ones that it makes are 2666666 and 3000000",
    );
    board(
        &MACHINE.replace(
            "clock_hz = 24_000_000\ntick_ns = 2000",
            "tick_ns = 1000\nclock_hz = 16_000_000\n[machine.other]",
        ),
        "",
    )
    .refuses("unknown field `other`");
    board(MACHINE, " --min x").refuses("--min x: expected AXIS=STEPS");
    board(MACHINE, " --max z=1").refuses("of an axis of x, y");
    board(MACHINE, " --vcd machine.toml/a.vcd").refuses("machine.toml/a.vcd");
    folder.run("virtual-board --machine none.toml").refuses("none.toml");
}
