//! The self-test of a board: outputs become active one after the other, slowly, and changes of
//! inputs are reported over the UART (docs/self-test.md). It moves nothing: the drivers have no
//! power, and no pin changes more often than once a second.
//!
//! ```text
//!            .------. next output        .--------. byte   .------.
//!            | walk |------------------->|        |------->|      |---> tx
//!  active <--|      |                    | speech |        | uart |
//!            '------'  .-------. changed |        |<-------|      |<--- rx
//!  pins -------------->| watch |-------->|        | echo   '------'
//!                      '-------'         '--------'
//! ```
//!
//! Interface: pins, the UART, and the LED. Bit i of a mask of pins is the pin of row i, a line of
//! text in the memory of `speech`; the board's top level connects the bits that have a pin. The
//! module does not drive `enable_n`: that is a constant of the top level.
//!
//! Cost: block RAM for 64 bytes per pin, three flip-flops per input, one per output, the UART, and
//! a timer of half a second.

use crate::line::UartLine;
use crate::primitives::register::Input;
use crate::primitives::word::Word;
use rust_hdl_core::prelude::*;

mod sim;
pub mod speech;
pub mod walk;
pub mod watch;

pub use sim::SelfTestSim;

use speech::Speech;
use walk::Walk;
use watch::Watch;

/// The self-test.
#[derive(LogicBlock, Default)]
pub struct SelfTest {
    /// The clock.
    pub clock: Input<Clock>,
    /// The line from the host, high when idle; asynchronous.
    pub rx: Input<Bit>,
    /// The line to the host.
    pub tx: Signal<Out, Bit>,
    /// The levels of the inputs, each at the bit of its row, and 0 at the other bits; asynchronous.
    pub pins: Input<Word<64>>,
    /// The output that is 1, at the bit of its row; bit 0: none is.
    pub active: Signal<Out, Word<64>>,
    /// The LED is lit.
    pub lit: Signal<Out, Bit>,
    walk: Walk,
    watch: Watch,
    speech: Speech,
    uart: UartLine,
}

impl SelfTest {
    /// Makes the self-test of this build, which has been checked.
    pub fn new(build: &carrystep_core::SelfTest) -> Self {
        Self {
            walk: Walk::new(build),
            watch: Watch::new(build),
            speech: Speech::new(build),
            uart: UartLine::new(build.uart()),
            ..Self::default()
        }
    }
}

impl Logic for SelfTest {
    #[hdl_gen]
    fn update(&mut self) {
        clock!(self, clock, walk, watch, speech, uart);
        self.walk.idle.next = self.speech.idle.val();
        self.watch.pins.next = self.pins.val();
        self.watch.scans.next = self.speech.idle.val() & !self.walk.walks.val();

        self.speech.walks.next = self.walk.walks.val();
        self.speech.slot.next = self.walk.next_slot.val();
        self.speech.changed.next = self.watch.changed.val();
        self.speech.scanned.next = self.watch.scanned.val();
        self.speech.levels.next = self.watch.seen.val() | self.walk.active.val();
        self.speech.received.next = self.uart.received.val();
        self.speech.received_valid.next = self.uart.received_valid.val();
        self.speech.take.next = self.uart.answer_take.val();

        self.uart.rx.next = self.rx.val();
        self.uart.answer.next = self.speech.data.val();
        self.uart.answer_valid.next = self.speech.offered.val();

        self.tx.next = self.uart.tx.val();
        self.active.next = self.walk.active.val();
        self.lit.next = self.walk.lit.val();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::assert_synthesizes;
    use carrystep_core::link::Uart;
    use carrystep_core::self_test::Rows;

    #[test]
    fn self_test_synthesizes() {
        let rows = Rows {
            heading: "board".into(),
            outputs: vec!["step = \u{1}".into(); 3],
            inputs: vec!["estop = \u{1}".into(); 2],
            fixed: vec!["led".into()],
        };
        let uart = Uart::new(48_000_000, 115_200).unwrap();
        let build = carrystep_core::SelfTest::new(uart, 24_000_000, rows).unwrap();
        assert_synthesizes(SelfTest::new(&build), "carrystep_self_test");
    }
}
