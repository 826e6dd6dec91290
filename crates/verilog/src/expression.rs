//! Translates Rust-HDL expressions to Verilog with explicit widths.
//!
//! Rust wraps an overflow where Verilog would widen the result. Therefore both operands of an
//! operator must have the same width, a cast is written as a concatenation or a slice, and
//! parentheses are derived from the expression tree. The Verilog then has the same value as the
//! Rust expression.

use crate::ExportError;
use crate::names::{Names, slice};
use crate::netlist::Number;
use carrystep_hdl::engine::layout;
use rust_hdl_core::prelude::ast::{
    VerilogExpression as Expression, VerilogOp as Op, VerilogOpUnary as Unary,
};

/// Text and width of an expression, and its precedence.
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
    /// An expression that needs no parentheses but cannot be sliced.
    Closed,
    /// An expression with this operator at its top.
    Open(&'static str),
}

/// Translates the expressions of one module.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Translator<'a> {
    pub(crate) module: &'a str,
    pub(crate) names: &'a Names,
    /// Name and value of the loop variable within a loop.
    pub(crate) counter: Option<(&'a str, usize)>,
}

impl Translator<'_> {
    /// The flat name without `$next`, with its index inserted.
    pub(crate) fn flat(&self, signal: &str) -> String {
        let signal = signal.trim_end_matches("$next");
        match self.counter {
            Some((variable, value)) => {
                signal.replace(&format!("[{variable}]"), &format!("${value}"))
            }
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
            Expression::Binary(left, op, right) => {
                self.binary(&self.expression(left)?, op, &self.expression(right)?)
            }
            Expression::Index(signal, index) => {
                self.part(&self.expression(signal)?, self.number(index)?, 1)
            }
            Expression::Slice(signal, width, low) => {
                self.part(&self.expression(signal)?, self.number(low)?, *width)
            }
            Expression::Signed(_) | Expression::Unsigned(_) => {
                Err(self.unsupported("signed arithmetic"))
            }
            Expression::IndexReplace(..) => Err(self.unsupported("replace_bit")),
        }
    }

    /// The value of an index: a literal, the loop variable, or a constant of the engine's layout.
    fn number(&self, index: &Expression) -> Result<usize, ExportError> {
        match (index, self.counter) {
            (Expression::Literal(literal), _) => Ok(literal.as_usize()),
            (Expression::Signal(name), Some((variable, value))) if name == variable => Ok(value),
            (Expression::Signal(name), _) => {
                layout::index(name).ok_or_else(|| self.unsupported(&format!("the index {name}")))
            }
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
        Ok(Text {
            text: format!("{} {sign} {zero}", inner.closed()),
            width: 1,
            bond: Bond::Open(sign),
        })
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
        // `a & b & c` needs no parentheses; `a - (b - c)` does.
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
    /// The text, in parentheses if an operator next to it could change its meaning.
    fn closed(&self) -> String {
        match self.bond {
            Bond::Open(_) => format!("({})", self.text),
            _ => self.text.clone(),
        }
    }
}
