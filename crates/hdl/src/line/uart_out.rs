//! The UART transmitter: a start bit, eight data bits, least significant first, and one stop bit.
//!
//! ```text
//! take     /^\_______________________________________________
//! line     ^^^\_______/ bit 0 / bit 1 / ... / bit 7 /^^^^^^^^
//!             |<- B ->|
//! ```
//!
//! B is the duration of a bit in clocks.
//!
//! Cost: a shift register of 9 bits and a timer that is as wide as B requires.

use crate::parameters::BIT_CLOCKS;
use crate::primitives::constant::{Literal, Parameter};
use crate::primitives::formula::Formula;
use crate::primitives::register::{Input, Register};
use crate::primitives::word::{Word, bit_cast};
use rust_hdl_core::prelude::*;

/// The UART transmitter.
#[derive(LogicBlock, Default)]
pub struct UartOut {
    /// The clock.
    pub clock: Input<Clock>,
    /// The byte that the link offers.
    pub data: Input<Word<8>>,
    /// The link offers a byte and holds it until the transmitter accepts it.
    pub valid: Input<Bit>,
    /// The transmitter accepts the offered byte in this clock.
    pub take: Signal<Out, Bit>,
    /// The line to the host.
    pub line: Signal<Out, Bit>,
    pin: Register<Bit>,      // `line`
    bits: Register<Word<9>>, // the stop bit is shifted down behind the byte
    timer: Register<Word<16>>,
    due: Signal<Local, Bit>,
    taken: Signal<Local, Bit>,
    last_clock: Parameter<16>,
    timer_bits: Parameter<16>,
    one: Literal<16, 1>,
    stop: Literal<9, 0x100>,
    by_one: Literal<1, 1>,
}

impl UartOut {
    /// Makes a transmitter for bits of `bit_clocks` clocks. The build has checked the range of
    /// `bit_clocks`.
    pub fn new(bit_clocks: u32) -> Self {
        let last = BIT_CLOCKS.of::<32>(bit_clocks).bits::<16>(0) - Formula::number(1);
        Self {
            pin: Register::new(true),
            last_clock: Parameter::of(&last),
            timer_bits: Parameter::of(&last.used_bits()),
            ..Self::default()
        }
    }
}

impl Logic for UartOut {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, pin, bits, timer);
        self.due.next = !self.timer.q.val().any();
        self.taken.next = self.due.val() & !self.bits.q.val().any() & self.valid.val();

        // While no byte is sent the timer stays at zero, so that a new byte begins at once.
        if !self.due.val() {
            self.timer.d.next = (self.timer.q.val() - self.one.val()) & self.timer_bits.val();
        }
        if self.due.val() & self.bits.q.val().any() {
            self.timer.d.next = self.last_clock.val();
            self.bits.d.next = self.bits.q.val() >> self.by_one.val();
            self.pin.d.next = self.bits.q.val().get_bit(0);
        }
        if self.taken.val() {
            self.timer.d.next = self.last_clock.val();
            self.bits.d.next = bit_cast::<9, 8>(self.data.val()) | self.stop.val();
            self.pin.d.next = false;
        }

        self.take.next = self.taken.val();
        self.line.next = self.pin.q.val();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::assert_synthesizes;

    #[test]
    fn uart_out_synthesizes() {
        assert_synthesizes(UartOut::new(16), "carrystep_uart_out");
    }
}
