//! The question before a program is entered at one of its blocks.

use crate::entry::EntryFigures;
use crate::failure::Failure;
use crate::interrupt;
use carrystep_link::Wish;
use std::io::{self, IsTerminal as _, Write as _};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

/// Time between two looks at requests of other commands.
const LOOK: Duration = Duration::from_millis(10);

/// The message where the answer was no.
const REFUSED: &str = "not confirmed; nothing was sent";

/// Shows how a program is entered, and asks whether it shall be, unless `yes` is set. `wish` is
/// called meanwhile, so that other commands get answers.
///
/// # Errors
/// The answer is no, there is no terminal that could give one, or a stop was requested.
pub fn confirm(
    entry: &EntryFigures,
    yes: bool,
    mut wish: impl FnMut() -> Wish,
) -> Result<(), Failure> {
    // If this write fails, there is no channel left to report it.
    let _ = write!(io::stderr(), "{entry}");
    if yes {
        return Ok(());
    }
    if !io::stdin().is_terminal() {
        let message = "--from-block asks before it begins, and there is no terminal for the answer: \
                       add --yes if the entry above is right";
        return Err(Failure::input(message));
    }
    let _ = write!(io::stderr(), "is this right? y begins, Enter alone does not: ");
    let (sender, answer) = channel();
    // The thread ends with the process: nothing can end a read of a terminal.
    std::thread::spawn(move || {
        let mut line = String::new();
        let _ = io::stdin().read_line(&mut line);
        let _ = sender.send(line);
    });
    loop {
        if wish() == Wish::Stop || interrupt::is_asked() {
            return Err(Failure::Run("stopped before the program began; nothing was sent".into()));
        }
        match answer.recv_timeout(LOOK) {
            Ok(line) if matches!(line.trim(), "y" | "Y" | "yes") => return Ok(()),
            Err(RecvTimeoutError::Timeout) => {}
            _ => return Err(Failure::input(REFUSED)),
        }
    }
}
