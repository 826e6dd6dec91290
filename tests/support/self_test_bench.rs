//! A bench with a self-test, a terminal at the other end of its UART, and jumpers at its inputs.
//! The Rust-HDL module runs in lock-step with the model, if the bench has it.

use crate::link_bench::{Receiver, Sender};
use carrystep_core::SelfTest;
use carrystep_core::self_test::{SelfTestInputs, SelfTestOutputs};
use carrystep_hdl::SelfTestSim;
use carrystep_simulators::vectors::{Bits, Vectors};
use std::collections::VecDeque;

const INPUTS: &[(&str, u32)] = &[("rx", 1), ("pins", 64)];
const OUTPUTS: &[(&str, u32)] = &[("tx", 1), ("lit", 1), ("active", 64)];

/// A self-test and what is connected to it.
pub struct SelfTestBench {
    model: carrystep_model::SelfTest,
    hdl: Option<SelfTestSim>,
    sender: Sender,
    receiver: Receiver,
    bytes: VecDeque<u8>,
    /// The levels of the inputs, at the bits of their rows.
    pub pins: u64,
    /// The outputs of the last cycle.
    pub outputs: SelfTestOutputs,
    /// What the terminal has received.
    pub text: Vec<u8>,
    /// Number of cycles so far.
    pub clocks: u64,
    /// The level of the line from the host in the last cycle.
    pub rx: bool,
}

impl SelfTestBench {
    /// The model alone, with all inputs open.
    pub fn of_model(test: &SelfTest) -> Self {
        let model = carrystep_model::SelfTest::new(test);
        let bit_clocks = test.uart().bit_clocks();
        Self {
            outputs: model.outputs(),
            model,
            hdl: None,
            sender: Sender::new(bit_clocks),
            receiver: Receiver::new(bit_clocks),
            bytes: VecDeque::new(),
            pins: test.inputs(),
            text: Vec::new(),
            clocks: 0,
            rx: true,
        }
    }

    /// The model and the Rust-HDL module.
    ///
    /// # Panics If Rust-HDL rejects the module.
    pub fn of_both(test: &SelfTest) -> Self {
        Self { hdl: Some(SelfTestSim::new(test).expect("a self-test")), ..Self::of_model(test) }
    }

    /// Appends bytes to those that the terminal sends.
    pub fn send(&mut self, bytes: &[u8]) {
        self.bytes.extend(bytes);
    }

    /// Executes one cycle.
    ///
    /// # Panics If model and Rust-HDL differ.
    pub fn clock(&mut self) {
        self.rx = self.sender.clock(&mut self.bytes);
        let inputs = SelfTestInputs { rx: self.rx, pins: self.pins };
        self.outputs = self.model.outputs();
        if let Some(hdl) = &mut self.hdl {
            let shown = hdl.settle(&inputs);
            assert_eq!(shown, self.outputs, "cycle {}: Rust-HDL and model", self.clocks);
            hdl.clock();
        }
        self.model.clock(&inputs);
        self.text.extend(self.receiver.clock(self.outputs.tx));
        self.clocks += 1;
    }
}

/// An empty recording of the module's ports.
pub fn module_vectors() -> Vectors {
    Vectors::new(INPUTS, OUTPUTS)
}

/// Adds the last cycle of a bench to a recording of the module's ports.
pub fn record(vectors: &mut Vectors, bench: &SelfTestBench) {
    let inputs = Bits::default().and(1, u64::from(bench.rx)).and(64, bench.pins);
    let SelfTestOutputs { tx, lit, active } = bench.outputs;
    let outputs = Bits::default().and(1, u64::from(tx)).and(1, u64::from(lit)).and(64, active);
    vectors.add(inputs, outputs);
}
