//! How a program is entered at one of its blocks, as it is printed and in `--json`.

use carrystep_files::unit::digits;
use carrystep_program::{
    AXIS_LETTERS, Entry, Modes, PathMode, Plane, ProgramFile, SwitchCount, Turn, unit,
};
use schemars::JsonSchema;
use serde::Serialize;
use std::fmt;

/// The entry of a program at one of its blocks.
#[derive(Debug, JsonSchema, Serialize)]
pub struct EntryFigures {
    /// Number of the executed block with which the program goes on.
    pub block: u64,
    /// The file of the block.
    pub file: String,
    /// Its line in this file.
    pub line: u64,
    /// Its text.
    pub text: String,
    /// Number of the tool that has to be in the spindle; 0 if the program has not chosen any.
    pub tool: u32,
    /// The modes in which the block begins, as codes.
    pub modes: String,
    /// What is added to program coordinates, mm or degrees, for each axis of the machine.
    pub offsets: Vec<AxisPlace>,
    /// M3, M4 or M5.
    pub spindle: &'static str,
    /// S, turns per minute.
    pub rpm: f64,
    /// M7 is on.
    pub mist: bool,
    /// M8 is on.
    pub flood: bool,
    /// F in mm/min; null if none is in force.
    pub feed_mm_min: Option<f64>,
    /// The machine place where the machine is before.
    pub from: Vec<AxisPlace>,
    /// The machine place where the block begins.
    pub to: Vec<AxisPlace>,
    /// The machine height of the way of all other axes, mm; null without z.
    pub height_mm: Option<f64>,
    /// The dwell before Z goes down, s.
    pub dwell_s: f64,
    /// The speed of the way down, mm/min.
    pub down_mm_min: f64,
    /// What the blocks before have waited for or assumed: nothing of it is done.
    pub passed: Vec<PassedBlocks>,
}

/// The place of an axis, mm or degrees.
#[derive(Debug, JsonSchema, Serialize)]
pub struct AxisPlace {
    pub axis: String,
    pub at: f64,
    pub unit: &'static str,
}

/// Something that the blocks before the entry ask for, and that is not done.
#[derive(Debug, JsonSchema, Serialize)]
pub struct PassedBlocks {
    /// pause, tool change, input or probe.
    pub what: &'static str,
    /// How often.
    pub count: u64,
    /// The first line that does it.
    pub line: u64,
}

impl EntryFigures {
    /// The entry of a program, if it does not begin with its first block.
    pub fn of(file: &ProgramFile) -> Option<Self> {
        let entry = file.entry()?;
        let Entry { block, place, modes, height, feed, dwell, .. } = entry;
        let places = |place: &[f64; 6]| {
            let letters = file.letters().all().iter();
            let axis = |&letter: &usize| AxisPlace {
                axis: AXIS_LETTERS[letter].to_string(),
                at: place[letter],
                unit: unit(letter),
            };
            letters.map(axis).collect()
        };
        let passed = |one: &SwitchCount| PassedBlocks {
            what: one.switch.name(),
            count: one.count,
            line: one.line,
        };
        Some(Self {
            block: block.number,
            file: block.file.to_string(),
            line: block.line,
            text: shown(&block.text),
            tool: modes.tool,
            modes: codes(modes),
            offsets: places(&modes.offset),
            spindle: match modes.spindle {
                Turn::Off => "M5",
                Turn::Clockwise => "M3",
                Turn::Counterclockwise => "M4",
            },
            rpm: modes.rpm,
            mist: modes.mist,
            flood: modes.flood,
            feed_mm_min: modes.feed,
            from: places(&file.settings().start),
            to: places(place),
            height_mm: *height,
            dwell_s: *dwell,
            down_mm_min: feed * 60.0,
            passed: entry.passed.iter().map(passed).collect(),
        })
    }
}

/// Text of a program without what a terminal would execute.
pub fn shown(text: &str) -> String {
    text.trim().chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}

/// The modes as codes.
fn codes(modes: &Modes) -> String {
    let plane = match modes.plane {
        Plane::Xy => "G17",
        Plane::Zx => "G18",
        Plane::Yz => "G19",
    };
    let system = match modes.system {
        system @ 1..=6 => format!("G{}", 53 + system),
        system => format!("G59.{}", system - 6),
    };
    let path = match modes.path {
        PathMode::Exact => "G61".to_owned(),
        PathMode::ExactStop => "G61.1".to_owned(),
        PathMode::Blend { tolerance_mm: None, .. } => "G64".to_owned(),
        PathMode::Blend { tolerance_mm: Some(tolerance), .. } => format!("G64 P{tolerance}"),
    };
    let either = |is: bool, yes: &'static str, no: &'static str| if is { yes } else { no };
    let units = either(modes.inches, "G20", "G21");
    let distance = either(modes.incremental, "G91", "G90");
    let feed = either(modes.inverse_time, "G93", "G94");
    let turned = match modes.rotation {
        0.0 => String::new(),
        degrees => format!(", turned by {degrees} degrees"),
    };
    format!("{plane} {units} {distance} {feed} {system} {path}{turned}")
}

/// Places such as "x=1 y=2.5".
fn places(places: &[AxisPlace]) -> String {
    let one = |AxisPlace { axis, at, .. }: &AxisPlace| format!("{axis}={}", digits(*at));
    places.iter().map(one).collect::<Vec<_>>().join(" ")
}

impl fmt::Display for EntryFigures {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { block, file, line, text, tool, modes, rpm, dwell_s, .. } = self;
        writeln!(f, "entry at block {block}, {file}:{line}: {text}")?;
        let tool =
            if *tool == 0 { "the program has chosen none".to_owned() } else { tool.to_string() };
        writeln!(f, "  tool:     {tool}")?;
        writeln!(f, "  modes:    {modes}")?;
        writeln!(f, "  offsets:  {}", places(&self.offsets))?;
        match self.spindle {
            "M5" => writeln!(f, "  spindle:  off")?,
            code => writeln!(f, "  spindle:  {code} S{rpm}, then {} s of rest", digits(*dwell_s))?,
        }
        let coolant = match (self.mist, self.flood) {
            (false, false) => "off",
            (true, false) => "mist",
            (false, true) => "flood",
            (true, true) => "mist and flood",
        };
        writeln!(f, "  coolant:  {coolant}")?;
        match self.feed_mm_min {
            Some(feed) => writeln!(f, "  feed:     F{} mm/min", digits(feed))?,
            None => writeln!(f, "  feed:     none in force")?,
        }
        writeln!(f, "  way:      from {}", places(&self.from))?;
        let to = places(&self.to);
        match self.height_mm {
            Some(height) => {
                let (height, down) = (digits(height), digits(self.down_mm_min));
                writeln!(f, "            Z to {height} at rapid, all other axes at rapid")?;
                writeln!(f, "            Z down at {down} mm/min to {to}")?;
            }
            None => {
                writeln!(f, "            straight at {} mm/min to {to}", digits(self.down_mm_min))?;
            }
        }
        for PassedBlocks { what, count, line } in &self.passed {
            let instead = match *what {
                "probe" => "assumed to have tripped at its target",
                "input" => "assumed to have become what the program waits for",
                _ => "not repeated",
            };
            writeln!(f, "  before:   {what} ({count}, first in line {line}): {instead}")?;
        }
        Ok(())
    }
}
