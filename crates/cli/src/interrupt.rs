//! Handles Ctrl-C and the signals that end a program. From the first file that is begun, or the
//! first run, they only set a flag, so that no incomplete file remains. Before that, they end the
//! command as usual.

use crate::failure::Failure;
use std::sync::Once;
use std::sync::atomic::{AtomicBool, Ordering};

static ASKED: AtomicBool = AtomicBool::new(false);
static WATCH: Once = Once::new();

/// Installs the handler and returns the flag that it sets.
pub fn watch() -> &'static AtomicBool {
    // If no handler can be installed, signals end the command as usual.
    WATCH.call_once(|| drop(ctrlc::set_handler(|| ASKED.store(true, Ordering::Relaxed))));
    &ASKED
}

/// Whether the flag is set.
pub fn is_asked() -> bool {
    ASKED.load(Ordering::Relaxed)
}

/// Fails if the flag is set.
pub fn check() -> Result<(), Failure> {
    if is_asked() { Err(Failure::Run("interrupted: nothing is kept".into())) } else { Ok(()) }
}
