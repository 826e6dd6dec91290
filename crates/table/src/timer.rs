//! The timer: its counts, its longest and shortest wait, and the choice of the prescaler.
//!
//! The names of the fields are part of `--json` and may not change.

use crate::error::TableError;
use schemars::JsonSchema;
use serde::Serialize;

/// The prescalers of timers 0 and 1 of an AVR.
pub const AVR_PRESCALERS: [u32; 5] = [1, 8, 64, 256, 1024];

/// A timer with a compare register.
#[derive(Debug, Clone, PartialEq, Eq, JsonSchema, Serialize)]
pub struct Timer {
    /// Frequency of the clock before the prescaler, Hz; 1 to 10^10.
    pub clock_hz: u64,
    /// Clocks per count; one of `prescalers`.
    pub prescaler: u32,
    /// The prescalers that the timer has.
    pub prescalers: Vec<u32>,
    /// Width of the counter.
    pub width: Width,
    /// What happens at a compare match.
    pub mode: TimerMode,
    /// Clocks that the interrupt needs from one pulse to the next; 0: not checked.
    pub interrupt_clocks: u32,
}

/// Width of a counter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, JsonSchema, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Width {
    /// 8 bits.
    Bits8,
    /// 16 bits.
    Bits16,
}

/// What the counter does at a compare match, which determines the meaning of a compare value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, JsonSchema, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum TimerMode {
    /// Clear timer on compare (CTC): a period is the compare value plus one.
    Ctc,
    /// The counter runs on, and the interrupt adds the value to the compare register.
    FreeRunning,
}

impl Width {
    /// The width in bits.
    pub const fn bits(self) -> u32 {
        match self {
            Self::Bits8 => 8,
            Self::Bits16 => 16,
        }
    }
}

impl Timer {
    /// A 16-bit AVR timer, whose interrupt time is not checked.
    pub fn avr16(clock_hz: u64, prescaler: u32, mode: TimerMode) -> Self {
        let prescalers = AVR_PRESCALERS.to_vec();
        Self { clock_hz, prescaler, prescalers, width: Width::Bits16, mode, interrupt_clocks: 0 }
    }

    /// Counts per second, F.
    pub fn frequency(&self) -> f64 {
        self.clock_hz as f64 / f64::from(self.prescaler)
    }

    /// The longest wait, counts: 2^width with CTC, one less with a free-running counter, where
    /// adding 2^width would not change the compare register.
    pub const fn most_counts(&self) -> u32 {
        let full = 1 << self.width.bits();
        match self.mode {
            TimerMode::Ctc => full,
            TimerMode::FreeRunning => full - 1,
        }
    }

    /// The shortest wait, counts: 1, or the time that the interrupt needs.
    pub fn least_counts(&self) -> u32 {
        self.least_counts_with(self.prescaler)
    }

    /// The compare value for a wait of `counts`: `counts` with a free-running counter, one less
    /// with CTC. `None` if it does not fit.
    pub fn compare(&self, counts: u32) -> Option<u16> {
        if counts == 0 || counts > self.most_counts() {
            return None;
        }
        u16::try_from(counts - self.offset()).ok()
    }

    /// [`Self::compare`], or the error that names the reason.
    pub(crate) fn word(&self, counts: u32) -> Result<u16, TableError> {
        let counts_f64 = f64::from(counts);
        self.compare(counts).ok_or_else(|| {
            self.fit(counts_f64, counts_f64).err().unwrap_or(TableError::TooSlow {
                counts: counts_f64,
                most: self.most_counts(),
                bits: self.width.bits(),
                prescaler: None,
                start: None,
            })
        })
    }

    /// The wait in counts that belongs to a compare value.
    pub fn counts(&self, compare: u16) -> u32 {
        u32::from(compare) + self.offset()
    }

    const fn offset(&self) -> u32 {
        match self.mode {
            TimerMode::Ctc => 1,
            TimerMode::FreeRunning => 0,
        }
    }

    fn least_counts_with(&self, prescaler: u32) -> u32 {
        self.interrupt_clocks.div_ceil(prescaler.max(1)).max(1)
    }

    pub(crate) fn check(&self) -> Result<(), TableError> {
        if !(1..=10_000_000_000).contains(&self.clock_hz) {
            let value = self.clock_hz as f64;
            return Err(TableError::Unusable { parameter: "clock_hz", value, needed: "1 to 1e10" });
        }
        if self.prescaler == 0 || !self.prescalers.contains(&self.prescaler) {
            let available = self.usable_prescalers();
            return Err(TableError::Prescaler { prescaler: self.prescaler, available });
        }
        Ok(())
    }

    /// Checks that waits between `shortest` and `longest` (counts, not yet rounded) fit.
    pub(crate) fn fit(&self, shortest: f64, longest: f64) -> Result<(), TableError> {
        let fits = |prescaler: &u32| {
            let scale = f64::from(self.prescaler) / f64::from(*prescaler);
            let least = f64::from(self.least_counts_with(*prescaler));
            let fast_enough = (shortest * scale).round() >= least;
            (fast_enough, fast_enough && (longest * scale).round() <= f64::from(self.most_counts()))
        };
        if fits(&self.prescaler).1 {
            return Ok(());
        }
        let available = self.usable_prescalers();
        let prescaler = available.iter().copied().find(|p| fits(p).1);
        let clock = self.clock_hz as f64;
        if !fits(&self.prescaler).0 {
            let finest = available.first().copied().unwrap_or(1);
            let speed = clock / (f64::from(finest) * f64::from(self.least_counts_with(finest)));
            return Err(TableError::TooFast {
                counts: shortest,
                least: self.least_counts(),
                prescaler,
                speed,
            });
        }
        let coarsest = available.iter().rfind(|p| fits(p).0).copied().unwrap_or(self.prescaler);
        let start = clock / (f64::from(coarsest) * f64::from(self.most_counts()));
        let top = self.frequency() / shortest;
        Err(TableError::TooSlow {
            counts: longest,
            most: self.most_counts(),
            bits: self.width.bits(),
            prescaler,
            start: (start < top).then_some(start),
        })
    }

    fn usable_prescalers(&self) -> Vec<u32> {
        let mut available: Vec<u32> = self.prescalers.iter().copied().filter(|&p| p > 0).collect();
        available.sort_unstable();
        available.dedup();
        available
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn compare_value_of_ctc_is_one_less_than_the_counts() {
        let ctc = Timer::avr16(16_000_000, 64, TimerMode::Ctc);
        let free = Timer { mode: TimerMode::FreeRunning, ..ctc.clone() };
        assert_eq!(
            (ctc.compare(0), ctc.compare(1), ctc.compare(65_536), ctc.compare(65_537)),
            (None, Some(0), Some(65_535), None)
        );
        assert_eq!(
            (free.compare(0), free.compare(1), free.compare(65_535), free.compare(65_536)),
            (None, Some(1), Some(65_535), None)
        );
        let small = Timer { width: Width::Bits8, ..ctc };
        assert_eq!((small.compare(256), small.compare(257)), (Some(255), None));
    }

    #[test]
    fn error_names_the_smallest_prescaler_that_works() {
        let timer = Timer::avr16(16_000_000, 1, TimerMode::Ctc);
        let advice = |shortest, longest| match timer.fit(shortest, longest) {
            Err(TableError::TooSlow { prescaler, .. } | TableError::TooFast { prescaler, .. }) => {
                prescaler
            }
            other => panic!("{other:?}"),
        };
        assert_eq!(timer.fit(1.0, 65_536.4), Ok(()));
        assert_eq!(advice(100.0, 65_537.0), Some(8));
        assert_eq!(advice(100.0, 65_536.0 * 64.0), Some(64));
        assert_eq!(advice(10.0, 65_536.0 * 64.0), None);
        assert_eq!(advice(0.4, 100.0), None);
    }
}
