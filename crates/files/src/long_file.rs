//! Reads the moves of a long move file one by one, as often as they are asked for.
//!
//! ```text
//!  machine_file = "m.toml"    the head: everything before the first move, read once
//!  [[move]]                   a part: from this line to the line before the next [[move]]
//!  to = { x = 1 }
//!  [[move]]                   the next part
//! ```
//!
//! A line that begins a table is told from a line within a text or a list by the brackets and
//! quotation marks before it; the parser of TOML then reads each part on its own.

use crate::error::{InputError, SourceText};
use crate::input::{self, MAX_TEXT_BYTES};
use crate::machine::Machine;
use crate::move_file::{Move, MovePlace, RawMoveFile, RawMoves, Targets};
use crate::toml_lines::{Line, LineFault, TableHead, TomlLines};
use std::fs::File;
use std::io::{self, BufReader};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::SystemTime;

/// A long move file.
#[derive(Debug, Clone)]
pub(crate) struct LongFile {
    path: PathBuf,
    state: FileState,
}

/// What changes when a file is written: its length and the time of its last change.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct FileState(u64, Option<SystemTime>);

impl FileState {
    fn of(file: &File) -> io::Result<Self> {
        let there = file.metadata()?;
        Ok(Self(there.len(), there.modified().ok()))
    }
}

impl LongFile {
    /// Opens a file, and reads its head. The result has the machine, or, if the file has no
    /// `[[move]]`, its whole text.
    ///
    /// # Errors
    /// [`InputError`] if the file cannot be read, or at the first mistake of the head.
    pub(crate) fn open(path: &Path) -> Result<(Self, Result<Machine, SourceText>), InputError> {
        let file = input::open(path).map_err(|error| InputError::new(error.to_string()))?;
        let state = FileState::of(&file).map_err(|error| unreadable(path, &error))?;
        let long = Self { path: path.to_owned(), state };
        let mut parts = long.parts(file);
        let Some(Part { text, .. }) = parts.next_part()? else {
            return Ok((long, Err(SourceText { path: path.to_owned(), text: "".into() })));
        };
        let is_all = parts.line.is_none();
        let first = parts.line.map_or(String::new(), |line| line.text);
        // An error of the last line shows the line after it too, but this is not parsed.
        let source = SourceText { path: path.to_owned(), text: (text.clone() + &first).into() };
        if is_all {
            return Ok((long, Err(source)));
        }
        let raw: RawMoveFile = source.parse_as(&text)?;
        if let Some(entry) = raw.moves.first() {
            let message = "a long file has each of its moves in a [[move]] table";
            return Err(InputError::at(&source, entry.span(), message));
        }
        let (machine, _) = raw.machine(&source)?;
        Ok((long, Ok(machine)))
    }

    /// The moves, from the first one on.
    ///
    /// # Errors
    /// [`InputError`] if the file cannot be opened any more.
    pub(crate) fn moves(&self, machine: &Machine) -> Result<LongMoves, InputError> {
        let failed = |error| unreadable(&self.path, &error);
        let file = File::open(&self.path).map_err(failed)?;
        let mut moves = LongMoves {
            parts: self.parts(file),
            file: self.clone(),
            targets: Targets::new(machine),
            machine: machine.clone(),
            is_over: false,
        };
        moves.unchanged()?;
        // The head was read when the file was opened.
        moves.parts.next_part()?;
        Ok(moves)
    }

    fn parts(&self, file: File) -> Parts {
        Parts {
            path: self.path.clone(),
            lines: TomlLines::new(BufReader::with_capacity(1 << 16, file)),
            line: None,
            before: String::new(),
            read: 0,
            begun: false,
        }
    }
}

fn unreadable(path: &Path, error: &io::Error) -> InputError {
    InputError::new(format!("cannot read {}: {error}", path.display()))
}

/// Reads the moves of a long file in order, and checks each.
#[derive(Debug)]
pub(crate) struct LongMoves {
    file: LongFile,
    parts: Parts,
    machine: Machine,
    targets: Targets,
    is_over: bool,
}

impl LongMoves {
    /// Checks that the file is the one that was opened first.
    fn unchanged(&self) -> Result<(), InputError> {
        let path = &self.file.path;
        let now = File::open(path).and_then(|file| FileState::of(&file));
        if now.map_err(|error| unreadable(path, &error))? == self.file.state {
            return Ok(());
        }
        let message = format!("{} has changed while it was read", path.display());
        Err(InputError::new(message).help("leave the file alone until the command has ended"))
    }

    fn read(&mut self) -> Result<Option<Move>, InputError> {
        let Some(part) = self.parts.next_part()? else {
            self.unchanged()?;
            return Ok(None);
        };
        let lines_before = part.lines_before();
        let at = |error| InputError { lines_before, ..error };
        let after = self.parts.line.as_ref().map_or("", |line| &line.text);
        let (source, parsed) = part.source(&self.file.path, after);
        let raw: RawMoves = source.parse_as(&parsed).map_err(at)?;
        let Some(entry) = raw.moves.into_iter().next() else { return Ok(None) };
        let moved = self.targets.next(&source, &self.machine, entry).map_err(at)?;
        let MovePlace { text, span, .. } = moved.place;
        Ok(Some(Move { place: MovePlace { text, lines_before, span }, ..moved }))
    }
}

impl Iterator for LongMoves {
    type Item = Result<Move, InputError>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.is_over {
            return None;
        }
        let read = self.read().transpose();
        self.is_over = !matches!(read, Some(Ok(_)));
        read
    }
}

/// A part of the file: the head, or a move.
struct Part {
    /// The line before it.
    before: String,
    text: String,
    /// The number of its first line, from 1.
    first_line: usize,
}

impl Part {
    /// Number of lines of the file before the text that [`Self::source`] gives.
    fn lines_before(&self) -> usize {
        self.first_line - 1 - usize::from(!self.before.is_empty())
    }

    /// The text with the lines around it, for errors, and the text to parse. In that one, blanks
    /// stand in the place of the line before it, so that a place is the same in both.
    fn source(&self, path: &Path, after: &str) -> (SourceText, String) {
        let text: Arc<str> = [self.before.as_str(), &self.text, after].concat().into();
        let blanks = self.before.len().saturating_sub(1);
        let newline = if self.before.is_empty() { "" } else { "\n" };
        let parsed = " ".repeat(blanks) + newline + &self.text;
        (SourceText { path: path.to_owned(), text }, parsed)
    }
}

/// Goes through the parts of a file.
#[derive(Debug)]
struct Parts {
    path: PathBuf,
    lines: TomlLines<BufReader<File>>,
    /// The first line of the next part.
    line: Option<Line>,
    /// The last line of the last part.
    before: String,
    /// Number of lines that were read, with `line`.
    read: usize,
    /// Whether the head has been read.
    begun: bool,
}

impl Parts {
    /// The next part: the head, which may be empty, and then each move. `None` at the end.
    fn next_part(&mut self) -> Result<Option<Part>, InputError> {
        let is_head = !std::mem::replace(&mut self.begun, true);
        let mut text = match self.line.take() {
            Some(line) => line.text,
            None if is_head => String::new(),
            None => return Ok(None),
        };
        let first_line = if is_head { 1 } else { self.read };
        let before = std::mem::take(&mut self.before);
        let mut last = text.clone();
        while let Some(line) = self.lines.next_line().map_err(|fault| self.fault(&fault))? {
            self.read += 1;
            match line.head {
                Some(TableHead::Move) => {
                    self.line = Some(line);
                    break;
                }
                Some(TableHead::Other) if !is_head => return Err(self.stray(&line)),
                _ => {}
            }
            if text.len() + line.text.len() > MAX_TEXT_BYTES as usize {
                return Err(self.too_long(is_head, first_line));
            }
            text += &line.text;
            last = line.text;
        }
        self.before = last;
        Ok(Some(Part { before, text, first_line }))
    }

    fn fault(&self, fault: &LineFault) -> InputError {
        let (path, line) = (self.path.display(), self.read + 1);
        match fault {
            LineFault::Io(error) => unreadable(&self.path, error),
            LineFault::NotUtf8 { column } => {
                InputError::new(format!("{path}:{line}:{column}: not UTF-8"))
                    .help("a text file in TOML is expected")
            }
            LineFault::Long => InputError::new(format!(
                "{path}:{line}: the line has over {MAX_TEXT_BYTES} bytes ({} MiB)",
                MAX_TEXT_BYTES >> 20
            )),
        }
    }

    /// The error for a table between the moves.
    fn stray(&self, line: &Line) -> InputError {
        let source = SourceText { path: self.path.clone(), text: line.text.as_str().into() };
        let end = line.text.trim_end().len();
        let error =
            InputError::at(&source, 0..end, "in a long file the machine stands before the moves")
                .help("put this table before the first [[move]]");
        InputError { lines_before: self.read - 1, ..error }
    }

    fn too_long(&self, is_head: bool, first_line: usize) -> InputError {
        let what = if is_head { "what stands before the first [[move]]" } else { "this move" };
        InputError::new(format!(
            "{}:{first_line}: {what} has over {MAX_TEXT_BYTES} bytes ({} MiB)",
            self.path.display(),
            MAX_TEXT_BYTES >> 20
        ))
    }
}
