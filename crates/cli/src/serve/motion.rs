//! A batch of lines on the board: stretches from rest to rest, with holds and overrides as in
//! `run`.

use super::probe::Probing;
use super::requests::{Flush, Positions, Requests};
use super::server::{Next, REST, Server};
use crate::connection::ConnectedBoardError;
use crate::control::Control;
use crate::drive::settle;
use crate::failure::Failure;
use crate::interrupt;
use carrystep_files::Machine;
use carrystep_grbl::Alarm;
use carrystep_job::{Hold, JobError, Pace};
use carrystep_link::{Ended, HostError, Progress, Wish};
use carrystep_program::{LineBreak, RowOutputs};
use carrystep_runner::{GrowingRows, OverrideSetting, Stretches};
use std::cell::RefCell;
use std::time::{Duration, Instant};

/// Time between two looks at the connections while the axes move.
const LOOK: Duration = Duration::from_micros(500);
/// Time between two looks at the line that is executed.
const LINE: Duration = Duration::from_millis(20);
/// Time between two tries of a hold that the limits forbid, and between two changes of overrides.
const TRY_AGAIN: Duration = Duration::from_millis(20);
type Way = RefCell<Stretches<GrowingRows>>;

impl Server<'_> {
    /// Executes the batch, of which the first rows are planned.
    pub fn batch(&mut self) -> Result<Next, Failure> {
        let way = self.way()?;
        while way.borrow_mut().begin().is_some() {
            self.requests.accessories.begins();
            let probing = self.requests.probing;
            if let Some(probe) = probing
                && !self.arms(probe)?
            {
                return Ok(Next::GoesOn);
            }
            let ended = self.stream(&way);
            let ended = self.disarms(probing, ended);
            // Each batch begins and ends at rest.
            self.outputs = way.borrow().row_outputs().at_rest();
            let left = way.borrow_mut().take_switch();
            self.requests.accessories.of_stretch(way.borrow().switched());
            self.requests.accessories.give_back(left);
            match ended {
                Ok(Probing::Tripped(states)) => return self.tripped(&states),
                Ok(Probing::Ended(Ended::Done | Ended::SeekEnded)) => {}
                Ok(Probing::Ended(Ended::Stopped)) if self.is_stopped_by_page() => {
                    return self.stopped_by_page();
                }
                Ok(Probing::Ended(Ended::Stopped)) => return self.stopped(),
                Err(HostError::Fault { .. }) => return self.fault(),
                Err(error) => return Err(self.lost(&error)),
            }
            if let Some(error) = self.failed.take() {
                return Err(error);
            }
            if self.rests()? == Next::Stopped {
                return Ok(Next::Stopped);
            }
            if let Some(flush) = self.requests.flush {
                self.settles()?;
                return self.flushed(flush);
            }
        }
        if let Some(flush) = self.requests.flush {
            return self.flushed(flush);
        }
        self.ends();
        Ok(Next::GoesOn)
    }

    /// The next line would move an axis toward a closed limit switch. Nothing has moved.
    fn refuses(&mut self, why: &str) {
        let probes = self.requests.probing.is_some();
        self.requests.alarms(Alarm::HardLimit, why);
        self.requests.rests_at(&self.board.status().positions);
        if probes {
            self.requests.clients.tell(&carrystep_grbl::Dialect::ok());
        }
    }

    fn way(&mut self) -> Result<Way, Failure> {
        let scales = self.requests.scales();
        let overrides = self.control.program().filter(|_| scales).map(|one| one.overrides());
        let positions = self.board.status().positions;
        let way = self.requests.way(self.machine, &positions, (&self.outputs, overrides));
        way.map_err(|error| Failure::input(error.to_string()))
    }

    /// Sends a stretch.
    fn stream(&mut self, way: &Way) -> Result<Ended, ConnectedBoardError> {
        let Self { board, control, requests, failed, .. } = self;
        let mut looks = Looks::new(Instant::now());
        board.stream(way, |progress| {
            let now = Instant::now();
            looks.look(now, (&mut *requests, &mut **control), way, progress, failed)
        })
    }

    /// Waits behind a stretch as long as a hold is in force. Returns at once if none is.
    fn rests(&mut self) -> Result<Next, Failure> {
        loop {
            self.switches()?;
            let holds = self.requests.holds || interrupt::is_asked();
            if self.requests.flush.is_some() || !holds {
                return Ok(Next::GoesOn);
            }
            if self.look()? == Next::Stopped || interrupt::is_asked() {
                self.settles()?;
                self.requests.rests_at(&self.board.status().positions);
                return Ok(Next::Stopped);
            }
            if self.board.status().answer.fault {
                self.fault()?;
                self.requests.flush.get_or_insert(Flush::Gone);
            }
            std::thread::sleep(REST);
        }
    }

    /// Brings P of all axes to its start value, where plans begin.
    fn settles(&mut self) -> Result<(), Failure> {
        if self.board.status().answer.fault {
            return Ok(());
        }
        settle(self.board, self.machine).map_err(|error| self.lost(&error))?;
        self.board.read_status().map(drop).map_err(|error| self.lost(&error))
    }

    /// The batch is executed to its end.
    fn ends(&mut self) {
        let Some(end) = self.requests.growing.take_end() else {
            self.requests.rests_at(&self.board.status().positions);
            return;
        };
        if let Some(why) = end.refused {
            self.refuses(&why);
            return;
        }
        self.requests.batch_ends(end.place);
        if let Some(error) = end.error {
            let why = error.to_string();
            self.requests.alarms(Alarm::SoftLimit, &why.replace(['\n', '[', ']'], " "));
            self.requests.rests_at(&self.board.status().positions);
            return;
        }
        match end.at {
            Some(LineBreak::Pause) => self.requests.holds = true,
            Some(LineBreak::End) => self.requests.clients.tell(&carrystep_grbl::message("Pgm End")),
            Some(LineBreak::Probe(probe)) => self.missed(probe),
            None => {}
        }
    }
}

impl Requests {
    /// The way of the batch from these positions on, with the outputs where it begins, and these
    /// overrides if any scale it.
    fn way(
        &self,
        machine: &Machine,
        positions: &Positions,
        (outputs, overrides): (&RowOutputs, Option<OverrideSetting>),
    ) -> Result<Way, JobError> {
        let steps = self.place.zero.iter().zip(positions);
        let start: Vec<i64> = steps.map(|(zero, &at)| zero + i64::from(at)).collect();
        let (hold, pace) = (Hold::new(machine)?, Pace::new(machine, &start)?);
        let way = Stretches::new(self.growing.rows(), &start, hold, pace, machine.queue);
        let way = way.with_outputs(outputs.clone());
        let mut way = way.for_holds(machine.cuts, machine.timebase.tick_ns());
        overrides.into_iter().for_each(|overrides| way.set_overrides(overrides));
        Ok(RefCell::new(way))
    }
}

/// When what was looked at last.
struct Looks {
    next: Instant,
    line: Instant,
    hold: Instant,
    overrides: Instant,
}

impl Looks {
    fn new(now: Instant) -> Self {
        Self { next: now, line: now, hold: now, overrides: now }
    }

    /// What is wanted of a stretch that runs, at this time.
    fn look(
        &mut self,
        now: Instant,
        (requests, control): (&mut Requests, &mut Control),
        way: &Way,
        progress: &Progress<'_>,
        failed: &mut Option<Failure>,
    ) -> Wish {
        if now < self.next {
            return Wish::GoOn;
        }
        self.next = now + LOOK;
        if let Err(error) = requests.poll(progress.status, control) {
            failed.get_or_insert(Failure::Run(format!("the pseudo-terminal is gone: {error}")));
            return Wish::Stop;
        }
        if control.wish(progress.status) == Wish::Stop || requests.stops {
            return Wish::Stop;
        }
        if now >= self.line {
            self.line = now + LINE;
            let zero = requests.place.zero.iter().zip(progress.status.positions);
            let places: Vec<i64> = zero.map(|(zero, at)| zero + i64::from(at)).collect();
            let block = way.borrow().block_at(&places);
            requests.line = block.map(|block| block.line);
            requests.accessories.of_stretch(way.borrow().switched());
            control.reached(block);
        }
        let wanted = control.program().map(|program| program.overrides());
        let wanted =
            wanted.filter(|wanted| requests.scales() && *wanted != way.borrow().overrides());
        if let Some(wanted) = wanted.filter(|_| now >= self.overrides) {
            self.overrides = now + TRY_AGAIN;
            let mut way = way.borrow_mut();
            match progress.queues {
                Some(queues) => {
                    if let Some(keep) = way.set_overrides_in(wanted, queues) {
                        return Wish::Cut { keep };
                    }
                }
                None => way.set_overrides(wanted),
            }
        }
        let coolant = requests.accessories.take_coolant();
        if !coolant.is_none() {
            let mut way = way.borrow_mut();
            let keep = match progress.queues {
                Some(queues) => way.switch_in(coolant, queues),
                None => {
                    way.switch(coolant);
                    None
                }
            };
            requests.accessories.of_stretch(way.switched());
            if let Some(keep) = keep {
                return Wish::Cut { keep };
            }
        }
        let holds = requests.holds || requests.flush.is_some() || interrupt::is_asked();
        if !holds || way.borrow().is_held() || now < self.hold {
            return Wish::GoOn;
        }
        // A later row may begin a hold where the limits forbid one now.
        self.hold = now + TRY_AGAIN;
        let mut way = way.borrow_mut();
        match progress.queues {
            Some(queues) => way.hold_in(queues).map_or(Wish::GoOn, |keep| Wish::Cut { keep }),
            None => {
                way.hold();
                Wish::GoOn
            }
        }
    }
}

#[cfg(test)]
mod first_changes;
