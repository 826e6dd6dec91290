//! Passes one step shaper from request to request.
//!
//! The shaper is *calm* if no step is held back and DIR has the direction of the speed. Until the
//! next request, nothing but the falling edge of STEP then happens on the pins, and the timers are
//! represented by the clocks at which they expire. In all other situations [`shaper::clock`] is
//! executed clock by clock until the shaper is calm again.

use super::edges::{Change, Edge, Record};
use crate::parts::shaper::{self, ShaperInput};
use carrystep_core::PinTiming;

/// The clock in which the shaper would latch an overrun.
pub(super) struct Overrun(pub u64);

/// A shaper that is being passed through a window.
pub(super) struct Pins<'a> {
    axis: u8,
    pins: PinTiming,
    edges: &'a mut Vec<Record>,
    sign: i8,
    calm: bool,
    /// The state in clock `at`. While calm, only DIR, the position and the constant fields are up
    /// to date.
    state: shaper::ShaperState,
    at: u64,
    /// The first clock in which each timer is 0.
    busy: u64,
    hold: u64,
    setup: u64,
}

impl<'a> Pins<'a> {
    /// The shaper in clock `at`, with the sign of the speed that it sees.
    pub fn new(
        axis: u8,
        pins: PinTiming,
        state: shaper::ShaperState,
        sign: i8,
        at: u64,
        edges: &'a mut Vec<Record>,
    ) -> Self {
        let after = |timer: u32| at + u64::from(timer);
        let (busy, hold, setup) = (after(state.busy), after(state.hold), after(state.setup));
        let agrees = sign == 0 || (sign < 0) == state.want;
        let calm = agrees && state.held_back.is_none() && state.dir == state.want;
        Self { axis, pins, edges, sign, calm, state, at, busy, hold, setup }
    }

    /// Requests steps in these clocks, which must ascend.
    #[inline]
    pub fn requests(&mut self, clocks: &[u64], backward: bool) -> Result<(), Overrun> {
        let period = u64::from(self.pins.step_high + self.pins.step_low);
        let (Some(first), Some(last)) = (clocks.first(), clocks.last()) else { return Ok(()) };
        let ready = self.calm && backward == self.state.dir && *first >= self.busy.max(self.setup);
        if !ready
            || clocks.windows(2).fold(false, |close, pair| close | (pair[1] - pair[0] < period))
        {
            return clocks.iter().try_for_each(|at| self.request(*at, backward));
        }
        let axis = self.axis;
        let record = |at| Edge { clock: at + 1, axis, change: Change::Rise, backward }.record();
        self.edges.extend(clocks.iter().map(|&at| record(at)));
        self.made(*last, clocks.len() as i32, backward);
        Ok(())
    }

    /// Requests one step.
    fn request(&mut self, at: u64, backward: bool) -> Result<(), Overrun> {
        if !self.calm || backward != self.state.dir || at < self.busy.max(self.setup) {
            return self.hard_request(at, backward);
        }
        self.edges
            .push(Edge { clock: at + 1, axis: self.axis, change: Change::Rise, backward }.record());
        self.made(at, 1, backward);
        Ok(())
    }

    /// Records that `steps` steps rose without delay, the last of them requested in clock `at`.
    fn made(&mut self, at: u64, steps: i32, backward: bool) {
        self.busy = at + u64::from(self.pins.step_high + self.pins.step_low);
        self.hold = at + u64::from(self.pins.dir_hold);
        self.state.step = true;
        self.state.position =
            self.state.position.wrapping_add(if backward { -steps } else { steps });
    }

    /// Sets the sign of the speed from clock `at` on.
    pub fn sign(&mut self, at: u64, sign: i8) -> Result<(), Overrun> {
        self.reach(at)?;
        self.sign = sign;
        if self.calm && sign != 0 && (sign < 0) != self.state.want {
            self.wake(at);
        }
        Ok(())
    }

    /// Returns the shaper in clock `at`.
    pub fn finish(mut self, at: u64) -> Result<shaper::ShaperState, Overrun> {
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

    /// Advances to clock `at`, or stops earlier if the shaper becomes calm.
    fn reach(&mut self, at: u64) -> Result<(), Overrun> {
        while !self.calm && self.at < at {
            self.clock(None)?;
        }
        Ok(())
    }

    /// Converts the expiry times of the timers back to registers.
    fn wake(&mut self, at: u64) {
        // A timer is at most 17 bits wide, so the value fits.
        let timer = |end: u64| end.saturating_sub(at) as u32;
        let busy = timer(self.busy);
        let step = self.state.step && busy >= self.pins.step_low;
        self.state = shaper::ShaperState {
            step,
            busy,
            hold: timer(self.hold),
            setup: timer(self.setup),
            ..self.state
        };
        self.at = at;
        self.calm = false;
    }

    /// Executes one clock of [`shaper::clock`].
    fn clock(&mut self, request: Option<bool>) -> Result<(), Overrun> {
        let before = self.state;
        let next = shaper::clock(
            before,
            ShaperInput { request, sign: self.sign, frozen: false },
            self.pins,
        );
        if next.overrun {
            return Err(Overrun(self.at));
        }
        self.at += 1;
        let edge =
            |change, backward| Edge { clock: self.at, axis: self.axis, change, backward }.record();
        if next.position != before.position {
            self.edges.push(edge(Change::Rise, before.dir));
        }
        if next.dir != before.dir {
            self.edges.push(edge(Change::DirChange, next.dir));
        }
        let after = |timer: u32| self.at + u64::from(timer);
        (self.busy, self.hold, self.setup) =
            (after(next.busy), after(next.hold), after(next.setup));
        self.calm = next.held_back.is_none() && next.dir == next.want;
        self.state = next;
        Ok(())
    }
}
