//! What the engine's guard watches, and how a stop goes on: docs/clock-by-clock.md, "Stops".

use carrystep_core::engine::{Cause, EngineInputs, Guard};

/// E-stop, watchdog and ENABLE.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Watch {
    /// The e-stop's two flip-flops.
    first: bool,
    now: bool,
    held: bool,
    /// Ticks since the round began.
    pub(super) tick_of_round: u32,
    /// Rounds without the host.
    silence: u32,
    pub(super) enabled: bool,
    /// Rounds with ENABLE.
    warm: u32,
}

impl Watch {
    pub(super) const fn new() -> Self {
        Self { first: false, now: false, held: false, tick_of_round: 0, silence: 0, enabled: false, warm: 0 }
    }

    /// The e-stop was active for a whole tick, at a strobe.
    pub(super) const fn pressed(&self) -> bool {
        self.held && self.now
    }

    /// The host was silent for too long.
    pub(super) const fn misses_the_host(&self, guard: &Guard) -> bool {
        guard.watchdog > 0 && self.silence == guard.watchdog
    }

    /// The drivers have been powered for long enough.
    pub(super) const fn is_warm(&self, guard: &Guard) -> bool {
        self.enabled && self.warm == guard.enable
    }

    pub(super) fn clock(&mut self, guard: &Guard, inputs: &EngineInputs, strobe: bool, idle: bool) {
        let round_over = strobe && self.tick_of_round + 1 == guard.round;
        *self = Self {
            first: inputs.estop != guard.estop_low,
            now: self.first,
            held: if strobe { self.now } else { self.held && self.now },
            tick_of_round: (self.tick_of_round + u32::from(strobe)) % guard.round,
            silence: match inputs.kick {
                true => 0,
                false => (self.silence + u32::from(round_over)).min(guard.watchdog),
            },
            enabled: inputs.enable || (self.enabled && !idle),
            warm: match self.enabled {
                true => (self.warm + u32::from(round_over)).min(guard.enable),
                false => 0,
            },
        };
    }
}

/// What lets `fast` pass many clocks at once.
impl Watch {
    /// With these inputs, and this `idle`, nothing changes but what is counted in rounds.
    pub(super) fn is_steady(&self, guard: &Guard, inputs: &EngineInputs, idle: bool, stop: &Stop) -> bool {
        let estop = inputs.estop != guard.estop_low;
        let seen = [self.first, self.now, self.held].iter().all(|&seen| seen == estop);
        seen && (!estop || (stop.frozen && stop.fault.is_some()))
            && (!inputs.kick || self.silence == 0)
            && self.enabled == (inputs.enable || (self.enabled && !idle))
            && (self.enabled || self.warm == 0)
    }

    /// Strobes before the one at which the host is missed.
    pub(super) fn strobes_to_silence(&self, guard: &Guard) -> u64 {
        if guard.watchdog == 0 { u64::MAX } else { self.strobes_to(guard, guard.watchdog - self.silence) }
    }

    /// Strobes before the first at which the drivers are warm.
    pub(super) fn strobes_to_warmth(&self, guard: &Guard) -> u64 {
        self.strobes_to(guard, guard.enable - self.warm)
    }

    /// Strobes before the first that finds a counter at its top, which is so many rounds away.
    fn strobes_to(&self, guard: &Guard, rounds: u32) -> u64 {
        u64::from(rounds) * u64::from(guard.round) - if rounds == 0 { 0 } else { u64::from(self.tick_of_round) }
    }

    /// Strobes before the first in this tick of a round.
    pub(super) const fn strobes_to_look(&self, guard: &Guard, tick_of_round: u32) -> u64 {
        ((tick_of_round + guard.round - self.tick_of_round) % guard.round) as u64
    }

    /// So many strobes go by.
    pub(super) fn pass(&mut self, guard: &Guard, kick: bool, strobes: u64) {
        let ticks = u64::from(self.tick_of_round) + strobes;
        let (rounds, round) = (ticks / u64::from(guard.round), u64::from(guard.round));
        let counted = |count: u32, top: u32| (u64::from(count) + rounds).min(top.into()) as u32;
        self.tick_of_round = (ticks % round) as u32;
        self.silence = if kick { 0 } else { counted(self.silence, guard.watchdog) };
        self.warm = if self.enabled { counted(self.warm, guard.enable) } else { 0 };
    }
}

/// A stop under way.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Stop {
    /// The first cause, and the axes that it came from.
    pub(super) fault: Option<(Cause, u8)>,
    pub(super) frozen: bool,
    pub(super) ramp: bool,
    pub(super) halted: bool,
    pub(super) settled: bool,
    pub(super) clearing: bool,
}

impl Stop {
    /// A cause is called; the first one stays.
    pub(super) fn call(&mut self, cause: Cause, culprits: u8, guard: &Guard) {
        self.fault = self.fault.or(Some((cause, culprits)));
        self.frozen |= freezes(cause, guard);
    }
}

/// How a cause stops the axes.
pub(super) const fn freezes(cause: Cause, guard: &Guard) -> bool {
    match cause {
        Cause::EStop | Cause::Overrun | Cause::Protocol | Cause::Overspeed => true,
        Cause::Limit => guard.limit_freezes,
        Cause::Watchdog | Cause::Underrun | Cause::Stop => false,
    }
}
