//! Drives the modules from outside, one clock cycle at a time.
//!
//! ```text
//! clock    ____/^^^^\____/^^^^\____
//!            ^    ^    ^    ^
//!       settle  clock  settle  clock      inputs change with the falling edge, outputs are read before the rising one
//! ```

use crate::HdlError;
use rust_hdl::prelude::{Bit, Block, Out, Signal, check_all, simulate};

/// Passes in which any module here settles, with room to spare.
const PASSES: usize = 50;

/// Lets the combinational outputs follow the inputs.
pub(crate) fn settle<B: Block>(block: &mut B) {
    let settled = simulate(block, PASSES);
    debug_assert!(settled, "a combinational loop, which check_all would have refused");
}

/// Moves every register on: the clock edge reaches all of them in one pass ([`crate::primitives::register`]).
pub(crate) fn rising_edge<B: Block>(block: &mut B) {
    block.update_all();
}

pub(crate) fn connected<B: Block>(mut block: B) -> Result<Box<B>, HdlError> {
    block.connect_all();
    check_all(&block).map_err(|error| HdlError::Check(format!("{error:?}")))?;
    Ok(Box::new(block))
}

/// The pins of all axes, bit i is axis i.
pub(crate) fn mask(bits: &[Signal<Out, Bit>]) -> u8 {
    bits.iter().rev().fold(0, |mask, bit| mask << 1 | u8::from(bit.val()))
}

/// Rust-HDL's checks, its Verilog and yosys accept the module.
#[cfg(test)]
pub(crate) fn assert_synthesizes<B: Block>(module: B, name: &str) {
    use rust_hdl::prelude::{generate_verilog, yosys_validate};
    let module = connected(module).unwrap();
    yosys_validate(name, &generate_verilog(module.as_ref())).unwrap();
}
