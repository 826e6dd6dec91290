//! The parallel core: each axis has adders of its own, so that all six make their step in the same
//! clock. It is the article's picture and the independent sibling of [`crate::engine`].

pub mod axis;
pub mod sequencer;
mod sim;
pub mod six_axis;

pub use axis::Axis;
pub use sim::{AxisSim, SixAxisSim};
pub use six_axis::SixAxis;
