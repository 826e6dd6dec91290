//! The command's output: text on standard output, and files. A file appears under its name only
//! when it is complete.

use crate::colour;
use crate::document::{Document, Named};
use crate::failure::Failure;
use crate::interrupt;
use crate::json;
use carrystep_files::{NewFile, OutputClaim, OutputFailure};
use std::borrow::Cow;
use std::ffi::OsString;
use std::io::{BufWriter, ErrorKind, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

/// Prints text to standard output, with verdicts in colour where colours are wanted.
///
/// # Errors `Failure::ReaderGone` if the reader has closed the pipe; `Failure::Input` if the write
/// fails otherwise.
pub fn print(text: &str) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    let painted =
        if colour::wanted(&out) { Cow::Owned(colour::painted(text)) } else { Cow::Borrowed(text) };
    out.write_all(painted.as_bytes())
        .and_then(|()| out.flush())
        .map_err(|error| not_printed(&error))
}

/// Prints a part of a text as it is.
pub fn print_bytes(bytes: &[u8]) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    out.write_all(bytes).and_then(|()| out.flush()).map_err(|error| not_printed(&error))
}

/// The reason why standard output could not be written.
fn not_printed(error: &std::io::Error) -> Failure {
    match error.kind() {
        ErrorKind::BrokenPipe => Failure::ReaderGone,
        _ => Failure::input(format!("cannot write to standard output: {error}")),
    }
}

/// True if `--json` or `--json-lines` is one of the arguments.
static JSON_WANTED: AtomicBool = AtomicBool::new(false);
/// True if a document is a line.
static JSON_LINES: AtomicBool = AtomicBool::new(false);
/// True if a document was printed. Each run prints one document, also if it fails.
static JSON_PRINTED: AtomicBool = AtomicBool::new(false);

/// Looks for `--json` and `--json-lines` before the arguments are parsed, so that they also apply
/// to arguments that the parser refuses.
pub fn json_is_wanted(arguments: impl Iterator<Item = OsString>) {
    for argument in arguments.take_while(|argument| argument != "--") {
        let lines = argument == "--json-lines";
        JSON_LINES.fetch_or(lines, Ordering::Relaxed);
        JSON_WANTED.fetch_or(lines || argument == "--json", Ordering::Relaxed);
    }
}

/// True if a document is wanted and none has been printed yet.
pub fn lacks_json() -> bool {
    JSON_WANTED.load(Ordering::Relaxed) && !JSON_PRINTED.load(Ordering::Relaxed)
}

/// Prints the JSON document of a run, preceded by the name and the version of its schema.
pub fn print_json(document: &impl Document) -> Result<(), Failure> {
    JSON_PRINTED.store(true, Ordering::Relaxed);
    write_json(document, JSON_LINES.load(Ordering::Relaxed))
}

/// Prints the JSON document of a run whose last member is an empty list. `elements` prints what
/// the list has instead of nothing.
pub fn print_json_around(
    document: &impl Document,
    elements: impl FnOnce() -> Result<(), Failure>,
) -> Result<(), Failure> {
    const END: &str = "]\n}\n";
    let text = json_text(document)?;
    JSON_PRINTED.store(true, Ordering::Relaxed);
    print_bytes(text.strip_suffix(END).unwrap_or(&text).as_bytes())?;
    elements()?;
    print_bytes(END.as_bytes())
}

/// Prints a document that the document of the run follows, as a line.
pub fn print_json_line(document: &impl Document) -> Result<(), Failure> {
    write_json(document, true)
}

/// Writes a document to standard output, in one line or indented. The text is written in blocks,
/// because some documents are long.
fn write_json(document: &impl Document, in_a_line: bool) -> Result<(), Failure> {
    let mut out = BufWriter::with_capacity(1 << 16, std::io::stdout().lock());
    json::write(&mut out, &Named::new(document), in_a_line).map_err(|error| {
        match error.io_error_kind() {
            Some(_) => not_printed(&error.into()),
            None => Failure::Run(error.to_string()),
        }
    })?;
    writeln!(out).and_then(|()| out.flush()).map_err(|error| not_printed(&error))
}

/// The text of a JSON document, preceded by the name and the version of its schema.
pub fn json_text(document: &impl Document) -> Result<String, Failure> {
    let text =
        json::indented(&Named::new(document)).map_err(|error| Failure::Run(error.to_string()))?;
    Ok(text + "\n")
}

/// An output file that appears under its name only when [`OutputFile::keep`] has succeeded.
/// `carrystep-files` refuses a path that is an input or another output of the same command.
pub struct OutputFile {
    writer: BufWriter<NewFile>,
}

impl OutputFile {
    /// Creates the folder if it does not exist, and begins the file. Everything that prevents the
    /// file from being written is detected here, before any work is done.
    pub fn create(path: &Path) -> Result<Self, Failure> {
        Self::begin(Self::claim(path)?)
    }

    /// The first half of [`OutputFile::create`]: checks the path and creates nothing. A command
    /// with several outputs claims all of them before it begins the first one.
    pub fn claim(path: &Path) -> Result<OutputClaim, Failure> {
        Ok(OutputClaim::new(path)?)
    }

    /// The second half of [`OutputFile::create`]: begins the file.
    pub fn begin(claim: OutputClaim) -> Result<Self, Failure> {
        interrupt::watch();
        Ok(Self { writer: BufWriter::with_capacity(1 << 18, claim.begin(false)?) })
    }

    /// The path under which the file will appear.
    pub fn path(&self) -> &Path {
        self.writer.get_ref().path()
    }

    /// Adds the path to an error, because the writers that use this file report only the cause.
    fn named(&self, error: &std::io::Error) -> std::io::Error {
        std::io::Error::new(error.kind(), format!("{}: {error}", self.path().display()))
    }

    fn failed(&self, source: std::io::Error) -> Failure {
        OutputFailure { path: self.path().to_owned(), source }.into()
    }

    /// Writes a whole text.
    pub fn text(&mut self, text: &str) -> Result<(), Failure> {
        self.writer.write_all(text.as_bytes()).map_err(|error| self.failed(error))
    }

    /// Flushes the buffer, so that all errors of writing are known.
    pub fn whole(&mut self) -> Result<(), Failure> {
        self.writer.flush().map_err(|error| self.failed(error))
    }

    /// Lets the complete file appear under its name, unless the user has interrupted the command.
    pub fn keep(self) -> Result<PathBuf, Failure> {
        interrupt::check()?;
        self.appear()
    }

    /// Lets the complete file appear, even after an interrupt. For commands that an interrupt ends
    /// regularly.
    pub fn appear(mut self) -> Result<PathBuf, Failure> {
        self.whole()?;
        let (file, _) = self.writer.into_parts();
        Ok(file.appear()?)
    }
}

impl From<OutputFailure> for Failure {
    fn from(error: OutputFailure) -> Self {
        Self::input(error.to_string())
    }
}

impl Write for OutputFile {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.writer.write(bytes).map_err(|error| self.named(&error))
    }
    fn flush(&mut self) -> std::io::Result<()> {
        self.writer.flush().map_err(|error| self.named(&error))
    }
}

impl Seek for OutputFile {
    fn seek(&mut self, to: SeekFrom) -> std::io::Result<u64> {
        self.writer.seek(to).map_err(|error| self.named(&error))
    }
}

/// Writes a whole text file, which appears when it is complete.
pub fn write_file(path: &Path, text: &str) -> Result<(), Failure> {
    let mut file = OutputFile::create(path)?;
    file.text(text)?;
    file.keep().map(|_| ())
}
