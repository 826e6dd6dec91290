//! The engine's guard: it watches e-stop, host and ENABLE, and defines how each cause stops the
//! axes (docs/clock-by-clock.md, "The guard's inputs" and "Stops").

use carrystep_core::engine::{Cause, EngineInputs, Guard};

/// State of e-stop input, watchdog and ENABLE.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Supervisor {
    /// Synchronizer of the e-stop input: two flip-flops, `first` and `now`.
    first: bool,
    now: bool,
    /// True if the e-stop has been active in every clock since the last strobe.
    held: bool,
    /// Ticks since the beginning of the round.
    pub(super) tick_of_round: u32,
    /// Rounds since the last kick of the host, saturating at the watchdog's time-out.
    silence: u32,
    /// Level of the ENABLE output: the drivers are to be powered.
    pub(super) enabled: bool,
    /// Rounds since ENABLE was asserted, saturating at the warm-up time.
    warm: u32,
}

impl Supervisor {
    pub(super) const fn new() -> Self {
        Self {
            first: false,
            now: false,
            held: false,
            tick_of_round: 0,
            silence: 0,
            enabled: false,
            warm: 0,
        }
    }

    /// At a strobe: true if the e-stop was active during the whole tick.
    pub(super) const fn pressed(&self) -> bool {
        self.held && self.now
    }

    /// True if the host has not kicked the watchdog for the time-out.
    pub(super) const fn misses_the_host(&self, guard: &Guard) -> bool {
        guard.watchdog > 0 && self.silence == guard.watchdog
    }

    /// True if the drivers have been powered for the warm-up time.
    pub(super) const fn is_warm(&self, guard: &Guard) -> bool {
        self.enabled && self.warm == guard.enable
    }

    /// Restarts the time-out of the watchdog and the warm-up of the drivers.
    pub(super) const fn forget(&mut self) {
        self.silence = 0;
        self.warm = 0;
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

/// Access for the fast model, which passes many clocks at once.
impl Supervisor {
    /// True if these inputs and this `idle` change nothing but the counters of rounds.
    pub(super) fn is_steady(
        &self,
        guard: &Guard,
        inputs: &EngineInputs,
        idle: bool,
        stop: &Stop,
    ) -> bool {
        let estop = inputs.estop != guard.estop_low;
        let seen = [self.first, self.now, self.held].iter().all(|&seen| seen == estop);
        seen && (!estop || (stop.frozen && stop.fault.is_some()))
            && (!inputs.kick || self.silence == 0)
            && self.enabled == (inputs.enable || (self.enabled && !idle))
            && (self.enabled || self.warm == 0)
    }

    /// Strobes before the strobe at which the watchdog expires.
    pub(super) fn strobes_to_silence(&self, guard: &Guard) -> u64 {
        if guard.watchdog == 0 {
            u64::MAX
        } else {
            self.strobes_to(guard, guard.watchdog - self.silence)
        }
    }

    /// Strobes before the first strobe at which the warm-up time is over.
    pub(super) fn strobes_to_warmth(&self, guard: &Guard) -> u64 {
        self.strobes_to(guard, guard.enable - self.warm)
    }

    /// Strobes before the first strobe that finds a counter saturated which is `rounds` rounds
    /// below its maximum.
    fn strobes_to(&self, guard: &Guard, rounds: u32) -> u64 {
        u64::from(rounds) * u64::from(guard.round)
            - if rounds == 0 { 0 } else { u64::from(self.tick_of_round) }
    }

    /// Strobes before the first strobe in this tick of a round.
    pub(super) const fn strobes_to_sample(&self, guard: &Guard, tick_of_round: u32) -> u64 {
        ((tick_of_round + guard.round - self.tick_of_round) % guard.round) as u64
    }

    /// Advances the counters by this many strobes.
    pub(super) fn pass(&mut self, guard: &Guard, kick: bool, strobes: u64) {
        let ticks = u64::from(self.tick_of_round) + strobes;
        let (rounds, round) = (ticks / u64::from(guard.round), u64::from(guard.round));
        let counted = |count: u32, top: u32| (u64::from(count) + rounds).min(top.into()) as u32;
        self.tick_of_round = (ticks % round) as u32;
        self.silence = if kick { 0 } else { counted(self.silence, guard.watchdog) };
        self.warm = if self.enabled { counted(self.warm, guard.enable) } else { 0 };
    }
}

/// The state of a stop.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Stop {
    /// The first cause and its axes (one bit each), latched until the host clears the stop.
    pub(super) fault: Option<(Cause, u8)>,
    /// New edges are suppressed at once.
    pub(super) frozen: bool,
    /// All axes are slowed down at their stop acceleration.
    pub(super) ramp: bool,
    /// No axis moves any more.
    pub(super) halted: bool,
    /// `halted` has been true for a whole tick.
    pub(super) settled: bool,
    /// The next strobe clears the stop.
    pub(super) clearing: bool,
}

impl Stop {
    /// Calls a stop. The first cause is latched; every freezing cause freezes the axes.
    pub(super) fn call(&mut self, cause: Cause, culprits: u8, guard: &Guard) {
        self.fault = self.fault.or(Some((cause, culprits)));
        self.frozen |= cause.freezes(guard.limit_freezes);
    }
}
