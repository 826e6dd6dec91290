//! The UART of a build: its baud rate, and the whole number of clocks per bit.

use core::fmt;
use thiserror::Error;

/// Baud rate of a machine file that gives none, bits per second.
pub const DEFAULT_BAUD: u32 = 921_600;

/// Fewest clocks of a bit. The receiver samples the line two clocks late, and the link needs some
/// instructions per byte.
pub const MIN_BIT_CLOCKS: u32 = 8;

/// Most clocks of a bit. The receiver counts one and a half bits in 16 bits.
pub const MAX_BIT_CLOCKS: u32 = 40_000;

/// Greatest deviation from the requested baud rate, percent. The two ends together may deviate by 4
/// %.
pub const BAUD_PERCENT: u64 = 2;

/// A UART whose baud rate the clock can make.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Uart {
    baud: u32,
    bit_clocks: u32,
}

/// A baud rate that the clock cannot make.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error(
    "a clock of {clock_hz} Hz does not make {baud} baud within {BAUD_PERCENT} %: {}",
    Possible(self)
)]
pub struct BaudError {
    /// The requested rate, bits per second.
    pub baud: u32,
    /// The clock, Hz.
    pub clock_hz: u64,
    /// The nearest lower rate that is possible, bits per second.
    pub below: u64,
    /// The nearest higher rate that is possible, bits per second.
    pub above: u64,
}

/// The rates that are possible instead. Beyond the range of the clock there is only one.
struct Possible<'a>(&'a BaudError);

impl fmt::Display for Possible<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let BaudError { baud, below, above, .. } = *self.0;
        if above < u64::from(baud) {
            write!(f, "the greatest that it makes is {above}")
        } else if below > u64::from(baud) {
            write!(f, "the least that it makes is {below}")
        } else {
            write!(f, "the next ones that it makes are {below} and {above}")
        }
    }
}

impl Uart {
    /// The UART of this baud rate (bits per second) at a clock (Hz).
    ///
    /// ```
    /// use carrystep_core::link::Uart;
    /// assert_eq!(Uart::new(48_000_000, 921_600).unwrap().bit_clocks(), 52);
    /// assert!(Uart::new(48_000_000, 5_600_000).is_err());
    /// ```
    ///
    /// # Errors
    /// [`BaudError`] if no whole number of clocks comes within 2 %; it gives the nearest possible
    /// rates.
    pub fn new(clock_hz: u64, baud: u32) -> Result<Self, BaudError> {
        let (least, most) = (u64::from(MIN_BIT_CLOCKS), u64::from(MAX_BIT_CLOCKS));
        let asked = u64::from(baud.max(1));
        let bit_clocks = ((2 * clock_hz + asked) / (2 * asked)).clamp(least, most);
        // Compares clock / bit_clocks with the baud rate without a division.
        let off = clock_hz.abs_diff(asked * bit_clocks);
        if baud == 0
            || 100 * u128::from(off) > u128::from(BAUD_PERCENT) * u128::from(asked * bit_clocks)
        {
            let slower = clock_hz.div_ceil(asked).clamp(least, most);
            let faster = (clock_hz / asked).clamp(least, most);
            return Err(BaudError {
                baud,
                clock_hz,
                below: clock_hz / slower,
                above: clock_hz / faster,
            });
        }
        Ok(Self { baud, bit_clocks: bit_clocks as u32 })
    }

    /// The requested baud rate, bits per second, which the host must set.
    pub const fn baud(self) -> u32 {
        self.baud
    }

    /// Number of clocks of a bit, from [`MIN_BIT_CLOCKS`] to [`MAX_BIT_CLOCKS`].
    pub const fn bit_clocks(self) -> u32 {
        self.bit_clocks
    }
}

/// The text of the UART that enters the build id. Two baud rates with the same divider have the
/// same id.
impl fmt::Display for Uart {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "uart, {} clocks a bit", self.bit_clocks)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::string::ToString as _;

    #[test]
    fn nearest_divider_is_used_and_a_far_one_refused() {
        let clocks = |clock_hz, baud| Uart::new(clock_hz, baud).map(Uart::bit_clocks);
        assert_eq!(clocks(48_000_000, 3_000_000), Ok(16));
        assert_eq!(clocks(48_000_000, 115_200), Ok(417));
        assert_eq!(clocks(12_000_000, 921_600), Ok(13));
        assert_eq!(clocks(48_000_000, 3_060_000), Ok(16));
        let said = clocks(48_000_000, 3_100_000).unwrap_err().to_string();
        assert!(said.ends_with("the next ones that it makes are 3000000 and 3200000"), "{said}");
        let said = clocks(24_000_000, 4_000_000).unwrap_err().to_string();
        assert!(said.ends_with("within 2 %: the greatest that it makes is 3000000"), "{said}");
        let said = clocks(48_000_000, 300).unwrap_err().to_string();
        assert!(said.ends_with("within 2 %: the least that it makes is 1200"), "{said}");
        for (clock_hz, baud) in [
            (48_000_000, 0),
            (48_000_000, u32::MAX),
            (48_000_000, 1),
            (1, 9600),
            (12_000_000, 3_000_000),
        ] {
            clocks(clock_hz, baud).unwrap_err();
        }
    }
}
