//! Constants that are computed from parameters. Each holds its value in this build, and the Verilog
//! expression that gives its value in any build.
//!
//! A [`Given`] is a parameter of the Verilog, which an instance may override. A [`Formula`] is
//! computed from parameters and numbers:
//!
//! ```
//! use carrystep_hdl::primitives::formula::{Formula, Given};
//! let width = Given::<32>::new("WIDTH", 8);
//! let last = width.bits::<17>(0) - Formula::number(1);
//! assert_eq!(last.value().value(), 7);
//! assert_eq!(last.text(), "WIDTH[16:0] - 17'd1");
//! ```
//!
//! Both operands of an operator have N bits, and the result wraps to N bits, in Rust as in Verilog.
//! The value in Rust and that of the Verilog expression therefore always agree.

use crate::primitives::word::{Word, bit_cast};
use std::ops::{Add, BitAnd, BitOr, Mul, Not, Sub};

/// A parameter of the Verilog with N bits, and its value in this build.
#[derive(Debug, Clone)]
pub struct Given<const N: usize> {
    name: String,
    value: Word<N>,
}

impl<const N: usize> Given<N> {
    /// Makes the parameter with this name and value.
    pub fn new(name: impl Into<String>, value: u64) -> Self {
        Self { name: name.into(), value: Word::from(value) }
    }

    /// The whole parameter.
    pub fn whole(&self) -> Formula<N> {
        self.part(self.name.clone())
    }

    /// M bits of the parameter, from bit `low` upward.
    pub fn bits<const M: usize>(&self, low: usize) -> Formula<M> {
        let text = match M {
            1 => format!("{}[{low}]", self.name),
            _ => format!("{}[{}:{low}]", self.name, low + M - 1),
        };
        self.part(text).with(self.value.get_bits::<M>(low))
    }

    /// 1 if the parameter is less than `least` or greater than `most`.
    pub fn is_outside(&self, least: u64, most: u64) -> Formula<1> {
        let above = self.whole().is_more(&Formula::number(most));
        if least == 0 { above } else { self.whole().is_less(&Formula::number(least)) | above }
    }

    fn part(&self, text: String) -> Formula<N> {
        let literal = Formula::from(self.value).text;
        let given = ParameterValue { name: self.name.clone(), bits: N, literal };
        Formula { value: self.value, text, is_closed: true, given: vec![given] }
    }
}

/// A constant of N bits, with its value in this build and its Verilog expression.
#[derive(Debug, Clone)]
pub struct Formula<const N: usize> {
    value: Word<N>,
    text: String,
    /// The text needs no parentheses as an operand.
    is_closed: bool,
    given: Vec<ParameterValue>,
}

/// A parameter that a formula uses, with its value in this build.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ParameterValue {
    /// Its name.
    pub name: String,
    /// Its width in bits; 0 if the parameter is a string.
    pub bits: usize,
    /// Its value in this build, as a Verilog literal that contains no space.
    pub literal: String,
}

impl ParameterValue {
    /// The value as a number. A string has the value of its characters, 8 bits each, as in Verilog.
    pub(crate) fn number(&self) -> u64 {
        let Some((_, digits)) = self.literal.split_once('\'') else {
            return self
                .literal
                .trim_matches('"')
                .bytes()
                .fold(0, |number, byte| number << 8 | u64::from(byte));
        };
        let radix = match digits.bytes().next() {
            Some(b'h') => 16,
            Some(b'b') => 2,
            _ => 10,
        };
        u64::from_str_radix(digits.get(1..).unwrap_or_default(), radix).unwrap_or_default()
    }
}

impl<const N: usize> Formula<N> {
    /// A number that does not depend on parameters.
    pub fn number(value: u64) -> Self {
        let value = Word::<N>::from(value);
        let text = match N {
            1 => format!("1'b{}", value.value()),
            2..=32 if value.value() <= 0xffff => format!("{N}'d{}", value.value()),
            _ => format!("{N}'h{:x}", value.value()),
        };
        Self { value, text, is_closed: true, given: Vec::new() }
    }

    /// The value in this build.
    pub const fn value(&self) -> Word<N> {
        self.value
    }

    /// The Verilog expression.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The parameters that the expression uses.
    pub fn given(&self) -> &[ParameterValue] {
        &self.given
    }

    /// A mask of the bits that a counter from 0 to this number uses: 0 gives 0, 4 gives 7. A module
    /// masks its timers with it (in its kernel, the `update` function that becomes Verilog), so
    /// that all higher bits are constantly 0 and synthesis removes their flip-flops.
    pub fn used_bits(self) -> Self {
        let value = match self.value.value().checked_ilog2() {
            Some(top) => (2 << top) - 1,
            None => 0,
        };
        let text = format!("used_bits_{N}({})", self.text);
        Self { value: Word::new(value), text, is_closed: true, given: self.given }
    }

    /// 1 if this is less than `other`.
    pub fn is_less(&self, other: &Self) -> Formula<1> {
        self.compared("<", other, self.value < other.value)
    }

    /// 1 if this is greater than `other`.
    pub fn is_more(&self, other: &Self) -> Formula<1> {
        self.compared(">", other, self.value > other.value)
    }

    /// 1 if this equals `other`.
    pub fn is(&self, other: &Self) -> Formula<1> {
        self.compared("==", other, self.value == other.value)
    }

    /// 1 if this does not equal `other`.
    pub fn is_not(&self, other: &Self) -> Formula<1> {
        self.compared("!=", other, self.value != other.value)
    }

    /// This if `test` is 1, otherwise `other`.
    pub fn where_or(self, test: &Formula<1>, other: Self) -> Self {
        let value = if test.value.any() { self.value } else { other.value };
        let text = format!("{} ? {} : {}", test.closed(), self.closed(), other.closed());
        let given = joined(joined(test.given.clone(), self.given), other.given);
        Self { value, text, is_closed: false, given }
    }

    /// The greater one of this and `other`.
    pub fn or_more(self, other: Self) -> Self {
        let test = self.is_more(&other);
        self.where_or(&test, other)
    }

    /// This minus `other`, or 0 if `other` is greater.
    pub fn without(self, other: Self) -> Self {
        let test = self.is_more(&other);
        (self - other).where_or(&test, Self::number(0))
    }

    fn with<const M: usize>(self, value: Word<M>) -> Formula<M> {
        Formula { value, text: self.text, is_closed: self.is_closed, given: self.given }
    }

    fn closed(&self) -> String {
        if self.is_closed { self.text.clone() } else { format!("({})", self.text) }
    }

    /// A comparison: one bit, 1 if it holds. Its text is the comparison itself (`X > 32'd1`), which
    /// has the same value in Verilog.
    fn compared(&self, sign: &str, other: &Self, value: bool) -> Formula<1> {
        self.clone().and_then(sign, other.clone(), self.value).with(Word::from(u64::from(value)))
    }

    fn and_then(self, sign: &str, other: Self, value: Word<N>) -> Self {
        let text = format!("{} {sign} {}", self.closed(), other.closed());
        Self { value, text, is_closed: false, given: joined(self.given, other.given) }
    }
}

fn joined(mut all: Vec<ParameterValue>, more: Vec<ParameterValue>) -> Vec<ParameterValue> {
    for one in more {
        if !all.contains(&one) {
            all.push(one);
        }
    }
    all
}

macro_rules! operator {
    ($trait:ident, $method:ident, $sign:literal, $compute:expr) => {
        impl<const N: usize> $trait for Formula<N> {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                let compute: fn(Word<N>, Word<N>) -> Word<N> = $compute;
                let value = compute(self.value, other.value);
                self.and_then($sign, other, value)
            }
        }
    };
}

operator!(Add, add, "+", |a, b| a + b);
operator!(Sub, sub, "-", |a, b| a - b);
operator!(Mul, mul, "*", |a, b| Word::new(a.value().wrapping_mul(b.value())));
operator!(BitAnd, bitand, "&", |a, b| a & b);
operator!(BitOr, bitor, "|", |a, b| a | b);

impl<const N: usize> Not for Formula<N> {
    type Output = Self;
    fn not(self) -> Self {
        Self {
            value: !self.value,
            text: format!("~{}", self.closed()),
            is_closed: true,
            given: self.given,
        }
    }
}

impl<const N: usize> From<Word<N>> for Formula<N> {
    fn from(word: Word<N>) -> Self {
        Self::number(bit_cast::<64, N>(word).value() as u64)
    }
}

/// The description of a constant for the Verilog export. Rust-HDL passes on only the value of a
/// constant and the name of its type, so a note is encoded as this name (`constant.rs` puts it
/// there).
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Note {
    /// The expression.
    pub text: String,
    /// The parameters that the expression uses.
    pub given: Vec<ParameterValue>,
    /// Whether the constant only tells that parameters are out of range.
    pub is_refusal: bool,
}

const CONSTANT: &str = "formula";
const REFUSAL: &str = "refusal";

impl Note {
    pub(crate) fn of<const N: usize>(formula: &Formula<N>, is_refusal: bool) -> Self {
        Self { text: formula.text.clone(), given: formula.given.clone(), is_refusal }
    }

    /// Decodes the note in the name of a type; `None` if the name contains no note.
    pub fn read(name: &str) -> Option<Self> {
        let mut parts = name.split('\t');
        let is_refusal = match parts.next()? {
            CONSTANT => false,
            REFUSAL => true,
            _ => return None,
        };
        let text = parts.next()?.to_owned();
        let given = parts.map(|part| {
            let mut words = part.split(' ');
            let (name, bits, literal) = (words.next()?, words.next()?, words.next()?);
            Some(ParameterValue {
                name: name.to_owned(),
                bits: bits.parse().ok()?,
                literal: literal.to_owned(),
            })
        });
        Some(Self { text, given: given.collect::<Option<_>>()?, is_refusal })
    }

    /// Encodes the note as the name of a type.
    pub(crate) fn written(&self) -> String {
        let kind = if self.is_refusal { REFUSAL } else { CONSTANT };
        let given = self
            .given
            .iter()
            .map(|ParameterValue { name, bits, literal }| format!("\t{name} {bits} {literal}"));
        format!("{kind}\t{}{}", self.text, given.collect::<String>())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn given(value: u64) -> Given<32> {
        Given::new("X", value)
    }

    #[test]
    fn formula_has_the_value_and_the_text() {
        let (x, y) = (given(65_536), Given::<32>::new("Y", 3));
        let sum = (x.bits::<17>(0) + y.bits::<17>(0)) - Formula::number(2);
        assert_eq!((sum.value().value(), sum.text()), (65_537, "(X[16:0] + Y[16:0]) - 17'd2"));
        assert_eq!(sum.given().iter().map(|one| one.name.as_str()).collect::<Vec<_>>(), ["X", "Y"]);
        let low = x.bits::<16>(0) - Formula::number(1);
        assert_eq!((low.value().value(), low.text()), (65_535, "X[15:0] - 16'd1"));
        let test = y.whole().is_more(&Formula::number(1));
        assert_eq!((test.value().value(), test.text()), (1, "Y > 32'd1"));
        let least = y.whole().without(Formula::number(5));
        assert_eq!((least.value().value(), least.text()), (0, "(Y > 32'd5) ? (Y - 32'd5) : 32'd0"));
        assert_eq!((x.whole() * y.whole()).value().value(), 196_608);
    }

    #[test]
    fn used_bits_are_all_up_to_the_highest() {
        for (greatest, bits) in
            [(0, 0), (1, 1), (2, 3), (3, 3), (4, 7), (65_535, 65_535), (65_536, 131_071)]
        {
            assert_eq!(given(greatest).bits::<17>(0).used_bits().value().value(), bits);
        }
        assert_eq!(given(5).bits::<17>(0).used_bits().text(), "used_bits_17(X[16:0])");
    }

    #[test]
    fn value_of_a_parameter_is_that_of_its_literal() {
        for value in [0, 1, 7, 65_536, u64::MAX] {
            assert_eq!(Given::<64>::new("X", value).whole().given()[0].number(), value);
        }
        let word = ParameterValue { name: "X".to_owned(), bits: 0, literal: "\"ab\"".to_owned() };
        assert_eq!(word.number(), 0x6162);
    }

    #[test]
    fn note_is_read_as_it_was_written() {
        let formula = given(7).whole() + Given::<32>::new("Y", 8).whole();
        for is_refusal in [false, true] {
            let note = Note::of(&formula, is_refusal);
            assert_eq!(Note::read(&note.written()), Some(note));
        }
        assert_eq!(Note::read("Word::<4>"), None);
    }
}
