//! SPI, mode 0, through embedded-hal: bytes go both ways at once, END where there is nothing to say.

use super::{Exchanged, Line};
use crate::registers::END;
use embedded_hal::spi::{MODE_0, Mode, SpiDevice};

/// What the bus must be set to; the clock at most a fifth of the gateware's.
pub const MODE: Mode = MODE_0;

/// Bytes that are clocked when there is nothing to say: about an answer.
const LISTEN: usize = 16;

/// A gateware behind an SPI device.
#[derive(Debug)]
pub struct SpiLine<D> {
    device: D,
}

impl<D: SpiDevice> SpiLine<D> {
    /// The device, set to [`MODE`].
    pub const fn new(device: D) -> Self {
        Self { device }
    }

    /// The device again.
    pub fn free(self) -> D {
        self.device
    }
}

impl<D: SpiDevice> Line for SpiLine<D> {
    type Error = D::Error;

    fn exchange(&mut self, out: &[u8], into: &mut [u8]) -> Result<Exchanged, D::Error> {
        let sent = out.len().min(into.len());
        let received = sent.max(LISTEN).min(into.len());
        let window = into.split_at_mut(received).0;
        window.fill(END);
        window.iter_mut().zip(out).for_each(|(place, byte)| *place = *byte);
        self.device.transfer_in_place(window)?;
        Ok(Exchanged { sent, received })
    }
}
