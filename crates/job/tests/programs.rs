//! The test programs, from text to integers: limits, rhythm, tolerance, landing, and their times
//! beside those of other rules.

use crate::common;
use crate::common::follow::within;
use crate::common::measure::{planned, programmed, times};
use crate::common::reader;
use crate::common::replay::Replay;
use carrystep_job::Item;

const PROGRAMS: [&str; 4] =
    ["square_and_arc.ngc", "chords_and_star.ngc", "trochoid.ngc", "relief.ngc"];

#[test]
fn programs_keep_limits_rhythm_and_tolerance_and_land_exactly() {
    let machine = common::machine(&reader::file("machine.toml"));
    for name in PROGRAMS {
        let items = reader::read(&reader::file(name));
        let rows = planned(&machine, &items);
        let mut replay = Replay::new(&machine);
        for row in &rows {
            assert!((4000..=16_000).contains(&row.ticks), "{name}: {} ticks", row.ticks);
            replay.run(row);
        }
        let path = programmed(&machine, &items);
        let kept = |scale: f64| within(&machine, &path, &rows, scale, &|motors| motors);
        assert_eq!(kept(1.0), Ok(()), "{name}");
        assert!(kept(0.5).is_err(), "{name}: the tolerance is not used");
        replay.assert_limits(&machine);
        let Some(Item::Move(last)) = items.last() else { panic!("{name} has moves") };
        for ((axis, to), steps) in replay.axes.iter().zip(&last.to).zip([80.0, 80.0, 400.0]) {
            assert_eq!(axis.distance, ((to * steps).round() as i128) << 64, "{name}");
        }
        assert!(rows.last().unwrap().segments.iter().all(|s| s.last));
        assert_eq!(rows.iter().filter(|row| row.segments.iter().any(|s| s.last)).count(), 1);
    }
}

#[test]
fn programs_are_nearly_as_fast_as_rules_without_a_jerk_limit() {
    let machine = common::machine(&reader::file("machine.toml"));
    for name in PROGRAMS {
        let times = times(&machine, &reader::read(&reader::file(name)));
        assert!(times.inner <= 1.03 * times.least, "{name}: {times:?}");
        assert!(times.inner >= times.least, "{name} is faster than possible: {times:?}");
        // On the trochoid, chords let Grbl's rule pass arcs faster than their acceleration allows.
        if name != "trochoid.ngc" {
            assert!(times.ours <= 1.10 * times.grbl, "{name}: {times:?}");
        }
        assert!(times.ours < times.rest_to_rest, "{name}: {times:?}");
    }
}

#[test]
fn references_give_the_published_times_of_simple_programs() {
    use common::reference::{Limits, grbl};
    let limits = Limits { speed: vec![100.0; 3], acceleration: vec![1000.0; 3] };
    let read = |text: &str| reader::read(text);
    // A trapezoid of 20 mm at 100 mm/s and 1000 mm/s^2 takes 0.2 s + 0.1 s.
    let one = read("G1 X20 F6000");
    assert!((grbl(&one, &limits, 0.01) - 0.3).abs() < 1e-12);
    // A corner of 90 degrees is passed at 5.84 mm/s (a sqrt 2 along the junction).
    let corner = (1000.0 * 2_f64.sqrt() * 0.01 * 0.5_f64.sqrt() / (1.0 - 0.5_f64.sqrt())).sqrt();
    assert!((corner - 5.84).abs() < 0.01);
    let expected = 2.0 * (0.3 - corner / 1000.0 + corner * corner / (2.0 * 1000.0 * 100.0));
    let two = grbl(&read("G1 X20 F6000\nG1 Y20"), &limits, 0.01);
    assert!((two - expected).abs() < 1e-9, "{two} {expected}");
    let stop = grbl(&read("G1 X20 F6000\nG1 Y20"), &limits, 0.0);
    assert!((stop - 0.6).abs() < 1e-9, "{stop}");
}

#[test]
fn rows_name_line_feed_and_distance_of_the_place_where_they_end() {
    let machine = common::machine(&reader::file("machine.toml"));
    // A staircase whose steps have other feeds, long enough for several windows of the planner.
    let line = |k: u64| {
        let (x, y) = (5 * k.div_ceil(2), 5 * (k / 2));
        format!("G1 X{x} Y{y} F{}\n", 600 + 100 * (k % 7))
    };
    let items = reader::read(&(1..=60).map(line).collect::<String>());
    let rows = planned(&machine, &items);
    let mut replay = Replay::new(&machine);
    let (mut most, mut round) = (0.0_f64, 0);
    for row in &rows {
        replay.run(row);
        let place = |axis: usize| replay.axes[axis].distance as f64 / 2_f64.powi(64) / 80.0;
        let (x, y) = (place(0), place(1));
        let k = row.line as i64;
        let from =
            [5 * (k - 1).div_euclid(2) + 5 * ((k - 1) % 2), 5 * ((k - 1) / 2)].map(|c| c as f64);
        let to = [5 * (k / 2) + 5 * (k % 2), 5 * (k / 2)].map(|c| c as f64);
        let beyond = |c: f64, a: f64, b: f64| (a - c).max(c - b).max(0.0);
        let away = beyond(x, from[0], to[0]).hypot(beyond(y, from[1], to[1]));
        assert!(away <= 0.02, "line {k} at {x} {y}: {away}");
        let feed = |k: i64| (600 + 100 * (k % 7)) as f64 / 60.0;
        assert!(row.feed == feed(k) || row.feed == feed(k - 1), "line {k}: {}", row.feed);
        assert!((0.0..=1.0).contains(&row.off), "{}", row.off);
        most = most.max(row.off);
        let corner = ((x / 5.0).round() * 5.0, (y / 5.0).round() * 5.0);
        if row.corner > 1.0 && row.off > 0.5 {
            round += 1;
            assert!((x - corner.0).hypot(y - corner.1) < 0.5, "no corner at {x} {y}");
        }
    }
    assert!(most > 0.5, "corners use the tolerance: {most}");
    assert!((59..600).contains(&round), "{round} rows at 59 corners");
}

/// What the engine's queue and the link need of successive rows, whatever the program does.
#[test]
fn any_eight_rows_last_32_ms_and_none_more_than_16_ms() {
    let text = reader::file("machine.toml");
    let limits = ["", "jerk_limit = 50000\n", "jerk_limit = 10000\n", "jerk_limit = 300\n"];
    for jerk in limits {
        let machine = common::machine(&text.replace("driver", &format!("{jerk}driver")));
        let mut items = Vec::new();
        // Rests of all lengths around one and two rows, between moves of all lengths.
        for k in 0..60_u32 {
            let x = f64::from(k % 2) * 0.001 * 1.17_f64.powi(k as i32);
            let line = format!("G1 X{x:.4} Y{:.4} F6000\n", f64::from(k) * 0.05);
            items.extend(reader::read(&line));
            let dwell = f64::from(k) * 0.0007;
            if k % 3 != 0 {
                items.push(Item::Rest { dwell, line: k.into() });
            }
        }
        let rows = planned(&machine, &items);
        assert!(rows.len() > 100);
        for row in &rows {
            assert!((4000..=16_000).contains(&row.ticks), "{jerk}: {}", row.ticks);
        }
        for eight in rows.windows(8) {
            assert!(eight.iter().map(|row| row.ticks).sum::<u32>() >= 32_000, "{jerk}");
        }
        let (ticks, count) = (rows.iter().map(|row| row.ticks).sum::<u32>(), rows.len());
        assert!(count as f64 / (f64::from(ticks) * 1e-6) <= 250.0, "{jerk}");
    }
}
