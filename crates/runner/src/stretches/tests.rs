//! Stretches without a board: what each axis takes, in which order, and what a hold changes of it.

use super::*;
use crate::settling::HALF_STEP;
use carrystep_files::{Machine, SourceText};
use carrystep_link::Queues;
use carrystep_program::Switch;

const PAUSE: u64 = 1 << 63 | 9;
const MACHINE: &str = "[machine]\nclock_hz = 80_000_000\ntick_ns = 1000\n\
    [[machine.axis]]\nname = \"x\"\nsteps_per_unit = 80\nspeed_limit = 100\n\
    accel_limit = 1000\ndriver = \"tmc2209\"\n\
    [[machine.axis]]\nname = \"y\"\nsteps_per_unit = 80\nspeed_limit = 100\n\
    accel_limit = 1000\ndriver = \"tmc2209\"\n";

fn row(ticks: u32, v: i64, marks: &[u64]) -> Row {
    let segment = |v| Segment { ticks, v, a: 0, j: 0, last: false };
    Row {
        ticks,
        segments: vec![segment(v), segment(2 * v)],
        line: 4,
        block: 5,
        feed: 1.0,
        off: 0.0,
        corner: 0.0,
        marks: marks.to_vec(),
        rests: false,
    }
}

/// The rows of a program, of which the planner marks the last one.
fn whole(mut rows: Vec<Row>) -> Vec<Row> {
    let last = rows.last_mut().unwrap();
    last.segments.iter_mut().for_each(|segment| segment.last = true);
    rows
}

fn stretches(rows: &[Row]) -> Stretches<impl Iterator<Item = Row>> {
    let text = SourceText { path: "machine.toml".into(), text: MACHINE.into() };
    let machine = Machine::from_source(&text).unwrap();
    let (hold, pace) = (Hold::new(&machine).unwrap(), Pace::new(&machine, &[0, 0]).unwrap());
    Stretches::new(rows.iter().cloned(), &[0, 0], hold, pace, 31).with_cuts(20_000)
}

fn taken(from: &mut impl SegmentSource, axis: u8) -> Vec<(u32, i64, bool)> {
    let mut next = || from.segment(axis);
    let all = std::iter::from_fn(|| next().map(|Segment { ticks, v, last, .. }| (ticks, v, last)));
    all.collect()
}

#[test]
fn pause_ends_a_stretch() {
    let rows = whole(vec![row(5, 1, &[]), row(6, 1, &[]), row(7, 1, &[PAUSE])]);
    let mut all = stretches(&rows);
    assert_eq!(all.begin(), Some(Vec::new()));
    assert_eq!((all.start(), all.start()), (Some(3), None));
    assert_eq!(taken(&mut all, 1), [(5, 2, false), (6, 2, true)]);
    assert_eq!(taken(&mut all, 0), [(5, 1, false), (6, 1, true)]);
    let pause = SyncPoint { switch: Switch::Pause, line: 9 };
    assert_eq!(all.begin(), Some(vec![Wait::SyncPoint(pause)]));
    assert_eq!(taken(&mut all, 0), [(7, 1, true)]);
    assert_eq!(taken(&mut all, 1), [(7, 2, true)]);
    assert_eq!(all.start(), Some(3));
    assert_eq!((all.begin(), all.segment(1)), (None, None));
}

#[test]
fn outputs_go_with_their_row() {
    let change = OutputChange::of_word(1 << 4 | 1 << 12);
    let rows = [row(5, 1, &[]), row(6, 1, &[change.word().into()])];
    let mut all = stretches(&rows);
    all.begin();
    // Another axis reads ahead.
    assert_eq!(taken(&mut all, 1).len(), 2);
    all.segment(0);
    assert_eq!(all.outputs(), OutputChange::NONE);
    all.segment(0);
    assert_eq!((all.outputs(), all.outputs()), (change, OutputChange::NONE));
}

#[test]
fn rest_of_a_stretch_is_dropped() {
    let rows = whole(vec![row(5, 1, &[]), row(6, 1, &[]), row(7, 1, &[PAUSE])]);
    let mut all = stretches(&rows);
    all.begin();
    all.segment(0);
    all.begin();
    assert_eq!(taken(&mut all, 1), [(7, 2, true)]);
}

/// 20 mm/s, for two seconds, and then as long to rest as it likes: only the beginning matters.
const V: i64 = 29_514_790_517_935_283;

#[test]
fn hold_goes_on_along_the_plan() {
    let rows: Vec<Row> = (0..500).map(|_| row(4000, V / 2, &[])).collect();
    let distance = |taken: &[Segment]| {
        taken.iter().map(|segment| travel(segment, segment.ticks.into())).sum::<i128>()
    };
    let mut all = stretches(&rows);
    all.begin();
    for axis in [0, 1] {
        assert!((0..7).all(|_| all.segment(axis).is_some()));
    }
    let sent = 7 * 4000 * i128::from(V / 2);
    all.hold();
    assert!(all.is_held());
    all.hold();
    let mut stop = Vec::new();
    while let Some(segment) = all.segment(0) {
        stop.push(segment);
    }
    // From 20 mm/s at 1000 mm/s^2 at most: 20 ms at least, and not twice the law's peak of that.
    let ticks: u32 = stop.iter().map(|segment| segment.ticks).sum();
    assert!((20_000..80_000).contains(&ticks), "{ticks}");
    assert!(stop.last().is_some_and(|segment| segment.last));
    assert_eq!(all.begin(), Some(vec![Wait::Hold(4)]));
    let mut behind = Vec::new();
    while let Some(segment) = all.segment(0) {
        behind.push(segment);
    }
    let whole = 500 * 4000 * i128::from(V / 2);
    assert_eq!(sent + distance(&stop) + distance(&behind), whole);
    assert_eq!(behind.last().map(|segment| segment.v), Some(V / 2));
}

/// What is left of a stretch.
fn rest(all: &mut impl SegmentSource) -> [Vec<Segment>; 2] {
    [0, 1].map(|axis| std::iter::from_fn(|| all.segment(axis)).collect())
}

#[test]
fn hold_in_the_queues_begins_behind_what_is_kept() {
    let rows: Vec<Row> = (0..500).map(|_| row(4000, V / 2, &[])).collect();
    let mut all = stretches(&rows);
    all.begin();
    for axis in [0, 1] {
        assert!((0..31).all(|_| all.segment(axis).is_some()));
    }
    let queues = Queues { sent: 30, begun: 3, cuts: 0 };
    assert_eq!(all.hold_in(queues), Some(8));
    assert!(all.is_held());
    let [stop, other] = rest(&mut all);
    assert_eq!(stop.len(), other.len());
    assert!(stop.last().is_some_and(|segment| segment.last));
    assert_eq!(all.begin(), Some(vec![Wait::Hold(4)]));
    let [behind, _] = rest(&mut all);
    let distance = |taken: &[Segment]| {
        taken.iter().map(|segment| travel(segment, segment.ticks.into())).sum::<i128>()
    };
    let whole = 500 * 4000 * i128::from(V / 2);
    let kept = 8 * 4000 * i128::from(V / 2);
    assert_eq!(kept + distance(&stop) + distance(&behind), whole);
}

/// Each refusal doubles what the next cut keeps, until nothing is left to cut off: then the hold
/// comes behind the queues.
#[test]
fn late_host_holds_behind_the_queues() {
    let rows: Vec<Row> = (0..500).map(|_| row(4000, V / 2, &[])).collect();
    let mut all = stretches(&rows);
    all.begin();
    assert!((0..31).all(|_| all.segment(0).is_some() && all.segment(1).is_some()));
    let queues = Queues { sent: 31, begun: 4, cuts: 0 };
    let mut kept = Vec::new();
    while let Some(keep) = all.hold_in(queues) {
        kept.push(keep - queues.begun);
        all.cut_refused();
    }
    assert_eq!((kept, all.is_held()), (vec![5, 10, 20], true));
}

#[test]
fn refused_cut_leaves_the_rows_as_they_were() {
    let change = OutputChange::of_word(1 << 4 | 1 << 12);
    let mut rows: Vec<Row> = (0..60).map(|_| row(4000, V / 2, &[])).collect();
    rows[40].marks.push(change.word().into());
    rows.push(row(9, 1, &[PAUSE]));
    let rows = whole(rows);
    // Taken before the cut, and behind it before it is refused.
    for (before, behind) in [(20, 0), (31, 1), (42, 3), (60, 5)] {
        let mut all = stretches(&rows);
        all.begin();
        let mut taken = Vec::new();
        for _ in 0..before {
            all.segment(1);
            taken.push((all.segment(0), all.outputs()));
        }
        let queues = Queues { sent: before, begun: before - 19, cuts: 0 };
        assert_eq!(all.hold_in(queues), Some(before - 14), "{before}");
        assert!((0..behind).all(|_| (all.segment(0), all.outputs()).0.is_some()));
        all.cut_refused();
        assert!(!all.is_held());
        while let Some(segment) = all.segment(0) {
            all.segment(1);
            taken.push((Some(segment), all.outputs()));
        }
        let planned = rows[..60].iter().enumerate().map(|(number, row)| {
            let none = OutputChange::NONE;
            let last = number == 59;
            let outputs = if number == 40 { change } else { none };
            (Some(Segment { last, ..row.segments[0] }), outputs)
        });
        assert_eq!(taken, planned.collect::<Vec<_>>(), "{before} {behind}");
        let pause = SyncPoint { switch: Switch::Pause, line: 9 };
        assert_eq!(all.begin(), Some(vec![Wait::SyncPoint(pause)]));
    }
}

#[test]
fn program_ends_with_its_outputs_off() {
    let off = OutputChange { mask: 0xff, levels: 0, duty: Some(0) };
    let rows: Vec<Row> = (0..500).map(|_| row(4000, V / 2, &[])).collect();
    let mut all = stretches(&rows);
    all.begin();
    all.segment(0);
    all.hold();
    assert!(all.is_held());
    while all.segment(0).is_some() {}
    // The next stretch has begun already where the program waits.
    assert_eq!(all.begin(), Some(vec![Wait::Hold(4)]));
    all.end_with(off, 4000);
    assert_eq!(all.begin(), Some(Vec::new()));
    assert_eq!(taken(&mut all, 1), [(4000, 0, true)]);
    assert!(all.segment(0).is_some());
    assert_eq!((all.outputs(), all.begin()), (off, None));
}

#[test]
fn settling_makes_no_step_and_ends_at_a_whole_one() {
    // P of each axis in 2^-64 step from its start value, at a place of 7 or -7 steps.
    for at in [-HALF_STEP, -HALF_STEP + 1, -12_345, -1, 0, 1, 99_999_999, HALF_STEP - 1] {
        let rows = [row(5, 1, &[])];
        let mut all = stretches(&rows);
        all.now.at = vec![(7 << 64) + at, -(7 << 64) + at];
        for segments in all.settling(4000) {
            assert_eq!(segments.iter().map(|segment| segment.ticks).sum::<u32>(), 4000);
            assert!(segments.iter().rev().skip(1).all(|segment| !segment.last));
            assert!(segments.last().is_some_and(|segment| segment.last));
            let mut p = HALF_STEP + at;
            for segment in segments {
                p += travel(&segment, segment.ticks.into());
                assert!((0..1 << 64).contains(&p), "a carry is a step: {at}, {p}");
            }
            assert_eq!(p, HALF_STEP);
        }
    }
}

/// As if the file had changed: the queues have to run dry, which ramps the axes down.
#[test]
fn rows_that_break_off_have_no_last_one() {
    let rows = [row(5, 1, &[]), row(6, 1, &[])];
    let mut all = stretches(&rows);
    all.begin();
    assert_eq!(taken(&mut all, 0), [(5, 1, false), (6, 1, false)]);
}

/// The changes of outputs of the segments that axis 0 takes, of which each has its ticks.
fn switched(from: &mut impl SegmentSource, most: usize) -> Vec<(u32, OutputChange)> {
    let mut all = Vec::new();
    while let Some(segment) = (all.len() < most).then(|| from.segment(0)).flatten() {
        all.push((segment.ticks, from.outputs()));
    }
    all
}

/// An output that is switched beside the program stays so when the rows are cut off and read again,
/// and whether the board grants the cut or refuses it; a later mark of the program goes first.
#[test]
fn switch_comes_once_with_the_next_row_over_cuts() {
    let on = OutputChange { mask: 2, levels: 2, duty: None };
    let other = OutputChange { mask: 3, levels: 1, duty: None };
    let marks = [other.word().into()];
    let rows = (0..20).map(|k| row(10_000 + k, 0, if k == 15 { &marks } else { &[] }));
    let rows = whole(rows.collect());
    for refuses in [false, true] {
        let mut all = stretches(&rows);
        all.begin();
        assert_eq!(switched(&mut all, 8).len(), 8);
        let queues = |sent, begun, cuts| Queues { sent, begun, cuts };
        // 20000 ticks behind the first row are kept: rows 1 and 2.
        assert_eq!(all.switch_in(on, queues(8, 1, 0)), Some(3));
        let found = switched(&mut all, 2);
        assert_eq!(found, [(10_003, on), (10_004, OutputChange::NONE)]);
        assert_eq!(all.switched(), on);
        let next = if refuses {
            all.cut_refused();
            // All 8 rows are still there, and the change comes behind them.
            assert_eq!(all.switched(), on);
            8
        } else {
            // Another cut drops the row with the change.
            assert_eq!(all.set_overrides_in(OverrideSetting::NONE, queues(5, 1, 1)), Some(3));
            3
        };
        let found = switched(&mut all, 20);
        assert_eq!(found[0], (10_000 + next, on), "{refuses}");
        let rest: Vec<_> = found[1..].iter().filter(|(_, change)| !change.is_none()).collect();
        assert_eq!(rest, [&(10_015, other)], "{refuses}");
        assert_eq!(all.switched(), on.then(other));
        all.switch(on);
        assert_eq!((all.take_switch(), all.take_switch()), (on, OutputChange::NONE));
    }
}
