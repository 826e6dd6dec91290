//! The grammar of values.
//!
//! ```text
//! value     = number | ("+" | "-") value | "#" reference | "[" chain "]"
//!           | "atan" bracket "/" bracket | "exists" "[" "#" reference "]" | function bracket
//! reference = "<" name ">" | value
//! bracket   = "[" chain "]"
//! chain     = value (operator value)*
//! ```
//!
//! Operators bind in this order, and from left to right within one row:
//!
//! ```text
//! **
//! *  /  MOD
//! +  -
//! EQ NE GT GE LT LE
//! AND OR XOR
//! ```

use super::input::{DEEPEST, Input, Parsed, cut, expected, fail, offset};
use crate::error::ErrorKind;
use crate::syntax::{Expression, ExpressionKind, Function, Operator, Reference};
use winnow::Parser as _;
use winnow::combinator::{opt, peek};
use winnow::token::{any, literal, take_while};

/// Operators by precedence, those that bind least first; longer texts before their beginnings.
const OPERATORS: [&[(&str, Operator)]; 5] = [
    &[("and", Operator::And), ("or", Operator::Or), ("xor", Operator::Xor)],
    &[
        ("eq", Operator::Equal),
        ("ne", Operator::NotEqual),
        ("gt", Operator::Greater),
        ("ge", Operator::GreaterOrEqual),
        ("lt", Operator::Less),
        ("le", Operator::LessOrEqual),
    ],
    &[("+", Operator::Plus), ("-", Operator::Minus)],
    &[("*", Operator::Times), ("/", Operator::Over), ("mod", Operator::Mod)],
    &[("**", Operator::Power)],
];

const FUNCTIONS: [(&str, Function); 12] = [
    ("abs", Function::Abs),
    ("acos", Function::Acos),
    ("asin", Function::Asin),
    ("cos", Function::Cos),
    ("exp", Function::Exp),
    ("fix", Function::Fix),
    ("fup", Function::Fup),
    ("ln", Function::Ln),
    ("round", Function::Round),
    ("sin", Function::Sin),
    ("sqrt", Function::Sqrt),
    ("tan", Function::Tan),
];

/// A value.
pub(super) fn value(input: &mut Input<'_>) -> Parsed<Expression> {
    let at = offset(input);
    if input.state.depth >= DEEPEST {
        return Err(cut(at, ErrorKind::TooDeep(DEEPEST)));
    }
    input.state.depth += 1;
    let column = input.state.column(at);
    let kind = value_kind(input);
    input.state.depth -= 1;
    Ok(Expression { column, kind: kind? })
}

fn value_kind(input: &mut Input<'_>) -> Parsed<ExpressionKind> {
    let rest: &[u8] = input.input.as_ref();
    match *rest {
        [b'0'..=b'9' | b'.', ..] | [b'+' | b'-', b'0'..=b'9' | b'.', ..] => number(input),
        [b'-', ..] => {
            any.parse_next(input)?;
            Ok(ExpressionKind::Negative(Box::new(value(input)?)))
        }
        [b'+', ..] => {
            any.parse_next(input)?;
            Ok(value(input)?.kind)
        }
        [b'#', ..] => {
            any.parse_next(input)?;
            Ok(ExpressionKind::Parameter(reference(input)?))
        }
        [b'[', ..] => Ok(bracket(input)?.kind),
        _ => function(input),
    }
}

fn number(input: &mut Input<'_>) -> Parsed<ExpressionKind> {
    let at = offset(input);
    let digits = |c: u8| c.is_ascii_digit() || c == b'.';
    let text = (opt(any.verify(|c| matches!(c, b'+' | b'-'))), take_while(1.., digits))
        .take()
        .parse_next(input)?;
    let text = str::from_utf8(text).unwrap_or_default();
    match text.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(ExpressionKind::Number(number)),
        Ok(_) => Err(cut(at, ErrorKind::Overflow)),
        Err(_) => Err(cut(at, ErrorKind::BadNumber(text.chars().take(20).collect()))),
    }
}

/// What follows `#`.
pub(super) fn reference(input: &mut Input<'_>) -> Parsed<Reference> {
    if opt(peek(literal("<"))).parse_next(input)?.is_some() {
        return Ok(Reference::Name(name(input)?.into()));
    }
    Ok(Reference::Number(Box::new(value(input)?)))
}

/// A name in angle brackets.
pub(super) fn name(input: &mut Input<'_>) -> Parsed<String> {
    literal("<").parse_next(input)?;
    let name = take_while(1.., |c: u8| c != b'>' && c != b'<')
        .parse_next(input)
        .map_err(|error| expected(error, input, "a name"))?;
    literal(">").parse_next(input).map_err(|error| expected(error, input, "`>` after a name"))?;
    Ok(String::from_utf8_lossy(name).into_owned())
}

fn function(input: &mut Input<'_>) -> Parsed<ExpressionKind> {
    if opt(literal("atan")).parse_next(input)?.is_some() {
        let y = bracket(input)?;
        let slash = literal("/").parse_next(input);
        slash.map_err(|error| expected(error, input, "`/` and the second value of ATAN"))?;
        return Ok(ExpressionKind::Atan(Box::new(y), Box::new(bracket(input)?)));
    }
    if opt(literal("exists")).parse_next(input)?.is_some() {
        let open = literal("[#").parse_next(input);
        open.map_err(|error| expected(error, input, "a parameter in brackets, as in [#<x>]"))?;
        let reference = reference(input)?;
        close(input)?;
        return Ok(ExpressionKind::Exists(reference));
    }
    for (text, function) in FUNCTIONS {
        if opt(literal(text)).parse_next(input)?.is_some() {
            return Ok(ExpressionKind::Function(function, Box::new(bracket(input)?)));
        }
    }
    fail(input, "a value")
}

/// A chain in brackets.
fn bracket(input: &mut Input<'_>) -> Parsed<Expression> {
    literal("[").parse_next(input).map_err(|error| expected(error, input, "`[`"))?;
    let chain = chain(input, 0)?;
    close(input)?;
    Ok(chain)
}

fn close(input: &mut Input<'_>) -> Parsed<()> {
    let close = literal("]").parse_next(input);
    close.map(|_| ()).map_err(|error| expected(error, input, "an operator or `]`"))
}

/// Values with operators of this precedence and of those that bind more.
fn chain(input: &mut Input<'_>, precedence: usize) -> Parsed<Expression> {
    let Some(operators) = OPERATORS.get(precedence) else {
        return value(input);
    };
    let first = chain(input, precedence + 1)?;
    let mut rest = Vec::new();
    while let Some((column, operator)) = operator(input, operators)? {
        rest.push((column, operator, chain(input, precedence + 1)?));
    }
    if rest.is_empty() {
        return Ok(first);
    }
    let column = first.column;
    Ok(Expression { column, kind: ExpressionKind::Chain(Box::new(first), rest) })
}

/// One of these operators, and its column.
fn operator(
    input: &mut Input<'_>,
    operators: &[(&str, Operator)],
) -> Parsed<Option<(u32, Operator)>> {
    let column = input.state.column(offset(input));
    for &(text, operator) in operators {
        // `*` does not begin `**`.
        if text == "*" && input.input.as_ref().starts_with(b"**") {
            continue;
        }
        if opt(literal(text)).parse_next(input)?.is_some() {
            return Ok(Some((column, operator)));
        }
    }
    Ok(None)
}
