//! The gateware as integer functions: `state, input -> state, output`, tick by tick for the
//! accumulator, clock by clock for the pins and the host link.
//!
//! Written from docs/clock-by-clock.md and from nothing of `crates/hdl`: the two are strangers, so
//! that their agreement proves something (docs/decisions/0004). Start with
//! [`parallel::axis::tick`]: it is the whole idea.

pub mod engine;
pub mod fast;
pub mod link;
pub mod parallel;
pub mod parts;

pub use engine::Engine;
pub use fast::{Fast, FastEngine};
pub use link::Link;
pub use parallel::SixAxis;
