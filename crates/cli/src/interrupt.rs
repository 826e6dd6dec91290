//! Handles Ctrl-C and the signals that end a program. From the first file that is begun, or the
//! first run, they only set a flag and are counted, so that no incomplete file remains. Before that,
//! they end the command as usual.

use crate::failure::Failure;
use std::sync::Once;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};

static ASKED: AtomicBool = AtomicBool::new(false);
static COUNT: AtomicU32 = AtomicU32::new(0);
static WATCH: Once = Once::new();

/// Installs the handler and returns the flag that it sets.
pub fn watch() -> &'static AtomicBool {
    // If no handler can be installed, signals end the command as usual.
    let came = || {
        COUNT.fetch_add(1, Ordering::Relaxed);
        ASKED.store(true, Ordering::Relaxed);
    };
    WATCH.call_once(|| drop(ctrlc::set_handler(came)));
    &ASKED
}

/// How many of these signals have come.
pub fn count() -> u32 {
    COUNT.load(Ordering::Relaxed)
}

/// Whether the flag is set.
pub fn is_asked() -> bool {
    ASKED.load(Ordering::Relaxed)
}

/// Fails if the flag is set.
pub fn check() -> Result<(), Failure> {
    if is_asked() { Err(Failure::Run("interrupted: nothing is kept".into())) } else { Ok(()) }
}
