//! The executable model of the gateware in integer arithmetic. Each part is a pure function from
//! state and inputs to the next state and outputs: one call is one tick for the accumulator, and
//! one clock for the step shaper, the cores and the host link.
//!
//! The model is written from docs/clock-by-clock.md, docs/link.md and docs/self-test.md, and uses
//! nothing of `crates/hdl`. The two implementations share no code, so their agreement is evidence
//! that both are right (docs/decisions/0004). [`parallel::axis::tick`] is the central function and
//! the best place to start reading.
//!
//! Any change of behaviour here must be made in docs/clock-by-clock.md and in `crates/hdl` as well;
//! the tests compare them in every clock.

pub mod engine;
pub mod fast;
pub mod link;
pub mod parallel;
pub mod parts;
pub mod self_test;

pub use engine::Engine;
pub use fast::{Fast, FastEngine, HostedEngine};
pub use link::{Awaited, Link, SPI_RESTS};
pub use parallel::ParallelCore;
pub use self_test::SelfTest;
