//! The way of a board through a plan: one stretch after the other, with what is waited for, read
//! and probed between them.
//!
//! ```text
//! begin -> waits: hold, M0 --> wait.rs       somebody lets the program go on
//!                 M66      --> reading.rs    the rest is planned again if the value is another one
//!                 G38      --> reading.rs    the probe is looked at, and the stretch becomes a seek
//!       -> stream: holds and overrides cut the queues
//!       -> behind a probe the rest is planned again
//! ```

use super::itinerary::{Itinerary, Plan, Rest};
use super::line::Line;
use super::pause::Pause;
use super::reading::{InputRead, Probing, read_input};
use super::wait::{self, Keys, Waited};
use super::ways::Ways;
use crate::connection::{ConnectedBoard, ConnectedBoardError};
use crate::control::Control;
use crate::failure::Failure;
use crate::memory::{self, BoardMemory};
use carrystep_link::{Ended, Progress, Status, Wish};
use carrystep_program::{Found, Input, Offsets, Point, ProgramFile, Reading};
use carrystep_runner::{BlockAt, Wait};
use std::io::{self, Write as _};
use std::time::{Duration, Instant};

/// Time between two searches for a hold that the limits forbid now, and between two changes of
/// overrides.
const TRY_AGAIN: Duration = Duration::from_millis(20);

/// What follows a place at which a program waits or reads something.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Next {
    /// The stretch.
    Stretch,
    /// Another stretch, because the rest was planned again or dropped.
    Other,
}

/// A board on its way through a plan.
pub(super) struct Course<'r, 'p> {
    pub board: &'r mut ConnectedBoard,
    pub control: &'r mut Control,
    pub memory: &'r mut BoardMemory,
    pub itinerary: &'r dyn Itinerary,
    pub plan: &'r mut Plan<'p>,
    pub line: Line<'r>,
    pub keys: Keys,
    pub ways: &'r mut Ways,
    /// The names of the axes.
    pub axes: &'r [String],
    /// Where the positions of the registers are zero, steps from machine zero; empty without a
    /// program.
    pub zero: Vec<i64>,
    /// The state at the beginning.
    pub start: Status,
    /// Whether a stretch was executed.
    pub has_moved: bool,
    /// Whether the program is to end, after its outputs have gone off.
    pub ends: bool,
    /// The probe move in which the machine is.
    pub probe: Option<Probing>,
    /// Why the program cannot go on.
    pub failed: Option<Failure>,
}

impl Course<'_, '_> {
    /// Goes all the way. Returns how it ended, and why the program could not go on if it could not.
    pub fn follow(mut self) -> (Result<Ended, ConnectedBoardError>, Option<Failure>) {
        let outcome = self.stretches();
        (outcome, self.failed)
    }

    fn stretches(&mut self) -> Result<Ended, ConnectedBoardError> {
        'stretches: while let Some(waits) = self.itinerary.begin() {
            for at in waits {
                if self.arrive(at)? == Next::Other {
                    continue 'stretches;
                }
            }
            if self.stream()? == Ended::Stopped {
                return Ok(Ended::Stopped);
            }
            self.has_moved = true;
            if let Some((probing, file)) = self.probe.zip(self.itinerary.program()) {
                self.probed(probing, file)?;
            } else if !self.ends {
                let status = *self.board.status();
                self.control.reached(block(self.itinerary, &self.start, &status));
            }
        }
        if self.ends {
            // The axes rest anywhere between two steps. A clear takes their places as they are.
            self.board.stop()?;
        }
        Ok(if self.ends { Ended::Stopped } else { Ended::Done })
    }

    /// The machine rests at a place before the stretch.
    fn arrive(&mut self, at: Wait) -> Result<Next, ConnectedBoardError> {
        self.line.rests(self.itinerary);
        let stop = match self.itinerary.waits(at) {
            Ok(stop) => stop,
            Err(failure) => {
                self.failed = Some(failure);
                None
            }
        };
        match stop.as_ref().and_then(|stop| Some((stop, stop.reading?.0))) {
            Some((stop, Reading::Probe { .. })) => {
                let Some(probing) = Probing::of(stop) else { return Ok(Next::Stretch) };
                match probing.check(self.board)? {
                    Ok(()) => self.probe = Some(probing),
                    Err(why) => {
                        // It is a mistake of the input as long as nothing has moved.
                        let refused = if self.has_moved { Failure::Run } else { Failure::input };
                        return Ok(self.fail(refused(why)));
                    }
                }
                Ok(Next::Stretch)
            }
            Some((stop, reading @ Reading::Input { input, until, seconds })) => {
                // Others are refused before anything is sent.
                let Input::Digital(input) = input else { return Ok(Next::Stretch) };
                let (wanted, place) = ((input, until, seconds), at.to_string());
                match read_input(self.board, self.control, &place, wanted)? {
                    InputRead::Value(Some(value)) if value == reading.assumed() => {
                        Ok(Next::Stretch)
                    }
                    InputRead::Value(value) => Ok(self.plan_again(stop.at, Found::Input(value))),
                    InputRead::Ends => Ok(self.end()),
                }
            }
            None => self.wait(at, stop.map(|stop| stop.offsets)),
        }
    }

    /// Waits until somebody lets the program go on.
    fn wait(&mut self, at: Wait, offsets: Option<Offsets>) -> Result<Next, ConnectedBoardError> {
        self.plan.program.iter_mut().for_each(|program| program.waits += 1);
        if let Some(offsets) = offsets.clone().filter(|_| self.itinerary.keeps()) {
            self.memory.set_work(offsets);
            if let Err(error) = self.memory.drives(self.board) {
                // If this write fails, too, there is no channel left to report it.
                let why = memory::not_kept(&error).message();
                self.line.above(|| drop(writeln!(io::stderr(), "warning: {why}")));
            }
        }
        let places = (self.axes, &*self.zero);
        let mut pause = Pause::new(self.itinerary, (self.memory, self.ways), places, offsets);
        let keys = (&mut self.keys, &self.line);
        match wait::wait(self.board, self.control, keys, (at, &mut pause))? {
            Waited::GoesOn(None) => Ok(Next::Stretch),
            Waited::GoesOn(Some(rest)) => Ok(self.go_on(rest)),
            Waited::Ends => Ok(self.end()),
        }
    }

    /// Sends the stretch, and holds, cuts and stops as the user wants.
    fn stream(&mut self) -> Result<Ended, ConnectedBoardError> {
        let Self { board, control, line, ways, start, .. } = self;
        let (itinerary, ends) = (self.itinerary, self.ends);
        // A probe moves at the feed of the program.
        let scales = !ends && self.probe.is_none();
        let changed = |control: &mut Control| {
            let wanted = control.program().map(|program| program.overrides());
            wanted.filter(|wanted| scales && *wanted != itinerary.overrides())
        };
        if let Some(wanted) = changed(control) {
            itinerary.set_overrides(wanted, None);
        }
        if let Some(probe) = &self.probe {
            probe.arm(board)?;
        }
        let mut source = itinerary.source();
        let (mut next_try, mut next_change) = (Instant::now(), Instant::now());
        let mut cuts = 0;
        let streamed = board.stream(&mut *source, |progress: &Progress<'_>| {
            line.show(progress.status, itinerary);
            ways.see(progress.status);
            cuts = progress.queues.map_or(0, |queues| queues.cuts);
            control.reached(block(itinerary, start, progress.status));
            match control.wish(progress.status) {
                // The axes rest while the outputs go off.
                Wish::Stop if !ends => return Wish::Stop,
                _ => {}
            }
            if let Some(wanted) = changed(control).filter(|_| Instant::now() >= next_change) {
                next_change = Instant::now() + TRY_AGAIN;
                if let Some(keep) = itinerary.set_overrides(wanted, progress.queues) {
                    return Wish::Cut { keep };
                }
            }
            let holds = control.program().is_some_and(|program| program.holds());
            if ends || !holds || itinerary.is_held() || Instant::now() < next_try {
                return Wish::GoOn;
            }
            // A later row may begin a hold where the limits forbid one now.
            next_try = Instant::now() + TRY_AGAIN;
            itinerary.hold(progress.queues).map_or(Wish::GoOn, |keep| Wish::Cut { keep })
        })?;
        drop(source);
        self.plan.program.iter_mut().for_each(|program| program.cuts += cuts);
        Ok(streamed)
    }

    /// A probe move is over: it has tripped, or has reached its target, or a hold has ended it early.
    fn probed(&mut self, probing: Probing, file: &ProgramFile) -> Result<(), ConnectedBoardError> {
        let hit = self.board.end_seek()?;
        if hit.is_none() && self.itinerary.is_held() {
            // The rest of the move follows behind the hold.
            return Ok(());
        }
        self.probe = None;
        self.line.rests(self.itinerary);
        let probed = match hit {
            Some(states) => {
                let places = (file, &*self.zero);
                Ok(probing.tripped(self.board, &self.line, places, &states)?)
            }
            None => probing.untripped(),
        };
        match probed {
            Ok((at, found)) => self.plan_again(at, found),
            Err(why) => self.fail(Failure::Run(why)),
        };
        Ok(())
    }

    /// Plans the rest of a program from what was found.
    fn plan_again(&mut self, at: Point, found: Found) -> Next {
        let Self { control, board, .. } = self;
        let status = *board.status();
        let mut wish = || {
            let ends = control.program().is_some_and(|program| program.ends());
            if ends { Wish::Stop } else { control.wish(&status) }
        };
        match self.itinerary.resume(at, None, found, &mut wish) {
            Ok(rest) => self.go_on(rest),
            Err(why) => self.fail(Failure::Run(format!("the machine rests: {}", why.message()))),
        }
    }

    /// The rest was planned again, from where the board is.
    fn go_on(&mut self, rest: Rest) -> Next {
        let gone = self.board.status().positions.into_iter().zip(self.start.positions);
        let gone = gone.map(|(now, from)| i64::from(now.wrapping_sub(from)));
        self.plan.steps = gone.zip(rest.steps).map(|(gone, left)| gone + left).collect();
        self.plan.seconds = self.line.plans(rest.seconds);
        Next::Other
    }

    /// The program cannot go on.
    fn fail(&mut self, why: Failure) -> Next {
        self.failed = Some(why);
        self.end()
    }

    /// The program ends here: the outputs go off in a stretch of their own.
    fn end(&mut self) -> Next {
        self.itinerary.end();
        self.ends = true;
        Next::Other
    }
}

/// The block in which the tool is, as long as nothing has stopped it.
fn block(itinerary: &dyn Itinerary, start: &Status, status: &Status) -> Option<BlockAt> {
    let moved = start.positions.iter().zip(&status.positions);
    let moved: Vec<i32> = moved.map(|(before, now)| now.wrapping_sub(*before)).collect();
    Some(&moved).filter(|_| !status.answer.fault).and_then(|moved| itinerary.block(moved))
}
