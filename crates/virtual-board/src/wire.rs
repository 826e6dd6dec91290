//! The line between a host and a board: bytes at the one end, levels of pins at the other.

use crate::line::{Ear, Speaker};
use crate::spi::Master;
use carrystep_core::link::Uart;

/// The host's end of it.
#[derive(Debug, Clone)]
pub(crate) enum Wire {
    Uart(Speaker, Ear),
    Spi(Master),
}

/// What the host drives. A UART's SPI rests.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Driven {
    /// RX, or MOSI.
    pub rx: bool,
    /// SCK, and select (low).
    pub spi: [bool; 2],
    /// For so many clocks, at the least.
    pub stays: u64,
}

/// SCK and select where nothing is said.
pub(crate) const SPI_RESTS: [bool; 2] = [false, true];

impl Wire {
    pub(crate) fn uart(clock_hz: u64, uart: Uart) -> Self {
        Self::Uart(Speaker::new(clock_hz, uart), Ear::new(clock_hz, uart))
    }

    pub(crate) fn spi(clock_hz: u64, sck_hz: u64) -> Self {
        Self::Spi(Master::new(clock_hz, sck_hz))
    }

    /// Says a byte after all others.
    pub(crate) fn say(&mut self, byte: u8) {
        match self {
            Self::Uart(speaker, _) => speaker.say(byte),
            Self::Spi(master) => master.say(byte),
        }
    }

    /// Bytes that have not yet gone.
    pub(crate) fn unsaid(&self) -> usize {
        match self {
            Self::Uart(speaker, _) => speaker.unsaid(),
            Self::Spi(master) => master.unsaid(),
        }
    }

    /// The next byte from the board.
    pub(crate) fn next_byte(&mut self) -> Option<u8> {
        match self {
            Self::Uart(_, ear) => ear.next_byte(),
            Self::Spi(master) => master.next_byte(),
        }
    }

    /// The host is in the middle of a byte from the board.
    pub(crate) fn is_hearing(&self) -> bool {
        match self {
            Self::Uart(_, ear) => ear.is_hearing(),
            Self::Spi(_) => false,
        }
    }

    /// What is driven in a clock, which is never before the last one that was asked about.
    pub(crate) fn drive(&mut self, cycle: u64) -> Driven {
        match self {
            Self::Uart(speaker, _) => Driven { rx: speaker.level(cycle), spi: SPI_RESTS, stays: speaker.stays(cycle) },
            Self::Spi(master) => {
                let [sck, select_n, mosi] = master.pins(cycle);
                Driven { rx: mosi, spi: [sck, select_n], stays: master.stays(cycle) }
            }
        }
    }

    /// The line from the gateware has had its level up to this clock, and has this one from here on.
    pub(crate) fn hear(&mut self, cycle: u64, level: bool) {
        match self {
            Self::Uart(_, ear) => ear.hear(cycle, level),
            Self::Spi(master) => master.hear(cycle, level),
        }
    }

    /// The line from the gateware has had its level up to this clock, and keeps it.
    pub(crate) fn reach(&mut self, cycle: u64) {
        match self {
            Self::Uart(_, ear) => ear.reach(cycle),
            Self::Spi(master) => master.reach(cycle),
        }
    }
}
