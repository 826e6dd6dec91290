//! Checks a long capture in slices, each for itself, and merges what they show into the report of
//! the whole capture.
//!
//! ```text
//!  capture   | header | slice 1 | slice 2 | slice 3 | slice 4 |
//!                     0         ^ a line with a time, at which no pulse is due
//!  slice 3              reads   ..|=======|       and the levels before it
//!  merge                appends  1, 2, 3, 4, and checks a slice again that does not follow
//! ```
//!
//! A slice reads the header, the capture up to its first pulse, a little before its beginning for
//! the levels of the pins, and its own bytes. Which bytes these are depends on the capture and on
//! the moves alone.

use crate::beside::go_on_beside;
use crate::checker::{Checker, Part, Setup};
use crate::edge::{OutputPins, PinChange, PinSink};
use crate::error::TraceError;
use crate::report::CheckReport;
use crate::signal_map::SignalMap;
use crate::vcd_cut::{self, Cut};
use crate::vcd_header::parser;
use crate::vcd_in::VcdReader;
use crate::vcd_play::{Played, Player, Playing};
use carrystep_files::sealed::sha256;
use serde::{Deserialize, Serialize};
use std::cell::Cell;
use std::io::{self, Read, Seek, SeekFrom};
use std::ops::Range;
use std::path::Path;

/// So many bytes before a slice are read for the levels of the pins.
const BEFORE: u64 = 1 << 16;

/// So many bytes at the beginning and at the end of a capture tell it from others.
const COMPARED: u64 = 1 << 14;

/// A capture in a file.
#[derive(Debug)]
pub struct Capture<'a> {
    path: &'a Path,
    names: &'a [&'a str],
    map: &'a SignalMap,
    /// The outputs that are searched, one bit each.
    outputs: OutputPins,
    bytes: u64,
}

/// One of several slices of a capture, with what it shows.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Slice {
    /// Number of the slice, counted from 1.
    pub number: u64,
    /// Number of all slices.
    pub count: u64,
    /// What tells the capture from others.
    capture: Fingerprint,
    /// Its beginning and its end, bytes from the start of the file.
    from: u64,
    to: u64,
    /// The time with which it begins, ps; `None` at the start of the capture.
    from_ps: Option<u64>,
    /// The last time of the slice, ps.
    end_ps: u64,
    part: Part,
}

impl Slice {
    /// Its beginning and its end, bytes from the start of the file.
    pub fn bytes(&self) -> (u64, u64) {
        (self.from, self.to)
    }
}

/// What tells a capture from others.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
struct Fingerprint {
    bytes: u64,
    first: String,
    last: String,
}

/// The report of the merged slices.
#[derive(Debug)]
pub struct Merged {
    /// The report.
    pub report: CheckReport,
    /// The last time in the capture, ps.
    pub end_ps: u64,
    /// The numbers of the slices that did not begin as the slices before them ended, and were
    /// checked again.
    pub again: Vec<u64>,
}

impl<'a> Capture<'a> {
    /// A capture in this file, in which the pins of these axes are found by their names.
    ///
    /// # Errors
    /// The file cannot be read.
    pub fn new(
        path: &'a Path,
        names: &'a [&'a str],
        map: &'a SignalMap,
    ) -> Result<Self, TraceError> {
        let mut file = carrystep_files::open(path)?;
        let bytes = file.seek(SeekFrom::End(0)).map_err(read)?;
        Ok(Self { path, names, map, outputs: OutputPins::default(), bytes })
    }

    /// The same capture, in which those of these outputs are read that it shows.
    #[must_use]
    pub fn with_outputs(self, outputs: OutputPins) -> Self {
        Self { outputs, ..self }
    }

    /// Reads the header and finds the pins.
    ///
    /// # Errors
    /// As [`VcdReader::new`].
    pub fn open(&self) -> Result<VcdReader<'static>, TraceError> {
        self.reader(self.bytes)
    }

    fn reader(&self, until: u64) -> Result<VcdReader<'static>, TraceError> {
        let Self { names, map, outputs, .. } = self;
        Ok(VcdReader::with_outputs(self.bytes(0..until)?, names, map, *outputs)?)
    }

    fn bytes(&self, range: Range<u64>) -> Result<io::Take<std::fs::File>, TraceError> {
        let mut file = carrystep_files::open(self.path)?;
        file.seek(SeekFrom::Start(range.start)).map_err(read)?;
        Ok(file.take(range.end.saturating_sub(range.start)))
    }

    fn fingerprint(&self) -> Result<Fingerprint, TraceError> {
        let sum = |range| -> Result<String, TraceError> {
            let mut bytes = Vec::new();
            self.bytes(range)?.read_to_end(&mut bytes).map_err(read)?;
            Ok(sha256(&bytes))
        };
        let first = sum(0..COMPARED)?;
        let last = sum(self.bytes.saturating_sub(COMPARED)..self.bytes)?;
        Ok(Fingerprint { bytes: self.bytes, first, last })
    }

    /// Checks one of `count` slices. `setups` makes the same values each time; the moves are read
    /// from their beginning.
    ///
    /// # Errors
    /// As [`VcdReader::play`].
    pub fn check_slice<'s>(
        &self,
        setups: impl Fn() -> Setup<'s>,
        number: u64,
        count: u64,
    ) -> Result<Slice, TraceError> {
        let Beginning { origin_ps, settled } = self.beginning(Checker::new(setups()))?;
        let mut crossings = Checker::new(Setup { courses: None, ..setups() });
        crossings.set_origin_ps(origin_ps);
        let mut cut = |number: u64| match number {
            0 => Ok(None),
            _ if number >= count => Ok(None),
            _ => {
                let place = u128::from(self.bytes) * u128::from(number) / u128::from(count);
                self.cut(settled.max(place as u64), |ps| crossings.is_near(ps))
            }
        };
        let (from, to) = (cut(number - 1)?, cut(number)?);
        let begin = from.map_or(if number == 1 { 0 } else { self.bytes }, |cut| cut.byte);
        let to = to.map_or(self.bytes, |cut| cut.byte);
        let mut checker = Checker::new(setups());
        let mut levels = None;
        if let Some(cut) = from {
            let known = self.levels_before(cut)?;
            checker.begin_at(cut.ps, origin_ps, &known);
            levels = Some(known);
        }
        let mut end_ps = 0;
        if begin < to {
            let (played, checked) =
                go_on_beside(checker, |sink| self.play(begin..to, levels, sink));
            (end_ps, checker) = (played?.end_ps, checked);
        }
        let capture = self.fingerprint()?;
        Ok(Slice {
            number,
            count,
            capture,
            from: begin,
            from_ps: from.map(|cut| cut.ps),
            to,
            end_ps,
            part: checker.into_part(),
        })
    }

    /// The first cut at a place or after it, if possible not near a crossing.
    fn cut(&self, from: u64, is_near: impl FnMut(u64) -> bool) -> Result<Option<Cut>, TraceError> {
        let from = from.max(1);
        let unit = self.open()?.into_header().unit;
        vcd_cut::find(self.bytes(from - 1..self.bytes)?, from, unit, is_near).map_err(read)
    }

    /// Appends the slices, which must be all and in order.
    ///
    /// # Errors
    /// A slice is of another capture or does not follow the one before it; or as
    /// [`VcdReader::play`], if a slice has to be checked again.
    pub fn merge(&self, setup: Setup<'_>, slices: &[Slice]) -> Result<Merged, TraceError> {
        let mut checker = Checker::new(setup);
        let (mut place, mut end_ps, mut again) = (0, 0, Vec::new());
        let capture = self.fingerprint()?;
        for slice in slices {
            let Slice { number, from, to, .. } = *slice;
            if slice.capture != capture {
                return Err(TraceError::OtherCapture { number });
            }
            if from != place || to < from || to > self.bytes {
                return Err(TraceError::NotInOrder { number });
            }
            if from == to {
                continue;
            }
            if let Some(to) = slice.from_ps.filter(|&ps| ps < end_ps) {
                return Err(TraceError::TimeBackwards { number, from: end_ps, to });
            }
            if !checker.append(&slice.part) {
                let levels = (from > 0).then(|| checker.levels());
                let (played, checked) =
                    go_on_beside(checker, |sink| self.play(from..to, levels, sink));
                played?;
                checker = checked;
                again.push(number);
            }
            (place, end_ps) = (to, slice.end_ps);
        }
        if place != self.bytes {
            return Err(TraceError::NotInOrder { number: slices.len() as u64 });
        }
        Ok(Merged { report: checker.finish(), end_ps, again })
    }

    /// Plays the bytes of a slice. `levels` are those at its beginning; `None` if it begins where
    /// the capture begins.
    fn play(
        &self,
        range: Range<u64>,
        levels: Option<Levels>,
        mut sink: &mut dyn PinSink,
    ) -> Result<Played, TraceError> {
        let is_last = range.end == self.bytes;
        let Some(levels) = levels else {
            let reader = self.reader(range.end)?;
            let must_end = is_last && reader.own().is_some();
            return reader.playing(&mut sink, must_end).play_out();
        };
        let header = self.open()?.into_header();
        let must_end = is_last && header.own.is_some();
        let levels = levels.into_iter().flat_map(|(step, dir)| [Some(step), dir]).collect();
        let player = Player::within(&mut sink, levels);
        let bytes = Box::new(self.bytes(range.clone())?);
        let played = Playing::new(parser(bytes), header, player, must_end).play_out();
        match played {
            Err(TraceError::Read(error)) => {
                // Lines are counted from the start of the capture, but only if one is named.
                let before = vcd_cut::line_ends(self.bytes(0..range.start)?).map_err(read)?;
                Err(error.later(before).into())
            }
            other => other,
        }
    }

    /// The levels just before a cut, as far as the bytes before it tell them.
    fn levels_before(&self, cut: Cut) -> Result<Levels, TraceError> {
        let before = self.cut(cut.byte.saturating_sub(BEFORE), |_| false)?;
        let from = before.map_or(cut.byte, |before| before.byte.min(cut.byte));
        let header = self.open()?.into_header();
        let mut nothing = Ignored;
        let player = Player::within(&mut nothing, vec![None; header.count]);
        let bytes = Box::new(self.bytes(from..cut.byte)?);
        let mut playing = Playing::new(parser(bytes), header, player, false);
        while playing.next()? {}
        let of = |pins: &[Option<bool>]| (pins[0].unwrap_or_default(), pins[1]);
        Ok(playing.player.levels().chunks_exact(2).map(of).collect())
    }

    /// Reads the capture until its first time is over and the origin is known.
    fn beginning(&self, checker: Checker<'_>) -> Result<Beginning, TraceError> {
        let known = Cell::new(checker.origin_ps());
        let mut sink = OriginSink { checker, known: &known };
        let mut playing = self.open()?.playing(&mut sink, false);
        while playing.next()? && !(playing.player.is_settled() && known.get().is_some()) {}
        // The times after this line are later than the first.
        let lines = playing.line() - 1;
        let settled = vcd_cut::place_of_line(self.bytes(0..self.bytes)?, lines).map_err(read)?;
        Ok(Beginning { origin_ps: known.get(), settled })
    }
}

/// The levels of STEP and DIR of each axis, that of DIR if it is known.
type Levels = Vec<(bool, Option<bool>)>;

/// What the beginning of a capture tells.
struct Beginning {
    /// The origin, or its estimate, ps; `None` if there is no pulse.
    origin_ps: Option<i64>,
    /// The place from which on all values are changes, bytes from the start of the file.
    settled: u64,
}

fn read(error: io::Error) -> TraceError {
    crate::error::ReadError::Io(error).into()
}

/// Estimates the origin from the first pulse.
struct OriginSink<'a, 'k> {
    checker: Checker<'a>,
    known: &'k Cell<Option<i64>>,
}

impl PinSink for OriginSink<'_, '_> {
    fn change(&mut self, change: PinChange) -> Result<(), TraceError> {
        let Checker { origin, axes, .. } = &mut self.checker;
        origin.estimate(change, |axis| axes.get(axis)?.first());
        self.known.set(origin.base_ps());
        Ok(())
    }
}

/// Discards everything.
struct Ignored;

impl PinSink for Ignored {
    fn change(&mut self, _: PinChange) -> Result<(), TraceError> {
        Ok(())
    }
}
