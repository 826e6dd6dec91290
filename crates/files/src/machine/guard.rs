//! `[machine.guard]`: the settings of the engine's guard, converted from the units of the file to
//! rounds of ticks.
//!
//! Every time is rounded up. The round is also the interval at which limits are sampled, so the
//! shortest round is chosen in which all times can be counted.

use crate::error::{InputError, SourceText};
use crate::number::not_negative;
use bigdecimal::{BigDecimal, RoundingMode, ToPrimitive, Zero};
use carrystep_core::build::Timebase;
use carrystep_core::engine::{
    Guard, InputRow, Latch, LimitWiring, MAX_DEBOUNCE_SAMPLES, MAX_ROUND, MAX_ROUNDS, SWITCH_ROWS,
};
use serde::Deserialize;
use toml::Spanned;

/// The table as it is written.
#[derive(Deserialize, Default)]
#[serde(deny_unknown_fields, expecting = "a [machine.guard] table")]
pub(super) struct RawGuard {
    watchdog_ms: Option<Spanned<f64>>,
    enable_ms: Option<Spanned<f64>>,
    debounce_us: Option<Spanned<f64>>,
    #[serde(default)]
    estop: Active,
    #[serde(default)]
    limits: LimitWiring,
    #[serde(default)]
    limit_level: Active,
    #[serde(default)]
    limit_stop: LimitStop,
}

/// The level of a pin at which it is active.
#[derive(Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Active {
    #[default]
    High,
    Low,
}

/// How a limit stops the axes.
#[derive(Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
enum LimitStop {
    #[default]
    Ramp,
    Freeze,
}

/// A time of the guard: its key in the file, the ns of its unit, its default in that unit, and its
/// greatest count of rounds.
struct Key {
    name: &'static str,
    unit_ns: u64,
    default: u64,
    most: u32,
    /// Whether 0 turns the function off. Otherwise 0 is counted as at least one round.
    can_be_off: bool,
}

const WATCHDOG: Key = Key {
    name: "watchdog_ms",
    unit_ns: 1_000_000,
    default: 100,
    most: MAX_ROUNDS,
    can_be_off: true,
};
const ENABLE: Key =
    Key { name: "enable_ms", unit_ns: 1_000_000, default: 1, most: MAX_ROUNDS, can_be_off: true };
const DEBOUNCE: Key = Key {
    name: "debounce_us",
    unit_ns: 1000,
    default: 500,
    most: MAX_DEBOUNCE_SAMPLES,
    can_be_off: false,
};

impl RawGuard {
    /// The wiring of the limits.
    pub(super) const fn limits(&self) -> LimitWiring {
        self.limits
    }

    /// Checks the table. `inputs` and the latches are those of `[machine.inputs]`; `stop` holds the
    /// stop acceleration of each axis.
    pub(super) fn check(
        self,
        source: &SourceText,
        timebase: &Timebase,
        (inputs, latches): ([InputRow; 2], Vec<Latch>),
        stop: Vec<u64>,
    ) -> Result<Guard, InputError> {
        let time = |key: Key, given: &Option<Spanned<f64>>| {
            Time::new(source, timebase, key, given.as_ref())
        };
        let watchdog = time(WATCHDOG, &self.watchdog_ms)?;
        let enable = time(ENABLE, &self.enable_ms)?;
        let debounce = time(DEBOUNCE, &self.debounce_us)?;
        // Each row of switches is sampled in a tick of its own.
        let has_inputs = inputs.iter().any(|row| row.exist != 0);
        let least = if has_inputs { SWITCH_ROWS.into() } else { 2 };
        // The longest round fits every time, because `Time::new` has checked that.
        let fits =
            |round: &u32| [&watchdog, &enable, &debounce].iter().all(|time| time.fits(*round));
        let round = (1..)
            .map(|power| 1 << power)
            .take_while(|&round| round < MAX_ROUND)
            .filter(|&round| round >= least)
            .find(fits)
            .unwrap_or(MAX_ROUND);
        Ok(Guard {
            round,
            debounce: debounce.rounds(round),
            watchdog: watchdog.rounds(round),
            enable: enable.rounds(round),
            limits: self.limits,
            limit_freezes: self.limit_stop == LimitStop::Freeze,
            estop_low: self.estop == Active::Low,
            limits_low: self.limit_level == Active::Low,
            inputs,
            latches,
            stop,
        })
    }
}

/// A time that can be counted if the round is long enough.
struct Time {
    key: Key,
    ns: BigDecimal,
    tick_ns: u64,
}

impl Time {
    fn new(
        source: &SourceText,
        timebase: &Timebase,
        key: Key,
        given: Option<&Spanned<f64>>,
    ) -> Result<Self, InputError> {
        let unit = BigDecimal::from(key.unit_ns);
        let most =
            BigDecimal::from(u64::from(key.most - 1) * u64::from(MAX_ROUND) * timebase.tick_ns());
        let Some(given) = given else {
            let ns = (unit * BigDecimal::from(key.default)).min(most);
            return Ok(Self { key, ns, tick_ns: timebase.tick_ns() });
        };
        let value = not_negative(source, given, key.name)?;
        let ns = &value * &unit;
        if ns > most {
            let most = (most / unit).normalized();
            let says = format!(
                "{} = {value}: with ticks of {} ns at most {most}",
                key.name,
                timebase.tick_ns()
            );
            let off = if key.can_be_off { ", or 0 for none" } else { "" };
            return Err(InputError::at(source, given.span(), format!("{says} can be counted"))
                .help(format!("take a shorter time or a longer tick{off}")));
        }
        Ok(Self { key, ns, tick_ns: timebase.tick_ns() })
    }

    /// The number of rounds that last at least this time. One round is added, because the first one
    /// may be almost over when the time begins.
    fn rounds(&self, round: u32) -> u32 {
        if self.key.can_be_off && self.ns.is_zero() {
            return 0;
        }
        let round_ns = BigDecimal::from(u64::from(round) * self.tick_ns);
        let below = (&self.ns / &round_ns).with_scale_round(0, RoundingMode::Floor);
        let up = u32::from(&below * &round_ns < self.ns);
        below.to_u32().unwrap_or(u32::MAX).saturating_add(up).saturating_add(1)
    }

    fn fits(&self, round: u32) -> bool {
        self.rounds(round) <= self.key.most
    }
}
