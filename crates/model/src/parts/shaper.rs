//! The step shaper of one axis. It keeps the promised times on the pins STEP and DIR: `step_high`,
//! `step_low`, `dir_setup` and `dir_hold`, all in clocks. [`clock`] must stay equal to the
//! section "shaper" of docs/clock-by-clock.md.
//!
//! ```text
//! DIR  ____/^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^\_______
//!          :DIR_SETUP:<-DIR_HOLD>:             :
//! STEP ______________/^^^^^^\________/^^^^^^\__________
//!           STEP_HIGH:<---->:<------>:STEP_LOW
//! ```
//!
//! While the timers run, one step is held back (`held_back`). A second step in that time is an
//! overrun. Every step is accounted for; in every clock: rising edges + held-back steps + discarded
//! steps == requests.

use carrystep_core::PinTiming;

/// The registers of one shaper.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ShaperState {
    /// Level of the STEP pin.
    pub step: bool,
    /// Level of the DIR pin; true is backward.
    pub dir: bool,
    /// Direction of the last speed that was not zero; true is backward.
    pub want: bool,
    /// The direction of the step that is held back until the timers allow it, if there is one.
    pub held_back: Option<bool>,
    /// Clocks until the next rising edge of STEP is allowed.
    pub busy: u32,
    /// Clocks until DIR may change.
    pub hold: u32,
    /// Clocks until STEP may rise after a change of DIR.
    pub setup: u32,
    /// Rising edges forward minus rising edges backward, in steps, wrapping.
    pub position: i32,
    /// Steps that never reached the pin, because of an overrun or a freeze; wrapping.
    pub discarded: u32,
    /// Latched: a second step arrived while one was held back.
    pub overrun: bool,
}

/// The inputs of a shaper in one clock.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ShaperInput {
    /// The direction of the step that is due in this clock, if there is one; true is backward.
    pub request: Option<bool>,
    /// Sign of the speed (-1, 0 or 1). DIR follows it; 0 keeps the direction.
    pub sign: i8,
    /// True while the core is frozen: neither pin begins a new edge, and steps are discarded.
    pub frozen: bool,
}

impl ShaperState {
    /// The state at configuration. The set-up timer runs, so that the direction set-up is kept from
    /// the first clock on.
    pub const fn at_configuration(pins: PinTiming) -> Self {
        Self {
            step: false,
            dir: false,
            want: false,
            held_back: None,
            busy: 0,
            hold: 0,
            setup: pins.dir_setup - 1,
            position: 0,
            discarded: 0,
            overrun: false,
        }
    }
}

impl ShaperState {
    /// True if no clock changes the state while no step is requested and the speed keeps its sign.
    pub(crate) const fn is_still(&self, frozen: bool) -> bool {
        let timers = self.busy == 0 && self.hold == 0 && self.setup == 0;
        timers && !self.step && self.held_back.is_none() && (frozen || self.dir == self.want)
    }
}

/// Executes one clock and returns the next state. The pins are registers of the state.
#[inline]
pub fn clock(state: ShaperState, input: ShaperInput, pins: PinTiming) -> ShaperState {
    let ShaperInput { request, sign, frozen } = input;
    let want = if sign == 0 { state.want } else { sign < 0 };
    let first = state.held_back.or(request);
    let rise = !frozen && first == Some(state.dir) && state.busy == 0 && state.setup == 0;
    let dir_changes = !frozen && state.hold == 0 && state.dir != first.unwrap_or(want);
    let lost = match (frozen, state.held_back, request) {
        (true, held_back, request) => u32::from(held_back.is_some()) + u32::from(request.is_some()),
        (false, Some(_), Some(_)) => u32::from(!rise),
        _ => 0,
    };
    ShaperState {
        step: rise || (state.step && state.busy != pins.step_low),
        dir: state.dir != dir_changes,
        want,
        held_back: match (frozen, rise) {
            (true, _) => None,
            (false, true) => state.held_back.and(request),
            (false, false) => first,
        },
        busy: if rise { pins.step_high + pins.step_low - 1 } else { state.busy.saturating_sub(1) },
        hold: if rise { pins.dir_hold - 1 } else { state.hold.saturating_sub(1) },
        setup: if dir_changes { pins.dir_setup - 1 } else { state.setup.saturating_sub(1) },
        position: if rise {
            state.position.wrapping_add(if state.dir { -1 } else { 1 })
        } else {
            state.position
        },
        discarded: state.discarded.wrapping_add(lost),
        overrun: state.overrun || (!frozen && lost > 0),
    }
}
