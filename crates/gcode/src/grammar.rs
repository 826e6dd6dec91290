//! The grammar of a line without comments and blanks, by the parser library `winnow`.
//!
//! ```text
//! block      = ["/"] ["n" digits] (control | (word | assignment)*)
//! word       = letter value
//! assignment = "#" reference "=" value
//! control    = "o" label [o-word value*]
//! label      = digits | "<" name ">" | "#" reference | "[" chain "]"
//! ```
//!
//! Values are in [`expression`].

mod expression;
mod input;

use crate::error::{ErrorKind, Fault};
use crate::grammar::expression::{reference, value};
use crate::grammar::input::{Input, Parsed, expected, fail, input, offset};
use crate::squeeze::Squeezed;
use crate::syntax::{Assignment, Block, Control, Label, OWord, Word};
use winnow::Parser as _;
use winnow::combinator::{opt, peek};
use winnow::error::ErrMode;
use winnow::token::{any, literal, one_of, take_while};

/// What a line is, apart from its content.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum LineKind {
    /// An ordinary block, possibly empty.
    Block,
    /// A block with `/` before it.
    Deletable,
    /// `%` alone.
    Percent,
}

/// The kind of a line.
pub(crate) fn kind(line: &Squeezed) -> LineKind {
    match line.text.as_slice() {
        b"%" => LineKind::Percent,
        [b'/', ..] => LineKind::Deletable,
        _ => LineKind::Block,
    }
}

/// Reads a line into `block`.
///
/// # Errors
/// The first place at which the line is not of the grammar.
pub(crate) fn read(line: &Squeezed, block: &mut Block) -> Result<(), Fault> {
    block.control = None;
    block.words.clear();
    block.assignments.clear();
    let mut input = input(line);
    into(&mut input, block).map_err(|error| {
        let (at, kind) = match error {
            ErrMode::Backtrack(fault) | ErrMode::Cut(fault) => (fault.offset, fault.kind),
            ErrMode::Incomplete(_) => (line.text.len(), None),
        };
        let kind = kind.map_or_else(|| unexpected(line, at, "a word, as in X1.5"), |kind| *kind);
        Fault::new(line.column(at), kind)
    })
}

/// The error for what is at this offset.
fn unexpected(line: &Squeezed, at: usize, expected: &'static str) -> ErrorKind {
    let rest = line.text.get(at..).unwrap_or_default();
    ErrorKind::Unexpected { expected, found: input::quoted(rest) }
}

fn into(input: &mut Input<'_>, block: &mut Block) -> Parsed<()> {
    opt(literal("/")).parse_next(input)?;
    if opt(literal("n")).parse_next(input)?.is_some() {
        let digits = |c: u8| c.is_ascii_digit() || c == b'.';
        take_while(1.., digits)
            .parse_next(input)
            .map_err(|error| expected(error, input, "a line number after N"))?;
    }
    if opt(literal("o")).parse_next(input)?.is_some() {
        block.control = Some(control(input)?);
        return end(input, "nothing more after an O-word");
    }
    while let Some(first) = opt(peek(any)).parse_next(input)? {
        match first {
            b'#' => block.assignments.push(assignment(input)?),
            b'o' => return fail(input, "the O-word at the beginning of its line"),
            b'n' => return fail(input, "the line number at the beginning of its line"),
            _ => block.words.push(word(input)?),
        }
    }
    Ok(())
}

fn end(input: &mut Input<'_>, what: &'static str) -> Parsed<()> {
    if input.input.is_empty() { Ok(()) } else { fail(input, what) }
}

fn word(input: &mut Input<'_>) -> Parsed<Word> {
    let column = input.state.column(offset(input));
    let letter = one_of(|c: u8| c.is_ascii_lowercase() || matches!(c, b'@' | b'^'))
        .parse_next(input)
        .map_err(|error| expected(error, input, "a word, as in X1.5"))?;
    Ok(Word { letter, column, value: value(input)? })
}

fn assignment(input: &mut Input<'_>) -> Parsed<Assignment> {
    let column = input.state.column(offset(input));
    literal("#").parse_next(input)?;
    let reference = reference(input)?;
    literal("=").parse_next(input).map_err(|error| expected(error, input, "`=` and a value"))?;
    Ok(Assignment { column, reference, value: value(input)? })
}

fn control(input: &mut Input<'_>) -> Parsed<Control> {
    let label = label(input)?;
    let at = offset(input);
    let column = input.state.column(at);
    if input.input.is_empty() {
        return Ok(Control { label, word: OWord::Program, column, values: Vec::new() });
    }
    let mut word = None;
    for known in OWord::ALL {
        if opt(literal(known.text())).parse_next(input)?.is_some() {
            word = Some(known);
            break;
        }
    }
    let Some(word) = word else {
        return fail(input, "an O-word: sub, call, if, while, do, repeat or their ends");
    };
    let (least, most) = word.values();
    let mut values = Vec::new();
    while values.len() < most && !input.input.is_empty() {
        values.push(value(input)?);
    }
    if values.len() < least {
        return fail(input, "a value in brackets");
    }
    Ok(Control { label, word, column, values })
}

fn label(input: &mut Input<'_>) -> Parsed<Label> {
    match opt(peek(any)).parse_next(input)? {
        Some(b'0'..=b'9') => {
            let digits = take_while(1.., |c: u8| c.is_ascii_digit()).parse_next(input)?;
            // Leading zeros do not distinguish labels.
            let digits: String = digits.iter().copied().map(char::from).collect();
            let digits = digits.trim_start_matches('0');
            Ok(Label::Fixed(if digits.is_empty() { "0" } else { digits }.into()))
        }
        Some(b'<') => Ok(Label::Fixed(format!("<{}>", expression::name(input)?).into())),
        Some(b'#' | b'[') => Ok(Label::Computed(value(input)?)),
        _ => fail(input, "a label after O: a number, or a name in angle brackets"),
    }
}
