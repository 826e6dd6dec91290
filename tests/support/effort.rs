//! Controls the amount of lock-step: a little in every test run, and more if `cargo xtask lockstep`
//! or `cargo xtask long` sets an environment variable.

use std::io::Write as _;

/// The least number of clocks of a random run: `usual`, or more if `CARRYSTEP_CLOCKS` asks for it.
///
/// # Panics
/// If `CARRYSTEP_CLOCKS` is not a number, because a long run that falls back to the usual length
/// would prove nothing.
pub fn clocks(usual: u64) -> u64 {
    asked().map_or(usual, |asked| asked.max(usual))
}

/// True in a long run, which must cover everything and not only what is quick.
pub fn is_long() -> bool {
    asked().is_some()
}

/// True if every board must be covered and not only one of each kind.
pub fn is_every_board() -> bool {
    std::env::var_os("CARRYSTEP_BOARDS").is_some()
}

/// Prints a line about the work that was done.
pub fn say(line: &str) {
    // If this write fails, there is no channel left to report it.
    let _ = writeln!(std::io::stderr(), "{line}");
}

/// Prints the figures of a long run as one line, which `cargo xtask long` copies into
/// `docs/long-runs.md`.
pub fn figures(line: &str) {
    say(&format!("FIGURES {line}"));
}

fn asked() -> Option<u64> {
    let text = std::env::var("CARRYSTEP_CLOCKS").ok()?;
    Some(text.parse().expect("CARRYSTEP_CLOCKS is a number of clocks"))
}
