//! All integration tests of this crate, in one program. With a program for each file, what they
//! share would be compiled and linked again for each.
#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches unit tests only")]

#[path = "support/asked.rs"]
mod asked;
#[path = "support/axes.rs"]
mod axes;
#[path = "../../../tests/support/repeats.rs"]
mod repeats;
mod support;

use support::random;

mod bad_line;
mod bus;
mod busy_computer;
mod c_library;
mod clocks;
mod corexy_homing;
mod cuts;
mod dead_host;
mod facts;
mod frozen;
mod gantry_homing;
mod homing;
mod host;
mod latches;
mod late_host;
mod pace;
mod page;
mod rates;
mod snapshots;
mod stranger;
mod talk;
mod terminal;
