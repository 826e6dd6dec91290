//! Work offsets that are kept of a board: how they are set, what begins with them, and when they are
//! refused.

use crate::command::{Folder, Ran};
use crate::run_programs::{begins, folder, positions, run, status, waits};
use crate::schemas;
use crate::virtual_boards::{Board, passed};
use serde_json::Value;
use std::path::PathBuf;

/// Goes to X1 Y2 of the coordinate system in force.
const GO: &str = "G21 G90 F1500\nG1 X1 Y2\nM2\n";

fn offset(folder: &Folder, board: &Board, options: &str) -> Ran {
    folder.run(format!("offset --machine machine.toml --port {} {options}", board.port).trim_end())
}

fn at(folder: &Folder, board: &Board) -> Vec<i64> {
    positions(&status(folder, board))
}

/// The one state file of the folder.
fn file(folder: &Folder) -> PathBuf {
    let mut files: Vec<PathBuf> =
        std::fs::read_dir(folder.state()).unwrap().map(|entry| entry.unwrap().path()).collect();
    assert_eq!(files.len(), 1, "{files:?}");
    files.pop().unwrap()
}

#[test]
fn program_begins_with_the_offsets_that_were_set() {
    let folder = folder(GO);
    let board = Board::new(&folder, "--fast --vcd a.vcd");
    assert!(offset(&folder, &board, "").stdout.ends_with(": no work offsets\n"));
    // The place of the machine, zero, gets these coordinates.
    let ran = offset(&folder, &board, "--set G54 x=-3,y=-1.5");
    passed(&ran);
    assert!(ran.stdout.ends_with("\nG54 x 3 y 1.5\n"), "{}", ran.stdout);
    let ran = run(&folder, &board, "");
    passed(&ran);
    assert!(ran.stderr.starts_with("work offsets: G54 x 3 y 1.5\n"), "{}", ran.stderr);
    assert_eq!(at(&folder, &board), [320, 280, 0]);
    let port = format!("--machine machine.toml --offsets-of {}", board.port);
    let ran = folder.run(&format!("simulate job.ngc {port} --json"));
    let told: Value = serde_json::from_str(&ran.stdout).unwrap();
    assert_eq!(told["positions"], serde_json::json!([320, 280, 0]));
    board.end();
    // Every pulse in its clock, as `simulate` has it with these offsets, and not without.
    passed(&folder.run(&format!("check a.vcd job.ngc {port}")));
    assert_eq!(folder.run("check a.vcd job.ngc --machine machine.toml").status, 1);
}

#[test]
fn offsets_of_a_program_are_kept_behind_it() {
    let folder = folder(
        "G21 G90 F1500\nG10 L2 P1 X2\nG10 L20 P2 Y5\nG43.1 Z0.5\nG92 Y1\nG1 X1\nM0\nG10 L2 P1 X7\nM2\n",
    );
    let board = Board::new(&folder, "--fast");
    // The last pause has nothing behind it that moves, so nobody waits there.
    passed(&run(&folder, &board, ""));
    let ran = offset(&folder, &board, "--json");
    passed(&ran);
    let told = schemas::check(&ran.stdout);
    let names: Vec<&str> = told["offsets"]
        .as_array()
        .unwrap()
        .iter()
        .map(|one| one["name"].as_str().unwrap())
        .collect();
    assert_eq!(names, ["G54", "G55", "G92", "tool length"]);
    assert_eq!(told["offsets"][0]["values"], serde_json::json!({"x": 7.0}));
    assert_eq!(at(&folder, &board), [240, 0, 0]);
    folder.write("job.ngc", "G21 G90 F1500\nG1 X0 Z0\nM2\n");
    passed(&run(&folder, &board, ""));
    assert_eq!(at(&folder, &board), [560, 0, 200]);
    // Without a zero there are no offsets, and those that are kept stay.
    folder.write("job.ngc", "G21 G90 F1500\nG10 L2 P1 X0\nG1 X1\nM2\n");
    passed(&run(&folder, &board, "--unhomed"));
    assert_eq!(at(&folder, &board), [640, 0, 200]);
    assert!(offset(&folder, &board, "").stdout.contains("\nG54 x 7\n"));
    passed(&offset(&folder, &board, "--clear"));
    assert!(offset(&folder, &board, "").stdout.ends_with(": no work offsets\n"));
}

#[test]
fn file_that_cannot_be_used_is_refused_and_stays() {
    let folder = folder(GO);
    let board = Board::new(&folder, "--fast");
    passed(&offset(&folder, &board, "--set G54 x=-3"));
    let path = file(&folder);
    let whole = std::fs::read_to_string(&path).unwrap();
    let other = whole.replacen("/dev/", "/dev/other/", 1);
    let build = whole.replacen("\"build\": \"", "\"build\": \"9", 1);
    let newer = whole.replacen("\"schema\": 3", "\"schema\": 4", 1);
    let far = whole.replacen("\"5221\": 3.0", "\"5221\": 3.0e99", 1);
    for (text, why) in [
        (&whole[..whole.len() / 2], "it is not whole"),
        ("", "it is not whole"),
        (&other, "it is that of the board at /dev/other/"),
        (&build, "it is that of a board of build 9"),
        (&newer, "its schema is 4"),
        (&far, "its work offsets are impossible"),
    ] {
        assert_ne!(text, whole);
        std::fs::write(&path, text).unwrap();
        let port = format!("--machine machine.toml --port {}", board.port);
        for command in [
            format!("run job.ngc {port}"),
            format!("jog x 1 {port}"),
            format!("offset {port} --clear"),
            format!("plan job.ngc --machine machine.toml --offsets-of {}", board.port),
        ] {
            let ran = folder.run(&command);
            assert_eq!(ran.status, 2, "{command}: {}", ran.stderr);
            let said = ran.stderr.replace("\n  ", " ");
            assert!(said.contains(why) && said.contains(".json"), "{command}: {said}");
        }
        passed(&folder.run(&format!("stop --port {} --machine machine.toml", board.port)));
        assert_eq!(std::fs::read_to_string(&path).unwrap(), text, "it was replaced");
    }
    assert_eq!(at(&folder, &board), [0, 0, 0]);
    std::fs::write(&path, &whole).unwrap();
    passed(&run(&folder, &board, ""));
    assert_eq!(at(&folder, &board), [320, 160, 0]);
}

#[test]
fn offsets_of_a_board_that_was_restarted_are_not_used() {
    let folder = folder(GO);
    let board = Board::new(&folder, "--fast");
    passed(&offset(&folder, &board, "--set G55 x=-3"));
    let path = file(&folder);
    let text = std::fs::read_to_string(&path).unwrap();
    let before = board.port.clone();
    board.end();
    // The board comes back at another terminal: its file goes with it.
    let board = Board::new(&folder, "--fast");
    let name = path.to_str().unwrap();
    let flat = |port: &str| port.replace('/', "_");
    let moved = name.replace(&format!("{}-", flat(&before)), &format!("{}-", flat(&board.port)));
    std::fs::remove_file(&path).unwrap();
    std::fs::write(&moved, text.replace(&format!("{before}\""), &format!("{}\"", board.port)))
        .unwrap();
    let ran = run(&folder, &board, "");
    assert_eq!(ran.status, 2);
    assert!(ran.stderr.contains("its work offsets are gone"), "{}", ran.stderr);
    // A jog does not make it forgotten.
    passed(&folder.run(&format!("jog x 1 --machine machine.toml --port {}", board.port)));
    assert_eq!(offset(&folder, &board, "").status, 2);
    let of = format!("plan job.ngc --machine machine.toml --offsets-of {}", board.port);
    assert_eq!(folder.run(&of).status, 2);
    passed(&offset(&folder, &board, "--clear"));
    passed(&run(&folder, &board, ""));
    passed(&folder.run(&of));
    assert_eq!(at(&folder, &board), [80, 160, 0]);
}

#[test]
fn offsets_outlive_a_run_that_is_killed() {
    let folder = folder("G21 G90 F1500\nG10 L2 P1 X4\nG1 X0\nM0\nG1 Y3\nM2\n");
    let board = Board::new(&folder, "--fast");
    passed(&offset(&folder, &board, "--set G55 z=-3"));
    let mut child = begins(&folder, &board);
    waits(&folder, &board, &mut child);
    child.kill().unwrap();
    child.wait().unwrap();
    let ran = offset(&folder, &board, "");
    passed(&ran);
    assert!(ran.stdout.ends_with("\nG54 x 4\nG55 z 3\n"), "{}", ran.stdout);
}

#[test]
fn wrong_offsets_are_refused() {
    let folder = folder(GO);
    let board = Board::new(&folder, "--fast");
    for (options, why) in [
        ("--set G54", "--set needs values"),
        ("--set G53 x=1", "expected G54 to G59"),
        ("--set G54 a=1", "the machine has no axis a"),
        ("--set G54 x=ten", "expected a letter"),
        ("x=1", "--set"),
        ("--set G54 x=1 --clear", "cannot be used with"),
    ] {
        let ran = offset(&folder, &board, options);
        assert_eq!(ran.status, 2, "{options}");
        assert!(ran.stderr.contains(why), "{options}: {}", ran.stderr);
    }
    let ran =
        folder.run(&format!("plan job.ngc --machine machine.toml --offsets-of {}", board.port));
    assert_eq!(ran.status, 2);
    assert!(ran.stderr.contains("nothing is known of a board at"), "{}", ran.stderr);
    let ran = folder.run("simulate machine.toml --offsets-of x");
    assert_eq!(ran.status, 2);
}
