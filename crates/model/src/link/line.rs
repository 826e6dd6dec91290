//! The gateware's end of the line to the host, which is either UART or SPI.

use super::spi::Spi;
use super::uart::{Receiver, Transmitter};
use carrystep_core::link::{LineKind, LinkInputs};

#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum End {
    Uart { receiver: Receiver, transmitter: Transmitter },
    Spi(Spi),
}

impl End {
    pub(super) const fn new(line: LineKind) -> Self {
        match line {
            LineKind::Uart(uart) => Self::Uart {
                receiver: Receiver::new(uart.bit_clocks()),
                transmitter: Transmitter::new(uart.bit_clocks()),
            },
            LineKind::Spi => Self::Spi(Spi::new()),
        }
    }

    /// The level of the line to the host.
    pub(super) const fn level(&self) -> bool {
        match self {
            Self::Uart { transmitter, .. } => transmitter.line(),
            Self::Spi(spi) => spi.line(),
        }
    }

    /// The byte that is received in this clock.
    pub(super) fn byte(&self) -> Option<u8> {
        match self {
            Self::Uart { receiver, .. } => receiver.byte(),
            Self::Spi(spi) => spi.byte(),
        }
    }

    /// True if an offered byte is accepted in this clock.
    pub(super) const fn takes(&self, offered: bool) -> bool {
        match self {
            Self::Uart { transmitter, .. } => transmitter.takes(offered),
            Self::Spi(spi) => spi.takes(offered),
        }
    }

    pub(super) fn clock(&mut self, inputs: &LinkInputs, taken: Option<u8>) {
        match self {
            Self::Uart { receiver, transmitter } => {
                transmitter.clock(taken);
                receiver.clock(inputs.rx);
            }
            Self::Spi(spi) => {
                let [sck, select_n] = inputs.spi;
                spi.clock([sck, select_n, inputs.rx], taken);
            }
        }
    }

    /// The number of clocks in which the line only counts, provided that it stays at `rx`, the
    /// other pins of an SPI stay as they are, and `offered` stays the same.
    pub(super) fn quiet(&self, rx: bool, [sck, select_n]: [bool; 2], offered: bool) -> u64 {
        match self {
            Self::Uart { receiver, transmitter } => {
                receiver.quiet(rx).min(transmitter.quiet(offered))
            }
            Self::Spi(spi) => spi.quiet([sck, select_n, rx]),
        }
    }

    pub(super) fn pass(&mut self, clocks: u64, rx: bool) {
        if let Self::Uart { receiver, transmitter } = self {
            receiver.pass(clocks, rx);
            transmitter.pass(clocks);
        }
    }
}
