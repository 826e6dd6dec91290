//! What the header of a VCD tells, and the parser of its words.

use crate::edge::OutputPins;
use crate::error::ReadError;
use crate::vcd_own::OwnCapture;
use std::collections::HashMap;
use std::io::{self, BufRead as _, BufReader, Chain, Read};
use vcd::{IdCode, ParseError, Parser, TimescaleUnit};

/// What the header of a VCD tells.
pub(crate) struct Header {
    pub(crate) unit: Unit,
    pub(crate) own: Option<OwnCapture>,
    /// The pins that each signal carries: the bit, counted from the least significant, and the
    /// pin's slot (2 x axis for STEP, 2 x axis + 1 for DIR, and behind all axes the outputs by
    /// their numbers, and the PWM).
    pub(crate) pins: HashMap<IdCode, Vec<(u32, usize)>>,
    /// The number of pins of axes.
    pub(crate) count: usize,
    /// The outputs that were found.
    pub(crate) outputs: OutputPins,
}

/// The file's unit of time as a fraction of ps.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Unit {
    numerator: u128,
    denominator: u128,
}

impl Unit {
    pub(crate) fn new(quantity: u32, unit: TimescaleUnit) -> Self {
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
    pub(crate) fn ps(self, time: u64) -> Option<u64> {
        let exact = u128::from(time).checked_mul(self.numerator)?;
        u64::try_from((exact + self.denominator / 2) / self.denominator).ok()
    }
}

/// A capture with a blank appended. Not every program ends its last line, and a token that is ended
/// by the end of the file is complete.
///
/// The buffer is behind the blank, because the parser reads byte by byte.
pub(crate) type Blanked<'a> = BufReader<Chain<Box<dyn Read + 'a>, &'static [u8]>>;

/// Bytes that are read at once.
const BUFFER: usize = 1 << 16;

/// A parser of these bytes.
pub(crate) fn parser<'a>(bytes: Box<dyn Read + 'a>) -> Parser<Blanked<'a>> {
    Parser::new(BufReader::with_capacity(BUFFER, bytes.chain(&b" "[..])))
}

/// Converts the parser's errors. A broken token at the very end of the file means that the file was
/// cut off.
pub(crate) fn sorted(
    error: io::Error,
    parser: &mut Parser<Blanked<'_>>,
    missing: &'static str,
) -> ReadError {
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
pub(crate) fn at_end(parser: &mut Parser<Blanked<'_>>) -> bool {
    parser.reader().fill_buf().is_ok_and(<[u8]>::is_empty)
}
