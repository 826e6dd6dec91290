//! Spindle and coolant beside the lines of a sender: 0x9E, 0xA0, 0xA1, the safety door, and a reset.

use crate::command::Folder;
use crate::program_outputs::changes;
use crate::run_programs::MACHINE;
use crate::sender::{Sender, Served, place};
use crate::virtual_boards::Board;

const SPINDLE_STOP: &[u8] = &[0x9e];
const FLOOD: &[u8] = &[0xa0];
const MIST: &[u8] = &[0xa1];
const DOOR: &[u8] = &[0x84];

/// The machine of these tests with a spindle on output 0 and flood on output 1, and mist on output 2
/// if it is wanted.
fn begins(mist: bool) -> (Folder, Board, Served, Sender) {
    let folder = Folder::new();
    let outputs =
        format!("count = 3\nspindle = 0\nflood = 1\n{}", if mist { "mist = 2\n" } else { "" });
    folder.write("machine.toml", MACHINE.replace("count = 2\nspindle = 0\n", &outputs));
    let board = Board::new(&folder, "--fast --vcd a.vcd");
    let served = Served::with(&folder, &format!("--port {}", board.port));
    let sender = Sender::tcp(&served);
    (folder, board, served, sender)
}

/// The machine of these tests with a spindle and an interlock.
fn with_interlock() -> (Folder, Board, Served, Sender) {
    let folder = Folder::new();
    let inputs = "[machine.inputs]\ninterlock = \"high\"\n\n[machine.outputs]\n";
    folder.write("machine.toml", MACHINE.replace("[machine.outputs]\n", inputs));
    let board = Board::new(&folder, "--fast");
    let served = Served::with(&folder, &format!("--port {}", board.port));
    let sender = Sender::tcp(&served);
    (folder, board, served, sender)
}

/// The outputs of the board with their levels, in the order of their changes, and the place of x.
fn switched(folder: &Folder, board: Board, served: Served) -> Vec<(usize, bool, f64)> {
    assert_eq!(served.interrupt().0, 0);
    board.end();
    let vcd = std::fs::read_to_string(folder.path("a.vcd")).unwrap();
    changes(&vcd).into_iter().map(|(output, level, [x, _])| (output, level, x)).collect()
}

/// The letters of `A:` in the next report that has overrides.
fn accessories(sender: &mut Sender) -> String {
    loop {
        let report = sender.report();
        if report.contains("|Ov:") {
            let shown = report.trim_end_matches('>').split("|A:").nth(1);
            return shown.unwrap_or_default().to_owned();
        }
    }
}

/// Waits until these are shown.
#[track_caller]
fn shows(sender: &mut Sender, wanted: &str) {
    let begin = std::time::Instant::now();
    loop {
        let shown = accessories(sender);
        if shown == wanted {
            return;
        }
        assert!(begin.elapsed().as_secs() < 60, "{shown:?}, wanted {wanted:?}");
    }
}

/// Waits until x is there, mm.
fn moves(sender: &mut Sender, to: f64) {
    while place(&sender.report())[0] < to {}
}

#[test]
fn spindle_stops_in_a_hold_and_starts_again_before_the_motion() {
    let (folder, board, served, mut sender) = begins(false);
    // Not in a hold: it is ignored.
    sender.send(SPINDLE_STOP);
    sender.simple("G21 G91 M3 S1000\nG1 X4 F100");
    moves(&mut sender, 0.5);
    sender.send("!");
    sender.state("Hold:0");
    shows(&mut sender, "S");
    sender.send(SPINDLE_STOP);
    shows(&mut sender, "");
    assert!(sender.report().contains("|FS:0,0"));
    sender.send(SPINDLE_STOP);
    shows(&mut sender, "S");
    sender.send(SPINDLE_STOP);
    shows(&mut sender, "");
    let rests = place(&sender.report())[0];
    sender.send("~");
    assert_eq!(sender.place(), [4.0, 0.0, 0.0]);
    shows(&mut sender, "S");
    sender.simple("M5\nG0 X1");
    assert_eq!(sender.place(), [5.0, 0.0, 0.0]);
    let found = switched(&folder, board, served);
    let levels: Vec<(usize, bool)> = found.iter().map(|change| (change.0, change.1)).collect();
    assert_eq!(
        levels,
        [true, false, true, false, true, false].map(|level| (0, level)),
        "{found:?}"
    );
    for change in &found[1..5] {
        assert!((change.2 - rests).abs() < 0.013, "{found:?}, held at {rests}");
    }
}

#[test]
fn coolant_is_toggled_at_rest_in_motion_and_by_later_lines() {
    let (folder, board, served, mut sender) = begins(true);
    sender.simple("G21 G91");
    sender.send(FLOOD);
    shows(&mut sender, "F");
    assert!(sender.ask("$G")[0].contains(" M8 "));
    sender.send(MIST);
    shows(&mut sender, "FM");
    sender.send(FLOOD);
    shows(&mut sender, "M");
    assert!(sender.ask("$G")[0].contains(" M7 "));
    // A line goes first again.
    sender.done("M9");
    shows(&mut sender, "");
    sender.simple("M8\nG1 X4 F100");
    moves(&mut sender, 0.5);
    sender.send(FLOOD);
    shows(&mut sender, "");
    // The segments with the first change are sent meanwhile.
    moves(&mut sender, 2.0);
    sender.send(FLOOD);
    sender.send("!");
    sender.state("Hold:0");
    shows(&mut sender, "F");
    // In a jog, it is ignored.
    sender.send("~");
    assert_eq!(sender.place(), [4.0, 0.0, 0.0]);
    sender.done("$J=G91 X1 F200");
    sender.state("Jog");
    sender.send(FLOOD);
    assert_eq!(sender.place(), [5.0, 0.0, 0.0]);
    shows(&mut sender, "F");
    // A reset switches off what is on.
    sender.send("\u{18}");
    sender.until(|line| line.starts_with("Grbl"));
    shows(&mut sender, "");
    let found = switched(&folder, board, served);
    let levels: Vec<(usize, bool)> = found.iter().map(|change| (change.0, change.1)).collect();
    let rest = [(1, true), (2, true), (1, false), (2, false), (1, true)];
    assert_eq!(levels[..5], rest, "{found:?}");
    assert_eq!(levels[5..], [(1, false), (1, true), (1, false)], "{found:?}");
    let in_motion = found[5].2;
    assert!(in_motion > 0.4 && in_motion < 2.5, "{found:?}");
}

#[test]
fn machine_without_mist_ignores_its_character() {
    let (folder, board, served, mut sender) = begins(false);
    sender.send(MIST);
    sender.done("G91 G0 X1");
    assert_eq!(sender.place(), [1.0, 0.0, 0.0]);
    shows(&mut sender, "");
    assert_eq!(switched(&folder, board, served), []);
}

#[test]
fn safety_door_switches_off_and_on_again() {
    let (folder, board, served, mut sender) = begins(false);
    sender.simple("G21 G91 M3 S1000\nM8\nG1 X4 F100");
    moves(&mut sender, 0.5);
    sender.send(DOOR);
    // It is ignored until the machine rests.
    sender.send("~");
    let rests = place(&sender.state("Door:0"))[0];
    shows(&mut sender, "");
    assert_eq!(sender.ask("$$"), ["error:8"]);
    sender.send("~");
    assert_eq!(sender.place(), [4.0, 0.0, 0.0]);
    shows(&mut sender, "SF");
    // At rest, too, and not again behind a reset.
    sender.send(DOOR);
    sender.state("Door:0");
    shows(&mut sender, "");
    sender.send("\u{18}");
    sender.until(|line| line.starts_with("Grbl"));
    sender.simple("G91 G0 X-1");
    assert_eq!(sender.place(), [3.0, 0.0, 0.0]);
    shows(&mut sender, "");
    let found = switched(&folder, board, served);
    let levels: Vec<(usize, bool)> = found.iter().map(|change| (change.0, change.1)).collect();
    let pair = |level| [(0, level), (1, level)];
    assert_eq!(levels, [pair(true), pair(false), pair(true), pair(false)].concat(), "{found:?}");
    assert!(found[2..6].iter().all(|change| (change.2 - rests).abs() < 0.013), "{found:?}");
}

#[test]
fn interlock_that_opens_behind_the_safety_door_is_an_alarm_and_places_stay_true() {
    let (_folder, mut board, served, mut sender) = with_interlock();
    sender.simple("G21 G91 M3 S1000\nG1 X4 F100");
    moves(&mut sender, 0.5);
    sender.send(DOOR);
    let rests = place(&sender.state("Door:0"));
    board.press("interlock 1");
    sender.until(|line| line == "ALARM:3");
    sender.until(|line| line == "[MSG:stopped by the machine: interlock]");
    sender.send("~");
    assert_eq!(place(&sender.state("Alarm")), rests);
    assert_eq!(sender.ask("$X").last().unwrap(), "error:8");
    board.press("interlock 0");
    while sender.ask("$X").last().unwrap() != "ok" {}
    assert_eq!(sender.place(), rests);
    // What was left of the line is dropped.
    sender.done("G90 G0 X2");
    assert_eq!(sender.place(), [2.0, 0.0, 0.0]);
    assert_eq!(served.interrupt().0, 0);
    assert!(board.end().contains("\nx at 160\n"));
}
