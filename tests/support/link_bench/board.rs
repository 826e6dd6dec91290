//! Records the inputs and outputs of a board's pins, except the oscillator.

use carrystep_boards::Board;
use carrystep_core::AXES;
use carrystep_core::engine::{EngineInputs, EngineOutputs};
use carrystep_simulators::vectors::{Bits, Vectors};

/// Cycles from the lock of the PLL to the first edge of the gated clock (docs/decisions/0033).
const LATE: u64 = 1026;

const MASK: u32 = AXES as u32;

const INPUTS: &[(&str, u32)] = &[("uart_rx", 1), ("estop", 1), ("limit_min", MASK)];
const OUTPUTS: &[(&str, u32)] = &[("uart_tx", 1), ("enable_n", 1), ("step", MASK), ("dir", MASK)];

/// The pins of a board with one limit switch per axis.
#[derive(Debug)]
pub struct BoardPins {
    board: &'static Board,
    /// Levels from the lock on, in cycles of the oscillator.
    pub vectors: Vectors,
}

impl BoardPins {
    /// The recording up to the first edge of the gated clock.
    pub fn new(board: &'static Board) -> Self {
        let mut vectors = Vectors::new(INPUTS, OUTPUTS);
        vectors.clock = "oscillator";
        let led = (board.bits("led") > 0).then_some("led");
        let ties = board.ties.iter().map(|tie| tie.port.as_str());
        vectors.outputs.to_mut().extend(led.into_iter().chain(ties).map(|port| (port, 1)));
        let mut pins = Self { board, vectors };
        for _ in 0..LATE {
            pins.add(true, &EngineInputs::default(), true, &EngineOutputs::default());
        }
        pins
    }

    /// Adds one cycle.
    pub(super) fn add(&mut self, rx: bool, pins: &EngineInputs, tx: bool, shown: &EngineOutputs) {
        let told = Bits::default().and(1, u64::from(rx)).and(1, u64::from(pins.estop));
        let mut showed = Bits::default()
            .and(1, u64::from(tx))
            .and(1, u64::from(!shown.enabled))
            .and(MASK, u64::from(shown.step))
            .and(MASK, u64::from(shown.dir));
        if self.board.bits("led") > 0 {
            // The LED is lit while no stop has been called.
            showed = showed.and(1, u64::from(shown.fault.is_none() != self.board.led_low));
        }
        let showed =
            self.board.ties.iter().fold(showed, |showed, tie| showed.and(1, u64::from(tie.level)));
        self.vectors.add(told.and(MASK, u64::from(pins.limit_min)), showed);
    }
}
