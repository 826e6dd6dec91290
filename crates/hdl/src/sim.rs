//! Drives a module from outside, one clock cycle at a time.
//!
//! ```text
//! clock    ____/^^^^\____/^^^^\____
//!            ^    ^    ^    ^
//!       settle  clock  settle  clock
//! ```
//!
//! The caller changes the inputs while the clock is low and calls `settle`, then reads the outputs,
//! then calls `clock`, which raises the clock.

use crate::HdlError;
use rust_hdl_core::prelude::{Bit, Block, Out, Signal, check_all, simulate};

/// The largest number of simulation passes for one cycle. Every module of this crate settles in
/// fewer.
const PASSES: usize = 50;

/// Simulates until the combinational outputs have followed the inputs.
pub(crate) fn settle<B: Block>(block: &mut B) {
    let settled = simulate(block, PASSES);
    debug_assert!(settled, "a combinational loop, which check_all would have refused");
}

/// Simulates a rising clock edge. One pass is enough, because the edge reaches every register in
/// that pass ([`crate::primitives::register`]).
pub(crate) fn rising_edge<B: Block>(block: &mut B) {
    block.update_all();
}

/// Connects the ports of a module and runs Rust-HDL's checks on it.
pub(crate) fn connected<B: Block>(mut block: B) -> Result<Box<B>, HdlError> {
    block.connect_all();
    check_all(&block).map_err(|error| HdlError::Check(format!("{error:?}")))?;
    Ok(Box::new(block))
}

/// Collects one pin of each axis in a mask, in which bit i is the pin of axis i.
pub(crate) fn mask(bits: &[Signal<Out, Bit>]) -> u8 {
    bits.iter().rev().fold(0, |mask, bit| mask << 1 | u8::from(bit.val()))
}

/// Asserts that Rust-HDL's checks accept the module and that yosys accepts its Verilog.
#[cfg(test)]
pub(crate) fn assert_synthesizes<B: Block>(module: B, name: &str) {
    use crate::engine::layout::INDICES;
    use rust_hdl_core::prelude::{generate_verilog, yosys_validate};
    let module = connected(module).unwrap();
    // Rust-HDL writes the names of indices as they stand in the kernel.
    let named = generate_verilog(module.as_ref());
    let text = INDICES.iter().fold(named, |text, (name, value)| {
        let text = text.replace(&format!("[{name}]"), &format!("[{value}]"));
        text.replace(&format!("[({name})"), &format!("[({value})"))
    });
    yosys_validate(name, &text).unwrap();
}
