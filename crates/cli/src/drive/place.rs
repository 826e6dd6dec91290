//! Where on its machine a board stands, so that a program can begin there.

use crate::failure::Failure;
use crate::memory::BoardMemory;
use carrystep_files::unit::digits;
use carrystep_files::{Axis, Machine, decimal};
use carrystep_program::{AXIS_LETTERS, Letters, Point, Settings};
use std::collections::BTreeMap;

/// A place of the machine.
#[derive(Debug)]
pub struct Place {
    /// Machine coordinates of the letters x, y, z in mm and a, b, c in degrees.
    pub start: [f64; 6],
    /// Of each axis, whether its machine zero is known, so that `travel` bounds it.
    pub soft: Vec<bool>,
    /// Of each axis, the machine place of its register's zero in steps.
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
        for (number, (axis, &letter)) in machine.axes.iter().zip(letters.of_axes()).enumerate() {
            let position = i64::from(positions.get(number).copied().unwrap_or_default());
            let homed = memory.offset(number).filter(|_| !unhomed && axis.home.is_some());
            let steps = match homed {
                Some(offset) => position.saturating_add(offset),
                None if unhomed => 0,
                None => position,
            };
            if homed.is_none() && axis.home.is_some() && !unhomed {
                lost.push(axis.name.as_str());
            }
            if homed.is_some() {
                within(axis, steps)?;
            }
            place.soft.push(homed.is_some() && axis.travel.is_some());
            place.zero.push(steps.saturating_sub(position));
            place.start[letter] = steps as f64 / decimal::to_f64(&axis.steps_per_unit);
        }
        if lost.is_empty() {
            return Ok(place);
        }
        let (names, are) = (lost.join(", "), if lost.len() == 1 { "is" } else { "are" });
        Err(Failure::input(format!(
            "{names} {are} not homed, so nobody knows where the machine is: `carrystep home` \
             first; --unhomed takes the place where the machine is for its zero and ignores `travel`"
        )))
    }

    /// The machine places in steps of the axes that `travel` bounds, for these positions.
    pub fn bounded_steps(&self, positions: &[i32]) -> Vec<Option<i64>> {
        let steps = self.zero.iter().zip(positions).zip(&self.soft);
        steps.map(|((zero, &at), &soft)| soft.then(|| zero + i64::from(at))).collect()
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
    let mut at = Point::default();
    for (&letter, (&zero, position)) in letters.of_axes().iter().zip(zero.iter().zip(positions)) {
        at[letter] = (zero as f64 + position) * letters.step()[letter];
    }
    at
}

/// The coordinates of a place by the letters of the machine's axes.
pub fn named_point(letters: &Letters, at: &Point) -> BTreeMap<char, f64> {
    letters.of_axes().iter().map(|&letter| (AXIS_LETTERS[letter], at[letter])).collect()
}

/// Refuses a program that would begin beyond the travel of an axis.
fn within(axis: &Axis, steps: i64) -> Result<(), Failure> {
    let Some([low, high]) = axis.travel.filter(|[low, high]| !(*low..=*high).contains(&steps))
    else {
        return Ok(());
    };
    let name = &axis.name;
    let [at, low, high] = [steps, low, high].map(|steps| digits(steps as f64 / axis.unit.steps));
    let unit = &axis.unit.name;
    Err(Failure::input(format!(
        "{name} stands at {at} {unit}, beyond its travel of {low} to {high} {unit}: jog it back \
         with `carrystep jog {name}`"
    )))
}
