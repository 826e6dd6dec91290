//! A line under simulation.

use super::{Spi, UartLine};
use crate::HdlError;
use crate::primitives::word::Word;
use crate::sim::{connected, rising_edge, settle};
use carrystep_core::link::Uart;

/// What a line tells the link.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct LineOutputs {
    /// A byte from the host.
    pub received: Option<u8>,
    /// The offered byte is taken.
    pub take: bool,
}

/// Both kinds of line have the same ports to the link.
macro_rules! byte_ports {
    ($line:expr, $offered:expr) => {{
        $line.answer.next = Word::from(u64::from($offered.unwrap_or(0)));
        $line.answer_valid.next = $offered.is_some();
        settle($line.as_mut());
        let received = $line.received_valid.val().then(|| $line.received.val().value() as u8);
        LineOutputs { received, take: $line.answer_take.val() }
    }};
}

/// A UART under simulation.
pub struct UartSim {
    line: Box<UartLine>,
}

impl UartSim {
    /// The line in cycle 0.
    ///
    /// # Errors
    /// [`HdlError`] where it cannot be made.
    pub fn new(uart: Uart) -> Result<Self, HdlError> {
        Ok(Self { line: connected(UartLine::new(uart))? })
    }

    /// The outputs of the present cycle, and the line to the host, while this byte is offered.
    pub fn settle(&mut self, rx: bool, offered: Option<u8>) -> (LineOutputs, bool) {
        self.line.clock.next = false.into();
        self.line.rx.next = rx;
        let outputs = byte_ports!(self.line, offered);
        (outputs, self.line.tx.val())
    }

    /// Goes to the next cycle, with the inputs as last settled.
    pub fn clock(&mut self) {
        self.line.clock.next = true.into();
        rising_edge(self.line.as_mut());
    }
}

/// An SPI under simulation.
pub struct SpiSim {
    line: Box<Spi>,
    said: LineOutputs,
}

impl SpiSim {
    /// The line in cycle 0.
    ///
    /// # Errors
    /// [`HdlError`] where it cannot be made.
    pub fn new() -> Result<Self, HdlError> {
        Ok(Self { line: connected(Spi::new())?, said: LineOutputs::default() })
    }

    /// The outputs of the present cycle, and MISO, while this byte is offered; `pins` are SCK, select (low) and MOSI.
    pub fn settle(&mut self, pins: [bool; 3], offered: Option<u8>) -> (LineOutputs, bool) {
        self.line.clock.next = false.into();
        [self.line.sck.next, self.line.select_n.next, self.line.mosi.next] = pins;
        self.said = byte_ports!(self.line, offered);
        (self.said, self.line.miso.val())
    }

    /// What it last told the link.
    pub fn last(&self) -> LineOutputs {
        self.said
    }

    /// Goes to the next cycle, with the inputs as last settled.
    pub fn clock(&mut self) {
        self.line.clock.next = true.into();
        rising_edge(self.line.as_mut());
    }
}
