//! A host that replaces its plan while the axes move: what is kept runs, what was cut off does not,
//! and a refused cut changes nothing. With a board of models and with the exported Verilog.

use crate::support::random::Random;
use crate::support::wire::Faults;
use crate::support::{CLOCK_HZ, End, Kind, QUICK, SESSION, build};
use carrystep_core::AXES;
use carrystep_core::engine::Cause;
use carrystep_core::link::Uart;
use carrystep_link::{
    Ended, HostError, OutputChange, Progress, Queues, Segment, SegmentSource, Wish,
};
use carrystep_virtual_board::{ModelBoard, VerilatedBoard};
use std::cell::RefCell;

/// Ticks of a row.
const TICKS: u32 = 1024;
/// Rows of the first plan.
const ROWS: u32 = 60;
/// Rows of the plan that replaces it.
const NEW_ROWS: u32 = 9;
/// The greatest number of steps in a row.
const STEPS: i64 = 9;

/// Steps of each axis in each row.
type Plan = Vec<[i64; AXES]>;

fn plan(random: &mut Random, rows: u32) -> Plan {
    let mut row = |_| std::array::from_fn(|_| random.below(1 + STEPS as u64) as i64);
    (0..rows).map(&mut row).collect()
}

fn sum(rows: &[[i64; AXES]]) -> Vec<i32> {
    (0..AXES).map(|axis| rows.iter().map(|row| row[axis]).sum::<i64>() as i32).collect()
}

/// A plan, and where each axis reads it.
#[derive(Clone)]
struct Reading {
    rows: Plan,
    at: [usize; AXES],
}

/// A source that may replace what follows its first rows.
struct Rows {
    now: Reading,
    before: Option<Reading>,
    start: Option<u8>,
    refused: u32,
    /// A row lasts 2 to the power of this times [`TICKS`].
    slow: u32,
}

impl Rows {
    fn new(rows: Plan) -> RefCell<Self> {
        let now = Reading { rows, at: [0; AXES] };
        RefCell::new(Self { now, before: None, start: Some(0x3f), refused: 0, slow: 0 })
    }

    /// Replaces what follows the first `keep` rows.
    fn replace(&mut self, keep: u32, new: &[[i64; AXES]]) {
        self.before = Some(self.now.clone());
        self.now.rows.truncate(keep as usize);
        self.now.rows.extend(new);
        self.now.at = [keep as usize; AXES];
    }
}

impl SegmentSource for Rows {
    fn segment(&mut self, axis: u8) -> Option<Segment> {
        let Reading { rows, at } = &mut self.now;
        let at = at.get_mut(usize::from(axis))?;
        let row = rows.get(*at)?;
        *at += 1;
        let (v, ticks) = (row[usize::from(axis)] << (54 - self.slow), TICKS << self.slow);
        Some(Segment { ticks, v, a: 0, j: 0, last: *at == rows.len() })
    }

    fn outputs(&mut self) -> OutputChange {
        OutputChange::NONE
    }

    fn start(&mut self) -> Option<u8> {
        self.start.take()
    }

    fn may_cut(&self) -> bool {
        true
    }

    fn cut_refused(&mut self) {
        self.refused += 1;
        self.now = self.before.take().unwrap();
    }
}

/// How far behind the row that runs a cut is asked for.
#[derive(Clone, Copy)]
enum Behind {
    Rows(u32),
    /// Behind the last row but one of those that have begun.
    Past,
    /// Behind the first row.
    First,
}

/// Streams a plan that is replaced when `begun` rows have begun. Returns whether the cut was
/// granted; `None` if a queue ran dry, which may happen on a bad line only.
fn cut<B: Kind>(seed: u64, begun: u32, behind: Behind, faults: Faults) -> Option<bool> {
    let mut random = Random::new(seed);
    let uart = Uart::new(CLOCK_HZ, 3_000_000).unwrap();
    let end = End::<B>::new(uart, faults, seed);
    let mut host = end.connect_to(uart.build_id(&build()), QUICK).unwrap();
    host.open(SESSION).unwrap();
    host.enable().unwrap();
    let (old, new) = (plan(&mut random, ROWS), plan(&mut random, NEW_ROWS));
    let source = Rows::new(old.clone());
    let (mut asked, mut last) = (None, Queues { sent: 0, begun: 0, cuts: 0 });
    let ended = host.stream(&source, |progress: &Progress<'_>| {
        last = progress.queues.unwrap();
        if asked.is_none() && last.begun >= begun {
            let keep = match behind {
                Behind::Rows(rows) => last.begun + rows,
                Behind::Past => last.begun - 1,
                Behind::First => 1,
            };
            if keep >= last.sent {
                return Wish::GoOn;
            }
            asked = Some(keep);
            source.borrow_mut().replace(keep, &new);
            return Wish::Cut { keep };
        }
        Wish::GoOn
    });
    if faults != Faults::default()
        && matches!(ended, Err(HostError::Fault { cause, .. }) if cause == Cause::Underrun as u8)
    {
        return None;
    }
    assert_eq!(ended, Ok(Ended::Done), "seed {seed}");
    let keep = asked.expect("there was room for a cut") as usize;
    let granted = last.cuts == 1;
    assert_eq!(source.borrow().refused, u32::from(!granted), "seed {seed}");
    let wanted = if granted { [&old[..keep], &new].concat() } else { old };
    assert_eq!(host.status().positions[..AXES], sum(&wanted), "seed {seed}, granted: {granted}");
    assert_eq!(last.sent as usize, wanted.len(), "all axes have got all rows");
    Some(granted)
}

/// The row that runs may end before the cut arrives; three rows last 6 ms.
fn plans_are_replaced<B: Kind>(seeds: u64) {
    let mut granted = 0;
    for seed in 0..seeds {
        let behind = Behind::Rows(1 + (seed % 4) as u32);
        let granted_now = cut::<B>(seed, 2 + (seed % 30) as u32, behind, Faults::default());
        granted += u64::from(granted_now == Some(true));
    }
    assert!(granted * 2 > seeds, "only {granted} of {seeds}");
}

#[test]
fn plans_are_replaced_on_a_board_of_models() {
    plans_are_replaced::<ModelBoard>(40);
}

#[test]
fn plans_are_replaced_on_the_verilog() {
    plans_are_replaced::<VerilatedBoard>(4);
}

#[test]
fn refused_cuts_change_nothing() {
    for seed in 0..20 {
        let behind = if seed < 10 { Behind::First } else { Behind::Past };
        let begun = 3 + 9 * (seed % 7) as u32;
        assert_eq!(cut::<ModelBoard>(seed, begun, behind, Faults::default()), Some(false));
    }
    // Near the end there is room in the queues, so that the slot is not named anew.
    assert_eq!(cut::<VerilatedBoard>(3, 57, Behind::Past, Faults::default()), Some(false));
}

#[test]
fn lost_frames_around_a_cut_are_sent_again() {
    let mut outcomes = [0; 3];
    for seed in 0..60 {
        let behind = if seed % 3 == 0 { Behind::Past } else { Behind::Rows(5) };
        let faults = Faults { drop: 300, flip: 300, ..Faults::default() };
        outcomes[match cut::<ModelBoard>(seed, 2 + (seed % 30) as u32, behind, faults) {
            Some(true) => 0,
            Some(false) => 1,
            None => 2,
        }] += 1;
    }
    assert!(outcomes.iter().all(|&count| count > 2), "{outcomes:?}");
}

/// A cut that names a row of the past, and the next one at once. The host is late, and sends the first
/// one twice: the second answer that refuses it comes when the second one is on the line.
#[test]
fn cut_right_behind_a_refused_one_is_taken_for_itself() {
    let (mut granted, seeds) = (0, 40);
    for seed in 0..seeds {
        let mut random = Random::new(seed);
        let uart = Uart::new(CLOCK_HZ, 240_000).unwrap();
        let end = End::<ModelBoard>::new(uart, Faults::default(), seed);
        let mut host = end.connect_to(uart.build_id(&build()), QUICK).unwrap();
        host.open(SESSION).unwrap();
        host.enable().unwrap();
        let (old, new) = (plan(&mut random, ROWS), plan(&mut random, NEW_ROWS));
        let source = Rows::new(old.clone());
        source.borrow_mut().slow = 3;
        let (mut first, mut second, mut cuts, mut late) = (false, None, 0, false);
        let mut furthest = 0;
        let ended = host.stream(&source, |progress: &Progress<'_>| {
            let Queues { sent, begun, cuts: now } = progress.queues.unwrap();
            cuts = now;
            // The refusal of a cut makes nothing unknown that was known before.
            assert!(begun >= furthest, "seed {seed}: {begun} rows have begun, {furthest} before");
            furthest = begun;
            let keep = match (first, second) {
                (false, _) if begun >= 3 + (seed % 20) as u32 => begun - 1,
                (true, None) if source.borrow().refused == 1 => begun + 4,
                (true, None) if !std::mem::replace(&mut late, true) => {
                    end.wait(u64::from(QUICK.timing.resend) + 3);
                    return Wish::GoOn;
                }
                _ => return Wish::GoOn,
            };
            if keep >= sent {
                return Wish::GoOn;
            }
            second = first.then_some(keep);
            first = true;
            source.borrow_mut().replace(keep, &new);
            Wish::Cut { keep }
        });
        assert_eq!(ended, Ok(Ended::Done), "seed {seed}");
        let refused = source.borrow().refused;
        let kept = second.filter(|_| refused == 1);
        assert_eq!(cuts, u32::from(kept.is_some()), "seed {seed}, {refused} refused");
        let wanted = match kept {
            Some(keep) => [&old[..keep as usize], &new].concat(),
            None => old,
        };
        assert_eq!(host.status().positions[..AXES], sum(&wanted), "seed {seed}, {kept:?}");
        granted += u64::from(kept.is_some());
    }
    assert!(granted * 2 > seeds, "only {granted} of {seeds}");
}
