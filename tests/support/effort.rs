//! How much lock-step is enough: a little in every test run, a lot when `cargo xtask lockstep` asks for it.

use std::io::Write as _;

/// The clocks that a random run takes at least, where `usual` will do in every test run.
///
/// # Panics
/// Where `CARRYSTEP_CLOCKS` is no number: a long run that is none would prove nothing.
pub fn clocks(usual: u64) -> u64 {
    asked().map_or(usual, |asked| asked.max(usual))
}

/// Everything that there is, not what is quick.
pub fn is_long() -> bool {
    asked().is_some()
}

/// Every board, not one of a kind.
pub fn is_every_board() -> bool {
    std::env::var_os("CARRYSTEP_BOARDS").is_some()
}

/// A line about what has been done.
pub fn say(line: &str) {
    // Nobody is left to tell if this fails.
    let _ = writeln!(std::io::stderr(), "{line}");
}

/// What a long run came to, in one line of its own that `cargo xtask long` takes into `docs/long-runs.md`.
pub fn figures(line: &str) {
    say(&format!("FIGURES {line}"));
}

fn asked() -> Option<u64> {
    let text = std::env::var("CARRYSTEP_CLOCKS").ok()?;
    Some(text.parse().expect("CARRYSTEP_CLOCKS is a number of clocks"))
}
