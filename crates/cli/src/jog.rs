//! Jogs: short moves of one axis or several, which are planned as a move of a move file and stay
//! within `travel` where machine zero is known.

use crate::failure::Failure;
use carrystep_files::unit::digits;
use carrystep_files::{Axis, Machine, MoveFile, SourceText, decimal};
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
        let length =
            self.distances.iter().map(|(_, distance)| distance.powi(2)).sum::<f64>().sqrt();
        let by_feed = self.feed.map(|feed| length * 60.0 / feed);
        match by_feed.filter(|&by_feed| self.time.is_none() && by_feed > seconds(&file)) {
            Some(by_feed) => self.timed(machine, Some(by_feed)),
            None => Ok(file),
        }
    }

    fn timed(&self, machine: &Machine, time: Option<f64>) -> Result<MoveFile, Failure> {
        let mut to = Vec::new();
        for (axis, distance) in &self.distances {
            // Quoted as a TOML key, so that the name cannot contain TOML syntax.
            let axis =
                serde_json::to_string(axis).map_err(|error| Failure::Run(error.to_string()))?;
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
        let first = file.moves.first().filter(|only| only.steps.iter().all(|&steps| steps == 0))?;
        let (name, distance) = self.distances.first()?;
        let (number, axis) = (0..).zip(&file.machine.axes).find(|(_, axis)| axis.name == *name)?;
        let part = first.rounding.get(number).copied().unwrap_or_default().abs();
        let step = 1.0 / decimal::to_f64(&axis.steps_per_unit);
        Some(Failure::input(format!(
            "jog {name} {distance} is {part:.3} step, which rounds to no step at all: nothing would \
             move. One step of {name} is {step} of its units"
        )))
    }
}

/// The time of a planned move, s; 0 if it cannot be planned, which is reported later.
fn seconds(file: &MoveFile) -> f64 {
    let planned = carrystep_plan::Survey::new(file.clone().into(), |_| Ok::<(), Failure>(()));
    planned
        .map_or(0.0, |survey| survey.totals().ticks as f64 * survey.build().timebase.tick_seconds())
}

/// Refuses a jog beyond `travel`, except one that leads back toward it. `places` are the machine
/// places of the axes in steps, of those whose machine zero is known.
pub fn within_travel(file: &MoveFile, places: &[Option<i64>]) -> Result<(), Failure> {
    for (number, axis) in file.machine.axes.iter().enumerate() {
        let Some((at, [low, high])) = places.get(number).copied().flatten().zip(axis.travel) else {
            continue;
        };
        let by: i64 = file.moves.iter().filter_map(|one| one.steps.get(number)).sum();
        let to = at.saturating_add(by);
        let is_out = to > high && by > 0 || to < low && by < 0;
        if is_out {
            return Err(beyond(axis, to, [low, high]));
        }
    }
    Ok(())
}

fn beyond(axis: &Axis, to: i64, travel: [i64; 2]) -> Failure {
    let (name, unit) = (&axis.name, &axis.unit.name);
    let shown = |steps: i64| digits(steps as f64 / axis.unit.steps);
    let [low, high] = travel.map(shown);
    let to = shown(to);
    Failure::input(format!(
        "{name} would go to {to} {unit}, beyond its travel of {low} to {high} {unit}"
    ))
}
