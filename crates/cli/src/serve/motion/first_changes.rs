//! From a real-time character of a sender to the pulses that it changes: at most 40 ms and the round
//! trip of the line to the board, which can cut its queues.
//!
//! ```text
//! sender -- TCP --> Clients -> Requests -> Looks -> Host::stream -- line --> board of models
//! pulses   | | | | | | | | | |  |  |    |         |      with the character
//!          | | | | | | | | | | | | | | | | | | | |       without it
//!              ^ sent           ^ the first pulse that differs
//! ```
//!
//! Time is the board's: the looks at the connections and the line have its clock, and only the
//! planner, which is ahead, has that of the computer. The lines are all taken before the batch
//! begins, so that its pulses are the same in each run.

use super::{Looks, Way};
use crate::arguments::WhenGone;
use crate::control::{self, Control};
use crate::drive::Place;
use crate::serve::terms;
use crate::serve::{Clients, Pty, Requests};
use carrystep_core::link::Uart;
use carrystep_files::{Machine, SourceText};
use carrystep_grbl::{Dialect, Settings};
use carrystep_link::{Ended, Patience};
use carrystep_model::fast::Edge;
use carrystep_program::{Letters, Lines, Offsets, RowOutputs};
use carrystep_runner::LINES;
use carrystep_virtual_board::ModelBoard;
use std::io::Write as _;
use std::net::{TcpListener, TcpStream};
use std::time::{Duration, Instant};
use support::random::Random;
use support::wire::Faults;
use support::{End, SESSION};

#[path = "../../../../virtual-board/tests/support/mod.rs"]
mod support;

/// The greatest time from a character to the first pulse that it changes, ms.
const BOUND: f64 = 40.0;

/// What the line itself takes: an exchange lasts a millisecond each way, a row two more.
const ROUND_TRIP: f64 = 4.0;

/// The time from the start of the motion within which characters are sent, ms.
const SENT: std::ops::Range<u64> = 100..700;

/// Lines that turn and change their feed.
const PROGRAM: &str = "G21 G90 G17 F2400\nG1 X10\nG2 X10 Y10 J5\nG1 X0 F1800\nG3 X0 Y0 J-5\n";
/// One feed, which both limits and overrides allow.
const STEADY: &str = "G21 G90 G1 X36 Y10 F1500\n";
/// Rapid moves alone.
const RAPID: &str = "G21 G90\nG0 X40 Y10\nG0 X0 Y30\nG0 X20 Y0 Z5\n";
/// One rapid move, which is at its greatest speed from 0.1 s to 2 s.
const LONG_RAPID: &str = "G21 G90\nG0 X200\n";
/// A jog.
const JOG: &str = "$J=G21 G91 X36 Y10 F2000\n";

/// What is done to a run.
#[derive(Clone, Copy)]
struct Sent {
    /// The character, and when it is sent, ms behind the start of the motion.
    character: u8,
    at: u64,
}

fn machine() -> Machine {
    let text = include_str!("../../../../../sim/jobs/machine.toml");
    let lines = "[machine]\nqueue_depth = 31\ncuts = true\nlink.baud = 921600\n";
    let text = text.replacen("[machine]\n", lines, 1);
    Machine::from_source(&SourceText { path: "machine.toml".into(), text: text.into() }).unwrap()
}

/// A sender, and the state of the dialect that it drives.
fn connected(machine: &Machine) -> (TcpStream, Requests, Control) {
    let letters = Letters::new(machine).unwrap();
    let axes = machine.axes.len();
    let place = Place { start: [0.0; 6], soft: vec![false; axes], zero: vec![0; axes] };
    let lines = Lines::new(machine, place.start, Offsets::default(), None).unwrap();
    let settings = Settings::new(terms::settings(machine, &letters, &place.soft));
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let sender = TcpStream::connect(listener.local_addr().unwrap()).unwrap();
    sender.set_nodelay(true).unwrap();
    let clients = Clients::new(Pty::new().unwrap(), Some(listener), None).unwrap();
    let dialect = Dialect::new(settings, LINES);
    let mut requests = Requests::new((dialect, clients), lines, place, WhenGone::Finish);
    requests.begins();
    // It is the name of no device, so that nothing is claimed.
    let claim = control::claim("no device", 0, "serve", false).unwrap().unwrap();
    let mut control = Control::new(claim, false).unwrap();
    control.runs_program(false);
    (sender, requests, control)
}

/// The edges of a run up to its first rest, and the clock in which the character was sent.
fn run(lines: &str, before: &[u8], sent: Option<Sent>) -> (Vec<Edge>, Option<u64>) {
    let machine = machine();
    let time = &machine.timebase;
    let (clock_hz, ms) = (time.clock_hz(), time.clock_hz() / 1000);
    let (engine, uart) = (machine.engine(), Uart::new(clock_hz, machine.baud).unwrap());
    let end = End::of(ModelBoard::new(&engine, uart), uart, Faults::default(), 1);
    let end = end.clocked(clock_hz, 1);
    let mut host = end.connect_to(uart.build_id(&engine), Patience::default()).unwrap();
    host.open(SESSION).unwrap();
    host.enable().unwrap();

    let (mut sender, mut requests, mut control) = connected(&machine);
    sender.write_all(before).unwrap();
    sender.write_all(lines.as_bytes()).unwrap();
    // A line without an item is not counted.
    let moves = lines.lines().filter(|line| line.contains(['X', 'Z'])).count();
    while requests.growing.free() > LINES - moves {
        requests.poll(host.status(), &mut control).unwrap();
    }
    while !requests.may_move() {
        requests.poll(host.status(), &mut control).unwrap();
    }
    let overrides = control.program().filter(|_| requests.scales()).map(|one| one.overrides());
    let outputs = RowOutputs::new(&machine, requests.lines.letters());
    let way: Way = requests.way(&machine, &[0; 8], (&outputs, overrides)).unwrap();
    assert!(way.borrow_mut().begin().is_some());

    let begin = Instant::now();
    let since = |clock: u64| begin + Duration::from_nanos(clock * 1_000_000 / ms);
    let now = || end.0.borrow().board.cycle();
    let (mut looks, mut asked, mut failed) = (Looks::new(since(now())), None, None);
    let ended = host.stream(&way, |progress| {
        let start = end.0.borrow().board.loads().first().copied();
        if let (Some(start), Some(Sent { character, at }), None) = (start, sent, asked)
            && now() >= start + at * ms
        {
            sender.write_all(&[character]).unwrap();
            asked = Some(now());
        }
        looks.look(since(now()), (&mut requests, &mut control), &way, progress, &mut failed)
    });
    assert_eq!(ended, Ok(Ended::Done));
    assert!(failed.is_none());
    let start = end.0.borrow().board.loads()[0];
    let edges = end.0.borrow().edges_since(start);
    (edges, asked.map(|asked| asked - start))
}

/// The times from this character, which is sent at random moments, to the first pulse that it
/// changes, ms.
fn first_changes(lines: &str, before: &[u8], character: u8, count: u64) -> Vec<f64> {
    let (planned, _) = run(lines, before, None);
    let (ms, mut random) =
        ((machine().timebase.clock_hz() / 1000) as f64, Random::new(2026 + u64::from(character)));
    let found = (0..count).map(|_| {
        let at = SENT.start + random.below(SENT.end - SENT.start);
        let (edges, asked) = run(lines, before, Some(Sent { character, at }));
        let asked = asked.expect("the motion lasts as long");
        let changed = edges.iter().zip(&planned).find(|(one, other)| one != other);
        let first = match changed {
            Some((one, other)) => one.clock.min(other.clock),
            // The motion ends where it would have gone on.
            None => planned.get(edges.len()).expect("a pulse has changed").clock,
        };
        assert!(first >= asked, "{character:#x} at {at} ms: {first} {asked}");
        (first - asked) as f64 / ms
    });
    found.collect()
}

/// Asserts the bound for a character. CARRYSTEP_FIRST_CHANGES makes the count greater.
fn assert_bound(name: &str, (lines, before): (&str, &[u8]), character: u8, count: u64) {
    let times: u64 =
        std::env::var("CARRYSTEP_FIRST_CHANGES").map_or(1, |text| text.parse().unwrap());
    let mut found = first_changes(lines, before, character, count * times);
    found.sort_by(f64::total_cmp);
    println!("{name}: {found:.1?} ms");
    assert!(found.iter().all(|&ms| ms <= BOUND + ROUND_TRIP), "{name}: {found:.1?} ms");
    // The cut keeps 20 ms.
    assert!(found.iter().all(|&ms| ms > 15.0), "{name}: {found:.1?} ms");
}

#[test]
fn holds_and_resets_change_the_pulses_within_40_ms() {
    assert_bound("feed hold", (PROGRAM, b""), b'!', 6);
    assert_bound("reset", (PROGRAM, b""), 0x18, 6);
    assert_bound("safety door", (PROGRAM, b""), 0x84, 2);
    assert_bound("feed hold in rapid moves", (RAPID, b""), b'!', 2);
}

#[test]
fn cancelled_jogs_change_the_pulses_within_40_ms() {
    assert_bound("jog cancel", (JOG, b""), 0x85, 4);
    assert_bound("feed hold of a jog", (JOG, b""), b'!', 2);
}

/// In a steady feed. Where the limits alone set the speed, another feed may change nothing.
#[test]
fn overrides_change_the_pulses_within_40_ms() {
    assert_bound("feed 100 % after 150 %", (STEADY, &[0x91; 5]), 0x90, 2);
    assert_bound("feed +10 %", (STEADY, b""), 0x91, 2);
    assert_bound("feed -10 %", (STEADY, b""), 0x92, 2);
    assert_bound("feed -1 %", (STEADY, b""), 0x94, 2);
    assert_bound("rapid 50 %", (LONG_RAPID, b""), 0x96, 2);
    assert_bound("rapid 100 % after 25 %", (LONG_RAPID, &[0x97]), 0x95, 2);
}
