//! Plays the values of a VCD into a sink, as levels and edges of pins.

use crate::edge::{Pin, PinChange, PinSink};
use crate::error::{ReadError, TraceError};
use crate::vcd_header::{Blanked, Header, at_end, sorted};
use crate::vcd_own;
use vcd::{Command, Parser, Value, Vector};

/// The slot of the PWM behind those of the axes, and behind those of eight outputs.
pub(crate) const PWM_SLOT: usize = 8;

/// Figures of a capture that has been played into a sink.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Played {
    /// The last time in the file, ps.
    pub end_ps: u64,
    /// Number of changes of pins of axes, and of times at which outputs change.
    pub changes: u64,
    /// How often a pin became unknown or floating (x, z) after its first level. The reader keeps
    /// the old level in this case.
    pub unknown: u64,
}

/// A capture, or a part of it, that is being played into a sink.
pub(crate) struct Playing<'a, 's> {
    parser: Parser<Blanked<'a>>,
    header: Header,
    pub(crate) player: Player<'s>,
    time: Option<u64>,
    /// Whether the capture may end here.
    may_end: bool,
}

impl<'a, 's> Playing<'a, 's> {
    /// A capture that `must_end` is refused if the last line of a capture by carrystep is missing.
    pub(crate) fn new(
        parser: Parser<Blanked<'a>>,
        header: Header,
        player: Player<'s>,
        must_end: bool,
    ) -> Self {
        Self { parser, header, player, time: None, may_end: !must_end }
    }

    /// Line of the capture, counted from 1.
    pub(crate) fn line(&self) -> u64 {
        self.parser.line()
    }

    /// Plays all of it.
    pub(crate) fn play_out(mut self) -> Result<Played, TraceError> {
        while self.next()? {}
        if self.may_end {
            return self.player.finish();
        }
        let missing = "the last line of a carrystep capture is missing";
        Err(ReadError::Truncated { line: self.line(), missing }.into())
    }

    /// Plays the next command; false if there is none.
    pub(crate) fn next(&mut self) -> Result<bool, TraceError> {
        const MISSING: &str = "a value or a time is incomplete";
        let command = self.parser.next();
        let line = self.parser.line();
        let Some(command) = command else { return Ok(false) };
        match command.map_err(|error| sorted(error, &mut self.parser, MISSING))? {
            Command::Timestamp(now) => {
                if let Some(from) = self.time.filter(|&from| now < from) {
                    if at_end(&mut self.parser) {
                        return Err(ReadError::Truncated { line, missing: MISSING }.into());
                    }
                    return Err(ReadError::TimeBackwards { line, from, to: now }.into());
                }
                self.time = Some(now);
                let ps = self.header.unit.ps(now);
                self.player.time(ps.ok_or(ReadError::TimeRange { line, time: now })?)?;
            }
            Command::ChangeScalar(code, value) => {
                for &(place, slot) in self.header.pins.get(&code).into_iter().flatten() {
                    self.player.value(slot, if place == 0 { value } else { Value::V0 })?;
                }
            }
            Command::ChangeVector(code, vector) => {
                for &(place, slot) in self.header.pins.get(&code).into_iter().flatten() {
                    self.player.value(slot, bit(&vector, place))?;
                }
            }
            Command::Comment(text) => self.may_end |= text == vcd_own::END,
            _ => {}
        }
        Ok(true)
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
pub(crate) struct Player<'s> {
    sink: &'s mut dyn PinSink,
    ps: Option<u64>,
    levels: Vec<Option<bool>>,
    /// The levels of the outputs, and those that the sink has.
    outputs: [u8; 2],
    /// The same of the PWM's pin.
    pwm: [bool; 2],
    /// The level that a STEP and a DIR have before their first value, if that is known.
    assumed: [Option<bool>; 2],
    /// Whether the first time is over, so that values are changes.
    settled: bool,
    changes: u64,
    unknown: u64,
}

impl<'s> Player<'s> {
    pub(crate) fn new(sink: &'s mut dyn PinSink, count: usize) -> Self {
        let (levels, assumed) = (vec![None; count], [Some(false); 2]);
        Self {
            sink,
            ps: None,
            levels,
            outputs: [0; 2],
            pwm: [false; 2],
            assumed,
            settled: false,
            changes: 0,
            unknown: 0,
        }
    }

    /// Begins in the middle of a capture, with the levels of STEP and DIR of each axis. A STEP that
    /// is not known is low; the first value of a DIR that is not known is a change.
    pub(crate) fn within(sink: &'s mut dyn PinSink, levels: Vec<Option<bool>>) -> Self {
        let assumed = [Some(false), None];
        Self { levels, assumed, settled: true, ..Self::new(sink, 0) }
    }

    /// The levels of STEP and DIR of each axis, as far as they are known.
    pub(crate) fn levels(&self) -> &[Option<bool>] {
        &self.levels
    }

    /// Whether the first time is over.
    pub(crate) fn is_settled(&self) -> bool {
        self.settled
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
        if self.ps.is_some_and(|before| ps > before) {
            self.switch()?;
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

    /// Gives the sink the levels of the outputs, all of one time together.
    fn switch(&mut self) -> Result<(), TraceError> {
        let (ps, [now, known]) = (self.ps.unwrap_or(0), &mut self.outputs);
        if std::mem::replace(known, *now) != *now {
            self.changes += 1;
            self.sink.outputs(ps, *now)?;
        }
        let [now, known] = &mut self.pwm;
        if std::mem::replace(known, *now) != *now {
            self.sink.pwm(ps, *now)?;
        }
        Ok(())
    }

    fn value(&mut self, slot: usize, value: Value) -> Result<(), TraceError> {
        if let Some(number) = slot.checked_sub(self.levels.len()) {
            let level = match value {
                Value::V0 => false,
                Value::V1 => true,
                // The old level stays, as for the other pins.
                Value::X | Value::Z => return Ok(()),
            };
            if number == PWM_SLOT {
                self.pwm[0] = level;
            } else {
                let bit = 1 << number;
                self.outputs[0] = (self.outputs[0] & !bit) | if level { bit } else { 0 };
            }
            return Ok(());
        }
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
        if old.or(self.assumed[slot % 2]) != Some(level) {
            self.changes += 1;
            self.sink.change(self.at(slot, level))?;
        }
        Ok(())
    }

    fn finish(mut self) -> Result<Played, TraceError> {
        self.settle()?;
        self.switch()?;
        let end_ps = self.ps.unwrap_or(0);
        self.sink.end(end_ps)?;
        Ok(Played { end_ps, changes: self.changes, unknown: self.unknown })
    }
}
