//! Holds, resets, jogs and overrides of senders: the machine comes to rest on its path, and its
//! place stays exact.

use crate::sender::{Sender, Served, is_answer, place};
use crate::serve_streams::{edges, folder};
use crate::virtual_boards::Board;
use rand_xoshiro::SplitMix64;
use rand_xoshiro::rand_core::{Rng as _, SeedableRng as _};
use std::time::Duration;

/// A square of 4 mm whose corners are not rounded.
pub const SQUARE: &str = "G21 G90 G61 F1200\nG1 X4\nG1 Y4\nG1 X0\nG1 Y0";

/// Whether a place is on the square, within a step.
fn is_on_square(at: &[f64]) -> bool {
    let near = |value: f64, to: f64| (value - to).abs() < 0.026;
    let within = |value: f64| (-0.026..4.026).contains(&value);
    let sides = |a: f64, b: f64| (near(a, 0.0) || near(a, 4.0)) && within(b);
    (sides(at[0], at[1]) || sides(at[1], at[0])) && at[2] == 0.0
}

#[test]
fn hold_rests_on_the_path_and_resume_goes_on() {
    let folder = folder();
    let served = Served::new(&folder, "");
    let mut sender = Sender::pty(&served);
    let mut random = SplitMix64::seed_from_u64(7);
    for _ in 0..6 {
        sender.simple(SQUARE);
        std::thread::sleep(Duration::from_millis(u64::from(random.next_u32() % 600)));
        sender.send("!");
        let rests = sender.state("Hold:0");
        assert!(is_on_square(&place(&rests)), "{rests}");
        assert_eq!(place(&sender.report()), place(&rests));
        sender.send("~");
        assert_eq!(sender.place(), [0.0; 3]);
    }
    assert_eq!(served.interrupt().0, 0);
}

#[test]
fn reset_rests_on_the_path_and_drops_the_rest() {
    let folder = folder();
    let served = Served::new(&folder, "");
    let mut sender = Sender::tcp(&served);
    let mut random = SplitMix64::seed_from_u64(8);
    for number in 0..6 {
        sender.simple(SQUARE);
        std::thread::sleep(Duration::from_millis(u64::from(random.next_u32() % 600)));
        // Also behind a hold.
        sender.send(if number % 2 == 0 { "\u{18}" } else { "!\u{18}" });
        sender.until(|line| line.starts_with("Grbl 1.1"));
        let at = sender.place();
        assert!(is_on_square(&at), "{at:?}");
        // Programs go on from the place at which the machine rests.
        sender.simple("G91 G1 X0.5 F1000\nG90");
        let moved = sender.place();
        // Reports have three decimals.
        let off = (moved[0] - at[0] - 0.5).abs();
        assert!(off < 0.0011 && moved[1] == at[1], "{at:?} {moved:?}");
        sender.simple("G0 X0 Y0");
        assert_eq!(sender.place(), [0.0; 3]);
    }
}

#[test]
fn jog_is_cancelled_on_its_path_and_changes_no_mode() {
    let folder = folder();
    let served = Served::new(&folder, "");
    let mut sender = Sender::tcp(&served);
    sender.simple("G20 G91");
    sender.done("$J=G21 G90 X2 F1000");
    assert_eq!(sender.place(), [2.0, 0.0, 0.0]);
    for cancel in [&b"\x85"[..], b"!"] {
        sender.done("$J=G21 X15 F300");
        sender.state("Jog");
        while place(&sender.report())[0] < 2.1 {}
        assert_eq!(sender.ask("G0 X0"), ["error:9"]);
        sender.send(cancel);
        let at = sender.place();
        assert!(at[0] > 2.0 && at[0] < 17.0 && at[1] == 0.0, "{at:?}");
        sender.done("$J=G21 G90 G53 X2 F2000");
        assert_eq!(sender.place(), [2.0, 0.0, 0.0]);
    }
    assert!(sender.ask("$G")[0].contains(" G20 G91 "));
    for (jog, answer) in [
        ("$J=X1", "error:22"),
        ("$J=F100", "error:26"),
        ("$J=G1 X1 F100", "error:16"),
        ("$J=X1 F100 M3", "error:16"),
        ("$J=", "error:16"),
    ] {
        assert_eq!(sender.ask(jog), [answer], "{jog}");
    }
    assert_eq!(sender.place(), [2.0, 0.0, 0.0]);
    served.interrupt();
}

#[test]
fn overrides_are_shown_until_a_reset() {
    let folder = folder();
    let served = Served::new(&folder, "");
    let mut sender = Sender::tcp(&served);
    sender.send(b"\x91\x91\x94\x96\x9b");
    let mut reports: Vec<String> = Vec::new();
    while !reports.iter().any(|report| report.contains("|Ov:")) {
        reports.push(sender.report());
    }
    assert!(reports.last().unwrap().contains("|Ov:119,50,90"), "{reports:?}");
    // A reset takes them back.
    sender.send("\u{18}");
    sender.until(|line| line.starts_with("Grbl 1.1"));
    let ov = (0..3).map(|_| sender.report()).find(|report| report.contains("|Ov:")).unwrap();
    assert!(ov.contains("|Ov:100,100,100"), "{ov}");
}

/// The ticks of the last edge of a program that is sent behind these characters.
fn lasts(characters: &[u8]) -> u64 {
    let folder = folder();
    let board = Board::new(&folder, "--fast --vcd a.vcd");
    let served = Served::with(&folder, &format!("--port {}", board.port));
    let mut sender = Sender::tcp(&served);
    sender.send(characters);
    // In a hold, so that both moves are planned together.
    sender.send("!");
    sender.simple("G21 G91 F600\nG1 X5\nG1 Y5");
    sender.send("~");
    assert_eq!(sender.place(), [5.0, 5.0, 0.0]);
    assert_eq!(served.interrupt().0, 0);
    board.end();
    let vcd = std::fs::read_to_string(folder.path("a.vcd")).unwrap();
    edges(&vcd).last().unwrap().0
}

#[test]
fn overrides_scale_the_feed() {
    let [whole, half, double] = [&b""[..], &[0x92; 5], &[0x91; 12]].map(lasts);
    let near = |found: u64, wanted: u64| found.abs_diff(wanted) < wanted / 6;
    assert!(near(half, 2 * whole) && near(2 * double, whole), "{whole} {half} {double}");
}

/// Characters at random times, whatever the machine does: each line is answered until a reset, and
/// the place stays exact.
#[test]
fn characters_at_random_times_leave_the_place_exact() {
    let folder = folder();
    let served = Served::new(&folder, "");
    let mut sender = Sender::tcp(&served);
    let mut random = SplitMix64::seed_from_u64(9);
    for _ in 0..15 {
        sender.send(SQUARE.replace(' ', "") + "\n");
        for _ in 0..random.next_u32() % 6 {
            let all = [b'!', b'~', 0x85, 0x91, 0x92, 0x95, 0x97, 0x90, b'?'];
            sender.send([all[random.next_u32() as usize % all.len()]]);
            std::thread::sleep(Duration::from_micros(u64::from(random.next_u32() % 4000)));
        }
        sender.send("~");
        for _ in SQUARE.lines() {
            assert_eq!(sender.until(is_answer), "ok");
        }
        assert_eq!(sender.place(), [0.0; 3]);
    }
    for _ in 0..10 {
        sender.send(SQUARE.to_owned() + "\n");
        std::thread::sleep(Duration::from_micros(u64::from(random.next_u32() % 20_000)));
        sender.send("\u{18}");
        sender.until(|line| line.starts_with("Grbl 1.1"));
        let at = sender.place();
        assert!(is_on_square(&at), "{at:?}");
        sender.simple("G90 G21 G0 X0 Y0");
        assert_eq!(sender.place(), [0.0; 3]);
    }
    assert_eq!(served.interrupt().0, 0);
}
