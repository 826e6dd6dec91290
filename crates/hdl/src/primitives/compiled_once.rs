//! The code of a generic module's kernel, compiled for one size only.
//!
//! From a kernel, Rust-HDL makes the method `hdl`, which lists the kernel's statements for the
//! Verilog. It is many times as long as the kernel. Rust would compile it once for each size of a
//! generic module, although the lists of two sizes differ only in numbers: the bounds of loops over
//! the axes, and the widths of slices that have one bit per axis. A module that implements [`Kernel`]
//! and is named in [`logic`] has its `hdl` compiled for one size. For another size, [`resized`]
//! replaces these numbers in the list that this `hdl` gives.

use rust_hdl_core::prelude::Verilog;
use rust_hdl_core::prelude::ast::{
    VerilogBlock, VerilogBlockOrConditional, VerilogExpression, VerilogLoop, VerilogStatement,
};

/// What `hdl_gen` makes of a kernel. A module implements it in place of Rust-HDL's `Logic`.
pub(crate) trait Kernel {
    /// The kernel.
    fn update(&mut self);
    /// Marks the signals that the kernel drives.
    fn connect(&mut self);
    /// The kernel's statements.
    fn hdl(&self) -> Verilog;
}

/// Implements `Logic` for a generic module that implements [`Kernel`]: `logic!(WideEngine<N = 8, K = 6>)`
/// compiles `hdl` for 8 and 6. In the kernel, a loop to 8 must be one to N and a slice of 8 bits one
/// of N bits, and the same for K; [`assert_sizes_agree`] finds out. A kernel that has slices of 8 bits
/// for another reason is compiled for 7.
///
/// `logic!(Engine<N = 8>, latch_bank)` names a part that not every build has
/// ([`Optional`](super::optional::Optional)). In such a kernel, a loop to 1 must be one to its number of
/// elements, and there may be no slice of one bit.
macro_rules! logic {
    ($module:ident<$($size:ident = $compiled:literal),+> $(, $part:ident)?) => {
        impl<$(const $size: usize),+> Logic for $module<$($size),+> {
            #[inline]
            fn update(&mut self) {
                $crate::primitives::compiled_once::Kernel::update(self);
            }
            fn connect(&mut self) {
                $crate::primitives::compiled_once::Kernel::connect(self);
            }
            fn hdl(&self) -> Verilog {
                let compiled = Box::<$module<$($compiled),+>>::default();
                let sizes = [$(($compiled, $size),)+ $((1, self.$part.len()))?];
                let code = $crate::primitives::compiled_once::Kernel::hdl(&*compiled);
                $crate::primitives::compiled_once::resized(code, &sizes)
            }
        }
    };
}
pub(crate) use logic;

/// The statements for other sizes; `sizes` contains the compiled and the wanted one.
pub(crate) fn resized(code: Verilog, sizes: &[(usize, usize)]) -> Verilog {
    match code {
        Verilog::Combinatorial(mut block) => {
            resize(&mut block, sizes);
            Verilog::Combinatorial(block)
        }
        other => other,
    }
}

fn resize(block: &mut VerilogBlock, sizes: &[(usize, usize)]) {
    let wanted =
        |size| sizes.iter().find(|(compiled, _)| *compiled == size).map(|(_, wanted)| *wanted);
    for statement in block {
        match statement {
            VerilogStatement::Assignment(_, VerilogExpression::Slice(_, width, _)) => {
                *width = wanted(*width).unwrap_or(*width);
            }
            VerilogStatement::If(conditional) => {
                resize(&mut conditional.then, sizes);
                if let VerilogBlockOrConditional::Block(block) = &mut conditional.otherwise {
                    resize(block, sizes);
                }
            }
            VerilogStatement::Loop(VerilogLoop { to, block, .. }) => {
                if let Some(wanted) = wanted(to.as_usize()) {
                    *to = wanted.into();
                }
                resize(block, sizes);
            }
            _ => {}
        }
    }
}

/// Asserts that a module has the same statements whether its `hdl` was compiled for its own size or
/// for the one of [`logic`].
///
/// Two other sizes are enough for a module, one of them no power of two. If a bound or a width in the
/// kernel is not the size itself, it differs from the number that [`resized`] inserts at every size but
/// the compiled one. An exception is a formula that equals the size at some sizes, such as the next
/// power of two; so two are compared.
#[cfg(test)]
pub(crate) fn assert_sizes_agree<M: Kernel + rust_hdl_core::prelude::Logic + Default>() {
    assert_sizes_agree_of(&*Box::<M>::default());
}

/// The same for a module whose optional part is not the default one.
#[cfg(test)]
pub(crate) fn assert_sizes_agree_of<M: Kernel + rust_hdl_core::prelude::Logic>(module: &M) {
    let (own, replaced) = (Kernel::hdl(module), rust_hdl_core::prelude::Logic::hdl(module));
    let (own, replaced) = (format!("{own:#?}"), format!("{replaced:#?}"));
    for (own, replaced) in own.lines().zip(replaced.lines()) {
        assert_eq!(own, replaced);
    }
    assert_eq!(own.len(), replaced.len());
}
