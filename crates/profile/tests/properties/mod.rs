//! Tests properties that hold for every curve, over the whole range of stepper moves.

mod laws;
mod limits;
mod moves;
mod ramps;

use proptest::prelude::*;

/// A number from `low` to `high`, with every decade equally likely.
fn decades(low: f64, high: f64) -> impl Strategy<Value = f64> {
    (low.ln()..high.ln()).prop_map(f64::exp)
}
