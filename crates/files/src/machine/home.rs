//! `travel`, `home` and `home_order`: the homing parameters of each axis, converted to the integers
//! of the engine.
//!
//! Speeds and accelerations are rounded down to 2^-64 step per tick (and tick^2), distances to the
//! nearest step.

use super::{Axis, gantry, stop};
use crate::decimal;
use crate::error::{InputError, SourceText};
use crate::number::{exact, positive};
use bigdecimal::{BigDecimal, ToPrimitive};
use carrystep_core::build::Timebase;
use carrystep_core::engine::{Guard, LimitWiring};
use serde::{Deserialize, Serialize};
use std::ops::Range;
use toml::Spanned;

mod order;
mod overrun;
mod travel;

pub(super) use order::RawOrder;
pub use overrun::overrun;
use overrun::{accepted, per_tick, register, steps_up};

/// Greatest distance or machine coordinate, steps: the range of a position register.
const MOST_STEPS: i64 = i32::MAX as i64;

/// Greatest length of a search, ticks. A segment holds up to 2^32 - 1 ticks.
const MOST_TICKS: u128 = (u32::MAX / 4) as u128;

/// An end of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum End {
    /// The low end, whose switch is `limit_min`; the axis moves toward it in the negative
    /// direction.
    Min,
    /// The high end, whose switch is `limit_max`; the axis moves toward it in the positive
    /// direction.
    Max,
}

/// Homing parameters of an axis. Every distance is 1 step or more.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Home {
    /// The end whose switch the axis searches.
    pub toward: End,
    /// Speed at which the axis starts, 2^-64 step per tick.
    pub start: u64,
    /// Acceleration, 2^-64 step per tick^2, 1 or more.
    pub accel: u64,
    /// Speed of the search, 2^-64 step per tick; 1 or more.
    pub seek: u64,
    /// Speed of the approach that sets the position, 2^-64 step per tick; 1 or more.
    pub slow: u64,
    /// Distance by which the axis moves away from the switch before a search, steps.
    pub move_off: u32,
    /// Greatest distance of the search, steps.
    pub max_travel: u32,
    /// Distance from the switch at which the axis rests at the end, steps.
    pub pull_off: u32,
    /// Machine coordinate of the place where the switch closes, steps.
    pub position: i64,
    /// How far a motor may move further than the others of its letter in homing, steps.
    pub most_apart: u32,
}

impl Home {
    /// Machine coordinate at which the axis rests after homing, steps.
    pub fn rests(&self) -> i64 {
        match self.toward {
            End::Min => self.position + i64::from(self.pull_off),
            End::Max => self.position - i64::from(self.pull_off),
        }
    }
}

/// The `home = { ... }` table as it is written.
#[derive(Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "a table, as in home = { toward = \"min\", seek_speed = 20 }"
)]
pub(super) struct RawHome {
    toward: End,
    seek_speed: Spanned<f64>,
    slow_speed: Spanned<f64>,
    move_off: Option<Spanned<f64>>,
    max_travel: Option<Spanned<f64>>,
    pull_off: Spanned<f64>,
    position: Spanned<f64>,
    most_apart: Option<Spanned<f64>>,
}

/// The entries of an axis' table that depend on the guard.
pub(super) struct RawPlace {
    pub(super) travel: Option<Spanned<Vec<Spanned<f64>>>>,
    pub(super) home: Option<Spanned<RawHome>>,
}

/// Sets travel and homing of each axis, and returns the homing order as numbers of axes.
pub(super) fn check(
    source: &SourceText,
    timebase: &Timebase,
    guard: &Guard,
    axes: &mut [Axis],
    places: Vec<RawPlace>,
    order: Option<RawOrder>,
) -> Result<Vec<Vec<usize>>, InputError> {
    let span = |place: &RawPlace| place.travel.as_ref().map(Spanned::span);
    let spans: Vec<_> = places.iter().map(span).collect();
    for (axis, RawPlace { travel, .. }) in axes.iter_mut().zip(&places) {
        axis.travel = travel.as_ref().map(|travel| travel::of(source, axis, travel)).transpose()?;
    }
    gantry::share_travel(source, axes, &spans)?;
    let span = |place: &RawPlace| {
        let home = place.home.as_ref()?;
        Some((home.span(), home.as_ref().most_apart.as_ref().map(Spanned::span)))
    };
    let homes: Vec<_> = places.iter().map(span).collect();
    for (axis, RawPlace { home, .. }) in axes.iter_mut().zip(places) {
        let Some(home) = home else { continue };
        if guard.limits == LimitWiring::None {
            let message = format!(
                "axis '{}' has no limit switch to home with: [machine.guard] limits is \"none\"",
                axis.name
            );
            return Err(InputError::at(source, home.span(), message)
                .help("limits = \"pair\", \"each\" or \"one\" says how the switches are wired"));
        }
        let span = home.span();
        let checked = Checked { source, timebase, guard, axis: &*axis, span };
        axis.home = Some(checked.home(&home.into_inner())?);
    }
    gantry::home(source, axes, &homes, guard.limits)?;
    match order {
        Some(order) => order::of(source, axes, order),
        None => Ok(order::usual(axes)),
    }
}

/// A home table while it is checked, with everything that the checks depend on.
struct Checked<'a> {
    source: &'a SourceText,
    timebase: &'a Timebase,
    guard: &'a Guard,
    axis: &'a Axis,
    span: Range<usize>,
}

impl Checked<'_> {
    fn home(&self, raw: &RawHome) -> Result<Home, InputError> {
        let accel = stop::at_the_limit(&self.axis.accel_limit);
        let start = register(self.axis.start_speed.units);
        let seek =
            self.speed(&raw.seek_speed, "seek_speed", &self.axis.speed_limit.steps, "speed_limit")?;
        let limit =
            positive(self.source, &raw.seek_speed, "seek_speed")? * &self.axis.steps_per_unit;
        let slow = self.speed(&raw.slow_speed, "slow_speed", &limit, "seek_speed")?;
        self.is_sampled_often_enough(raw, slow)?;
        let move_off = match &raw.move_off {
            Some(value) => self.distance(value, "move_off")?,
            None => self.usual_move_off()?,
        };
        self.moves_off(raw, seek, move_off)?;
        let pull_off = self.distance(&raw.pull_off, "pull_off")?;
        let least = steps_up(accepted(slow, self.guard)) + 1;
        if u64::from(pull_off) < least {
            let far = self.axis.unit.both(f64::from(pull_off), 0);
            let message = format!("pull_off is {far}: the axis would rest on its switch");
            return Err(self.at(&raw.pull_off, message).help(self.at_least(least)));
        }
        let max_travel = match (&raw.max_travel, self.axis.travel) {
            (Some(value), _) => self.distance(value, "max_travel")?,
            (None, Some([low, high])) => {
                let most = (high - low).saturating_add(2 * i64::from(move_off)).min(MOST_STEPS);
                most.to_u32().unwrap_or(u32::MAX)
            }
            (None, None) => return Err(self.missing("max_travel")),
        };
        if max_travel <= move_off {
            let span = raw.max_travel.as_ref().map_or_else(|| self.span.clone(), Spanned::span);
            let [far, off] =
                [max_travel, move_off].map(|steps| self.axis.unit.both(f64::from(steps), 0));
            let message = format!("max_travel is {far}: not over move_off, which is {off}");
            return Err(InputError::at(self.source, span, message)
                .help("the search first goes back over what the axis has moved off"));
        }
        for (value, speed, steps) in
            [(&raw.seek_speed, seek, max_travel), (&raw.slow_speed, slow, move_off * 2)]
        {
            self.ends(value, u128::from(steps) << 64, speed, accel)?;
        }
        let position = self.position(raw, pull_off)?;
        Ok(Home {
            toward: raw.toward,
            start,
            accel,
            seek,
            slow,
            move_off,
            max_travel,
            pull_off,
            position,
            most_apart: match &raw.most_apart {
                Some(value) => self.distance(value, "most_apart")?,
                None => move_off,
            },
        })
    }

    /// Makes an error at a number of the table.
    fn at(&self, value: &Spanned<f64>, message: impl Into<String>) -> InputError {
        InputError::at(self.source, value.span(), message)
    }

    fn at_least(&self, steps: u64) -> String {
        format!("at least {} are needed", self.axis.unit.both(steps as f64, 0))
    }

    /// Converts a speed of the file to 2^-64 step per tick. It must not exceed `most`, in steps/s,
    /// which the message calls `of`.
    fn speed(
        &self,
        value: &Spanned<f64>,
        key: &str,
        most: &BigDecimal,
        of: &str,
    ) -> Result<u64, InputError> {
        let steps = positive(self.source, value, key)? * &self.axis.steps_per_unit;
        if steps > *most {
            let most = self.axis.unit.at_most(decimal::to_f64(most), 1);
            return Err(self
                .at(value, format!("{key} is over {of}"))
                .help(format!("at most {most}")));
        }
        let speed = per_tick(&steps, self.timebase);
        if speed == 0 {
            return Err(self.at(value, format!("{key} is under 2^-64 step per tick")));
        }
        Ok(speed)
    }

    /// Converts a distance of the file to steps.
    fn distance(&self, value: &Spanned<f64>, key: &str) -> Result<u32, InputError> {
        let steps = positive(self.source, value, key)? * &self.axis.steps_per_unit;
        let steps = decimal::round_half_away(&steps).unwrap_or(i64::MAX);
        if steps > MOST_STEPS {
            return Err(self.at(value, format!("{key} is over {MOST_STEPS} steps")));
        }
        u32::try_from(steps)
            .ok()
            .filter(|&steps| steps > 0)
            .ok_or_else(|| self.at(value, format!("{key} is less than half a step")))
    }

    fn missing(&self, key: &str) -> InputError {
        InputError::at(
            self.source,
            self.span.clone(),
            format!("the home table of axis '{}' has no {key}", self.axis.name),
        )
        .help(format!(
            "give {key}, or travel = [LOW, HIGH] in the axis' table, from which it follows"
        ))
    }

    /// Default of `move_off`, steps: the distance by which a limit stop from full speed overruns
    /// the switch, plus a hundredth of the travel.
    fn usual_move_off(&self) -> Result<u32, InputError> {
        let Some([low, high]) = self.axis.travel else { return Err(self.missing("move_off")) };
        let full = overrun(register(self.axis.speed_limit.units), self.axis.stop, self.guard);
        let steps = full.saturating_add((high - low).unsigned_abs().div_ceil(100));
        match u32::try_from(steps) {
            Ok(steps) if i64::from(steps) <= (high - low) / 2 => Ok(steps),
            _ => {
                let far = self.axis.unit.both(steps as f64, 0);
                let message = format!(
                    "move_off would be {far}, from speed_limit and stop_accel: over half of the travel"
                );
                Err(InputError::at(self.source, self.span.clone(), message)
                    .help("give move_off in the home table"))
            }
        }
    }

    /// Checks `move_off`: when the switch has closed at the speed of the search, moving off must
    /// open it again.
    fn moves_off(&self, raw: &RawHome, seek: u64, move_off: u32) -> Result<(), InputError> {
        let least = overrun(seek, self.axis.stop, self.guard) + 1;
        if u64::from(move_off) >= least {
            return Ok(());
        }
        let span = raw.move_off.as_ref().map_or_else(|| self.span.clone(), Spanned::span);
        let message = format!(
            "move_off is {}: from seek_speed the axis runs {} over its switch until it rests",
            self.axis.unit.both(f64::from(move_off), 0),
            self.axis.unit.both((least - 1) as f64, 0)
        );
        let help = format!(
            "{}, and the travel of the switch; or a slower seek_speed",
            self.at_least(least)
        );
        Err(InputError::at(self.source, span, message).help(help))
    }

    /// Checks the speed of the approach. A limit is sampled once per round, and the axis must move
    /// at most one step between two samples; otherwise two homing runs could differ by more than
    /// one step.
    fn is_sampled_often_enough(&self, raw: &RawHome, slow: u64) -> Result<(), InputError> {
        let ticks = u128::from(self.guard.round) + 2;
        if u128::from(slow) * ticks <= 1 << 64 {
            return Ok(());
        }
        let seconds = ticks as f64 * self.timebase.tick_ns() as f64 * 1e-9;
        let most = self.axis.unit.at_most(1.0 / seconds, 1);
        let message = "slow_speed is over a step between two samples of the switch: two homes could differ by more than a step";
        Err(self.at(&raw.slow_speed, message).help(format!(
            "at most {most}; or a shorter watchdog_ms, enable_ms or debounce_us: the longest of them says how often \
             a limit is sampled"
        )))
    }

    /// Checks that a search at this speed ends within the ticks that a segment can count.
    fn ends(
        &self,
        value: &Spanned<f64>,
        units: u128,
        speed: u64,
        accel: u64,
    ) -> Result<(), InputError> {
        let ticks = units / u128::from(speed) + u128::from(speed / accel);
        if ticks <= MOST_TICKS {
            return Ok(());
        }
        let seconds = |ticks: u128| ticks as f64 * self.timebase.tick_ns() as f64 * 1e-9;
        let message = format!("at this speed the search takes up to {:.0} s", seconds(ticks));
        Err(self
            .at(value, message)
            .help(format!("at most {:.0} s can be counted", seconds(MOST_TICKS))))
    }

    /// Machine coordinate of the switch, steps. The switch and the place where the axis rests must
    /// lie within the travel.
    fn position(&self, raw: &RawHome, pull_off: u32) -> Result<i64, InputError> {
        let steps = exact(self.source, &raw.position, "position")? * &self.axis.steps_per_unit;
        let position =
            decimal::round_half_away(&steps).filter(|steps| steps.abs() <= MOST_STEPS).ok_or_else(
                || self.at(&raw.position, format!("position is over {MOST_STEPS} steps from zero")),
            )?;
        let Some([low, high]) = self.axis.travel else { return Ok(position) };
        if !(low..=high).contains(&position) {
            return Err(self.at(&raw.position, "position is outside of travel"));
        }
        let rests = match raw.toward {
            End::Min => position + i64::from(pull_off),
            End::Max => position - i64::from(pull_off),
        };
        if (low..=high).contains(&rests) {
            return Ok(position);
        }
        Err(self.at(&raw.pull_off, "pull_off ends outside of travel"))
    }
}
