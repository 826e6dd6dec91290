//! Programs with rotary axes: feeds in degrees, inverse time, travel and tolerance in degrees, and
//! the pulses of their plans.

use crate::common::{check, planned, program_on, pulses};
use carrystep_check::PathReport;
use carrystep_files::InputError;
use carrystep_job::Row;
use carrystep_program::{Events, ProgramError, ProgrammedMove, Survey};

/// x and y with 80 steps/mm, a with 100 and c with 40 steps/degree.
const MACHINE: &str = r#"
[machine]
tick_ns = 1000
[[machine.axis]]
name = "x"
steps_per_unit = 80
speed_limit = 100
accel_limit = 1000
driver = "tmc2209"
[[machine.axis]]
name = "y"
steps_per_unit = 80
speed_limit = 100
accel_limit = 1000
driver = "tmc2209"
[[machine.axis]]
name = "a"
unit = "deg"
steps_per_unit = 100
speed_limit = 90
accel_limit = 900
travel = [-180, 180]
driver = "tmc2209"
[[machine.axis]]
name = "c"
unit = "deg"
steps_per_unit = 40
speed_limit = 360
accel_limit = 3600
driver = "tmc2209"
"#;
/// 2^64, the units of a step.
const STEP: f64 = 18_446_744_073_709_551_616.0;
const STEPS: [f64; 4] = [80.0, 80.0, 100.0, 40.0];

/// The survey of a program whose pulses were checked, the greatest speed of each axis in units/s,
/// and the check.
fn run(text: &str) -> (Survey, [f64; 4], PathReport) {
    let (_folder, file) = program_on(MACHINE, text);
    let (survey, rows) = planned(&file);
    let report = check(&file, &survey, &pulses(&rows), None);
    assert!(report.passed && survey.landed(), "{text}: {:?}", report.failures);
    let timebase = &file.machine().timebase;
    let speed = |axis: usize| survey.axes[axis].peaks.steps_per_s(timebase) / STEPS[axis];
    let speeds = std::array::from_fn(speed);
    (survey, speeds, report)
}

/// The greatest speed of a and c together at the starts of rows, degrees/s.
fn turning(text: &str) -> f64 {
    let (_folder, file) = program_on(MACHINE, text);
    let speed = |row: &Row, axis: usize| row.segments[axis].v as f64 / STEP / STEPS[axis] * 1e6;
    let (_, rows) = planned(&file);
    rows.iter().map(|row| speed(row, 2).hypot(speed(row, 3))).fold(0.0, f64::max)
}

#[track_caller]
fn near(found: f64, wanted: f64) {
    assert!((found / wanted - 1.0).abs() < 0.01, "{found}, not {wanted}");
}

/// The speed of a move with this feed: hardly less, and never more.
#[track_caller]
fn fed(found: f64, wanted: f64) {
    assert!((0.99..=1.0 + 1e-9).contains(&(found / wanted)), "{found}, not {wanted}");
}

#[test]
fn feed_of_rotary_axes_alone_is_in_degrees_per_minute() {
    let (survey, speeds, _) = run("F600\nG1 A30\n");
    fed(speeds[2], 10.0);
    near(survey.ticks as f64 / 1e6, 3.0 + 0.02);
    assert_eq!((survey.axes[2].steps(), survey.counts.rotary_deg), (3000, 30.0));
    assert_eq!(survey.counts.distance_mm, 0.0);
    // Also in inches, and over both axes together.
    fed(run("G20\nF600\nG1 A30\n").1[2], 10.0);
    let both = run("F600\nG1 A30 C40\n").1;
    assert!((6.0..6.3).contains(&both[2]) && (8.0..8.4).contains(&both[3]), "{both:?}");
    fed(turning("F600\nG1 A30 C40\n"), 10.0);
}

#[test]
fn rapid_of_rotary_axes_has_the_speed_of_the_slowest() {
    let speeds = run("G0 A90 C90\n").1;
    near(speeds[2], 90.0);
    near(speeds[3], 90.0);
    near(run("G0 C720\n").1[3], 360.0);
}

#[test]
fn feed_of_a_mixed_move_is_that_of_x_and_y() {
    let (survey, speeds, _) = run("F1200\nG1 X30 Y40 A90\n");
    fed(speeds[0].hypot(speeds[1]), 20.0);
    near(speeds[2], 36.0);
    assert_eq!((survey.counts.distance_mm, survey.counts.rotary_deg), (50.0, 0.0));
    // A is slower than the feed asks for.
    let speeds = run("F1200\nG1 X1 A90\n").1;
    near(speeds[2], 90.0);
    // Within 0.01 mm of this short move, X need not keep the ratio of the speeds.
    assert!((0.99..1.1).contains(&speeds[0]), "{speeds:?}");
}

#[test]
fn arc_with_a_rotary_axis_keeps_its_feed() {
    let (survey, speeds, _) = run("F1200\nG0 X10\nG2 X10 Y0 I-10 J0 A120\n");
    let length = std::f64::consts::TAU * 10.0;
    assert!((survey.counts.distance_mm - 10.0 - length).abs() < 1e-9);
    near(speeds[2], 20.0 * 120.0 / length);
}

#[test]
fn inverse_time_gives_the_time_of_each_move() {
    // 2 s for 30 degrees, 4 s for 30 mm with 60 degrees, 3 s for 30 degrees back.
    let (survey, speeds, _) = run("G93\nG61.1\nG1 A30 F30\nG1 X30 A90 F15\nG1 A60 C-10 F20\n");
    near(survey.ticks as f64 / 1e6, 2.0 + 4.0 + 3.0 + 3.0 * 0.022);
    near(speeds[0], 7.5);
    fed(run("G93\nG1 A30 F30\n").1[2], 15.0);
}

/// A turn alone is one also where X is not on a whole step, to which the end of the run is rounded.
#[test]
fn turn_behind_a_place_between_two_steps_keeps_its_feed() {
    fed(run("F600\nG0 X1.003\nG1 A30\n").1[2], 10.0);
    fed(run("F600\nG1 X1.003\nA-30\nX1.001\n").1[2], 10.0);
}

/// In a rotated coordinate system, X and Y differ by rounding errors where A turns alone.
#[test]
fn turn_in_a_rotated_system_is_a_turn_alone() {
    let frame = "G10 L2 P1 R33\nG0 X12.3 Y4.56\n";
    fed(run(&format!("{frame}F600\nG1 A30\n")).1[2], 10.0);
    let (survey, ..) = run(&format!("{frame}G93\nG1 A30 F30\n"));
    let (before, ..) = run(frame);
    near((survey.ticks - before.ticks) as f64 / 1e6, 2.0 + 0.02);
    assert_eq!(survey.counts.rotary_deg, 30.0);
    let (_folder, file) = program_on(MACHINE, &format!("{frame}F600\nG1 A30\n"));
    let moves: Vec<ProgrammedMove> = Events::new(&file)
        .unwrap()
        .filter_map(|event| match event.unwrap() {
            carrystep_program::Event::Move(one) => Some(one),
            _ => None,
        })
        .collect();
    assert_eq!(moves[1].length(), 30.0);
}

#[test]
fn travel_is_in_degrees() {
    for (text, place) in [("F600\nG1 A180.01\n", "180.01"), ("G91\nG0 A-90.5\nA-90\n", "-180.5")] {
        let (_folder, file) = program_on(MACHINE, text);
        let error = Survey::new(&file, |_| Ok::<(), ProgramError>(())).unwrap_err();
        let says = format!("a would go to {place} deg, beyond its travel of -180 to 180 deg");
        let error = InputError::from(error);
        assert!(error.message.contains(&says), "{error}");
        assert_eq!(error.line_column().map(|(line, _)| line), Some(text.lines().count()));
    }
    assert_eq!(run("G0 A180\nA-180\nA0\n").0.axes[2].steps(), 0);
}

/// Corners in A and C are rounded within 0.01 degrees: faster than with G61, within a step, and
/// slower than from rest to rest.
#[test]
fn corners_of_rotary_axes_use_their_tolerance() {
    let corners = "G91 F6000\no1 repeat [6]\nG1 A2\nC2\nA-2\nC2\no1 endrepeat\n";
    let (default, _, report) = run(corners);
    // One step of the coarser axis.
    assert!((report.deviation_bound_deg - (0.01 + 1.0 / 40.0)).abs() < 1e-12, "{report}");
    assert!(report.deviation_deg <= report.deviation_bound_deg, "{report}");
    let [exact, stops] = ["G61\n", "G61.1\n"].map(|mode| run(&format!("{mode}{corners}")).0.ticks);
    assert!(default.ticks < stops && exact < stops, "{} {exact} {stops}", default.ticks);
    // A tolerance of X and Y is none of A.
    assert_eq!(run(&format!("G64 P1\n{corners}")).0.ticks, default.ticks);
}

/// A tool that cuts a corner of A and C by more than the tolerance and a step is caught.
#[test]
fn rotary_axis_that_is_late_is_caught() {
    let (_folder, file) = program_on(MACHINE, "F3000\nG1 A20\nC20\nA0\n");
    let (survey, rows) = planned(&file);
    let mut changes = pulses(&rows);
    let late = |change: &mut carrystep_check::PinChange| {
        change.ps += if change.axis == 3 { 20_000_000_000 } else { 0 };
    };
    changes.iter_mut().for_each(late);
    changes.sort_by_key(|change| change.ps);
    let report = check(&file, &survey, &changes, None);
    let says = "the tool leaves the path";
    assert!(!report.passed && report.failures[0].contains(says), "{:?}", report.failures);
    assert!(report.failures[0].contains(" degrees from it, "), "{:?}", report.failures);
}
