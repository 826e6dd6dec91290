//! The directions in which axes begin to move along an element of a path.

use carrystep_job::{Arc, Element};

/// An axis whose coordinate differs by no more does not move, mm or degrees.
const STANDS: f64 = 1e-6;

/// The direction in which each axis moves where an element begins that leads away from this place.
pub(crate) fn directions(from: &[f64], Element { to, arc, .. }: &Element) -> Vec<i8> {
    let sign = |value: f64| match value {
        value if value > STANDS => 1,
        value if value < -STANDS => -1,
        _ => 0,
    };
    let mut directions: Vec<i8> = to.iter().zip(from).map(|(to, from)| sign(to - from)).collect();
    if let Some(Arc { plane: [a, b], centre, angle }) = arc {
        let (x, y) = (from[*a] - centre[0], from[*b] - centre[1]);
        let turn = angle.signum();
        // Where an arc begins across an axis, that axis goes toward the centre.
        let toward = |along: f64, off: f64| match sign(along) {
            0 => sign(-off),
            way => way,
        };
        (directions[*a], directions[*b]) = (toward(-turn * y, x), toward(turn * x, y));
    }
    directions
}

#[cfg(test)]
mod tests {
    use super::*;
    use carrystep_job::Tolerance;
    use std::f64::consts::PI;

    fn element(to: [f64; 3], arc: Option<Arc>) -> Element {
        let tolerance = Tolerance { linear: 0.01, rotary: 0.01 };
        Element { to: to.to_vec(), arc, feed: Some(1.0), tolerance, line: 1, block: 1 }
    }

    #[test]
    fn line_goes_toward_its_end() {
        let ways = |to| directions(&[1.0, 2.0, 3.0], &element(to, None));
        assert_eq!(ways([2.0, 2.0, -3.0]), [1, 0, -1]);
        assert_eq!(ways([1.0, 2.0, 3.0 + 1e-9]), [0, 0, 0]);
    }

    /// Around the origin from the right: at first y goes up or down, and x back.
    #[test]
    fn arc_begins_along_its_tangent_and_across_it_toward_the_centre() {
        let ways = |from: [f64; 3], angle: f64| {
            let arc = Arc { plane: [0, 1], centre: [0.0, 0.0], angle };
            directions(&from, &element([from[0], from[1], 4.0], Some(arc)))
        };
        assert_eq!(ways([5.0, 0.0, 3.0], 2.0 * PI), [-1, 1, 1]);
        assert_eq!(ways([5.0, 0.0, 5.0], -2.0 * PI), [-1, -1, -1]);
        assert_eq!(ways([0.0, -5.0, 4.0], 2.0 * PI), [1, 1, 0]);
        assert_eq!(ways([-3.0, 4.0, 4.0], 2.0 * PI), [-1, -1, 0]);
        assert_eq!(ways([-3.0, 4.0, 4.0], -2.0 * PI), [1, 1, 0]);
    }
}
