//! Where results go: standard output, and files that appear whole or not at all.

use crate::colour;
use crate::documents::{Document, Named};
use crate::failure::Failure;
use crate::interrupt;
use carrystep_files::{Claim, NewFile, OutputFailure};
use std::borrow::Cow;
use std::ffi::OsString;
use std::io::{BufWriter, ErrorKind, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

/// Prints text to standard output.
pub fn print(text: &str) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    let painted = if colour::wanted(&out) { Cow::Owned(colour::painted(text)) } else { Cow::Borrowed(text) };
    out.write_all(painted.as_bytes()).and_then(|()| out.flush()).map_err(|error| match error.kind() {
        ErrorKind::BrokenPipe => Failure::ReaderGone,
        _ => Failure::input(format!("cannot write to standard output: {error}")),
    })
}

/// `--json` is among the arguments.
static JSON_WANTED: AtomicBool = AtomicBool::new(false);
/// A document was printed: there is one for each run, on failure too.
static JSON_PRINTED: AtomicBool = AtomicBool::new(false);

/// Looks for `--json` before the arguments are parsed: it also holds for arguments that are refused.
pub fn json_is_wanted(mut arguments: impl Iterator<Item = OsString>) {
    let options = arguments.by_ref().take_while(|argument| argument != "--");
    JSON_WANTED.store(options.into_iter().any(|argument| argument == "--json"), Ordering::Relaxed);
}

/// Whether a document is wanted that nobody has printed.
pub fn lacks_json() -> bool {
    JSON_WANTED.load(Ordering::Relaxed) && !JSON_PRINTED.load(Ordering::Relaxed)
}

/// Prints one JSON document, with the name and version of its schema.
pub fn print_json(document: &impl Document) -> Result<(), Failure> {
    JSON_PRINTED.store(true, Ordering::Relaxed);
    let text = serde_json::to_string_pretty(&Named::new(document)).map_err(|error| Failure::Run(error.to_string()))?;
    print(&format!("{text}\n"))
}

/// A file that is there under its name only once [`OutputFile::keep`] has succeeded. It is no input, and no other
/// output, of the same command: `carrystep-files` compares them.
pub struct OutputFile {
    writer: BufWriter<NewFile>,
}

impl OutputFile {
    /// Makes the folder if need be. Whatever forbids the file is found here, before any work is done.
    pub fn create(path: &Path) -> Result<Self, Failure> {
        Self::begin(Self::claim(path)?)
    }

    /// The first half of [`OutputFile::create`]: makes nothing. A command with several outputs claims all of them
    /// before it begins the first.
    pub fn claim(path: &Path) -> Result<Claim, Failure> {
        Ok(Claim::new(path)?)
    }

    /// The second half of [`OutputFile::create`].
    pub fn begin(claim: Claim) -> Result<Self, Failure> {
        interrupt::watch();
        Ok(Self { writer: BufWriter::with_capacity(1 << 18, claim.begin(false)?) })
    }

    /// Where the result will be.
    pub fn path(&self) -> &Path {
        self.writer.get_ref().path()
    }

    /// Who writes into us says only what is wrong; this adds where.
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

    /// Nothing is left to be written.
    pub fn whole(&mut self) -> Result<(), Failure> {
        self.writer.flush().map_err(|error| self.failed(error))
    }

    /// Everything is written: let it appear, unless somebody has asked us to end.
    pub fn keep(self) -> Result<PathBuf, Failure> {
        interrupt::check()?;
        self.appear()
    }

    /// Everything is written: let it appear, where to be asked to end is how a command ends.
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

/// Writes a whole text file.
pub fn write_file(path: &Path, text: &str) -> Result<(), Failure> {
    let mut file = OutputFile::create(path)?;
    file.text(text)?;
    file.keep().map(|_| ())
}
