//! The SPI peripheral of the gateware, mode 0. A byte is complete at the eighth rising edge of SCK,
//! which the link sees two clocks later.

use carrystep_core::link::END;

/// The pins driven by the host.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Pins {
    sck: bool,
    select_n: bool,
    mosi: bool,
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Spi {
    /// The pins one clock ago (`sync`) and two clocks ago (`now`), and SCK three clocks ago
    /// (`before`).
    sync: Pins,
    now: Pins,
    before: bool,
    /// The bits that have been received, the bits that are still to be sent, and the number of bits
    /// in the current byte.
    comes: u8,
    goes: u8,
    count: u8,
    /// True if the last byte was an END.
    ended: bool,
}

impl Spi {
    pub(super) const fn new() -> Self {
        let rest = Pins { sck: false, select_n: true, mosi: false };
        Self { sync: rest, now: rest, before: false, comes: 0, goes: END, count: 0, ended: true }
    }

    /// The byte that is complete in this clock.
    const fn whole(&self) -> Option<u8> {
        let rises = self.now.sck && !self.before && !self.now.select_n;
        if rises && self.count == 7 { Some(self.shifted()) } else { None }
    }

    const fn shifted(&self) -> u8 {
        self.comes << 1 | self.now.mosi as u8
    }

    /// The byte that is received in this clock. Of consecutive ENDs only the first is received.
    pub(super) fn byte(&self) -> Option<u8> {
        self.whole().filter(|&byte| byte != END || !self.ended)
    }

    /// True if an offered byte is accepted in this clock.
    pub(super) const fn takes(&self, offered: bool) -> bool {
        offered && self.whole().is_some()
    }

    /// The level of MISO.
    pub(super) const fn line(&self) -> bool {
        self.goes & 0x80 != 0
    }

    /// The number of clocks in which nothing happens while the pins stay at these levels: `u64::MAX`
    /// or 0. While the chip is not selected, nobody reads MOSI.
    pub(super) fn quiet(&self, [sck, select_n, mosi]: [bool; 3]) -> u64 {
        let same = |pins: Pins| {
            pins.sck == sck && pins.select_n == select_n && (select_n || pins.mosi == mosi)
        };
        let keeps_count = !select_n || self.count == 0;
        let stays = same(self.sync) && same(self.now) && self.before == sck && keeps_count;
        if stays { u64::MAX } else { 0 }
    }

    pub(super) fn clock(&mut self, [sck, select_n, mosi]: [bool; 3], taken: Option<u8>) {
        let whole = self.whole();
        if self.now.select_n {
            self.count = 0;
        } else if self.now.sck && !self.before {
            (self.comes, self.goes, self.count) =
                (self.shifted(), self.goes << 1, (self.count + 1) & 7);
        }
        if let Some(byte) = whole {
            (self.ended, self.goes) = (byte == END, taken.unwrap_or(END));
        }
        self.before = self.now.sck;
        self.now = self.sync;
        self.sync = Pins { sck, select_n, mosi };
    }
}
