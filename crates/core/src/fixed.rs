//! Number formats of the arithmetic contract. One unit of distance is 2^-64 step; time is counted
//! in ticks.
//!
//! Every value that is counted or that decides where an edge falls is one of these integers. No
//! float does either.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Fractional bits of a position: one step is 2^64 units.
pub const FRACTION_BITS: u32 = 64;

/// One step in units of 2^-64 step.
pub const ONE_STEP: i128 = 1 << FRACTION_BITS;

/// Width of a segment's tick count, bits.
pub const TICKS_BITS: u32 = 32;

/// Width of the position register, bits, two's complement.
pub const POSITION_BITS: u32 = 32;

/// Phase of a step in which a move starts and ends.
///
/// `Half` puts every pulse of a move in the middle of a step, so that the last pulse of a move
/// which ends at rest is well conditioned. `Zero` is Table 1 of Ranade (2009).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, JsonSchema, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum StartPhase {
    /// P starts at 2^63, half a step.
    #[default]
    Half,
    /// P starts at 0.
    Zero,
}

impl StartPhase {
    /// Value of P before the first move and after every move, in units of 2^-64 step.
    pub const fn start_value(self) -> u64 {
        match self {
            Self::Half => 1 << 63,
            Self::Zero => 0,
        }
    }

    /// Distance from the start of a move at which pulse `k` (from 1) is due, in half steps:
    /// 2k - 1 at half phase, 2k forward and 2k - 2 backward at zero phase.
    pub const fn pulse_half_steps(self, k: u64, backward: bool) -> u64 {
        match (self, backward) {
            (Self::Half, _) => 2 * k - 1,
            (Self::Zero, false) => 2 * k,
            (Self::Zero, true) => 2 * k - 2,
        }
    }
}
