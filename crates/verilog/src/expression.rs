//! Rust-HDL expressions as Verilog, with every width known.
//!
//! Rust wraps where Verilog widens. Both operands of each operator must have one width here, a cast is a
//! concatenation or a slice, and parentheses come from the tree, not from the text: so the two cannot part.

use crate::ExportError;
use crate::names::{Names, slice};
use crate::netlist::Number;
use rust_hdl::prelude::ast::{VerilogExpression as Expression, VerilogOp as Op, VerilogOpUnary as Unary};

/// An expression's text and width, and how tightly it binds.
#[derive(Debug, Clone)]
pub(crate) struct Text {
    pub(crate) text: String,
    pub(crate) width: usize,
    bond: Bond,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Bond {
    /// A name or a literal.
    Atom,
    /// Never needs parentheses, but cannot be sliced.
    Closed,
    /// An operator.
    Open(&'static str),
}

/// Translates the expressions of one module.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Translator<'a> {
    pub(crate) module: &'a str,
    pub(crate) names: &'a Names,
    /// The loop variable and its value, inside a loop.
    pub(crate) counter: Option<(&'a str, usize)>,
}

impl Translator<'_> {
    /// The flat name without `$next`, its index put in.
    pub(crate) fn flat(&self, signal: &str) -> String {
        let signal = signal.trim_end_matches("$next");
        match self.counter {
            Some((variable, value)) => signal.replace(&format!("[{variable}]"), &format!("${value}")),
            None => signal.to_owned(),
        }
    }

    pub(crate) fn expression(&self, expression: &Expression) -> Result<Text, ExportError> {
        match expression {
            Expression::Signal(signal) => {
                let name = self.names.get(self.module, &self.flat(signal))?;
                Ok(Text { text: name.text.clone(), width: name.width, bond: Bond::Atom })
            }
            Expression::Literal(literal) => {
                let number = Number::new(literal).ok_or_else(|| self.unsupported("literal"))?;
                Ok(Text { text: number.to_string(), width: number.width, bond: Bond::Closed })
            }
            Expression::Paren(inner) => self.expression(inner),
            Expression::Cast(inner, width) => self.cast(&self.expression(inner)?, *width),
            Expression::Unary(Unary::Any, inner) => self.against_zero(inner, "!="),
            Expression::Unary(Unary::Not, inner) => match inner.as_ref() {
                Expression::Unary(Unary::Any, inner) => self.against_zero(inner, "=="),
                _ => self.unary(&Unary::Not, &self.expression(inner)?),
            },
            Expression::Unary(op, inner) => self.unary(op, &self.expression(inner)?),
            Expression::Binary(left, op, right) => self.binary(&self.expression(left)?, op, &self.expression(right)?),
            Expression::Index(signal, index) => self.part(&self.expression(signal)?, self.number(index)?, 1),
            Expression::Slice(signal, width, low) => self.part(&self.expression(signal)?, self.number(low)?, *width),
            Expression::Signed(_) | Expression::Unsigned(_) => Err(self.unsupported("signed arithmetic")),
            Expression::IndexReplace(..) => Err(self.unsupported("replace_bit")),
        }
    }

    /// An index: a literal or the loop variable.
    fn number(&self, index: &Expression) -> Result<usize, ExportError> {
        match (index, self.counter) {
            (Expression::Literal(literal), _) => Ok(literal.as_usize()),
            (Expression::Signal(name), Some((variable, value))) if name == variable => Ok(value),
            _ => Err(self.unsupported("an index that is not a number")),
        }
    }

    fn part(&self, signal: &Text, low: usize, width: usize) -> Result<Text, ExportError> {
        if signal.bond != Bond::Atom || signal.text.ends_with(']') || low + width > signal.width {
            return Err(self.unsupported(&format!("bits of {}", signal.text)));
        }
        if width == signal.width {
            return Ok(signal.clone());
        }
        Ok(Text { text: slice(&signal.text, low, width), width, bond: Bond::Closed })
    }

    fn cast(&self, inner: &Text, width: usize) -> Result<Text, ExportError> {
        if width <= inner.width {
            return self.part(inner, 0, width);
        }
        let text = format!("{{{}'b0, {}}}", width - inner.width, inner.text);
        Ok(Text { text, width, bond: Bond::Closed })
    }

    fn against_zero(&self, inner: &Expression, sign: &'static str) -> Result<Text, ExportError> {
        let inner = self.expression(inner)?;
        let zero = Number { width: inner.width, value: 0 };
        Ok(Text { text: format!("{} {sign} {zero}", inner.closed()), width: 1, bond: Bond::Open(sign) })
    }

    fn unary(&self, op: &Unary, inner: &Text) -> Result<Text, ExportError> {
        let Text { width, .. } = *inner;
        let (sign, width) = match op {
            Unary::Not if width == 1 => ("!", 1),
            Unary::Not => ("~", width),
            Unary::All => ("&", 1),
            Unary::Xor => ("^", 1),
            Unary::Neg | Unary::Any => return Err(self.unsupported("negation")),
        };
        Ok(Text { text: format!("{sign}{}", inner.closed()), width, bond: Bond::Closed })
    }

    fn binary(&self, left: &Text, op: &Op, right: &Text) -> Result<Text, ExportError> {
        let (sign, compares) = match op {
            Op::Add => ("+", false),
            Op::Sub => ("-", false),
            Op::LogicalAnd | Op::BitAnd => ("&", false),
            Op::LogicalOr | Op::BitOr => ("|", false),
            Op::BitXor => ("^", false),
            Op::Shl => ("<<", false),
            Op::Shr => (">>", false),
            Op::Eq => ("==", true),
            Op::Ne => ("!=", true),
            Op::Lt => ("<", true),
            Op::Le => ("<=", true),
            Op::Gt => (">", true),
            Op::Ge => (">=", true),
            Op::Mul => return Err(self.unsupported("multiplication")),
        };
        if left.width != right.width && !matches!(op, Op::Shl | Op::Shr) {
            return Err(self.unsupported(&format!(
                "{} ({} bits) {sign} {} ({} bits)",
                left.text, left.width, right.text, right.width
            )));
        }
        // a & b & c, but a - (b - c)
        let chained = matches!(sign, "&" | "|" | "^") && left.bond == Bond::Open(sign);
        let left_text = if chained { left.text.clone() } else { left.closed() };
        let text = format!("{left_text} {sign} {}", right.closed());
        Ok(Text { text, width: if compares { 1 } else { left.width }, bond: Bond::Open(sign) })
    }

    pub(crate) fn unsupported(&self, what: &str) -> ExportError {
        ExportError::unsupported(self.module, what)
    }
}

impl Text {
    /// The text, in parentheses where an operator could tear it apart.
    fn closed(&self) -> String {
        match self.bond {
            Bond::Open(_) => format!("({})", self.text),
            _ => self.text.clone(),
        }
    }
}
