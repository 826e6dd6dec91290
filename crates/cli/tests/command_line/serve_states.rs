//! What each state of `carrystep serve` allows: alarms, homing, checks, queries, and what is
//! refused.

use crate::command::Folder;
use crate::run_programs::{HOME, MACHINE};
use crate::sender::{Sender, Served};
use crate::serve_streams::folder;
use crate::virtual_boards::Board;

#[test]
fn queries_show_the_machine() {
    let folder = folder();
    let served = Served::new(&folder, "");
    let mut sender = Sender::pty(&served);
    let settings = sender.ask("$$");
    for line in ["$100=80.000", "$110=3000.000", "$122=500.000", "$130=29.000", "$20=0", "$22=0"] {
        assert!(settings.iter().any(|known| known == line), "{line} in {settings:?}");
    }
    let modes = sender.ask("$G");
    assert_eq!(modes[0], "[GC:G0 G54 G17 G21 G90 G94 M5 M9 T0 F0 S0]");
    sender.simple("G10 L2 P2 X1 Y2\nG55\nG1 F500");
    let modes = sender.ask("$G");
    assert_eq!(modes[0], "[GC:G1 G55 G17 G21 G90 G94 M5 M9 T0 F500 S0]");
    let parameters = sender.ask("$#");
    assert_eq!(parameters[1], "[G55:1.000,2.000,0.000]", "{parameters:?}");
    let reports: Vec<String> = (0..12).map(|_| sender.report()).collect();
    assert!(reports.iter().any(|report| report.contains("|WCO:1.000,2.000,0.000")), "{reports:?}");
    assert!(sender.ask("$I")[1].starts_with("[OPT:VNM,1024,1024]"));
    assert!(sender.ask("$110=1")[0].starts_with("[MSG:$110 is given by speed"));
    // Offsets are kept over a reset.
    sender.send("\u{18}");
    sender.until(|line| line.starts_with("Grbl"));
    assert!(sender.ask("$#").contains(&"[G55:1.000,2.000,0.000]".to_owned()));
    assert!(sender.ask("$RST=#")[0].contains("Restoring defaults"));
    sender.until(|line| line.starts_with("Grbl"));
    assert_eq!(sender.ask("$#")[1], "[G55:0.000,0.000,0.000]");
}

#[test]
fn mistakes_have_the_numbers_of_grbl_and_change_nothing() {
    let folder = folder();
    let served = Served::new(&folder, "");
    let mut sender = Sender::tcp(&served);
    for (line, code) in [
        ("G1 X1", 22),
        ("X", 2),
        ("G999", 20),
        ("G0 G1 X1", 21),
        ("G0 X1 X2", 25),
        ("G0 X1 Q5", 36),
        ("G2 X1 Y1 R0.1 F100", 34),
        ("o100 sub", 20),
        ("G38.2 Z-1 F10", 20),
        ("M66 P0", 20),
        ("hello", 2),
        ("5X1", 1),
        ("$Z", 3),
        ("$N0=G21", 3),
        ("$I=mine", 3),
    ] {
        let said = sender.ask(line);
        assert_eq!(said.last().unwrap(), &format!("error:{code}"), "{line}: {said:?}");
    }
    let long = format!("G0 X{}1", "0".repeat(300));
    assert_eq!(sender.ask(&long), ["error:11"]);
    assert_eq!(sender.ask("%"), ["ok"]);
    assert_eq!(sender.ask("(only a comment)"), ["ok"]);
    // Nothing has moved or changed.
    assert_eq!(sender.place(), [0.0; 3]);
    assert_eq!(sender.ask("$G")[0], "[GC:G0 G54 G17 G21 G90 G94 M5 M9 T0 F0 S0]");
    // 10 MB without a newline.
    let piece = vec![b'X'; 1 << 20];
    for _ in 0..10 {
        sender.send(&piece);
    }
    assert_eq!(sender.ask(""), ["error:11"]);
    sender.done("G0 X1");
    assert_eq!(sender.place(), [1.0, 0.0, 0.0]);
}

/// Machine and board with a switch of x at -200 steps.
fn with_switch() -> (Folder, Board) {
    let folder = Folder::new();
    let text = MACHINE.replace("travel = [-9, 20]\n", HOME);
    let text = text.replace("debounce_us = 100\n", "debounce_us = 100\nlimits = \"pair\"\n");
    folder.write("machine.toml", text);
    let board = Board::new(&folder, "--fast --min x=-200");
    (folder, board)
}

#[test]
fn machine_that_is_not_homed_is_locked_until_it_is() {
    let (folder, board) = with_switch();
    let served = Served::with(&folder, &format!("--port {}", board.port));
    let mut sender = Sender::pty(&served);
    assert_eq!(sender.next().as_deref(), Some("[MSG:'$H'|'$X' to unlock]"));
    assert_eq!(sender.ask("G0 X1"), ["error:9"]);
    assert_eq!(sender.ask("$J=X1 F100"), ["error:8"]);
    assert!(sender.report().starts_with("<Alarm|"));
    sender.done("$H");
    assert_eq!(sender.place(), [1.0, 0.0, 0.0]);
    assert!(sender.ask("$$").iter().any(|line| line == "$20=1"));
    // Behind homing, travel is a bound.
    sender.done("G0 X3");
    assert_eq!(sender.place(), [3.0, 0.0, 0.0]);
    assert_eq!(sender.ask("$J=X100 F1000"), ["error:15"]);
    sender.send("G1 X100 F1000\n");
    sender.until(|line| line == "ALARM:2");
    sender.until(|line| line.starts_with("[MSG:x would go to 100 mm, beyond its travel"));
    assert_eq!(sender.ask("G0 X1"), ["error:9"]);
    sender.done("$X");
    sender.done("G0 X4");
    assert_eq!(sender.place(), [4.0, 0.0, 0.0]);
    // Twice, and by one axis.
    sender.done("$HX");
    assert_eq!(sender.place(), [1.0, 0.0, 0.0]);
    assert!(sender.ask("$HY").last().unwrap().starts_with("error:5"));
    assert_eq!(served.interrupt().0, 0);
}

#[test]
fn unlock_takes_the_present_place_for_zero_and_a_limit_is_an_alarm() {
    let (folder, board) = with_switch();
    let served = Served::with(&folder, &format!("--port {}", board.port));
    let mut sender = Sender::tcp(&served);
    sender.done("$X");
    sender.done("G0 X1");
    assert_eq!(sender.place(), [1.0, 0.0, 0.0]);
    sender.send("G0 X-8\n");
    sender.until(|line| line == "ALARM:1");
    let said = sender.next().unwrap();
    assert!(said.contains("limit from x"), "{said}");
    sender.done("$X");
    sender.done("$J=G91 X4 F600");
    let at = sender.place();
    // The switch is at -2.5, and the axis has ramped down behind it.
    assert!(at[0] > -2.0 && at[0] < 1.5, "{at:?}");
    assert_eq!(served.interrupt().0, 0);
}

#[test]
fn check_mode_moves_nothing() {
    let folder = folder();
    let served = Served::new(&folder, "");
    let mut sender = Sender::tcp(&served);
    assert_eq!(sender.ask("$C"), ["[MSG:Enabled]", "ok"]);
    sender.simple("G91 G0 X5\nG1 Y3 F100");
    assert_eq!(sender.ask("G1 X1 X2").last().unwrap(), "error:25");
    assert!(sender.report().starts_with("<Check|MPos:0.000,0.000,0.000|"));
    assert_eq!(sender.ask("$C"), ["[MSG:Disabled]", "ok"]);
    sender.until(|line| line.starts_with("Grbl 1.1"));
    assert_eq!(sender.place(), [0.0; 3]);
    sender.done("G0 X1");
    assert_eq!(sender.place(), [1.0, 0.0, 0.0]);
}

#[test]
fn pause_and_end_of_a_program() {
    let folder = folder();
    let served = Served::new(&folder, "");
    let mut sender = Sender::tcp(&served);
    sender.simple("G21 G91\nG0 X1\nM0\nG0 X1\nM2");
    let rests = sender.state("Hold:0");
    assert!(rests.contains("MPos:1.000,"), "{rests}");
    sender.send("~");
    sender.until(|line| line == "[MSG:Pgm End]");
    assert_eq!(sender.place(), [2.0, 0.0, 0.0]);
    // M2 has brought back the modes of the beginning.
    assert!(sender.ask("$G")[0].contains(" G90 "));
    // In the wrong order, and twice.
    sender.send("~~\u{85}!");
    sender.state("Hold:0");
    sender.send("!~");
    sender.state("Idle");
    assert_eq!(sender.ask("$SLP"), ["[MSG:Sleeping]", "ok"]);
    assert_eq!(sender.ask("G0 X1"), ["error:9"]);
    sender.send("\u{18}");
    sender.until(|line| line.starts_with("Grbl 1.1"));
    sender.state("Alarm");
    sender.done("$X");
    sender.done("G0 X1");
    assert_eq!(sender.place(), [1.0, 0.0, 0.0]);
}
