//! The line between a host and a board: bytes at the host's end, levels of pins at the board's end.

use crate::line::{LineReceiver, LineSender};
use crate::spi::Master;
use carrystep_core::link::Uart;
use carrystep_model::SPI_RESTS;

/// The host's end of the line.
#[derive(Debug, Clone)]
pub(crate) enum Wire {
    Uart(LineSender, LineReceiver),
    Spi(Master),
}

/// Levels that the host drives. With a UART the SPI pins are idle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Driven {
    /// Level of RX, or of MOSI.
    pub rx: bool,
    /// Levels of SCK and of the active-low chip select.
    pub spi: [bool; 2],
    /// Number of clocks, at least, for which these levels stay.
    pub stays: u64,
}

impl Wire {
    pub(crate) fn uart(clock_hz: u64, uart: Uart) -> Self {
        Self::Uart(LineSender::new(clock_hz, uart), LineReceiver::new(clock_hz, uart))
    }

    pub(crate) fn spi(clock_hz: u64, sck_hz: u64) -> Self {
        Self::Spi(Master::new(clock_hz, sck_hz))
    }

    /// Queues a byte for transmission.
    pub(crate) fn say(&mut self, byte: u8) {
        match self {
            Self::Uart(line_sender, _) => line_sender.say(byte),
            Self::Spi(master) => master.say(byte),
        }
    }

    /// Number of bytes that are not sent completely.
    pub(crate) fn unsaid(&self) -> usize {
        match self {
            Self::Uart(line_sender, _) => line_sender.unsaid(),
            Self::Spi(master) => master.unsaid(),
        }
    }

    /// The next byte received from the board.
    pub(crate) fn next_byte(&mut self) -> Option<u8> {
        match self {
            Self::Uart(_, line_receiver) => line_receiver.next_byte(),
            Self::Spi(master) => master.next_byte(),
        }
    }

    /// Whether the host is within a byte from the board.
    pub(crate) fn is_hearing(&self) -> bool {
        match self {
            Self::Uart(_, line_receiver) => line_receiver.is_hearing(),
            Self::Spi(_) => false,
        }
    }

    /// Levels in a clock. Calls must not go back in time.
    pub(crate) fn drive(&mut self, cycle: u64) -> Driven {
        match self {
            Self::Uart(line_sender, _) => Driven {
                rx: line_sender.level(cycle),
                spi: SPI_RESTS,
                stays: line_sender.stays(cycle),
            },
            Self::Spi(master) => {
                let [sck, select_n, mosi] = master.pins(cycle);
                Driven { rx: mosi, spi: [sck, select_n], stays: master.stays(cycle) }
            }
        }
    }

    /// The line from the gateware had its previous level up to this clock, and has this level from
    /// here on.
    pub(crate) fn hear(&mut self, cycle: u64, level: bool) {
        match self {
            Self::Uart(_, line_receiver) => line_receiver.hear(cycle, level),
            Self::Spi(master) => master.hear(cycle, level),
        }
    }

    /// The line from the gateware had its level up to this clock, and keeps it.
    pub(crate) fn reach(&mut self, cycle: u64) {
        match self {
            Self::Uart(_, line_receiver) => line_receiver.reach(cycle),
            Self::Spi(master) => master.reach(cycle),
        }
    }
}
