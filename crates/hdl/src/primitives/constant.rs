//! Constants that a kernel can name. In the Verilog they are local parameters.
//!
//! Rust-HDL's own `Constant` has no default, so that a module that contains one would have to name
//! every field in its constructor. The types here have a default: the value of a [`Literal`] is
//! part of its type, and the value of a [`Parameter`] is set when the module is built.

use crate::primitives::word::Word;
use rust_hdl::core::signal::get_signal_id;
use rust_hdl::prelude::{
    Atom, AtomKind, Block, Logic, PinConstraint, Probe, Synth, TypeDescriptor, VCDValue, VerilogLiteral,
};

/// The constant VALUE, N bits wide.
#[derive(Debug)]
pub struct Literal<const N: usize, const VALUE: u64> {
    id: usize,
}

impl<const N: usize, const VALUE: u64> Default for Literal<N, VALUE> {
    fn default() -> Self {
        Self { id: get_signal_id() }
    }
}

impl<const N: usize, const VALUE: u64> Literal<N, VALUE> {
    /// The value of the constant.
    #[inline]
    pub const fn val(&self) -> Word<N> {
        Word::new(VALUE as u128)
    }
}

/// A constant of N bits whose value is chosen when the module is built.
#[derive(Debug)]
pub struct Parameter<const N: usize> {
    value: Word<N>,
    id: usize,
}

impl<const N: usize> Default for Parameter<N> {
    fn default() -> Self {
        Self::new(0)
    }
}

impl<const N: usize> Parameter<N> {
    /// Makes a parameter. The caller ensures that `value` fits in N bits; higher bits are dropped.
    pub fn new(value: u64) -> Self {
        Self { value: Word::from(value), id: get_signal_id() }
    }

    /// The value of the constant.
    #[inline]
    pub const fn val(&self) -> Word<N> {
        self.value
    }
}

/// The mask of all bits that a counter from 0 to `greatest` can set. Kernels mask their timers with
/// it, so that the unused upper bits are constantly zero and synthesis removes their flip-flops.
pub(crate) const fn used_bits(greatest: u64) -> u64 {
    match greatest.checked_ilog2() {
        Some(top) => (2 << top) - 1,
        None => 0,
    }
}

/// Implements the traits that Rust-HDL requires of a constant.
macro_rules! constant_atom {
    ([$($generics:tt)*] $type:ty) => {
        impl<$($generics)*> Logic for $type {
            fn update(&mut self) {}
        }

        impl<$($generics)*> Block for $type {
            fn connect_all(&mut self) {}
            #[inline]
            fn update_all(&mut self) {}
            #[inline]
            fn has_changed(&self) -> bool {
                false
            }
            fn accept(&self, name: &str, probe: &mut dyn Probe) {
                probe.visit_atom(name, self);
            }
        }

        impl<$($generics)*> Atom for $type {
            fn bits(&self) -> usize {
                N
            }
            fn connected(&self) -> bool {
                true
            }
            fn changed(&self) -> bool {
                false
            }
            fn kind(&self) -> AtomKind {
                AtomKind::Constant
            }
            fn descriptor(&self) -> TypeDescriptor {
                Word::<N>::descriptor()
            }
            fn vcd(&self) -> VCDValue {
                self.val().vcd()
            }
            fn id(&self) -> usize {
                self.id
            }
            fn verilog(&self) -> VerilogLiteral {
                self.val().verilog()
            }
            fn constraints(&self) -> Vec<PinConstraint> {
                Vec::new()
            }
        }
    };
}

constant_atom!([const N: usize, const VALUE: u64] Literal<N, VALUE>);
constant_atom!([const N: usize] Parameter<N>);
