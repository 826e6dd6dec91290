//! `carrystep stop` and `status` from a second terminal while another command drives the board;
//! hosts that hang or are killed; ports that are held; and lines that are lost.

use crate::command::{Folder, Ran};
use crate::virtual_boards::{Board, MACHINE, document, folder, passed};
use serde_json::Value;
use std::fs::File;
use std::io::{Read, Write as _};
use std::os::unix::fs::MetadataExt as _;
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// Starts a command that drives the board at this port.
pub fn drives(folder: &Folder, arguments: &str, port: &str) -> Child {
    let mut command = Command::new(env!("CARGO_BIN_EXE_carrystep"));
    command
        .args(arguments.split(' '))
        .args(["--port", port, "--json"])
        .env("CARRYSTEP_STATE", folder.state())
        .current_dir(folder.path(""));
    command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
}

fn status(folder: &Folder, port: &str) -> Value {
    let ran = folder.run(&format!("status --port {port} --machine machine.toml --json"));
    passed(&ran);
    serde_json::from_str(&ran.stdout).unwrap()
}

/// Waits until that command holds the port and an axis moves; returns the output of `status` then.
pub fn moving(folder: &Folder, child: &mut Child, port: &str) -> Value {
    loop {
        assert_eq!(child.try_wait().unwrap(), None, "it has ended: {}", said(child));
        let ran = folder.run(&format!("status --port {port} --machine machine.toml --json"));
        // Before the command listens, the port is only reported as busy.
        let told: Value = serde_json::from_str(&ran.stdout).unwrap_or_default();
        if told["held_by"]["pid"] == child.id() && told["axes"][0]["position"] != 0 {
            return told;
        }
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// What a command has said that has ended too early.
pub fn said(child: &mut Child) -> String {
    let mut said = String::new();
    let outputs: [Option<Box<dyn Read>>; 2] = [
        child.stdout.take().map(|output| Box::new(output) as _),
        child.stderr.take().map(|output| Box::new(output) as _),
    ];
    for mut output in outputs.into_iter().flatten() {
        output.read_to_string(&mut said).unwrap();
    }
    said
}

pub fn stop(folder: &Folder, port: &str, options: &str) -> Ran {
    folder.run(&format!("stop --port {port} --machine machine.toml{options}"))
}

pub fn signal(child: &Child, name: &str) {
    assert!(Command::new("kill").args([name, &child.id().to_string()]).status().unwrap().success());
}

const LONG_JOG: &str = "jog x 1000000 --machine machine.toml";

#[test]
fn stop_reaches_the_command_that_holds_the_port() {
    let folder = folder();
    let board = Board::new(&folder, "");
    for (command, options) in
        [("run long.toml", ""), (LONG_JOG, ""), ("run long.toml", " --clear"), (LONG_JOG, " --off")]
    {
        let mut child = drives(&folder, command, &board.port);
        moving(&folder, &mut child, &board.port);
        let pid = child.id();
        let ran = stop(&folder, &board.port, options);
        passed(&ran);
        let name = command.split(' ').next().unwrap();
        assert!(
            ran.stdout.contains(&format!("`carrystep {name}` (process {pid}) was stopped\n")),
            "{}",
            ran.stdout
        );
        assert!(ran.stdout.contains("\nat rest; drivers "), "{}", ran.stdout);
        assert_eq!(
            ran.stdout.contains("drivers without power"),
            options == " --off",
            "{}",
            ran.stdout
        );
        let told = document(child);
        assert_eq!(
            (&told["ended"], &told["stopped_by"]),
            (&"stopped".into(), &"stop".into()),
            "{told}"
        );
        let position = status(&folder, &board.port)["axes"][0]["position"].clone();
        assert_eq!(position, told["axes"][0]["position"]);
        passed(&folder.run(&format!(
            "jog x {} --machine machine.toml --port {}",
            -position.as_f64().unwrap() / 5.0,
            board.port
        )));
    }
}

#[test]
fn stop_reaches_a_run_that_waits_for_the_drivers_power() {
    let folder = folder();
    folder.write("machine.toml", MACHINE.replace("debounce_us", "enable_ms = 3000\ndebounce_us"));
    let board = Board::new(&folder, "");
    let child = drives(&folder, "run long.toml", &board.port);
    while folder
        .run(&format!("status --port {} --machine machine.toml", board.port))
        .stdout
        .contains("at rest")
    {
        // If it is the one that answers, it has connected.
        if status(&folder, &board.port)["held_by"]["pid"] == child.id() {
            break;
        }
    }
    let begun = Instant::now();
    let ran = stop(&folder, &board.port, "");
    passed(&ran);
    assert!(
        ran.stdout.contains("was stopped") && begun.elapsed() < Duration::from_millis(2500),
        "{}",
        ran.stdout
    );
    let told = document(child);
    assert_eq!(
        (&told["stopped_by"], &told["axes"][0]["position"]),
        (&"stop".into(), &0.into()),
        "{told}"
    );
}

#[test]
fn status_asks_the_command_that_drives() {
    let folder = folder();
    let board = Board::new(&folder, "");
    let mut child = drives(&folder, "run long.toml", &board.port);
    let first = moving(&folder, &mut child, &board.port);
    assert_eq!(
        (&first["held_by"]["command"], &first["idle"]),
        (&"run".into(), &false.into()),
        "{first}"
    );
    let position = |told: &Value| told["axes"][0]["position"].as_i64().unwrap();
    assert_eq!(first["axes"][0]["place"].as_f64().unwrap(), position(&first) as f64 / 5.0);
    while position(&status(&folder, &board.port)) <= position(&first) {}
    passed(&stop(&folder, &board.port, ""));
    child.wait().unwrap();
}

#[test]
fn killed_run_does_not_block_the_next_command() {
    let folder = folder();
    let board = Board::new(&folder, "");
    for _ in 0..2 {
        let mut child = drives(&folder, "run long.toml", &board.port);
        moving(&folder, &mut child, &board.port);
        child.kill().unwrap();
        child.wait().unwrap();
        // Its socket and its lock still exist, but no process uses them.
        let ran = stop(&folder, &board.port, " --clear");
        passed(&ran);
        assert!(!ran.stdout.contains("was stopped"), "{}", ran.stdout);
        passed(&folder.run(&format!("jog x -1 --machine machine.toml --port {}", board.port)));
    }
}

#[test]
fn hanging_run_is_named_with_what_stops_the_axes() {
    let folder = folder();
    let board = Board::new(&folder, "");
    let mut child = drives(&folder, "run long.toml", &board.port);
    moving(&folder, &mut child, &board.port);
    signal(&child, "-STOP");
    let ran = stop(&folder, &board.port, "");
    let pid = child.id();
    assert_eq!((ran.status, ran.stdout.as_str()), (1, ""));
    for says in [
        format!("`carrystep run` (process {pid}) holds {} and does not answer", board.port),
        "the board's watchdog ramps the axes down 400".to_owned(),
        "press the e-stop".to_owned(),
    ] {
        assert!(ran.stderr.contains(&says), "wanted: {says}\nfound: {}", ran.stderr);
    }
    if cfg!(target_os = "linux") {
        assert!(
            ran.stderr.contains(&format!("`kill -CONT {pid}` wakes it: then it stops the axes")),
            "{}",
            ran.stderr
        );
    }
    // The request has remained in the socket.
    signal(&child, "-CONT");
    let output = child.wait_with_output().unwrap();
    let told: Value = serde_json::from_slice(&output.stdout).unwrap_or_default();
    // If the computer is so slow that the watchdog comes first, the watchdog is reported instead.
    assert!(
        told["stopped_by"] == "stop" || told["cause"] == "watchdog",
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
}

#[test]
fn a_port_that_is_held_is_refused_by_every_name() {
    let folder = folder();
    let board = Board::new(&folder, "");
    std::os::unix::fs::symlink(&board.port, folder.path("port")).unwrap();
    std::os::unix::fs::symlink(folder.path("port"), folder.path("again")).unwrap();
    let mut child = drives(&folder, "run long.toml", &board.port);
    moving(&folder, &mut child, &board.port);
    for name in [board.port.as_str(), "port", "again"] {
        let says =
            format!("serial port {name} is in use by `carrystep run` (process {})", child.id());
        folder.run(&format!("run long.toml --port {name}")).refuses(&says);
        folder.run(&format!("jog x 1 --machine machine.toml --port {name}")).refuses(&says);
    }
    // The other names lead to the same command.
    let ran = stop(&folder, "again", "");
    passed(&ran);
    assert!(ran.stdout.contains("was stopped"), "{}", ran.stdout);
    assert_eq!(document(child)["stopped_by"], "stop");
}

#[test]
fn a_command_that_is_about_to_end_is_waited_for() {
    let folder = folder();
    let board = Board::new(&folder, "--fast");
    // The claim of a command that is about to close the port, or has closed it.
    let device = std::fs::metadata(&board.port).unwrap().rdev();
    let user = rustix::process::geteuid().as_raw();
    let name = format!("{}-{}.lock", rustix::fs::major(device), rustix::fs::minor(device));
    passed(&folder.run(&format!("status --port {} --machine machine.toml", board.port)));
    let path = [format!("/run/user/{user}/carrystep"), format!("/tmp/carrystep-{user}")]
        .into_iter()
        .map(PathBuf::from)
        .find(|path| path.is_dir())
        .unwrap()
        .join(name);
    let mut claim = File::create(&path).unwrap();
    claim.lock().unwrap();
    let holder = r#"{"pid": 7, "command": "run", "baud": 3000000, "listens": false}"#;
    claim.write_all(holder.as_bytes()).unwrap();
    let mut child = drives(&folder, "jog x 1 --machine machine.toml", &board.port);
    std::thread::sleep(Duration::from_millis(200));
    assert_eq!(child.try_wait().unwrap(), None, "it has ended: {}", said(&mut child));
    std::fs::remove_file(&path).unwrap();
    drop(claim);
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success(), "{output:?}");
}

#[test]
fn line_that_is_lost_during_a_run_is_reported() {
    let folder = folder();
    let board = Board::new(&folder, "");
    let mut child = drives(&folder, "run long.toml", &board.port);
    moving(&folder, &mut child, &board.port);
    signal(&board.child, "-STOP");
    let output = child.wait_with_output().unwrap();
    signal(&board.child, "-CONT");
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{said}");
    let document: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!((&document["passed"], &document["error"]["kind"]), (&false.into(), &"run".into()));
    assert!(said.contains("the line to the board is dead: it has answered until now"), "{said}");
    assert!(said.contains("the board's watchdog ramps the axes down 400"), "{said}");
    assert!(!said.contains("baud"), "{said}");
}

#[test]
fn clear_with_the_e_stop_pressed_fails_at_once() {
    let folder = folder();
    let mut board = Board::new(&folder, "--fast");
    board.press("estop 1");
    while status(&folder, &board.port)["cause"] != "e-stop" {}
    let begun = Instant::now();
    let ran = stop(&folder, &board.port, " --clear");
    // Without the check for the e-stop it would take five seconds.
    assert!(begun.elapsed() < Duration::from_millis(2500), "{:?}", begun.elapsed());
    assert_eq!(ran.status, 1);
    assert!(
        ran.stderr.starts_with(
            "error: the e-stop is still pressed, so nothing can be cleared: release it"
        ),
        "{}",
        ran.stderr
    );
    board.press("estop 0");
    std::thread::sleep(Duration::from_millis(100));
    passed(&stop(&folder, &board.port, " --clear"));
}

#[test]
fn status_reports_the_cause_of_a_stop_and_the_remedy() {
    let folder = folder();
    let mut board = Board::new(&folder, "--fast --max y=100");
    let port = board.port.clone();
    let told = |folder: &Folder| {
        folder.run(&format!("status --port {port} --machine machine.toml")).stdout
    };
    board.press("estop 1");
    while status(&folder, &port)["cause"] != "e-stop" {}
    assert!(told(&folder).contains("\nSTOPPED: e-stop; "), "{}", told(&folder));
    assert!(
        told(&folder).contains("\nto do: release it, then `carrystep stop --clear`"),
        "{}",
        told(&folder)
    );
    board.press("estop 0");
    std::thread::sleep(Duration::from_millis(100));
    passed(&stop(&folder, &port, " --clear"));
    let ran = folder.run(&format!("jog y 5 --machine machine.toml --port {port}"));
    assert_eq!(ran.status, 1);
    assert!(
        ran.stdout.contains("STOPPED by the machine: limit, axis y moving forward; "),
        "{}",
        ran.stdout
    );
    assert!(
        ran.stdout.ends_with(
            "\nto do: `carrystep stop --clear`, then jog that axis away from the switch\n"
        ),
        "{}",
        ran.stdout
    );
    let said = told(&folder);
    assert!(said.contains("\nSTOPPED: limit, from y; "), "{said}");
    assert!(
        said.contains(
            "\nto do: `carrystep stop --clear`, then jog that axis away from the switch\n"
        ),
        "{said}"
    );
}

#[test]
fn a_jog_of_less_than_half_a_step_is_refused() {
    let folder = folder();
    // The command does not contact a board.
    let jog = |way: &str| folder.run(&format!("jog {way} --machine machine.toml --port none"));
    jog("x 0.08").refuses(
        "jog x 0.08 is 0.400 step, which rounds to no step at all: nothing would move. One step of x is 0.2 of",
    );
    jog("y -0.005").refuses("jog y -0.005 is 0.400 step");
    jog("x 0").refuses("jog x 0 is 0.000 step");
    jog("x 0.1").refuses("there is no serial port none");
}
