//! All integration tests of this crate, in one program. With a program for each file, what they
//! share would be compiled and linked again for each.
#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches unit tests only")]

mod jobs;
#[path = "../../../tests/support/repeats.rs"]
mod repeats;
#[path = "../../virtual-board/tests/support/mod.rs"]
mod support;
mod three_axes;

mod first_changes;
mod growing;
mod holds_on_a_board;
mod hours_of_a_program;
mod late_hosts;
mod overrides;
mod pulses_of_simulate;
mod runs_over_spi;
mod time_left;
