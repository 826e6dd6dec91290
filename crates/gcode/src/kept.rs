//! What a machine keeps from one program to the next: work offsets, stored places, tool length.

use crate::canon::{AXES, Point};
use crate::state::{State, numbers};

/// Number of coordinate systems, G54 to G59.3.
const SYSTEMS: usize = 9;

/// Offsets that outlive a program: the origins and rotations of G54 to G59.3, G92, the places of
/// G28 and G30, and the tool length in effect.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Offsets {
    /// Numbers and values of the parameters that are not 0, in the order of their numbers: in mm and
    /// degrees, [`Offsets::NUMBERS`] in all.
    pub parameters: Vec<(u16, f64)>,
    /// Tool length in effect (G43, G43.1): x, y, z in mm, a, b, c in degrees.
    pub tool: Point,
}

impl Offsets {
    /// How many parameters are kept.
    pub const NUMBERS: usize = 2 * AXES + 1 + AXES + SYSTEMS * (AXES + 1);

    /// The numbers of the parameters that are kept: `#5221` is X of G54, for example.
    pub fn numbers() -> impl Iterator<Item = u16> {
        let systems = (0..SYSTEMS).flat_map(|system| {
            let step = system * numbers::SYSTEM_STEP;
            (numbers::ORIGIN..numbers::ORIGIN + AXES)
                .chain([numbers::ROTATION])
                .map(move |number| number + step)
        });
        (numbers::HOME_28..numbers::HOME_28 + AXES)
            .chain(numbers::HOME_30..numbers::HOME_30 + AXES)
            .chain(numbers::G92_ON..=numbers::G92 + AXES - 1)
            .chain(systems)
            .map(|number| number as u16)
    }

    /// Whether no offset is in effect or stored.
    pub fn is_zero(&self) -> bool {
        *self == Self::default()
    }

    /// The value of a parameter; 0 if it is not kept.
    pub fn get(&self, number: u16) -> f64 {
        let found = self.parameters.iter().find(|(known, _)| *known == number);
        found.map_or(0.0, |&(_, value)| value)
    }

    pub(crate) fn of(state: &State) -> Self {
        let value = |number: u16| (number, state.memory.get(number.into()));
        let parameters = Self::numbers().map(value).filter(|(_, value)| *value != 0.0).collect();
        Self { parameters, tool: state.frame.tool }
    }

    pub(crate) fn give(&self, state: &mut State) {
        for number in Self::numbers() {
            state.memory.set(number.into(), self.get(number));
        }
        state.frame.tool = self.tool;
        state.refresh_frame();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_number_is_kept_once_and_in_order() {
        let numbers: Vec<u16> = Offsets::numbers().collect();
        assert_eq!(numbers.len(), Offsets::NUMBERS);
        assert!(numbers.is_sorted_by(|a, b| a < b), "{numbers:?}");
        assert_eq!((numbers[0], numbers.last()), (5161, Some(&5390)));
    }
}
