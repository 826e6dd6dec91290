//! The line between host and gateware: a UART or an SPI.

use super::{BuildId, Uart};
use crate::EngineBuild;
use alloc::string::ToString as _;
use core::fmt;

/// The line of a build.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LineKind {
    /// A UART with its divider.
    Uart(Uart),
    /// An SPI with the gateware as peripheral. The host sets its rate, up to a fifth of the clock.
    Spi,
}

impl LineKind {
    /// The id of a build with this line.
    pub fn build_id(self, build: &EngineBuild) -> BuildId {
        BuildId::new(build, &self.to_string())
    }
}

impl Uart {
    /// The id of a build with this UART.
    pub fn build_id(self, build: &EngineBuild) -> BuildId {
        LineKind::from(self).build_id(build)
    }
}

impl From<Uart> for LineKind {
    fn from(uart: Uart) -> Self {
        Self::Uart(uart)
    }
}

/// The text of the line that enters the build id.
impl fmt::Display for LineKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Uart(uart) => uart.fmt(f),
            Self::Spi => f.write_str("spi"),
        }
    }
}
