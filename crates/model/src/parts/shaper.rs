//! The step shaper: what keeps the promises of width, gap, set-up and hold on the pins.
//!
//! ```text
//! DIR  ____/^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^\_______
//!          :<-- D -->:<--- H --->:             :
//! STEP ______________/^^^^^^\________/^^^^^^\__________
//!                    :<-W ->:<- S -->:
//! ```
//!
//! One step may be owed while the timers run; a second is an overrun. Nothing is dropped in silence:
//! rising edges + owed + discarded == requests, in every clock.

use carrystep_core::PinTiming;

/// The registers of one shaper.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct State {
    /// STEP pin.
    pub step: bool,
    /// DIR pin; true is backward.
    pub dir: bool,
    /// Direction of the last speed that was not zero.
    pub want: bool,
    /// A step waits for the timers; its direction.
    pub owed: Option<bool>,
    /// Clocks until the next rise is allowed.
    pub busy: u32,
    /// Clocks until DIR may turn.
    pub hold: u32,
    /// Clocks until a rise is allowed after a turn.
    pub setup: u32,
    /// Rising edges forward less rising edges back.
    pub position: i32,
    /// Steps that were not made.
    pub discarded: u32,
    /// A second step was owed.
    pub overrun: bool,
}

/// What a shaper is told in one clock.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Input {
    /// A step is due now; true is backward.
    pub request: Option<bool>,
    /// Sign of the speed: the direction that DIR is to have.
    pub sign: i8,
    /// No new edges.
    pub frozen: bool,
}

impl State {
    /// At configuration. The set-up timer runs, so that promise 3 holds from the first clock.
    pub const fn at_configuration(pins: PinTiming) -> Self {
        Self {
            step: false,
            dir: false,
            want: false,
            owed: None,
            busy: 0,
            hold: 0,
            setup: pins.setup - 1,
            position: 0,
            discarded: 0,
            overrun: false,
        }
    }
}

impl State {
    /// No clock changes anything while no step is due and the speed keeps its sign.
    pub(crate) const fn is_still(&self, frozen: bool) -> bool {
        let timers = self.busy == 0 && self.hold == 0 && self.setup == 0;
        timers && !self.step && self.owed.is_none() && (frozen || self.dir == self.want)
    }
}

/// One clock: `state, input -> state`. The pins are registers of the state.
#[inline]
pub fn clock(state: State, input: Input, pins: PinTiming) -> State {
    let Input { request, sign, frozen } = input;
    let want = if sign == 0 { state.want } else { sign < 0 };
    let first = state.owed.or(request);
    let rise = !frozen && first == Some(state.dir) && state.busy == 0 && state.setup == 0;
    let turn = !frozen && state.hold == 0 && state.dir != first.unwrap_or(want);
    let lost = match (frozen, state.owed, request) {
        (true, owed, request) => u32::from(owed.is_some()) + u32::from(request.is_some()),
        (false, Some(_), Some(_)) => u32::from(!rise),
        _ => 0,
    };
    State {
        step: rise || (state.step && state.busy != pins.gap),
        dir: state.dir != turn,
        want,
        owed: match (frozen, rise) {
            (true, _) => None,
            (false, true) => state.owed.and(request),
            (false, false) => first,
        },
        busy: if rise { pins.width + pins.gap - 1 } else { state.busy.saturating_sub(1) },
        hold: if rise { pins.hold - 1 } else { state.hold.saturating_sub(1) },
        setup: if turn { pins.setup - 1 } else { state.setup.saturating_sub(1) },
        position: if rise { state.position.wrapping_add(if state.dir { -1 } else { 1 }) } else { state.position },
        discarded: state.discarded.wrapping_add(lost),
        overrun: state.overrun || (!frozen && lost > 0),
    }
}
