//! The moves of a file, held in memory if the file is short, and read again each time if it is
//! long.

use crate::error::InputError;
use crate::long_file::LongFile;
use crate::machine::Machine;
use crate::move_file::{Move, MoveFile};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The greatest size in bytes of a move file that is parsed as a whole. The parser needs some 80
/// times as much memory as the text has.
const WHOLE_BYTES: u64 = 1 << 18;

/// A machine, and moves for it that can be read as often as they are needed.
#[derive(Debug, Clone)]
pub struct MoveSource {
    /// The machine.
    pub machine: Machine,
    /// The name of the move file, for messages.
    pub path: PathBuf,
    moves: Stored,
    fit_ns: Option<u64>,
}

#[derive(Debug, Clone)]
enum Stored {
    Whole(Arc<[Move]>),
    Long(Box<LongFile>),
}

/// The moves of a [`MoveSource`], from the first one on.
pub struct Moves(Box<dyn Iterator<Item = Result<Move, InputError>> + Send>);

impl std::fmt::Debug for Moves {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Moves").finish_non_exhaustive()
    }
}

impl MoveSource {
    /// Opens a move file of any length, and reads the machine. A file of up to 256 KiB is checked
    /// as a whole; of a longer one, a mistake in a move is found when the move is read.
    ///
    /// # Errors
    /// [`InputError`] with file, line and column of the first mistake.
    pub fn open(path: &Path) -> Result<Self, InputError> {
        let is_long =
            std::fs::metadata(path).is_ok_and(|there| there.is_file() && there.len() > WHOLE_BYTES);
        if !is_long {
            return MoveFile::load(path).map(Self::from);
        }
        let (file, head) = LongFile::open(path)?;
        match head {
            Ok(machine) => Ok(Self {
                machine,
                path: path.to_owned(),
                moves: Stored::Long(Box::new(file)),
                fit_ns: None,
            }),
            Err(whole) => MoveFile::from_source(whole).map(Self::from),
        }
    }

    /// Replaces the fit tolerance of all moves by `fit_ns` ns, if it is given.
    #[must_use]
    pub fn with_fit(self, fit_ns: Option<u64>) -> Self {
        Self { fit_ns: fit_ns.or(self.fit_ns), ..self }
    }

    /// The moves, from the first one on.
    ///
    /// # Errors
    /// [`InputError`] if the file cannot be read again. A later mistake is an item of its own, and
    /// the last one.
    pub fn moves(&self) -> Result<Moves, InputError> {
        let moves: Box<dyn Iterator<Item = Result<Move, InputError>> + Send> = match &self.moves {
            Stored::Whole(moves) => {
                let moves = moves.clone();
                Box::new((0..moves.len()).map(move |at| Ok(moves[at].clone())))
            }
            Stored::Long(file) => Box::new(file.moves(&self.machine)?),
        };
        let Some(fit_ns) = self.fit_ns else { return Ok(Moves(moves)) };
        let fitted = move |moved: Result<Move, InputError>| Ok(Move { fit_ns, ..moved? });
        Ok(Moves(Box::new(moves.map(fitted))))
    }

    /// Makes an error about a move of this source.
    pub fn move_error(&self, moved: &Move, message: impl Into<String>) -> InputError {
        moved.place.error(&self.path, message)
    }
}

impl From<MoveFile> for MoveSource {
    fn from(file: MoveFile) -> Self {
        let MoveFile { machine, moves, source, .. } = file;
        Self { machine, path: source.path, moves: Stored::Whole(moves.into()), fit_ns: None }
    }
}

impl Iterator for Moves {
    type Item = Result<Move, InputError>;

    fn next(&mut self) -> Option<Self::Item> {
        self.0.next()
    }
}
