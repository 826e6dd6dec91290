//! The checker finds from the program alone where outputs have to change, and notices changes in
//! other places.

use crate::common::{ORIGIN_PS, check, job, levels, planned, program_on, pulses};
use carrystep_check::PathReport;

/// The report of a program whose output pins are changed by `bug`.
fn report(text: &str, bug: impl FnOnce(&mut Vec<(u64, u8)>)) -> PathReport {
    let (_folder, file) = program_on(&job("outputs.toml"), text);
    let (survey, rows) = planned(&file);
    let mut pins = levels(&rows);
    bug(&mut pins);
    check(&file, &survey, &pulses(&rows), Some(&pins))
}

/// The failures of `sim/jobs/outputs.ngc` with changed output pins.
#[track_caller]
fn caught(says: &str, bug: impl FnOnce(&mut Vec<(u64, u8)>)) {
    let PathReport { passed, failures, .. } = report(&job("outputs.ngc"), bug);
    assert!(!passed && failures.len() == 1 && failures[0].contains(says), "{failures:?}");
}

const MS: u64 = 1_000_000_000;

#[test]
fn changes_at_their_places_pass() {
    let found = report(&job("outputs.ngc"), |_| {});
    assert!(found.passed && found.output_changes == Some(6), "{found}");
}

/// Changes at rest, in motion, in corners and arcs, some of them within one segment.
#[test]
fn changes_between_many_short_moves_pass() {
    let mut text = "G21 G90 G64 P0.02 F6000\nM3 S100\nG4 P0.03\n".to_owned();
    for k in 0..60 {
        let angle = f64::from(k) * 2.4;
        let radius = if k % 7 == 0 { 0.004 } else { 0.3 * f64::from(k % 9) };
        let (x, y) = (10.0 + radius * angle.cos(), 10.0 + radius * angle.sin());
        text += &format!("M6{} P3\nG1 X{x:.4} Y{y:.4}\n", 2 + k % 2);
        match k % 10 {
            3 => text += "M8\nG4 P0.01\nM9\n",
            5 => text += "G91 G3 X1 Y1 I0.5 J0.5\nG90\n",
            8 => text += "M64 P3\nM65 P3\nG4 P0.001\nM64 P3\n",
            _ => {}
        }
    }
    let found = report(&text, |_| {});
    assert!(found.passed && found.output_changes > Some(40), "{found}");
}

#[test]
fn change_that_is_missing_is_caught() {
    caught("output 3 does not change where line 7 does it", |pins| {
        pins.iter_mut().for_each(|(_, levels)| *levels &= 7);
    });
    caught("output 0 does not change where line 3 does it", |pins| {
        pins.iter_mut().for_each(|(_, levels)| *levels &= !1);
    });
    caught("output 0 does not change where line 15 does it", |pins| {
        pins.pop();
    });
}

#[test]
fn wrong_output_is_caught() {
    caught("output 1 changes before the tool is where line", |pins| {
        pins.iter_mut().for_each(|(_, levels)| *levels = *levels & 7 | (*levels & 8) >> 2);
    });
}

#[test]
fn change_in_motion_that_is_early_or_late_is_caught() {
    caught("output 3 changes before the tool is where line 7 changes outputs", |pins| {
        pins[1].0 -= 40 * MS;
    });
    caught("output 3 does not change where line 7 does it", |pins| pins[1].0 += 40 * MS);
}

#[test]
fn change_at_rest_that_is_early_or_late_is_caught() {
    // The tool needs some hundredths of a second for the last and the first step of a run.
    caught("output 0 changes before the tool is where line 15 changes outputs", |pins| {
        pins[5].0 -= 200 * MS;
    });
    caught("output 0 does not change where line 3 does it", |pins| pins[0].0 += 250 * MS);
}

#[test]
fn change_that_the_program_does_not_make_is_caught() {
    caught("output 1 changes before the tool is", |pins| pins.insert(1, (pins[0].0 + MS, 7)));
    let moves = "G1 X5 F3000\nM2\n";
    let found = report(moves, |pins| pins.push((ORIGIN_PS + 30 * MS, 8)));
    assert!(
        found.failures[0].contains("output 3 changes, and the program changes none"),
        "{found}"
    );
}

#[test]
fn blink_at_rest_that_is_left_out_is_caught() {
    let blinks = "M64 P3\nG4 P0.02\nM65 P3\nG4 P0.02\nM64 P3\nG4 P0.02\nM65 P3\nG1 X1 F600\n";
    assert!(report(blinks, |_| {}).passed);
    let found = report(blinks, |pins| drop(pins.drain(1..3)));
    assert!(found.failures[0].contains("output 3 does not change where line"), "{found}");
}
