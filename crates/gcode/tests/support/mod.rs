//! The programs that the tests read.

use carrystep_gcode::{Canon, GcodeError, Interpreter, Options, Point, Step, ToolTable};
use proptest::prelude::*;
use std::io::Cursor;
use std::path::{Path, PathBuf};

/// All programs in a folder and the folders in it, sorted by their paths.
pub fn files(folder: &Path) -> Vec<PathBuf> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
    let mut found = Vec::new();
    for path in entries.filter_map(|entry| Some(entry.ok()?.path())) {
        if path.is_dir() {
            found.extend(files(&path));
        } else if path.extension().is_some_and(|extension| extension == "ngc") {
            found.push(path);
        }
    }
    found.sort();
    found
}

/// The jobs of `sim/jobs`.
pub fn jobs() -> Vec<PathBuf> {
    files(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../sim/jobs"))
}

/// The programs of `tests/programs`, which use each part of the language.
pub fn programs() -> Vec<PathBuf> {
    files(&Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/programs"))
}

/// A program whose subroutines are in other files.
pub fn main_of_subroutines() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/subroutines/main.ngc")
}

/// The text of a tool table: a line for each tool.
pub fn tool_table() -> String {
    let line = |tool: u32| {
        let n = f64::from(tool);
        let turned = if tool.is_multiple_of(7) { n } else { 0.0 };
        format!("T{tool} P{tool} X{} Z{} A{turned} D{}\n", n / 8.0, 2.5 * n, n / 4.0)
    };
    (1..99).map(line).collect()
}

/// The tools of [`tool_table`].
pub fn tools() -> ToolTable {
    ToolTable::read(Cursor::new(tool_table()), "tools.tbl").expect("a tool table")
}

/// The steps of a program.
pub fn steps(text: &str) -> Result<Vec<Step>, GcodeError> {
    Interpreter::new(Cursor::new(text), "p.ngc", &Options::default())?.collect()
}

/// The canonical moves of a program that is not refused, without their lines.
pub fn canons(text: &str) -> Vec<Canon> {
    match steps(text) {
        Ok(steps) => steps.into_iter().map(|step| step.canon).collect(),
        Err(error) => panic!("{error}\n{text}"),
    }
}

/// The X coordinates in mm to which a program moves, in order.
pub fn xs(text: &str) -> Vec<f64> {
    let x = |canon| match canon {
        Canon::Traverse { to } | Canon::Feed { to, .. } => Some(to[0]),
        _ => None,
    };
    canons(text).into_iter().filter_map(x).collect()
}

/// Coordinates with up to four digits, as CAM programs write them.
pub fn point() -> impl Strategy<Value = Point> {
    prop::array::uniform6((-9_999_i32..9_999).prop_map(|n| f64::from(n) / 100.0))
}

/// The axis words of a place.
pub fn words(point: &Point) -> String {
    let letters = carrystep_gcode::AXIS_LETTERS;
    letters.iter().zip(point).map(|(letter, value)| format!("{letter}{value} ")).collect()
}

/// Whether two places are not the same but for rounding.
pub fn is_apart(one: &Point, other: &Point) -> bool {
    (0..6).any(|axis| (one[axis] - other[axis]).abs() > 1e-6)
}
