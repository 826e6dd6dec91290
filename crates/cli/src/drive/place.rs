//! Where on its machine a board stands, so that a program can begin there.

use crate::failure::Failure;
use crate::memory::BoardMemory;
use carrystep_files::unit::digits;
use carrystep_files::{Axis, Machine};
use carrystep_program::{AXIS_LETTERS, Letters, Point, Settings};
use std::collections::BTreeMap;

/// A place of the machine.
#[derive(Debug)]
pub struct Place {
    /// Machine coordinates of the letters x, y, z in mm and a, b, c in degrees.
    pub start: [f64; 6],
    /// Of each axis, whether the machine zero of its letter is known, so that `travel` bounds it.
    pub soft: Vec<bool>,
    /// Of each motor, the machine place of its register's zero in steps.
    pub zero: Vec<i64>,
}

impl Place {
    /// The place of a board whose position registers are these.
    ///
    /// An axis with a home table must be homed. `unhomed` lifts this: the present place is zero
    /// then. The zero of an axis without a home table is where the board was configured.
    ///
    /// # Errors
    /// Axes are not homed, or stand beyond their `travel`.
    pub fn find(
        machine: &Machine,
        letters: &Letters,
        memory: &BoardMemory,
        positions: &[i32],
        unhomed: bool,
    ) -> Result<Self, Failure> {
        let mut place =
            Self { start: Settings::default().start, soft: Vec::new(), zero: Vec::new() };
        let mut lost = Vec::new();
        let registers: Vec<f64> = positions.iter().map(|&at| at.into()).collect();
        let mut at = Vec::new();
        for (number, axis) in machine.axes.iter().enumerate() {
            let homed = memory.place(number, positions);
            let homed = homed.filter(|_| !unhomed && axis.home.is_some());
            // Each motor of a gantry has a place of its own.
            let own = match machine.is_crossed(number) {
                true => machine.letter_steps(number, &registers),
                false => registers.get(number).copied().unwrap_or_default(),
            };
            let steps = match homed {
                Some(steps) => steps,
                None if unhomed => 0.0,
                None => own,
            };
            if homed.is_none() && axis.home.is_some() && !unhomed {
                lost.push(axis.name.as_str());
            }
            if homed.is_some() {
                within(axis, steps)?;
            }
            place.soft.push(homed.is_some() && axis.travel.is_some());
            at.push(steps);
        }
        let turned = machine.motor_steps(&at);
        let motor = |number: usize| match machine.is_crossed(number) {
            true => turned[number],
            false => at[number],
        };
        let motors: Vec<f64> = (0..at.len()).map(motor).collect();
        let zero = motors.iter().zip(&registers).map(|(motor, register)| (motor - register) as i64);
        place.zero = zero.collect();
        if lost.is_empty() {
            is_square(machine, &motors)?;
            place.start = letters.place(&motors);
            return Ok(place);
        }
        let (names, are) = (lost.join(", "), if lost.len() == 1 { "is" } else { "are" });
        Err(Failure::input(format!(
            "{names} {are} not homed, so nobody knows where the machine is: `carrystep home` \
             first; --unhomed takes the place where the machine is for its zero and ignores `travel`"
        )))
    }

    /// The machine places in steps of the letters that `travel` bounds, for these positions.
    pub fn bounded_steps(&self, machine: &Machine, positions: &[i32]) -> Vec<Option<f64>> {
        let steps = self.zero.iter().zip(positions);
        let motors: Vec<f64> = steps.map(|(zero, &at)| (zero + i64::from(at)) as f64).collect();
        let soft = self.soft.iter().enumerate();
        soft.map(|(axis, &soft)| soft.then(|| machine.letter_steps(axis, &motors))).collect()
    }

    /// The machine with `travel` only for axes whose zero is known.
    pub fn bounded(&self, machine: &Machine) -> Machine {
        let mut machine = machine.clone();
        for (axis, _) in machine.axes.iter_mut().zip(&self.soft).filter(|(_, soft)| !**soft) {
            axis.travel = None;
        }
        machine
    }
}

/// The machine place, mm and degrees, at which the position registers have these values. `zero` is
/// the machine place of their zeros in steps.
pub fn point_at(letters: &Letters, zero: &[i64], positions: &[f64]) -> Point {
    let steps = zero.iter().zip(positions).map(|(&zero, position)| zero as f64 + position);
    letters.place(&steps.collect::<Vec<_>>())
}

/// The coordinates of a place by the letters of the machine's axes.
pub fn named_point(letters: &Letters, at: &Point) -> BTreeMap<char, f64> {
    letters.all().iter().map(|&letter| (AXIS_LETTERS[letter], at[letter])).collect()
}

/// Refuses to move a letter whose motors are not at one place, so that what they move is not square.
fn is_square(machine: &Machine, motors: &[f64]) -> Result<(), Failure> {
    for (motor, (axis, &steps)) in machine.axes.iter().zip(motors).enumerate() {
        let leader = machine.leader(motor);
        let off = steps - motors[leader];
        if off == 0.0 {
            continue;
        }
        let letter = &axis.letter;
        let (first, off) = (&machine.axes[leader].name, axis.unit.both(off, 0));
        return Err(Failure::input(format!(
            "the motors of {letter} are not at one place: {} is {off} from {first}. `carrystep home \
             {letter}` brings both to one place; on a letter without a home table, align them by hand \
             and configure the board again",
            axis.name
        )));
    }
    Ok(())
}

/// Refuses a program that would begin beyond the travel of an axis.
fn within(axis: &Axis, steps: f64) -> Result<(), Failure> {
    // Half a step of crossed belts is rounding.
    let is_out = |[low, high]: &[i64; 2]| steps < *low as f64 - 0.5 || steps > *high as f64 + 0.5;
    let Some([low, high]) = axis.travel.filter(is_out) else { return Ok(()) };
    let name = &axis.name;
    let [at, low, high] =
        [steps, low as f64, high as f64].map(|steps| digits(steps / axis.unit.steps));
    let unit = &axis.unit.name;
    Err(Failure::input(format!(
        "{name} stands at {at} {unit}, beyond its travel of {low} to {high} {unit}: jog it back \
         with `carrystep jog {name}`"
    )))
}
