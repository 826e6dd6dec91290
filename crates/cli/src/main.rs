//! The `carrystep` command. It parses the arguments, calls the library crates and prints their
//! reports; the logic is in those crates.

mod arguments;
mod belt_ways;
mod bitstream;
mod capture;
mod claimed_line;
mod colour;
mod commands;
mod confirm;
mod connection;
mod control;
mod document;
mod documents;
mod drive;
mod ending;
mod entry;
mod excerpt;
mod executable;
mod failure;
mod figures;
mod found;
mod gateware;
mod holder;
mod homing;
mod interrupt;
mod job;
mod jog;
mod json;
mod junit;
mod limits;
mod memory;
mod one_pass;
#[cfg(unix)]
mod operated;
mod output;
mod pass;
mod pause;
mod probe;
mod program;
mod program_run;
mod program_table;
mod progress;
mod recorded;
mod segments;
#[cfg(unix)]
mod serve;
#[cfg(unix)]
mod shipped;
mod spool;
mod switches;
mod table;
mod wanted;
mod work;

use arguments::{Arguments, Subcommand};
use carrystep_tools::kept;
use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    output::json_is_wanted(std::env::args_os());
    // Whoever builds a bitstream, or simulates Verilog, expects that the tools are run.
    kept::never();
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => return ending::usage(&error),
    };
    let result = match &arguments.command {
        Subcommand::Demo(demo) => commands::demo::run(demo),
        Subcommand::Profile(profile) => commands::profile::run(profile),
        Subcommand::Table(table) => commands::table::run(table),
        Subcommand::Plan(plan) => commands::plan::run(plan),
        Subcommand::Simulate(simulate) => commands::simulate::run(simulate),
        Subcommand::Check(check) => commands::check::run(check),
        Subcommand::Verilog(verilog) => commands::verilog::run(verilog),
        Subcommand::Sweep(sweep) => commands::sweep::run(sweep),
        Subcommand::Run(run) => commands::run::run(run),
        Subcommand::Hold(port) => commands::hold::hold(port),
        Subcommand::Resume(port) => commands::hold::resume(port),
        Subcommand::Override(overrides) => commands::overrides::run(overrides),
        Subcommand::Jog(jog) => commands::run::jog(jog),
        Subcommand::Probe(probe) => commands::probe::run(probe),
        Subcommand::Offset(offset) => commands::offset::run(offset),
        #[cfg(unix)]
        Subcommand::Serve(serve) => commands::serve::run(serve),
        Subcommand::Home(home) => commands::home::run(home),
        Subcommand::Status(status) => commands::status::status(status),
        Subcommand::Stop(stop) => commands::stop::stop(stop),
        #[cfg(unix)]
        Subcommand::VirtualBoard(board) => commands::virtual_board::run(board),
        Subcommand::Linuxcnc(linuxcnc) => commands::linuxcnc::run(linuxcnc),
        Subcommand::Machine(machine) => commands::machine::run(machine),
        Subcommand::Build(build) => commands::build::run(build),
        Subcommand::Selftest(selftest) => commands::selftest::run(selftest),
        Subcommand::Boards(boards) => commands::boards::run(boards),
        Subcommand::Doctor(doctor) => commands::doctor::run(doctor),
        Subcommand::Completions(completions) => commands::completions::run(completions),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => ending::tell(failure),
    }
}
