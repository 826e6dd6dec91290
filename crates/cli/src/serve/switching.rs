//! Outputs that are switched while the machine rests: segments in which nothing moves bring the
//! change, and the time that a spindle needs.

use super::accessories::Due;
use super::requests::{Flush, Requests};
use super::server::Server;
use crate::failure::Failure;
use carrystep_core::{OutputChange, Segment};
use carrystep_grbl::{Door, State};
use carrystep_link::{HostError, SegmentSource, Wish};
use std::cell::Cell;

/// Length of a segment, s. A wait that is not wanted any more ends with the segments in the queues.
const SEGMENT: f64 = 0.01;

/// Segments of all axes in which nothing moves.
struct AtRest<'a> {
    ticks: u32,
    /// Segments of each axis at most, and the number that each has got.
    count: u32,
    given: Vec<u32>,
    /// The number of segments that there are, as soon as it is known.
    ends: Option<u32>,
    /// Whether the wait is to end.
    is_over: &'a Cell<bool>,
    change: OutputChange,
    start: Option<u8>,
}

impl SegmentSource for AtRest<'_> {
    fn segment(&mut self, axis: u8) -> Option<Segment> {
        let given = self.given.get_mut(usize::from(axis))?;
        if self.ends.is_some_and(|ends| *given == ends) {
            return None;
        }
        *given += 1;
        let furthest = self.given.iter().copied().max().unwrap_or_default();
        let given = self.given[usize::from(axis)];
        if self.ends.is_none() && given == furthest && (given == self.count || self.is_over.get()) {
            // No axis is further, so this is the last one of all.
            let others = self.given.iter().filter(|&&other| other == given).count();
            self.ends = (given == self.count || others == 1).then_some(given);
        }
        let last = self.ends == Some(given);
        Some(Segment { ticks: self.ticks, v: 0, a: 0, j: 0, last })
    }

    fn outputs(&mut self) -> OutputChange {
        std::mem::replace(&mut self.change, OutputChange::NONE)
    }

    fn start(&mut self) -> Option<u8> {
        self.start.take()
    }
}

impl Requests {
    /// What is to be switched at rest.
    fn due(&mut self) -> Option<Due> {
        // What is dropped, as behind a reset, starts nothing again.
        let is_locked = self.sleeps || self.alarm && !self.accessories.is_to_be_off();
        if is_locked || self.flush.is_some() {
            return None;
        }
        self.accessories.due(self.holds, self.door)
    }
}

impl Server<'_> {
    /// Switches what is wanted of spindle and coolant. The machine rests.
    pub fn switches(&mut self) -> Result<(), Failure> {
        while !self.board.status().answer.fault
            && let Some(due) = self.requests.due()
        {
            self.switch(due)?;
        }
        Ok(())
    }

    fn switch(&mut self, Due { change, dwell, door }: Due) -> Result<(), Failure> {
        if change.is_none() {
            return Ok(());
        }
        let (axes, tick) = (self.machine.axes.len(), self.machine.timebase.tick_seconds());
        let is_over = Cell::new(false);
        let mut source = AtRest {
            ticks: ((SEGMENT / tick).ceil() as u32).max(1),
            count: ((dwell / SEGMENT).ceil() as u32).max(1),
            given: vec![0; axes],
            ends: None,
            is_over: &is_over,
            change,
            start: Some(((1_u16 << axes) - 1) as u8),
        };
        let state = if door { State::Door(Door::Restores) } else { State::Hold { rests: true } };
        self.requests.restores = (dwell > 0.0).then_some(state);
        let Self { board, control, requests, failed, .. } = self;
        let ended = board.stream(&mut source, |progress| {
            if let Err(error) = requests.poll(progress.status, control) {
                failed.get_or_insert(Failure::Run(format!("the pseudo-terminal is gone: {error}")));
                return Wish::Stop;
            }
            is_over.set(requests.holds || requests.flush.is_some());
            let stops = control.wish(progress.status) == Wish::Stop || requests.stops;
            if stops { Wish::Stop } else { Wish::GoOn }
        });
        self.requests.restores = None;
        match ended {
            // Whoever has stopped the axes is noticed with the next look.
            Ok(_) => self.requests.accessories.sent(change),
            Err(HostError::Fault { .. }) => {
                self.fault()?;
                self.requests.flush.get_or_insert(Flush::Gone);
            }
            Err(error) => return Err(self.lost(&error)),
        }
        Ok(())
    }
}
