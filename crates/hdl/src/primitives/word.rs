//! `Word<N>`: N bits, simulated as one machine integer.
//!
//! Rust-HDL's own `Bits<N>` is an array of `bool` above 32 bits, but P, V, A and J have 64 bits. A
//! `Word` is equivalent for kernels and in the Verilog, and simulates about ten times faster. Every
//! operator wraps at N bits. To obtain a carry, widen the operands first with [`bit_cast`], as is
//! usual in Rust-HDL.

use rust_hdl_core::prelude::{Bits, Synth, TypeDescriptor, TypeKind, VCDValue, VerilogLiteral};
use std::ops::{Add, BitAnd, BitOr, BitXor, Not, Shl, Shr, Sub};

/// An unsigned word of N bits, where N is at most 127.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug, Default)]
pub struct Word<const N: usize>(u128);

/// Converts a word to M bits. A wider word has zeros in its upper bits; a narrower one loses its
/// upper bits.
pub fn bit_cast<const M: usize, const N: usize>(x: Word<N>) -> Word<M> {
    Word::new(x.0)
}

impl<const N: usize> Word<N> {
    const MASK: u128 = (1 << N) - 1;

    /// Makes a word of the lowest N bits of `value`.
    #[inline]
    pub const fn new(value: u128) -> Self {
        Self(value & Self::MASK)
    }

    /// The word as an unsigned number.
    #[inline]
    pub const fn value(self) -> u128 {
        self.0
    }

    /// Returns whether any bit is set.
    #[inline]
    pub const fn any(self) -> bool {
        self.0 != 0
    }

    /// Returns one bit. Bit 0 is the lowest.
    #[inline]
    pub const fn get_bit(self, index: usize) -> bool {
        self.0 >> index & 1 == 1
    }

    /// Returns M bits, of which the lowest is bit `index` of this word.
    #[inline]
    pub const fn get_bits<const M: usize>(self, index: usize) -> Word<M> {
        Word::new(self.0 >> index)
    }
}

impl<const N: usize> From<u64> for Word<N> {
    fn from(value: u64) -> Self {
        Self::new(value.into())
    }
}

impl<const N: usize> From<i64> for Word<N> {
    /// Converts a signed number to its two's complement.
    fn from(value: i64) -> Self {
        Self::new(i128::from(value) as u128)
    }
}

impl<const N: usize> From<Word<N>> for Bits<N> {
    fn from(word: Word<N>) -> Self {
        (0..N).fold(Self::default(), |bits, index| bits.replace_bit(index, word.get_bit(index)))
    }
}

impl<const N: usize> Synth for Word<N> {
    const BITS: usize = N;

    fn descriptor() -> TypeDescriptor {
        TypeDescriptor { name: format!("Word::<{N}>"), kind: TypeKind::Bits(N) }
    }

    fn vcd(self) -> VCDValue {
        Bits::from(self).into()
    }

    fn verilog(self) -> VerilogLiteral {
        Bits::from(self).into()
    }
}

macro_rules! operator {
    ($trait:ident, $method:ident, $compute:expr) => {
        impl<const N: usize> $trait for Word<N> {
            type Output = Self;
            #[inline]
            fn $method(self, other: Self) -> Self {
                let compute: fn(u128, u128) -> u128 = $compute;
                Self::new(compute(self.0, other.0))
            }
        }
    };
}

operator!(Add, add, u128::wrapping_add);
operator!(Sub, sub, u128::wrapping_sub);
operator!(BitAnd, bitand, |a, b| a & b);
operator!(BitOr, bitor, |a, b| a | b);
operator!(BitXor, bitxor, |a, b| a ^ b);

impl<const N: usize, const M: usize> Shl<Word<M>> for Word<N> {
    type Output = Self;
    #[inline]
    fn shl(self, by: Word<M>) -> Self {
        if by.0 < 128 { Self::new(self.0 << by.0) } else { Self::new(0) }
    }
}

impl<const N: usize, const M: usize> Shr<Word<M>> for Word<N> {
    type Output = Self;
    #[inline]
    fn shr(self, by: Word<M>) -> Self {
        if by.0 < 128 { Self::new(self.0 >> by.0) } else { Self::new(0) }
    }
}

impl<const N: usize> Not for Word<N> {
    type Output = Self;
    #[inline]
    fn not(self) -> Self {
        Self::new(!self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn word_addition_wraps_and_a_widened_addition_carries() {
        let (a, b) = (Word::<8>::from(200_u64), Word::<8>::from(100_u64));
        assert_eq!((a + b).value(), 44);
        let wide = bit_cast::<9, 8>(a) + bit_cast::<9, 8>(b);
        assert!(wide.get_bit(8));
        assert_eq!(wide.get_bits::<8>(0).value(), 44);
    }

    #[test]
    fn word_of_a_negative_number_is_its_twos_complement() {
        assert_eq!(Word::<64>::from(-1_i64).value(), u128::from(u64::MAX));
        assert_eq!((Word::<4>::from(0_u64) - Word::from(1_u64)).value(), 15);
    }

    #[test]
    fn word_verilog_literal_has_all_bits() {
        assert_eq!(Word::<64>::from(1_u64 << 63).verilog().to_string(), "64'h8000000000000000");
    }
}
