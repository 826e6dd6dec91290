//! Reads pin changes from any VCD: from carrystep, another simulator or a logic analyser.

use crate::edge::{Pin, PinChange, PinSink};
use crate::error::{ReadError, TraceError};
use crate::signal_map::{Signal, SignalMap};
use crate::vcd_own::{self, OwnCapture};
use std::collections::HashMap;
use std::fmt;
use std::io::{self, BufRead as _, BufReader, Chain, Read};
use vcd::{Command, IdCode, ParseError, Parser, TimescaleUnit, Value, Vector};

/// The greatest depth of nested scopes; no real design is nested more deeply.
const MAX_DEPTH: usize = 256;

/// A VCD whose header has been read and whose pins have been found.
pub struct VcdReader<'a> {
    parser: Parser<Blanked<'a>>,
    unit: Unit,
    own: Option<OwnCapture>,
    /// The pins that each signal carries: the bit, counted from the least significant, and the
    /// pin's slot (2 x axis for STEP, 2 x axis + 1 for DIR).
    pins: HashMap<IdCode, Vec<(u32, usize)>>,
    count: usize,
}

/// Figures of a capture that has been played into a sink.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Played {
    /// The last time in the file, ps.
    pub end_ps: u64,
    /// Number of pin changes.
    pub changes: u64,
    /// How often a pin became unknown or floating (x, z) after its first level. The reader keeps
    /// the old level in this case.
    pub unknown: u64,
}

/// The file's unit of time as a fraction of ps.
#[derive(Debug, Clone, Copy)]
struct Unit {
    numerator: u128,
    denominator: u128,
}

impl Unit {
    fn new(quantity: u32, unit: TimescaleUnit) -> Self {
        let (numerator, denominator) = match unit {
            TimescaleUnit::S => (1_000_000_000_000, 1),
            TimescaleUnit::MS => (1_000_000_000, 1),
            TimescaleUnit::US => (1_000_000, 1),
            TimescaleUnit::NS => (1000, 1),
            TimescaleUnit::PS => (1, 1),
            TimescaleUnit::FS => (1, 1000),
        };
        Self { numerator: numerator * u128::from(quantity), denominator }
    }

    /// A time of the file in ps, rounded to the nearest; `None` if it does not fit into 64 bits.
    fn ps(self, time: u64) -> Option<u64> {
        let exact = u128::from(time).checked_mul(self.numerator)?;
        u64::try_from((exact + self.denominator / 2) / self.denominator).ok()
    }
}

impl fmt::Debug for VcdReader<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("VcdReader")
            .field("own", &self.own)
            .field("pins", &self.pins)
            .finish_non_exhaustive()
    }
}

/// A capture with a blank appended. Not every program ends its last line, and a token that is ended
/// by the end of the file is complete.
///
/// The buffer is behind the blank, because the parser reads byte by byte.
type Blanked<'a> = BufReader<Chain<Box<dyn Read + 'a>, &'static [u8]>>;

/// Bytes that are read at once.
const BUFFER: usize = 1 << 16;

/// Converts the parser's errors. A broken token at the very end of the file means that the file was
/// cut off.
fn sorted(error: io::Error, parser: &mut Parser<Blanked<'_>>, missing: &'static str) -> ReadError {
    let line = parser.line();
    let Some(parse) = error.get_ref().and_then(|inner| inner.downcast_ref::<ParseError>()) else {
        let cut = error.kind() == io::ErrorKind::UnexpectedEof;
        return if cut { ReadError::Truncated { line, missing } } else { ReadError::Io(error) };
    };
    if at_end(parser) {
        return ReadError::Truncated { line, missing };
    }
    ReadError::Syntax { line: parse.line(), message: parse.kind().to_string() }
}

/// Whether the last token reached the very end of the file.
fn at_end(parser: &mut Parser<Blanked<'_>>) -> bool {
    parser.reader().fill_buf().is_ok_and(<[u8]>::is_empty)
}

impl<'a> VcdReader<'a> {
    /// Reads the header and finds STEP and DIR of every axis.
    ///
    /// # Errors
    /// A [`ReadError`] if the file is not a VCD, ends in its header, has no unit of time, lacks a
    /// signal, or shows only a part of a run.
    pub fn new(reader: impl Read + 'a, axes: &[&str], map: &SignalMap) -> Result<Self, ReadError> {
        Self::boxed(Box::new(reader), axes, map)
    }

    /// The same without a parameter, so that all of it is compiled with this crate.
    fn boxed(
        reader: Box<dyn Read + 'a>,
        axes: &[&str],
        map: &SignalMap,
    ) -> Result<Self, ReadError> {
        const MISSING: &str = "the header has no end";
        let blanked = reader.chain(&b" "[..]);
        let mut parser = Parser::new(BufReader::with_capacity(BUFFER, blanked));
        let mut scopes: Vec<String> = Vec::new();
        let mut signals = Vec::new();
        let mut unit = None;
        let mut own = None;
        loop {
            let command = parser.next();
            let line = parser.line();
            let Some(command) = command else {
                return Err(ReadError::Truncated { line, missing: MISSING });
            };
            match command.map_err(|error| sorted(error, &mut parser, MISSING))? {
                Command::Enddefinitions => break,
                Command::Comment(text) => own = own.or_else(|| OwnCapture::from_comment(&text)),
                Command::Timescale(quantity, _) if ![1, 10, 100].contains(&quantity) => {
                    return Err(ReadError::Timescale { line, quantity });
                }
                Command::Timescale(quantity, scale) => unit = Some(Unit::new(quantity, scale)),
                Command::ScopeDef(_, name) => {
                    scopes.push(name);
                    if scopes.len() > MAX_DEPTH {
                        return Err(ReadError::Depth { line, limit: MAX_DEPTH });
                    }
                }
                Command::Upscope => {
                    scopes.pop();
                }
                Command::VarDef(_, bits, code, name, index) => {
                    signals.push(Signal::new(&scopes, &name, index, code, bits));
                }
                Command::Date(_) | Command::Version(_) => {}
                _ => {
                    let message = "values before the end of the header".to_owned();
                    return Err(ReadError::Syntax { line, message });
                }
            }
        }
        if own.is_some_and(|own| own.is_part) {
            return Err(ReadError::Part);
        }
        let unit = unit.ok_or(ReadError::NoTimescale)?;
        let mut pins: HashMap<IdCode, Vec<(u32, usize)>> = HashMap::new();
        let sources = map.resolve(&signals, axes)?;
        for (slot, source) in sources.iter().flatten().enumerate() {
            pins.entry(source.code).or_default().push((source.place, slot));
        }
        Ok(Self { parser, unit, own, pins, count: 2 * axes.len() })
    }

    /// The header of a capture by carrystep; `None` for a foreign capture.
    pub fn own(&self) -> Option<OwnCapture> {
        self.own
    }

    /// Plays the whole capture into a sink.
    ///
    /// The values at the first time are initial levels and not edges. A pin without an initial
    /// level is low.
    ///
    /// # Errors
    /// [`TraceError::Read`] if the file is broken, cut off or goes back in time; any other
    /// [`TraceError`] if the sink cannot write.
    pub fn play(mut self, sink: &mut dyn PinSink) -> Result<Played, TraceError> {
        const MISSING: &str = "a value or a time is incomplete";
        let mut player = Player::new(sink, self.count);
        let mut time = None;
        let mut whole = self.own.is_none();
        loop {
            let command = self.parser.next();
            let line = self.parser.line();
            let Some(command) = command else {
                if !whole {
                    let missing = "the last line of a carrystep capture is missing";
                    return Err(ReadError::Truncated { line, missing }.into());
                }
                return player.finish();
            };
            match command.map_err(|error| sorted(error, &mut self.parser, MISSING))? {
                Command::Timestamp(now) => {
                    if let Some(from) = time.filter(|&from| now < from) {
                        if at_end(&mut self.parser) {
                            return Err(ReadError::Truncated { line, missing: MISSING }.into());
                        }
                        return Err(ReadError::TimeBackwards { line, from, to: now }.into());
                    }
                    time = Some(now);
                    player
                        .time(self.unit.ps(now).ok_or(ReadError::TimeRange { line, time: now })?)?;
                }
                Command::ChangeScalar(code, value) => {
                    for &(place, slot) in self.pins.get(&code).into_iter().flatten() {
                        player.value(slot, if place == 0 { value } else { Value::V0 })?;
                    }
                }
                Command::ChangeVector(code, vector) => {
                    for &(place, slot) in self.pins.get(&code).into_iter().flatten() {
                        player.value(slot, bit(&vector, place))?;
                    }
                }
                Command::Comment(text) => whole |= text == vcd_own::END,
                _ => {}
            }
        }
    }
}

/// The bit of a vector at a place counted from the least significant. The bits that a short vector
/// omits are 0, or x or z if its first bit is.
fn bit(vector: &Vector, place: u32) -> Value {
    let place = place as usize;
    match vector.len().checked_sub(place + 1) {
        Some(index) => vector.get(index).unwrap_or(Value::X),
        None => vector.get(0).filter(|&first| first != Value::V1).unwrap_or(Value::V0),
    }
}

/// Converts values of signals to levels and edges.
struct Player<'s> {
    sink: &'s mut dyn PinSink,
    ps: Option<u64>,
    levels: Vec<Option<bool>>,
    /// Whether the first time is over, so that values are changes.
    settled: bool,
    changes: u64,
    unknown: u64,
}

impl<'s> Player<'s> {
    fn new(sink: &'s mut dyn PinSink, count: usize) -> Self {
        Self { sink, ps: None, levels: vec![None; count], settled: false, changes: 0, unknown: 0 }
    }

    fn at(&self, slot: usize, level: bool) -> PinChange {
        let pin = if slot.is_multiple_of(2) { Pin::Step } else { Pin::Dir };
        PinChange { ps: self.ps.unwrap_or(0), axis: (slot / 2) as u8, pin, level }
    }

    fn time(&mut self, ps: u64) -> Result<(), TraceError> {
        let first = self.ps.unwrap_or(if self.levels.iter().any(Option::is_some) { 0 } else { ps });
        if ps > first {
            self.settle()?;
        }
        self.ps = Some(ps);
        Ok(())
    }

    fn settle(&mut self) -> Result<(), TraceError> {
        if !self.settled {
            self.settled = true;
            for slot in 0..self.levels.len() {
                if let Some(level) = self.levels[slot] {
                    self.sink.initial(self.at(slot, level))?;
                }
            }
        }
        Ok(())
    }

    fn value(&mut self, slot: usize, value: Value) -> Result<(), TraceError> {
        let level = match value {
            Value::V0 => false,
            Value::V1 => true,
            Value::X | Value::Z => {
                self.unknown += u64::from(self.levels[slot].is_some());
                return Ok(());
            }
        };
        let old = self.levels[slot].replace(level);
        if !self.settled {
            match old {
                // Of two different levels at the first time, the second one is an edge.
                Some(old) if old != level => {
                    self.levels[slot] = Some(old);
                    self.settle()?;
                    self.levels[slot] = Some(level);
                }
                _ => return Ok(()),
            }
        }
        if old.unwrap_or(false) != level {
            self.changes += 1;
            self.sink.change(self.at(slot, level))?;
        }
        Ok(())
    }

    fn finish(mut self) -> Result<Played, TraceError> {
        self.settle()?;
        let end_ps = self.ps.unwrap_or(0);
        self.sink.end(end_ps)?;
        Ok(Played { end_ps, changes: self.changes, unknown: self.unknown })
    }
}
