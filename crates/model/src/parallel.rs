//! The parallel core: each axis has adders of its own.

pub mod axis;
pub mod six_axis;

pub use six_axis::SixAxis;
