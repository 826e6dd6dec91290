//! Constants that a kernel can name. In the Verilog they are local parameters.
//!
//! Rust-HDL's own `Constant` has no default, so that a module that contains one would have to name
//! every field in its constructor. The types here have a default. The value of a [`Literal`] is
//! part of its type; the value of a [`Parameter`] is set when the module is built, and a parameter
//! that is made of a [`Formula`] follows in the Verilog from parameters of the module. A
//! [`ParameterRefusal`] exists in the Verilog only: it says which values of the parameters are
//! refused.

use crate::primitives::formula::{Formula, Note, ParameterValue};
use crate::primitives::word::Word;
use rust_hdl_core::prelude::{
    Atom, AtomKind, Block, Logic, PinConstraint, Probe, Synth, TypeDescriptor, VCDValue,
    VerilogLiteral,
};
use rust_hdl_core::signal::get_signal_id;

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
    note: Option<Note>,
    id: usize,
}

impl<const N: usize> Default for Parameter<N> {
    fn default() -> Self {
        Self::new(0)
    }
}

impl<const N: usize> Parameter<N> {
    /// Makes a constant that no parameter of the Verilog changes. The caller ensures that `value`
    /// fits in N bits; higher bits are dropped.
    pub fn new(value: u64) -> Self {
        Self { value: Word::from(value), note: None, id: get_signal_id() }
    }

    /// The number that follows from parameters of the Verilog.
    pub fn of(formula: &Formula<N>) -> Self {
        Self { value: formula.value(), note: Some(Note::of(formula, false)), id: get_signal_id() }
    }

    /// The value of the constant.
    #[inline]
    pub const fn val(&self) -> Word<N> {
        self.value
    }
}

/// States that some parameters of the Verilog are out of range. Where the formula is 1, the Verilog
/// instantiates a module that does not exist and that is named after this field. In a build of
/// Rust-HDL the formula is 0, because the constructor of the module has checked its arguments.
#[derive(Debug)]
pub struct ParameterRefusal {
    value: Word<1>,
    note: Option<Note>,
    id: usize,
}

impl Default for ParameterRefusal {
    fn default() -> Self {
        Self::of(&Formula::number(0))
    }
}

impl ParameterRefusal {
    /// Makes the refusal of all parameters for which `formula` is 1.
    pub fn of(formula: &Formula<1>) -> Self {
        Self { value: formula.value(), note: Some(Note::of(formula, true)), id: get_signal_id() }
    }

    const fn val(&self) -> Word<1> {
        self.value
    }
}

/// The Verilog writes this before the name of a [`ParameterRefusal`] to name the module that does
/// not exist.
pub const ERROR: &str = "carrystep_error_";

/// A parameter of a module whose Verilog is written as text; both have the same name.
#[derive(Debug)]
pub struct TextParameter {
    name: String,
    value: Word<64>,
    note: Note,
    id: usize,
}

impl TextParameter {
    /// Makes the constant of this parameter.
    pub fn new(given: ParameterValue) -> Self {
        let (name, text, value) =
            (given.name.clone(), given.name.clone(), Word::from(given.number()));
        Self {
            name,
            value,
            note: Note { text, given: vec![given], is_refusal: false },
            id: get_signal_id(),
        }
    }

    /// The name of the parameter.
    pub fn name(&self) -> &str {
        &self.name
    }

    const fn val(&self) -> Word<64> {
        self.value
    }
}

/// Implements the traits that Rust-HDL requires of a constant.
macro_rules! constant_atom {
    ([$($generics:tt)*] $type:ty, $bits:expr, $note:expr) => {
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
                $bits
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
                let note: fn(&Self) -> Option<&Note> = $note;
                let plain = Word::<{ $bits }>::descriptor();
                let name = note(self).map_or(plain.name, Note::written);
                TypeDescriptor { name, kind: plain.kind }
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

constant_atom!([const N: usize, const VALUE: u64] Literal<N, VALUE>, N, |_| None);
constant_atom!([const N: usize] Parameter<N>, N, |this| this.note.as_ref());
constant_atom!([] ParameterRefusal, 1, |this| this.note.as_ref());
constant_atom!([] TextParameter, 64, |this| Some(&this.note));
