//! The modules of one axis that turn steps into pulses, and the tick counter that both cores use.

pub mod edge;
pub mod shaper;
pub mod tick;
