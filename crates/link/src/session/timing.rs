//! How long a host waits for an answer.

/// Waiting times, in milliseconds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Timing {
    /// Time without an answer until a request is sent again. It must exceed the delay of the line
    /// and its driver.
    pub resend: u32,
    /// Time until a request is sent again that the gateware refused as busy.
    pub pause: u32,
}

impl Default for Timing {
    /// Times for USB serial bridges, which delay an answer by up to 16 ms.
    fn default() -> Self {
        Self { resend: 40, pause: 2 }
    }
}
