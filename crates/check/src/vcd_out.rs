//! Writes the waveform as VCD.
//!
//! `waves.rs` decides what is written and when; this file only holds the file format.

use crate::vcd_own::{self, OwnCapture};
use crate::wave_format::{Format, SCOPE, SIGNALS, VERSION};
use crate::waves::{WaveWriter, Waves};
use std::io::{self, Write};
use vcd::{IdCode, ReferenceIndex, SimulationCommand, TimescaleUnit, VarType};

/// A VCD file that is being written.
pub struct VcdFormat<W: Write>(vcd::Writer<W>);

/// Writes a VCD from a stream of pin changes.
pub type VcdWriter<'a, W> = WaveWriter<'a, VcdFormat<W>>;

impl<'a, W: Write> VcdWriter<'a, W> {
    /// A writer that has not written anything. It writes the header with the first change.
    pub fn new(out: W, waves: Waves<'a>) -> Self {
        Self::of(VcdFormat(vcd::Writer::new(out)), waves)
    }
}

impl<W: Write> Format for VcdFormat<W> {
    type Id = IdCode;
    const NAME: &'static str = "the VCD";

    fn declare(
        &mut self,
        own: &OwnCapture,
        axes: &[&str],
    ) -> io::Result<Vec<[IdCode; SIGNALS.len()]>> {
        let out = &mut self.0;
        out.version(VERSION)?;
        out.comment(&own.to_string())?;
        out.timescale(1, TimescaleUnit::PS)?;
        out.add_module(SCOPE)?;
        let mut all = Vec::new();
        for axis in axes {
            out.add_module(axis)?;
            let mut ids = [IdCode::FIRST; SIGNALS.len()];
            for (id, (name, bits)) in ids.iter_mut().zip(SIGNALS) {
                *id = match bits {
                    0 => out.add_var(VarType::Real, 64, name, None)?,
                    1 => out.add_wire(1, name)?,
                    // The range is a token of its own: the name must not contain brackets.
                    _ => {
                        let range = ReferenceIndex::Range(i32::try_from(bits - 1).unwrap_or(0), 0);
                        out.add_var(VarType::Wire, bits, name, Some(range))?
                    }
                };
            }
            out.upscope()?;
            all.push(ids);
        }
        out.upscope()?;
        out.enddefinitions()?;
        Ok(all)
    }

    fn initial(
        &mut self,
        ps: u64,
        values: impl FnOnce(&mut Self) -> io::Result<()>,
    ) -> io::Result<()> {
        self.0.timestamp(ps)?;
        self.0.begin(SimulationCommand::Dumpvars)?;
        values(self)?;
        self.0.end()
    }

    fn time(&mut self, ps: u64) -> io::Result<()> {
        self.0.timestamp(ps)
    }

    fn bit(&mut self, id: IdCode, level: bool) -> io::Result<()> {
        self.0.change_scalar(id, level)
    }

    /// Writes the value without its leading zeros, which every reader restores.
    fn vector(&mut self, id: IdCode, value: u64, _: u32) -> io::Result<()> {
        let shown = (u64::BITS - value.leading_zeros()).max(1) as usize;
        // The library formats a vector bit by bit, which took most of the time of writing a
        // waveform.
        let mut text = [b'b'; 1 + u64::BITS as usize];
        for (bit, digit) in text[1..=shown].iter_mut().rev().enumerate() {
            *digit = b'0' + (value >> bit & 1) as u8;
        }
        self.0.writer().write_all(&text[..=shown])?;
        writeln!(self.0.writer(), " {id}")
    }

    fn real(&mut self, id: IdCode, value: f64) -> io::Result<()> {
        self.0.change_real(id, value)
    }

    fn end(&mut self) -> io::Result<()> {
        self.0.comment(vcd_own::END)?;
        self.0.flush()
    }
}
