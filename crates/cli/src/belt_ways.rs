//! The directions in which crossed belts move x and y, from the positions of their motors.

use carrystep_files::Machine;

/// A direction that is not known well enough: the letter may move either way, or rest.
pub const EITHER: i8 = 0;

/// Fewest steps of a motor from which directions are taken. Positions are read one after the other,
/// so a few steps say nothing.
const LEAST: u32 = 8;

/// The directions in which x and y were last seen moving.
#[derive(Debug, Clone, Default)]
pub struct BeltWays {
    belts: Option<[usize; 2]>,
    before: Option<[i32; 8]>,
    last: [i8; 2],
}

impl BeltWays {
    /// For the belts of a machine, if it has any.
    pub fn new(machine: &Machine) -> Self {
        Self { belts: machine.belts(), ..Self::default() }
    }

    /// Notes the positions of all motors.
    pub fn see(&mut self, positions: &[i32; 8]) {
        let Some(belts) = self.belts else { return };
        let before = *self.before.get_or_insert(*positions);
        let [first, second] = belts.map(|motor| positions[motor].wrapping_sub(before[motor]));
        let most = first.unsigned_abs().max(second.unsigned_abs());
        if most < LEAST {
            return;
        }
        self.before = Some(*positions);
        let (first, second) = (i64::from(first), i64::from(second));
        // A letter that moves by less than an eighth of a motor's way may as well rest.
        self.last = [first + second, first - second].map(|way| {
            if way.unsigned_abs() > u64::from(most / 4) { way.signum() as i8 } else { EITHER }
        });
    }

    /// The axes that may have met a limit where these motors moved, one bit each, and the direction
    /// of each: 1, -1 or [`EITHER`]. Motors that are none of belts have none.
    pub fn met(&self, motors: u8) -> Vec<(usize, i8)> {
        let met = |belts: [usize; 2]| belts.into_iter().zip(self.last).collect();
        let moved = self.belts.filter(|belts| belts.iter().any(|motor| motors >> motor & 1 == 1));
        moved.map_or_else(Vec::new, met)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ways(steps: [i32; 2]) -> [i8; 2] {
        let mut ways = BeltWays { belts: Some([1, 0]), ..BeltWays::default() };
        let at = |[first, second]: [i32; 2]| [second, first, 7, 0, 0, 0, 0, 0];
        ways.see(&at([0, 0]));
        ways.see(&at(steps));
        assert!(ways.met(0b100).is_empty());
        let met = ways.met(0b01);
        assert_eq!([met[0].0, met[1].0], [1, 0]);
        [met[0].1, met[1].1]
    }

    #[test]
    fn letters_move_as_sum_and_difference_of_the_motors() {
        assert_eq!(ways([100, 100]), [1, EITHER]);
        assert_eq!(ways([-100, -99]), [-1, EITHER]);
        assert_eq!(ways([-100, 100]), [EITHER, -1]);
        assert_eq!(ways([0, -100]), [-1, 1]);
        assert_eq!(ways([-90, 40]), [-1, -1]);
        assert_eq!(ways([3, -3]), [EITHER, EITHER]);
    }

    #[test]
    fn slow_motion_adds_up_and_a_rest_changes_nothing() {
        let mut ways = BeltWays { belts: Some([0, 1]), ..BeltWays::default() };
        for step in 0..20 {
            ways.see(&[-step, 0, 0, 0, 0, 0, 0, 0]);
        }
        assert_eq!(ways.met(1), [(0, -1), (1, -1)]);
        ways.see(&[-19, 0, 0, 0, 0, 0, 0, 0]);
        assert_eq!(ways.met(2), [(0, -1), (1, -1)]);
    }
}
