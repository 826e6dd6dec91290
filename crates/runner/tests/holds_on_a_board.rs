//! Programs that are held while a board of models runs them, with queues of 31 segments that the
//! hold cuts: how soon the pulses change, and that the program ends where it should.
//!
//! ```text
//! pulses   | | | | | | | | | |  |  |    |         |    |  | | | |     held
//!          | | | | | | | | | | | | | | | |                            not held
//!              ^ hold asked     ^ the first pulse that differs
//! ```

use crate::support::wire::Faults;
use crate::support::{CLOCK_HZ, End, MS, SESSION};
use crate::three_axes::machine;
use carrystep_core::link::Uart;
use carrystep_job::{Hold, Pace};
use carrystep_link::{Ended, Patience, Progress, Wish};
use carrystep_model::fast::{Change, Edge};
use carrystep_program::{ProgramFile, Rows, Settings};
use carrystep_runner::{OverrideSetting, Stretches, Wait, kept_ticks};
use carrystep_virtual_board::ModelBoard;
use std::cell::RefCell;
use std::path::{Path, PathBuf};

const TABLES: &str = "[machine]\nclock_hz = 48_000_000\ntick_ns = 2000\nqueue_depth = 31\n\
    cuts = true\n[machine.link]\nbaud = 3_000_000";

/// The greatest time from the request to the first pulse that differs, ms: 40, and the round trip
/// of this line.
const FIRST_CHANGE: u64 = 43;

/// What a run came to.
struct Run {
    edges: Vec<Edge>,
    positions: Vec<i32>,
    /// The cycle of the request for a hold.
    asked: Option<u64>,
    cuts: u32,
    holds: usize,
}

/// What is asked of a program.
#[derive(Debug, Clone, Copy)]
enum What {
    Hold,
    Feed(u8),
}

/// The moment of a request, ms of the board's time from configuration; and for how long the host
/// plans its first hold, ms.
#[derive(Clone, Copy)]
struct Request {
    at: u64,
    plans: u64,
    what: What,
}

fn run(path: &Path, request: Option<Request>) -> Run {
    let (machine, text) = machine(TABLES);
    let (engine, uart) = (machine.engine(), Uart::new(CLOCK_HZ, 3_000_000).unwrap());
    let file = ProgramFile::open(path, machine.clone(), &text.path, Settings::default()).unwrap();
    let rows = Rows::new(&file).unwrap().map(Result::unwrap);
    let (hold, kept) = (Hold::new(&machine).unwrap(), kept_ticks(machine.timebase.tick_ns()));
    let start = file.start_steps();
    let pace = Pace::new(&machine, &start).unwrap();
    let stretches = Stretches::new(rows, &start, hold, pace, machine.queue).with_cuts(kept);
    let stretches = RefCell::new(stretches);
    let end = End::of(ModelBoard::new(&engine, uart), uart, Faults::default(), 1);
    let mut host = end.connect_to(uart.build_id(&engine), Patience::default()).unwrap();
    host.open(SESSION).unwrap();
    host.enable().unwrap();
    let (mut asked, mut cuts, mut holds) = (None, 0, 0);
    while let Some(waits) = { stretches.borrow_mut().begin() } {
        holds += waits.iter().filter(|wait| matches!(wait, Wait::Hold(_))).count();
        let mut granted = 0;
        let ended = host.stream(&stretches, |progress: &Progress<'_>| {
            let queues = progress.queues.unwrap();
            granted = queues.cuts;
            let now = end.0.borrow().board.cycle();
            let Some(Request { at, plans, what }) = request else { return Wish::GoOn };
            if now < at * MS || holds > 0 || stretches.borrow().is_held() {
                return Wish::GoOn;
            }
            let keep = match what {
                What::Hold => stretches.borrow_mut().hold_in(queues),
                What::Feed(feed) => {
                    let wanted = OverrideSetting { feed, ..OverrideSetting::NONE };
                    if stretches.borrow().overrides() == wanted {
                        return Wish::GoOn;
                    }
                    stretches.borrow_mut().set_overrides_in(wanted, queues)
                }
            };
            if asked.is_none() {
                end.wait(plans);
            }
            asked.get_or_insert(now);
            keep.map_or(Wish::GoOn, |keep| Wish::Cut { keep })
        });
        assert_eq!(ended, Ok(Ended::Done));
        cuts += granted;
    }
    let positions = host.status().positions[..machine.axes.len()].to_vec();
    let edges = end.0.borrow().edges_since(0);
    Run { edges, positions, asked, cuts, holds }
}

/// The pulses of an axis, without their times.
fn pulses(edges: &[Edge], axis: u8) -> Vec<bool> {
    let is_pulse = |edge: &&Edge| edge.axis == axis && edge.change == Change::Rise;
    edges.iter().filter(is_pulse).map(|edge| edge.backward).collect()
}

/// The first cycle in which the pulses of two runs differ.
fn differ(one: &[Edge], other: &[Edge]) -> u64 {
    let (a, b) = one.iter().zip(other).find(|(a, b)| a != b).expect("a difference");
    a.clock.min(b.clock)
}

fn program(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../sim/jobs").join(name)
}

/// Holds a program at these times, ms. Returns the times to the first change, ms, and the number of
/// cuts.
fn holds(name: &str, times: impl Iterator<Item = u64>, plans: u64) -> (Vec<u64>, u32) {
    let plain = run(&program(name), None);
    let (mut changes, mut cuts) = (Vec::new(), 0);
    for at in times {
        let held = run(&program(name), Some(Request { at, plans, what: What::Hold }));
        assert_eq!(held.positions, plain.positions, "{name}, hold at {at} ms");
        for axis in 0..3 {
            assert_eq!(pulses(&held.edges, axis), pulses(&plain.edges, axis), "{name}, {at} ms");
        }
        assert_eq!(held.holds, 1, "{name}, hold at {at} ms");
        cuts += held.cuts;
        changes.push((differ(&held.edges, &plain.edges) - held.asked.unwrap()) / MS);
    }
    (changes, cuts)
}

#[test]
fn hold_changes_the_pulses_within_40_ms() {
    let (changes, cuts) = holds("square_and_arc.ngc", (600..2400).step_by(173), 0);
    println!("{changes:?} ms to the first change, {cuts} cuts");
    assert!(changes.iter().all(|&ms| ms <= FIRST_CHANGE), "{changes:?} ms");
    assert_eq!(cuts, changes.len() as u32);
}

/// The first pulse that another feed changes comes about as soon as that of a hold; where the plan
/// uses the whole acceleration, it cannot.
#[test]
fn override_changes_the_pulses_soon_and_no_place() {
    let name = "square_and_arc.ngc";
    let plain = run(&program(name), None);
    let (mut changes, mut cuts) = (Vec::new(), 0);
    for (at, feed) in [(600, 50), (1000, 20), (1400, 80), (1800, 200), (2200, 10)] {
        let request = Request { at, plans: 0, what: What::Feed(feed) };
        let found = run(&program(name), Some(request));
        assert_eq!(found.positions, plain.positions, "{feed} % at {at} ms");
        for axis in 0..3 {
            let [found, plain] = [&found, &plain].map(|run| run.edges.iter());
            let count = |edges: std::slice::Iter<'_, Edge>| {
                let rises = edges.filter(|edge| edge.axis == axis && edge.change == Change::Rise);
                rises.map(|edge| if edge.backward { -1 } else { 1 }).sum::<i64>()
            };
            assert_eq!(count(found), count(plain), "{feed} % at {at} ms, axis {axis}");
        }
        let changed = differ(&found.edges, &plain.edges);
        changes.push((feed, changed.saturating_sub(found.asked.unwrap()) / MS));
        cuts += found.cuts;
    }
    assert!(changes.iter().all(|&(feed, ms)| feed > 100 || ms <= FIRST_CHANGE), "{changes:?}");
    println!("(percent, ms to the first change): {changes:?}, {cuts} cuts");
    assert_eq!(cuts, 5);
}

/// The first cut is refused, and the next one keeps more.
#[test]
fn late_host_holds_a_little_later() {
    let (changes, cuts) = holds("square_and_arc.ngc", [900, 1200, 1500].into_iter(), 60);
    assert!(changes.iter().all(|ms| (60..200).contains(ms)), "{changes:?} ms");
    assert_eq!(cuts, 3);
}
