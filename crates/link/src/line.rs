//! The line: an interface that sends and receives bytes. It is implemented for a serial port
//! (feature `serial`) and an SPI bus (feature `spi`), and can be implemented for other devices.

#[cfg(feature = "serial")]
pub mod serial;
#[cfg(feature = "spi")]
pub mod spi;

/// Result of an exchange.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Exchanged {
    /// Number of bytes of `out` that were sent.
    pub sent: usize,
    /// Number of bytes received.
    pub received: usize,
}

/// A line in both directions. A call may block for some milliseconds at most.
pub trait Line {
    /// Error of the line.
    type Error;

    /// Sends as many bytes of `out` as possible, and stores received bytes in `into`. Either count
    /// may be 0.
    ///
    /// # Errors
    /// The line has failed.
    fn exchange(&mut self, out: &[u8], into: &mut [u8]) -> Result<Exchanged, Self::Error>;
}

impl<L: Line + ?Sized> Line for &mut L {
    type Error = L::Error;

    fn exchange(&mut self, out: &[u8], into: &mut [u8]) -> Result<Exchanged, Self::Error> {
        (**self).exchange(out, into)
    }
}
