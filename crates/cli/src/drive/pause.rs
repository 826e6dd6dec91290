//! A wait of a program, at a place of its own or in a hold, until somebody lets it go on: by Enter in
//! this terminal, or by `carrystep resume` in another one. The board hears this host all the while, so that its watchdog rests.

use super::Line;
use crate::connection::{ConnectedBoard, ConnectedBoardError};
use crate::control::{Control, ProgramControl};
use carrystep_link::{HostError, Wish};
use carrystep_runner::Wait;
use std::io::{self, IsTerminal as _, Write as _};
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

/// Time between two looks at the board.
const LOOK: Duration = Duration::from_millis(10);

/// The lines that the user enters in this terminal.
#[derive(Default)]
pub(super) struct Keys {
    lines: Option<Receiver<()>>,
}

impl Keys {
    /// Forgets the lines that were entered before, and listens from now on. Returns whether there
    /// is a terminal.
    fn listen(&mut self) -> bool {
        if !io::stdin().is_terminal() {
            return false;
        }
        let lines = self.lines.get_or_insert_with(|| {
            let (sender, lines) = channel();
            // The thread ends with the process: nothing can end a read of a terminal.
            std::thread::spawn(move || {
                let mut line = String::new();
                while io::stdin().read_line(&mut line).is_ok_and(|bytes| bytes > 0)
                    && sender.send(()).is_ok()
                {
                    line.clear();
                }
            });
            lines
        });
        lines.try_iter().for_each(drop);
        true
    }

    fn entered(&self) -> bool {
        self.lines.as_ref().is_some_and(|lines| lines.try_recv().is_ok())
    }
}

/// How a wait ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Waited {
    /// The program goes on.
    GoesOn,
    /// The program is to end here, at rest.
    Ends,
    /// The axes are to be stopped.
    Stopped,
}

/// Waits until somebody lets the program go on.
pub(super) fn wait(
    board: &mut ConnectedBoard,
    control: &mut Control,
    (keys, line): (&mut Keys, &Line<'_>),
    at: Wait,
) -> Result<Waited, ConnectedBoardError> {
    let enter = if keys.listen() { "Enter, or " } else { "" };
    line.above(|| {
        // If this write fails, there is no channel left to report it.
        let _ = writeln!(
            io::stderr(),
            "{at}: the machine rests; {enter}`carrystep resume` in another terminal lets it go on, and Ctrl-C ends it"
        );
    });
    control.program().into_iter().for_each(|program| program.rests(at.to_string()));
    loop {
        let status = board.read_status()?;
        let answer = status.answer;
        if answer.fault {
            return Err(HostError::Fault { cause: answer.cause, culprits: answer.culprits });
        }
        if control.wish(&status) == Wish::Stop {
            return Ok(Waited::Stopped);
        }
        let program = control.program();
        let (ends, resumed) =
            program.map_or((false, false), |program| (program.ends(), program.resumed()));
        if ends {
            control.ends_program();
            return Ok(Waited::Ends);
        }
        if resumed || keys.entered() {
            control.program().into_iter().for_each(ProgramControl::moves);
            return Ok(Waited::GoesOn);
        }
        std::thread::sleep(LOOK);
    }
}
