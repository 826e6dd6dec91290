//! Jogs: short moves of one axis or several, which are planned as a move of a move file and stay
//! within `travel` where machine zero is known.

use crate::failure::Failure;
use crate::json;
use crate::work::{OffsetWish, Target};
use carrystep_files::unit::digits;
use carrystep_files::{Axis, Machine, MoveFile, SourceText, decimal};
use carrystep_gcode::AXIS_LETTERS;
use serde::{Deserialize, Serialize};

/// What a user wants to move.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct JogWish {
    /// Names of axes, and distances in their units.
    pub distances: Vec<(String, f64)>,
    /// Greatest speed along the line, units of the axes per minute; default: as fast as the axes
    /// allow.
    pub feed: Option<f64>,
    /// Duration in s; default: as short as the axes allow.
    pub time: Option<f64>,
    /// Move further toward a limit that was met.
    pub into_limit: bool,
}

impl JogWish {
    /// The move.
    ///
    /// # Errors
    /// There is no such axis, or no axis would move by a step.
    pub fn file(&self, machine: &Machine) -> Result<MoveFile, Failure> {
        let file = self.timed(machine, self.time)?;
        if let Some(failure) = self.nothing_to_do(&file) {
            return Err(failure);
        }
        let by_feed = self.feed.map(|feed| self.seconds_at(machine, feed));
        match by_feed.filter(|&by_feed| self.time.is_none() && by_feed > seconds(&file)) {
            Some(by_feed) => self.timed(machine, Some(by_feed)),
            None => Ok(file),
        }
    }

    /// The duration in s with which the speed along the line is at most the feed, units per minute.
    /// An axis that has this time accelerates at its limit, and goes at most at its part of the
    /// feed.
    fn seconds_at(&self, machine: &Machine, feed: f64) -> f64 {
        let length =
            self.distances.iter().map(|(_, distance)| distance.powi(2)).sum::<f64>().sqrt();
        let mut letters = vec![0.0; machine.axes.len()];
        for (name, distance) in &self.distances {
            let axis = machine.letter_index(name);
            axis.into_iter().for_each(|axis| letters[axis] += distance);
        }
        // Motors of crossed belts go further than the tool, and have the same steps per unit.
        let motors = machine.motor_steps(&letters);
        let seconds = |(axis, distance): (&Axis, &f64)| {
            let scale = decimal::to_f64(&axis.steps_per_unit);
            let accel = axis.accel_limit.float / scale;
            let distance = distance.abs();
            // A short move does not reach its part of the feed.
            let speed = (feed / 60.0 * distance / length).min((distance * accel).sqrt());
            (speed > 0.0).then(|| distance / speed + speed / accel)
        };
        machine.axes.iter().zip(&motors).filter_map(seconds).fold(0.0, f64::max)
    }

    fn timed(&self, machine: &Machine, time: Option<f64>) -> Result<MoveFile, Failure> {
        let mut to = Vec::new();
        for (axis, distance) in &self.distances {
            // Quoted as a TOML key, so that the name cannot contain TOML syntax.
            let axis = json::line(axis).map_err(|error| Failure::Run(error.to_string()))?;
            to.push(format!("{axis} = {distance:?}"));
        }
        let time = time.map_or_else(String::new, |seconds| format!("time = {seconds:?}\n"));
        let to = to.join(", ");
        let text = format!("[[move]]\nprofile = \"trapezoid\"\n{time}to = {{ {to} }}\n");
        let source = SourceText { path: "jog".into(), text: text.into() };
        Ok(MoveFile::of_moves(machine.clone(), source)?)
    }

    /// The failure for a jog of less than half a step, which states the size of a step.
    fn nothing_to_do(&self, file: &MoveFile) -> Option<Failure> {
        file.moves.first().filter(|only| only.steps.iter().all(|&steps| steps == 0))?;
        let (name, distance) = self.distances.first()?;
        let axis = &file.machine.axes[file.machine.letter_index(name)?];
        let part = (distance * decimal::to_f64(&axis.steps_per_unit)).abs();
        let step = 1.0 / decimal::to_f64(&axis.steps_per_unit);
        Some(Failure::input(format!(
            "jog {name} {distance} is {part:.3} step, which rounds to no step at all: nothing would \
             move. One step of {name} is {step} of its units"
        )))
    }
}

/// A word of `--set`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SetWord {
    /// What is set.
    Target(Target),
    /// A letter by its number, and its coordinate.
    Value(usize, f64),
}

impl std::str::FromStr for SetWord {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if let Ok(target) = text.parse() {
            return Ok(Self::Target(target));
        }
        let (name, value) = text.split_once('=').unwrap_or((text, "0"));
        let is = |letter: &char| name.eq_ignore_ascii_case(&letter.to_string());
        let value = value.parse::<f64>().ok().filter(|value| value.abs() <= 1e9);
        AXIS_LETTERS.iter().position(is).zip(value).map_or_else(
            || {
                Err("expected a system, G54 to G59.3, G92 or G43.1, then axes: --set G54 x=0,z=1.5"
                    .to_owned())
            },
            |(letter, value)| Ok(Self::Value(letter, value)),
        )
    }
}

/// What the words of `--set` say. If they name no axis, those of the jog get 0.
///
/// # Errors
/// The first word is no system, another one is, or no axis is named.
pub fn offset_of(words: &[SetWord], jogged: &[(String, f64)]) -> Result<OffsetWish, Failure> {
    let wrong = || Failure::input("--set needs one system, and then axes: `--set G54 x=0,z=1.5`");
    let Some((&SetWord::Target(target), values)) = words.split_first() else { return Err(wrong()) };
    let value = |word: &SetWord| match *word {
        SetWord::Value(letter, value) => Ok((letter, value)),
        SetWord::Target(_) => Err(wrong()),
    };
    let mut values = values.iter().map(value).collect::<Result<Vec<_>, _>>()?;
    if values.is_empty() {
        for (name, _) in jogged {
            let is = |letter: &char| name.eq_ignore_ascii_case(&letter.to_string());
            let letter = AXIS_LETTERS.iter().position(is).ok_or_else(|| {
                Failure::input(format!("'{name}' is no axis of a program: x, y, z, a, b or c"))
            })?;
            values.push((letter, 0.0));
        }
    }
    if values.is_empty() { Err(wrong()) } else { Ok(OffsetWish { target, values }) }
}

/// The time of a planned move, s; 0 if it cannot be planned, which is reported later.
fn seconds(file: &MoveFile) -> f64 {
    let planned = carrystep_plan::Survey::new(file.clone().into(), |_| Ok::<(), Failure>(()));
    planned
        .map_or(0.0, |survey| survey.totals().ticks as f64 * survey.build().timebase.tick_seconds())
}

/// Refuses a jog beyond `travel`, except one that leads back toward it. `places` are the machine
/// places of the axes' letters in steps, of those whose machine zero is known.
pub fn within_travel(file: &MoveFile, places: &[Option<f64>]) -> Result<(), Failure> {
    let machine = &file.machine;
    let motor =
        |number: usize| -> i64 { file.moves.iter().filter_map(|one| one.steps.get(number)).sum() };
    let motors: Vec<f64> = (0..machine.axes.len()).map(|number| motor(number) as f64).collect();
    for (number, axis) in machine.axes.iter().enumerate() {
        let Some((at, [low, high])) = places.get(number).copied().flatten().zip(axis.travel) else {
            continue;
        };
        let by = machine.letter_steps(number, &motors);
        let to = at + by;
        let is_out = to > high as f64 && by > 0.0 || to < low as f64 && by < 0.0;
        if is_out {
            return Err(beyond(axis, to, [low, high]));
        }
    }
    Ok(())
}

fn beyond(axis: &Axis, to: f64, travel: [i64; 2]) -> Failure {
    let (name, unit) = (&axis.name, &axis.unit.name);
    let shown = |steps: f64| digits(steps / axis.unit.steps);
    let [low, high] = travel.map(|steps| shown(steps as f64));
    let to = shown(to);
    Failure::input(format!(
        "{name} would go to {to} {unit}, beyond its travel of {low} to {high} {unit}"
    ))
}
