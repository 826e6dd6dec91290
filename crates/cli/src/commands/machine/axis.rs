//! One axis of a new machine file: the keys of `[[machine.axis]]` and their values, from options or
//! answers.

use crate::failure::Failure;
use carrystep_files::decimal;
use carrystep_files::driver::drivers;
use std::collections::BTreeMap;

/// The type of a key's value.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Text,
    Number,
}

/// Every key except the name, in the order in which they are written, with the comment behind each;
/// `UNIT` stands for the axis' unit.
const KEYS: [(&str, Kind, &str); 16] = [
    ("unit", Kind::Text, "positions and speeds are shown in it"),
    ("steps_per_unit", Kind::Number, "microsteps that move one UNIT"),
    ("lead", Kind::Number, "UNIT that one turn of the motor moves"),
    ("steps_per_rev", Kind::Number, "full steps of a turn: 200 for 1.8 degrees"),
    ("microsteps", Kind::Number, "as the driver is set"),
    ("start_speed", Kind::Number, "UNIT/s: the jump from rest that the motor takes"),
    ("start_speed_per_min", Kind::Number, "UNIT/min: the jump from rest that the motor takes"),
    ("speed_limit", Kind::Number, "UNIT/s"),
    ("speed_limit_per_min", Kind::Number, "UNIT/min"),
    ("accel_limit", Kind::Number, "UNIT/s^2"),
    ("jerk_limit", Kind::Number, "UNIT/s^3, for the profile scurve"),
    ("driver", Kind::Text, "its pulse widths, set-up and hold times are built in"),
    ("step_high_ns", Kind::Number, "ns that STEP is high, at least"),
    ("step_low_ns", Kind::Number, "ns that STEP is low, at least"),
    ("dir_setup_ns", Kind::Number, "ns that DIR is stable before STEP rises"),
    ("dir_hold_ns", Kind::Number, "ns that DIR is stable after STEP has risen"),
];

/// The required keys. Each entry lists alternatives; all keys of one alternative must be given.
const NEEDED: [&[&[&str]]; 4] = [
    &[&["lead", "steps_per_rev", "microsteps"], &["steps_per_unit"]],
    &[&["speed_limit"], &["speed_limit_per_min"]],
    &[&["accel_limit"]],
    &[&["driver"], &["step_high_ns", "step_low_ns", "dir_setup_ns", "dir_hold_ns"]],
];

/// The keys of one axis.
#[derive(Debug, Clone, Default)]
pub struct AxisKeys {
    pub name: String,
    keys: BTreeMap<&'static str, String>,
}

impl AxisKeys {
    /// An axis of which only the name is known.
    pub fn named(name: &str) -> Self {
        Self { name: name.to_owned(), keys: BTreeMap::new() }
    }

    /// Parses the option `x,unit=mm,lead=40,...`.
    pub fn parse(option: &str) -> Result<Self, Failure> {
        let mut parts = option.split(',').map(str::trim);
        let mut axis = Self::named(parts.next().unwrap_or_default());
        for part in parts {
            let refused = |why: String| Failure::input(format!("--axis {option}: {why}"));
            let Some((key, value)) = part.split_once('=') else {
                return Err(refused(format!("{part:?} is not KEY=VALUE")));
            };
            axis.set(key.trim(), value.trim()).map_err(refused)?;
        }
        Ok(axis)
    }

    /// Sets a key, or returns the reason why it is refused.
    pub fn set(&mut self, key: &str, value: &str) -> Result<(), String> {
        let Some(&(key, kind, _)) = KEYS.iter().find(|(known, ..)| *known == key) else {
            let known: Vec<&str> = KEYS.iter().map(|(key, ..)| *key).collect();
            return Err(format!("an axis has no key {key:?}; its keys are {}", known.join(", ")));
        };
        if kind == Kind::Number && decimal::parse(value).is_none() {
            return Err(format!("{key} = {value}: a number is expected"));
        }
        if key == "driver" && !drivers().contains_key(value) {
            let known: Vec<&str> = drivers().keys().map(String::as_str).collect();
            return Err(format!("no driver is called '{value}'; known are {}", known.join(", ")));
        }
        match self.keys.insert(key, value.to_owned()) {
            None => Ok(()),
            Some(_) => Err(format!("{key} is given twice")),
        }
    }

    /// The missing keys: for each requirement the missing keys of its first alternative, and a text
    /// with all alternatives.
    pub fn missing(&self) -> Vec<(Vec<&'static str>, String)> {
        let has = |set: &&[&str]| set.iter().all(|key| self.keys.contains_key(key));
        let lacks = |ways: &&&[&[&'static str]]| !ways.iter().any(has);
        let told = |ways: &&[&[&'static str]]| {
            let first =
                ways[0].iter().copied().filter(|key| !self.keys.contains_key(key)).collect();
            (first, ways.iter().map(|set| set.join(", ")).collect::<Vec<_>>().join("; or "))
        };
        NEEDED.iter().filter(lacks).map(told).collect()
    }

    /// The unit, for questions and comments.
    pub fn unit(&self) -> &str {
        self.keys.get("unit").map_or("units", String::as_str)
    }

    /// The text of the axis' table.
    pub fn text(&self) -> String {
        let quoted = |text: &str| format!("{text:?}");
        let mut lines =
            vec!["[[machine.axis]]".to_owned(), format!("name = {}", quoted(&self.name))];
        for (key, kind, comment) in KEYS {
            let Some(value) = self.keys.get(key) else { continue };
            let value = if kind == Kind::Text { quoted(value) } else { value.clone() };
            lines.push(format!(
                "{:<28} # {}",
                format!("{key} = {value}"),
                comment.replace("UNIT", self.unit())
            ));
        }
        lines.join("\n") + "\n"
    }
}
