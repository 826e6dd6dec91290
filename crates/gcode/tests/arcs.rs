//! Every point of an arc is on its circle, and its ends are exact.

use crate::support::{canons, point, words};
use carrystep_gcode::{Arc, Canon, Plane, Point};
use proptest::prelude::*;
use proptest::sample::select;
use std::f64::consts::TAU;

/// G code, letters of the axes and of the centre in the order of [`Plane::axes`].
const PLANES: [(&str, &str, &str, Plane); 3] = [
    ("G17", "XYZ", "IJ", Plane::Xy),
    ("G18", "ZXY", "KI", Plane::Zx),
    ("G19", "YZX", "JK", Plane::Yz),
];

proptest! {
    #[test]
    fn every_point_of_an_arc_is_on_its_circle_and_its_ends_are_exact(
        plane in select(&PLANES[..]),
        start in point(), radius in 0.1_f64..500.0,
        angle in 0.0_f64..360.0, end_angle in 0.0_f64..360.0,
        clockwise: bool, turns in 1_u32..4, height in -50.0..50.0, inches: bool,
    ) {
        let (code, letters, offsets, plane) = plane;
        let letter = |index: usize| letters.chars().nth(index).unwrap();
        let [first, second, normal] = plane.axes();
        let unit = if inches { 25.4 } else { 1.0 };
        let on_circle = |degrees: f64| {
            let (sin, cos) = degrees.to_radians().sin_cos();
            [radius * cos, radius * sin]
        };
        let (from, to) = (on_circle(angle), on_circle(end_angle));
        let (x, y) = (start[first] + to[0] - from[0], start[second] + to[1] - from[1]);
        let mut offset = offsets.chars().zip(from.map(|value: f64| -value));
        let (i, j) = (offset.next().unwrap(), offset.next().unwrap());
        let text = format!(
            "{} {code}\nF60\nG0 {}\nG{} {}{x} {}{y} {}{height} {}{} {}{} P{turns}",
            if inches { "G20" } else { "G21" }, words(&start), if clockwise { 2 } else { 3 },
            letter(0), letter(1), letter(2), i.0, i.1, j.0, j.1,
        );
        let found = canons(&text);
        let (from, arc): (Point, Arc) = match &found[..] {
            [Canon::Traverse { to }, Canon::Arc(arc), Canon::End] => (*to, *arc),
            // The start is machine zero.
            [Canon::Arc(arc), Canon::End] => (Point::default(), *arc),
            _ => panic!("{found:?}"),
        };
        prop_assert_eq!(arc.to[first], x * unit);
        prop_assert_eq!(arc.to[second], y * unit);
        prop_assert_eq!(arc.to[normal], height * unit);
        prop_assert_eq!(arc.at(&from, 0.0), from);
        prop_assert_eq!(arc.at(&from, 1.0), arc.to);
        prop_assert_eq!(arc.turns.unsigned_abs(), turns);
        prop_assert_eq!(arc.sweep < 0.0, clockwise);
        let wanted = if clockwise { angle - end_angle } else { end_angle - angle };
        let wanted = wanted.rem_euclid(360.0);
        let swept = arc.sweep.abs().to_degrees() - 360.0 * f64::from(turns - 1);
        let apart = (swept - wanted).abs().min((swept - wanted - 360.0).abs());
        prop_assert!(apart < 1e-6, "{swept} {wanted}");
        let mut last = from;
        for part in 1..=64 {
            let part = f64::from(part) / 64.0;
            let place = arc.at(&from, part);
            let [u, v] = arc.radius_vector(&place);
            let apart: f64 = u.hypot(v) - radius * unit;
            prop_assert!(apart.abs() < 1e-9, "{apart} {text}");
            let rise = from[normal] + (arc.to[normal] - from[normal]) * part;
            prop_assert!((place[normal] - rise).abs() < 1e-9);
            // Continuous: no step is longer than its part of the path.
            let most = arc.sweep.abs() * radius * unit / 64.0 * (1.0 + 1e-6) + 1e-9;
            let step = (place[first] - last[first]).hypot(place[second] - last[second]);
            prop_assert!(step <= most, "{step} {most}");
            last = place;
        }
    }
}

/// The sweep of the only arc of a program, in turns.
fn turns(text: &str) -> f64 {
    match &canons(text)[..] {
        [.., Canon::Arc(arc), Canon::End] => arc.sweep / TAU,
        other => panic!("{other:?}"),
    }
}

#[test]
fn an_arc_that_ends_where_it_starts_is_a_whole_turn() {
    assert_eq!(turns("F60\nG2 I5"), -1.0);
    assert_eq!(turns("F60\nG3 I5 P3"), 3.0);
    assert_eq!(turns("F60\nG3 X0 Y0 Z3 I-0.1 J7"), 1.0);
    // A billionth of a turn further or less is the same place.
    for end in ["0.00000001", "-0.00000001"] {
        for (code, sign) in [("G2", -1.0), ("G3", 1.0)] {
            let found = turns(&format!("F60\n{code} X0 Y{end} I5"));
            assert!((found - sign).abs() < 1e-8, "{found}");
        }
    }
    // A hundredth of a degree is not.
    assert!((turns("F60\nG3 X0 Y-0.001 I5") - 0.001 / (5.0 * TAU)).abs() < 1e-8);
    assert!((turns("F60\nG2 X0 Y-0.001 I5") + 1.0).abs() < 1e-4);
}
