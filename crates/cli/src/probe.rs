//! Touching off: a move of one axis that the probe ends, and what becomes of the place at which it
//! has touched.

use crate::failure::Failure;
use crate::jog::JogWish;
use crate::work::{self, OffsetWish, Target};
use carrystep_files::unit::digits;
use carrystep_files::{Axis, Machine, decimal};
use carrystep_program::{Letters, Offsets, Point};
use serde::{Deserialize, Serialize};

/// A move of an axis that the probe ends.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ProbeWish {
    /// The name of the axis.
    pub axis: String,
    /// How far it moves if the probe does not end the move, in its units.
    pub distance: f64,
    /// Greatest speed, units of the axis per minute.
    pub feed: f64,
    /// The move ends where the probe opens, and not where it closes.
    pub away: bool,
    /// How far from the touched place the axis goes back, in its units; it never goes beyond the
    /// place where it began. `None`: it stays.
    pub retract: Option<f64>,
    /// What is set at the touched place.
    pub target: Option<Target>,
    /// How thick the plate is that was touched, in units of the axis.
    pub plate: f64,
}

impl ProbeWish {
    /// The number of the axis.
    ///
    /// # Errors
    /// The machine has no probe or no such axis.
    pub fn axis(&self, machine: &Machine) -> Result<usize, Failure> {
        if !machine.has_probe() {
            return Err(Failure::input(
                "the machine has no probe: give its level with probe = \"high\" or \"low\" in \
                 [machine.inputs], and build its gateware again",
            ));
        }
        let axis = machine.letter_index(&self.axis);
        axis.ok_or_else(|| Failure::input(machine.no_letter(&self.axis)))
    }

    /// The move to its end.
    pub fn way(&self) -> JogWish {
        JogWish {
            distances: vec![(self.axis.clone(), self.distance)],
            feed: Some(self.feed),
            time: None,
            into_limit: false,
        }
    }

    /// The move back behind the touch, if there is one: `touched`, `began` and `rests` are
    /// places of the axis' letter in steps.
    pub fn back(&self, axis: &Axis, [touched, began, rests]: [f64; 3]) -> Option<JogWish> {
        let scale = decimal::to_f64(&axis.steps_per_unit);
        let way = self.retract? * scale * self.distance.signum();
        let to = touched - way;
        let to = if self.distance > 0.0 { to.max(began) } else { to.min(began) };
        let steps = (to - rests).round();
        let distances = vec![(self.axis.clone(), steps / scale)];
        (steps != 0.0).then(|| JogWish { feed: None, distances, ..self.way() })
    }

    /// The offsets behind the touch, where the axes were at this machine place.
    ///
    /// # Errors
    /// An offset beyond what a program may have.
    pub fn offsets(
        &self,
        before: &Offsets,
        (machine, letters): (&Machine, &Letters),
        touched: Point,
    ) -> Result<Option<Offsets>, Failure> {
        let Some(target) = self.target else { return Ok(None) };
        let letter = letters.of_axes()[self.axis(machine)?];
        let wish = OffsetWish { target, values: vec![(letter, self.coordinate())] };
        work::set(before, touched, &wish).map(Some)
    }

    /// The coordinate of the touched place. The plate is between the work, which gets 0, and the
    /// tool. A tool that goes down to the plate, or up from it, is above the work.
    fn coordinate(&self) -> f64 {
        let goes_down = self.distance < 0.0;
        if goes_down == self.away { -self.plate } else { self.plate }
    }

    /// The message where the probe has the wanted state before the move begins.
    pub fn already(&self) -> String {
        let (state, todo) = if self.away {
            ("open", "begin where it touches")
        } else {
            ("closed", "move away from what it touches")
        };
        format!(
            "the probe is {state} before the move begins: {todo}, or look at its wiring and at `probe` \
             in [machine.inputs]"
        )
    }

    /// The message where the probe has not ended the move.
    pub fn missed(&self) -> String {
        let Self { axis, distance, .. } = self;
        let (what, distance) = (self.state(), digits(*distance));
        format!(
            "the probe has not {what}: {axis} rests at the end of the move, {distance} from where it \
             began, and nothing was set"
        )
    }

    /// What the probe does at the touched place: `closed` or `opened`.
    pub const fn state(&self) -> &'static str {
        if self.away { "opened" } else { "closed" }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wish(distance: f64, away: bool) -> ProbeWish {
        let target = Some(Target::System(1));
        ProbeWish {
            axis: "z".to_owned(),
            distance,
            feed: 60.0,
            away,
            retract: None,
            target,
            plate: 1.5,
        }
    }

    #[test]
    fn tool_is_on_the_side_of_the_plate_from_which_it_came() {
        assert_eq!(wish(-20.0, false).coordinate(), 1.5);
        assert_eq!(wish(20.0, false).coordinate(), -1.5);
        assert_eq!(wish(20.0, true).coordinate(), 1.5);
        assert_eq!(wish(-20.0, true).coordinate(), -1.5);
    }
}
