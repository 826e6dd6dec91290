//! The `carrystep` command: arguments in, reports out; no logic of its own.

mod arguments;
mod commands;
mod connection;
mod control;
#[cfg(unix)]
mod desk;
mod drive;
mod failure;
mod figures;
mod found;
mod gateware;
mod homing;
mod interrupt;
mod job;
mod memory;
mod output;
mod progress;
#[cfg(unix)]
mod switches;
mod table;
mod wanted;

use arguments::{Arguments, Subcommand};
use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments = Arguments::parse();
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
        Subcommand::Jog(jog) => commands::run::jog(jog),
        Subcommand::Home(home) => commands::home::run(home),
        Subcommand::Status(status) => commands::status::status(status),
        Subcommand::Stop(stop) => commands::stop::stop(stop),
        #[cfg(unix)]
        Subcommand::VirtualBoard(board) => commands::virtual_board::run(board),
        Subcommand::Build(build) => commands::build::run(build),
        Subcommand::Boards(boards) => commands::boards::run(boards),
        Subcommand::Doctor(doctor) => commands::doctor::run(doctor),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.tell(),
    }
}
