//! The PLL of an iCE40 with simple feedback. Its ranges and filter steps are those of icestorm's
//! `icepll`; among equal settings the same one is chosen (`tests/clocks.rs` compares them).

use super::{ClockManager, Way};
use schemars::JsonSchema;
use serde::Serialize;

/// Settings of `SB_PLL40_CORE` or `SB_PLL40_PAD`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, JsonSchema, Serialize)]
pub struct Ice40Pll {
    /// DIVR, 0 to 15: divides the reference by one more.
    pub divr: u8,
    /// DIVF, 0 to 127: multiplies it by one more.
    pub divf: u8,
    /// DIVQ, 1 to 6: divides the VCO by 2^DIVQ.
    pub divq: u8,
    /// FILTER_RANGE, 1 to 6, by the phase detector's frequency.
    pub filter_range: u8,
}

const MHZ: u64 = 1_000_000;

/// Ranges of frequencies, MHz: DETECTOR for the phase detector and the input, VCO, and OUT for the
/// output.
const DETECTOR: (u64, u64) = (10, 133);
const VCO: (u64, u64) = (533, 1066);
const OUT: (u64, u64) = (16, 275);

/// Filter range by the frequency of the phase detector: lowest frequency, MHz, and the range from
/// there on.
const FILTER: [(u64, u8); 6] = [(101, 6), (66, 5), (44, 4), (26, 3), (17, 2), (0, 1)];

/// Whether a / b Hz lies within a range given in MHz.
const fn within(a: u64, b: u64, range: (u64, u64)) -> bool {
    a >= range.0 * MHZ * b && a <= range.1 * MHZ * b
}

/// All settings, in the order in which `icepll` tries them.
pub(super) fn ways(oscillator_hz: u64) -> impl Iterator<Item = Way> {
    let f = oscillator_hz.min(DETECTOR.1 * MHZ + 1);
    let references = (0..16_u8)
        .filter(move |&divr| within(f, 1, DETECTOR) && within(f, u64::from(divr) + 1, DETECTOR));
    references.flat_map(move |divr| {
        let r = u64::from(divr) + 1;
        let filter_range =
            FILTER.iter().find(|(from, _)| f >= from * MHZ * r).map_or(1, |&(_, range)| range);
        let vcos = (0..128_u8).filter(move |&divf| within(f * (u64::from(divf) + 1), r, VCO));
        vcos.flat_map(move |divf| {
            let vco = f * (u64::from(divf) + 1);
            let outs = (1..7_u8).filter(move |&divq| within(vco, r << divq, OUT));
            outs.map(move |divq| Way {
                manager: ClockManager::Ice40Pll(Ice40Pll { divr, divf, divq, filter_range }),
                made: (vco, r << divq),
            })
        })
    })
}
