//! `carrystep probe` and `jog --set` on virtual boards when something goes wrong: what is refused,
//! and what is true behind a stop, a limit, a killed command and a board that is pulled.

use crate::command::Folder;
use crate::probes::folder;
use crate::probes::with_switches;
use crate::run_programs::{LONG, PAUSES, begins, done, positions, resume, status, waits};
use crate::schemas;
use crate::stops::{drives, moving, signal};
use crate::touch_off::{at, command, refused, told, waits_again, z};
use crate::virtual_boards::{Board, document, passed};
use serde_json::{Value, json};

/// A move that takes hours, on which a test does something else.
const LONG_PROBE: &str = "probe z -90000 --feed 600 --machine machine.toml";

/// The same; `before` as long as the command that drives the board does not answer.
fn at_or(folder: &Folder, board: &Board, before: &[i64]) -> Vec<i64> {
    let found = status(folder, board);
    if found["axes"].is_array() { positions(&found) } else { before.to_vec() }
}

#[test]
fn probe_that_is_missed_leaves_the_axis_at_its_target_and_sets_nothing() {
    let folder = folder(PAUSES);
    let board = Board::new(&folder, "--fast");
    let line = "probe z -3 --feed 600 --set G54";
    let alone = command(&folder, &board, line);
    assert_eq!(alone.status, 1);
    assert!(alone.stderr.contains("the probe has not closed: z rests"), "{}", alone.stderr);
    assert_eq!(at(&folder, &board), [0, 0, -1200]);
    assert_eq!(told(&folder, &board, "offset")["offsets"], json!([]));
    // In a pause the program waits further, and goes on from there.
    let mut child = begins(&folder, &board);
    let first = waits(&folder, &board, &mut child);
    let ran = command(&folder, &board, &format!("{line} --json"));
    assert_eq!(ran.status, 1);
    let failure = schemas::check(&ran.stdout);
    assert!(failure["error"]["message"].as_str().unwrap().contains("not closed"), "{failure}");
    assert_eq!(waits(&folder, &board, &mut child), first);
    assert_eq!(at(&folder, &board), [320, 0, -2400]);
    passed(&resume(&folder, &board));
    waits_again(&folder, &board, &mut child, &first);
    passed(&resume(&folder, &board));
    assert_eq!(done(child)["offsets"], Value::Null);
    assert_eq!(at(&folder, &board), [320, 240, -400]);
}

#[test]
fn probe_moves_that_cannot_be_made_move_nothing() {
    let folder = with_switches(&LONG.replace("[6]", "[600]"));
    let mut board = Board::new(&folder, "--fast --min x=-400 --probe z=-4000000");
    let probe = |board: &Board, line: &str| command(&folder, board, &format!("probe {line}"));
    refused(&probe(&board, "z -1 --feed 60"), "x is not homed");
    refused(&command(&folder, &board, "jog z 1 --set G54"), "x is not homed");
    refused(&probe(&board, "z -1 --feed 60 --unhomed --set G54"), "cannot be used with");
    refused(&probe(&board, "z -1"), "--feed");
    refused(&probe(&board, "z -1 --feed 60 --plate 1"), "--set");
    refused(&probe(&board, "z -1 --feed 60 --plate -1 --set G54"), "expected a length");
    refused(&probe(&board, "z -1 --feed 60 --set G43.1"), "--tool G54");
    refused(&probe(&board, "z -1 --feed 60 --set G54 --tool G54"), "cannot be used with");
    refused(&probe(&board, "z -1 --feed 60 --away --retract 1"), "cannot be used with");
    refused(&probe(&board, "q -1 --feed 60 --unhomed"), "no axis is called 'q'");
    refused(&probe(&board, "z 0 --feed 60 --unhomed"), "no step at all");
    assert_eq!(at(&folder, &board), [0, 0, 0]);
    passed(&command(&folder, &board, "home"));
    refused(&probe(&board, "x -10.5 --feed 60"), "beyond its travel of -9 to 20");
    refused(&probe(&board, "z -1 --feed 60 --away"), "the probe is open before the move begins");
    board.press("probe 1");
    refused(&probe(&board, "z -1 --feed 60"), "the probe is closed before the move begins");
    let homed = at(&folder, &board);
    let mut child = begins(&folder, &board);
    while at_or(&folder, &board, &homed) == homed {
        assert_eq!(child.try_wait().unwrap(), None, "it has ended");
    }
    refused(&probe(&board, "z -1 --feed 60"), "is in use by `carrystep run`");
    passed(&folder.run(&format!("hold --port {}", board.port)));
    waits(&folder, &board, &mut child);
    let held = at(&folder, &board);
    refused(&probe(&board, "z -1 --feed 60"), "the program is held on its path");
    assert_eq!(at(&folder, &board), held);
    passed(&command(&folder, &board, "stop"));
    assert_eq!(document(child)["ended"], "stopped");
    // In a pause the same is refused.
    folder.write("job.ngc", PAUSES);
    let mut child = begins(&folder, &board);
    let first = waits(&folder, &board, &mut child);
    let rests = at(&folder, &board);
    refused(&probe(&board, "z -1 --feed 60"), "the probe is closed before the move begins");
    assert_eq!(waits(&folder, &board, &mut child), first);
    assert_eq!(at(&folder, &board), rests);
    child.kill().unwrap();
    child.wait().unwrap();
}

#[test]
fn machine_without_a_probe_has_no_touch() {
    let folder = crate::run_programs::folder("M2\n");
    let board = Board::new(&folder, "--fast");
    let ran = command(&folder, &board, "probe z -1 --feed 60");
    refused(&ran, "the machine has no probe");
    assert_eq!(at(&folder, &board), [0, 0, 0]);
}

#[test]
fn limit_that_a_probe_move_meets_is_named_and_remembered() {
    let folder = with_switches("M2\n");
    let board = Board::new(&folder, "--fast --min z=-200");
    let line = "probe z -20 --feed 600 --unhomed";
    let ran = command(&folder, &board, &format!("{line} --json"));
    assert_eq!(ran.status, 1, "{}", ran.stderr);
    let found = schemas::check(&ran.stdout);
    assert_eq!((&found["ended"], &found["cause"]), (&"fault".into(), &"limit".into()));
    assert_eq!(found["culprits"], json!([{"axis": "z", "direction": -1}]));
    assert_eq!(found["touched"], Value::Null);
    passed(&command(&folder, &board, "stop --clear"));
    refused(&command(&folder, &board, line), "the limit switch of axis z is closed");
    passed(&command(&folder, &board, "jog z 2"));
}

#[test]
fn limit_that_is_met_in_a_pause_is_remembered_with_the_direction_of_the_pause() {
    for meets in ["jog z -90 --feed 30", "probe z -90 --feed 30"] {
        let folder = with_switches("G21 G90 F1500\nG1 Z1\nM0\nG1 X2\nM2\n");
        // One input for both ends does not say which of them was met.
        let machine = std::fs::read_to_string(folder.path("machine.toml")).unwrap();
        folder.write("machine.toml", machine.replace("\"pair\"", "\"each\""));
        let mut board = Board::new(&folder, "--fast");
        let mut child =
            drives(&folder, "run job.ngc --unhomed --machine machine.toml", &board.port);
        waits(&folder, &board, &mut child);
        // The program, and the pause as a whole, go up.
        passed(&command(&folder, &board, "jog z 100"));
        let top = at(&folder, &board);
        let line = format!("{meets} --machine machine.toml");
        let down = drives(&folder, &line, &board.port);
        while at_or(&folder, &board, &top) == top {}
        board.press("min z 1");
        assert_eq!(document(down)["passed"], false, "{meets}");
        let ended = document(child);
        assert_eq!(ended["culprits"], json!([{"axis": "z", "direction": -1}]), "{meets}");
        passed(&command(&folder, &board, "stop --clear"));
        refused(&command(&folder, &board, "jog z -1"), "the limit switch of axis z is closed");
        passed(&command(&folder, &board, "jog z 1"));
    }
}

#[test]
fn offset_that_cannot_be_kept_is_refused_before_anything_moves() {
    let folder = folder("M2\n");
    let board = Board::new(&folder, "--fast --probe z=-100");
    let lines = ["probe z -1 --feed 60 --set G54", "jog z 1 --set G54"];
    for line in lines {
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_carrystep"));
        command.args(line.split(' ')).args(["--machine", "machine.toml", "--port", &board.port]);
        // Nobody can make a folder there.
        command.env("CARRYSTEP_STATE", "/proc/carrystep").current_dir(folder.path(""));
        let ran = command.output().unwrap();
        let said = String::from_utf8_lossy(&ran.stderr);
        assert_eq!(ran.status.code(), Some(1), "{line}: {said}");
        assert!(said.contains("the work offsets cannot be kept"), "{line}: {said}");
    }
    assert_eq!(at(&folder, &board), [0, 0, 0]);
    passed(&command(&folder, &board, lines[1]));
    let before = at(&folder, &board);
    // A file that is cut in two stays.
    let file = std::fs::read_dir(folder.state()).unwrap().next().unwrap().unwrap().path();
    let text = std::fs::read(&file).unwrap();
    std::fs::write(&file, &text[..text.len() / 2]).unwrap();
    for line in lines {
        refused(&command(&folder, &board, line), "it is not whole");
    }
    assert_eq!(std::fs::read(&file).unwrap(), text[..text.len() / 2]);
    assert_eq!(at(&folder, &board), before);
}

#[test]
fn interrupt_in_a_probe_move_ramps_down_and_says_so() {
    let folder = folder(PAUSES);
    let board = Board::new(&folder, "--fast");
    let mut child = drives(&folder, LONG_PROBE, &board.port);
    while at_or(&folder, &board, &[0; 3])[2] == 0 {
        assert_eq!(child.try_wait().unwrap(), None, "it has ended");
    }
    refused(&command(&folder, &board, "probe z -1 --feed 60"), "is in use by `carrystep probe`");
    signal(&child, "-INT");
    let found = document(child);
    assert_eq!((&found["ended"], &found["stopped_by"]), (&"stopped".into(), &"interrupt".into()));
    assert_eq!(found["touched"], Value::Null);
    // The place is true, and no axis waits for the probe any more.
    let after = status(&folder, &board);
    assert_eq!(after["axes"][2]["seeking"], false);
    let rest = positions(&after)[2];
    assert_eq!((z(&found["place"]) * 400.0).round() as i64, rest);
    passed(&command(&folder, &board, "jog z 1"));
    assert_eq!(at(&folder, &board)[2], rest + 400);
    // In a pause it ends the program, too.
    let mut program = begins(&folder, &board);
    waits(&folder, &board, &mut program);
    let probes = drives(&folder, LONG_PROBE, &board.port);
    while at_or(&folder, &board, &[0, 0, rest + 400])[2] == rest + 400 {}
    refused(&command(&folder, &board, "probe z -1 --feed 60"), "is not done yet");
    signal(&probes, "-INT");
    let ended = probes.wait_with_output().unwrap();
    assert_eq!(ended.status.code(), Some(1));
    let said = String::from_utf8_lossy(&ended.stdout).into_owned();
    assert!(said.contains("the probe move was stopped, and the program ends"), "{said}");
    assert_eq!(document(program)["ended"], "stopped");
    passed(&command(&folder, &board, "jog z 1"));
}

#[test]
fn board_that_is_pulled_in_a_probe_move_is_named() {
    let folder = folder(PAUSES);
    let mut board = Board::new(&folder, "--fast");
    let mut child = drives(&folder, LONG_PROBE, &board.port);
    while at_or(&folder, &board, &[0; 3])[2] == 0 {
        assert_eq!(child.try_wait().unwrap(), None, "it has ended");
    }
    board.child.kill().unwrap();
    let failure = document(child);
    assert_eq!(failure["error"]["kind"], "run", "{failure}");
    // In a pause both commands end.
    let mut board = Board::new(&folder, "--fast");
    let mut program = begins(&folder, &board);
    waits(&folder, &board, &mut program);
    let probes = drives(&folder, LONG_PROBE, &board.port);
    while at_or(&folder, &board, &[0; 3])[2] == 0 {}
    board.child.kill().unwrap();
    assert_eq!(document(probes)["error"]["kind"], "run");
    assert_eq!(document(program)["error"]["kind"], "run");
}

#[test]
fn offsets_outlive_a_probe_that_is_killed() {
    let folder = folder("M2\n");
    let board = Board::new(&folder, "--fast --probe x=-80");
    passed(&command(&folder, &board, "probe x -9 --feed 60 --set G54"));
    passed(&command(&folder, &board, "probe x 9 --feed 60 --away"));
    let kept = told(&folder, &board, "offset");
    let mut child = drives(&folder, LONG_PROBE, &board.port);
    moving(&folder, &mut child, &board.port);
    child.kill().unwrap();
    child.wait().unwrap();
    passed(&command(&folder, &board, "stop --clear"));
    assert_eq!(told(&folder, &board, "offset")["offsets"], kept["offsets"]);
    passed(&command(&folder, &board, "probe x -9 --feed 600"));
}
