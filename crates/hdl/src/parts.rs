//! Modules that both cores are made of.

pub mod edge;
pub mod shaper;
pub mod tick;
