//! Simulates the self-test, clock by clock.

use super::SelfTest;
use crate::HdlError;
use crate::primitives::word::Word;
use crate::sim::{connected, rising_edge, settle};
use carrystep_core::self_test::{SelfTestInputs, SelfTestOutputs};

/// A simulated self-test.
pub struct SelfTestSim {
    module: Box<SelfTest>,
}

impl SelfTestSim {
    /// Makes the self-test of this build, in cycle 0.
    ///
    /// # Errors
    /// Returns an [`HdlError`] if Rust-HDL's checks reject the module.
    pub fn new(build: &carrystep_core::SelfTest) -> Result<Self, HdlError> {
        Ok(Self { module: connected(SelfTest::new(build))? })
    }

    /// Applies the inputs and returns the outputs of the present cycle.
    pub fn settle(&mut self, inputs: &SelfTestInputs) -> SelfTestOutputs {
        let module = self.module.as_mut();
        module.clock.next = false.into();
        module.rx.next = inputs.rx;
        module.pins.next = Word::from(inputs.pins);
        settle(module);
        SelfTestOutputs {
            tx: module.tx.val(),
            lit: module.lit.val(),
            active: module.active.val().value() as u64,
        }
    }

    /// Advances to the next cycle. The inputs are those of the last call of `settle`.
    pub fn clock(&mut self) {
        self.module.clock.next = true.into();
        rising_edge(self.module.as_mut());
    }
}
