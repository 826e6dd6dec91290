//! The PLL of an ECP5, `EHXPLLL`. Its output CLKOP only closes the loop, undivided, so that the
//! clock, CLKOS, need not be a multiple of the reference.
//!
//! ```text
//! F / divide ---> phase detector ---> VCO ---> / out_divide ---> CLKOS, the clock
//!                       ^------ / multiply <----'     CLKOP
//! ```

use super::{ClockManager, Way};
use schemars::JsonSchema;
use serde::Serialize;

/// CLKI_DIV, CLKOP_DIV and CLKOS_DIV of an `EHXPLLL` whose CLKFB_DIV is 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, JsonSchema, Serialize)]
pub struct Ecp5Pll {
    /// Divides the reference, 1 to 128.
    pub divide: u8,
    /// Multiplies the divided reference, 1 to 128: the VCO's frequency.
    pub multiply: u8,
    /// Divides the VCO, 1 to 128.
    pub out_divide: u8,
}

const MHZ: u64 = 1_000_000;

/// Ranges of frequencies, Hz: IN for the reference, DETECTOR for the phase detector, VCO, and OUT
/// for the outputs (Lattice's family data sheet, table "sysCLOCK PLL Timing", as cited by
/// projectf.io, "ECP5 FPGA Clock Generation"; the least frequency of the detector is the least
/// that Lattice's own configurator uses). The lower end of OUT is rounded up.
const IN: (u64, u64) = (8 * MHZ, 400 * MHZ);
const DETECTOR: (u64, u64) = (10 * MHZ, 400 * MHZ);
const VCO: (u64, u64) = (400 * MHZ, 800 * MHZ);
const OUT: (u64, u64) = (4 * MHZ, 400 * MHZ);

/// The middle of the VCO's range, Hz.
const MIDDLE: u64 = (VCO.0 + VCO.1) / 2;

/// All settings, in the order of preference: the smallest divider of the reference first, and with
/// it the VCO that is nearest to the middle of its range, the faster one of two.
pub(super) fn ways(oscillator_hz: u64) -> impl Iterator<Item = Way> {
    let f = oscillator_hz.min(IN.1 + 1);
    let within = |a: u64, b: u64, range: (u64, u64)| a >= range.0 * b && a <= range.1 * b;
    let references = (1..129_u8)
        .filter(move |&divide| within(f, 1, IN) && within(f, u64::from(divide), DETECTOR));
    references.flat_map(move |divide| {
        let d = u64::from(divide);
        let vco = move |multiply: &u8| f * u64::from(*multiply);
        let mut factors: Vec<u8> =
            (1..129_u8).filter(|multiply| within(vco(multiply), d, VCO)).collect();
        factors.sort_by_key(|multiply| {
            (vco(multiply).abs_diff(MIDDLE * d), std::cmp::Reverse(*multiply))
        });
        factors.into_iter().flat_map(move |multiply| {
            let made = move |out: &u8| (vco(&multiply), d * u64::from(*out));
            let outs = (1..129_u8).filter(move |out| within(made(out).0, made(out).1, OUT));
            outs.map(move |out_divide| Way {
                manager: ClockManager::Ecp5Pll(Ecp5Pll { divide, multiply, out_divide }),
                made: made(&out_divide),
            })
        })
    })
}
