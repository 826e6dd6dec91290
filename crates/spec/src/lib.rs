//! The definitions that the crates of carrystep share: number formats, segments, build parameters,
//! faults, driver timings, boards and their clocks, machine and move files.
//!
//! This crate computes no motion. Each fact that two crates must agree on is defined here, once.

pub mod board;
pub mod build;
pub mod clock;
pub mod decimal;
pub mod driver;
pub mod engine;
pub mod error;
pub mod fault;
pub mod fixed;
pub mod link;
pub mod machine;
pub mod move_file;
mod number;
pub mod ports;
pub mod segment;
pub mod tick;
pub mod tool;
pub mod unit;

pub use bigdecimal::BigDecimal;
pub use build::{AXES, Build, PinTiming, Timebase};
pub use engine::EngineBuild;
pub use error::{InputError, Source};
pub use fault::Faults;
pub use fixed::StartPhase;
pub use machine::{Axis, Machine, TooManyAxes};
pub use move_file::{Move, MoveFile, PathKind, ProfileKind};
pub use segment::{Command, Program, Segment};
pub use tick::ChosenTick;
pub use unit::Unit;
