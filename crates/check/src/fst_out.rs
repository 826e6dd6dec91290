//! Writes the waveform as FST, which GTKWave opens quickly however long it is.
//!
//! `waves.rs` decides what is written and when; this file only holds the file format.

use crate::edge::PinSink;
use crate::vcd_own::OwnCapture;
use crate::wave_format::{Format, MILLION, SCOPE, SIGNALS, VERSION};
use crate::waves::{WaveWriter, Waves};
use fst_writer::{
    FstBodyWriter, FstFileType, FstHeaderWriter, FstInfo, FstScopeType, FstSignalId, FstSignalType,
    FstVarDirection, FstVarType, FstWriteError,
};
use std::io::{self, Seek, Write};

/// Changes are kept in memory up to this many bytes and then written as a block.
const BLOCK: usize = 1 << 20;

/// Returns a writer of an FST, which writes the header with the first change.
pub fn fst_writer<'a>(out: impl Write + Seek + 'a, waves: Waves<'a>) -> Box<dyn PinSink + 'a> {
    boxed(Box::new(out), waves)
}

/// The same without a parameter, so that all of it is compiled with this crate.
fn boxed<'a>(out: Box<dyn Output + 'a>, waves: Waves<'a>) -> Box<dyn PinSink + 'a> {
    Box::new(WaveWriter::new(FstFormat(State::New(out)), waves))
}

/// A file that can be written anywhere.
trait Output: Write + Seek {}

impl<W: Write + Seek> Output for W {}

/// An FST file that is being written.
struct FstFormat<'a>(State<'a>);

enum State<'a> {
    New(Box<dyn Output + 'a>),
    Body(Box<FstBodyWriter<Box<dyn Output + 'a>>>),
    /// The file is complete, or writing has failed.
    Over,
}

/// Converts an error of the library; an error of the system is passed on unchanged.
fn told(error: FstWriteError) -> io::Error {
    match error {
        FstWriteError::Io(error) => error,
        other => io::Error::other(other),
    }
}

impl<'a> FstFormat<'a> {
    fn body(&mut self) -> io::Result<&mut FstBodyWriter<Box<dyn Output + 'a>>> {
        match &mut self.0 {
            State::Body(body) => Ok(body),
            State::New(_) | State::Over => Err(io::Error::other("nothing is declared")),
        }
    }
}

impl Format for FstFormat<'_> {
    type Id = FstSignalId;
    const NAME: &'static str = "the FST";

    fn declare(
        &mut self,
        own: &OwnCapture,
        axes: &[&str],
    ) -> io::Result<Vec<[FstSignalId; SIGNALS.len()]>> {
        let State::New(out) = std::mem::replace(&mut self.0, State::Over) else {
            return Err(io::Error::other("declared twice"));
        };
        let info = FstInfo {
            start_time: 0,
            timescale_exponent: -12,
            version: format!("{VERSION}: {own}"),
            // The date is left empty, so that the same run gives the same file.
            date: String::new(),
            file_type: FstFileType::Verilog,
        };
        let mut header = FstHeaderWriter::new(out, &info).map_err(told)?;
        header.scope(SCOPE, "", FstScopeType::Module).map_err(told)?;
        let mut all = Vec::new();
        for axis in axes {
            header.scope(axis, "", FstScopeType::Module).map_err(told)?;
            let mut ids = Vec::new();
            for (name, bits) in SIGNALS {
                let (name, signal, kind) = match bits {
                    0 => (name.to_owned(), FstSignalType::real(), FstVarType::Real),
                    1 => (name.to_owned(), FstSignalType::bit_vec(1), FstVarType::Wire),
                    _ => (
                        format!("{name} [{}:0]", bits - 1),
                        FstSignalType::bit_vec(bits),
                        FstVarType::Wire,
                    ),
                };
                ids.push(
                    header.var(name, signal, kind, FstVarDirection::Output, None).map_err(told)?,
                );
            }
            header.up_scope().map_err(told)?;
            all.extend(<[FstSignalId; SIGNALS.len()]>::try_from(ids));
        }
        header.up_scope().map_err(told)?;
        let mut body = header.finish().map_err(told)?;
        // A viewer that interpolates needs both ends of a level, so repeated values are kept.
        body.set_deduplicate(false);
        self.0 = State::Body(Box::new(body));
        Ok(all)
    }

    fn initial(
        &mut self,
        ps: u64,
        values: impl FnOnce(&mut Self) -> io::Result<()>,
    ) -> io::Result<()> {
        // A block begins with the values that are written before its first time, and the first one
        // begins at 0. Before a window the values are unknown.
        if ps > 0 {
            self.time(ps)?;
            return values(self);
        }
        values(self)?;
        self.time(ps)
    }

    fn time(&mut self, ps: u64) -> io::Result<()> {
        let body = self.body()?;
        if body.size() > BLOCK {
            body.flush().map_err(told)?;
        }
        body.time_change(ps).map_err(told)
    }

    fn bit(&mut self, id: FstSignalId, level: bool) -> io::Result<()> {
        self.body()?.signal_change(id, if level { b"1" } else { b"0" }).map_err(told)
    }

    fn vector(&mut self, id: FstSignalId, value: u64, bits: u32) -> io::Result<()> {
        let mut text = [b'0'; u64::BITS as usize];
        let text = &mut text[..bits as usize];
        for (bit, digit) in text.iter_mut().rev().enumerate() {
            *digit = b'0' + (value >> bit & 1) as u8;
        }
        self.body()?.signal_change(id, text).map_err(told)
    }

    fn real(&mut self, id: FstSignalId, millionths: f64) -> io::Result<()> {
        let value = millionths / MILLION;
        self.body()?.signal_change(id, &value.to_le_bytes()).map_err(told)
    }

    fn end(&mut self) -> io::Result<()> {
        let State::Body(body) = std::mem::replace(&mut self.0, State::Over) else {
            return Err(io::Error::other("nothing is declared"));
        };
        (*body).finish().map_err(told)?.flush()
    }
}
