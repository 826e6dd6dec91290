//! What the grammar reads from, and how it reports mistakes.

use crate::error::ErrorKind;
use crate::squeeze::Squeezed;
use winnow::error::{ErrMode, ParserError};
use winnow::stream::{LocatingSlice, Location as _, Stateful};

/// Greatest depth of brackets in brackets; more would not be readable, and the depth bounds the
/// stack that a line needs.
pub(super) const DEEPEST: u32 = 40;

/// The text of a line with the columns of its characters.
pub(super) type Input<'t> = Stateful<LocatingSlice<&'t [u8]>, State<'t>>;

/// What the grammar knows besides the text.
#[derive(Debug, Clone)]
pub(super) struct State<'t> {
    line: &'t Squeezed,
    /// Open brackets and signs around the present place.
    pub(super) depth: u32,
}

impl State<'_> {
    pub(super) fn column(&self, offset: usize) -> u32 {
        self.line.column(offset)
    }
}

/// The result of a parser.
pub(super) type Parsed<T> = Result<T, ErrMode<Mistake>>;

/// A mistake at an offset of the text. Without a kind, the text simply does not match.
#[derive(Debug)]
pub(super) struct Mistake {
    pub(super) offset: usize,
    pub(super) kind: Option<Box<ErrorKind>>,
}

impl<'t> ParserError<Input<'t>> for Mistake {
    type Inner = Self;

    fn from_input(input: &Input<'t>) -> Self {
        Self { offset: offset(input), kind: None }
    }

    fn into_inner(self) -> Result<Self::Inner, Self> {
        Ok(self)
    }
}

/// The beginning of a line.
pub(super) fn input(line: &Squeezed) -> Input<'_> {
    Stateful { input: LocatingSlice::new(&line.text), state: State { line, depth: 0 } }
}

/// Number of characters before the present place.
pub(super) fn offset(input: &Input<'_>) -> usize {
    input.current_token_start()
}

/// A mistake at the present place: what the grammar expects.
pub(super) fn fail<T>(input: &Input<'_>, what: &'static str) -> Parsed<T> {
    let found = quoted(input.input.as_ref());
    Err(cut(offset(input), ErrorKind::Unexpected { expected: what, found }))
}

/// Gives a mismatch the words that say what is expected.
pub(super) fn expected(
    error: ErrMode<Mistake>,
    input: &Input<'_>,
    what: &'static str,
) -> ErrMode<Mistake> {
    match error {
        ErrMode::Backtrack(Mistake { offset, kind: None }) => {
            let found = quoted(input.input.as_ref());
            cut(offset, ErrorKind::Unexpected { expected: what, found })
        }
        other => other,
    }
}

/// A mistake that no other reading of the text can mend.
pub(super) fn cut(offset: usize, kind: ErrorKind) -> ErrMode<Mistake> {
    ErrMode::Cut(Mistake { offset, kind: Some(Box::new(kind)) })
}

/// A text as messages quote it: at most its first 20 characters.
pub(super) fn quoted(rest: &[u8]) -> String {
    const MOST: usize = 20;
    if rest.is_empty() {
        return "the end of the line".to_owned();
    }
    let shown = String::from_utf8_lossy(&rest[..rest.len().min(MOST)]);
    format!("`{shown}{}`", if rest.len() > MOST { "..." } else { "" })
}
