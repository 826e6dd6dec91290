//! What a person does twice, one command each. CI calls nothing else.

mod arrows;
mod ladder;
mod readme;
mod shell;
mod tools;

use clap::{Parser, Subcommand};
use std::process::ExitCode;

/// Chores of the carrystep workspace.
#[derive(Parser)]
#[command(name = "cargo xtask", version)]
struct Arguments {
    #[command(subcommand)]
    chore: Chore,
}

#[derive(Subcommand)]
enum Chore {
    /// Install what is missing, then pass every test: the whole ladder. This is what CI runs.
    Test,
    /// Install the simulators and yosys that the tests need, by apt.
    Tools,
    /// Ten million clocks of lock-step for each test of the engine, and its longest golden vectors.
    Lockstep,
    /// Check that the arrows between the crates go one way.
    Arrows,
    /// Formatting and lints, without a warning.
    Lint,
    /// Write `hdl-out/` anew from the Rust-HDL modules.
    Generate,
    /// Write the README's table and pictures anew from the demo (the waveform needs gtkwave and xvfb).
    Readme,
}

fn main() -> ExitCode {
    let result = match Arguments::parse().chore {
        Chore::Test => ladder::climb(),
        Chore::Tools => tools::install(),
        Chore::Lockstep => ladder::lockstep(),
        Chore::Arrows => arrows::check(),
        Chore::Lint => ladder::lint(),
        Chore::Generate => readme::generate(),
        Chore::Readme => readme::write(),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            shell::say(&format!("xtask: {message}"));
            ExitCode::FAILURE
        }
    }
}
