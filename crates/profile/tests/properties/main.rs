//! What is true of every curve, over all that a stepper can be asked to do.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the message")]

mod laws;
mod limits;
mod moves;
mod ramps;

use proptest::prelude::*;

/// A number from `low` to `high`, every decade as likely as the next.
fn decades(low: f64, high: f64) -> impl Strategy<Value = f64> {
    (low.ln()..high.ln()).prop_map(f64::exp)
}
