//! A wait of a program, at a place of its own or in a hold, until somebody lets it go on: by Enter
//! in this terminal, or by `carrystep resume` in another one. The command reads the state of the
//! board meanwhile, so that it notices a stop and answers other commands.

use super::Line;
use super::itinerary::Rest;
use super::pause::Pause;
use crate::connection::{ConnectedBoard, ConnectedBoardError};
use crate::control::{Control, ProgramControl};
use carrystep_link::{HostError, Wish};
use carrystep_runner::Wait;
use std::io::{self, Write as _};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

/// Time between two looks at the board.
const LOOK: Duration = Duration::from_millis(10);

/// Another command may have jogged, probed or set an offset while the program waited. A program that
/// ends stays for at most this time, until that command, which asks every 10 ms, has fetched the
/// result.
const FETCHED: Duration = Duration::from_millis(500);

/// Time between two looks at the requests of that command, meanwhile.
const SOON: Duration = Duration::from_millis(1);

/// The lines that the user enters in this terminal.
pub(super) struct Keys {
    lines: Option<Receiver<()>>,
}

impl Keys {
    /// Listens from now on, if this command runs in the foreground of a terminal: a read in the
    /// background would suspend it.
    pub fn listening() -> Self {
        let lines = is_foreground().then(|| {
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
        Self { lines }
    }

    /// Forgets what was entered before. Returns whether anybody can enter something.
    fn forget(&self) -> bool {
        self.lines.iter().flat_map(Receiver::try_iter).for_each(drop);
        self.lines.is_some()
    }

    fn entered(&self) -> bool {
        self.lines.as_ref().is_some_and(|lines| lines.try_recv().is_ok())
    }
}

/// Whether this process reads from a terminal, in whose foreground it is.
#[cfg(unix)]
fn is_foreground() -> bool {
    rustix::termios::tcgetpgrp(io::stdin()).is_ok_and(|group| group == rustix::process::getpgrp())
}

/// Whether this process reads from a terminal.
#[cfg(not(unix))]
fn is_foreground() -> bool {
    io::IsTerminal::is_terminal(&io::stdin())
}

/// How a wait ended.
#[derive(Debug)]
pub(super) enum Waited {
    /// The program goes on; with its rest if that was planned again.
    GoesOn(Option<Rest>),
    /// The program is to end here, at rest.
    Ends,
}

/// Waits until somebody lets the program go on, or ends it.
pub(super) fn wait(
    board: &mut ConnectedBoard,
    control: &mut Control,
    of_terminal: (&mut Keys, &Line<'_>),
    place: (Wait, &mut Pause<'_>),
) -> Result<Waited, ConnectedBoardError> {
    let waited = until_it_goes_on(board, control, of_terminal, place)?;
    let begin = Instant::now();
    let is_unfetched =
        |control: &mut Control| control.program().is_some_and(|program| program.is_unfetched());
    while matches!(waited, Waited::Ends) && is_unfetched(control) && begin.elapsed() < FETCHED {
        std::thread::sleep(SOON);
        // Only the requests of other commands are wanted here: the program ends in any case.
        let _ = control.wish(board.status());
    }
    Ok(waited)
}

fn until_it_goes_on(
    board: &mut ConnectedBoard,
    control: &mut Control,
    (keys, line): (&mut Keys, &Line<'_>),
    (at, pause): (Wait, &mut Pause<'_>),
) -> Result<Waited, ConnectedBoardError> {
    let enter = if keys.forget() { "Enter, or " } else { "" };
    line.above(|| {
        // If this write fails, there is no channel left to report it.
        let _ = writeln!(
            io::stderr(),
            "{at}: the machine rests; {enter}`carrystep resume` in another terminal lets it go on, \
             and Ctrl-C ends it"
        );
    });
    let place = at.to_string();
    control.program().into_iter().for_each(|program| program.rests(place.clone()));
    loop {
        if pause.look(board, control, &place)? {
            // What was entered while the machine moved was not meant for its rest.
            keys.forget();
        }
        let status = board.read_status()?;
        let answer = status.answer;
        if answer.fault {
            return Err(HostError::Fault { cause: answer.cause, culprits: answer.culprits });
        }
        if control.wish(&status) == Wish::Stop {
            return Ok(Waited::Ends);
        }
        let program = control.program();
        let (ends, resumed) =
            program.map_or((false, false), |program| (program.ends(), program.resumed()));
        if ends {
            control.ends_program();
            return Ok(Waited::Ends);
        }
        if resumed || keys.entered() {
            let mut wish = || {
                let ends = control.program().is_some_and(|program| program.ends());
                if ends { Wish::Stop } else { control.wish(&status) }
            };
            match pause.go_on(&status, &mut wish) {
                Ok(rest) => {
                    control.program().into_iter().for_each(ProgramControl::moves);
                    return Ok(Waited::GoesOn(rest));
                }
                Err(failure) => {
                    let why = failure.message();
                    let waits = format!("{at}; it cannot go on: {why}");
                    line.above(|| {
                        // If this write fails, there is no channel left to report it.
                        let _ = writeln!(io::stderr(), "{waits}");
                    });
                    control.program().into_iter().for_each(|program| program.stays(waits.clone()));
                }
            }
        }
        std::thread::sleep(LOOK);
    }
}
