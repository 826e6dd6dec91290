//! Keeps the figures of a program while its rows pass, and plans a program once to its end.

use crate::counts::Counts;
use crate::error::ProgramError;
use crate::file::ProgramFile;
use crate::rows::Rows;
use carrystep_core::Segment;
use carrystep_gcode::Offsets;
use carrystep_job::Row;
use carrystep_plan::Peaks;
use carrystep_plan::exact::{speeds, travel};

/// A planned program.
#[derive(Debug, Clone)]
pub struct Survey {
    /// Figures of the program.
    pub counts: Counts,
    /// Whether all lines were of the program itself, and not of files beside it.
    pub one_file: bool,
    /// Length of the job, ticks.
    pub ticks: u64,
    /// Number of rows: segments of each axis.
    pub rows: u64,
    /// The offsets that the machine keeps behind the program.
    pub offsets: Offsets,
    /// Each axis, in the order of the machine file.
    pub axes: Vec<AxisSurvey>,
}

/// What one axis does in a job, exactly, from the integers of its segments.
#[derive(Debug, Clone)]
pub struct AxisSurvey {
    /// Machine place at the beginning, whole steps.
    pub start_steps: i64,
    /// Machine place where the program ends, rounded to whole steps, half away from zero.
    pub end_steps: i64,
    /// Distance of all segments, 2^-64 step.
    pub distance: i128,
    /// Least and greatest machine place of the axis' letter at the ends of rows, 2^-64 step.
    pub extent: [i128; 2],
    /// Greatest speed, acceleration and jerk.
    pub peaks: Peaks,
}

impl AxisSurvey {
    fn add(&mut self, segment: &Segment) {
        let last = i128::from(segment.ticks) - 1;
        let (a, j) = (i128::from(segment.a), i128::from(segment.j));
        let speed = speeds(segment).map(i128::unsigned_abs).max().unwrap_or(0);
        let acceleration = a.unsigned_abs().max((a + last * j).unsigned_abs());
        let units = |value: u128| u64::try_from(value).unwrap_or(u64::MAX);
        self.peaks = self.peaks.with(&Peaks {
            speed: units(speed),
            acceleration: units(acceleration),
            jerk: units(j.unsigned_abs()),
            start_speed: 0,
        });
        self.distance += travel(segment, segment.ticks.into());
    }

    /// The machine place of the motor where the last row ends, 2^-64 step.
    fn place(&self) -> i128 {
        (i128::from(self.start_steps) << 64) + self.distance
    }

    /// Steps from the start to the end of the program.
    pub fn steps(&self) -> i64 {
        self.end_steps - self.start_steps
    }

    /// Distance of the segments beyond the steps from start to end, 2^-64 step: exactly 0 if the
    /// job lands, and then P ends at its start value.
    pub fn residue(&self) -> i128 {
        self.distance - (i128::from(self.steps()) << 64)
    }
}

/// The rows of a program, whose figures are kept as they pass. After an error there are no more.
#[derive(Debug)]
pub struct SurveyedRows {
    rows: Rows,
    ticks: u64,
    count: u64,
    axes: Vec<AxisSurvey>,
    /// For each axis, the motors that its letter is a sum of, each with its sign: their mean is its
    /// place.
    letters: Vec<Vec<(usize, i128)>>,
}

impl SurveyedRows {
    /// Plans a program from its beginning.
    ///
    /// # Errors
    /// As [`Rows::new`].
    pub fn new(file: &ProgramFile) -> Result<Self, ProgramError> {
        let axis = |start_steps: i64| AxisSurvey {
            start_steps,
            end_steps: start_steps,
            distance: 0,
            extent: [i128::MAX, i128::MIN],
            peaks: Peaks::default(),
        };
        let axes = file.start_steps().into_iter().map(axis).collect();
        let machine = file.machine();
        let letter = |axis: usize| {
            let sign = |motor: usize| (motor, machine.coefficient(motor, axis).into());
            machine.leaders().into_iter().map(sign).filter(|(_, sign)| *sign != 0).collect()
        };
        let letters = (0..machine.axes.len()).map(letter).collect();
        let mut this = Self { rows: Rows::new(file)?, ticks: 0, count: 0, axes, letters };
        this.reach();
        Ok(this)
    }

    /// Notes the places of the letters.
    fn reach(&mut self) {
        for (axis, motors) in self.letters.iter().enumerate() {
            let sum: i128 =
                motors.iter().map(|&(motor, sign)| sign * self.axes[motor].place()).sum();
            let place = sum / motors.len() as i128;
            let [least, most] = self.axes[axis].extent;
            self.axes[axis].extent = [least.min(place), most.max(place)];
        }
    }

    /// The survey of the rows that have passed; after the last one, of the program.
    pub fn finish(self, file: &ProgramFile) -> Survey {
        let Self { rows, ticks, count, mut axes, .. } = self;
        for (axis, end_steps) in axes.iter_mut().zip(file.steps(rows.end())) {
            axis.end_steps = end_steps;
        }
        let (counts, one_file) = (rows.counts().clone(), rows.one_file());
        let offsets = rows.offsets();
        Survey { counts, one_file, ticks, rows: count, offsets, axes }
    }
}

impl Iterator for SurveyedRows {
    type Item = Result<Row, ProgramError>;

    fn next(&mut self) -> Option<Self::Item> {
        let row = self.rows.next()?;
        if let Ok(row) = &row {
            self.ticks += u64::from(row.ticks);
            self.count += 1;
            for (axis, segment) in self.axes.iter_mut().zip(&row.segments) {
                axis.add(segment);
            }
            self.reach();
        }
        Some(row)
    }
}

impl Survey {
    /// Plans a program to its end. `watch` sees each row.
    ///
    /// # Errors
    /// The first mistake of the program, the first move that the planner refuses, or the first
    /// error of `watch`.
    pub fn new<E: From<ProgramError>>(
        file: &ProgramFile,
        mut watch: impl FnMut(&Row) -> Result<(), E>,
    ) -> Result<Self, E> {
        let mut rows = SurveyedRows::new(file)?;
        for row in rows.by_ref() {
            watch(&row?)?;
        }
        Ok(rows.finish(file))
    }

    /// Whether every axis ends exactly at its target, P included.
    pub fn landed(&self) -> bool {
        self.axes.iter().all(|axis| axis.residue() == 0)
    }
}
