//! Which motors of the machine are which letter of a program.

use crate::error::Fault;
use crate::letter::{LINEAR, letter_of, unit};
use carrystep_core::StartPhase;
use carrystep_files::{Machine, decimal};
use carrystep_gcode::{AXES, Point};

/// The letters of a machine's motors.
#[derive(Debug, Clone)]
pub struct Letters {
    /// The letter of each motor in the order of the machine file, as an index of a [`Point`].
    of_axis: Vec<usize>,
    /// The letters in the order of their first motors.
    planned: Vec<usize>,
    /// The first motor of each letter.
    axis_of: [Option<usize>; AXES],
    /// How far a step of each motor moves the tool: x, y, z in mm, a, b, c in degrees. Of several
    /// motors of a letter, the first one moves it, and the others move nothing.
    moves: Vec<Point>,
    /// One step of each letter, mm or degrees; 0 for letters without an axis.
    step: Point,
}

impl Letters {
    /// The letters of a machine.
    ///
    /// # Errors
    /// A [`Fault`] if jobs cannot be planned for this machine: an axis is not called x, y, z, a, b
    /// or c, has a wrong unit, or is in a wrong order, or moves do not start half a step away from
    /// the next step.
    pub fn new(machine: &Machine) -> Result<Self, Fault> {
        if machine.phase != StartPhase::Half {
            return Err(Fault::Phase);
        }
        let mut letters = Self {
            of_axis: Vec::new(),
            planned: Vec::new(),
            axis_of: [None; AXES],
            moves: Vec::new(),
            step: [0.0; AXES],
        };
        for (number, axis) in machine.axes.iter().enumerate() {
            let letter = letter_of(&axis.letter);
            let letter = letter.ok_or_else(|| Fault::AxisName(axis.name.clone()))?;
            let wanted = unit(letter);
            let unit = axis.unit.name.as_str();
            // An axis without a unit in its file is taken to be in mm or degrees.
            if unit != wanted && unit != "units" {
                return Err(Fault::Unit { axis: axis.name.clone(), unit: unit.into(), wanted });
            }
            letters.of_axis.push(letter);
            if letters.axis_of[letter].is_some() {
                continue;
            }
            if letter < LINEAR && letters.planned.iter().any(|&before| before >= LINEAR) {
                return Err(Fault::Order(axis.name.clone()));
            }
            letters.planned.push(letter);
            letters.axis_of[letter] = Some(number);
        }
        for motor in 0..machine.axes.len() {
            letters.moves.push(letters.moves_of(machine, motor));
        }
        for (letter, step) in letters.step.iter_mut().enumerate() {
            // Letters that share motors have a part of a step of each of them.
            *step = letters.moves.iter().fold(0.0, |sum: f64, moves| sum.hypot(moves[letter]));
        }
        Ok(letters)
    }

    /// How far a step of a motor moves the tool.
    fn moves_of(&self, machine: &Machine, motor: usize) -> Point {
        let mut moves = Point::default();
        if machine.leader(motor) != motor {
            return moves;
        }
        let mut one = vec![0.0; machine.axes.len()];
        one[motor] = 1.0;
        for &letter in &self.planned {
            let Some(axis) = self.axis(letter) else { continue };
            let step = 1.0 / decimal::to_f64(&machine.axes[axis].steps_per_unit);
            moves[letter] = machine.letter_steps(axis, &one) * step;
        }
        moves
    }

    /// The letter of each motor, in the order of the machine file, as an index of a [`Point`].
    pub fn of_axes(&self) -> &[usize] {
        &self.of_axis
    }

    /// The letters in the order of their first motors, each once.
    pub fn all(&self) -> &[usize] {
        &self.planned
    }

    /// The first motor of a letter, if the machine has one.
    pub fn axis(&self, letter: usize) -> Option<usize> {
        self.axis_of.get(letter).copied().flatten()
    }

    /// The number of a letter among those of the machine.
    pub(crate) fn number(&self, letter: usize) -> Option<usize> {
        self.planned.iter().position(|&known| known == letter)
    }

    /// The place at which the motors are so many steps from machine zero. All motors of a letter are
    /// at one place: the first one says which.
    pub fn place(&self, steps: &[f64]) -> Point {
        let mut at = Point::default();
        for (moves, steps) in self.moves.iter().zip(steps) {
            for &letter in &self.planned {
                at[letter] += moves[letter] * steps;
            }
        }
        at
    }

    /// How far a step of each motor moves the tool, in the order of the machine file: x, y, z in mm,
    /// a, b, c in degrees. Of several motors of a letter, all but the first one move nothing.
    pub fn moves(&self) -> &[Point] {
        &self.moves
    }

    /// One step of each letter, mm or degrees; 0 for letters without an axis. On crossed belts a step
    /// of either motor moves the tool by so much, along a diagonal.
    pub fn step(&self) -> &Point {
        &self.step
    }

    /// Number of letters that are in mm; they come first.
    pub(crate) fn linear(&self) -> usize {
        self.planned.iter().filter(|&&letter| letter < LINEAR).count()
    }

    /// The coordinates of the machine's letters, in the order of their first motors.
    pub(crate) fn coordinates(&self, place: &Point) -> Vec<f64> {
        self.planned.iter().map(|&letter| place[letter]).collect()
    }

    /// The finest step of the axes in mm, and of those in degrees, if there are any.
    pub(crate) fn finest(&self) -> [Option<f64>; 2] {
        let least = |steps: &[f64]| steps.iter().copied().filter(|&s| s > 0.0).reduce(f64::min);
        let (linear, rotary) = self.step.split_at(LINEAR);
        [least(linear), least(rotary)]
    }
}
