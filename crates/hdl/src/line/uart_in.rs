//! The UART receiver: eight data bits, least significant first, no parity, one stop bit.
//!
//! ```text
//! line     ^^^\_______/ bit 0 / bit 1 / ... / bit 7 /^^^^^^^^
//!             |<- B ->|
//! samples          (start)  ^       ^            ^       ^
//! valid                                             /^\
//! ```
//!
//! B is the duration of a bit in clocks. The receiver samples the first bit B + B/2 clocks after
//! the line has fallen, then one bit every B clocks. It asserts `valid` if the stop bit is high;
//! otherwise it discards the byte.
//!
//! Cost: a shift register of 9 bits and a timer that is as wide as B requires.

use crate::parameters::BIT_CLOCKS;
use crate::primitives::constant::{Literal, Parameter, ParameterRefusal};
use crate::primitives::formula::Formula;
use crate::primitives::register::{Input, Register};
use crate::primitives::word::Word;
use carrystep_core::link::{MAX_BIT_CLOCKS, MIN_BIT_CLOCKS};
use rust_hdl_core::prelude::*;

/// The UART receiver.
#[derive(LogicBlock, Default)]
pub struct UartIn {
    /// The clock.
    pub clock: Input<Clock>,
    /// The line from the host, high when idle; asynchronous.
    pub line: Input<Bit>,
    /// The received byte. It is valid while `valid` is asserted and stays until the next byte
    /// begins.
    pub data: Signal<Out, Word<8>>,
    /// Asserted for one clock per received byte.
    pub valid: Signal<Out, Bit>,
    sync: Register<Bit>,
    now: Register<Bit>,
    busy: Register<Bit>,
    bits: Register<Word<9>>, // a 1 is shifted down behind the byte and marks its end
    timer: Register<Word<16>>,
    due: Signal<Local, Bit>,
    done: Signal<Local, Bit>,
    to_first: Parameter<16>,
    to_next: Parameter<16>,
    timer_bits: Parameter<16>,
    one: Literal<16, 1>,
    mark: Literal<9, 0x100>,
    top: Literal<9, 0x100>,
    by_one: Literal<1, 1>,
    bit_clocks_out_of_range: ParameterRefusal,
}

impl UartIn {
    /// Makes a receiver for bits of `bit_clocks` clocks. The build has checked the range of
    /// `bit_clocks`.
    pub fn new(bit_clocks: u32) -> Self {
        let bit = BIT_CLOCKS.of::<32>(bit_clocks);
        // A bit and a half; MAX_BIT_CLOCKS keeps it in 16 bits.
        let to_first = (bit.bits::<16>(0) + bit.bits::<16>(1)) - Formula::number(1);
        Self {
            sync: Register::new(true),
            now: Register::new(true),
            to_first: Parameter::of(&to_first),
            to_next: Parameter::of(&(bit.bits(0) - Formula::number(1))),
            timer_bits: Parameter::of(&to_first.used_bits()),
            bit_clocks_out_of_range: ParameterRefusal::of(
                &bit.is_outside(MIN_BIT_CLOCKS.into(), MAX_BIT_CLOCKS.into()),
            ),
            ..Self::default()
        }
    }
}

impl Logic for UartIn {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, sync, now, busy, bits, timer);
        self.sync.d.next = self.line.val();
        self.now.d.next = self.sync.q.val();

        self.due.next = !self.timer.q.val().any();
        self.done.next = self.busy.q.val() & self.due.val() & self.bits.q.val().get_bit(0);
        self.timer.d.next = (self.timer.q.val() - self.one.val()) & self.timer_bits.val();
        if self.due.val() {
            self.timer.d.next = self.to_next.val();
        }
        if self.busy.q.val() & self.due.val() & !self.bits.q.val().get_bit(0) {
            self.bits.d.next = self.bits.q.val() >> self.by_one.val();
            if self.now.q.val() {
                self.bits.d.next = (self.bits.q.val() >> self.by_one.val()) | self.top.val();
            }
        }
        if self.done.val() {
            self.busy.d.next = false;
        }
        if !self.busy.q.val() & !self.now.q.val() {
            self.busy.d.next = true;
            self.bits.d.next = self.mark.val();
            self.timer.d.next = self.to_first.val();
        }

        self.data.next = self.bits.q.val().get_bits::<8>(1);
        self.valid.next = self.done.val() & self.now.q.val();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::assert_synthesizes;

    #[test]
    fn uart_in_synthesizes() {
        assert_synthesizes(UartIn::new(16), "carrystep_uart_in");
    }
}
