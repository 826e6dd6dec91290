//! The subcommands, one file each.

pub mod boards;
pub mod build;
pub mod check;
pub mod check_program;
pub mod completions;
pub mod demo;
pub mod doctor;
pub mod hold;
pub mod home;
pub mod linuxcnc;
pub mod list_blocks;
pub mod machine;
pub mod offset;
pub mod overrides;
pub mod plan;
pub mod plan_program;
pub mod probe;
pub mod profile;
pub mod run;
pub mod run_program;
pub mod selftest;
#[cfg(unix)]
pub mod serve;
pub mod simulate;
pub mod status;
pub mod stop;
pub mod sweep;
pub mod table;
pub mod verilog;
#[cfg(unix)]
pub mod virtual_board;
