//! `carrystep probe` and `jog --set` on virtual boards: what becomes of a touched place, by itself and
//! while a program waits, and what is refused.

use crate::command::{Folder, Ran};
use crate::probes::folder;
use crate::run_programs::{
    HOME, LONG, PAUSES, begins, done, positions, resume, run, status, waits,
};
use crate::schemas;
use crate::stops::{drives, moving, signal};
use crate::virtual_boards::{Board, document, passed};
use serde_json::{Value, json};

/// A move that takes hours, on which a test does something else.
const LONG_PROBE: &str = "probe z -90000 --feed 600 --machine machine.toml";

fn command(folder: &Folder, board: &Board, line: &str) -> Ran {
    folder.run(&format!("{line} --machine machine.toml --port {}", board.port))
}

/// The document of a command that has passed.
#[track_caller]
fn told(folder: &Folder, board: &Board, line: &str) -> Value {
    let ran = command(folder, board, &format!("{line} --json"));
    passed(&ran);
    schemas::check(&ran.stdout)
}

fn at(folder: &Folder, board: &Board) -> Vec<i64> {
    positions(&status(folder, board))
}

/// The same; `before` as long as the command that drives the board does not answer.
fn at_or(folder: &Folder, board: &Board, before: &[i64]) -> Vec<i64> {
    let found = status(folder, board);
    if found["axes"].is_array() { positions(&found) } else { before.to_vec() }
}

#[track_caller]
fn refused(ran: &Ran, why: &str) {
    let said = ran.stderr.replace("\n  ", " ");
    assert!(ran.status == 2 && said.contains(why), "{}: {said}", ran.status);
}

/// z of a document, mm.
fn z(value: &Value) -> f64 {
    value["z"].as_f64().unwrap_or_else(|| panic!("{value}"))
}

/// The offset of z of the first system that is set.
fn offset(document: &Value) -> f64 {
    z(&document["offsets"][0]["values"])
}

/// Waits until a program waits for something else.
fn waits_again(
    folder: &Folder,
    board: &Board,
    child: &mut std::process::Child,
    before: &str,
) -> String {
    loop {
        let now = waits(folder, board, child);
        if now != before {
            return now;
        }
    }
}

#[test]
fn touched_place_less_the_plate_becomes_zero() {
    let folder = folder("G21 G90 F600\nG1 Z0\nM2\n");
    let board = Board::new(&folder, "--fast --probe z=-800");
    let mut before = Vec::new();
    // Twice: the second touch begins where the first one has gone back to.
    for _ in 0..2 {
        let found =
            told(&folder, &board, "probe z -20 --feed 60 --set G54 --plate 1.5 --retract 1");
        let touched = z(&found["touched"]);
        // 1 mm/s, and the level is accepted within some milliseconds.
        assert!((-2.005..=-1.99875).contains(&touched), "{touched}");
        assert!((offset(&found) - (touched - 1.5)).abs() < 1e-9, "{found}");
        assert!((z(&found["place"]) - (touched + 1.0)).abs() <= 0.00125, "{found}");
        assert_eq!(found["offsets"][0]["name"], "G54");
        before.push(touched);
    }
    assert!((before[0] - before[1]).abs() < 0.002, "{before:?}");
    passed(&run(&folder, &board, ""));
    let zero = ((before[1] - 1.5) * 400.0).round() as i64;
    assert_eq!(at(&folder, &board), [0, 0, zero]);
    // Up from below, the tool is below the plate and the work above it.
    passed(&command(&folder, &board, "offset --clear"));
    let found = told(&folder, &board, "probe z 20 --feed 60 --away --set G55 --plate 0.25");
    let opened = z(&found["touched"]);
    assert!((-2.001..=-1.99).contains(&opened), "{opened}");
    assert!((offset(&found) - (opened - 0.25)).abs() < 1e-9, "{found}");
}

#[test]
fn touch_from_below_has_the_plate_on_the_other_side() {
    let folder = folder("M2\n");
    let mut board = Board::new(&folder, "--fast");
    let line = "probe x 20000 --feed 600 --set G54 --plate 1.5 --machine machine.toml";
    let mut child = drives(&folder, line, &board.port);
    moving(&folder, &mut child, &board.port);
    board.press("probe 1");
    let found = done(child);
    let touched = found["touched"]["x"].as_f64().unwrap();
    let offset = found["offsets"][0]["values"]["x"].as_f64().unwrap();
    assert!((offset - (touched + 1.5)).abs() < 1e-9, "{found}");
}

#[test]
fn length_of_the_tool_gives_the_touched_place_its_coordinate() {
    let folder = folder("G21 G90 F600\nG1 Z1\nM2\n");
    let board = Board::new(&folder, "--fast --probe z=-800");
    passed(&command(&folder, &board, "offset --set G55 z=-3"));
    let found = told(&folder, &board, "probe z -20 --feed 60 --tool G55 --plate 0.5 --retract 9");
    // G55 stays as it is: its zero is at machine 3, and the tool is that much shorter.
    let names = [&found["offsets"][0]["name"], &found["offsets"][1]["name"]];
    assert_eq!(names, ["G55", "tool length"]);
    assert_eq!(offset(&found), 3.0);
    let length = z(&found["offsets"][1]["values"]);
    assert!((length - (z(&found["touched"]) - 3.0 - 0.5)).abs() < 1e-9, "{found}");
    // It does not go back beyond its beginning.
    assert_eq!(at(&folder, &board), [0, 0, 0]);
}

#[test]
fn program_goes_on_with_what_was_touched_off_in_its_pause() {
    let folder = folder(PAUSES);
    let board = Board::new(&folder, "--fast --probe z=-800");
    let mut child = begins(&folder, &board);
    let first = waits(&folder, &board, &mut child);
    passed(&resume(&folder, &board));
    let second = waits_again(&folder, &board, &mut child, &first);
    assert_eq!(second, "tool change in line 5 (M6)");
    let line = "probe z -20 --feed 60 --set G54 --plate 1.5 --retract 1";
    let found = told(&folder, &board, line);
    assert_eq!(found["waits"], second);
    let touched = z(&found["touched"]);
    assert!((-2.005..=-1.99875).contains(&touched), "{touched}");
    assert!((offset(&found) - (touched - 1.5)).abs() < 1e-9, "{found}");
    assert!((z(&found["place"]) - (touched + 1.0)).abs() <= 0.00125, "{found}");
    // Once more, and by hand behind it.
    let found = told(&folder, &board, line);
    let touched = z(&found["touched"]);
    let found = told(&folder, &board, "jog --axis x=1,y=-1 --feed 600 --set G54 x=4 y=3");
    assert_eq!(found["offsets"][0]["values"]["x"], 1.0);
    assert_eq!(found["offsets"][0]["values"]["y"], -1.0);
    passed(&resume(&folder, &board));
    done(child);
    // Behind the tool change, z alone moves, to -1 of G54.
    let end = ((touched - 1.5 - 1.0) * 400.0).round() as i64;
    assert_eq!(at(&folder, &board), [400, 160, end]);
    // What was set is kept.
    let found = told(&folder, &board, "offset");
    assert!((offset(&found) - (touched - 1.5)).abs() < 1e-9, "{found}");
}

/// A folder whose x can be homed, and whose axes have switches at both ends.
fn with_switches(job: &str) -> Folder {
    let folder = folder(job);
    let machine = std::fs::read_to_string(folder.path("machine.toml")).unwrap();
    let machine = machine
        .replace("debounce_us = 100", "debounce_us = 100\nlimits = \"pair\"")
        .replace("travel = [-9, 20]\n", HOME);
    folder.write("machine.toml", machine);
    folder
}

#[test]
fn rest_of_a_program_is_checked_again_behind_a_touch() {
    let folder = with_switches("G21 G90 F1500\nG1 X4\nM6 T1\nG1 X6\nM2\n");
    let board = Board::new(&folder, "--fast --min x=-800 --probe x=-700");
    passed(&command(&folder, &board, "home"));
    let mut child = begins(&folder, &board);
    let first = waits(&folder, &board, &mut child);
    refused(&command(&folder, &board, "probe x -13.5 --feed 600"), "beyond its travel of -9 to 20");
    // x of the touch, 0.25, is called 90: so 6 is far below the travel.
    let touch = "probe x -9 --feed 600 --retract 2 --set G54 --plate";
    passed(&command(&folder, &board, &format!("{touch} 90")));
    passed(&resume(&folder, &board));
    let why = waits_again(&folder, &board, &mut child, &first);
    assert!(why.contains("cannot go on") && why.contains("x would go to -8"), "{why}");
    let found = told(&folder, &board, &format!("{touch} 1"));
    let touched = found["touched"]["x"].as_f64().unwrap();
    passed(&resume(&folder, &board));
    done(child);
    let now = status(&folder, &board)["axes"][0]["machine"].as_f64().unwrap();
    assert!((now - (touched - 1.0 + 6.0)).abs() <= 0.00625, "{now}");
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
    for meets in ["jog z -5", "probe z -5 --feed 600"] {
        let folder = with_switches("G21 G90 F1500\nG1 Z1\nM0\nG1 X2\nM2\n");
        // One input for both ends does not say which of them was met.
        let machine = std::fs::read_to_string(folder.path("machine.toml")).unwrap();
        folder.write("machine.toml", machine.replace("\"pair\"", "\"each\""));
        let board = Board::new(&folder, "--fast --min z=-200");
        let unhomed = format!("run job.ngc --unhomed {}", "--machine machine.toml");
        let mut child = drives(&folder, &unhomed, &board.port);
        waits(&folder, &board, &mut child);
        assert_eq!(command(&folder, &board, meets).status, 1, "{meets}");
        let ended = document(child);
        assert_eq!(ended["culprits"], json!([{"axis": "z", "direction": -1}]));
        passed(&command(&folder, &board, "stop --clear"));
        refused(&command(&folder, &board, "jog z -1"), "the limit switch of axis z is closed");
        passed(&command(&folder, &board, "jog z 2"));
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

#[test]
fn jog_sets_the_offset_where_it_ends() {
    let folder = folder("G21 G90 F600\nG1 X0 Y0 Z0\nM2\n");
    let board = Board::new(&folder, "--fast");
    let found = told(&folder, &board, "jog z -1 --set G54");
    assert_eq!(found["offsets"], json!([{"name": "G54", "values": {"z": -1.0}, "rotation": 0.0}]));
    let found = told(&folder, &board, "jog --axis x=2,y=1 --feed 600 --set G54 x=0.5,y");
    assert_eq!(found["offsets"][0]["values"], json!({"x": 1.5, "y": 1.0, "z": -1.0}));
    // Nothing moves.
    let found = told(&folder, &board, "jog --set G54 z=0.25");
    assert_eq!(found["offsets"][0]["values"]["z"], -1.25);
    assert_eq!(at(&folder, &board), [160, 80, -400]);
    // A jog that sets nothing leaves the offsets as they are.
    assert_eq!(told(&folder, &board, "jog z 1")["offsets"], Value::Null);
    passed(&run(&folder, &board, ""));
    assert_eq!(at(&folder, &board), [120, 80, -500]);
    for (line, why) in [
        ("jog", "required"),
        ("jog --set G54", "--set needs one system"),
        ("jog z 1 --set x=1", "--set needs one system"),
        ("jog z 1 --set G54 G55 x=1", "--set needs one system"),
        ("jog z 1 --set G53", "expected a system"),
        ("jog z 1 --set G54 a", "the machine has no axis a"),
        ("jog z 1 --set G54 z=2e9", "expected a system"),
    ] {
        refused(&command(&folder, &board, line), why);
    }
    assert_eq!(at(&folder, &board), [120, 80, -500]);
}

#[test]
fn feed_of_a_jog_is_its_greatest_speed() {
    let folder = folder("M2\n");
    let board = Board::new(&folder, "--fast --vcd a.vcd");
    // 25 mm/s on 5 mm with 1000 mm/s^2: 0.2 s, and 0.025 s for the ramps.
    let found = told(&folder, &board, "jog x 5 --feed 1500");
    let planned = found["planned_s"].as_f64().unwrap();
    assert!((planned - 0.225).abs() < 1e-4, "{planned}");
    board.end();
    let vcd = std::fs::read_to_string(folder.path("a.vcd")).unwrap();
    let code = vcd.lines().find_map(|line| {
        let words: Vec<&str> = line.split_whitespace().collect();
        matches!(words[..], ["$var", _, _, _, "step", ..]).then(|| words[3].to_owned())
    });
    let rising = format!("1{}", code.unwrap());
    let (mut now, mut times) = (0_u64, Vec::new());
    for line in vcd.lines() {
        match line.strip_prefix('#') {
            Some(time) => now = time.parse().unwrap(),
            None if line == rising => times.push(now),
            None => {}
        }
    }
    assert_eq!(times.len(), 400);
    let least = times.windows(2).map(|pair| pair[1] - pair[0]).min().unwrap();
    // 2000 steps/s: 500 us, and a phase of 0.125 us.
    assert!((499_870_000..500_500_000).contains(&least), "{least}");
}
