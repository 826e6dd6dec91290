//! A line: bytes out, bytes in. A serial port (feature `serial`), an SPI bus (feature `spi`), or anything else.

#[cfg(feature = "serial")]
pub mod serial;
#[cfg(feature = "spi")]
pub mod spi;

/// How much of an exchange took place.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Exchanged {
    /// Bytes that went out, from the front.
    pub sent: usize,
    /// Bytes that came in.
    pub received: usize,
}

/// Takes bytes both ways without waiting for long: some milliseconds at most.
pub trait Line {
    /// What can go wrong on it.
    type Error;

    /// Sends some of `out`, and puts what has come into `into`; either may be nothing.
    ///
    /// # Errors
    /// The line is gone.
    fn exchange(&mut self, out: &[u8], into: &mut [u8]) -> Result<Exchanged, Self::Error>;
}

impl<L: Line + ?Sized> Line for &mut L {
    type Error = L::Error;

    fn exchange(&mut self, out: &[u8], into: &mut [u8]) -> Result<Exchanged, Self::Error> {
        (**self).exchange(out, into)
    }
}
