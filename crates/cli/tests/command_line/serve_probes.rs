//! Probe moves of senders: what is reported, where the machine rests, and what locks it.

use crate::command::Folder;
use crate::probes::folder;
use crate::sender::{Sender, Served, is_answer, place};
use crate::stops::stop;
use crate::virtual_boards::Board;

/// A plate below z, at -2 mm.
const PLATE: &str = "--fast --probe z=-800";
const PLATE_MM: f64 = -2.0;

/// Longest way from the plate to the place that is reported, and to that where the tool rests, mm:
/// at 100 mm/min the level is accepted some milliseconds later.
const LATE: f64 = 0.02;

fn begins(options: &str) -> (Board, Served, Sender) {
    let (_, board, served, sender) = begins_in(folder(""), options);
    (board, served, sender)
}

fn begins_in(folder: Folder, options: &str) -> (Folder, Board, Served, Sender) {
    let board = Board::new(&folder, options);
    let (served, sender) = serves(&folder, &board);
    (folder, board, served, sender)
}

/// Serves a board that runs already.
fn serves(folder: &Folder, board: &Board) -> (Served, Sender) {
    let served = Served::with(folder, &format!("--port {}", board.port));
    let sender = Sender::tcp(&served);
    (served, sender)
}

/// Begins a slow probe move, and waits until it moves.
fn begins_to_probe(sender: &mut Sender) {
    sender.simple("G21 G91");
    sender.send("G38.2 Z-5 F50\n");
    while place(&sender.report())[2] > -0.1 {}
}

/// A probe move behind another one that was ended finds the plate.
#[track_caller]
fn probes_again(sender: &mut Sender) {
    let above = sender.place()[2];
    assert!(above <= -0.1 && above > PLATE_MM, "{above}");
    sender.simple("G21 G91\nG0 Z0.1");
    assert!((sender.place()[2] - above - 0.1).abs() < 0.003);
    let (at, tripped) = probes(sender, "G38.2 Z-5 F100");
    assert!(tripped);
    is_at_the_plate(at[2]);
}

/// The place of a `[PRB:x,y,z:1]`, and whether the probe has tripped.
#[track_caller]
fn probed(line: &str) -> (Vec<f64>, bool) {
    let inner = line.strip_prefix("[PRB:").and_then(|line| line.strip_suffix(']'));
    let (at, tripped) = inner.and_then(|inner| inner.split_once(':')).expect(line);
    (at.split(',').map(|value| value.parse().unwrap()).collect(), tripped == "1")
}

/// Sends a probe move that ends without an alarm, and returns its report.
#[track_caller]
fn probes(sender: &mut Sender, line: &str) -> (Vec<f64>, bool) {
    let said = sender.ask(line);
    assert_eq!((said.len(), said[1].as_str()), (2, "ok"), "{said:?}");
    probed(&said[0])
}

#[track_caller]
fn is_at_the_plate(z: f64) {
    assert!((PLATE_MM - LATE..=PLATE_MM).contains(&z), "{z}");
}

/// What senders do to set the zero of a workpiece with a plate of 0.5 mm.
#[test]
fn zero_is_set_at_the_place_of_the_trip() {
    let (_board, _served, mut sender) = begins(PLATE);
    sender.simple("G21 G91\nG1 X1 F600");
    // At 10 mm/s, z needs 0.1 mm to come to rest. The report is the place of the trip.
    let (at, _) = probes(&mut sender, "G38.2 Z-5 F600");
    assert!((PLATE_MM - 0.05..=PLATE_MM).contains(&at[2]), "{at:?}");
    assert!(sender.place()[2] < at[2] - 0.09, "{:?} {at:?}", sender.place());
    sender.done("G0 Z1");
    let (at, tripped) = probes(&mut sender, "G38.2 Z-5 F100");
    assert!(tripped && at[..2] == [1.0, 0.0], "{at:?}");
    is_at_the_plate(at[2]);
    let rests = sender.place();
    is_at_the_plate(rests[2]);
    assert!(rests[2] <= at[2] && rests[0] == 1.0, "{rests:?}");
    // The report stays, and the parameters have the same place.
    let told = sender.ask("$#").into_iter().find(|line| line.starts_with("[PRB")).unwrap();
    assert_eq!(probed(&told), (at.clone(), true));
    sender.simple("G10 L20 P1 Z0.5\nG90\nG0 Z3.5");
    assert!((sender.place()[2] - (rests[2] + 3.0)).abs() < 0.003, "{:?}", sender.place());
    sender.done("G53 G0 Z#5063");
}

/// The lines behind a probe move begin where it has ended.
#[test]
fn lines_behind_it_wait_for_its_end() {
    let (_board, _served, mut sender) = begins(PLATE);
    sender.send("G21 G91\nG38.2 Z-5 F100\nG1 Z1 F600\nG38.2 Z-5 F50\nG1 Z2 X1 F600\n");
    let mut reports = Vec::new();
    for _ in 0..5 {
        while let Some(line) = sender.next().filter(|line| !is_answer(line)) {
            reports.push(probed(&line));
        }
    }
    assert_eq!(reports.len(), 2);
    reports.iter().for_each(|(at, tripped)| {
        assert!(tripped);
        is_at_the_plate(at[2]);
    });
    let place = sender.place();
    is_at_the_plate(place[2] - 2.0);
    assert_eq!(place[0], 1.0);
}

#[test]
fn probe_in_the_wrong_state_and_probe_that_is_missed_lock_the_machine() {
    let (_board, _served, mut sender) = begins(PLATE);
    sender.simple("G21 G91");
    // Not reached: without an alarm, and with one.
    assert_eq!(probes(&mut sender, "G38.3 Z-1 F300"), (vec![0.0, 0.0, -1.0], false));
    let said = sender.ask("G38.2 Z-0.5 F300");
    assert_eq!((said[0].as_str(), said.last().unwrap().as_str()), ("ALARM:5", "ok"), "{said:?}");
    assert_eq!(probed(&said[said.len() - 2]), (vec![0.0, 0.0, -1.5], false));
    assert_eq!(sender.ask("G0 X1"), ["error:9"]);
    sender.done("$X");
    assert_eq!(sender.place(), [0.0, 0.0, -1.5]);
    // It is open, and the move waits for that.
    let said = sender.ask("G38.4 Z-0.1 F300");
    assert_eq!((said[0].as_str(), said.last().unwrap().as_str()), ("ALARM:4", "ok"), "{said:?}");
    sender.done("$X");
    let (at, _) = probes(&mut sender, "G38.2 Z-5 F100");
    // It is closed.
    let said = sender.ask("G38.2 Z-1 F100");
    assert_eq!((said[0].as_str(), said.last().unwrap().as_str()), ("ALARM:4", "ok"), "{said:?}");
    sender.done("$X");
    is_at_the_plate(sender.place()[2]);
    // Away from it.
    let (left, tripped) = probes(&mut sender, "G38.4 Z5 F100");
    assert!(tripped && left[2] >= at[2] && left[2] < PLATE_MM + LATE, "{left:?}");
    sender.simple("G90\nG0 Z0");
    assert_eq!(sender.place(), [0.0; 3]);
}

/// A hold in a probe move rests; the rest of the move still ends at the plate.
#[test]
fn held_probe_move_still_trips_and_a_reset_ends_it() {
    let (_board, _served, mut sender) = begins(PLATE);
    sender.simple("G21 G91");
    sender.send("G38.2 Z-5 F50\n");
    while place(&sender.report())[2] > -0.1 {}
    sender.send("!");
    while !sender.report().starts_with("<Hold:0") {}
    let rests = place(&sender.report())[2];
    assert!(rests > PLATE_MM, "{rests}");
    sender.send("~");
    let (at, tripped) = probed(&sender.until(|line| line.starts_with("[PRB")));
    assert!(tripped);
    is_at_the_plate(at[2]);
    assert_eq!(sender.until(is_answer), "ok");
    sender.simple("G0 Z1");
    // A reset drops the move: nothing is reported, and the next one begins anew.
    let above = sender.place()[2];
    sender.send("G38.2 Z-5 F50\n");
    while place(&sender.report())[2] > above - 0.1 {}
    sender.send("\u{18}");
    sender.until(|line| line.starts_with("Grbl"));
    let rests = sender.place()[2];
    assert!(rests > PLATE_MM, "{rests}");
    assert!(sender.ask("$#").iter().any(|line| line.ends_with(":1]")));
    sender.simple("G21 G91");
    let (at, _) = probes(&mut sender, "G38.2 Z-5 F100");
    is_at_the_plate(at[2]);
    // A check of a program moves nothing, and probes nothing.
    sender.done("$C");
    sender.done("G38.2 Z-1 F100");
    is_at_the_plate(place(&sender.report())[2]);
}

/// Ctrl-C brings a probe move to rest above the plate. The place is kept, and the probe ends nothing
/// any more.
#[test]
fn interrupted_probe_move_rests_and_the_next_command_probes() {
    let (folder, board, served, mut sender) = begins_in(folder(""), PLATE);
    begins_to_probe(&mut sender);
    let (status, said) = served.interrupt();
    assert!(status == 0 && said.contains("the positions are valid"), "{said}");
    let (served, mut sender) = serves(&folder, &board);
    probes_again(&mut sender);
    assert_eq!(served.interrupt().0, 0);
}

#[test]
fn stopped_probe_move_ramps_down_and_the_next_command_probes() {
    let (folder, board, served, mut sender) = begins_in(folder(""), PLATE);
    begins_to_probe(&mut sender);
    let ran = stop(&folder, &board.port, "");
    assert!(ran.stdout.contains("`carrystep serve` (process"), "{}{}", ran.stdout, ran.stderr);
    sender.until(|line| line == "ALARM:3");
    assert_eq!(served.end().0, 0);
    let (served, mut sender) = serves(&folder, &board);
    probes_again(&mut sender);
    assert_eq!(served.interrupt().0, 0);
}

/// The e-stop freezes a probe move. The command goes on, and when the machine is unlocked, the next
/// move probes.
#[test]
fn e_stop_in_a_probe_move_is_an_alarm_and_the_next_move_probes() {
    let (_folder, mut board, served, mut sender) = begins_in(folder(""), PLATE);
    begins_to_probe(&mut sender);
    board.press("estop 1");
    sender.until(|line| line == "ALARM:3");
    assert!(sender.next().unwrap().contains("e-stop"));
    assert_eq!(sender.ask("$X").last().unwrap(), "error:8");
    board.press("estop 0");
    while sender.ask("$X").last().unwrap() != "ok" {}
    probes_again(&mut sender);
    assert_eq!(served.interrupt().0, 0);
}
