//! Writes the waveform as VCD.
//!
//! `waves.rs` decides what is written and when; this file only holds the file format. The library
//! writes the header. The lines of values, of which there are millions, are put together here,
//! because the library formats them bit by bit and character by character.

use crate::edge::PinSink;
use crate::vcd_own::{self, OwnCapture};
use crate::wave_format::{Format, MILLION, SCOPE, SIGNALS, VERSION};
use crate::waves::{WaveWriter, Waves};
use std::io::{self, BufWriter, Write};
use vcd::{IdCode, ReferenceIndex, SimulationCommand, TimescaleUnit, VarType};

/// Bytes of lines that are collected before they are written.
const BUFFER: usize = 1 << 16;
/// The longest line: a vector, which has 64 digits.
const LINE: usize = 128;

/// Returns a writer of a VCD, which writes the header with the first change.
pub fn vcd_writer<'a>(out: impl Write + 'a, waves: Waves<'a>) -> Box<dyn PinSink + 'a> {
    boxed(Box::new(out), waves)
}

/// The same without a parameter, so that all of it is compiled with this crate.
fn boxed<'a>(out: Box<dyn Write + 'a>, waves: Waves<'a>) -> Box<dyn PinSink + 'a> {
    let out = vcd::Writer::new(BufWriter::new(out));
    let lines = Vec::with_capacity(BUFFER + LINE);
    Box::new(WaveWriter::new(VcdFormat { out, lines }, waves))
}

/// A VCD file that is being written.
struct VcdFormat<'a> {
    out: vcd::Writer<BufWriter<Box<dyn Write + 'a>>>,
    /// Lines of values that have not been given to `out`.
    lines: Vec<u8>,
}

/// What stands behind a value: the identifier of its signal, and the end of the line.
#[derive(Clone, Copy)]
struct Tail {
    text: [u8; 8],
    length: usize,
}

/// The end of a line without a signal.
const NO_SIGNAL: Tail = Tail { text: *b"\n       ", length: 1 };

/// Adds the first `length` of these bytes. A copy of constant length takes a fraction of the time.
fn add<const N: usize>(lines: &mut Vec<u8>, text: &[u8; N], length: usize) {
    let end = lines.len() + length;
    lines.extend_from_slice(text);
    lines.truncate(end);
}

impl Tail {
    fn of(id: IdCode) -> io::Result<Self> {
        let line = format!("{id}\n");
        let mut text = [0; 8];
        let place = text.get_mut(..line.len()).ok_or(io::ErrorKind::InvalidInput)?;
        place.copy_from_slice(line.as_bytes());
        Ok(Self { text, length: line.len() })
    }
}

impl VcdFormat<'_> {
    /// Ends the line.
    fn finish(&mut self, tail: &Tail) -> io::Result<()> {
        add(&mut self.lines, &tail.text, tail.length);
        if self.lines.len() < BUFFER {
            return Ok(());
        }
        self.flush()
    }

    /// Gives all lines to `out`.
    #[cold]
    fn flush(&mut self) -> io::Result<()> {
        self.out.writer().write_all(&self.lines)?;
        self.lines.clear();
        Ok(())
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
        self.flush()?;
        self.out.begin(SimulationCommand::Dumpvars)?;
        values(self)?;
        self.flush()?;
        self.out.end()
    }

    fn time(&mut self, ps: u64) -> io::Result<()> {
        self.lines.push(b'#');
        self.lines.extend_from_slice(itoa::Buffer::new().format(ps).as_bytes());
        self.finish(&NO_SIGNAL)
    }

    fn bit(&mut self, id: Tail, level: bool) -> io::Result<()> {
        self.lines.push(b'0' + u8::from(level));
        self.finish(&id)
    }

    /// Writes the value without its leading zeros, which every reader restores.
    fn vector(&mut self, id: Tail, value: u64, _: u32) -> io::Result<()> {
        self.lines.push(b'b');
        // 0 has one digit.
        let hidden = value.leading_zeros().min(u64::BITS - 1);
        let mut digits = [0; u64::BITS as usize];
        for (digits, byte) in digits.chunks_exact_mut(8).zip((value << hidden).to_be_bytes()) {
            digits.copy_from_slice(&BINARY[usize::from(byte)]);
        }
        add(&mut self.lines, &digits, (u64::BITS - hidden) as usize);
        self.lines.push(b' ');
        self.finish(&id)
    }

    fn real(&mut self, id: Tail, millionths: f64) -> io::Result<()> {
        self.lines.push(b'r');
        decimal(&mut self.lines, millionths)?;
        self.lines.push(b' ');
        self.finish(&id)
    }

    fn end(&mut self) -> io::Result<()> {
        self.flush()?;
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

/// Writes a whole number of millionths as the standard library writes the quotient: the shortest text
/// that reads as this float. Up to 10^9 this is the number without trailing zeros.
fn decimal(line: &mut Vec<u8>, millionths: f64) -> io::Result<()> {
    const ONE: u64 = MILLION as u64;
    if millionths.abs() >= 1e15 {
        return write!(line, "{}", millionths / MILLION);
    }
    if millionths < 0.0 {
        line.push(b'-');
    }
    let (whole, rest) = (millionths.abs() as u64 / ONE, millionths.abs() as u64 % ONE);
    let mut digits = itoa::Buffer::new();
    line.extend_from_slice(digits.format(whole).as_bytes());
    // The digit 1 before the six decimals keeps their leading zeros; the point replaces it.
    if let Some(decimals) = digits.format(ONE + rest).as_bytes().first_chunk::<7>()
        && let Some(last) = decimals[1..].iter().rposition(|&digit| digit != b'0')
    {
        let point = line.len();
        add(line, decimals, last + 2);
        line[point] = b'.';
    }
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
            let any = any.round() + 0.0;
            for millionths in [(whole / 10_i64.pow(cut)) as f64, any] {
                let mut line = Vec::new();
                decimal(&mut line, millionths).unwrap();
                prop_assert_eq!(
                    String::from_utf8(line).unwrap(),
                    (millionths / MILLION).to_string()
                );
            }
        }
    }
}
