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

/// All settings, in the order of preference: the smallest divider of the reference first, and with
/// it the VCO that is nearest to the middle of its range, the faster one of two.
pub(super) fn ways(oscillator_hz: u64) -> impl Iterator<Item = Way> {
    // The reference is at most 64 times the fastest frequency of the detector.
    let f = oscillator_hz.min(64 * DETECTOR.1 + 1);
    let within = |a: u64, b: u64, range: (u64, u64)| a >= range.0 * b && a <= range.1 * b;
    let references = (1..65_u8).filter(move |&divide| within(f, u64::from(divide), DETECTOR));
    references.flat_map(move |divide| {
        let d = u64::from(divide);
        let clocks = (1..65_u8).filter(move |&multiply| within(f * u64::from(multiply), d, OUT));
        clocks.flat_map(move |multiply| {
            let clock = f * u64::from(multiply);
            let vco = move |out: u8| clock * u64::from(out);
            let mut outs: Vec<u8> =
                OUT_DIVIDERS.into_iter().filter(|&out| within(vco(out), d, VCO)).collect();
            outs.sort_by_key(|&out| (vco(out).abs_diff(MIDDLE * d), std::cmp::Reverse(out)));
            outs.into_iter().map(move |out_divide| Way {
                manager: ClockManager::GowinPll(GowinPll { divide, multiply, out_divide }),
                made: (clock, d),
            })
        })
    })
}
