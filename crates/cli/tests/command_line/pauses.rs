//! Jogs and offsets while a program waits, and the rest of the program behind them.

use crate::command::{Folder, Ran};
use crate::run_programs::{
    HOME, LONG, MACHINE, PAUSES, begins, done, folder, hold, positions, resume, run, spindle,
    status, waits,
};
use crate::schemas;
use crate::stops::{drives, moving};
use crate::terminal::Screen;
use crate::virtual_boards::{Board, document, passed};
use std::process::Command;

fn jog(folder: &Folder, board: &Board, options: &str) -> Ran {
    folder.run(&format!("jog --machine machine.toml --port {} {options}", board.port))
}

fn offset(folder: &Folder, board: &Board, options: &str) -> Ran {
    let ran = format!("offset --machine machine.toml --port {} {options}", board.port);
    folder.run(ran.trim_end())
}

fn at(folder: &Folder, board: &Board) -> Vec<i64> {
    positions(&status(folder, board))
}

fn refused(ran: &Ran, why: &str) {
    let said = ran.stderr.replace("\n  ", " ");
    assert!(ran.status == 2 && said.contains(why), "{}: {said}", ran.status);
}

#[test]
fn program_goes_on_from_where_it_was_jogged_to() {
    // The pause is between two steps of x.
    let folder = folder("G21 G90 F1500\nG1 X4.003\nM0\nG1 Y3\nM6 T2\nG1 Z-1\nG1 X0\nM2\n");
    let board = Board::new(&folder, "--fast");
    let mut child = begins(&folder, &board);
    let first = waits(&folder, &board, &mut child);
    assert_eq!(at(&folder, &board), [320, 0, 0]);
    let ran = jog(&folder, &board, "--axis y=-2,z=0.5,x=1 --feed 600 --json");
    passed(&ran);
    let told = schemas::check(&ran.stdout);
    assert_eq!(told["place"], serde_json::json!({"x": 5.0, "y": -2.0, "z": 0.5}));
    assert_eq!(told["waits"], first);
    assert_eq!(at(&folder, &board), [400, -160, 200]);
    passed(&jog(&folder, &board, "z -0.25"));
    assert_eq!(at(&folder, &board), [400, -160, 100]);
    passed(&resume(&folder, &board));
    let second = loop {
        let now = waits(&folder, &board, &mut child);
        if now != first {
            break now;
        }
    };
    assert_eq!(second, "tool change in line 5 (M6)");
    // y alone moves to its target; the others stay where they were jogged to.
    assert_eq!(at(&folder, &board), [400, 240, 100]);
    passed(&resume(&folder, &board));
    let told = done(child);
    assert_eq!((&told["program"]["waits"], &told["passed"]), (&2.into(), &true.into()));
    assert_eq!(told["axes"][1]["steps_planned"], 240);
    assert!(board.end().contains("\nx at 0\ny at 240\nz at -400\n"));
}

#[test]
fn offset_that_is_set_in_a_pause_holds_for_the_rest_and_is_kept() {
    let folder = folder(PAUSES);
    let board = Board::new(&folder, "--fast");
    let mut child = begins(&folder, &board);
    let first = waits(&folder, &board, &mut child);
    passed(&jog(&folder, &board, "z 2"));
    let ran = offset(&folder, &board, "--set G54 z=0.5,y=1");
    passed(&ran);
    assert!(ran.stdout.contains("machine place: x 4.0000 y 0.0000 z 2.0000\nG54 y -1 z 1.5\n"));
    passed(&resume(&folder, &board));
    while waits(&folder, &board, &mut child) == first {}
    assert_eq!(at(&folder, &board), [320, 160, 800]);
    passed(&resume(&folder, &board));
    done(child);
    assert_eq!(at(&folder, &board), [320, 160, 200]);
    let ran = offset(&folder, &board, "");
    assert!(ran.stdout.ends_with("\nG54 y -1 z 1.5\n"), "{}", ran.stdout);
    passed(&offset(&folder, &board, "--clear"));
    // As often as one likes, and with what is kept.
    let mut child = begins(&folder, &board);
    waits(&folder, &board, &mut child);
    passed(&offset(&folder, &board, "--set G54 x=0"));
    passed(&offset(&folder, &board, "--clear"));
    passed(&resume(&folder, &board));
    while waits(&folder, &board, &mut child) == first {}
    assert_eq!(at(&folder, &board), [320, 240, 200]);
    child.kill().unwrap();
    child.wait().unwrap();
}

#[test]
fn rest_that_cannot_be_executed_leaves_the_program_waiting() {
    let folder = folder("G21 G90 F1500\nG1 X4\nM0\nG1 X6\nM2\n");
    let switches = MACHINE
        .replace("debounce_us = 100", "debounce_us = 100\nlimits = \"pair\"")
        .replace("travel = [-9, 20]\n", HOME);
    folder.write("machine.toml", switches);
    let board = Board::new(&folder, "--fast --min x=-400");
    passed(&folder.run(&format!("home --machine machine.toml --port {}", board.port)));
    let mut child = begins(&folder, &board);
    let first = waits(&folder, &board, &mut child);
    refused(
        &jog(&folder, &board, "x 17"),
        "x would go to 21 units, beyond its travel of -9 to 20 units",
    );
    refused(&jog(&folder, &board, "q 1"), "q");
    refused(&jog(&folder, &board, "x 0.001"), "no step at all");
    // 4 mm are -12 now, so 6 mm are at 22.
    passed(&offset(&folder, &board, "--set G54 x=-12"));
    passed(&resume(&folder, &board));
    let why = loop {
        let now = waits(&folder, &board, &mut child);
        if now != first {
            break now;
        }
    };
    assert!(why.contains("cannot go on") && why.contains("x would go to 22 mm"), "{why}");
    passed(&offset(&folder, &board, "--set G54 x=-2"));
    passed(&resume(&folder, &board));
    done(child);
    let found = status(&folder, &board);
    assert_eq!(found["axes"][0]["machine"], 12.0);
    refused(&jog(&folder, &board, "x 9"), "beyond its travel");
    passed(&jog(&folder, &board, "--axis x=-1,z=1 --feed 300"));
    assert_eq!(status(&folder, &board)["axes"][0]["machine"], 11.0);
}

#[test]
fn move_in_the_line_of_a_wait_does_not_go_from_another_place() {
    let folder = folder("G21 G90 F1500\nG1 X4\nM6 T1 G1 X6\nM2\n");
    let board = Board::new(&folder, "--fast");
    let mut child = begins(&folder, &board);
    let first = waits(&folder, &board, &mut child);
    passed(&jog(&folder, &board, "y 1"));
    passed(&resume(&folder, &board));
    let why = loop {
        let now = waits(&folder, &board, &mut child);
        if now != first {
            break now;
        }
    };
    assert!(why.contains("has a move of its own"), "{why}");
    assert_eq!(at(&folder, &board), [320, 80, 0]);
    passed(&folder.run(&format!("stop --port {} --machine machine.toml", board.port)));
    assert_eq!(document(child)["ended"], "stopped");
}

#[test]
fn nothing_is_changed_in_a_hold_or_in_motion() {
    let folder = folder(LONG);
    let board = Board::new(&folder, "--fast");
    let mut child = begins(&folder, &board);
    moving(&folder, &mut child, &board.port);
    refused(&jog(&folder, &board, "x 1"), "is in use by");
    refused(&offset(&folder, &board, "--set G54 x=0"), "is in use by");
    passed(&hold(&folder, &board));
    waits(&folder, &board, &mut child);
    refused(&jog(&folder, &board, "x 1"), "the program is held on its path");
    refused(&offset(&folder, &board, "--clear"), "the program is held on its path");
    passed(&resume(&folder, &board));
    done(child);
    assert!(board.end().contains("\nx at 0\ny at 0\nz at 0\n"));
}

/// The rising edges of the step pins of a capture in their order: time and pin.
pub fn pulses(folder: &Folder, name: &str) -> Vec<(u64, String)> {
    let vcd = std::fs::read_to_string(folder.path(name)).unwrap();
    let (mut pins, mut now, mut pulses) = (Vec::new(), 0, Vec::new());
    for line in vcd.lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        if let ["$var", _, _, code, "step", ..] = words[..] {
            pins.push(code.to_owned());
        } else if let Some(time) = line.strip_prefix('#') {
            now = time.parse().unwrap();
        } else if let Some(code) = line.strip_prefix('1')
            && pins.iter().any(|pin| pin == code)
        {
            pulses.push((now, code.to_owned()));
        }
    }
    pulses.sort();
    pulses
}

#[test]
fn pause_in_which_nothing_was_changed_moves_pulses_in_time_only() {
    let folder = folder(
        "G21 G90 F1500\nM3 S1000\nG1 X4.003 Y1.01\nM5\nM0\nG1 Y3 Z0.7\nM6 T2\n\
         G3 X2 Y5 I-2\nG1 Z-1 X0\nM2\n",
    );
    let board = Board::new(&folder, "--fast --vcd a.vcd");
    let mut child = begins(&folder, &board);
    let first = waits(&folder, &board, &mut child);
    passed(&offset(&folder, &board, ""));
    refused(&jog(&folder, &board, "x 0.001"), "no step at all");
    passed(&resume(&folder, &board));
    while waits(&folder, &board, &mut child) == first {}
    passed(&resume(&folder, &board));
    done(child);
    board.end();
    passed(&folder.run("check a.vcd job.ngc --machine machine.toml --path-only"));
    passed(&folder.run("simulate job.ngc --machine machine.toml --vcd b.vcd"));
    // Each of the three stretches is later by a time of its own.
    let (ran, planned) = (pulses(&folder, "a.vcd"), pulses(&folder, "b.vcd"));
    assert_eq!((ran.len(), planned.len()), (2008, 2008));
    let mut shifts: Vec<i128> = Vec::new();
    for ((at, pin), (time, of)) in ran.iter().zip(&planned) {
        assert_eq!(pin, of);
        shifts.push(i128::from(*at) - i128::from(*time));
    }
    shifts.dedup();
    assert_eq!(shifts.len(), 3, "{shifts:?}");
}

#[test]
fn what_is_switched_before_a_wait_is_switched_when_it_begins() {
    for codes in ["M5\nM0", "M6 T1"] {
        let folder = folder(&format!("G21 G90 F1500\nM3 S1000\nG1 X4\n{codes}\nG1 Y3\nM2\n"));
        passed(&folder.run("simulate job.ngc --machine machine.toml"));
        let board = Board::new(&folder, "--fast --vcd a.vcd");
        let mut child = begins(&folder, &board);
        waits(&folder, &board, &mut child);
        child.kill().unwrap();
        child.wait().unwrap();
        assert_eq!(spindle(&folder, board), ["0", "1", "0"], "{codes}");
    }
}

#[test]
fn stop_in_a_jog_ends_the_jog_and_the_program() {
    let folder = folder(PAUSES);
    let board = Board::new(&folder, "--fast");
    let mut child = begins(&folder, &board);
    waits(&folder, &board, &mut child);
    // Hours at 20 mm/s.
    let jogs = drives(&folder, "jog z 90000 --machine machine.toml", &board.port);
    while at(&folder, &board)[2] == 0 {}
    refused(&jog(&folder, &board, "x 1"), "another jog, probe or offset is not done yet");
    passed(&folder.run(&format!("stop --port {} --machine machine.toml", board.port)));
    let ended = jogs.wait_with_output().unwrap();
    assert_eq!(ended.status.code(), Some(1));
    let said = String::from_utf8_lossy(&ended.stdout).into_owned();
    assert!(said.contains("the jog was stopped"), "{said}");
    assert_eq!(document(child)["ended"], "stopped");
    // Its place is true, and a program begins there.
    let rest = at(&folder, &board);
    folder.write("job.ngc", "G21 G91 F1500\nG1 Z1\nM2\n");
    passed(&run(&folder, &board, ""));
    assert_eq!(at(&folder, &board)[2], rest[2] + 400);
}

#[test]
fn resume_is_refused_while_a_jog_of_the_pause_moves() {
    let folder = folder("G21 G90 F1500\nG1 X4\nM0\nG1 X5 Y3\nM2\n");
    let board = Board::new(&folder, "--fast");
    let mut child = begins(&folder, &board);
    let first = waits(&folder, &board, &mut child);
    // Some seconds.
    let jogs = drives(&folder, "jog z 20 --feed 60 --machine machine.toml", &board.port);
    while at(&folder, &board)[2] == 0 {}
    refused(&resume(&folder, &board), "a jog, probe or offset of the pause is not done yet");
    done(jogs);
    // It was not remembered.
    std::thread::sleep(std::time::Duration::from_millis(100));
    assert_eq!(waits(&folder, &board, &mut child), first);
    assert_eq!(at(&folder, &board), [320, 0, 8000]);
    passed(&resume(&folder, &board));
    done(child);
    assert_eq!(at(&folder, &board), [400, 240, 8000]);
}

#[cfg(target_os = "linux")]
#[test]
fn enter_while_a_jog_of_the_pause_moves_is_forgotten() {
    let folder = folder("G21 G90 F1500\nG1 X4\nM0\nG1 X5\nM2\n");
    let board = Board::new(&folder, "--fast");
    // In the foreground of its terminal, as behind a shell.
    let mut command = Command::new("setsid");
    command.args([
        "-c",
        env!("CARGO_BIN_EXE_carrystep"),
        "run",
        "job.ngc",
        "--machine",
        "machine.toml",
        "--port",
        &board.port,
    ]);
    command.env("CARRYSTEP_STATE", folder.state()).current_dir(folder.path(""));
    let mut screen = Screen::start(&mut command);
    screen.waits_for("the machine rests; Enter, or ");
    let jogs = drives(&folder, "jog z 20 --feed 60 --machine machine.toml", &board.port);
    while at(&folder, &board)[2] == 0 {}
    screen.types("\n");
    done(jogs);
    std::thread::sleep(std::time::Duration::from_millis(200));
    assert!(status(&folder, &board)["waits"].is_string());
    screen.types("\n");
    screen.waits_for("DONE");
    assert_eq!(at(&folder, &board), [400, 0, 8000]);
}

#[test]
fn offsets_of_a_pause_that_cannot_be_kept_are_not_set() {
    let folder = crate::probes::folder(PAUSES);
    let board = Board::new(&folder, "--fast --probe z=-400");
    let mut child = begins(&folder, &board);
    let first = waits(&folder, &board, &mut child);
    passed(&offset(&folder, &board, "--set G55 x=1"));
    let before = offset(&folder, &board, "").stdout;
    // Nobody can write into the folder any more.
    let away = folder.path("state");
    std::fs::rename(folder.state(), &away).unwrap();
    std::fs::write(folder.state(), "").unwrap();
    let rests = at(&folder, &board);
    for line in ["jog z 1 --set G54", "jog --set G54 z=0", "offset --set G54 z=0", "offset --clear"]
        .iter()
        .chain(&["probe z -20 --feed 600 --set G54"])
    {
        let ran = folder.run(&format!("{line} --machine machine.toml --port {}", board.port));
        assert_eq!(ran.status, 1, "{line}: {}", ran.stderr);
        let said = ran.stderr.replace("\n  ", " ");
        assert!(said.contains("the work offsets cannot be kept"), "{line}: {said}");
        assert!(said.contains("CARRYSTEP_STATE"), "{line}: {said}");
        assert_eq!(at(&folder, &board), rests, "{line}: it has moved");
        assert_eq!(offset(&folder, &board, "").stdout, before, "{line}");
    }
    // The program waits further, and goes on with the offsets of before.
    std::fs::remove_file(folder.state()).unwrap();
    std::fs::rename(&away, folder.state()).unwrap();
    assert_eq!(waits(&folder, &board, &mut child), first);
    passed(&jog(&folder, &board, "z 1 --set G54 z=3"));
    passed(&resume(&folder, &board));
    while waits(&folder, &board, &mut child) == first {}
    passed(&resume(&folder, &board));
    done(child);
    // Machine z 1 is 3 in G54, and the program ends at -1.
    assert_eq!(at(&folder, &board), [320, 240, -1200]);
}

#[test]
fn offsets_outlive_a_run_that_is_killed_in_motion() {
    let folder = folder(&LONG.replace("[6]", "[600]"));
    let board = Board::new(&folder, "--fast");
    passed(&offset(&folder, &board, "--set G54 x=-3"));
    let mut child = begins(&folder, &board);
    moving(&folder, &mut child, &board.port);
    child.kill().unwrap();
    child.wait().unwrap();
    passed(&folder.run(&format!("stop --clear --port {} --machine machine.toml", board.port)));
    let ran = offset(&folder, &board, "");
    assert!(ran.stdout.ends_with("\nG54 x 3\n"), "{} {}", ran.stdout, ran.stderr);
}
