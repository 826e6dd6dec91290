//! The files of a program: the program itself, and the files beside it whose subroutines it calls.
//!
//! `o<name> call` and `M98 P100` look for their subroutine in the running file, then in the
//! program, and then in the file `name.ngc` or `100.ngc` in the folder of the program. A file stays
//! open once it has been found, with its outline; its lines are read again for each call.

use crate::error::{ErrorKind, Fault, GcodeError};
use crate::outline::{Outline, Style};
use crate::seal::Seal;
use crate::source::{Place, Source};
use std::io::{Read, Seek};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Greatest number of files, which bounds the memory.
const MOST_FILES: usize = 100;

/// A place in one of the files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Address {
    /// Number of the file; the program itself is 0.
    pub(crate) file: usize,
    pub(crate) place: Place,
}

/// A file that is open.
#[derive(Debug)]
struct Opened<R> {
    name: Arc<str>,
    source: Source<R>,
    outline: Outline,
    seal: Option<Seal>,
}

/// Where other files are, and how they are opened.
#[derive(Debug)]
pub(crate) struct Folder<R> {
    pub(crate) path: PathBuf,
    pub(crate) open: fn(&Path) -> Result<(R, Seal), ErrorKind>,
}

/// All files of a program.
#[derive(Debug)]
pub(crate) struct Files<R> {
    /// The program, and then the other files in the order of their first calls.
    opened: Vec<Opened<R>>,
    /// The file whose lines are being executed.
    running: usize,
    folder: Option<Folder<R>>,
    block_delete: bool,
}

impl<R: Read + Seek> Files<R> {
    /// Reads the outline of a program. Without a folder, no other files are looked for.
    ///
    /// # Errors
    /// The program cannot be read, or an O-word is malformed or without its beginning or end.
    pub(crate) fn new(
        input: R,
        name: Arc<str>,
        seal: Option<Seal>,
        folder: Option<Folder<R>>,
        block_delete: bool,
    ) -> Result<Self, GcodeError> {
        let mut this = Self { opened: Vec::new(), running: 0, folder, block_delete };
        this.add(input, name, seal)?;
        Ok(this)
    }

    fn add(&mut self, input: R, name: Arc<str>, seal: Option<Seal>) -> Result<(), GcodeError> {
        let fail = |kind| GcodeError { file: name.clone(), line: 0, column: 0, kind };
        let mut source = Source::new(input).map_err(fail)?;
        let outline = Outline::read(&mut source, &name, self.block_delete)?;
        source.jump(Place::default()).map_err(fail)?;
        self.opened.push(Opened { name, source, outline, seal });
        Ok(())
    }

    /// The name of a file.
    pub(crate) fn name(&self, file: usize) -> &Arc<str> {
        &self.opened[file].name
    }

    /// The outline of the running file.
    pub(crate) fn outline(&self) -> &Outline {
        &self.opened[self.running].outline
    }

    /// The beginning of the next line.
    pub(crate) fn next(&self) -> Address {
        self.here(self.opened[self.running].source.next_place())
    }

    /// A place in the running file.
    pub(crate) fn here(&self, place: Place) -> Address {
        Address { file: self.running, place }
    }

    /// Reads the next line; false at the end of the running file.
    pub(crate) fn advance(&mut self) -> Result<bool, ErrorKind> {
        self.opened[self.running].source.advance()
    }

    /// The line that was read.
    pub(crate) fn line(&self) -> &[u8] {
        self.opened[self.running].source.line()
    }

    /// Continues with the line that begins here.
    pub(crate) fn jump(&mut self, to: Address) -> Result<(), ErrorKind> {
        self.running = to.file;
        self.opened[to.file].source.jump(to.place)
    }

    /// Checks that no file has changed since it was opened.
    pub(crate) fn check(&self) -> Result<(), Fault> {
        let has_changed = |file: &&Opened<R>| file.seal.as_ref().is_some_and(|seal| !seal.holds());
        match self.opened.iter().find(has_changed) {
            None => Ok(()),
            Some(Opened { name: file, .. }) => {
                let (file, kind) = (file.clone(), ErrorKind::Changed);
                Err(GcodeError { file, line: 0, column: 0, kind }.into())
            }
        }
    }

    /// Finds the first line of a subroutine, and opens its file if need be. `label` is the number,
    /// or the name in angle brackets.
    ///
    /// # Errors
    /// Nowhere is such a subroutine, or its file cannot be read.
    pub(crate) fn find(&mut self, style: Style, label: &str) -> Result<Address, Fault> {
        let known = [self.running, 0].into_iter().find_map(|file| self.sub(file, style, label));
        if let Some(address) = known {
            return Ok(address);
        }
        let fault = |kind| Fault::new(0, kind);
        let Some(name) = self.folder.as_ref().and_then(|folder| folder.file_of(label)) else {
            return Err(fault(ErrorKind::UnknownSub(style.text(label))));
        };
        let shown: Arc<str> = name.display().to_string().into();
        let file = match self.opened.iter().position(|file| file.name == shown) {
            Some(file) => file,
            None => self.open(&name, shown.clone())?,
        };
        let absent = || ErrorKind::SubNotInFile { file: shown.to_string(), sub: style.text(label) };
        self.sub(file, style, label).ok_or_else(|| fault(absent()))
    }

    fn sub(&self, file: usize, style: Style, label: &str) -> Option<Address> {
        let outline = &self.opened[file].outline;
        let place = outline.nodes[outline.sub(style, label)?].after;
        Some(Address { file, place })
    }

    fn open(&mut self, path: &Path, name: Arc<str>) -> Result<usize, Fault> {
        let fault = |kind| Fault::new(0, kind);
        if self.opened.len() >= MOST_FILES {
            return Err(fault(ErrorKind::TooManyFiles(MOST_FILES)));
        }
        let Some(folder) = &self.folder else { return Ok(0) };
        let (input, seal) = (folder.open)(path).map_err(|kind| {
            Fault::from(GcodeError { file: name.clone(), line: 0, column: 0, kind })
        })?;
        self.add(input, name, Some(seal))?;
        Ok(self.opened.len() - 1)
    }
}

impl<R> Folder<R> {
    /// The file of a subroutine, if there is one. A label never leads out of the folder.
    fn file_of(&self, label: &str) -> Option<PathBuf> {
        let name = label.trim_start_matches('<').trim_end_matches('>');
        let is_plain = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '-');
        let path = self.path.join(format!("{name}.ngc"));
        (!name.is_empty() && name.chars().all(is_plain) && path.exists()).then_some(path)
    }
}
