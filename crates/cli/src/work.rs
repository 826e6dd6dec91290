//! Work offsets and tool length as the command's memory of a board holds them, and how a user sets
//! them.

use crate::failure::Failure;
use carrystep_files::Machine;
use carrystep_gcode::{AXIS_LETTERS, Interpreter, Offsets, Options, Point, Tool, ToolTable};
use carrystep_program::Letters;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt;
use std::fmt::Write as _;
use std::io::{self, Cursor, Write as _};

/// Greatest offset, mm and degrees: that of programs.
const FURTHEST: f64 = 1e9;

/// The names of the coordinate systems, in the order of their parameters.
pub const SYSTEMS: [&str; 9] =
    ["G54", "G55", "G56", "G57", "G58", "G59", "G59.1", "G59.2", "G59.3"];
/// Number of the parameter that is X of G54, the distance of two systems, and that of the rotation
/// from X.
const ORIGIN: u16 = 5221;
const STEP: u16 = 20;
const ROTATION: u16 = 9;
/// Numbers of the parameters of G92.
const G92_ON: u16 = 5210;
const G92: u16 = 5211;

/// The offsets in the file of a board.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct WorkRecord {
    /// Parameters of programs by their numbers, mm and degrees: 5221 is X of G54.
    parameters: BTreeMap<u16, f64>,
    /// Tool length in effect: x, y, z in mm, a, b, c in degrees.
    tool: Point,
}

impl WorkRecord {
    /// The offsets; `None` if a value is impossible.
    pub fn offsets(&self) -> Option<Offsets> {
        let known: Vec<u16> = Offsets::numbers().collect();
        let fits = |(number, value): (&u16, &f64)| {
            known.contains(number) && value.is_finite() && value.abs() <= FURTHEST
        };
        let is_whole = self.parameters.iter().all(fits)
            && self.tool.iter().all(|value| value.is_finite() && value.abs() <= FURTHEST);
        let parameters = self.parameters.iter().map(|(&number, &value)| (number, value)).collect();
        is_whole.then_some(Offsets { parameters, tool: self.tool })
    }
}

impl From<&Offsets> for WorkRecord {
    fn from(offsets: &Offsets) -> Self {
        let Offsets { parameters, tool } = offsets;
        Self { parameters: parameters.iter().copied().collect(), tool: *tool }
    }
}

/// An offset that is not zero.
#[derive(Debug, Clone, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct NamedOffset {
    /// A coordinate system (`G54`), `G92`, `G92 (suspended)`, or `tool length`.
    pub name: String,
    /// The values that are not zero, by their letters: x, y, z in mm, a, b, c in degrees.
    pub values: BTreeMap<char, f64>,
    /// Rotation of a coordinate system, degrees.
    pub rotation: f64,
}

impl fmt::Display for NamedOffset {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.name)?;
        for letter in AXIS_LETTERS {
            let value = self.values.get(&letter);
            value.map_or(Ok(()), |&value| write!(f, " {letter} {}", shown(value)))?;
        }
        if self.rotation == 0.0 {
            return Ok(());
        }
        write!(f, " rotated by {} degrees", shown(self.rotation))
    }
}

/// The offsets that are not zero.
pub fn named(offsets: &Offsets) -> Vec<NamedOffset> {
    let of = |name: &str, value: &dyn Fn(u16) -> f64, rotation: f64| {
        let letters = AXIS_LETTERS.into_iter().zip((0..).map(value));
        let values = letters.filter(|(_, value)| *value != 0.0).collect();
        NamedOffset { name: name.to_owned(), values, rotation }
    };
    let system = |(name, number): (&&str, u16)| {
        let first = ORIGIN + STEP * number;
        of(name, &|axis| offsets.get(first + axis), offsets.get(first + ROTATION))
    };
    let all = if offsets.get(G92_ON) == 0.0 { "G92 (suspended)" } else { "G92" };
    let others = [
        of(all, &|axis| offsets.get(G92 + axis), 0.0),
        of("tool length", &|axis| offsets.tool[usize::from(axis)], 0.0),
    ];
    let every = SYSTEMS.iter().zip(0..).map(system).chain(others);
    every.filter(|one| !one.values.is_empty() || one.rotation != 0.0).collect()
}

/// Says on standard error which offsets a program begins with, if there are any.
pub fn tell(offsets: &Offsets) {
    let lines: Vec<String> = named(offsets).iter().map(NamedOffset::to_string).collect();
    if !lines.is_empty() {
        // If this write fails, there is no channel left to report it.
        let _ = writeln!(io::stderr(), "work offsets: {}", lines.join("; "));
    }
}

/// A length with at most six digits behind the point.
fn shown(value: f64) -> String {
    let text = format!("{value:.6}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// What gets coordinates or a length: a coordinate system, G92 or the tool.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Target {
    /// G54 to G59.3: its number, from 1.
    System(u8),
    /// G92: all coordinate systems.
    All,
    /// G43.1: the length of the tool.
    Tool,
    /// The length of the tool with which the place has the coordinates in this system, G54 to
    /// G59.3: its number, from 1.
    ToolIn(u8),
}

/// What a user wants to set where the machine is.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OffsetWish {
    /// What gets the values.
    pub target: Target,
    /// Letters by their numbers, with mm or degrees.
    pub values: Vec<(usize, f64)>,
}

impl OffsetWish {
    /// Refuses letters that the machine does not have.
    ///
    /// # Errors
    /// The first of them.
    pub fn check(&self, machine: &Machine, letters: &Letters) -> Result<(), Failure> {
        let strange = self.values.iter().find(|(letter, _)| letters.axis(*letter).is_none());
        strange.map_or(Ok(()), |&(letter, _)| {
            let (name, axes) = (AXIS_LETTERS[letter], machine.letter_names());
            Err(Failure::input(format!("the machine has no axis {name}: the axes are {axes}")))
        })
    }
}

impl std::str::FromStr for Target {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let name = text.to_ascii_uppercase();
        let system = (1..).zip(SYSTEMS).find(|(_, known)| *known == name);
        match (system, &*name) {
            (Some((number, _)), _) => Ok(Self::System(number)),
            (None, "G92") => Ok(Self::All),
            (None, "G43.1") => Ok(Self::Tool),
            _ => Err("expected G54 to G59, G59.1 to G59.3, G92 or G43.1".to_owned()),
        }
    }
}

/// The offsets with which the machine place gets the wanted coordinates. The rules are those of G10
/// L20, G92, G43.1 and G10 L10 in programs.
///
/// # Errors
/// An offset beyond what a program may have.
pub fn set(offsets: &Offsets, at: Point, wish: &OffsetWish) -> Result<Offsets, Failure> {
    let mut words = String::new();
    for &(letter, value) in &wish.values {
        // Programs have no exponents, and fifteen digits are finer than any offset. Writing to a
        // string cannot fail.
        let _ = write!(words, " {}{value:.15}", AXIS_LETTERS[letter]);
    }
    let mut options = Options { start: at, offsets: offsets.clone(), ..Options::default() };
    let text = match wish.target {
        Target::System(number) => format!("G10 L20 P{number}{words}"),
        Target::All => format!("G92{words}"),
        Target::Tool => format!("G43.1{words}"),
        Target::ToolIn(number) => {
            // The other axes keep the offset that is in effect.
            let mut table = ToolTable::default();
            table.set(1, Tool { offset: offsets.tool, ..Tool::default() });
            options.tools = Some(table);
            let system = SYSTEMS[usize::from(number).clamp(1, SYSTEMS.len()) - 1];
            format!("{system}\nG10 L10 P1{words}\nG43 H1")
        }
    };
    let refused = |error: carrystep_gcode::GcodeError| Failure::input(format!("offset: {error}"));
    let mut program = Interpreter::new(Cursor::new(text), "offset", &options).map_err(refused)?;
    program.by_ref().try_for_each(|step| step.map(drop)).map_err(refused)?;
    Ok(program.offsets())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn described(offsets: &Offsets) -> Vec<String> {
        named(offsets).iter().map(NamedOffset::to_string).collect()
    }

    #[test]
    fn offset_gives_the_place_its_coordinate() {
        let at = [10.0, -2.0, 1.0, 0.0, 0.0, 0.0];
        let set = |before: &Offsets, target, values: &[(usize, f64)]| {
            set(before, at, &OffsetWish { target, values: values.to_vec() }).unwrap()
        };
        let one = set(&Offsets::default(), Target::System(2), &[(0, 3.0), (2, 0.0)]);
        assert_eq!(described(&one), ["G55 x 7 z 1"]);
        // The tool length counts, as it does in programs.
        let tool = set(&one, Target::Tool, &[(2, 0.25)]);
        let two = set(&tool, Target::System(1), &[(2, 0.0)]);
        assert_eq!(described(&two), ["G54 z 0.75", "G55 x 7 z 1", "tool length z 0.25"]);
        let all = set(&two, Target::All, &[(1, 5.0)]);
        assert_eq!(described(&all).get(2).map(String::as_str), Some("G92 y -7"));
        // With this length, z of the place is 2.5 in G55, and in G92 as well.
        let length = set(&all, Target::ToolIn(2), &[(2, 2.5)]);
        assert_eq!(described(&length).last().map(String::as_str), Some("tool length z -2.5"));
        assert_eq!(described(&length)[..3], described(&all)[..3]);
        assert_eq!(WorkRecord::from(&all).offsets(), Some(all));
    }

    #[test]
    fn impossible_offsets_are_none() {
        let text = r#"{"parameters": {"5221": 1e300}, "tool": [0, 0, 0, 0, 0, 0]}"#;
        assert_eq!(serde_json::from_str::<WorkRecord>(text).unwrap().offsets(), None);
        let text = r#"{"parameters": {"31": 1}, "tool": [0, 0, 0, 0, 0, 0]}"#;
        assert_eq!(serde_json::from_str::<WorkRecord>(text).unwrap().offsets(), None);
    }
}
