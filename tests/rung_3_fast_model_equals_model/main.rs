//! Rung 3: the fast model is the clock-by-clock model: the same registers wherever it stops, the
//! same edges (ten million of them and more), the same outputs in every clock.

mod engine;
mod parallel;

use proptest::prelude::*;

/// Lengths of leaps: as far as possible, or ending in any clock.
pub(crate) fn leaps() -> impl Strategy<Value = Vec<u64>> {
    prop_oneof![2 => Just(vec![u64::MAX]), 1 => prop::collection::vec(1_u64..5000, 1..20)]
}
