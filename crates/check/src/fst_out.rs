//! Writes the waveform as FST, which GTKWave opens quickly however long it is.
//!
//! `waves.rs` decides what is written and when; this file only holds the file format. The library
//! writes the names and kinds of the signals. Their changes, of which there are millions, are put
//! together in `fst_body.rs`.

use crate::edge::PinSink;
use crate::fst_body::{self, Body, Kind};
use crate::vcd_own::OwnCapture;
use crate::wave_format::{Format, MILLION, SCOPE, SIGNALS, VERSION};
use crate::waves::{WaveWriter, Waves};
use fst_writer::{
    FstFileType, FstHeaderWriter, FstInfo, FstScopeType, FstSignalType, FstVarDirection,
    FstVarType, FstWriteError,
};
use std::io::{self, Seek, SeekFrom, Write};

/// Where the header of the file has its last time.
const LAST_TIME: u64 = 17;
/// Where it has the number of blocks of value changes.
const BLOCKS: u64 = 65;

/// Returns a writer of an FST, which writes the header with the first change.
pub fn fst_writer<'a>(out: impl Write + Seek + 'a, waves: Waves<'a>) -> Box<dyn PinSink + 'a> {
    boxed(Box::new(out), waves)
}

/// The same without a parameter, so that all of it is compiled with this crate.
fn boxed<'a>(out: Box<dyn Output + 'a>, waves: Waves<'a>) -> Box<dyn PinSink + 'a> {
    Box::new(WaveWriter::new(FstFormat { out, body: Body::new([]) }, waves))
}

/// A file that can be written anywhere.
trait Output: Write + Seek {}

impl<W: Write + Seek> Output for W {}

/// An FST file that is being written.
struct FstFormat<'a> {
    out: Box<dyn Output + 'a>,
    /// Without signals until they are declared.
    body: Body,
}

/// Converts an error of the library; an error of the system is passed on unchanged.
fn told(error: FstWriteError) -> io::Error {
    match error {
        FstWriteError::Io(error) => error,
        other => io::Error::other(other),
    }
}

/// The part of a file of the library before its first block of value changes.
pub(crate) fn before_changes(mut file: Vec<u8>) -> Vec<u8> {
    let mut place = 0;
    while file.get(place).is_some_and(|&kind| kind != fst_body::CHANGES) {
        // The length counts its own eight bytes, and not that of the kind.
        let length = file.get(place + 1..place + 9).and_then(|bytes| bytes.try_into().ok());
        let length = usize::try_from(length.map_or(0, u64::from_be_bytes)).unwrap_or(0);
        place += 1 + length.max(8);
    }
    file.truncate(place);
    file
}

impl Format for FstFormat<'_> {
    type Id = usize;
    const NAME: &'static str = "the FST";

    fn declare(
        &mut self,
        own: &OwnCapture,
        axes: &[&str],
    ) -> io::Result<Vec<[usize; SIGNALS.len()]>> {
        let info = FstInfo {
            start_time: 0,
            timescale_exponent: -12,
            version: format!("{VERSION}: {own}"),
            // The date is left empty, so that the same run gives the same file.
            date: String::new(),
            file_type: FstFileType::Verilog,
        };
        let mut header = FstHeaderWriter::write_to_mem(&info).map_err(told)?;
        header.scope(SCOPE, "", FstScopeType::Module).map_err(told)?;
        let mut kinds = Vec::new();
        for axis in axes {
            header.scope(axis, "", FstScopeType::Module).map_err(told)?;
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
                kinds.push(if bits == 0 { Kind::Real } else { Kind::Bits(bits) });
                header.var(name, signal, kind, FstVarDirection::Output, None).map_err(told)?;
            }
            header.up_scope().map_err(told)?;
        }
        header.up_scope().map_err(told)?;
        let file = header.finish().and_then(|body| body.finish()).map_err(told)?;
        self.out.write_all(&before_changes(file.into_inner()))?;
        self.body = Body::new(kinds);
        let first = |axis| axis * SIGNALS.len();
        Ok((0..axes.len()).map(|axis| std::array::from_fn(|signal| first(axis) + signal)).collect())
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
        if self.body.is_full() {
            self.body.write_block(&mut self.out)?;
        }
        self.body.time(ps)
    }

    fn bit(&mut self, id: usize, level: bool) -> io::Result<()> {
        self.body.change(id, level.into())
    }

    fn vector(&mut self, id: usize, value: u64, _bits: u32) -> io::Result<()> {
        self.body.change(id, value)
    }

    fn real(&mut self, id: usize, millionths: f64) -> io::Result<()> {
        self.body.change(id, (millionths / MILLION).to_bits())
    }

    fn end(&mut self) -> io::Result<()> {
        self.body.write_block(&mut self.out)?;
        let (last_time, blocks) = self.body.end();
        for (place, number) in [(LAST_TIME, last_time), (BLOCKS, blocks)] {
            self.out.seek(SeekFrom::Start(place))?;
            self.out.write_all(&number.to_be_bytes())?;
        }
        self.out.flush()
    }
}
