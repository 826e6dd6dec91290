//! `carrystep override` while a program runs on a virtual board.

use crate::command::{Folder, Ran};
use crate::run_programs::{LONG, MACHINE, begins, done, folder, hold, resume, status, waits};
use crate::stops::moving;
use crate::virtual_boards::{Board, passed};

fn set(folder: &Folder, board: &Board, options: &str) -> Ran {
    folder.run(&format!("override {options} --port {}", board.port))
}

/// The machine with a spindle whose speed an output sets.
fn spindle(machine: &str) -> String {
    machine.replace("spindle = 0\n", "spindle = 0\npwm_divider = 8\nspindle_rpm = 24_000\n")
}

#[test]
fn overrides_are_refused_by_name() {
    let folder = folder(LONG);
    let board = Board::new(&folder, "--fast");
    let none = set(&folder, &board, "--feed 50");
    assert_eq!(none.status, 2);
    assert!(none.stderr.contains("no program runs at"), "{}", none.stderr);
    for options in ["", "--feed 9", "--feed 201", "--rapid 101", "--spindle 5", "--feed x"] {
        assert_eq!(set(&folder, &board, options).status, 2, "{options}");
    }
    let far = set(&folder, &board, "--rapid 101");
    assert!(far.stderr.contains("10..=100"), "{}", far.stderr);
}

#[test]
fn program_runs_at_its_overrides_and_ends_where_it_should() {
    let folder = folder(LONG);
    let deep = "[machine]\nqueue_depth = 31\ncuts = true\n";
    folder.write("machine.toml", spindle(&MACHINE.replacen("[machine]\n", deep, 1)));
    let board = Board::new(&folder, "--vcd a.vcd --fast");
    let mut child = begins(&folder, &board);
    moving(&folder, &mut child, &board.port);
    for feed in [50, 150, 30] {
        let ran = set(&folder, &board, &format!("--feed {feed}"));
        passed(&ran);
        let told = format!("feed {feed} %, rapid 100 %, spindle 100 %");
        assert!(ran.stdout.contains(&told), "{}", ran.stdout);
    }
    assert_eq!(status(&folder, &board)["overrides"]["feed"], 30);
    let told = folder.run(&format!("status --port {}", board.port)).stdout;
    assert!(told.contains("overrides: feed 30 %, rapid 100 %, spindle 100 %"), "{told}");
    passed(&hold(&folder, &board));
    waits(&folder, &board, &mut child);
    // In a hold, too, and twice.
    passed(&set(&folder, &board, "--feed 60 --rapid 25"));
    passed(&set(&folder, &board, "--spindle 110"));
    passed(&resume(&folder, &board));
    let told = done(child);
    let last = &told["program"]["overrides"];
    assert_eq!((&last["feed"], &last["rapid"]), (&60.into(), &25.into()));
    assert_eq!(last["spindle"], 110);
    assert!(board.end().contains("\nx at 0\ny at 0\nz at 0\n"));
    passed(&folder.run("check a.vcd job.ngc --machine machine.toml --path-only"));
}
