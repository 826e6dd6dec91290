//! The MMCM of a Spartan-7 of speed grade -1. Only whole factors are used.

use super::{ClockManager, Way};
use schemars::JsonSchema;
use serde::Serialize;

/// CLKFBOUT_MULT_F, DIVCLK_DIVIDE and CLKOUT0_DIVIDE_F.
#[derive(Debug, Clone, Copy, PartialEq, Eq, JsonSchema, Serialize)]
pub struct Mmcm {
    /// 2 to 64.
    pub multiply: u8,
    /// Divides the reference, 1 to 106.
    pub divide: u8,
    /// Divides the VCO, 1 to 128.
    pub out_divide: u8,
}

const MHZ: u64 = 1_000_000;

/// Ranges of frequencies, Hz: DETECTOR for the input and the phase detector, VCO, and OUT for the
/// output.
const DETECTOR: (u64, u64) = (10 * MHZ, 450 * MHZ);
const VCO: (u64, u64) = (600 * MHZ, 1200 * MHZ);
const OUT: (u64, u64) = (5 * MHZ, 800 * MHZ);

/// All settings, in the order of preference: the smallest reference divider first, and with it the
/// fastest VCO, which has the least jitter.
pub(super) fn ways(oscillator_hz: u64) -> impl Iterator<Item = Way> {
    let f = oscillator_hz.min(OUT.1 + 1);
    let within = |a: u64, b: u64, range: (u64, u64)| a >= range.0 * b && a <= range.1 * b;
    let references = (1..107_u8).filter(move |&divide| within(f, u64::from(divide), DETECTOR));
    references.flat_map(move |divide| {
        let d = u64::from(divide);
        let vcos =
            (2..65_u8).rev().filter(move |&multiply| within(f * u64::from(multiply), d, VCO));
        vcos.flat_map(move |multiply| {
            let vco = f * u64::from(multiply);
            let outs =
                (1..129_u8).filter(move |&out_divide| within(vco, d * u64::from(out_divide), OUT));
            outs.map(move |out_divide| Way {
                manager: ClockManager::Mmcm(Mmcm { multiply, divide, out_divide }),
                made: (vco, d * u64::from(out_divide)),
            })
        })
    })
}
