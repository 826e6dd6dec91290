//! One shaper from request to request.
//!
//! It is *calm* where nothing is owed and DIR is as the speed wants it: then nothing happens on the pins
//! until the next request but STEP's fall, and timers are times at which they run out. Anything else goes
//! clock by clock through [`shaper::clock`] until it is calm again.

use super::edges::{Change, Edge, Record};
use crate::parts::shaper::{self, Input};
use carrystep_core::PinTiming;

/// A clock in which the shaper would latch an overrun.
pub(super) struct Overrun(pub u64);

/// A shaper on its way through a window.
pub(super) struct Pins<'a> {
    axis: u8,
    pins: PinTiming,
    edges: &'a mut Vec<Record>,
    sign: i8,
    calm: bool,
    /// As it is in clock `at`; while calm only DIR, position and what does not change are up to date.
    state: shaper::State,
    at: u64,
    /// The clocks from which each timer is 0.
    busy: u64,
    hold: u64,
    setup: u64,
}

impl<'a> Pins<'a> {
    /// A shaper as it is in clock `at`, with the sign of the speed that it sees.
    pub fn new(axis: u8, pins: PinTiming, state: shaper::State, sign: i8, at: u64, edges: &'a mut Vec<Record>) -> Self {
        let after = |timer: u32| at + u64::from(timer);
        let (busy, hold, setup) = (after(state.busy), after(state.hold), after(state.setup));
        let agrees = sign == 0 || (sign < 0) == state.want;
        let calm = agrees && state.owed.is_none() && state.dir == state.want;
        Self { axis, pins, edges, sign, calm, state, at, busy, hold, setup }
    }

    /// Steps are asked for in these clocks, which ascend.
    #[inline]
    pub fn requests(&mut self, clocks: &[u64], backward: bool) -> Result<(), Overrun> {
        let period = u64::from(self.pins.width + self.pins.gap);
        let (Some(first), Some(last)) = (clocks.first(), clocks.last()) else { return Ok(()) };
        let ready = self.calm && backward == self.state.dir && *first >= self.busy.max(self.setup);
        if !ready || clocks.windows(2).fold(false, |close, pair| close | (pair[1] - pair[0] < period)) {
            return clocks.iter().try_for_each(|at| self.request(*at, backward));
        }
        let axis = self.axis;
        let record = |at| Edge { clock: at + 1, axis, change: Change::Rise, backward }.record();
        self.edges.extend(clocks.iter().map(|&at| record(at)));
        self.made(*last, clocks.len() as i32, backward);
        Ok(())
    }

    /// A step is asked for.
    fn request(&mut self, at: u64, backward: bool) -> Result<(), Overrun> {
        if !self.calm || backward != self.state.dir || at < self.busy.max(self.setup) {
            return self.hard_request(at, backward);
        }
        self.edges.push(Edge { clock: at + 1, axis: self.axis, change: Change::Rise, backward }.record());
        self.made(at, 1, backward);
        Ok(())
    }

    /// So many steps were made as they were asked for, the last of them in clock `at`.
    fn made(&mut self, at: u64, steps: i32, backward: bool) {
        self.busy = at + u64::from(self.pins.width + self.pins.gap);
        self.hold = at + u64::from(self.pins.hold);
        self.state.step = true;
        self.state.position = self.state.position.wrapping_add(if backward { -steps } else { steps });
    }

    /// From clock `at` on the speed has this sign.
    pub fn sign(&mut self, at: u64, sign: i8) -> Result<(), Overrun> {
        self.reach(at)?;
        self.sign = sign;
        if self.calm && sign != 0 && (sign < 0) != self.state.want {
            self.wake(at);
        }
        Ok(())
    }

    /// The shaper as it is in clock `at`.
    pub fn finish(mut self, at: u64) -> Result<shaper::State, Overrun> {
        self.reach(at)?;
        if self.calm {
            self.wake(at);
        }
        Ok(self.state)
    }

    #[cold]
    fn hard_request(&mut self, at: u64, backward: bool) -> Result<(), Overrun> {
        self.reach(at)?;
        if self.calm {
            self.wake(at);
        }
        self.clock(Some(backward))
    }

    /// Comes to clock `at`, or to where the shaper is calm.
    fn reach(&mut self, at: u64) -> Result<(), Overrun> {
        while !self.calm && self.at < at {
            self.clock(None)?;
        }
        Ok(())
    }

    /// From times back to registers.
    fn wake(&mut self, at: u64) {
        // A timer is at most 17 bits wide.
        let timer = |end: u64| end.saturating_sub(at) as u32;
        let busy = timer(self.busy);
        let step = self.state.step && busy >= self.pins.gap;
        self.state = shaper::State { step, busy, hold: timer(self.hold), setup: timer(self.setup), ..self.state };
        self.at = at;
        self.calm = false;
    }

    /// One clock as it is written in the contract.
    fn clock(&mut self, request: Option<bool>) -> Result<(), Overrun> {
        let before = self.state;
        let next = shaper::clock(before, Input { request, sign: self.sign, frozen: false }, self.pins);
        if next.overrun {
            return Err(Overrun(self.at));
        }
        self.at += 1;
        let edge = |change, backward| Edge { clock: self.at, axis: self.axis, change, backward }.record();
        if next.position != before.position {
            self.edges.push(edge(Change::Rise, before.dir));
        }
        if next.dir != before.dir {
            self.edges.push(edge(Change::Turn, next.dir));
        }
        let after = |timer: u32| self.at + u64::from(timer);
        (self.busy, self.hold, self.setup) = (after(next.busy), after(next.hold), after(next.setup));
        self.calm = next.owed.is_none() && next.dir == next.want;
        self.state = next;
        Ok(())
    }
}
