//! Programs that probe and read inputs, on virtual boards: the place of the trip, what follows it,
//! and what is refused.

use crate::command::Folder;
use crate::run_programs::{HOME, MACHINE, begins, done, resume, run, status, waits};
use crate::stops::moving;
use crate::virtual_boards::{Board, passed};
use serde_json::Value;

/// A machine with a probe and three general inputs.
pub fn folder(job: &str) -> Folder {
    let folder = Folder::new();
    let inputs = "[machine.inputs]\nprobe = \"low\"\ngeneral = [\"high\", \"low\", \"high\"]\n\n";
    folder.write(
        "machine.toml",
        MACHINE.replacen("[[machine.axis]]", &format!("{inputs}[[machine.axis]]"), 1),
    );
    folder.write("job.ngc", job);
    folder
}

/// The positions of x, y and z at the end of a board.
fn positions(board: Board) -> [i32; 3] {
    let said = board.end();
    ["x", "y", "z"].map(|axis| {
        let at = said.lines().find_map(|line| line.strip_prefix(&format!("{axis} at ")));
        at.unwrap_or_else(|| panic!("{said}")).parse().unwrap()
    })
}

/// Probes, and goes 1 mm above the place of the trip and 1 mm to the side if it has tripped.
const PROBE: &str = "G21 G90 F1200\nG1 X2\nG10 L20 P1 Z0.5\nG38.2 Z-5 F100\n\
                     G1 Z[#5063 + 1] F300\no1 if [#5070 EQ 1]\nG1 X3\no1 endif\nM2\n";

/// A folder whose x can be homed, and whose axes have switches at both ends.
pub fn with_switches(job: &str) -> Folder {
    let folder = folder(job);
    let machine = std::fs::read_to_string(folder.path("machine.toml")).unwrap();
    let machine = machine
        .replace("debounce_us = 100", "debounce_us = 100\nlimits = \"pair\"")
        .replace("travel = [-9, 20]\n", HOME);
    folder.write("machine.toml", machine);
    folder
}

#[test]
fn program_goes_on_from_the_place_at_which_the_probe_trips() {
    for plate in [-400, -1077] {
        let folder = folder(PROBE);
        let board = Board::new(&folder, &format!("--fast --probe z={plate}"));
        let ran = run(&folder, &board, "");
        passed(&ran);
        assert!(
            ran.stderr.contains("line 4: the probe has tripped at machine x 2"),
            "{}",
            ran.stderr
        );
        let [x, y, z] = positions(board);
        assert_eq!((x, y), (240, 0));
        // 1.7 mm/s, and the level is accepted after some tenths of a millisecond.
        assert!((plate + 400 - 2..=plate + 400).contains(&z), "{z}");
    }
}

#[test]
fn place_of_the_trip_is_that_of_the_hit_and_not_that_of_the_rest() {
    // Behind the hit, x moves on by v^2 / 2a = 64 steps, until it rests.
    let folder = folder("G21 G90 F2400\nG38.2 X-8\nM0\nG1 X#5061\nM2\n");
    let board = Board::new(&folder, "--fast --probe x=-300");
    let mut child = begins(&folder, &board);
    assert_eq!(waits(&folder, &board, &mut child), "pause in line 3 (M0, M1 or M60)");
    let rests = status(&folder, &board)["axes"][0]["position"].as_i64().unwrap();
    assert!((-380..-330).contains(&rests), "{rests}");
    passed(&resume(&folder, &board));
    done(child);
    // 3.2 steps a millisecond. With a watchdog of 4 s, a switch is sampled every 1.024 ms, and its
    // level is accepted with the second sample. The plate itself is pressed up to 0.1 ms late.
    let [x, ..] = positions(board);
    assert!((-308..=-303).contains(&x), "{x}");
}

#[test]
fn probe_move_that_was_held_still_trips() {
    let folder = folder("G21 G90 F30\nG38.2 X-8\nG1 X[#5061 + 1] F300\nM2\n");
    let board = Board::new(&folder, "--fast --probe x=-300");
    let mut child = begins(&folder, &board);
    moving(&folder, &mut child, &board.port);
    passed(&folder.run(&format!("hold --port {}", board.port)));
    let held = waits(&folder, &board, &mut child);
    assert_eq!(held, "hold in line 2");
    passed(&resume(&folder, &board));
    done(child);
    let [x, ..] = positions(board);
    assert!((-222..=-220).contains(&x), "{x}");
}

#[test]
fn probe_that_never_trips_is_an_error_or_a_zero() {
    let missed = folder(PROBE);
    let board = Board::new(&missed, "--fast");
    let ran = run(&missed, &board, "");
    assert_eq!(ran.status, 1, "{}", ran.stderr);
    assert!(ran.stderr.contains("line 4: the probe has not closed"), "{}", ran.stderr);
    assert_eq!(positions(board), [160, 0, -2200]);
    // The program goes on, and knows it.
    let goes_on = folder(&PROBE.replace("G38.2", "G38.3"));
    let board = Board::new(&goes_on, "--fast");
    passed(&run(&goes_on, &board, ""));
    assert_eq!(positions(board), [160, 0, -1800]);
}

#[test]
fn probe_that_has_the_wanted_state_at_the_start_moves_nothing() {
    let first = folder("G21 F100\nG38.2 Z-5\nM2\n");
    let mut board = Board::new(&first, "--fast --probe z=-100");
    board.press("probe 1");
    let closed = "line 2: the probe is closed before the move begins";
    let ran = run(&first, &board, "");
    assert_eq!(ran.status, 2, "{}", ran.stderr);
    assert!(ran.stderr.contains(closed), "{}", ran.stderr);
    board.press("probe 0");
    first.write("job.ngc", "G21 F100\nG38.4 Z-5\nM2\n");
    let ran = run(&first, &board, "");
    assert_eq!(ran.status, 2, "{}", ran.stderr);
    assert!(ran.stderr.contains("line 2: the probe is open before"), "{}", ran.stderr);
    assert_eq!(positions(board), [0, 0, 0]);
    // Behind a move, the machine rests where it is.
    let later = folder("G21 F100\nG1 X1\nG38.2 Z-5\nM2\n");
    let board = Board::new(&later, "--fast --probe x=100");
    let ran = run(&later, &board, "");
    assert_eq!(ran.status, 1, "{}", ran.stderr);
    assert!(ran.stderr.contains("line 3: the probe is closed before"), "{}", ran.stderr);
    assert_eq!(positions(board), [80, 0, 0]);
}

#[test]
fn probe_moves_off_the_plate_and_touches_it_again() {
    let job = "G21 F100\nG38.2 Z-5\nG38.4 Z2\nG38.2 Z-5 F30\nG1 Z[#5063]\nM2\n";
    let folder = folder(job);
    let board = Board::new(&folder, "--fast --probe z=-150");
    let ran = run(&folder, &board, "");
    passed(&ran);
    assert_eq!(ran.stderr.matches("the probe has tripped").count(), 3, "{}", ran.stderr);
    let [_, _, z] = positions(board);
    assert!((-151..=-150).contains(&z), "{z}");
}

#[test]
fn rest_that_a_probe_changes_stays_within_travel() {
    // The plan assumes that the probe trips, and then nothing is beyond the travel of x.
    let job = "G21 F1200\nG38.3 Z-2 F300\no1 if [#5070 EQ 0]\nG1 X21\no1 endif\nG1 X1\nM2\n";
    let folder = with_switches(job);
    let board = Board::new(&folder, "--fast --min x=-400");
    passed(&folder.run(&format!("home --machine machine.toml --port {}", board.port)));
    let ran = run(&folder, &board, "");
    assert_eq!(ran.status, 1, "{}", ran.stderr);
    let why = "x would go to 21 mm, beyond its travel of -9 to 20 mm";
    assert!(ran.stderr.contains(why) && ran.stderr.contains("the machine rests"), "{}", ran.stderr);
    // x is where homing has left it, 1 mm from its switch.
    assert_eq!(positions(board), [-320, 0, -800]);
}

#[test]
fn input_that_a_program_waits_for_lets_it_go_on() {
    let job = "G21 G90 F1200\nM66 P0 L3 Q60\nG1 X1\nM66 P1 L4 Q60\nG1 Y[#5399 + 1]\n\
               M66 P2 L1 Q0.05\nG1 Z#5399\nM66 P0 L0\nG1 X[1 + #5399]\nM2\n";
    let folder = folder(job);
    let mut board = Board::new(&folder, "--fast");
    board.press("input 1 1");
    let mut child = begins(&folder, &board);
    assert_eq!(waits(&folder, &board, &mut child), "input in line 2 (M66)");
    let told = folder.run(&format!("status --port {}", board.port)).stdout;
    let wanted = "it waits: input in line 2 (M66); its input lets it go on";
    assert!(told.contains(wanted), "{told}");
    // Nobody but the input lets it go on.
    assert_eq!(resume(&folder, &board).status, 2);
    board.press("input 0 1");
    while waits(&folder, &board, &mut child) != "input in line 4 (M66)" {}
    board.press("input 1 0");
    let told: Value = done(child);
    assert_eq!((&told["ended"], &told["program"]["waits"]), (&"done".into(), &0.into()));
    assert_eq!(positions(board), [160, 80, -400]);
}

#[test]
fn program_that_reads_what_the_machine_lacks_is_refused() {
    let folder = folder("G21 F1200\nG1 X1\nM66 P3 L0\nM2\n");
    let board = Board::new(&folder, "--fast");
    let ran = run(&folder, &board, "");
    assert_eq!(ran.status, 2);
    assert!(ran.stderr.contains("line 3: M66 P3 reads general input 3"), "{}", ran.stderr);
    folder.write("job.ngc", "G21 F1200\nG1 X1\nM66 E1 L0\nM2\n");
    let ran = run(&folder, &board, "");
    assert_eq!(ran.status, 2);
    assert!(ran.stderr.contains("line 3: M66 E1 reads an analog input"), "{}", ran.stderr);
    assert_eq!(positions(board), [0, 0, 0]);
}
