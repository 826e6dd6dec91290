//! Writes the waveform as VCD.
//!
//! `waves.rs` decides what is written and when; this file only holds the file format. The library
//! writes the header. The lines of values, of which there are millions, are put together here,
//! because the library formats them bit by bit and character by character.

use crate::edge::PinSink;
use crate::ideal::rounded;
use crate::vcd_own::{self, OwnCapture};
use crate::wave_format::{Format, SCOPE, SIGNALS, VERSION};
use crate::waves::{WaveWriter, Waves};
use std::io::{self, BufWriter, Write};
use vcd::{IdCode, ReferenceIndex, SimulationCommand, TimescaleUnit, VarType};

/// Bytes that are collected before they are written.
const BUFFER: usize = 1 << 16;

/// Returns a writer of a VCD, which writes the header with the first change.
pub fn vcd_writer<'a>(out: impl Write + 'a, waves: Waves<'a>) -> Box<dyn PinSink + 'a> {
    boxed(Box::new(out), waves)
}

/// The same without a parameter, so that all of it is compiled with this crate.
fn boxed<'a>(out: Box<dyn Write + 'a>, waves: Waves<'a>) -> Box<dyn PinSink + 'a> {
    let out = vcd::Writer::new(BufWriter::with_capacity(BUFFER, out));
    Box::new(WaveWriter::new(VcdFormat { out, line: Vec::new() }, waves))
}

/// A VCD file that is being written.
struct VcdFormat<'a> {
    out: vcd::Writer<BufWriter<Box<dyn Write + 'a>>>,
    /// The line that is being put together.
    line: Vec<u8>,
}

/// What stands behind a value: the identifier of its signal, and the end of the line.
#[derive(Clone, Copy)]
struct Tail {
    text: [u8; 8],
    length: usize,
}

impl Tail {
    fn of(id: IdCode) -> io::Result<Self> {
        let line = format!("{id}\n");
        let mut text = [0; 8];
        let place = text.get_mut(..line.len()).ok_or(io::ErrorKind::InvalidInput)?;
        place.copy_from_slice(line.as_bytes());
        Ok(Self { text, length: line.len() })
    }

    fn bytes(&self) -> &[u8] {
        &self.text[..self.length]
    }
}

impl VcdFormat<'_> {
    /// Ends the line and writes it.
    fn finish(&mut self, tail: &[u8]) -> io::Result<()> {
        self.line.extend_from_slice(tail);
        self.out.writer().write_all(&self.line)
    }
}

impl Format for VcdFormat<'_> {
    type Id = Tail;
    const NAME: &'static str = "the VCD";

    fn declare(
        &mut self,
        own: &OwnCapture,
        axes: &[&str],
    ) -> io::Result<Vec<[Tail; SIGNALS.len()]>> {
        let out = &mut self.out;
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
            let tails = ids.map(Tail::of).into_iter().collect::<io::Result<Vec<_>>>()?;
            all.extend(<[Tail; SIGNALS.len()]>::try_from(tails));
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
        self.time(ps)?;
        self.out.begin(SimulationCommand::Dumpvars)?;
        values(self)?;
        self.out.end()
    }

    fn time(&mut self, ps: u64) -> io::Result<()> {
        self.line.clear();
        self.line.push(b'#');
        self.line.extend_from_slice(itoa::Buffer::new().format(ps).as_bytes());
        self.finish(b"\n")
    }

    fn bit(&mut self, id: Tail, level: bool) -> io::Result<()> {
        self.line.clear();
        self.line.push(b'0' + u8::from(level));
        self.finish(id.bytes())
    }

    /// Writes the value without its leading zeros, which every reader restores.
    fn vector(&mut self, id: Tail, value: u64, _: u32) -> io::Result<()> {
        self.line.clear();
        self.line.push(b'b');
        let shown = (u64::BITS - value.leading_zeros()).max(1) as usize;
        let digits = value.to_be_bytes().map(|byte| BINARY[usize::from(byte)]);
        let digits = digits.as_flattened();
        self.line.extend_from_slice(&digits[digits.len() - shown..]);
        self.line.push(b' ');
        self.finish(id.bytes())
    }

    fn real(&mut self, id: Tail, value: f64) -> io::Result<()> {
        self.line.clear();
        self.line.push(b'r');
        decimal(&mut self.line, value)?;
        self.line.push(b' ');
        self.finish(id.bytes())
    }

    fn end(&mut self) -> io::Result<()> {
        self.out.comment(vcd_own::END)?;
        self.out.flush()
    }
}

/// The digits of every byte in binary.
const BINARY: [[u8; 8]; 256] = {
    let mut all = [[b'0'; 8]; 256];
    let mut byte = 0;
    while byte < all.len() {
        let mut bit = 0;
        while bit < 8 {
            all[byte][7 - bit] += (byte >> bit & 1) as u8;
            bit += 1;
        }
        byte += 1;
    }
    all
};

/// Writes a number with at most six decimals as the standard library does: the shortest text that
/// reads as this float. Up to 10^9 this is the whole number of millionths without trailing zeros.
fn decimal(line: &mut Vec<u8>, value: f64) -> io::Result<()> {
    const MILLION: u64 = 1_000_000;
    let millionths = rounded(value.abs() * MILLION as f64);
    let is_short = millionths < 1e15 && millionths / MILLION as f64 == value.abs();
    if !is_short {
        return write!(line, "{value}");
    }
    if value.is_sign_negative() {
        line.push(b'-');
    }
    let millionths = millionths as u64;
    let (whole, mut rest) = (millionths / MILLION, millionths % MILLION);
    line.extend_from_slice(itoa::Buffer::new().format(whole).as_bytes());
    if rest == 0 {
        return Ok(());
    }
    let mut digits = [b'.'; 7];
    for digit in digits[1..].iter_mut().rev() {
        *digit = b'0' + (rest % 10) as u8;
        rest /= 10;
    }
    let shown = digits.iter().rposition(|&digit| digit != b'0').unwrap_or(0);
    line.extend_from_slice(&digits[..=shown]);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn decimals_are_those_of_the_standard_library(
            whole in -9_999_999_999_999_999_i64..9_999_999_999_999_999,
            cut in 0_u32..16,
            any in any::<f64>(),
        ) {
            for value in [(whole / 10_i64.pow(cut)) as f64 / 1e6, any, whole as f64] {
                let mut line = Vec::new();
                decimal(&mut line, value).unwrap();
                prop_assert_eq!(String::from_utf8(line).unwrap(), value.to_string());
            }
        }
    }
}
