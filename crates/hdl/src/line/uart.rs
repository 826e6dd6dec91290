//! A UART: the receiver and the transmitter with the ports of a line.

use super::uart_in::UartIn;
use super::uart_out::UartOut;
use crate::primitives::register::Input;
use crate::primitives::word::Word;
use carrystep_core::link::Uart;
use rust_hdl_core::prelude::*;

/// A UART with a receiver and a transmitter.
#[derive(LogicBlock, Default)]
pub struct UartLine {
    /// The clock.
    pub clock: Input<Clock>,
    /// The line from the host, high when idle; asynchronous.
    pub rx: Input<Bit>,
    /// The line to the host.
    pub tx: Signal<Out, Bit>,
    /// The received byte. It is valid while `received_valid` is asserted and stays until the next
    /// byte begins.
    pub received: Signal<Out, Word<8>>,
    /// Asserted for one clock per received byte.
    pub received_valid: Signal<Out, Bit>,
    /// The byte of the answer that the link offers.
    pub answer: Input<Word<8>>,
    /// The link offers a byte and holds it until the line accepts it.
    pub answer_valid: Input<Bit>,
    /// The line accepts the offered byte in this clock.
    pub answer_take: Signal<Out, Bit>,
    uart_in: UartIn,
    uart_out: UartOut,
}

impl UartLine {
    /// Makes the line for the baud rate and the clock of this UART.
    pub fn new(uart: Uart) -> Self {
        let bit_clocks = uart.bit_clocks();
        Self {
            uart_in: UartIn::new(bit_clocks),
            uart_out: UartOut::new(bit_clocks),
            ..Self::default()
        }
    }
}

impl Logic for UartLine {
    #[hdl_gen]
    fn update(&mut self) {
        clock!(self, clock, uart_in, uart_out);
        self.uart_in.line.next = self.rx.val();
        self.received.next = self.uart_in.data.val();
        self.received_valid.next = self.uart_in.valid.val();
        self.uart_out.data.next = self.answer.val();
        self.uart_out.valid.next = self.answer_valid.val();
        self.answer_take.next = self.uart_out.take.val();
        self.tx.next = self.uart_out.line.val();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::assert_synthesizes;

    #[test]
    fn uart_synthesizes() {
        assert_synthesizes(
            UartLine::new(Uart::new(48_000_000, 3_000_000).unwrap()),
            "carrystep_uart",
        );
    }
}
