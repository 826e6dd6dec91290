//! Programs in G-code as segments for the levels.

use crate::moves::root;
use carrystep_core::{Command, EngineBuild, OutputChange, Program, Segment};
use carrystep_files::{Machine, SourceText};
use carrystep_program::{ProgramError, ProgramFile, Row, RowOutputs, Settings, Survey};
use std::path::Path;

/// Lines, an arc, a corner, a rest and a reversal, in a third of a second.
const SHORT: &str =
    "G64 P0.02 F1500\nG1 X0.8 Y0.4\nG3 X0.8 Y1.2 J0.4\nG4 P0.01\nG1 X0 Y0 Z-0.1\nX0.2\n";

/// Three short moves, with outputs and the duty of the PWM that change at rest and in motion. It is
/// for levels that take seconds for a tenth of a second.
const SWITCHING: &str =
    "G64 P0.02 F3000\nM3 S9000 M8\nG1 X0.05 Y0.03\nM62 P3\nX0.1\nM63 P3\nY0 Z-0.005\nM5 M9\n";

/// A planned program.
#[derive(Debug)]
pub struct GcodeJob {
    /// The machine.
    pub machine: Machine,
    /// Its segments: rows of common ticks.
    pub rows: Vec<Row>,
    /// The outputs before the first row.
    pub outputs: RowOutputs,
    /// Its figures.
    pub survey: Survey,
}

/// A short program on the machine of `sim/jobs/`.
///
/// # Panics If it cannot be planned.
pub fn short() -> GcodeJob {
    written(SHORT, &machine("machine.toml"))
}

/// A very short program that switches outputs, on the machine of `sim/jobs/` with outputs. A slow
/// clock makes it half a million clocks.
///
/// # Panics If it cannot be planned.
pub fn switching() -> GcodeJob {
    let text = machine("outputs.toml");
    let slow = text.replace("80_000_000", "12_000_000").replace("tick_ns = 1000", "tick_ns = 4000");
    written(SWITCHING, &slow)
}

fn written(text: &str, machine: &str) -> GcodeJob {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("written.ngc");
    std::fs::write(&path, text).expect("a file");
    planned(&path, machine)
}

/// A program of `sim/jobs/`.
///
/// # Panics If it cannot be planned.
pub fn shipped(name: &str) -> GcodeJob {
    planned(&root().join("sim/jobs").join(name), &machine("machine.toml"))
}

/// A machine file of `sim/jobs/`.
fn machine(name: &str) -> String {
    std::fs::read_to_string(root().join("sim/jobs").join(name)).expect("a machine file")
}

fn planned(path: &Path, machine: &str) -> GcodeJob {
    let machine_file = Path::new("machine.toml");
    let source = SourceText { path: machine_file.to_owned(), text: machine.into() };
    let machine = Machine::from_source(&source).expect("the machine of the jobs");
    let file = ProgramFile::open(path, machine.clone(), machine_file, Settings::default())
        .expect("a program");
    let mut rows = Vec::new();
    let survey = Survey::new(&file, |row| {
        rows.push(row.clone());
        Ok::<(), ProgramError>(())
    });
    GcodeJob { machine, rows, outputs: file.row_outputs(), survey: survey.expect("a plan") }
}

impl GcodeJob {
    /// The engine of the machine.
    pub fn engine(&self) -> EngineBuild {
        self.machine.engine()
    }

    /// The segments of one axis.
    pub fn segments(&self, axis: usize) -> Vec<Segment> {
        self.rows.iter().map(|row| row.segments[axis]).collect()
    }

    /// What a host sends: the changes of outputs and the segments row by row; all axes start behind
    /// the first row.
    pub fn program(&self) -> Program {
        let mut program: Program = Vec::new();
        for ((number, row), change) in self.rows.iter().enumerate().zip(self.changes()) {
            program.extend((!change.is_none()).then_some(Command::Outputs(change)));
            let of_row = (0..).zip(&row.segments);
            program.extend(of_row.map(|(axis, &segment)| Command::Segment { axis, segment }));
            if number == 0 {
                program.push(Command::Start { mask: (1 << self.machine.axes.len()) - 1 });
            }
        }
        program
    }

    /// What changes at the outputs with each row.
    fn changes(&self) -> impl Iterator<Item = OutputChange> {
        let mut outputs = self.outputs.clone();
        self.rows.iter().map(move |row| outputs.change(row))
    }

    /// The rows with which outputs change.
    pub fn switches(&self) -> usize {
        self.changes().filter(|change| !change.is_none()).count()
    }

    /// Number of steps of all axes, by adding tick by tick.
    pub fn steps(&self) -> u64 {
        let of_axis = |axis: usize| {
            let (mut p, mut steps) = (1_u64 << 63, 0);
            for s in self.segments(axis) {
                let (mut v, mut a) = (s.v, s.a);
                for _ in 0..s.ticks {
                    let (next, carry) = p.overflowing_add(v.cast_unsigned());
                    steps += u64::from(carry != (v < 0));
                    (p, v, a) = (next, v.wrapping_add(a), a.wrapping_add(s.j));
                }
            }
            steps
        };
        (0..self.machine.axes.len()).map(of_axis).sum()
    }
}
