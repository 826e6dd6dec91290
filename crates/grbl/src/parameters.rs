//! What `$#` and `$G` show.

use std::fmt::Write as _;

/// Millimetres of an inch.
pub(crate) const INCH: f64 = 25.4;

/// The last probe move.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Probed {
    /// Where it ended, in machine coordinates.
    pub at: Vec<f64>,
    /// Whether the probe has tripped.
    pub tripped: bool,
}

impl Probed {
    /// The report behind a probe move, as `$#` shows it too.
    pub fn text(&self, inches: bool) -> String {
        format!("[PRB:{}:{}]\r\n", places(&self.at, inches), u8::from(self.tripped))
    }
}

/// Offsets and stored places, each with a value for each axis, in mm or degrees.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Parameters {
    /// G54 to G59.
    pub systems: [Vec<f64>; 6],
    /// G28 and G30.
    pub stored: [Vec<f64>; 2],
    /// G92.
    pub g92: Vec<f64>,
    /// Tool length, mm.
    pub tool_length: f64,
    /// The last probe move.
    pub probed: Probed,
}

/// Coordinates as reports show them: three decimals in mm, four in inches. Letters from the third
/// on are in degrees, but Grbl has none, and so they are treated like the others.
pub(crate) fn places(values: &[f64], inches: bool) -> String {
    let (unit, digits) = if inches { (INCH, 4) } else { (1.0, 3) };
    let one = |value: &f64| {
        let text = format!("{:.digits$}", value / unit);
        // No negative zero.
        if text.trim_start_matches('-').bytes().all(|byte| matches!(byte, b'0' | b'.')) {
            text.trim_start_matches('-').to_owned()
        } else {
            text
        }
    };
    values.iter().map(one).collect::<Vec<_>>().join(",")
}

impl Parameters {
    /// The text of `$#`.
    pub fn text(&self, inches: bool) -> String {
        let mut text = String::new();
        let names = ["G54", "G55", "G56", "G57", "G58", "G59"].iter().zip(&self.systems);
        let all = names.chain(["G28", "G30"].iter().zip(&self.stored));
        for (name, values) in all.chain([(&"G92", &self.g92)]) {
            // Writing to a string cannot fail.
            let _ = write!(text, "[{name}:{}]\r\n", places(values, inches));
        }
        let length = places(&[self.tool_length], inches);
        let _ = write!(text, "[TLO:{length}]\r\n");
        text + &self.probed.text(inches)
    }
}

/// The modes in force behind the last line that was read.
#[derive(Debug, Clone, PartialEq)]
pub struct ParserState {
    /// The motion mode, such as `G0` or `G38.2`.
    pub motion: String,
    /// The coordinate system, such as `G54`.
    pub system: String,
    /// G17, G18 or G19.
    pub plane: u8,
    /// G20.
    pub inches: bool,
    /// G91.
    pub incremental: bool,
    /// G93.
    pub inverse_time: bool,
    /// The spindle: 3, 4 or 5.
    pub spindle: u8,
    /// M7.
    pub mist: bool,
    /// M8.
    pub flood: bool,
    /// The tool.
    pub tool: u32,
    /// F, mm/min.
    pub feed: f64,
    /// S, turns per minute.
    pub rpm: f64,
}

impl ParserState {
    /// The text of `$G`. `inches` is about the report, and not about the program.
    pub fn text(&self, inches: bool) -> String {
        let Self { motion, system, plane, spindle, tool, rpm, .. } = self;
        let units = if self.inches { 20 } else { 21 };
        let distance = if self.incremental { 91 } else { 90 };
        let rate = if self.inverse_time { 93 } else { 94 };
        let coolant = match (self.mist, self.flood) {
            (true, true) => "M7 M8",
            (true, false) => "M7",
            (false, true) => "M8",
            (false, false) => "M9",
        };
        let feed =
            if inches { format!("{:.1}", self.feed / INCH) } else { format!("{:.0}", self.feed) };
        format!(
            "[GC:{motion} {system} G{plane} G{units} G{distance} G{rate} M{spindle} {coolant} T{tool} \
             F{feed} S{rpm:.0}]\r\n"
        )
    }
}
