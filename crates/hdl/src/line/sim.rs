//! Simulates a line to the host, clock by clock.

use super::{Spi, UartLine};
use crate::HdlError;
use crate::primitives::word::Word;
use crate::sim::{connected, rising_edge, settle};
use carrystep_core::link::Uart;

/// The outputs of a line to the link in one cycle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct LineOutputs {
    /// The byte that was received from the host in this cycle, if any.
    pub received: Option<u8>,
    /// The line accepts the byte that the link offers.
    pub take: bool,
}

/// Drives and reads the ports to the link, which are the same for both kinds of line.
macro_rules! byte_ports {
    ($line:expr, $offered:expr) => {{
        $line.answer.next = Word::from(u64::from($offered.unwrap_or(0)));
        $line.answer_valid.next = $offered.is_some();
        settle($line.as_mut());
        let received = $line.received_valid.val().then(|| $line.received.val().value() as u8);
        LineOutputs { received, take: $line.answer_take.val() }
    }};
}

/// A simulated UART.
pub struct UartSim {
    line: Box<UartLine>,
}

impl UartSim {
    /// Makes the line, in cycle 0.
    ///
    /// # Errors
    /// Returns an [`HdlError`] if Rust-HDL's checks reject the module.
    pub fn new(uart: Uart) -> Result<Self, HdlError> {
        Ok(Self { line: connected(UartLine::new(uart))? })
    }

    /// Applies the line from the host and the byte that the link offers. Returns the outputs to the
    /// link in the present cycle, and the line to the host.
    pub fn settle(&mut self, rx: bool, offered: Option<u8>) -> (LineOutputs, bool) {
        self.line.clock.next = false.into();
        self.line.rx.next = rx;
        let outputs = byte_ports!(self.line, offered);
        (outputs, self.line.tx.val())
    }

    /// Advances to the next cycle. The inputs are those of the last call of `settle`.
    pub fn clock(&mut self) {
        self.line.clock.next = true.into();
        rising_edge(self.line.as_mut());
    }
}

/// A simulated SPI.
pub struct SpiSim {
    line: Box<Spi>,
    said: LineOutputs,
}

impl SpiSim {
    /// Makes the line, in cycle 0.
    ///
    /// # Errors
    /// Returns an [`HdlError`] if Rust-HDL's checks reject the module.
    pub fn new() -> Result<Self, HdlError> {
        Ok(Self { line: connected(Spi::new())?, said: LineOutputs::default() })
    }

    /// Applies the pins and the byte that the link offers. `pins` are SCK, the select (active low)
    /// and MOSI. Returns the outputs to the link in the present cycle, and MISO.
    pub fn settle(&mut self, pins: [bool; 3], offered: Option<u8>) -> (LineOutputs, bool) {
        self.line.clock.next = false.into();
        [self.line.sck.next, self.line.select_n.next, self.line.mosi.next] = pins;
        self.said = byte_ports!(self.line, offered);
        (self.said, self.line.miso.val())
    }

    /// The outputs to the link of the last call of `settle`.
    pub fn last(&self) -> LineOutputs {
        self.said
    }

    /// Advances to the next cycle. The inputs are those of the last call of `settle`.
    pub fn clock(&mut self) {
        self.line.clock.next = true.into();
        rising_edge(self.line.as_mut());
    }
}
