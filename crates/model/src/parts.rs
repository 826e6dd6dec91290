//! Functions that the models of both cores share.

pub mod phase;
pub mod shaper;
