//! `carrystep probe` and `jog --set` on virtual boards: what becomes of a touched place, by itself
//! and while a program waits.

use crate::command::{Folder, Ran};
use crate::probes::{folder, with_switches};
use crate::run_programs::{PAUSES, begins, done, positions, resume, run, status, waits};
use crate::schemas;
use crate::stops::{drives, moving};
use crate::virtual_boards::{Board, passed};
use serde_json::{Value, json};

pub fn command(folder: &Folder, board: &Board, line: &str) -> Ran {
    folder.run(&format!("{line} --machine machine.toml --port {}", board.port))
}

/// The document of a command that has passed.
#[track_caller]
pub fn told(folder: &Folder, board: &Board, line: &str) -> Value {
    let ran = command(folder, board, &format!("{line} --json"));
    passed(&ran);
    schemas::check(&ran.stdout)
}

pub fn at(folder: &Folder, board: &Board) -> Vec<i64> {
    positions(&status(folder, board))
}

#[track_caller]
pub fn refused(ran: &Ran, why: &str) {
    let said = ran.stderr.replace("\n  ", " ");
    assert!(ran.status == 2 && said.contains(why), "{}: {said}", ran.status);
}

/// z of a document, mm.
pub fn z(value: &Value) -> f64 {
    value["z"].as_f64().unwrap_or_else(|| panic!("{value}"))
}

/// The offset of z of the first system that is set.
fn offset(document: &Value) -> f64 {
    z(&document["offsets"][0]["values"])
}

/// Waits until a program waits for something else.
pub fn waits_again(
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
