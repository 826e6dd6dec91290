//! A program in stretches, each of which begins and ends at rest.
//!
//! ```text
//! rows      r0  r1  r2  r3  r4  r5  r6
//! mark                      M0
//! stretch   |---- first ---||-- second --|
//! last                  x              x      the queues run empty here
//! start     ^               ^
//! ```
//!
//! A row with a [`SyncPoint`] begins a stretch. The row before it is marked as the last one of its
//! move in all axes, so that the gateware finds an empty queue there and no underrun. A hold ends a
//! stretch early (`held.rs`): behind the rows that were read, or behind earlier ones if the board
//! can cut the others off.

use crate::blocks::{BlockAt, nearest};
use crate::held::{Held, Window};
use crate::reading::Reading;
use carrystep_core::{OutputChange, Segment};
use carrystep_job::Hold;
use carrystep_link::{Queues, SegmentSource};
use carrystep_plan::exact::travel;
use carrystep_program::{Row, SyncPoint, sync_points};
use std::fmt;

/// The time that a cut keeps behind the rows that have begun to run, ns.
const KEPT_NS: u64 = 20_000_000;

/// Rows that are read and not in a queue: the one that runs, and those on the line.
const ON_THE_WAY: usize = 4;

/// What a program waits for before a stretch.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Wait {
    /// Somebody at a place of the program.
    SyncPoint(SyncPoint),
    /// The end of a hold; the line that was running.
    Hold(u64),
}

impl fmt::Display for Wait {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::SyncPoint(at) => write!(f, "{at}"),
            Self::Hold(line) => write!(f, "hold in line {line}"),
        }
    }
}

/// Half a step in units of 2^-64 step.
const HALF_STEP: i128 = 1 << 63;

/// The rows of a program, stretch by stretch: as a [`SegmentSource`], it gives the segments of the
/// stretch that was begun last. Memory holds only the rows of which an axis has not taken its
/// segment yet, those that may wait in the board's queues, and those that a hold looks at.
#[derive(Debug)]
pub struct Stretches<I: Iterator<Item = Row>> {
    rows: I,
    hold: Hold,
    /// Number of segments that the queue of an axis holds.
    queue: usize,
    /// How long the rows last that a cut keeps behind those that have begun, ticks; `None` if the
    /// board cannot cut its queues.
    kept: Option<u64>,
    /// Number of cuts of the stretch that the board has refused.
    refused: u32,
    now: Reading,
    /// The place before a cut that the board has not decided.
    uncut: Option<Reading>,
    /// Whether nothing of `rows` is wanted any more.
    ended: bool,
    /// The axes of the start that was not taken.
    start: Option<u8>,
}

impl<I: Iterator<Item = Row>> Stretches<I> {
    /// The stretches of these rows, which begin at these steps from machine zero, for a board with
    /// queues of so many segments.
    pub fn new(rows: I, start_steps: &[i64], hold: Hold, queue: usize) -> Self {
        let (kept, now) = (None, Reading::new(start_steps));
        Self { rows, hold, queue, kept, refused: 0, now, uncut: None, ended: false, start: None }
    }

    /// The same for a board that can cut its queues: each cut keeps the rows that last for so many
    /// ticks behind those that have begun to run ([`kept_ticks`]).
    #[must_use]
    pub fn with_cuts(self, kept: u64) -> Self {
        Self { kept: Some(kept), ..self }
    }

    /// In which block of the program the tool is if the axes are at these steps from machine zero.
    /// Only rows count that the board may not have finished. Of several that fit, it is the first.
    pub fn block_at(&self, positions: &[i64]) -> Option<BlockAt> {
        nearest(self.now.recent(self.queue + ON_THE_WAY), positions)
    }

    /// Begins the next stretch, and returns what the program waits for before. `None` at the end of
    /// the program. What is left of the stretch before is dropped.
    pub fn begin(&mut self) -> Option<Vec<Wait>> {
        while !self.now.whole {
            self.next_row();
        }
        let waits = match self.now.held.take() {
            Some(line) => vec![Wait::Hold(line)],
            None => sync_points(self.peek()?).map(Wait::SyncPoint).collect(),
        };
        self.peek()?;
        let axes = self.now.segments.len();
        self.start = Some(((1_u16 << axes) - 1) as u8);
        (self.uncut, self.refused) = (None, 0);
        self.now.begin();
        Some(waits)
    }

    /// Whether a hold ends the present stretch.
    pub const fn is_held(&self) -> bool {
        self.now.left.is_some()
    }

    /// Ends the present stretch on the planned curve, if the limits allow it from one of the next
    /// rows on. If they do not, it may be possible when more rows have been read. Nothing is done
    /// for a stretch that has been held, or that ends by itself with the rows that were read.
    pub fn hold(&mut self) {
        if self.now.whole || self.is_held() {
            return;
        }
        let before = self.now.last().cloned();
        let base = before.as_ref().map_or_else(|| self.now.at.clone(), |(_, at)| at.clone());
        let mut rows: Vec<Row> = before.into_iter().map(|(row, _)| row).collect();
        let known = rows.len();
        let within = |rows: &[Row], row: &Row| rows.is_empty() || !waits(row);
        let most = self.hold.window();
        while rows.len() < most && self.peek().is_some_and(|row| within(&rows, row)) {
            rows.extend(self.now.ahead.pop_front());
        }
        let ends = self.peek().is_none_or(waits);
        let window = Window { rows, at: base, first: known, ends };
        let rows = match window.held(&self.hold) {
            Some(Held { before, behind, line }) => {
                (self.now.left, self.now.held) = (Some(before.len()), Some(line));
                [before, behind].concat()
            }
            None => window.rows.into_iter().skip(known).collect(),
        };
        rows.into_iter().rev().for_each(|row| self.now.ahead.push_front(row));
    }

    /// The same as soon as the queues of the board allow it. Returns the number of rows of the
    /// stretch behind which the board has to cut its queues: the hold follows these. `None` if
    /// nothing has to be cut; whether there is a hold now, [`Self::is_held`] says.
    pub fn hold_in(&mut self, queues: Queues) -> Option<u32> {
        let Some(keep) = self.cut(queues) else {
            self.hold();
            return None;
        };
        // The rows that the hold looks at have to stay if the cut is refused.
        let mut ends = self.now.ahead.iter().any(waits);
        while self.now.ahead.len() <= self.hold.window() && !ends {
            let Some(row) = self.rows.next().filter(|_| !self.ended) else { break };
            ends = waits(&row);
            self.now.ahead.push_back(row);
        }
        let before = self.now.clone();
        if self.now.rewind(keep) {
            self.hold();
        }
        if self.is_held() {
            self.uncut = Some(before);
            return Some(keep);
        }
        self.now = before;
        None
    }

    /// The number of rows of the stretch that a cut keeps; `None` if it would drop none. A host that
    /// was late for a cut keeps more with the next one.
    fn cut(&self, queues: Queues) -> Option<u32> {
        let kept = self.kept?.checked_shl(self.refused)?;
        let may = !self.is_held() && self.uncut.is_none() && queues.begun > 0;
        self.now.behind(queues.begun, kept).filter(|&keep| may && keep < queues.sent)
    }

    /// What brings P of each axis to its start value where the program waits: the segments of each
    /// axis, `ticks` in all. No axis makes a step, because each stays within half a step of the whole
    /// number that its position register shows.
    pub fn settling(&self, ticks: u32) -> Vec<Vec<Segment>> {
        let ticks = ticks.max(1);
        let axis = |&at: &i128| {
            let whole = (at + HALF_STEP) >> 64 << 64;
            let (left, count) = (whole - at, i128::from(ticks));
            let (v, more) = (left.div_euclid(count), left.rem_euclid(count));
            // `more` ticks with one unit more, and then the others.
            let parts = [(more, v + 1), (count - more, v)];
            let parts = parts.into_iter().filter(|(ticks, _)| *ticks > 0);
            let mut segments: Vec<Segment> = parts
                .map(|(ticks, v)| Segment {
                    ticks: ticks as u32,
                    v: v as i64,
                    a: 0,
                    j: 0,
                    last: false,
                })
                .collect();
            segments.iter_mut().last().into_iter().for_each(|segment| segment.last = true);
            segments
        };
        self.now.at.iter().map(axis).collect()
    }

    /// Drops what is left of the program, and ends it with this change of outputs, at rest. The
    /// next stretch is that row alone.
    pub fn end_with(&mut self, change: OutputChange, ticks: u32) {
        let segment = Segment { ticks, v: 0, a: 0, j: 0, last: true };
        let segments = vec![segment; self.now.segments.len()];
        let marks = vec![change.word().into()];
        let (line, block) = self.now.last().map_or((0, 0), |(row, _)| (row.line, row.block));
        (self.now.held, self.now.left, self.now.whole, self.ended) = (None, None, true, true);
        self.now.ahead.clear();
        let (feed, off, corner) = (f64::INFINITY, 0.0, 0.0);
        self.now.ahead.push_back(Row { ticks, segments, line, block, feed, off, corner, marks });
    }

    /// The next row, which stays.
    fn peek(&mut self) -> Option<&Row> {
        if self.now.ahead.is_empty() && !self.ended {
            self.now.ahead.extend(self.rows.next());
        }
        self.now.ahead.front()
    }

    /// Reads the next row of the stretch.
    fn next_row(&mut self) {
        self.peek();
        let Some(row) = self.now.ahead.pop_front().filter(|_| !self.now.whole) else {
            self.now.whole = true;
            return;
        };
        self.now.whole = match &mut self.now.left {
            Some(left) => {
                *left -= 1;
                *left == 0
            }
            None => self.peek().is_none_or(waits),
        };
        // The last row of a program is marked by the planner. Where the rows break off because the
        // program cannot be read any more, no row is: the queues run dry, and the axes ramp down.
        let ends = self.now.whole && self.peek().is_some();
        self.now.take(row, ends, |segment| travel(segment, segment.ticks.into()));
    }
}

/// Ticks that the rows last at least which a cut keeps behind those that have begun to run: the hold
/// has to be planned, and to arrive, meanwhile.
pub const fn kept_ticks(tick_ns: u64) -> u64 {
    KEPT_NS.div_ceil(tick_ns)
}

/// Whether somebody has to let the machine go on before a row.
fn waits(row: &Row) -> bool {
    sync_points(row).next().is_some()
}

impl<I: Iterator<Item = Row>> SegmentSource for Stretches<I> {
    fn segment(&mut self, axis: u8) -> Option<Segment> {
        let axis = usize::from(axis);
        while self.now.segments.get(axis)?.is_empty() && !self.now.whole {
            self.next_row();
        }
        let segment = self.now.segments.get_mut(axis)?.pop_front();
        if axis == 0 {
            self.now.change = self.now.outputs.pop_front().unwrap_or(OutputChange::NONE);
        }
        segment
    }

    fn outputs(&mut self) -> OutputChange {
        std::mem::replace(&mut self.now.change, OutputChange::NONE)
    }

    fn start(&mut self) -> Option<u8> {
        self.start.take()
    }

    fn may_cut(&self) -> bool {
        self.kept.is_some()
    }

    fn cut_refused(&mut self) {
        if let Some(before) = self.uncut.take() {
            self.now = before;
            self.refused += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use carrystep_files::{Machine, SourceText};
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
        let hold = Hold::new(&Machine::from_source(&text).unwrap()).unwrap();
        Stretches::new(rows.iter().cloned(), &[0, 0], hold, 31).with_cuts(20_000)
    }

    fn taken(from: &mut impl SegmentSource, axis: u8) -> Vec<(u32, i64, bool)> {
        let mut next = || from.segment(axis);
        let all =
            std::iter::from_fn(|| next().map(|Segment { ticks, v, last, .. }| (ticks, v, last)));
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
}
