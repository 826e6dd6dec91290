//! Writes a VCD of pins, positions and outputs only, for a board whose moves are not known to the
//! writer, and for jobs.
//!
//! The names of the signals are those of `waves.rs`.

use crate::edge::{OutputPins, Pin, PinChange, PinSink};
use crate::error::TraceError;
use crate::vcd_own::{self, OwnCapture};
use crate::wave_format::{PWM, SCOPE, VERSION};
use std::fmt;
use std::io::{self, Write};
use vcd::{IdCode, ReferenceIndex, SimulationCommand, TimescaleUnit, VarType, Writer};

/// Width of a position, bits.
const BITS: u32 = 32;

/// Writes pins as they change, under the same names as [`VcdWriter`](crate::VcdWriter).
pub struct PinsVcd<W: Write> {
    out: Writer<W>,
    axes: Vec<Axis>,
    /// The output pins, each with its number and its level.
    outputs: Vec<(u8, IdCode, bool)>,
    pwm: Option<IdCode>,
    time: u64,
}

struct Axis {
    step: IdCode,
    dir: IdCode,
    position: IdCode,
    backward: bool,
    steps: i32,
}

impl<W: Write> fmt::Debug for PinsVcd<W> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("PinsVcd").field("time", &self.time).finish_non_exhaustive()
    }
}

impl<W: Write> PinsVcd<W> {
    /// Begins a capture of these axes, in the order of their numbers, and of these outputs. All pins
    /// are low and all positions 0.
    ///
    /// # Errors
    /// [`TraceError::Write`] if the file cannot be written.
    pub fn new<'n>(
        out: W,
        own: OwnCapture,
        names: impl Iterator<Item = &'n str>,
        outputs: OutputPins,
    ) -> Result<Self, TraceError> {
        Self::begin(Writer::new(out), own, names, outputs).map_err(failed)
    }

    fn begin<'n>(
        mut out: Writer<W>,
        own: OwnCapture,
        names: impl Iterator<Item = &'n str>,
        outputs: OutputPins,
    ) -> io::Result<Self> {
        out.version(VERSION)?;
        out.comment(&own.to_string())?;
        out.timescale(1, TimescaleUnit::PS)?;
        out.add_module(SCOPE)?;
        let mut axes = Vec::new();
        for name in names {
            out.add_module(name)?;
            let range = ReferenceIndex::Range(BITS as i32 - 1, 0);
            axes.push(Axis {
                step: out.add_wire(1, "step")?,
                dir: out.add_wire(1, "dir")?,
                position: out.add_var(VarType::Wire, BITS, "position", Some(range))?,
                backward: false,
                steps: 0,
            });
            out.upscope()?;
        }
        let exist = (0..8_u8).filter(|number| outputs.outputs >> number & 1 == 1);
        let has_pwm = outputs.pwm;
        let outputs = exist
            .map(|number| Ok((number, out.add_wire(1, &format!("output_{number}"))?, false)))
            .collect::<io::Result<Vec<_>>>()?;
        let pwm = has_pwm.then(|| out.add_wire(1, PWM)).transpose()?;
        out.upscope()?;
        out.enddefinitions()?;
        out.timestamp(0)?;
        out.begin(SimulationCommand::Dumpvars)?;
        for axis in &axes {
            out.change_scalar(axis.step, false)?;
            out.change_scalar(axis.dir, false)?;
            change_position(&mut out, axis)?;
        }
        for (_, code, level) in &outputs {
            out.change_scalar(*code, *level)?;
        }
        pwm.iter().try_for_each(|code| out.change_scalar(*code, false))?;
        out.end()?;
        Ok(Self { out, axes, outputs, pwm, time: 0 })
    }

    fn stamp(&mut self, ps: u64) -> io::Result<()> {
        if ps > self.time {
            self.out.timestamp(ps)?;
            self.time = ps;
        }
        Ok(())
    }

    fn write(&mut self, change: PinChange) -> io::Result<()> {
        self.stamp(change.ps)?;
        let Some(axis) = self.axes.get_mut(usize::from(change.axis)) else { return Ok(()) };
        match change.pin {
            Pin::Dir => {
                axis.backward = change.level;
                self.out.change_scalar(axis.dir, change.level)
            }
            Pin::Step => {
                self.out.change_scalar(axis.step, change.level)?;
                if !change.level {
                    return Ok(());
                }
                axis.steps = axis.steps.wrapping_add(if axis.backward { -1 } else { 1 });
                change_position(&mut self.out, axis)
            }
        }
    }

    fn write_outputs(&mut self, ps: u64, levels: u8) -> io::Result<()> {
        self.stamp(ps)?;
        for (number, code, level) in &mut self.outputs {
            let now = levels >> *number & 1 == 1;
            if std::mem::replace(level, now) != now {
                self.out.change_scalar(*code, now)?;
            }
        }
        Ok(())
    }

    fn write_pwm(&mut self, ps: u64, level: bool) -> io::Result<()> {
        let Some(code) = self.pwm else { return Ok(()) };
        self.stamp(ps)?;
        self.out.change_scalar(code, level)
    }

    fn close(&mut self, ps: u64) -> io::Result<()> {
        self.stamp(ps)?;
        self.out.comment(vcd_own::END)?;
        self.out.flush()
    }
}

fn change_position<W: Write>(out: &mut Writer<W>, axis: &Axis) -> io::Result<()> {
    let bits = (0..BITS).rev().map(|bit| (axis.steps >> bit & 1 == 1).into());
    out.change_vector(axis.position, bits)
}

fn failed(source: io::Error) -> TraceError {
    TraceError::Write { what: "the VCD", source }
}

impl<W: Write> PinSink for PinsVcd<W> {
    fn change(&mut self, change: PinChange) -> Result<(), TraceError> {
        self.write(change).map_err(failed)
    }

    fn outputs(&mut self, ps: u64, levels: u8) -> Result<(), TraceError> {
        self.write_outputs(ps, levels).map_err(failed)
    }

    fn pwm(&mut self, ps: u64, level: bool) -> Result<(), TraceError> {
        self.write_pwm(ps, level).map_err(failed)
    }

    fn end(&mut self, ps: u64) -> Result<(), TraceError> {
        self.close(ps).map_err(failed)
    }
}
