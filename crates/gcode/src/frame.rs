//! From program coordinates to machine coordinates, and back.
//!
//! ```text
//! machine = rotated(program + G92 offset) + coordinate system + tool offset
//! ```
//!
//! The rotation (R of G10 L2) turns X and Y about the origin of the coordinate system. All lengths
//! are in mm.

use crate::canon::Point;

/// A coordinate further from zero than this, in mm or degrees, is a mistake of the program.
pub(crate) const FURTHEST: f64 = 1e9;

/// The offsets in effect.
#[derive(Debug, Clone, Default)]
pub(crate) struct Frame {
    /// Origin of the coordinate system (G54 to G59.3).
    pub(crate) system: Point,
    /// Offset of G92; zero while it is not in effect.
    pub(crate) g92: Point,
    /// Offset of the tool (G43, G43.1, G43.2).
    pub(crate) tool: Point,
    /// Sine and cosine of the rotation, if there is one.
    sin_cos: Option<(f64, f64)>,
}

impl Frame {
    /// Sets the rotation, counterclockwise.
    pub(crate) fn set_rotation(&mut self, degrees: f64) {
        self.sin_cos = (degrees != 0.0).then(|| degrees.to_radians().sin_cos());
    }

    pub(crate) fn is_rotated(&self) -> bool {
        self.sin_cos.is_some()
    }

    pub(crate) fn to_machine(&self, program: &Point) -> Point {
        let place = self.rotated(std::array::from_fn(|axis| program[axis] + self.g92[axis]));
        std::array::from_fn(|axis| place[axis] + self.system[axis] + self.tool[axis])
    }

    pub(crate) fn to_program(&self, machine: &Point) -> Point {
        let place = std::array::from_fn(|axis| machine[axis] - self.tool[axis] - self.system[axis]);
        let place = self.unrotated(place);
        std::array::from_fn(|axis| place[axis] - self.g92[axis])
    }

    /// The origin of a coordinate system in which a machine place has these program coordinates
    /// (G10 L20).
    pub(crate) fn origin_for(&self, machine: &Point, program: &Point) -> Point {
        let place = self.rotated(std::array::from_fn(|axis| program[axis] + self.g92[axis]));
        std::array::from_fn(|axis| machine[axis] - self.tool[axis] - place[axis])
    }

    /// The tool offset with which a machine place has these program coordinates (G10 L10).
    pub(crate) fn tool_offset_for(&self, machine: &Point, program: &Point) -> Point {
        let place = self.rotated(std::array::from_fn(|axis| program[axis] + self.g92[axis]));
        std::array::from_fn(|axis| machine[axis] - self.system[axis] - place[axis])
    }

    fn rotated(&self, place: Point) -> Point {
        let Some((sin, cos)) = self.sin_cos else { return place };
        let [x, y, rest @ ..] = place;
        let [z, a, b, c] = rest;
        [x * cos - y * sin, x * sin + y * cos, z, a, b, c]
    }

    fn unrotated(&self, place: Point) -> Point {
        let Some((sin, cos)) = self.sin_cos else { return place };
        let [x, y, rest @ ..] = place;
        let [z, a, b, c] = rest;
        [x * cos + y * sin, y * cos - x * sin, z, a, b, c]
    }
}
