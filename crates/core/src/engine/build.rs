//! The build parameters of an engine: axes, pins, and what its guard watches.

use super::{EngineError, MAX_AXES, MAX_LOOKS, MAX_ROUND, MAX_ROUNDS, check_pins, check_schedule};
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
    /// Where in a step moves start.
    pub phase: StartPhase,
    /// Pin timing of each axis: as many as there are axes.
    pub pins: Vec<PinTiming>,
    /// What stops the axes.
    pub guard: Guard,
}

/// What the guard watches, and how it stops the axes.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Guard {
    /// Ticks from one look at a limit to the next, and the unit of the times below; a power of two.
    pub round: u32,
    /// Looks until a limit is believed.
    pub debounce: u32,
    /// Rounds of silence until the host is missed; 0: it is not.
    pub watchdog: u32,
    /// Rounds from ENABLE to the first start; 0: none.
    pub enable: u32,
    /// How the limit switches are wired.
    pub limits: Limits,
    /// A limit freezes; otherwise it ramps down.
    pub limit_freezes: bool,
    /// The e-stop is pressed where its pin is low.
    pub estop_low: bool,
    /// A limit is reached where its pin is low.
    pub limits_low: bool,
    /// Stop acceleration of each axis, 2^-64 step per tick^2.
    pub stop: Vec<u64>,
}

/// How the limit switches are wired.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, JsonSchema, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Limits {
    /// There are none.
    None,
    /// Two for each axis: each stops the way that it ends.
    #[default]
    Pair,
    /// One for each axis, for both ends.
    Each,
    /// One for all axes.
    One,
}

impl Guard {
    /// A guard that watches only what the engine itself can do wrong; ramps of `stop`.
    pub fn minimal(stop: Vec<u64>) -> Self {
        Self {
            round: 64,
            debounce: 1,
            watchdog: 0,
            enable: 0,
            limits: Limits::None,
            limit_freezes: false,
            estop_low: false,
            limits_low: false,
            stop,
        }
    }
}

impl EngineBuild {
    /// The engine of these parameters with the least guard.
    pub fn minimal(build: &Build, stop: u64) -> Self {
        let Build { timebase, phase, pins } = build;
        let guard = Guard::minimal(vec![stop; pins.len()]);
        Self { timebase: *timebase, phase: *phase, pins: pins.to_vec(), guard }
    }

    /// How many axes.
    pub fn axes(&self) -> usize {
        self.pins.len()
    }

    /// Whether there can be such an engine.
    ///
    /// # Errors
    /// [`EngineError`] names the parameter.
    pub fn check(&self) -> Result<(), EngineError> {
        let (axes, guard) = (self.axes(), &self.guard);
        if !(1..=MAX_AXES).contains(&axes) {
            return Err(EngineError::Axes(axes));
        }
        check_schedule(axes, &self.timebase)?;
        check_pins(&self.pins)?;
        if !(2..=MAX_ROUND).contains(&guard.round) || !guard.round.is_power_of_two() {
            return Err(EngineError::Round(guard.round));
        }
        for (name, rounds) in [("watchdog", guard.watchdog), ("enable", guard.enable)] {
            if rounds > MAX_ROUNDS {
                return Err(EngineError::Rounds { name, rounds });
            }
        }
        if !(1..=MAX_LOOKS).contains(&guard.debounce) {
            return Err(EngineError::Debounce(guard.debounce));
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
    fn a_parameter_that_cannot_be_is_named() {
        let nine = |build: &mut EngineBuild| build.pins = vec![PinTiming::SHORTEST; 9];
        assert_eq!(refusal(nine), "9 axes: an engine has 1 to 8");
        assert!(refusal(|build| build.pins.clear()).starts_with("0 axes"));
        let said = refusal(|build| build.pins[3].gap = 0);
        assert_eq!(said, "axis 3: gap is 0 clocks: from 1 to 65536 can be counted");
        assert!(refusal(|build| build.pins[5].hold = 65_537).starts_with("axis 5: hold is 65537 clocks"));
        assert!(refusal(|build| build.guard.round = 3).starts_with("a round of 3 ticks"));
        assert!(refusal(|build| build.guard.watchdog = 5000).starts_with("watchdog of 5000 rounds"));
        assert!(refusal(|build| build.guard.enable = 5000).starts_with("enable of 5000 rounds"));
        assert!(refusal(|build| build.guard.debounce = 0).starts_with("a debounce of 0 looks"));
        assert!(refusal(|build| build.guard.stop[3] = 0).starts_with("the stop acceleration of axis 3"));
        assert!(refusal(|build| build.guard.stop.push(1)).starts_with("7 stop accelerations for 6 axes"));
    }

    #[test]
    fn eight_axes_fit_where_their_turns_do() {
        let seven = |build: &mut EngineBuild| {
            build.pins = vec![PinTiming::SHORTEST; 8];
            build.guard.stop = vec![1; 8];
            build.timebase = Timebase::new(48_000_000, 2000, 16).unwrap();
        };
        let said = refusal(seven);
        assert!(said.starts_with("8 axes need 13 clocks each and one to close the tick, 105 in all"), "{said}");
    }
}
