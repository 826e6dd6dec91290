//! Senders that people use drive a virtual board through `carrystep serve`: CNCjs from npm, and the
//! sender of bCNC from PyPI.
//!
//! They are downloaded and take minutes, so this is a longer run: `cargo xtask long senders`. It
//! needs node, npm and Python with tkinter. Without CARRYSTEP_SENDERS the tests do nothing.
#![allow(clippy::print_stderr, reason = "figures, for the page of longer runs")]

mod bcnc;
mod cncjs;

use crate::command::Folder;
use crate::sender::{Sender, Served, place};
use crate::serve_streams::edges;
use crate::virtual_boards::{Board, passed};
use cncjs::Cncjs;
use serde_json::{Value, json};

/// Programs, and where they end, mm.
const PROGRAMS: [(&str, &str, [f64; 3]); 3] = [
    ("trochoid", include_str!("../../../../sim/jobs/trochoid.ngc"), [76.0, 0.0, 0.0]),
    ("chords_and_star", include_str!("../../../../sim/jobs/chords_and_star.ngc"), [25.0, 0.0, 0.0]),
    ("relief", include_str!("../../../../sim/jobs/relief.ngc"), [0.0, 29.5, 5.0]),
];

/// `None` if nobody asks for these tests.
fn folder() -> Option<Folder> {
    std::env::var_os("CARRYSTEP_SENDERS")?;
    let folder = Folder::new();
    // The watchdog is long and the queues are deep, because this computer may be busy.
    let machine = include_str!("../../../../sim/jobs/machine.toml").replace(
        "[machine]\n",
        "[machine]\nqueue_depth = 31\nlink = { baud = 3_000_000 }\nguard = { watchdog_ms = 4000 }\n",
    );
    folder.write("machine.toml", machine.replace("80_000_000", "48_000_000"));
    Some(folder)
}

/// Runs a program by `carrystep run` on a board of its own, and returns what the board has said.
fn ran(folder: &Folder, program: &str, options: &str) -> String {
    folder.write("job.ngc", program);
    let board = Board::new(folder, &format!("--fast {options}"));
    passed(&folder.run(&format!("run job.ngc --machine machine.toml --port {}", board.port)));
    board.end()
}

/// A virtual board that is served to a CNCjs, and a connection that watches.
fn served_to_cncjs(folder: &Folder, options: &str) -> (Board, Served, Cncjs, Sender) {
    let board = Board::new(folder, options);
    let served = Served::with(folder, &format!("--port {} --link grbl", board.port));
    let cncjs = Cncjs::new(folder, &folder.path("grbl").display().to_string());
    let watcher = Sender::tcp(&served);
    (board, served, cncjs, watcher)
}

/// The positions that a board says when it ends.
fn positions(said: &str) -> Vec<&str> {
    said.lines().filter(|line| line.contains(" at ")).collect()
}

/// Whether the state that CNCjs shows has this machine place.
fn is_at(status: &Value, wanted: &[f64]) -> bool {
    ["x", "y", "z"].iter().zip(wanted).all(|(axis, wanted)| {
        status["mpos"][axis].as_str().and_then(|at| at.parse().ok()) == Some(*wanted)
    })
}

/// Settings, three files, a pause and overrides in motion; the end is that of `run`.
#[test]
fn cncjs_streams_programs() {
    let Some(folder) = folder() else { return };
    let (board, served, mut cncjs, mut watcher) = served_to_cncjs(&folder, "--fast");
    // CNCjs has understood them: the words behind a value are its own.
    let accel = "$120=1000.000 (X-axis acceleration, mm/sec^2)";
    assert!(cncjs.said.iter().any(|line| line == accel), "{:?}", cncjs.said);
    let mut lines = 0;
    for (name, program, end) in PROGRAMS {
        cncjs.load(name, program);
        cncjs.command("gcode:start", &[]);
        if name == "relief" {
            pauses(&mut cncjs, &mut watcher, name);
            overrides(&mut cncjs);
        }
        lines += cncjs.finishes(name);
        assert_eq!(watcher.place(), end, "{name}");
        cncjs.state(|status| status["activeState"] == "Idle" && is_at(status, &end));
        cncjs.command("gcode:stop", &[]);
    }
    let wrong = cncjs.said.iter().find(|line| line.contains("error:") || line.contains("ALARM"));
    assert_eq!(wrong, None);
    // Once more, with a closed port between. A watcher would drive meanwhile.
    drop(watcher);
    cncjs.close();
    cncjs.open();
    let mut watcher = Sender::tcp(&served);
    cncjs.load("again", "G21 G90\nG0 X1 Y2 Z0\n");
    cncjs.command("gcode:start", &[]);
    cncjs.finishes("again");
    assert_eq!(watcher.place(), [1.0, 2.0, 0.0]);
    cncjs.end();
    assert_eq!(served.interrupt().0, 0);
    assert_eq!(positions(&board.end()), ["x at 80", "y at 160", "z at 0"]);
    // `run` ends each program where CNCjs has ended it.
    for (name, program, end) in PROGRAMS {
        let said = ran(&folder, program, "");
        let steps: Vec<String> = ["x", "y", "z"]
            .iter()
            .zip(end.iter().zip([80.0, 80.0, 400.0]))
            .map(|(axis, (at, steps))| format!("{axis} at {}", at * steps))
            .collect();
        assert_eq!(positions(&said), steps, "{name}");
    }
    eprintln!(
        "FIGURES {} programs through CNCjs, {lines} lines, paused and with overrides in motion, \
         ends exact and those of run",
        PROGRAMS.len()
    );
}

/// A pause in motion: the machine rests, no line is taken, and then it goes on.
fn pauses(cncjs: &mut Cncjs, watcher: &mut Sender, name: &str) {
    cncjs.answered(name, 200);
    cncjs.command("gcode:pause", &[]);
    cncjs.until("workflow:state", |event| event[1] == "paused");
    let at = place(&watcher.state("Hold:0"));
    // The pause has met the program in motion: it has 30 mm in y.
    assert!(at[1] < 29.5 && at != [0.0; 3], "{at:?}");
    cncjs.state(|status| status["activeState"] == "Hold" && is_at(status, &at));
    assert_eq!(place(&watcher.report()), at);
    cncjs.command("gcode:resume", &[]);
    cncjs.until("workflow:state", |event| event[1] == "running");
    watcher.state("Run");
}

/// Overrides in motion, each shown by CNCjs, and all taken back.
fn overrides(cncjs: &mut Cncjs) {
    for value in [10, 10, -1] {
        cncjs.command("feedOverride", &[json!(value)]);
    }
    cncjs.command("rapidOverride", &[json!(50)]);
    cncjs.command("spindleOverride", &[json!(-10)]);
    cncjs.state(|status| status["ov"] == json!([119, 50, 90]));
    for name in ["feedOverride", "rapidOverride", "spindleOverride"] {
        cncjs.command(name, &[json!(0)]);
    }
    cncjs.state(|status| status["ov"] == json!([100, 100, 100]));
}

/// A program that CNCjs sends in a hold has the pulses of `run`.
#[test]
fn cncjs_in_a_hold_has_the_pulses_of_run() {
    let Some(folder) = folder() else { return };
    let (name, program, end) = PROGRAMS[0];
    ran(&folder, program, "--vcd run.vcd");
    let (board, served, mut cncjs, mut watcher) =
        served_to_cncjs(&folder, "--fast --vcd serve.vcd");
    cncjs.command("feedhold", &[]);
    watcher.state("Hold:0");
    cncjs.load(name, program);
    cncjs.command("gcode:start", &[]);
    cncjs.finishes(name);
    assert_eq!(place(&watcher.state("Hold:0")), [0.0; 3]);
    cncjs.command("cyclestart", &[]);
    cncjs.until("serialport:read", |event| event[1] == "[MSG:Pgm End]");
    assert_eq!(watcher.place(), end);
    cncjs.end();
    assert_eq!(served.interrupt().0, 0);
    board.end();
    let [ran, streamed] = ["run.vcd", "serve.vcd"]
        .map(|name| edges(&std::fs::read_to_string(folder.path(name)).unwrap()));
    assert!(ran.len() > 10_000, "{}", ran.len());
    let differs = ran.iter().zip(&streamed).position(|(one, other)| one != other);
    assert_eq!((differs, ran.len()), (None, streamed.len()));
    eprintln!("FIGURES {} edges of {name} through CNCjs in a hold, those of run", ran.len());
}

/// The last edge of a capture, s from the first one.
fn seconds(folder: &Folder, vcd: &str) -> f64 {
    let edges = edges(&std::fs::read_to_string(folder.path(vcd)).unwrap());
    edges.last().unwrap().0 as f64 / 1e12
}

/// A program that CNCjs sends while the machine moves keeps to its path, and takes hardly longer
/// than by `run`. The board is one in real time, because lines that come late cost time.
#[test]
fn cncjs_takes_hardly_longer_than_run() {
    let Some(folder) = folder() else { return };
    let (name, program, end) = PROGRAMS[0];
    ran(&folder, program, "--vcd run.vcd");
    let (board, served, mut cncjs, mut watcher) = served_to_cncjs(&folder, "--vcd serve.vcd");
    cncjs.load(name, program);
    cncjs.command("gcode:start", &[]);
    cncjs.finishes(name);
    assert_eq!(watcher.place(), end);
    cncjs.end();
    assert_eq!(served.interrupt().0, 0);
    board.end();
    passed(&folder.run("check serve.vcd job.ngc --machine machine.toml --path-only"));
    let [ran, streamed] = ["run.vcd", "serve.vcd"].map(|vcd| seconds(&folder, vcd));
    assert!(streamed <= ran * 1.02, "{streamed} s by CNCjs, {ran} s by run");
    eprintln!("FIGURES {name} through CNCjs in real time: {:.4} x the time of run", streamed / ran);
}

/// CNCjs is killed in motion: what was answered is executed, and the next CNCjs drives.
#[test]
fn cncjs_is_killed_in_motion() {
    let Some(folder) = folder() else { return };
    let served = Served::new(&folder, "--link grbl");
    let port = folder.path("grbl").display().to_string();
    let mut cncjs = Cncjs::new(&folder, &port);
    let mut watcher = Sender::tcp(&served);
    let (name, program, _) = PROGRAMS[2];
    cncjs.load(name, program);
    cncjs.command("gcode:start", &[]);
    cncjs.answered(name, 200);
    watcher.state("Run");
    cncjs.server.kill().unwrap();
    let at = watcher.place();
    drop(cncjs);
    drop(watcher);
    let mut cncjs = Cncjs::new(&folder, &port);
    cncjs.load("back", "G21 G90\nG0 Z5\nG0 X0 Y0\n");
    cncjs.command("gcode:start", &[]);
    cncjs.finishes("back");
    cncjs.state(|status| status["activeState"] == "Idle" && is_at(status, &[0.0, 0.0, 5.0]));
    cncjs.end();
    assert_eq!(served.interrupt().0, 0);
    eprintln!("FIGURES CNCjs killed in motion, at rest at {at:?}, the next one goes on");
}

/// bCNC streams a program by counting characters, with an override and a pause in motion. When it
/// closes the port, it holds and resets the machine, which keeps its place.
#[test]
fn bcnc_streams_a_program() {
    let Some(folder) = folder() else { return };
    let (name, program, end) = PROGRAMS[0];
    folder.write("job.ngc", program);
    let board = Board::new(&folder, "--fast");
    let served = Served::with(&folder, &format!("--port {} --link grbl", board.port));
    let said = bcnc::streams(&folder, &folder.path("grbl"));
    assert_eq!(said["settings"], json!(["80.000", "80.000", "400.000"]));
    assert_eq!((&said["place"], &said["state"]), (&json!(end), &json!("Idle")));
    assert_eq!(Sender::tcp(&served).place(), end);
    assert_eq!(served.interrupt().0, 0);
    assert_eq!(positions(&board.end()), ["x at 6080", "y at 0", "z at 0"]);
    eprintln!("FIGURES {} lines of {name} through bCNC, end exact", said["lines"]);
}
