//! Random paths: every plan keeps limits and rhythm in exact integers, lands exactly, and passes its
//! marks in order; none is refused. Bad elements are refused with their lines.

use crate::common;
use crate::common::follow::{deviation, within};
use crate::common::free_space::Programmed;
use crate::common::replay::Replay;
use carrystep_job::{Arc, Element, Item, JobError, Planner, Tolerance, rows};
use proptest::prelude::*;

/// A machine of three axes with these limits; a jerk limit of 0 is left out.
fn machine_text(speed: f64, acceleration: f64, jerk: f64) -> String {
    let mut text = String::from("[machine]\nclock_hz = 80_000_000\ntick_ns = 1000\n");
    for (name, steps, part) in [("x", 80.0, 1.0), ("y", 80.0, 1.0), ("z", 400.0, 0.5)] {
        text += &format!(
            "[[machine.axis]]\nname = \"{name}\"\nsteps_per_unit = {steps}\n\
             speed_limit = {}\naccel_limit = {}\ndriver = \"tmc2209\"\n",
            speed * part,
            acceleration * part
        );
        if jerk > 0.0 {
            text += &format!("jerk_limit = {}\n", jerk * part);
        }
    }
    text
}

/// How an element goes on: by a line of this size and direction, or by an arc of this radius and
/// angle with this rise.
#[derive(Debug, Clone)]
enum Shape {
    Line { size: f64, to: [f64; 3] },
    Back,
    Arc { radius: f64, angle: f64, rise: f64, from: f64 },
    Rest { dwell: f64 },
    Mark,
}

fn shapes() -> impl Strategy<Value = Vec<Shape>> {
    let direction = prop::array::uniform3(-1.0..1.0_f64);
    let shape = prop_oneof![
        6 => (-2.5..1.3_f64, direction).prop_map(|(size, to)| Shape::Line { size: 10_f64.powf(size), to }),
        1 => Just(Shape::Back),
        2 => (-1.0..1.2_f64, -6.2..6.2_f64, -1.0..1.0_f64, 0.0..6.3_f64).prop_map(
            |(radius, angle, rise, from)| Shape::Arc { radius: 10_f64.powf(radius), angle, rise, from }
        ),
        1 => (0.0..0.1_f64).prop_map(|dwell| Shape::Rest { dwell }),
        1 => Just(Shape::Mark),
    ];
    prop::collection::vec(shape, 1..40)
}

fn items(shapes: &[Shape], feed: f64, tolerance: f64) -> Vec<Item> {
    let (mut at, mut before) = ([0.0_f64; 3], [0.0_f64; 3]);
    let mut items = Vec::new();
    for (number, shape) in shapes.iter().enumerate() {
        let line = number as u64 + 1;
        let (to, arc) = match *shape {
            Shape::Line { size, to } => (std::array::from_fn(|k| at[k] + size * to[k]), None),
            Shape::Back => (before, None),
            Shape::Arc { radius, angle, rise, from } => {
                let angle = if angle.abs() < 0.1 { 0.5 } else { angle };
                let centre = [at[0] - radius * from.cos(), at[1] - radius * from.sin()];
                let end = from + angle;
                let to =
                    [centre[0] + radius * end.cos(), centre[1] + radius * end.sin(), at[2] + rise];
                (to, Some(Arc { plane: [0, 1], centre, angle }))
            }
            Shape::Rest { dwell } => {
                items.push(Item::Rest { dwell, line });
                continue;
            }
            Shape::Mark => {
                items.push(Item::Mark(line));
                continue;
            }
        };
        items.push(Item::Move(Element {
            to: to.to_vec(),
            arc,
            feed: if number % 7 == 3 { None } else { Some(feed) },
            tolerance: Tolerance { linear: tolerance, rotary: tolerance },
            line,
            block: 0,
        }));
        (before, at) = (at, to);
    }
    items
}

/// The same machine with two crossed belts.
fn crossed_text(speed: f64, acceleration: f64) -> String {
    let crossed = "[machine]\nkinematics = \"corexy\"\nguard = { limits = \"none\" }\n";
    machine_text(speed, acceleration, 0.0).replacen("[machine]\n", crossed, 1)
}

/// Sum and difference: the motors of crossed belts for places of the tool.
fn motors_of_belts(place: &[f64]) -> Vec<f64> {
    vec![place[0] + place[1], place[0] - place[1], place[2]]
}

fn letters_of_belts(motors: &[f64]) -> Vec<f64> {
    vec![(motors[0] + motors[1]) / 2.0, (motors[0] - motors[1]) / 2.0, motors[2]]
}

/// Plans the items and checks the rows; the letters follow from the motors by `letters`, and the
/// motors from the letters by `motors`.
fn check(
    text: &str,
    motors: impl Fn(&[f64]) -> Vec<f64>,
    letters: impl Fn(Vec<f64>) -> Vec<f64>,
    items: &[Item],
) {
    let machine = common::machine(text);
    let planner = Planner::new(&machine, 3, &[0.0; 3]).unwrap();
    let mut replay = Replay::new(&machine);
    let (mut marks, mut all, mut last) = (Vec::new(), Vec::new(), false);
    for row in rows(planner, items.to_vec()) {
        let row = row.unwrap();
        assert!(row.ticks >= 4000 && row.ticks <= 16_001, "{} ticks", row.ticks);
        replay.run(&row);
        all.push(row.clone());
        marks.extend(row.marks.iter().copied());
        last = row.segments.iter().all(|s| s.last);
    }
    replay.assert_limits(&machine);
    let landed = |place: &[f64]| {
        let whole = |(place, steps): (f64, f64)| (place * steps).round() / steps;
        letters(motors(place).into_iter().zip([80.0, 80.0, 400.0]).map(whole).collect())
    };
    let path = Programmed::new(&[0.0; 3], items, 3, landed);
    if let Err(place) = within(&machine, &path, &all, 1.0, &letters) {
        let least = deviation(&machine, &path, &all, &letters);
        panic!("{least} of the tolerance: {place}");
    }
    let wanted: Vec<u64> = items
        .iter()
        .filter_map(|item| if let Item::Mark(mark) = item { Some(*mark) } else { None })
        .collect();
    assert_eq!(marks, wanted, "marks");
    assert!(last || replay.ticks == 0, "the last row is marked");
    for axis in &replay.axes {
        assert_eq!(axis.distance & ((1 << 64) - 1), 0, "P is at its start value");
    }
    if let Some(Item::Move(end)) = items.iter().rev().find(|item| matches!(item, Item::Move(_))) {
        let motors: Vec<f64> = replay
            .axes
            .iter()
            .zip([80.0, 80.0, 400.0])
            .map(|(a, s)| (a.distance >> 64) as f64 / s)
            .collect();
        for (to, found) in end.to.iter().zip(letters(motors)) {
            assert!((to - found).abs() <= ROUNDING, "{to} {found}");
        }
    }
}

/// Half a step of an axis of 80 steps/mm in each direction, mm.
const ROUNDING: f64 = 0.00885;

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

    #[test]
    fn random_paths_keep_limits_and_land_on_cartesian_machines(
        shapes in shapes(),
        feed in 1.0..150.0_f64,
        tolerance in prop_oneof![Just(0.01), 0.003..0.2_f64],
        speed in 20.0..300.0_f64,
        acceleration in 100.0..5000.0_f64,
    ) {
        let items = items(&shapes, feed, tolerance);
        check(&machine_text(speed, acceleration, 0.0), <[f64]>::to_vec, |motors| motors, &items);
    }

    #[test]
    fn random_paths_keep_limits_and_land_on_crossed_belts(shapes in shapes(), feed in 1.0..150.0_f64) {
        let items = items(&shapes, feed, 0.01);
        check(&crossed_text(100.0, 1000.0), motors_of_belts, |motors| letters_of_belts(&motors), &items);
    }

    #[test]
    fn random_paths_keep_jerk_limits_and_land(shapes in shapes(), jerk in 4.0..6.5_f64) {
        let text = machine_text(100.0, 1000.0, 10_f64.powf(jerk));
        check(&text, <[f64]>::to_vec, |motors| motors, &items(&shapes, 100.0, 0.01));
    }
}

#[test]
fn a_smooth_path_is_planned_on_crossed_belts() {
    let to = |x: f64, y: f64| Shape::Line { size: 1.0, to: [x, y, 0.0] };
    let shapes =
        [to(20.0, 5.0), Shape::Mark, to(-3.0, 8.0), Shape::Rest { dwell: 0.02 }, to(1.0, 1.0)];
    let items = items(&shapes, 50.0, 0.01);
    check(
        &crossed_text(100.0, 1000.0),
        motors_of_belts,
        |motors| letters_of_belts(&motors),
        &items,
    );
}

/// The path ends near a line on which the tool came, so that a tool that turns before the first
/// corner is within the tolerance of that line up to the end.
#[test]
#[expect(clippy::unreadable_literal, reason = "only these digits show it")]
fn tool_that_turns_before_a_corner_has_not_come_to_the_end() {
    let line = |size: f64, to: [f64; 3]| Shape::Line { size, to };
    let shapes = [
        line(0.01069307106018658, [0.6331829034729821, 0.5198446232408022, 0.15356843098504733]),
        line(0.15546125967863433, [-0.21005444368369416, 0.1290265889658647, -0.24970946086517587]),
        Shape::Back,
        line(2.8744275962631396, [-0.6090841551245559, -0.1782155977206314, 0.21758137266184294]),
        line(0.012224880131992664, [0.8250904086949656, -0.5348401866679399, -0.5841192086064682]),
        line(0.041568056191382714, [0.7226391031591337, 0.5441034419832157, -0.41308071748252984]),
        Shape::Back,
    ];
    let items = items(&shapes, 24.69684199961989, 0.007668008225998642);
    let text = machine_text(218.93188530193103, 843.0281500124129, 0.0);
    check(&text, <[f64]>::to_vec, |motors| motors, &items);
}

#[test]
fn bad_elements_are_refused_with_their_line() {
    let machine = common::machine(&machine_text(100.0, 1000.0, 0.0));
    let good = Element {
        to: vec![1.0, 0.0, 0.0],
        arc: None,
        feed: Some(10.0),
        tolerance: Tolerance { linear: 0.01, rotary: 0.01 },
        line: 7,
        block: 0,
    };
    let refused = |element: Element| {
        let mut planner = Planner::new(&machine, 3, &[0.0; 3]).unwrap();
        planner.push(&Item::Move(element)).unwrap_err()
    };
    let arc = |centre, angle| Some(Arc { plane: [0, 1], centre, angle });
    assert!(matches!(
        refused(Element { to: vec![1.0], ..good.clone() }),
        JobError::Coordinates { line: 7, .. }
    ));
    for value in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(
            refused(Element { feed: Some(value), ..good.clone() }),
            JobError::Number { line: 7, .. }
        ));
        let tolerance = Tolerance { linear: value, rotary: 0.01 };
        assert!(matches!(
            refused(Element { tolerance, ..good.clone() }),
            JobError::Number { line: 7, .. }
        ));
    }
    assert!(matches!(
        refused(Element { to: vec![f64::NAN, 0.0, 0.0], ..good.clone() }),
        JobError::Number { line: 7, .. }
    ));
    assert!(matches!(
        refused(Element { to: vec![1e9, 0.0, 0.0], ..good.clone() }),
        JobError::Far { line: 7, .. }
    ));
    assert!(matches!(
        refused(Element { arc: arc([0.3, 0.0], 3.0), ..good.clone() }),
        JobError::Arc { .. } | JobError::Radii { line: 7, .. }
    ));
    assert!(matches!(
        refused(Element { arc: arc([0.5, 0.0], 0.0), ..good.clone() }),
        JobError::Arc { line: 7 }
    ));
    let mut planner = Planner::new(&machine, 3, &[0.0; 3]).unwrap();
    planner.finish().unwrap();
    assert_eq!(planner.push(&Item::Move(good)), Err(JobError::Ended));
    assert_eq!(planner.next_row(), Ok(None));
}
