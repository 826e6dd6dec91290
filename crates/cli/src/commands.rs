//! One file a subcommand.

pub mod boards;
pub mod build;
pub mod check;
pub mod demo;
pub mod doctor;
pub mod home;
pub mod plan;
pub mod profile;
pub mod run;
pub mod simulate;
pub mod status;
pub mod stop;
pub mod sweep;
pub mod table;
pub mod verilog;
#[cfg(unix)]
pub mod virtual_board;
