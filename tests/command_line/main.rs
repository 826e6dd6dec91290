//! The command from outside: what it says, its exit status, and what it leaves behind.

#![allow(clippy::unwrap_used)] // a test may panic

mod bad_captures;
mod bad_curves;
mod bad_files;
mod bad_machines;
mod bad_moves;
mod bad_outputs;
mod command;
mod curves;
mod engine;
mod interrupts;
mod json_names;
mod profile;
mod sweeps;
mod table;
