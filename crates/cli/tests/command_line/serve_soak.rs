//! A sender that misbehaves at random, for hours of the machine's time: after each of its deeds the
//! next sender finds a machine that works, at an exact place, and the command's memory does not
//! grow. Run with `CARRYSTEP_SOAK=S` for S seconds of motion.
#![allow(clippy::print_stderr, reason = "figures, for the page of longer runs")]

use crate::sender::{Sender, Served, is_answer};
use crate::serve_streams::folder;
use crate::virtual_boards::Board;
use rand_xoshiro::SplitMix64;
use rand_xoshiro::rand_core::{Rng as _, SeedableRng as _};
use std::time::Duration;

/// A way of more than 64 mm that ends where it begins, at 20 mm/s.
const WAY: &str = "G21 G90 G64 P0.02 F1200\nG1 X4\nG1 Y4\nG3 X0 Y0 I-2 J-2\nG1 X8 Z1\nG1 Y8\nG1 X0\n\
    G1 Y0 Z0\nG4 P2\nG1 X4\nG1 Y4\nG1 X0\nG1 Y0\n";
/// The least time that it takes: two seconds of rest, and 64 mm.
const SECONDS: f64 = 2.0 + 64.0 / 20.0;

/// Memory of a process, bytes.
fn memory(pid: u32) -> u64 {
    let text = std::fs::read_to_string(format!("/proc/{pid}/statm")).unwrap();
    text.split_whitespace().nth(1).unwrap().parse::<u64>().unwrap() * 4096
}

/// What a sender does in the middle of its program.
fn misbehave(sender: &mut Sender, deed: u32, random: &mut SplitMix64) {
    let mut below = |count: u32| random.next_u32() % count;
    match deed {
        0 => sender.send([0x18]),
        1 => sender.send("!!!!~~~~\u{18}"),
        // Garbage, in the middle of a line too.
        2 => sender.send((0..2000).map(|_| below(256) as u8).collect::<Vec<_>>()),
        3 => sender.send("G1 X".to_owned() + &"9".repeat(100_000) + "\n"),
        4 => sender.send("(".repeat(5000) + "\n"),
        // It asks, and does not listen.
        5 => sender.send([b'?'; 3000]),
        6 => sender.send("$J=G91 X3 F600\n\u{85}$H\n$X\n$RST=*\n$10=1\n$110=7\n$$\n$I\n"),
        7 => sender.send("G1 X1e9 F1\nG0 X-1e300\nG2 X1\nM6\n~M0\n~G38.2 Z-3\n"),
        _ => sender.send([0x91, 0x91, 0x95, b'!', 0x84, b'~', 0x9d, 0x18]),
    }
}

/// A sender that drives. The one before may not have been noticed to be gone; then this one is told
/// that it watches, and a line that it sends before it is welcomed again has no answer.
fn drives(served: &Served) -> Sender {
    let mut sender = Sender::tcp(served);
    loop {
        sender.send("\n");
        std::thread::sleep(Duration::from_millis(5));
        sender.report();
        if sender.taken().iter().any(|line| line == "ok") {
            return sender;
        }
    }
}

#[test]
fn sender_that_misbehaves_harms_nothing() {
    let wanted = std::env::var("CARRYSTEP_SOAK").map_or(12.0, |text| text.parse().unwrap());
    let folder = folder();
    let board = Board::new(&folder, "--fast");
    let served = Served::with(&folder, &format!("--port {}", board.port));
    let mut random = SplitMix64::seed_from_u64(22);
    let (mut seconds, mut deeds, mut early) = (0.0, 0_u64, None);
    let mut sender = drives(&served);
    while seconds < wanted {
        sender.send(WAY);
        std::thread::sleep(Duration::from_micros(u64::from(random.next_u32() % 200_000)));
        let deed = random.next_u32() % 9;
        misbehave(&mut sender, deed, &mut random);
        // Half of the senders vanish with what they were told.
        if random.next_u32().is_multiple_of(2) {
            drop(sender);
            sender = drives(&served);
        }
        // Whatever it was: a reset, and the machine works.
        sender.send([0x18]);
        sender.until(|line| line.starts_with("Grbl 1.1"));
        sender.send("$X\n");
        sender.until(is_answer);
        sender.simple("G21 G90 G54 G49\nG0 X0 Y0 Z0");
        assert_eq!(sender.place(), [0.0; 3], "deed {deed}");
        sender.simple(WAY);
        assert_eq!(sender.place(), [0.0; 3], "deed {deed}");
        (seconds, deeds) = (seconds + SECONDS, deeds + 1);
        if deeds == 50 {
            early = Some(memory(served.child.id()));
        }
    }
    let late = memory(served.child.id());
    if let Some(early) = early {
        assert!(late < early + (8 << 20), "{early} to {late} bytes");
    }
    assert_eq!(served.interrupt().0, 0);
    let said = board.end();
    assert!(said.contains("\nx at 0\ny at 0\nz at 0\n"), "{said}");
    eprintln!(
        "FIGURES {deeds} deeds in more than {seconds:.0} s of motion, each followed by a program \
         that ends exactly; {} MB of memory",
        late >> 20
    );
}
