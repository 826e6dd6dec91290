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
//! can cut the others off. An override changes the rows from such a place on.

use crate::blocks::{BlockAt, nearest};
use crate::held::{Held, Window};
use crate::horizon::Horizon;
use crate::override_setting::OverrideSetting;
use crate::reading::{NextRow, Reading};
use crate::settling::settling;
use carrystep_core::{OutputChange, Segment};
use carrystep_job::{Hold, Pace, Paced, Track};
use carrystep_link::SegmentSource;
use carrystep_plan::exact::travel;
use carrystep_program::{Row, RowOutputs, SyncPoint, sync_points};
use std::fmt;

mod cuts;

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
    /// No row is sent while those that wait last for so long, ticks; `None` if the queues are filled.
    enough: Option<u64>,
    /// Number of cuts of the stretch that the board has refused.
    refused: u32,
    /// Number of cuts of the stretch that the board had granted when the last one was asked for.
    granted: u32,
    /// The planned rows that the overrides look at.
    track: Track,
    now: Reading,
    /// The place before a cut that the board has not decided, and the overrides there.
    uncut: Option<(Reading, OverrideSetting)>,
    overrides: OverrideSetting,
    /// Whether nothing of `rows` is wanted any more.
    ended: bool,
    /// The axes of the start that was not taken.
    start: Option<u8>,
}

impl<I: Iterator<Item = Row>> Stretches<I> {
    /// The stretches of these rows, which begin at these steps from machine zero, for a board with
    /// queues of so many segments. `pace` begins there, too.
    pub fn new(rows: I, start_steps: &[i64], hold: Hold, pace: Pace, queue: usize) -> Self {
        Self {
            rows,
            hold,
            queue,
            kept: None,
            enough: None,
            refused: 0,
            granted: 0,
            track: Track::new(start_steps),
            now: Reading::new(start_steps, pace, RowOutputs::default()),
            uncut: None,
            overrides: OverrideSetting::NONE,
            ended: false,
            start: None,
        }
    }

    /// The same with outputs that depend on more than the marks of the rows: the duty of a laser.
    #[must_use]
    pub fn with_outputs(mut self, outputs: RowOutputs) -> Self {
        self.now.row_outputs = outputs;
        self
    }

    /// The outputs behind the rows that were read.
    pub const fn row_outputs(&self) -> &RowOutputs {
        &self.now.row_outputs
    }

    /// The same for a board that can cut its queues: each cut keeps the rows that last for so many
    /// ticks behind those that have begun to run ([`kept_ticks`]).
    #[must_use]
    pub fn with_cuts(self, kept: u64) -> Self {
        Self { kept: Some(kept), ..self }
    }

    /// The same for a board with ticks of `tick_ns` ns. If it cannot cut its queues (`cuts`), a hold
    /// comes behind what waits there, and no more waits than [`Horizon::of_board`] says, and a row.
    #[must_use]
    pub fn for_holds(self, cuts: bool, tick_ns: u64) -> Self {
        if cuts {
            return self.with_cuts(kept_ticks(tick_ns));
        }
        Self { enough: Some(Horizon::enough_ticks(tick_ns)), ..self }
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
            None => sync_points(&self.peek()?.row).map(Wait::SyncPoint).collect(),
        };
        self.peek()?;
        let axes = self.now.segments.len();
        self.start = Some(((1_u16 << axes) - 1) as u8);
        (self.uncut, self.refused, self.granted) = (None, 0, 0);
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
        let mut ahead: Vec<NextRow> = Vec::new();
        let most = self.hold.window();
        while rows.len() < most
            && self.peek().is_some_and(|next| rows.is_empty() || !waits(&next.row))
        {
            let next = self.now.ahead.pop_front();
            rows.extend(next.iter().map(|next| next.row.clone()));
            ahead.extend(next);
        }
        let ends = self.peek().is_none_or(|next| waits(&next.row));
        let window = Window { rows, at: base, first: known, ends };
        if let Some(Held { from, stop, resume, next, line }) = window.held(&self.hold) {
            let planned = |rows: std::ops::Range<usize>| ahead.get(rows).unwrap_or_default();
            let own = |rows: Vec<Row>| rows.into_iter().map(NextRow::own).collect::<Vec<_>>();
            let lasts = |rows: &[Row]| rows.iter().map(|row| f64::from(row.ticks)).sum::<f64>();
            let replaced = planned(from - known..next - known).iter();
            let replaced = replaced.map(|next| f64::from(next.row.ticks) * next.rate).sum::<f64>();
            self.now.added += lasts(&stop) + lasts(&resume) - replaced;
            let before = [planned(0..from - known), &own(stop)].concat();
            (self.now.left, self.now.held) = (Some(before.len()), Some(line));
            ahead = [&before, &own(resume)[..], planned(next - known..ahead.len())].concat();
        }
        ahead.into_iter().rev().for_each(|next| self.now.ahead.push_front(next));
    }

    /// The overrides of the rows that are read from now on.
    pub const fn overrides(&self) -> OverrideSetting {
        self.overrides
    }

    /// Planned ticks per tick in the row that was read last.
    pub const fn rate(&self) -> f64 {
        self.now.rate
    }

    /// Planned ticks of the rows that were read, those of holds included: where the board rests, of
    /// the motion that is over.
    pub const fn gone(&self) -> f64 {
        self.now.gone
    }

    /// Ticks by which holds have made the motion longer than planned so far.
    pub const fn added(&self) -> f64 {
        self.now.added
    }

    /// Changes the overrides from the next row of the plan on. In a hold, this is the first one
    /// behind the resumption.
    pub fn set_overrides(&mut self, overrides: OverrideSetting) {
        self.overrides = overrides;
        let held = self.now.left.unwrap_or_default();
        let first = (held..self.now.ahead.len()).find(|&at| self.now.ahead[at].from.is_some());
        let place = first.and_then(|first| self.now.ahead[first].from.clone());
        self.now.ahead.truncate(first.unwrap_or(self.now.ahead.len()));
        if self.now.pace.overrides() != overrides.motion() || place.is_some() {
            self.now.pace.set(overrides.motion(), place.as_ref());
        }
    }

    /// Changes outputs with the next row that is read, before what the program says of that row.
    pub fn switch(&mut self, change: OutputChange) {
        let before = self.uncut.as_mut().map(|(before, _)| before);
        for now in [Some(&mut self.now), before].into_iter().flatten() {
            now.pending = now.pending.then(change);
        }
    }

    /// Takes back what [`Self::switch`] has not brought to a row.
    pub const fn take_switch(&mut self) -> OutputChange {
        std::mem::replace(&mut self.now.pending, OutputChange::NONE)
    }

    /// All changes of outputs of the rows of the stretch that were read so far, and those that come
    /// with the next row, as one.
    pub const fn switched(&self) -> OutputChange {
        self.now.switched.then(self.now.pending)
    }

    /// What brings P of each axis to its start value where the program waits: the segments of each
    /// axis, `ticks` in all ([`settling`]).
    pub fn settling(&self, ticks: u32) -> Vec<Vec<Segment>> {
        settling(&self.now.at, ticks)
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
        let row = Row { ticks, segments, line, block, feed, off, corner, marks, rests: true };
        self.now.ahead.push_back(NextRow::own(row));
    }

    /// The next row, which stays.
    fn peek(&mut self) -> Option<&NextRow> {
        if self.now.ahead.is_empty() && !self.ended {
            let Self { rows, track, now, .. } = self;
            if let Some(Paced { row, rate, from }) = now.pace.next(track, &mut || rows.next()) {
                now.ahead.push_back(NextRow { row, rate, from: Some(from) });
            }
        }
        self.now.ahead.front()
    }

    /// Reads the next row of the stretch.
    fn next_row(&mut self) {
        self.peek();
        let Some(next) = self.now.ahead.pop_front().filter(|_| !self.now.whole) else {
            self.now.whole = true;
            return;
        };
        self.now.whole = match &mut self.now.left {
            Some(left) => {
                *left -= 1;
                *left == 0
            }
            None => self.peek().is_none_or(|next| waits(&next.row)),
        };
        // The last row of a program is marked by the planner. Where the rows break off because the
        // program cannot be read any more, no row is: the queues run dry, and the axes ramp down.
        let ends = self.now.whole && self.peek().is_some();
        let percent = self.overrides.spindle;
        self.now.take(next, ends, percent, |segment| travel(segment, segment.ticks.into()));
        let earlier = self.uncut.as_ref().map_or(&self.now, |(before, _)| before);
        if let Some(oldest) = earlier.oldest() {
            self.now.pace.forget(&mut self.track, oldest);
        }
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

    fn may_send(&self, begun: u32, sent: u32) -> bool {
        self.enough.is_none_or(|enough| self.now.lasts(begun, sent) < enough)
    }

    fn cut_refused(&mut self) {
        if let Some((before, overrides)) = self.uncut.take() {
            (self.now, self.overrides) = (before, overrides);
            self.refused += 1;
        }
    }
}

#[cfg(test)]
mod tests;
