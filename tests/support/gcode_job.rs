//! Programs in G-code as segments for the levels.

use crate::moves::root;
use carrystep_core::{Command, EngineBuild, Program, Segment};
use carrystep_files::Machine;
use carrystep_program::{ProgramError, ProgramFile, Row, Settings, Survey};

/// Lines, an arc, a corner, a rest and a reversal, in a third of a second.
const SHORT: &str =
    "G64 P0.02 F1500\nG1 X0.8 Y0.4\nG3 X0.8 Y1.2 J0.4\nG4 P0.01\nG1 X0 Y0 Z-0.1\nX0.2\n";

/// A planned program.
#[derive(Debug)]
pub struct GcodeJob {
    /// The machine.
    pub machine: Machine,
    /// Its segments: rows of common ticks.
    pub rows: Vec<Row>,
    /// Its figures.
    pub survey: Survey,
}

/// A short program on the machine of `sim/jobs/`.
///
/// # Panics If it cannot be planned.
pub fn short() -> GcodeJob {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("short.ngc");
    std::fs::write(&path, SHORT).expect("a file");
    planned(&path)
}

/// A program of `sim/jobs/`.
///
/// # Panics If it cannot be planned.
pub fn shipped(name: &str) -> GcodeJob {
    planned(&root().join("sim/jobs").join(name))
}

fn planned(path: &std::path::Path) -> GcodeJob {
    let machine_file = root().join("sim/jobs/machine.toml");
    let machine = Machine::load(&machine_file).expect("the machine of the jobs");
    let file = ProgramFile::open(path, machine.clone(), &machine_file, Settings::default())
        .expect("a program");
    let mut rows = Vec::new();
    let survey = Survey::new(&file, |row| {
        rows.push(row.clone());
        Ok::<(), ProgramError>(())
    });
    GcodeJob { machine, rows, survey: survey.expect("a plan") }
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

    /// What a host sends: the segments row by row; all axes start behind the first row.
    pub fn program(&self) -> Program {
        let axes = self.machine.axes.len();
        let mut program: Program = Vec::new();
        for row in &self.rows {
            let of_row = (0..).zip(&row.segments);
            program.extend(of_row.map(|(axis, &segment)| Command::Segment { axis, segment }));
            if program.len() == axes {
                program.push(Command::Start { mask: (1 << axes) - 1 });
            }
        }
        program
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
