//! `kinematics`: which motors move a letter.
//!
//! On a cartesian machine each letter has its own motors. Two crossed belts (CoreXY) let both motors
//! at the frame move the tool along x and along y:
//!
//! ```text
//!  motor of the axis x:  A = x + y        x = (A + B) / 2
//!  motor of the axis y:  B = x - y        y = (A - B) / 2
//! ```
//!
//! These are the equations of the machine's author (I. Moyer, corexy.com, 2012). Klipper and Grbl use
//! the same ones. The motors have the same steps per unit, so a step along a letter is a step of both
//! motors, and all places of the tool are whole halves of a step.

use super::{Axis, Machine, gantry};
use crate::error::{InputError, SourceText};
use carrystep_core::build::Timebase;
use carrystep_core::engine::LimitWiring;
use serde::Deserialize;
use std::ops::Range;

/// How the motors follow from the letters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Kinematics {
    /// Each letter has its own motors.
    #[default]
    Cartesian,
    /// Two crossed belts: the motor of the axis x makes x + y, that of the axis y makes x - y. The
    /// other letters have their own motors.
    CoreXy,
}

impl Kinematics {
    /// Its name in machine files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Cartesian => "cartesian",
            Self::CoreXy => "corexy",
        }
    }
}

impl Machine {
    /// How many steps a motor makes when the letter of an axis moves up by one step: 1, -1 or 0.
    pub fn coefficient(&self, motor: usize, axis: usize) -> i8 {
        let [motor, axis] = [motor, axis].map(|number| self.axes[number].letter.as_str());
        match (self.kinematics, motor, axis) {
            (Kinematics::CoreXy, "x" | "y", "x") | (Kinematics::CoreXy, "x", "y") => 1,
            (Kinematics::CoreXy, "y", "y") => -1,
            _ => i8::from(motor == axis),
        }
    }

    /// The numbers of the axes x and y, if crossed belts move them.
    pub fn belts(&self) -> Option<[usize; 2]> {
        let [x, y] = belts(&self.axes);
        x.zip(y).filter(|_| self.kinematics == Kinematics::CoreXy).map(|(x, y)| [x, y])
    }

    /// What the motor of an axis makes on crossed belts, as an expression of letters; `None` for all
    /// other axes.
    pub fn belt(&self, motor: usize) -> Option<&'static str> {
        let belt = if self.axes[motor].letter == "x" { "x + y" } else { "x - y" };
        self.is_crossed(motor).then_some(belt)
    }

    /// Whether the letter of an axis is moved by two crossed belts, both of which also move another
    /// letter.
    pub fn is_crossed(&self, axis: usize) -> bool {
        self.kinematics == Kinematics::CoreXy && matches!(&*self.axes[axis].letter, "x" | "y")
    }

    /// All motors that move when the letter of an axis does, one bit each.
    pub fn motors_of(&self, axis: usize) -> u8 {
        let moves = |motor: &usize| self.coefficient(*motor, axis) != 0;
        (0..self.axes.len()).filter(moves).fold(0, |mask, motor| mask | 1 << motor)
    }

    /// The motors that an axis moves when it homes, as two masks: those that run in the direction of
    /// its letter, and those that run against it. Motors of one letter home on their own.
    pub fn homing_motors(&self, axis: usize) -> [u8; 2] {
        if !self.is_crossed(axis) {
            return [1 << axis, 0];
        }
        let that = |way: i8| {
            let motors = (0..self.axes.len()).filter(|&one| self.coefficient(one, axis) == way);
            motors.fold(0, |mask, motor| mask | 1 << motor)
        };
        [1, -1].map(that)
    }

    /// The steps of each motor when the letters have moved by so many steps: those of each axis, of
    /// which the first one of a letter counts.
    pub fn motor_steps(&self, letters: &[f64]) -> Vec<f64> {
        let leaders = self.leaders();
        let steps = |motor: usize| {
            let of = |&axis: &usize| {
                f64::from(self.coefficient(motor, axis))
                    * letters.get(axis).copied().unwrap_or_default()
            };
            leaders.iter().map(of).sum()
        };
        (0..self.axes.len()).map(steps).collect()
    }

    /// The place of the letter of an axis when the motors are at these steps. Of several motors of a
    /// letter, the first one counts. For whole steps the result is exact: a whole number, or one and
    /// a half on crossed belts.
    pub fn letter_steps(&self, axis: usize, motors: &[f64]) -> f64 {
        let (mut sum, mut count) = (0.0, 0.0);
        for motor in self.leaders() {
            let coefficient = f64::from(self.coefficient(motor, axis));
            sum += coefficient * motors.get(motor).copied().unwrap_or_default();
            count += coefficient.abs();
        }
        sum / count
    }

    /// How far the tool moves with one step of a motor, in steps of its letter: 1, or the root of a
    /// half on crossed belts, whose motors move the tool along the diagonals.
    pub fn step_of_tool(&self, motor: usize) -> f64 {
        if self.is_crossed(motor) { std::f64::consts::FRAC_1_SQRT_2 } else { 1.0 }
    }
}

/// The axes of crossed belts by their numbers, first that of x.
fn belts(axes: &[Axis]) -> [Option<usize>; 2] {
    ["x", "y"].map(|letter| axes.iter().position(|axis| axis.letter == letter))
}

/// Makes the motors of crossed belts equal, or refuses a machine that cannot be one. `place` is that
/// of the key, `names` are those of the axes' names.
pub(super) fn cross(
    source: &SourceText,
    timebase: &Timebase,
    axes: &mut [Axis],
    place: Range<usize>,
    names: &[Range<usize>],
) -> Result<(), InputError> {
    let [Some(x), Some(y)] = belts(axes) else {
        let missing = if belts(axes)[0].is_none() { "x" } else { "y" };
        let message = format!("kinematics = \"corexy\", and the machine has no axis {missing}");
        return Err(InputError::at(source, place, message)
            .help("give it the axes x and y: their motors are those of the two belts"));
    };
    let another = |number: usize| {
        let letter = &*axes[number].letter;
        number != x && number != y && matches!(letter, "x" | "y")
    };
    if let Some(number) = (0..axes.len()).find(|&number| another(number)) {
        let Axis { name, letter, .. } = &axes[number];
        let message = format!(
            "the motor '{name}' is a second one of {letter}, whose belts have a motor each"
        );
        return Err(InputError::at(source, names[number].clone(), message).help(
            "on a machine with kinematics = \"corexy\", x and y have one axis each; other letters may \
             have several motors",
        ));
    }
    let span = names[x.max(y)].clone();
    if axes[x].steps_per_unit != axes[y].steps_per_unit {
        let [first, second] = [x, y].map(|number| axes[number].unit.steps);
        let message = format!("the motors of x and y have {first} and {second} steps per unit");
        return Err(InputError::at(source, span, message).help(
            "along x and y both belts run equally far: give both motors the same steps_per_unit, by \
             their microsteps",
        ));
    }
    if axes[x].unit.name != axes[y].unit.name {
        let [first, second] = [x, y].map(|number| &axes[number].unit.name);
        let message = format!("the motors of x and y are in {first} and {second}");
        return Err(InputError::at(source, span, message).help("give both the same unit"));
    }
    gantry::make_equal(axes, x, y);
    axes[x].check_speed(source, span, timebase)
}

/// Refuses switches and homing that crossed belts cannot have. `homes` are the places of the home
/// tables.
pub(super) fn check_switches(
    source: &SourceText,
    axes: &[Axis],
    limits: LimitWiring,
    place: Range<usize>,
    homes: &[Option<Range<usize>>],
) -> Result<(), InputError> {
    let wired = match limits {
        LimitWiring::Pair => Some("pair"),
        LimitWiring::Each => Some("each"),
        LimitWiring::One | LimitWiring::None => None,
    };
    if let Some(wired) = wired {
        let message = format!("kinematics = \"corexy\" with limits = \"{wired}\" in machine.guard");
        return Err(InputError::at(source, place, message).help(
            "there, the guard looks at the switch of an axis while the motor of this axis moves, and \
             in a move at 45 degrees one motor of crossed belts rests. Connect all switches to one \
             input, with limits = \"one\", or give limits = \"none\"",
        ));
    }
    let [Some(x), Some(y)] = belts(axes) else { return Ok(()) };
    if axes[x].home.is_some() == axes[y].home.is_some() {
        return Ok(());
    }
    let (with, without) = if axes[x].home.is_some() { (x, y) } else { (y, x) };
    let [named, other] = [with, without].map(|number| &axes[number].letter);
    let message = format!("{named} has a home table, and {other} has none");
    Err(InputError::at(source, homes[with].clone().unwrap_or_default(), message).help(
        "where the motors of crossed belts are is known only if both letters are homed: give both a \
         home table, or none",
    ))
}
