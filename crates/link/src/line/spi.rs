//! SPI, mode 0, through embedded-hal. Bytes are transferred in both directions at once; END is sent
//! when there is nothing else to send.

use super::{Exchanged, Line};
use crate::registers::END;
use embedded_hal::spi::{MODE_0, Mode, SpiDevice};

/// Mode of the bus. Its clock may be at most a fifth of the gateware's.
pub const MODE: Mode = MODE_0;

/// Number of bytes that are clocked when there is nothing to send: about an answer.
const LISTEN: usize = 16;

/// A gateware on an SPI bus.
#[derive(Debug)]
pub struct SpiLine<D> {
    device: D,
}

impl<D: SpiDevice> SpiLine<D> {
    /// Uses this device, which must be set to [`MODE`].
    pub const fn new(device: D) -> Self {
        Self { device }
    }

    /// Returns the device.
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
