//! Ctrl-C, and whatever else asks the command to end: a flag from the first file that is begun, or the first run,
//! so that nothing half written stays behind. Before that the command ends as any other.

use crate::failure::Failure;
use std::sync::Once;
use std::sync::atomic::{AtomicBool, Ordering};

static ASKED: AtomicBool = AtomicBool::new(false);
static WATCH: Once = Once::new();

/// From now on to be asked to end sets the flag. It is returned.
pub fn watch() -> &'static AtomicBool {
    // Where there can be no handler, the command ends as any other.
    WATCH.call_once(|| drop(ctrlc::set_handler(|| ASKED.store(true, Ordering::Relaxed))));
    &ASKED
}

/// Fails once the flag is set.
pub fn check() -> Result<(), Failure> {
    if ASKED.load(Ordering::Relaxed) { Err(Failure::Run("interrupted: nothing is kept".into())) } else { Ok(()) }
}
