//! Lines as they are executed.

use std::sync::Arc;

/// A line as it was executed. Every line that the interpreter reads counts, also an empty one, a
/// comment, an O-word, `%`, and one that begins with `/`. A line in a loop or a subroutine counts
/// each time, and lines that are jumped over do not. So the number of a block is that of its line
/// as long as nothing jumps.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ExecutedBlock {
    /// Its number, from 1.
    pub number: u64,
    /// Name of the file, as the caller gave it, or that of a subroutine.
    pub file: Arc<str>,
    /// Line in the file, from 1.
    pub line: u64,
    /// The line as it is in the file.
    pub text: String,
    /// Whether it gives a move.
    pub moves: bool,
}
