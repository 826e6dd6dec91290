//! The parallel core: each of its axes has its own adders, so that all axes work in the same clock.
//!
//! It is the circuit that the article draws, and the reference for [`mod@crate::engine`]: a proof
//! compares the pulses of both. The two cores share only the tick counter and the primitives. The
//! parallel core costs far more flip-flops than the engine, which keeps the state of its axes in
//! block RAM.

pub mod axis;
pub mod core;
pub mod sequencer;
mod sim;

pub use self::core::ParallelCore;
pub use axis::ParallelAxis;
pub use sim::{AnyParallelCore, AxisSim, ParallelSim, parallel_core};
