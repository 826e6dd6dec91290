//! Reads the header of any VCD, from carrystep, another simulator or a logic analyser, and finds its
//! pins.

use crate::edge::{OutputPins, PinSink};
use crate::error::{ReadError, TraceError};
use crate::signal_map::{Signal, SignalMap};
use crate::vcd_header::{Blanked, Header, Unit, parser, sorted};
use crate::vcd_own::OwnCapture;
use crate::vcd_play::{PWM_SLOT, Played, Player, Playing};
use std::collections::HashMap;
use std::fmt;
use std::io::Read;
use vcd::{Command, IdCode, Parser};

/// The greatest depth of nested scopes; no real design is nested more deeply.
const MAX_DEPTH: usize = 256;

/// A VCD whose header has been read and whose pins have been found.
pub struct VcdReader<'a> {
    parser: Parser<Blanked<'a>>,
    header: Header,
}

impl fmt::Debug for VcdReader<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("VcdReader")
            .field("own", &self.header.own)
            .field("pins", &self.header.pins)
            .finish_non_exhaustive()
    }
}

impl<'a> VcdReader<'a> {
    /// Reads the header and finds STEP and DIR of every axis.
    ///
    /// # Errors
    /// A [`ReadError`] if the file is not a VCD, ends in its header, has no unit of time, lacks a
    /// signal, or shows only a part of a run.
    pub fn new(reader: impl Read + 'a, axes: &[&str], map: &SignalMap) -> Result<Self, ReadError> {
        Self::with_outputs(reader, axes, map, OutputPins::default())
    }

    /// The same, and finds those of these outputs that the capture shows.
    ///
    /// # Errors
    /// As [`VcdReader::new`].
    pub fn with_outputs(
        reader: impl Read + 'a,
        axes: &[&str],
        map: &SignalMap,
        outputs: OutputPins,
    ) -> Result<Self, ReadError> {
        Self::boxed(Box::new(reader), axes, map, outputs)
    }

    /// The same without a parameter, so that all of it is compiled with this crate.
    fn boxed(
        reader: Box<dyn Read + 'a>,
        axes: &[&str],
        map: &SignalMap,
        outputs: OutputPins,
    ) -> Result<Self, ReadError> {
        const MISSING: &str = "the header has no end";
        let mut parser = parser(reader);
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
        let count = 2 * axes.len();
        let mut found = OutputPins::default();
        for (number, source) in map.resolve_outputs(&signals, outputs.outputs)? {
            let slot = count + usize::from(number);
            pins.entry(source.code).or_default().push((source.place, slot));
            found.outputs |= 1 << number;
        }
        if let Some(source) = map.resolve_pwm(&signals, outputs.pwm)? {
            pins.entry(source.code).or_default().push((source.place, count + PWM_SLOT));
            found.pwm = true;
        }
        Ok(Self { parser, header: Header { unit, own, pins, count, outputs: found } })
    }

    /// The outputs that the capture shows.
    pub fn outputs(&self) -> OutputPins {
        self.header.outputs
    }

    /// The header of a capture by carrystep; `None` for a foreign capture.
    pub fn own(&self) -> Option<OwnCapture> {
        self.header.own
    }

    /// Plays the whole capture into a sink.
    ///
    /// The values at the first time are initial levels and not edges. A pin without an initial
    /// level is low.
    ///
    /// # Errors
    /// [`TraceError::Read`] if the file is broken, cut off or goes back in time; any other
    /// [`TraceError`] if the sink cannot write.
    pub fn play(self, sink: &mut dyn PinSink) -> Result<Played, TraceError> {
        let must_end = self.header.own.is_some();
        self.playing(sink, must_end).play_out()
    }

    /// Begins to play. A capture that `must_end` is refused if its last line is missing.
    pub(crate) fn playing<'s>(self, sink: &'s mut dyn PinSink, must_end: bool) -> Playing<'a, 's> {
        let player = Player::new(sink, self.header.count);
        Playing::new(self.parser, self.header, player, must_end)
    }

    /// The header alone.
    pub(crate) fn into_header(self) -> Header {
        self.header
    }
}
