//! The files that the measured commands read and write. All of them are in a temporary folder.

use super::child;
use super::rows::{Input, Row};
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

/// The machine of the moves: that of this file, which has a jerk limit.
const MACHINE: &str = include_str!("../../../../../sim/curves.toml");

/// Every case of the sweep has about the same amount of work.
const SWEEP: &str = r#"move_file = '''
[machine]
clock_hz = 80_000_000

[[machine.axis]]
name = "x"
steps_per_unit = 1
speed_limit = 20_000
accel_limit = 500_000
driver = "tmc2209"

[[move]]
profile = "trapezoid"
to = { x = {{ steps }} }

[[move]]
profile = "trapezoid"
to = { x = -{{ steps }} }
'''

[vary]
steps = { from = 300, to = 340 }
"#;

/// A command line whose files exist, except that of its output.
pub struct CommandLine {
    arguments: Vec<String>,
    out: PathBuf,
    /// The folder of all files. It is removed with the command line.
    _folder: tempfile::TempDir,
}

impl CommandLine {
    /// Writes the input of a command for an amount of work.
    ///
    /// # Errors
    /// A file cannot be written, or the capture cannot be made.
    pub fn prepare(row: &Row, units: u64, carrystep: &Path) -> Result<Self, String> {
        let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
        let path = |name: &str| folder.path().join(name);
        let [moves, capture, sweep, out] = ["move.toml", "in.vcd", "sweep.toml", "out"].map(path);
        let write = |path: &Path, text: &str| {
            fs::write(path, text).map_err(|error| format!("{}: {error}", path.display()))
        };
        match row.input {
            Input::Moves | Input::Capture => write(&moves, &many_moves(units)),
            Input::Steps | Input::StepsCapture => write(&moves, &many_steps(units)),
            Input::OneMove => write(&moves, &one_move(units)),
            Input::Sweep => write(&sweep, SWEEP),
            Input::Arguments => Ok(()),
        }?;
        let word = |word: &str| match word {
            "MOVE" => moves.display().to_string(),
            "CAPTURE" => capture.display().to_string(),
            "SWEEP" => sweep.display().to_string(),
            "OUT" => out.display().to_string(),
            "UNITS" => units.to_string(),
            other => other.to_owned(),
        };
        if let Input::Capture | Input::StepsCapture = row.input {
            let words = ["simulate", "MOVE", "--core", "parallel", "--vcd", "CAPTURE"];
            child::seconds(carrystep, &words.map(word))?;
        }
        let arguments = row.command.split(' ').map(word).collect();
        Ok(Self { arguments, out, _folder: folder })
    }

    /// Runs the command, returns its processor time in seconds, and removes its output.
    ///
    /// # Errors
    /// The command fails.
    pub fn run(&self, carrystep: &Path) -> Result<f64, String> {
        let seconds = child::seconds(carrystep, &self.arguments)?;
        self.remove_output()?;
        Ok(seconds)
    }

    /// Runs the command, returns the greatest memory that it used in bytes, and removes its output.
    ///
    /// # Errors
    /// The command fails.
    pub fn memory(&self, carrystep: &Path) -> Result<u64, String> {
        let bytes = child::memory(carrystep, &self.arguments)?;
        self.remove_output()?;
        Ok(bytes)
    }

    fn remove_output(&self) -> Result<(), String> {
        if self.out.exists() {
            fs::remove_file(&self.out).map_err(|error| error.to_string())?;
        }
        Ok(())
    }
}

/// The tables of the machine, without the moves that follow them.
fn machine() -> &'static str {
    MACHINE.split_once("[[move]]").map_or(MACHINE, |(machine, _)| machine)
}

/// S-curves of 20 to 27 steps, alternately forward and backward, in as few bytes as possible.
fn many_moves(units: u64) -> String {
    let mut text = machine().to_owned();
    for number in 0..units {
        let sign = if number % 2 == 0 { "" } else { "-" };
        let steps = 20 + number / 2 % 8;
        // Writing to a string cannot fail.
        let _ = writeln!(text, "[[move]]\nprofile=\"scurve\"\nto={{c={sign}{steps}}}");
    }
    text
}

/// Moves of a single step, alternately forward and backward.
fn many_steps(units: u64) -> String {
    let moved = |sign| format!("[[move]]\nprofile=\"ranade\"\nto={{c={sign}1}}\n");
    let both = moved("") + &moved("-");
    machine().to_owned() + &both.repeat(units.div_ceil(2) as usize)
}

/// One move of so many steps.
fn one_move(units: u64) -> String {
    format!("{}[[move]]\nprofile = \"trapezoid\"\nto = {{ c = {units} }}\n", machine())
}
