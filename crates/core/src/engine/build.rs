//! The build parameters of an engine: its axes, their pins, and the settings of its guard. The
//! guard is the part of the engine that watches limits, e-stop, watchdog and faults, and stops the
//! axes.

use super::{
    Adders, EngineError, Latch, MAX_AXES, MAX_DEBOUNCE_SAMPLES, MAX_PWM_DIVIDER, MAX_ROUND,
    MAX_ROUNDS, Outputs, QUEUE_DEPTHS, TIME_SLOT_CLOCKS, adder_counts, check_pins,
    check_schedule_of_adders, time_slots,
};
use crate::build::{Build, PinTiming, Timebase};
use crate::fixed::StartPhase;
use alloc::vec;
use alloc::vec::Vec;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// All parameters of an engine.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct EngineBuild {
    /// Clock, tick and phases.
    pub timebase: Timebase,
    /// Phase of a step in which moves start.
    pub phase: StartPhase,
    /// Pin timing of each axis, in clocks; one entry per axis.
    pub pins: Vec<PinTiming>,
    /// Settings of the guard.
    pub guard: Guard,
    /// The outputs that change with the motion.
    pub outputs: Outputs,
    /// Number of segments that the queue of an axis holds besides the one that runs, one of
    /// [`QUEUE_DEPTHS`].
    pub queue: usize,
    /// Whether a host can cut queues.
    pub cuts: bool,
    /// Number of adders, one of [`adder_counts`]. Axis i is computed by the adder i % adders.
    pub adders: usize,
}

/// Settings of the guard: what it watches, and how it stops the axes.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Guard {
    /// Length of a round in ticks: the time between two samples of a limit, and the unit of the
    /// times below. A power of two from 2 to [`MAX_ROUND`].
    pub round: u32,
    /// Number of consecutive samples with the same level after which a limit's level is accepted, 1
    /// to [`MAX_DEBOUNCE_SAMPLES`].
    pub debounce: u32,
    /// Time without a valid request after which the watchdog stops all axes, in rounds, up to
    /// [`MAX_ROUNDS`]; 0 turns the watchdog off.
    pub watchdog: u32,
    /// Time from power at ENABLE to the first start, in rounds, up to [`MAX_ROUNDS`]; 0 for no
    /// delay.
    pub enable: u32,
    /// Wiring of the limit switches.
    pub limits: LimitWiring,
    /// Whether a limit freezes the axes at once; otherwise they ramp down.
    pub limit_freezes: bool,
    /// Whether the e-stop counts as pressed while its pin is low (otherwise: while it is high).
    pub estop_low: bool,
    /// Whether a limit counts as reached while its pin is low (otherwise: while it is high).
    pub limits_low: bool,
    /// The inputs of the rows 2 and 3: probe, interlock and general inputs.
    pub inputs: [InputRow; 2],
    /// The latches, at most [`super::MAX_LATCHES`]; latch k is entry k.
    pub latches: Vec<Latch>,
    /// Stop acceleration of each axis, 2^-64 step per tick^2, 1 to 2^62.
    pub stop: Vec<u64>,
}

/// The inputs of a row that a build has. Bit i is input i of the row; it is below the number of
/// axes. Input 0 of the first row is the probe, input 0 of the second row is the interlock.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct InputRow {
    /// The inputs that exist.
    pub exist: u8,
    /// Those of them that are active while their pin is low.
    pub low: u8,
}

/// Wiring of the limit switches.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, JsonSchema, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum LimitWiring {
    /// There are no limit switches.
    None,
    /// Two for each axis. Each stops motion toward its own end only.
    #[default]
    Pair,
    /// One input for each axis, shared by both ends.
    Each,
    /// One input for all axes.
    One,
}

impl Guard {
    /// The smallest guard: no watchdog, no ENABLE delay and no limits. Ramps use the accelerations
    /// of `stop`.
    pub fn minimal(stop: Vec<u64>) -> Self {
        Self {
            round: 64,
            debounce: 1,
            watchdog: 0,
            enable: 0,
            limits: LimitWiring::None,
            limit_freezes: false,
            estop_low: false,
            limits_low: false,
            inputs: [InputRow::default(); 2],
            latches: Vec::new(),
            stop,
        }
    }

    /// This guard with the active level of every switch and latch: low, or else high.
    #[must_use]
    pub fn active_low(self, low: bool) -> Self {
        let row = |InputRow { exist, .. }| InputRow { exist, low: if low { exist } else { 0 } };
        Self {
            estop_low: low,
            limits_low: low,
            inputs: self.inputs.map(row),
            latches: self.latches.into_iter().map(|latch| Latch { low, ..latch }).collect(),
            ..self
        }
    }

    /// True if the build has the interlock: input 0 of row 3.
    pub const fn has_interlock(&self) -> bool {
        self.inputs[1].exist & 1 == 1
    }
}

impl EngineBuild {
    /// An engine with these parameters, the smallest guard and the shortest queues, without outputs
    /// and cuts; every axis ramps down with `stop`, 2^-64 step per tick^2.
    pub fn minimal(build: &Build, stop: u64) -> Self {
        let Build { timebase, phase, pins } = build;
        let guard = Guard::minimal(vec![stop; pins.len()]);
        let outputs = Outputs::default();
        let queue = QUEUE_DEPTHS[0];
        Self {
            timebase: *timebase,
            phase: *phase,
            pins: pins.to_vec(),
            guard,
            outputs,
            queue,
            cuts: false,
            adders: 1,
        }
    }

    /// Number of slots of an axis in memory: those of its queue, and that of the running segment.
    pub const fn slots(&self) -> usize {
        self.queue + 1
    }

    /// Number of axes.
    pub fn axes(&self) -> usize {
        self.pins.len()
    }

    /// The number of time slots of a tick.
    pub fn time_slots(&self) -> usize {
        time_slots(self.axes(), self.adders)
    }

    /// The first clock of a tick that belongs to the time slot of an axis.
    pub const fn first_clock_of(&self, axis: usize) -> u32 {
        (axis / self.adders) as u32 * TIME_SLOT_CLOCKS
    }

    /// Checks that every parameter is in its range.
    ///
    /// # Errors
    /// [`EngineError`] names the first parameter that is not, and its range.
    pub fn check(&self) -> Result<(), EngineError> {
        let (axes, guard) = (self.axes(), &self.guard);
        if !(1..=MAX_AXES).contains(&axes) {
            return Err(EngineError::Axes(axes));
        }
        if !adder_counts(axes).any(|adders| adders == self.adders) {
            return Err(EngineError::Adders(Adders { adders: self.adders, axes }));
        }
        check_schedule_of_adders(axes, self.adders, &self.timebase)?;
        check_pins(&self.pins)?;
        if !(2..=MAX_ROUND).contains(&guard.round) || !guard.round.is_power_of_two() {
            return Err(EngineError::Round(guard.round));
        }
        for (name, rounds) in [("watchdog", guard.watchdog), ("enable", guard.enable)] {
            if rounds > MAX_ROUNDS {
                return Err(EngineError::Rounds { name, rounds });
            }
        }
        if !(1..=MAX_DEBOUNCE_SAMPLES).contains(&guard.debounce) {
            return Err(EngineError::Debounce(guard.debounce));
        }
        for (index, InputRow { exist, low }) in guard.inputs.into_iter().enumerate() {
            if u32::from(exist) >> axes != 0 || low & !exist != 0 {
                return Err(EngineError::Inputs { row: index as u8 + 2, exist, low, axes });
            }
            if exist != 0 && guard.round < 4 {
                return Err(EngineError::RoundOfInputs(guard.round));
            }
        }
        self.check_latches()?;
        if self.adders > 1 && self.has_several_latches() {
            return Err(EngineError::LatchesOfAdders(self.adders));
        }
        if self.outputs.pwm_divider > MAX_PWM_DIVIDER {
            return Err(EngineError::PwmDivider(self.outputs.pwm_divider));
        }
        if !QUEUE_DEPTHS.contains(&self.queue) {
            return Err(EngineError::Queue(self.queue));
        }
        if guard.stop.len() != axes {
            return Err(EngineError::StopCount { axes, found: guard.stop.len() });
        }
        match guard.stop.iter().position(|units| !(1..=1 << 62).contains(units)) {
            Some(axis) => Err(EngineError::StopAcceleration { axis, units: guard.stop[axis] }),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::build::AXES;
    use alloc::string::String;
    use alloc::string::ToString as _;

    fn refusal(change: impl FnOnce(&mut EngineBuild)) -> String {
        let timebase = Timebase::new(48_000_000, 2000, 16).unwrap();
        let build = Build { timebase, phase: StartPhase::Half, pins: [PinTiming::SHORTEST; AXES] };
        let mut build = EngineBuild::minimal(&build, 1);
        build.check().unwrap();
        change(&mut build);
        build.check().unwrap_err().to_string()
    }

    #[test]
    fn error_names_the_parameter_out_of_range() {
        let nine = |build: &mut EngineBuild| build.pins = vec![PinTiming::SHORTEST; 9];
        assert_eq!(refusal(nine), "9 axes: an engine has 1 to 8");
        assert!(refusal(|build| build.pins.clear()).starts_with("0 axes"));
        let said = refusal(|build| build.pins[3].step_low = 0);
        assert_eq!(said, "axis 3: step_low is 0 clocks: from 1 to 65536 can be counted");
        assert!(
            refusal(|build| build.pins[5].dir_hold = 65_537)
                .starts_with("axis 5: dir_hold is 65537 clocks")
        );
        assert!(refusal(|build| build.guard.round = 3).starts_with("a round of 3 ticks"));
        assert!(
            refusal(|build| build.guard.watchdog = 5000).starts_with("watchdog of 5000 rounds")
        );
        assert!(refusal(|build| build.guard.enable = 5000).starts_with("enable of 5000 rounds"));
        assert!(refusal(|build| build.guard.debounce = 0).starts_with("a debounce of 0 samples"));
        let row = |exist, low| InputRow { exist, low };
        let said = refusal(|build| build.guard.inputs[1] = row(0x41, 0));
        assert_eq!(said, "inputs 0x41 of row 3, 0x0 of them active low: 6 axes have room for 0x3f");
        let said = refusal(|build| build.guard.inputs[0] = row(1, 3));
        assert!(said.starts_with("inputs 0x1 of row 2, 0x3 of them active low"), "{said}");
        let said = refusal(|build| {
            build.guard.inputs[0] = row(1, 1);
            build.guard.round = 2;
        });
        assert!(said.starts_with("a round of 2 ticks: inputs need a round of 4"), "{said}");
        let said = refusal(|build| build.outputs.pwm_divider = 257);
        assert!(said.starts_with("a PWM of 257 clocks"), "{said}");
        let said = refusal(|build| build.queue = 8);
        assert_eq!(said, "a queue of 8 segments: 7, 15 and 31 can be built");
        assert!(
            refusal(|build| build.guard.stop[3] = 0).starts_with("the stop acceleration of axis 3")
        );
        assert!(
            refusal(|build| build.guard.stop.push(1))
                .starts_with("7 stop accelerations for 6 axes")
        );
    }

    #[test]
    fn eight_axes_need_a_tick_of_106_clocks() {
        let seven = |build: &mut EngineBuild| {
            build.pins = vec![PinTiming::SHORTEST; 8];
            build.guard.stop = vec![1; 8];
            build.timebase = Timebase::new(48_000_000, 2000, 16).unwrap();
        };
        let said = refusal(seven);
        assert!(
            said.starts_with("8 axes need 13 clocks each and two to close the tick, 106 in all"),
            "{said}"
        );
    }
}
