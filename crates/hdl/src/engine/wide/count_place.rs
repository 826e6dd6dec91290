//! Puts the counts of one pulser at their place in the word of the counts of all pulsers.
//!
//! Rust-HDL widens no element of an array, therefore this is a module.
//!
//! Cost: none.

use crate::primitives::register::Input;
use crate::primitives::word::{Word, bit_cast};
use rust_hdl_core::prelude::*;

/// The counts of one pulser, widened and moved.
#[derive(LogicBlock, Default)]
pub struct CountPlace {
    /// The counts of the pulser.
    pub counts: Input<Word<6>>,
    /// The place of their lowest bit.
    pub place: Input<Word<6>>,
    /// The counts at their place; the other bits are 0.
    pub all: Signal<Out, Word<48>>,
}

impl Logic for CountPlace {
    #[hdl_gen]
    fn update(&mut self) {
        self.all.next = bit_cast::<48, 6>(self.counts.val()) << self.place.val();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::assert_synthesizes;

    #[test]
    fn count_place_synthesizes() {
        assert_synthesizes(CountPlace::default(), "carrystep_count_place");
    }
}
