//! The parallel core: each axis has adders of its own.

pub mod axis;
pub mod core;

pub use self::core::ParallelCore;
