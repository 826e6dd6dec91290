//! The ladder: tools, arrows, lints, then every rung as a test of its own.

use crate::shell::{self, TaskResult};
use crate::{accuracy, arrows, bench, decisions, readme, testing, tools};
use std::thread;

/// Everything, in the order in which failing is cheapest. No rung is skipped: a missing tool is an
/// error.
pub fn climb() -> TaskResult {
    decisions::check()?;
    // What is compiled needs no tool of others, and an installation mostly waits for the network. The
    // sources are read for the arrows on one core, in some seconds.
    let (tools, arrows, linted) = thread::scope(|scope| {
        let tools = scope.spawn(tools::install);
        let arrows = scope.spawn(arrows::check);
        let linted = lint();
        (tools.join(), arrows.join(), linted)
    });
    arrows.unwrap_or_else(|_| Err("the check of the arrows has panicked".to_owned()))?;
    linted?;
    tools.unwrap_or_else(|_| Err("the installation of tools has panicked".to_owned()))?;
    bare()?;
    let tests = testing::build()?;
    // The figures take one core for some seconds.
    let (figures, tests) = thread::scope(|scope| {
        let figures = scope.spawn(figures);
        let tests = tests.run();
        (figures.join(), tests)
    });
    tests?;
    figures.unwrap_or_else(|_| Err("the comparison of figures has panicked".to_owned()))
}

/// The figures of README and pages are those of the command, and the benchmark runs.
fn figures() -> TaskResult {
    readme::check()?;
    accuracy::check()?;
    bench::run(false, true)
}

/// Rung 7 by itself, with its table.
pub fn prove() -> TaskResult {
    tools::install()?;
    let rung =
        ["test", "--release", "-p", "carrystep-tests", "--test", "rung_7_promises_are_proved"];
    shell::run("cargo", &[&rung[..], &["--", "--nocapture"]].concat())
}

/// A microcontroller without atomics, and without anything of `std`.
const BARE: &str = "thumbv6m-none-eabi";

/// The link's core on a bare microcontroller; where its target cannot be had, on this machine
/// without `std`.
pub fn bare() -> TaskResult {
    let check =
        ["check", "--quiet", "-p", "carrystep-link", "--no-default-features", "--features", "spi"];
    let there = shell::is_there("rustup") && shell::run("rustup", &["target", "add", BARE]).is_ok();
    if !there {
        shell::say(&format!("no target {BARE}: checked for this machine, without std"));
    }
    let target: &[&str] = if there { &["--target", BARE] } else { &[] };
    shell::run("cargo", &[&check[..], target].concat())
}

/// Formatting and lints.
pub fn lint() -> TaskResult {
    shell::run("cargo", &["fmt", "--all", "--check"])?;
    shell::run(
        "cargo",
        &["clippy", "--quiet", "--release", "--workspace", "--all-targets", "--", "-D", "warnings"],
    )
}

/// The long lock-step: what a test run does in part, it does whole.
pub fn lockstep() -> TaskResult {
    tools::install()?;
    let run = |test| {
        let arguments =
            ["test", "--release", "-p", "carrystep-tests", "--test", test, "--", "--nocapture"];
        shell::run_with(&[("CARRYSTEP_CLOCKS", "10000000")], "cargo", &arguments)
    };
    run("rung_4_model_equals_rust_hdl")?;
    run("rung_5_model_equals_verilog")?;
    run("rung_6_netlist_and_bitstream_equal_verilog")
}

/// All mutants of the engine, where a test run takes a few.
pub fn mutants(write: bool) -> TaskResult {
    tools::install()?;
    let test = [
        "test",
        "--release",
        "-p",
        "carrystep-tests",
        "--test",
        "rung_8_mutants_are_caught",
        "--",
        "--nocapture",
    ];
    shell::run_with(&[("CARRYSTEP_MUTANTS", if write { "write" } else { "all" })], "cargo", &test)
}
