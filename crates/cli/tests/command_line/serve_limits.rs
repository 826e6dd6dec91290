//! Lines of a sender toward a limit switch that is closed already: nothing moves, and the machine is
//! locked.

use crate::command::Folder;
use crate::run_programs::MACHINE;
use crate::sender::{Sender, Served};
use crate::virtual_boards::Board;

/// What a line is told that would move x further into its switch.
const BACK: &str = "the limit switch of axis x is closed, and the line would move it further back: \
                    unlock, and move it forward";

/// A switch of x at -2.5 mm, on a machine with inputs of this kind.
fn begins(limits: &str) -> (Board, Served, Sender) {
    let folder = Folder::new();
    let wired = format!("debounce_us = 100\nlimits = \"{limits}\"\n");
    folder.write("machine.toml", MACHINE.replace("debounce_us = 100\n", &wired));
    let board = Board::new(&folder, "--fast --min x=-200");
    let served = Served::with(&folder, &format!("--port {}", board.port));
    let mut sender = Sender::tcp(&served);
    sender.simple("G21 G91");
    (board, served, sender)
}

/// Drives x into its switch, and unlocks the machine. Returns the place of x.
fn meets(sender: &mut Sender) -> f64 {
    sender.send("G0 X-8\n");
    sender.until(|line| line == "ALARM:1");
    sender.done("$X");
    let at = sender.place()[0];
    assert!(at < -2.5, "{at}");
    at
}

/// Waits for the alarm of a refused line, and unlocks the machine.
#[track_caller]
fn is_refused(sender: &mut Sender, says: &str) {
    sender.until(|line| line == "ALARM:1");
    let said = sender.next().unwrap();
    assert!(said.contains(says), "{said}");
    assert_eq!(sender.ask("G0 X1"), ["error:9"]);
    sender.done("$X");
}

#[test]
fn line_toward_a_closed_switch_moves_nothing_and_one_away_does() {
    for limits in ["pair", "each"] {
        let (_board, served, mut sender) = begins(limits);
        let at = meets(&mut sender);
        for line in ["G0 X-1", "$J=G91 X-0.5 F300", "G1 Y-1 X-1 F600", "G2 X0 Y2 J1 F600"] {
            sender.send(format!("{line}\n"));
            is_refused(&mut sender, BACK);
            let place = sender.place();
            assert_eq!(place, [at, 0.0, 0.0], "{limits}: {line}");
        }
        // What comes before such a line is done.
        sender.send("G0 Y1\nG0 X-1\n");
        is_refused(&mut sender, "axis x");
        assert_eq!(sender.place(), [at, 1.0, 0.0], "{limits}");
        sender.simple("G1 X0.1 Y-1 F600");
        sender.place();
        sender.simple("G1 X-0.1");
        is_refused(&mut sender, "axis x");
        // Away, and then back: the switch opens, and stops the machine when it closes again.
        sender.done("$J=G91 X0.1 F300");
        sender.place();
        sender.done("G0 X8");
        let away = sender.place();
        sender.simple("G0 X-1\nG0 X1");
        assert_eq!(sender.place(), away);
        assert!(meets(&mut sender) < -2.5);
        assert_eq!(served.interrupt().0, 0);
    }
}
