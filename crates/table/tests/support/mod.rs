//! Compiles the generated header and the player with a C compiler, and runs them on a simulated
//! timer.

use carrystep_table::{
    Kind, Motor, Options, PLAYER, Pulses, Speed, Table, TableRequest, Timer, TimerMode,
};
use std::fmt;
use std::path::{Path, PathBuf};
use std::process::Command;
use tempfile::TempDir;

pub const FLAGS: [&str; 8] =
    ["-std=c99", "-O2", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-Wconversion", "-Wshadow"];

/// A move: its steps, and the pulse at which it is stopped from outside.
#[derive(Debug, Clone, Copy)]
pub struct Move {
    pub steps: u32,
    pub stop: Option<u32>,
}

impl Move {
    pub fn of(steps: u32) -> Self {
        Self { steps, stop: None }
    }
}

impl fmt::Display for Move {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.steps)?;
        self.stop.map_or(Ok(()), |stop| write!(f, ":{stop}"))
    }
}

/// A folder with the player and a table, in which they are compiled.
pub struct Bench {
    folder: TempDir,
    flags: Vec<String>,
}

impl Bench {
    pub fn new(header: &str) -> Self {
        let bench =
            Self { folder: tempfile::tempdir().expect("a temporary folder"), flags: Vec::new() };
        for (name, text) in PLAYER {
            bench.write(name, text);
        }
        bench.write("ramp.h", header);
        bench.write("timer_bench.c", include_str!("../bench/timer_bench.c"));
        bench
    }

    pub fn of(table: &Table) -> Self {
        Self::new(&table.header(&Options::new("ramp").expect("a name")))
    }

    pub fn write(&self, name: &str, text: &str) {
        let path = self.path(name);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("a folder is made");
        std::fs::write(path, text).expect("a file is written");
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub fn flag(mut self, flag: &str) -> Self {
        self.flags.push(flag.to_owned());
        self
    }

    /// Compiles the sources. The error is the output of the compiler.
    pub fn compile(&self, sources: &[&str]) -> Result<PathBuf, String> {
        let compiler = std::env::var("CC").unwrap_or_else(|_| "gcc".to_owned());
        let program = self.path("bench");
        let mut command = Command::new(&compiler);
        command
            .current_dir(self.folder.path())
            .args(FLAGS)
            .arg("-I.")
            .args(&self.flags)
            .args(sources);
        let output = command.arg("-o").arg(&program).output();
        let output =
            output.unwrap_or_else(|error| panic!("{compiler} (apt-get install gcc): {error}"));
        if output.status.success() {
            Ok(program)
        } else {
            Err(String::from_utf8_lossy(&output.stderr).into_owned())
        }
    }

    /// The clocks of all pulses of each move. Compiles the bench first if that was not done yet.
    pub fn play(&self, latency: u32, moves: &[Move]) -> Vec<Vec<u64>> {
        if !self.path("bench").exists() {
            let sources = ["timer_bench.c", "carrystep_player.c", "carrystep_sine.c"];
            self.compile(&sources).unwrap_or_else(|words| panic!("{words}"));
        }
        self.try_play(latency, moves).unwrap_or_else(|words| panic!("{words}"))
    }

    /// The same as [`Self::play`], but returns an error if the player does not end as it should.
    pub fn try_play(&self, latency: u32, moves: &[Move]) -> Result<Vec<Vec<u64>>, String> {
        let mut arguments = vec![latency.to_string()];
        arguments.extend(moves.iter().map(Move::to_string));
        let text = run(&self.path("bench"), &arguments)?;
        let clock =
            |line: &str| line.parse().map_err(|_| format!("{line} interrupt after the end"));
        let mut played = text.split("end\n").map(|text| text.lines().map(clock).collect());
        moves
            .iter()
            .map(|_| played.next().unwrap_or_else(|| Err("the bench stops early".to_owned())))
            .collect()
    }
}

/// The output of a compiled bench.
pub fn run(program: &Path, arguments: &[String]) -> Result<String, String> {
    let output = Command::new(program).args(arguments).output().expect("the bench runs");
    if !output.status.success() {
        return Err(format!("the bench ends with {}", output.status));
    }
    String::from_utf8(output.stdout).map_err(|error| error.to_string())
}

/// The delay of each pulse of a move by the formula, counts, not rounded.
pub fn ideal_delays(table: &Table, steps: u32) -> Vec<f64> {
    let request = table.request();
    let ramp: Vec<f64> = table.ramp_entries().map(|entry| table.ideal_delays()[entry]).collect();
    let cruise = request.timer.frequency() / request.top_frequency();
    (0..steps).map(|j| *ramp.get(j.min(steps - 1 - j) as usize).unwrap_or(&cruise)).collect()
}

/// Checks the pulses of a move: their number, and their times, which may differ from those of the
/// formula by `per_pulse` counts for each pulse up to it.
pub fn judge(table: &Table, steps: u32, pulses: &[u64], per_pulse: f64) -> Result<(), String> {
    if pulses.len() != steps as usize {
        return Err(format!("{} pulses in a move of {steps}", pulses.len()));
    }
    let mut ideal = 0.0;
    for (n, (&pulse, delay)) in pulses.iter().zip(ideal_delays(table, steps)).enumerate() {
        ideal += delay;
        let bound = per_pulse * (n + 1) as f64 + 1e-6;
        if (pulse as f64 - ideal).abs() > bound {
            return Err(format!(
                "pulse {n} of {steps} at {pulse}, by the formula {ideal}, bound {bound}"
            ));
        }
    }
    Ok(())
}

/// Lengths of moves just below, at and above every limit at which a move changes its form.
pub fn lengths(table: &Table) -> Vec<u32> {
    let ramp = u32::try_from(table.figures().ramp_pulses).expect("a short ramp");
    let mut lengths = vec![0, 1, 2, 3, 4, 5, ramp - 1, ramp, ramp + 1, ramp + ramp / 2];
    lengths.extend([2 * ramp - 1, 2 * ramp, 2 * ramp + 1, 2 * ramp + 2, 2 * ramp + 3001]);
    lengths
}

/// The table of the source: 500 to 13 333 Hz, 1000 entries, 16 MHz / 64.
pub fn source(mode: TimerMode, entries: u32, pulses: Pulses) -> TableRequest {
    TableRequest {
        timer: Timer::avr16(16_000_000, 64, mode),
        motor: Motor { step_angle_deg: 1.8, microsteps: 8 },
        start_frequency: 500.0,
        top_speed: Speed::Rpm(500.0),
        kind: Kind::Logistic { entries, steepness: 6.0, centre: None },
        pulses,
    }
}
