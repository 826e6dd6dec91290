//! Machines with two crossed belts: programs keep the limits of both motors and the tolerance of the
//! tool, and the checker notices motors that turn the wrong way. The tool is rebuilt here from the
//! pulses by the inverse of the belts as it is published, not by the machine's own.

use crate::common::{check, planned, program_on, pulses};
use carrystep_check::{Pin, PinChange};
use carrystep_job::{Overrides, Pace, Track};
use carrystep_program::{ProgramFile, Row, Survey};
use proptest::prelude::*;
use std::fmt::Write as _;

const STEPS_PER_MM: f64 = 80.0;
const TOLERANCE: f64 = 0.02;
/// 2^64, the units of a step.
const STEP: f64 = 18_446_744_073_709_551_616.0;
const TICK: f64 = 1e-6;

fn axis(name: &str, (speed, acceleration): (u32, u32), more: &str) -> String {
    format!(
        "[[machine.axis]]\nname = \"{name}\"\nunit = \"mm\"\nsteps_per_unit = 80\n\
         speed_limit = {speed}\naccel_limit = {acceleration}\ndriver = \"tmc2209\"\n{more}"
    )
}

/// A machine with these motors of the belts; its axes are in this order.
fn machine(order: [&str; 3], limits: (u32, u32), more: &str) -> String {
    let axes = order.map(|name| axis(name, if name == "z" { (40, 400) } else { limits }, more));
    format!(
        "[machine]\ntick_ns = 1000\nkinematics = \"corexy\"\n[machine.guard]\nlimits = \"none\"\n\
         [machine.link]\nspi = true\n{}",
        axes.concat()
    )
}

const XYZ: [&str; 3] = ["x", "y", "z"];

/// Corners of a program on a grid of 0.1 mm.
type Corner = (i32, i32, i32);

fn text(corners: &[Corner], feed: u32) -> String {
    let mut text = format!("G21 G90 G64 P{TOLERANCE} F{feed}\n");
    for &(x, y, z) in corners {
        let [x, y, z] = [x, y, z].map(|tenths| f64::from(tenths) / 10.0);
        writeln!(text, "G1 X{x} Y{y} Z{z}").unwrap();
    }
    text
}

/// The distance of a place from the nearest place of straight lines between corners, mm.
fn distance(corners: &[[f64; 3]], place: [f64; 3]) -> f64 {
    let dot = |u: [f64; 3], v: [f64; 3]| u.iter().zip(v).map(|(u, v)| u * v).sum::<f64>();
    let minus = |u: [f64; 3], v: [f64; 3]| std::array::from_fn(|k| u[k] - v[k]);
    let of = |pair: &[[f64; 3]]| {
        let (way, off): ([f64; 3], [f64; 3]) = (minus(pair[1], pair[0]), minus(place, pair[0]));
        let square = dot(way, way);
        let part = if square > 0.0 { (dot(way, off) / square).clamp(0.0, 1.0) } else { 0.0 };
        let left: [f64; 3] = std::array::from_fn(|k| off[k] - part * way[k]);
        dot(left, left).sqrt()
    };
    corners.windows(2).map(of).fold(f64::INFINITY, f64::min)
}

/// The places of the tool behind each pulse, mm. `at` are the numbers of the motors of x, y and z.
fn tool(changes: &[PinChange], at: [usize; 3]) -> Vec<[f64; 3]> {
    let (mut steps, mut backward) = ([0.0; 3], [false; 3]);
    let mut places = Vec::new();
    for change in changes {
        let axis = usize::from(change.axis);
        match change.pin {
            Pin::Dir => backward[axis] = change.level,
            Pin::Step if change.level => {
                steps[axis] += if backward[axis] { -1.0 } else { 1.0 };
                let [a, b, z] = at.map(|motor| steps[motor] / STEPS_PER_MM);
                places.push([(a + b) / 2.0, (a - b) / 2.0, z]);
            }
            _ => {}
        }
    }
    places
}

/// The greatest speed and acceleration of each motor in rows, steps/s and steps/s^2.
fn peaks(rows: &[Row]) -> Vec<[f64; 2]> {
    let of = |motor: usize| {
        rows.iter().fold([0.0_f64; 2], |[speed, acceleration], row| {
            let segment = row.segments[motor];
            let (mut v, mut most) = (i128::from(segment.v), 0);
            let (a, j) = (i128::from(segment.a), i128::from(segment.j));
            // V is greatest at the ends or where A passes zero.
            for tick in 0..=i128::from(row.ticks) {
                most = most.max(v.abs());
                v += a + j * tick;
            }
            let last = (a + j * i128::from(row.ticks - 1)).abs().max(a.abs());
            let units = |value: i128, power: i32| value as f64 / STEP / TICK.powi(power);
            [speed.max(units(most, 1)), acceleration.max(units(last, 2))]
        })
    };
    (0..rows[0].segments.len()).map(of).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20))]
    #[test]
    fn tool_of_crossed_belts_follows_programs_within_the_limits_of_both_motors(
        corners in prop::collection::vec((-90..90, -90..90, -20..20), 1..7),
        feed in 300_u32..9000,
        limits in (30_u32..200, 300_u32..3000),
        order in Just(XYZ).prop_shuffle(),
    ) {
        prop_assume!(corners.iter().any(|&corner| corner != (0, 0, 0)));
        let (_folder, file) = program_on(&machine(order, limits, ""), &text(&corners, feed));
        let (survey, rows) = planned(&file);
        prop_assert!(survey.landed());
        let changes = pulses(&rows);
        let report = check(&file, &survey, &changes, None);
        prop_assert_eq!(report.failures, Vec::<String>::new());
        prop_assert!(report.deviation_mm <= TOLERANCE + 2_f64.sqrt() / STEPS_PER_MM + 1e-9);

        let at = XYZ.map(|name| order.iter().position(|one| *one == name).unwrap());
        let mut path = vec![[0.0; 3]];
        path.extend(corners.iter().map(|&(x, y, z)| [x, y, z].map(|tenths| f64::from(tenths) / 10.0)));
        let places = tool(&changes, at);
        // A step of a belt moves the tool by the root of a half of a step; z has a whole step.
        let bound = TOLERANCE + 2_f64.sqrt() / STEPS_PER_MM;
        for &place in &places {
            let off = distance(&path, place);
            prop_assert!(off <= bound + 1e-9, "{off} of {bound} at {place:?}");
        }
        // Each belt lands on its nearest step.
        let (end, landed) = (path[path.len() - 1], places[places.len() - 1]);
        for (way, off) in [(1.0, "x + y"), (-1.0, "x - y")] {
            let belt = |place: [f64; 3]| place[0] + way * place[1];
            prop_assert!((belt(end) - belt(landed)).abs() <= 0.5 / STEPS_PER_MM + 1e-9, "{}", off);
        }
        let (speed, acceleration) = limits;
        for (peaks, motor) in peaks(&rows).iter().zip(order) {
            let limits = if motor == "z" { (40, 400) } else { (speed, acceleration) };
            let limits = [f64::from(limits.0), f64::from(limits.1)];
            for (peak, limit) in peaks.iter().zip(limits) {
                prop_assert!(*peak <= limit * STEPS_PER_MM * (1.0 + 1e-9), "{motor}: {peaks:?}");
            }
        }
    }
}

/// The time of a program and the greatest speeds of the belts' motors, mm/s.
fn fastest(text: &str) -> (f64, [f64; 2]) {
    let (_folder, file) = program_on(&machine(XYZ, (100, 5000), ""), text);
    let (survey, rows) = planned(&file);
    let peaks = peaks(&rows);
    (survey.ticks as f64 * TICK, [0, 1].map(|motor| peaks[motor][0] / STEPS_PER_MM))
}

#[test]
fn tool_is_as_fast_as_its_motors_along_letters_and_slower_along_diagonals() {
    let (along_x, both) = fastest("G0 X90\n");
    assert!(both.iter().all(|speed| (99.0..=100.0).contains(speed)), "{both:?}");
    let (along_y, both) = fastest("G0 Y90\n");
    assert!(both.iter().all(|speed| (99.0..=100.0).contains(speed)), "{both:?}");
    assert!((along_x - along_y).abs() < 1e-6);
    // 90 mm of the tool along a diagonal are 127 mm of one motor, and the other one rests.
    let (diagonal, [first, second]) = fastest("G0 X63.63961 Y63.63961\n");
    assert!((99.0..=100.0).contains(&first) && second == 0.0, "{first} {second}");
    let (other, [first, second]) = fastest("G0 X63.63961 Y-63.63961\n");
    assert!(first == 0.0 && (99.0..=100.0).contains(&second), "{first} {second}");
    assert!((diagonal - other).abs() < 1e-6 && diagonal > 1.3 * along_x, "{along_x} {diagonal}");
}

#[test]
fn feed_and_its_override_are_those_of_the_tool() {
    for line in ["G1 X40 Y0 F1800\n", "G1 X0 Y40 F1800\n", "G1 X28.2843 Y28.2843 F1800\n"] {
        let (_folder, file) = program_on(&machine(XYZ, (100, 5000), ""), line);
        let (survey, rows) = planned(&file);
        // 40 mm at 30 mm/s, and the ramps.
        let seconds = survey.ticks as f64 * TICK;
        assert!((1.33..1.42).contains(&seconds), "{line}: {seconds}");
        let start = file.start_steps();
        let mut pace = Pace::new(file.machine(), &start).unwrap();
        let mut track = Track::new(&start);
        let mut planned = rows.into_iter();
        pace.set(Overrides { feed: 2.0, rapid: 1.0 }, None);
        let mut ticks = 0;
        while let Some(next) = pace.next(&mut track, &mut || planned.next()) {
            ticks += u64::from(next.row.ticks);
        }
        let seconds = ticks as f64 * TICK;
        assert!((0.66..0.80).contains(&seconds), "{line}: {seconds} at twice the feed");
    }
}

#[test]
fn power_of_a_laser_follows_the_speed_of_the_tool() {
    let outputs = "[machine.outputs]\npwm_divider = 4\nspindle_rpm = 1000\nlaser = true\n";
    for line in ["X40", "Y40", "X28.2843 Y-28.2843"] {
        let text = format!("F1800 M4 S500\nG1 {line}\nM5 M2\n");
        let file = machine(XYZ, (100, 5000), "");
        let (head, axes) = file.split_once("[[machine.axis]]").unwrap();
        let file = format!("{head}{outputs}[[machine.axis]]{axes}");
        let (_folder, file) = program_on(&file, &text);
        let (_, rows) = planned(&file);
        let mut outputs = file.row_outputs();
        let duties: Vec<u16> = rows.iter().filter_map(|row| outputs.change(row).duty).collect();
        // Half of the full duty of 4096 at the feed.
        let most = duties.iter().max().unwrap();
        assert!((2040..=2056).contains(most), "{line}: {duties:?}");
    }
}

const LINES: &str = "G64 P0.02 F1800\nG1 X5 Y8\nG1 X9 Y-2\nG1 X0 Y0\n";

fn job() -> (tempfile::TempDir, ProgramFile, Survey, Vec<PinChange>) {
    let (folder, file) = program_on(&machine(XYZ, (100, 1000), ""), LINES);
    let (survey, rows) = planned(&file);
    let changes = pulses(&rows);
    (folder, file, survey, changes)
}

/// The failures of the check of a program with changed pulses.
fn failures(bug: impl Fn(&mut Vec<PinChange>)) -> Vec<String> {
    let (_folder, file, survey, mut changes) = job();
    bug(&mut changes);
    check(&file, &survey, &changes, None).failures
}

#[test]
fn checker_finds_motors_that_turn_the_wrong_way_or_are_exchanged() {
    let leaves = |found: Vec<String>| {
        assert!(found.iter().any(|one| one.contains("the tool leaves the path")), "{found:?}");
    };
    assert_eq!(failures(|_| ()), Vec::<String>::new());
    // B = y - x instead of x - y.
    leaves(failures(|changes| {
        let first = PinChange { ps: 0, axis: 1, pin: Pin::Dir, level: true };
        for change in changes.iter_mut().filter(|one| one.axis == 1 && one.pin == Pin::Dir) {
            change.level = !change.level;
        }
        changes.insert(0, first);
    }));
    // The plugs of both motors are exchanged.
    leaves(failures(|changes| {
        changes.iter_mut().for_each(|one| one.axis = [1, 0, 2][usize::from(one.axis)]);
    }));
    // The motors of a cartesian machine would go along x and y.
    leaves(failures(|changes| changes.retain(|change| change.axis != 1)));
}

#[test]
fn checker_finds_a_lost_step_and_a_motor_that_is_late() {
    let short = failures(|changes| {
        let rises = |change: &PinChange| change.axis == 1 && change.pin == Pin::Step;
        let last = changes.iter().rposition(rises).unwrap();
        changes.remove(last);
        let rise = changes[..last].iter().rposition(rises).unwrap();
        changes.remove(rise);
    });
    assert!(short.iter().any(|one| one.contains("axis y: the pulses end at")), "{short:?}");
    let late = failures(|changes| {
        for change in changes.iter_mut().filter(|change| change.axis == 0) {
            change.ps += 10_000_000_000;
        }
        changes.sort_by_key(|change| change.ps);
    });
    assert!(late.iter().any(|one| one.contains("the tool leaves the path")), "{late:?}");
}

#[test]
fn travel_bounds_the_tool_and_not_the_motors() {
    let file = machine(XYZ, (100, 1000), "travel = [-10, 50]\n");
    // The motor of x goes to 95 mm, that of y to -50 mm.
    for text in ["G0 X50 Y45\n", "G0 X0 Y50\n", "G0 X-10 Y-10\n"] {
        let (_folder, file) = program_on(&file, text);
        let (survey, rows) = planned(&file);
        assert_eq!(check(&file, &survey, &pulses(&rows), None).failures, Vec::<String>::new());
    }
    for (text, says) in [
        ("G0 X51 Y0\n", "x would go to 51 mm, beyond its travel of -10 to 50 mm"),
        ("G0 X20 Y-11\n", "y would go to -11 mm, beyond its travel of -10 to 50 mm"),
        // An arc whose ends are within the travel.
        ("G0 X30 Y40\nG2 X50 Y40 I10 F600\n", ""),
        ("G0 X30 Y45\nG2 X50 Y45 I10 F600\n", "y would go to 52.075 mm"),
    ] {
        let (_folder, file) = program_on(&file, text);
        let refused = Survey::new(&file, |_| Ok::<(), carrystep_program::ProgramError>(()));
        match refused {
            Ok(_) => assert_eq!(says, "", "{text}"),
            Err(error) => {
                assert!(!says.is_empty() && error.to_string().contains(says), "{text}: {error}");
            }
        }
    }
}
