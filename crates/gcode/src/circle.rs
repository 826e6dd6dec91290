//! Geometry in a plane: polar coordinates, and of arcs the centre from R, the radii that must
//! agree, and the angle from start to end. All lengths are in mm.

use crate::error::ErrorKind;
use std::f64::consts::TAU;

/// A point or a vector in the plane of an arc.
pub(crate) type Vector = [f64; 2];

/// A distance in mm and an angle in degrees from the first axis of the plane XY.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Polar {
    pub(crate) radius: f64,
    pub(crate) angle: f64,
}

impl Polar {
    /// X and Y.
    pub(crate) fn place(self) -> Vector {
        let (sin, cos) = self.angle.to_radians().sin_cos();
        [self.radius * cos, self.radius * sin]
    }
}

/// Radii that differ by at most this, in mm, make a spiral.
const RADII_ABSOLUTE: f64 = 0.005;
/// So do radii that differ by at most this part of the greater one ...
const RADII_RELATIVE: f64 = 0.001;
/// ... but by no more than this, in mm.
const RADII_GREATEST: f64 = 0.5;

/// A radius below this, in mm, is none: the direction of the centre would be a rounding error.
const LEAST_RADIUS: f64 = 1e-9;

/// An arc that would turn by less than this, in radians, is a whole turn: its ends are the same
/// place except for rounding (Grbl 1.1, `ARC_ANGULAR_TRAVEL_EPSILON`).
const WHOLE_TURN: f64 = 5e-7;

/// Checks that an arc around `centre` goes from `start` to `end`.
///
/// # Errors
/// No radius, or radii that differ too much.
pub(crate) fn check(centre: Vector, start: Vector, end: Vector) -> Result<(), ErrorKind> {
    let radius = |place: Vector| (place[0] - centre[0]).hypot(place[1] - centre[1]);
    let (start, end) = (radius(start), radius(end));
    if start.min(end) < LEAST_RADIUS {
        return Err(ErrorKind::ArcNoRadius);
    }
    let difference = (start - end).abs();
    let relative = RADII_RELATIVE * start.max(end);
    if difference > RADII_GREATEST || difference > RADII_ABSOLUTE && difference > relative {
        return Err(ErrorKind::ArcRadii { start, end, difference });
    }
    Ok(())
}

/// The centre of an arc by radius: with a positive radius it turns by at most half a turn, with a
/// negative one by at least half a turn.
///
/// # Errors
/// Ends at the same place, or further apart than the diameter.
pub(crate) fn centre_by_radius(
    start: Vector,
    end: Vector,
    radius: f64,
    clockwise: bool,
) -> Result<Vector, ErrorKind> {
    let chord = [end[0] - start[0], end[1] - start[1]];
    let distance = chord[0].hypot(chord[1]);
    if distance < LEAST_RADIUS {
        return Err(ErrorKind::ArcSamePoint);
    }
    let half = distance / 2.0;
    if half - radius.abs() > RADII_ABSOLUTE {
        return Err(ErrorKind::ArcTooSmall { diameter: 2.0 * radius.abs(), distance });
    }
    // The product has fewer rounding errors than the difference of squares.
    let height = ((radius.abs() - half) * (radius.abs() + half)).max(0.0).sqrt();
    let to_left = if clockwise == (radius > 0.0) { -height } else { height };
    Ok([
        (start[0] + end[0]) / 2.0 - chord[1] / distance * to_left,
        (start[1] + end[1]) / 2.0 + chord[0] / distance * to_left,
    ])
}

/// The angle from start to end in radians, positive counterclockwise, with `turns` - 1 whole turns.
pub(crate) fn sweep(
    centre: Vector,
    start: Vector,
    end: Vector,
    clockwise: bool,
    turns: u32,
) -> f64 {
    let from = [start[0] - centre[0], start[1] - centre[1]];
    let to = [end[0] - centre[0], end[1] - centre[1]];
    let cross = from[0] * to[1] - from[1] * to[0];
    let dot = from[0] * to[0] + from[1] * to[1];
    let sign = if clockwise { -1.0 } else { 1.0 };
    let mut angle = sign * cross.atan2(dot);
    if angle <= WHOLE_TURN {
        angle += TAU;
    }
    sign * (angle + f64::from(turns.saturating_sub(1)) * TAU)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::f64::consts::PI;

    fn vector() -> impl Strategy<Value = Vector> {
        [-100.0..100.0, -100.0..100.0]
    }

    proptest! {
        #[test]
        fn centre_by_radius_has_that_distance_from_both_ends_and_lies_on_the_right_side(
            start in vector(), end in vector(), beyond in 0.0..100.0, major: bool, clockwise: bool,
        ) {
            let distance: f64 = (end[0] - start[0]).hypot(end[1] - start[1]);
            prop_assume!(distance > 1e-3);
            let radius: f64 = distance / 2.0 + beyond;
            let signed = if major { -radius } else { radius };
            let centre = centre_by_radius(start, end, signed, clockwise).unwrap();
            for place in [start, end] {
                let found = (place[0] - centre[0]).hypot(place[1] - centre[1]);
                prop_assert!((found - radius).abs() < 1e-9, "{found} {radius}");
            }
            let angle = sweep(centre, start, end, clockwise, 1);
            prop_assert_eq!(angle < 0.0, clockwise);
            let slack = if beyond < 1e-6 { 1e-2 } else { 1e-9 };
            let is_major = angle.abs() > PI;
            prop_assert!(is_major == major || (angle.abs() - PI).abs() < slack, "{angle}");
        }

        #[test]
        fn turning_the_start_by_the_sweep_gives_the_end(
            centre in vector(), start in vector(), to in -TAU..TAU, clockwise: bool,
            turns in 1_u32..5,
        ) {
            let from = [start[0] - centre[0], start[1] - centre[1]];
            prop_assume!(from[0].hypot(from[1]) > 0.1);
            let turned = |angle: f64| {
                let (sin, cos) = angle.sin_cos();
                [
                    centre[0] + from[0] * cos - from[1] * sin,
                    centre[1] + from[0] * sin + from[1] * cos,
                ]
            };
            let end = turned(to);
            let angle = sweep(centre, start, end, clockwise, turns);
            prop_assert!((f64::from(turns) - 1.0) * TAU < angle.abs());
            prop_assert!(angle.abs() <= f64::from(turns) * TAU + WHOLE_TURN);
            let found = turned(angle);
            prop_assert!((found[0] - end[0]).hypot(found[1] - end[1]) < 1e-9);
        }
    }

    #[test]
    fn radii_may_differ_by_5_um_or_by_a_thousandth_and_half_a_millimetre() {
        let differs = |radius: f64, by: f64| check([0.0; 2], [radius, 0.0], [0.0, radius + by]);
        assert_eq!(differs(1.0, 0.0049), Ok(()));
        assert!(matches!(differs(1.0, 0.0051), Err(ErrorKind::ArcRadii { .. })));
        assert_eq!(differs(100.0, 0.0999), Ok(()));
        assert!(matches!(differs(100.0, 0.11), Err(ErrorKind::ArcRadii { .. })));
        assert_eq!(differs(10_000.0, 0.499), Ok(()));
        assert!(matches!(differs(10_000.0, 0.501), Err(ErrorKind::ArcRadii { .. })));
    }
}
