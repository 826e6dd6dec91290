//! Selects the counts of the pulser that belongs to the axis of a time slot.
//!
//! Interface: one of these modules per lane; all of them receive the counts of all pulsers.
//!
//! Cost: six cells per axis of the lane; synthesis removes the others.

use crate::primitives::compiled_once;
use crate::primitives::constant::{Literal, Parameter};
use crate::primitives::per_axis::PerAxis;
use crate::primitives::register::Input;
use crate::primitives::word::Word;
use rust_hdl_core::prelude::*;

/// The selection of one lane, for N axes.
#[derive(LogicBlock)]
pub struct LaneCounts<const N: usize> {
    /// The axis of the time slot, one-hot.
    pub axis_one_hot: Input<Word<N>>,
    /// The counts of all pulsers, 6 bits each, those of axis 0 lowest.
    pub all: Input<Word<48>>,
    /// The counts of the axis of the time slot.
    pub counts: Signal<Out, Word<6>>,
    moved: PerAxis<Signal<Local, Word<48>>, N>,
    chosen: PerAxis<Signal<Local, Word<6>>, N>,
    found: Signal<Local, Word<6>>,
    at: PerAxis<Parameter<6>, N>,
    none: Literal<6, 0>,
}

impl<const N: usize> Default for LaneCounts<N> {
    fn default() -> Self {
        Self {
            axis_one_hot: Default::default(),
            all: Default::default(),
            counts: Default::default(),
            moved: PerAxis::default(),
            chosen: PerAxis::default(),
            found: Default::default(),
            at: PerAxis::from_fn(|axis| Parameter::new(6 * axis as u64)),
            none: Literal::default(),
        }
    }
}

compiled_once::logic!(LaneCounts<N = 8>);

impl<const N: usize> compiled_once::Kernel for LaneCounts<N> {
    #[hdl_gen]
    fn update(&mut self) {
        self.found.next = self.none.val();
        for i in 0..N {
            self.moved[i].next = self.all.val() >> self.at[i].val();
            self.chosen[i].next = self.none.val();
            if self.axis_one_hot.val().get_bit(i) {
                self.chosen[i].next = self.moved[i].val().get_bits::<6>(0);
            }
            self.found.next = self.found.val() | self.chosen[i].val();
        }
        self.counts.next = self.found.val();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::assert_synthesizes;

    #[test]
    fn lane_counts_synthesizes() {
        assert_synthesizes(LaneCounts::<6>::default(), "carrystep_lane_counts");
    }
}
