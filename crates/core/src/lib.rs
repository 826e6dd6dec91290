//! The definitions that the crates of carrystep share: number formats, segments, build parameters,
//! faults, stop causes, registers and the link's program. It needs no standard library.
//!
//! This crate computes no motion. Each fact that two crates must agree on is defined here, once.

#![no_std]

extern crate alloc;
#[cfg(test)]
extern crate std;

pub mod build;
pub mod engine;
pub mod fault;
pub mod fixed;
pub mod link;
pub mod ports;
mod profile_kind;
mod schedule;
pub mod segment;
pub mod tick;

pub use build::{AXES, Build, PinTiming, Timebase};
pub use engine::EngineBuild;
pub use fault::Faults;
pub use fixed::StartPhase;
pub use profile_kind::ProfileKind;
pub use segment::{Command, Program, Segment};
pub use tick::ChosenTick;
