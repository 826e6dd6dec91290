//! The PLL of a Gowin part, `rPLL`, with its internal feedback.
//!
//! ```text
//! F / divide ---> phase detector ---> VCO ---> / out_divide ---> CLKOUT, the clock
//!                       ^-------------- / multiply <---------------'
//! ```
//!
//! The divider of the output is within the loop, so that the clock is F x multiply / divide.

use super::{ClockManager, Way};
use schemars::JsonSchema;
use serde::Serialize;
use std::cmp::Reverse;

/// The dividers of an `rPLL`: IDIV_SEL and FBDIV_SEL, each plus one, and ODIV_SEL.
#[derive(Debug, Clone, Copy, PartialEq, Eq, JsonSchema, Serialize)]
pub struct GowinPll {
    /// Divides the reference, 1 to 64.
    pub divide: u8,
    /// Multiplies the divided reference, 1 to 64: the clock.
    pub multiply: u8,
    /// Divides the VCO to the clock: 2, 4, 8, 16, 32, 48, 64, 80, 96, 112 or 128.
    pub out_divide: u8,
}

const MHZ: u64 = 1_000_000;

/// Ranges of frequencies, Hz, that a GW1NR-9 of grade C6/I5 and a GW2AR-18 of grade C8/I7 have in
/// common (apycula 0.32, `gowin_pll.py`): the phase detector, the VCO and the clock. Its least
/// clock, 3.90625 MHz, is rounded up.
const DETECTOR: (u64, u64) = (3 * MHZ, 400 * MHZ);
const VCO: (u64, u64) = (500 * MHZ, 1200 * MHZ);
const OUT: (u64, u64) = (4 * MHZ, 600 * MHZ);

/// The middle of the VCO's range, Hz.
const MIDDLE: u64 = (VCO.0 + VCO.1) / 2;

const OUT_DIVIDERS: [u8; 11] = [2, 4, 8, 16, 32, 48, 64, 80, 96, 112, 128];

/// A setting for each clock and divider of the reference, in the order of preference: the smallest
/// divider first. Its VCO is the nearest to the middle of its range, the faster one of two.
pub(super) fn ways(oscillator_hz: u64) -> Vec<Way> {
    // The reference is at most 64 times the fastest frequency of the detector.
    let f = oscillator_hz.min(64 * DETECTOR.1 + 1);
    let within = |a: u64, b: u64, range: (u64, u64)| a >= range.0 * b && a <= range.1 * b;
    let mut ways = Vec::new();
    for divide in 1..65_u8 {
        let d = u64::from(divide);
        for multiply in 1..65_u8 {
            let clock = f * u64::from(multiply);
            if !within(f, d, DETECTOR) || !within(clock, d, OUT) {
                continue;
            }
            let vco = |out: u8| clock * u64::from(out);
            let nearest = OUT_DIVIDERS
                .into_iter()
                .filter(|&out| within(vco(out), d, VCO))
                .min_by_key(|&out| (vco(out).abs_diff(MIDDLE * d), Reverse(out)));
            ways.extend(nearest.map(|out_divide| Way {
                manager: ClockManager::GowinPll(GowinPll { divide, multiply, out_divide }),
                made: (clock, d),
            }));
        }
    }
    ways
}
