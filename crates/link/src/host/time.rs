//! Time for a host: its clock, and how long it waits for what.

use crate::session::Timing;

/// A time of the host's clock.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Moment {
    /// Microseconds since an arbitrary moment.
    pub us: u64,
    /// Greatest time by which `us` lies before the true time, us.
    pub resolution_us: u32,
}

/// A clock.
pub trait Clock {
    /// Milliseconds since an arbitrary moment; the value wraps.
    fn milliseconds(&mut self) -> u32;

    /// The time for comparisons with the gateware's clock. Without an implementation of its own it
    /// is the time in milliseconds, and a comparison ends when that wraps.
    fn moment(&mut self) -> Moment {
        Moment { us: u64::from(self.milliseconds()) * 1000, resolution_us: 1000 }
    }
}

/// The clock of the operating system.
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

    fn moment(&mut self) -> Moment {
        Moment { us: self.0.elapsed().as_micros() as u64, resolution_us: 1 }
    }
}

/// Waiting times of a host.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Patience {
    /// For the answers to single requests.
    pub timing: Timing,
    /// For the first answer at a port, until the port is given up, ms.
    pub silence: u32,
    /// For any answer of a gateware that has answered before, until it is given up, ms. The
    /// gateware's watchdog is far shorter, so a short time here has no advantage, and a computer
    /// may be busy.
    pub lost: u32,
    /// For a change that takes time (power, a stop by ramps, a clear), ms.
    pub change: u32,
    /// Between two reads of the state while there is nothing to send, ms. It must be shorter than
    /// the watchdog's time.
    pub status_period: u32,
}

impl Default for Patience {
    fn default() -> Self {
        Self {
            timing: Timing::default(),
            silence: 500,
            lost: 2000,
            change: 5000,
            status_period: 20,
        }
    }
}
