//! A board that senders drive: what is done at rest, and when a batch of lines begins.

use super::requests::{Flush, Requests, Todo};
use crate::connection::{self, ConnectedBoard, ConnectedBoardError};
use crate::control::Control;
use crate::failure::Failure;
use crate::memory::{self, BoardMemory};
use crate::{found, interrupt};
use carrystep_core::engine::Cause;
use carrystep_files::Machine;
use carrystep_grbl::{Alarm, Dialect, ErrorCode, Pins, message};
use carrystep_link::registers::INPUTS;
use carrystep_link::{Ended, HostError, Wish};
use carrystep_program::RowOutputs;
use std::time::{Duration, Instant};

/// Time between two looks at the inputs.
const INPUTS_PERIOD: Duration = Duration::from_millis(50);

/// What a machine waits for that rests in a hold, or at M0, M1 or M6.
const WAITS: &str = "hold, M0, M1 or M6 of the sender";

/// Bits of the register INPUTS behind the limits of both ends: the probe, and the interlock.
const PROBE: u32 = 16;
const INTERLOCK: u32 = 24;

/// Time between two looks at rest.
pub const REST: Duration = Duration::from_millis(1);

/// How a batch, or the wait in it, goes on.
#[derive(Debug, PartialEq, Eq)]
pub enum Next {
    /// With what comes.
    GoesOn,
    /// The command ends: somebody has stopped it.
    Stopped,
}

/// A board that senders drive.
pub struct Server<'a> {
    pub board: &'a mut ConnectedBoard,
    pub control: &'a mut Control,
    pub memory: &'a mut BoardMemory,
    pub machine: &'a Machine,
    pub axes: &'a [String],
    pub requests: Requests,
    /// The outputs where the next batch begins.
    pub outputs: RowOutputs,
    /// Why the command cannot go on.
    pub failed: Option<Failure>,
    /// When the inputs were read last.
    pub inputs: Instant,
    /// The tolerance in place of that of G64, mm.
    pub tolerance: Option<f64>,
}

impl Server<'_> {
    /// Serves until a signal or `carrystep stop` ends it. All axes rest then.
    ///
    /// # Errors
    /// The line to the board is lost, or the pseudo-terminal.
    pub fn serve(&mut self) -> Result<(), Failure> {
        loop {
            if self.look()? == Next::Stopped || interrupt::is_asked() {
                return Ok(());
            }
            self.switches()?;
            self.reads_limits()?;
            let next = if self.board.status().answer.fault && !self.requests.alarm {
                self.fault()?
            } else if let Some(flush) = self.requests.flush {
                self.flushed(flush)?
            } else if self.requests.may_move() {
                self.batch()?
            } else if let Some(todo) = self.requests.todo.filter(|_| !self.requests.is_busy()) {
                self.does(todo)?;
                Next::GoesOn
            } else {
                std::thread::sleep(REST);
                Next::GoesOn
            };
            if next == Next::Stopped {
                return Ok(());
            }
        }
    }

    /// Looks at the board, which rests, and at the connections.
    pub fn look(&mut self) -> Result<Next, Failure> {
        let read = self.board.read_status();
        let status = read.map_err(|error| self.lost(&error))?;
        if self.inputs.elapsed() >= INPUTS_PERIOD {
            self.inputs = Instant::now();
            let read = self.board.register(INPUTS);
            let inputs = read.map_err(|error| self.lost(&error))?;
            self.requests.pins = self.pins(inputs);
            self.keeps_offsets();
        }
        let polled = self.requests.poll(&status, self.control);
        polled.map_err(|error| Failure::Run(format!("the pseudo-terminal is gone: {error}")))?;
        let holds = self.requests.holds;
        if let Some(program) = self.control.program().filter(|one| holds && !one.is_waiting()) {
            program.rests(WAITS.to_owned());
        }
        if self.control.wish(&status) == Wish::Stop {
            self.stopped()
        } else if self.requests.stops {
            self.stopped_by_page()
        } else {
            Ok(Next::GoesOn)
        }
    }

    fn pins(&self, inputs: u32) -> Pins {
        let [low, high, ..] = inputs.to_le_bytes();
        let closed = |number: usize| (low | high) >> number & 1;
        let letters = self.requests.lines.letters().of_axes().iter().enumerate();
        let limits = letters.fold(0, |mask, (number, letter)| mask | closed(number) << letter);
        let estop = self.board.status().answer;
        Pins {
            limits,
            probe: inputs >> PROBE & 1 == 1,
            door: inputs >> INTERLOCK & 1 == 1,
            reset: estop.fault && Cause::from_number(estop.cause) == Some(Cause::EStop),
        }
    }

    /// All that was planned is dropped; the axes rest with P at its start value.
    pub fn flushed(&mut self, flush: Flush) -> Result<Next, Failure> {
        self.requests.rests_at(&self.board.status().positions);
        self.requests.flush = None;
        if flush == Flush::Reset {
            self.requests.restarts();
            self.control.restart_program();
        }
        Ok(Next::GoesOn)
    }

    /// The axes were ramped down on request.
    pub fn stopped(&mut self) -> Result<Next, Failure> {
        if let Some(failure) = self.failed.take() {
            return Err(failure);
        }
        if !self.board.status().answer.idle {
            self.board.stop().map_err(|error| self.lost(&error))?;
        }
        self.board.clear().map_err(|error| self.lost(&error))?;
        self.requests.rests_at(&self.board.status().positions);
        self.requests.alarms(Alarm::Abort, "stopped by `carrystep stop`");
        Ok(Next::Stopped)
    }

    /// Whether a page, and nobody else, has the axes ramped down.
    pub fn is_stopped_by_page(&self) -> bool {
        self.requests.stops && self.failed.is_none() && self.control.stopped_by().is_none()
    }

    /// A page has stopped the machine. The stop of the board remains in force, and with it the
    /// outputs are safe, until somebody unlocks the machine; the command goes on.
    pub fn stopped_by_page(&mut self) -> Result<Next, Failure> {
        self.requests.stops = false;
        if !self.board.status().answer.fault {
            self.board.stop().map_err(|error| self.lost(&error))?;
        }
        if !self.requests.alarm {
            self.requests.alarms(Alarm::Abort, "stopped on the web page");
        }
        // A batch that rests in a hold is dropped as soon as it looks.
        self.requests.flush.get_or_insert(Flush::Gone);
        Ok(Next::GoesOn)
    }

    /// The machine has stopped by itself.
    pub fn fault(&mut self) -> Result<Next, Failure> {
        let read = self.board.read_status();
        let status = read.map_err(|error| self.lost(&error))?;
        let answer = status.answer;
        let freezes = memory::freezes(answer.cause, self.machine.guard.limit_freezes);
        if freezes || self.machine.outputs.off_at_ramps {
            self.requests.accessories.safe();
        }
        if freezes {
            self.memory.forget_places();
        }
        let cause = found::cause(&answer);
        if cause == Some(Cause::Limit) {
            let own = (0..self.axes.len()).filter(|&axis| !self.machine.is_crossed(axis));
            for axis in own.filter(|axis| answer.culprits >> axis & 1 == 1) {
                self.memory
                    .set_limit(axis, self.requests.ways.get(axis).copied().filter(|way| *way != 0));
            }
            for (axis, way) in self.requests.belts.met(answer.culprits) {
                self.memory.set_limit(axis, Some(way));
            }
        }
        let names = found::names(self.axes, answer.culprits);
        let from = if names.is_empty() { String::new() } else { format!(" from {names}") };
        let name = cause.map_or("?", Cause::name);
        let alarm = if cause == Some(Cause::Limit) { Alarm::HardLimit } else { Alarm::Abort };
        self.requests.alarms(alarm, &format!("stopped by the machine: {name}{from}"));
        self.requests.rests_at(&status.positions);
        self.requests.flush = None;
        Ok(Next::GoesOn)
    }

    /// Does what needs a machine at rest.
    fn does(&mut self, todo: Todo) -> Result<(), Failure> {
        let answer = match todo {
            Todo::Home(axis) => self.home(axis)?,
            Todo::Probe(probe) => {
                self.requests.begins_probe(probe);
                String::new()
            }
            Todo::Unlock => self.unlock()?,
            Todo::Sleep => {
                self.board.disable().map_err(|error| self.lost(&error))?;
                self.memory.forget_places();
                self.requests.sleeps = true;
                message("Sleeping") + &Dialect::ok()
            }
            Todo::Wake => {
                let powered = self.board.enable();
                powered.map_err(|error| self.lost(&error))?;
                (self.requests.sleeps, self.requests.alarm) = (false, true);
                message("'$H'|'$X' to unlock")
            }
        };
        // Until here, no further line was taken.
        self.requests.todo = None;
        self.requests.clients.tell(&answer);
        Ok(())
    }

    /// Ends an alarm.
    fn unlock(&mut self) -> Result<String, Failure> {
        if self.board.status().answer.fault {
            match self.board.clear() {
                Ok(()) => {}
                Err(error @ (HostError::StillPressed | HostError::TooLong { .. })) => {
                    return Ok(message(&error.to_string()) + &Dialect::error(ErrorCode::NotIdle));
                }
                Err(error) => return Err(self.lost(&error)),
            }
        }
        self.requests.rests_at(&self.board.status().positions);
        self.requests.alarm = false;
        Ok(message("Caution: Unlocked") + &Dialect::ok())
    }

    /// The failure for an error of the board.
    pub fn lost(&mut self, error: &ConnectedBoardError) -> Failure {
        let failure = connection::lost(error, self.axes, self.board.facts());
        self.requests.alarms(Alarm::Abort, "the board is gone");
        failure
    }

    /// Powers the drivers.
    ///
    /// # Errors
    /// The line to the board is lost.
    pub fn powers(&mut self) -> Result<Ended, Failure> {
        let Self { board, control, .. } = self;
        let powered = board.enable_while(|progress| control.wish(progress.status));
        powered.map_err(|error| self.lost(&error))
    }
}
