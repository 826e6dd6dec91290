//! How the host is connected.

use super::{BuildId, Uart};
use crate::EngineBuild;
use alloc::string::ToString as _;
use core::fmt;

/// The line of a build.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Line {
    /// A UART.
    Uart(Uart),
    /// An SPI, to which the gateware is the peripheral; its rate is the host's, up to a fifth of the clock.
    Spi,
}

impl Line {
    /// The id of a build with this line.
    pub fn build_id(self, build: &EngineBuild) -> BuildId {
        BuildId::new(build, &self.to_string())
    }
}

impl From<Uart> for Line {
    fn from(uart: Uart) -> Self {
        Self::Uart(uart)
    }
}

/// What the build id is made of.
impl fmt::Display for Line {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Uart(uart) => uart.fmt(f),
            Self::Spi => f.write_str("spi"),
        }
    }
}
