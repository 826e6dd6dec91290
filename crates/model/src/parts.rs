//! Functions and types that the models of both cores share.

pub(crate) mod cubic;
pub(crate) mod moving;
pub mod phase;
pub mod shaper;
pub mod stage;
