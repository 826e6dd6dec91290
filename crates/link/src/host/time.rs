//! Where a host's time comes from, and how long it waits.

use crate::session::Timing;

/// Where time comes from.
pub trait Clock {
    /// Milliseconds since any moment; wraps.
    fn milliseconds(&mut self) -> u32;
}

/// The system's clock.
#[cfg(feature = "std")]
#[derive(Debug, Clone, Copy)]
pub struct SystemClock(std::time::Instant);

#[cfg(feature = "std")]
impl Default for SystemClock {
    fn default() -> Self {
        Self(std::time::Instant::now())
    }
}

#[cfg(feature = "std")]
impl Clock for SystemClock {
    fn milliseconds(&mut self) -> u32 {
        self.0.elapsed().as_millis() as u32
    }
}

/// How a host waits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Patience {
    /// For single answers.
    pub timing: Timing,
    /// Without any answer, until a port is given up at which nothing has answered yet, ms.
    pub silence: u32,
    /// Without any answer, until a gateware is given up that has answered before, ms. Its watchdog is far quicker, so
    /// nothing is won by haste, and a computer may be busy.
    pub lost: u32,
    /// For what takes its time: power, a stop by ramps, a clear; ms.
    pub change: u32,
    /// From one look at the machine to the next while there is nothing to send, ms; less than the watchdog's time.
    pub look: u32,
}

impl Default for Patience {
    fn default() -> Self {
        Self { timing: Timing::default(), silence: 500, lost: 2000, change: 5000, look: 20 }
    }
}
