//! The tool table: number, offset and diameter of each tool, in the format of LinuxCNC.
//!
//! ```text
//! ;  tool  pocket  offsets           diameter
//!    T1    P1      Z12.5             D3.175    ; what follows a semicolon is a comment
//!    T2    P2      X0.1 Z-3 A5       D6
//! ```
//!
//! Lengths are in mm, as all of this machine. The pocket and the lathe's words I, J and Q are read
//! and mean nothing.

use crate::canon::{AXIS_LETTERS, Point};
use crate::error::{ErrorKind, Fault, GcodeError};
use crate::evaluate::whole;
use crate::frame::FURTHEST;
use crate::seal::Seal;
use crate::source::Source;
use std::collections::BTreeMap;
use std::io::{Read, Seek};
use std::path::Path;
use std::sync::Arc;

/// Greatest number of a tool.
pub(crate) const LAST_TOOL: u32 = 99_999;

/// The same in words, for messages.
pub(crate) const TOOL_RANGE: &str = "0 to 99999";

/// What a program can know of a tool.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Tool {
    /// How far the tool moves the controlled point: X, Y, Z in mm, A, B, C in degrees.
    pub offset: Point,
    /// Diameter in mm.
    pub diameter: f64,
}

/// The tools of a machine by their numbers.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ToolTable {
    tools: BTreeMap<u32, Tool>,
}

impl ToolTable {
    /// Reads a file.
    ///
    /// # Errors
    /// As [`ToolTable::read`], and if the file cannot be read.
    pub fn open(path: &Path) -> Result<Self, GcodeError> {
        let name: Arc<str> = path.display().to_string().into();
        match Seal::open(path) {
            Ok((file, _)) => Self::read(file, &name),
            Err(kind) => Err(GcodeError { file: name, line: 0, column: 0, kind }),
        }
    }

    /// Reads a table. `name` is the name of the file in errors.
    ///
    /// # Errors
    /// The first word that is malformed or unknown, a line without T, or a tool that occurs twice.
    pub fn read<R: Read + Seek>(input: R, name: &str) -> Result<Self, GcodeError> {
        let mut table = Self::default();
        let mut line = 0;
        match table.add_lines(input, &mut line) {
            Ok(()) => Ok(table),
            Err(Fault { column, kind, .. }) => {
                Err(GcodeError { file: name.into(), line, column, kind })
            }
        }
    }

    /// The tool of this number.
    pub fn get(&self, number: u32) -> Option<&Tool> {
        self.tools.get(&number)
    }

    /// Sets or adds a tool.
    pub fn set(&mut self, number: u32, tool: Tool) {
        self.tools.insert(number, tool);
    }

    /// All tools with their numbers, in the order of the numbers.
    pub fn iter(&self) -> impl Iterator<Item = (u32, &Tool)> {
        self.tools.iter().map(|(&number, tool)| (number, tool))
    }

    /// Adds all lines. `line` is the number of the last one that was read.
    fn add_lines<R: Read + Seek>(&mut self, input: R, line: &mut u64) -> Result<(), Fault> {
        let whole_line = |kind| Fault::new(0, kind);
        let mut source = Source::new(input).map_err(whole_line)?;
        loop {
            *line += 1;
            if !source.advance().map_err(whole_line)? {
                return Ok(());
            }
            self.add_line(source.line())?;
        }
    }

    fn add_line(&mut self, line: &[u8]) -> Result<(), Fault> {
        let text = line.split(|&byte| byte == b';').next().unwrap_or_default();
        let text = str::from_utf8(text).map_err(|error| {
            let at = error.valid_up_to();
            Fault::new(column(at), ErrorKind::NotText(text[at]))
        })?;
        let mut number = None;
        let mut tool = Tool::default();
        let mut seen = Vec::new();
        for (at, word) in words(text) {
            let fault = |kind| Fault::new(column(at), kind);
            let letter = word.chars().next().unwrap_or_default().to_ascii_lowercase();
            if !letter.is_ascii_alphabetic() {
                return Err(fault(unknown(word)));
            }
            let value = value(&word[1..]).map_err(fault)?;
            if seen.contains(&letter) {
                return Err(fault(ErrorKind::LetterTwice(letter.to_ascii_uppercase())));
            }
            seen.push(letter);
            match letter {
                't' => number = Some(tool_number(value).map_err(fault)?),
                'd' => tool.diameter = value,
                'p' | 'i' | 'j' | 'q' => {}
                // Axes that this machine does not have may be in the table, without an offset.
                'u' | 'v' | 'w' if value == 0.0 => {}
                letter => match AXIS_LETTERS.iter().position(|&axis| axis == letter) {
                    Some(axis) => tool.offset[axis] = value,
                    None => return Err(fault(unknown(word))),
                },
            }
        }
        match number {
            None if seen.is_empty() => Ok(()),
            None => {
                let kind = ErrorKind::Missing { code: "a tool".to_owned(), word: "T, its number" };
                Err(Fault::new(0, kind))
            }
            Some(number) if self.tools.insert(number, tool).is_some() => {
                Err(Fault::new(0, ErrorKind::ToolTwice(number)))
            }
            Some(_) => Ok(()),
        }
    }
}

/// The column of the character at this offset of an ASCII text.
fn column(offset: usize) -> u32 {
    u32::try_from(offset).unwrap_or(u32::MAX).saturating_add(1)
}

/// The words of a line with their offsets.
fn words(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let is_end = |c: char| c.is_whitespace();
    let offset = |word: &str| word.as_ptr().addr() - text.as_ptr().addr();
    text.split(is_end).filter(|word| !word.is_empty()).map(move |word| (offset(word), word))
}

fn value(digits: &str) -> Result<f64, ErrorKind> {
    let is_plain = digits.bytes().all(|c| c.is_ascii_digit() || matches!(c, b'.' | b'+' | b'-'));
    match digits.parse::<f64>() {
        Ok(value) if is_plain && value.abs() <= FURTHEST => Ok(value),
        Ok(_) if is_plain => Err(ErrorKind::Overflow),
        _ => Err(ErrorKind::BadNumber(digits.chars().take(20).collect())),
    }
}

fn tool_number(value: f64) -> Result<u32, ErrorKind> {
    match whole(value) {
        Some(number) if (0.0..=f64::from(LAST_TOOL)).contains(&number) => Ok(number as u32),
        Some(_) => Err(ErrorKind::OutOfRange { letter: 'T', value, range: TOOL_RANGE }),
        None => Err(ErrorKind::NotWhole { letter: 'T', value }),
    }
}

fn unknown(word: &str) -> ErrorKind {
    let expected = "a word of a tool table: T, P, D, or an offset of X, Y, Z, A, B or C";
    ErrorKind::Unexpected {
        expected,
        found: format!("`{}`", word.chars().take(20).collect::<String>()),
    }
}
