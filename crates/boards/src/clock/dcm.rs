//! The frequency synthesiser of a Spartan-3, 3E or 6: the output CLKFX of a DCM without feedback.

use super::{ClockManager, Way};
use schemars::JsonSchema;
use serde::Serialize;
use std::ops::RangeInclusive;

/// CLKFX_MULTIPLY and CLKFX_DIVIDE.
#[derive(Debug, Clone, Copy, PartialEq, Eq, JsonSchema, Serialize)]
pub struct Dcm {
    /// 2 to 32.
    pub multiply: u8,
    /// 1 to 32.
    pub divide: u8,
}

/// All settings, in the order of preference: the smallest divider first, then the smallest
/// multiplier, because small factors lock fastest.
pub(super) fn ways(
    oscillator_hz: u64,
    least_in: u64,
    out: RangeInclusive<u64>,
) -> impl Iterator<Item = Way> {
    let f = if oscillator_hz < least_in { 0 } else { oscillator_hz.min(1 << 32) };
    (1..33_u8).flat_map(move |divide| {
        let (out, d) = (out.clone(), u64::from(divide));
        let pairs = (2..33_u8).map(move |multiply| (multiply, f * u64::from(multiply)));
        pairs.filter(move |(_, made)| *made >= out.start() * d && *made <= out.end() * d).map(
            move |(multiply, made)| Way {
                manager: ClockManager::Dcm(Dcm { multiply, divide }),
                made: (made, d),
            },
        )
    })
}
