//! Times of a guard in seconds. The times of a machine file are rounded up to whole rounds of
//! ticks; these are the times that the gateware then keeps.

use super::{EngineBuild, LimitWiring};
use alloc::vec::Vec;
use schemars::JsonSchema;
use serde::Serialize;

/// A time that the guard keeps, as a range.
#[derive(Debug, Clone, Copy, PartialEq, JsonSchema, Serialize)]
pub struct Between {
    /// Shortest possible time.
    pub least: f64,
    /// Longest possible time.
    pub most: f64,
}

/// The settings of a guard, in the units of a machine file.
#[derive(Debug, Clone, PartialEq, JsonSchema, Serialize)]
pub struct GuardFigures {
    /// Time between two samples of a limit, us.
    pub round_us: f64,
    /// Time from the host's last valid request to the stop, ms; `None` if the watchdog is off.
    pub watchdog_ms: Option<Between>,
    /// Time from ENABLE to the first start, ms; `None` for no delay.
    pub enable_ms: Option<Between>,
    /// Time from the change of a limit's pin until it is accepted, us; `None` without limits.
    pub debounce_us: Option<Between>,
    /// Level of the e-stop pin at which the e-stop counts as pressed.
    pub estop: &'static str,
    /// Wiring of the limits.
    pub limits: LimitWiring,
    /// Level of a limit pin at which the limit counts as reached.
    pub limit_level: &'static str,
    /// How a limit stops the axes: `ramp` or `freeze`.
    pub limit_stop: &'static str,
    /// Acceleration of each axis' stop ramp, steps/s^2.
    pub stop_accel_steps_per_s2: Vec<f64>,
}

impl EngineBuild {
    /// The times and ramps of this build's guard, in the units of a machine file.
    pub fn guard_figures(&self) -> GuardFigures {
        let guard = &self.guard;
        let level = |low| if low { "low" } else { "high" };
        // Each argument is a whole number of ns well below 2^53, so that the conversion to a float
        // is exact.
        let ns = |ticks: u64| (ticks * self.timebase.tick_ns()) as f64;
        let round = u64::from(guard.round);
        // The first round may be almost over when a time begins, so up to one round is missing. The
        // result is committed one tick after the last round.
        let between = |rounds: u32, ns_of_unit: f64| {
            let rounds = u64::from(rounds);
            let (least, most) = (round * rounds.saturating_sub(1), round * rounds + 1);
            (rounds > 0)
                .then(|| Between { least: ns(least) / ns_of_unit, most: ns(most) / ns_of_unit })
        };
        GuardFigures {
            round_us: ns(round) / 1e3,
            watchdog_ms: between(guard.watchdog, 1e6),
            enable_ms: between(guard.enable, 1e6),
            debounce_us: between(guard.debounce, 1e3).filter(|_| guard.limits != LimitWiring::None),
            estop: level(guard.estop_low),
            limits: guard.limits,
            limit_level: level(guard.limits_low),
            limit_stop: if guard.limit_freezes { "freeze" } else { "ramp" },
            stop_accel_steps_per_s2: guard
                .stop
                .iter()
                .map(|&units| self.timebase.steps_per_s2(units))
                .collect(),
        }
    }
}
