//! The definitions that the crates of carrystep share: number formats, segments, build parameters,
//! faults, stop causes, registers and the link's program. It needs no standard library.
//!
//! Without its feature `alloc` it defines only [`Segment`] and allocates no memory: the host's side
//! of the link uses it so on a microcontroller.
//!
//! This crate computes no motion. Each fact that two crates must agree on is defined here, once.

#![no_std]

#[cfg(feature = "alloc")]
extern crate alloc;
#[cfg(test)]
extern crate std;

#[cfg(feature = "alloc")]
pub mod build;
#[cfg(feature = "alloc")]
pub mod engine;
#[cfg(feature = "alloc")]
pub mod fault;
#[cfg(feature = "alloc")]
pub mod fixed;
#[cfg(feature = "alloc")]
pub mod link;
#[cfg(feature = "alloc")]
mod one_of;
mod output_change;
#[cfg(feature = "alloc")]
pub mod ports;
#[cfg(feature = "alloc")]
mod profile_kind;
#[cfg(feature = "alloc")]
mod schedule;
pub mod segment;
#[cfg(feature = "alloc")]
pub mod self_test;
#[cfg(feature = "alloc")]
pub mod tick;

#[cfg(feature = "alloc")]
pub use self::{
    build::{AXES, Build, PinTimes, PinTiming, Timebase},
    engine::EngineBuild,
    fault::Faults,
    fixed::StartPhase,
    profile_kind::ProfileKind,
    segment::{Command, Program},
    self_test::SelfTest,
    tick::ChosenTick,
};
#[cfg(feature = "alloc")]
pub use one_of::one_of;
pub use output_change::OutputChange;
pub use segment::Segment;
