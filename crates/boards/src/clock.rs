//! Computes the settings of a part's clock manager for a clock made from the board's oscillator. F
//! is the oscillator's frequency.
//!
//! ```text
//! iCE40      F x (DIVF + 1) / (DIVR + 1) / 2^DIVQ         PLL
//! ECP5       F x M / D / O                                PLL
//! Gowin      F x M / D                                    PLL
//! Spartan-3  F x M / D                                    DCM (3E and 6 too)
//! Spartan-7  F x M / D / O                                MMCM
//! ```
//!
//! Only exact clocks are accepted; the error names the nearest possible one. With a clock that is
//! off by a thousandth, every speed would be off by a thousandth.

use carrystep_core::tick::mhz;
use schemars::JsonSchema;
use serde::Serialize;
use std::fmt;
use thiserror::Error;

mod dcm;
mod ecp5;
mod gowin;
mod ice40;
mod mmcm;

pub use dcm::Dcm;
pub use ecp5::Ecp5Pll;
pub use gowin::GowinPll;
pub use ice40::Ice40Pll;
pub use mmcm::Mmcm;

/// The clock manager, which makes the gateware's clock from the oscillator.
#[derive(Debug, Clone, Copy, PartialEq, Eq, JsonSchema, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum ClockManager {
    /// No clock manager: the oscillator is the clock.
    Oscillator,
    /// The PLL of an iCE40.
    Ice40Pll(Ice40Pll),
    /// The PLL of an ECP5.
    Ecp5Pll(Ecp5Pll),
    /// The PLL of a Gowin part.
    GowinPll(GowinPll),
    /// The frequency synthesiser of a Spartan's DCM.
    Dcm(Dcm),
    /// The MMCM of a Spartan-7.
    Mmcm(Mmcm),
}

impl fmt::Display for ClockManager {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Oscillator => f.write_str("the oscillator"),
            Self::Ice40Pll(Ice40Pll { divr, divf, divq, filter_range }) => {
                write!(f, "PLL: DIVR {divr}, DIVF {divf}, DIVQ {divq}, FILTER_RANGE {filter_range}")
            }
            Self::Ecp5Pll(Ecp5Pll { divide, multiply, out_divide }) => {
                write!(f, "PLL: x {multiply} / {divide} / {out_divide}")
            }
            Self::GowinPll(GowinPll { divide, multiply, out_divide }) => {
                write!(f, "PLL: x {multiply} / {divide}, VCO / {out_divide}")
            }
            Self::Dcm(Dcm { multiply, divide }) => write!(f, "DCM: x {multiply} / {divide}"),
            Self::Mmcm(Mmcm { multiply, divide, out_divide }) => {
                write!(f, "MMCM: x {multiply} / {divide} / {out_divide}")
            }
        }
    }
}

/// The clock manager of a family, with the ranges of its frequencies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ClockManagers {
    /// The PLL of an iCE40.
    Ice40,
    /// The PLL of an ECP5.
    Ecp5,
    /// The PLL of a Gowin part.
    Gowin,
    /// A DCM, with the ranges of its input and of its synthesised clock, Hz.
    Dcm {
        /// Slowest input, Hz.
        least_in: u64,
        /// Slowest output, Hz.
        least_out: u64,
        /// Fastest output, Hz.
        most_out: u64,
    },
    /// The MMCM of a Spartan-7 of speed grade -1.
    Mmcm,
}

/// A clock that cannot be made from the oscillator.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{manager} makes no clock of {} MHz from {} MHz; {}", mhz(*.wanted_hz), mhz(*.oscillator_hz), nearest_said(.nearest_hz))]
pub struct ClockError {
    /// Name of the clock manager: PLL, DCM or MMCM.
    pub manager: &'static str,
    /// Frequency of the oscillator, Hz.
    pub oscillator_hz: u64,
    /// The wanted clock, Hz.
    pub wanted_hz: u64,
    /// The nearest clock of whole Hz that can be made, if there is one.
    pub nearest_hz: Option<u64>,
}

fn nearest_said(nearest_hz: &Option<u64>) -> String {
    match nearest_hz {
        Some(hz) => format!("the nearest that it makes is {} MHz", mhz(*hz)),
        None => "it makes none of that at all".to_owned(),
    }
}

/// One setting of a clock manager, and the clock that it makes.
struct Way {
    manager: ClockManager,
    /// The clock, Hz, as numerator and denominator.
    made: (u64, u64),
}

impl ClockManagers {
    /// The settings for exactly this clock, both frequencies in Hz.
    ///
    /// # Errors
    /// [`ClockError`] names the nearest clock of whole Hz, if there is one.
    pub fn solve(self, oscillator_hz: u64, wanted_hz: u64) -> Result<ClockManager, ClockError> {
        if oscillator_hz == wanted_hz {
            return Ok(ClockManager::Oscillator);
        }
        let (manager, ways): (_, Vec<Way>) = match self {
            Self::Ice40 => ("the PLL", ice40::ways(oscillator_hz).collect()),
            Self::Ecp5 => ("the PLL", ecp5::ways(oscillator_hz).collect()),
            Self::Gowin => ("the PLL", gowin::ways(oscillator_hz)),
            Self::Dcm { least_in, least_out, most_out } => {
                ("the DCM", dcm::ways(oscillator_hz, least_in, least_out..=most_out).collect())
            }
            Self::Mmcm => ("the MMCM", mmcm::ways(oscillator_hz).collect()),
        };
        // The first exact setting in the order of the manager's preference.
        let exact = |way: &&Way| way.made.0 == u64::saturating_mul(wanted_hz, way.made.1);
        if let Some(way) = ways.iter().find(exact) {
            return Ok(way.manager);
        }
        let whole = ways
            .iter()
            .filter(|way| way.made.0.is_multiple_of(way.made.1))
            .map(|way| way.made.0 / way.made.1);
        let nearest_hz = whole.min_by_key(|hz| hz.abs_diff(wanted_hz));
        Err(ClockError { manager, oscillator_hz, wanted_hz, nearest_hz })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clock_that_cannot_be_made_is_refused_with_the_nearest() {
        let refused =
            |managers: ClockManagers, from, to| managers.solve(from, to).unwrap_err().to_string();
        assert_eq!(
            refused(ClockManagers::Ice40, 12_000_000, 40_000_000),
            "the PLL makes no clock of 40 MHz from 12 MHz; the nearest that it makes is 39.75 MHz"
        );
        assert_eq!(
            refused(ClockManagers::Ice40, 12_000_000, 80_000_000),
            "the PLL makes no clock of 80 MHz from 12 MHz; the nearest that it makes is 79.5 MHz"
        );
        // 47.916666... MHz is nearer, but it is not a whole number of Hz.
        assert!(
            refused(ClockManagers::Ice40, 100_000_000, 48_000_000).ends_with("makes is 48.125 MHz")
        );
        assert!(
            refused(ClockManagers::Ice40, 1_000_000, 48_000_000)
                .ends_with("it makes none of that at all")
        );
    }

    #[test]
    fn clock_of_the_oscillator_needs_no_manager() {
        assert_eq!(ClockManagers::Mmcm.solve(12_000_000, 12_000_000), Ok(ClockManager::Oscillator));
    }
}
