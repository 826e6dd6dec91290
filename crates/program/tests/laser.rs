//! The duty of a laser, compared with the speed of the tool that the pulses' own sums give, and with
//! the program.

use crate::common::{job, planned, program_on};
use carrystep_program::{FromBlock, Row, RowOutputs};

const STEPS_PER_MM: f64 = 80.0;
const TICK_S: f64 = 1e-6;

/// A row as the tests see it: where the tool is at each of its ticks, and the duty.
struct Seen {
    /// Places of x and y in mm, from the start of the row to its end.
    places: Vec<[f64; 2]>,
    duty: u16,
    row: Row,
}

impl Seen {
    fn length(&self) -> f64 {
        self.places.windows(2).map(|two| distance(two[0], two[1])).sum()
    }

    /// Mean speed, mm/s.
    fn speed(&self) -> f64 {
        self.length() / (self.places.len() - 1) as f64 / TICK_S
    }

    fn begin(&self) -> [f64; 2] {
        self.places[0]
    }

    fn end(&self) -> [f64; 2] {
        self.places[self.places.len() - 1]
    }
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// Adds up all ticks of rows, and takes the duties that their changes leave.
fn seen(rows: &[Row], mut outputs: RowOutputs) -> Vec<Seen> {
    let (mut at, mut duty, mut all) = ([0_i128; 2], 0, Vec::new());
    for row in rows {
        duty = outputs.change(row).duty.unwrap_or(duty);
        let mut states = [0, 1].map(|axis| (row.segments[axis].v, row.segments[axis].a));
        let mm = |at: [i128; 2]| at.map(|p| p as f64 / 2_f64.powi(64) / STEPS_PER_MM);
        let mut places = vec![mm(at)];
        for _ in 0..row.ticks {
            for (axis, (v, a)) in states.iter_mut().enumerate() {
                at[axis] += i128::from(*v);
                *v += *a;
                *a += row.segments[axis].j;
            }
            places.push(mm(at));
        }
        all.push(Seen { places, duty, row: row.clone() });
    }
    all
}

fn laser(text: &str) -> Vec<Seen> {
    let (_folder, file) = program_on(&job("laser.toml"), text);
    let (_, rows) = planned(&file);
    seen(&rows, file.row_outputs())
}

/// The duty of S at a speed and a feed, mm/s.
fn following(s: f64, speed: f64, feed: f64) -> f64 {
    (s / 1000.0 * 4096.0).round() * speed / feed
}

#[test]
fn power_of_m4_follows_the_speed_and_m3_stays() {
    let rows = laser(&job("laser.ngc"));
    let mut kinds = [0; 4];
    for (number, one) in rows.iter().enumerate() {
        let (found, speed) = (f64::from(one.duty), one.speed());
        let is_last = rows.get(number + 1).is_none_or(|next| next.speed() == 0.0);
        match one.row.line {
            _ if speed == 0.0 || one.row.rests => {
                kinds[0] += 1;
                assert_eq!(one.duty, 0, "at rest, row {number}");
            }
            // Of rows at the ends of moves, the next test judges where the power changes.
            7 if distance(one.begin(), [5.0, 5.0]) > 0.3 => {
                kinds[1] += 1;
                let ideal = following(600.0, speed, 50.0);
                // A half by rounding, and less by the quadrature over the row.
                assert!((found - ideal).abs() < 0.75, "row {number}: {found}, {ideal}");
            }
            14 if !is_last && distance(one.begin(), [30.0, 5.0]) > 0.3 => {
                kinds[2] += 1;
                assert_eq!(one.duty, 1024, "row {number}");
            }
            5 | 17 => {
                kinds[3] += 1;
                assert_eq!(one.duty, 0, "a rapid move, row {number}");
            }
            _ => {}
        }
    }
    assert!(kinds[0] > 1 && kinds[1..].iter().all(|&count| count > 20), "{kinds:?}");
}

/// The energy on a side of a square with corners that the tool passes without a rest is that of the
/// program, although it is slower in the corners.
#[test]
fn each_side_gets_its_energy() {
    let rows = laser("G21 G90 G64 P0.02\nM4 S500\nG1 X20 F3000\nG1 Y20 S1000\nG1 X0 S250\nG1 Y0\n");
    let energy = |rows: &mut dyn Iterator<Item = &Seen>| -> f64 {
        rows.map(|one| f64::from(one.duty) / 4096.0 * f64::from(one.row.ticks) * TICK_S).sum()
    };
    let whole = energy(&mut rows.iter());
    // 20 mm at 50 mm/s each, with 0.5, 1, 0.25 and 0.25 of the power.
    let ideal = 20.0 / 50.0 * 2.0;
    assert!((whole / ideal - 1.0).abs() < 0.01, "{whole} of {ideal}");
}

/// The power changes at the start of the row that is nearest to the place in the program.
#[test]
fn power_changes_within_half_a_row_of_its_place() {
    let mut text = "G21 G90 G64 P0.01\nM3 S100\nG1 X5 F3000\n".to_owned();
    let places: Vec<f64> = (0..20).map(|k| 6.13 + 1.37 * f64::from(k)).collect();
    for (number, x) in places.iter().enumerate() {
        text += &format!("G1 X{x} S{}\n", 200 + 37 * number);
    }
    text += "G1 X60\n";
    let rows = laser(&text);
    let mut before = rows[0].duty;
    let mut changes = Vec::new();
    for one in rows.iter().filter(|one| !one.row.rests) {
        if std::mem::replace(&mut before, one.duty) != one.duty {
            changes.push(one);
        }
    }
    // The first one is at 5 mm, behind the start with S100.
    assert_eq!(changes.len(), places.len(), "{:?}", changes.len());
    let wanted = std::iter::once(5.0).chain(places);
    for (change, x) in changes.iter().zip(wanted) {
        let off = distance(change.begin(), [x, 0.0]);
        assert!(off <= change.length() / 2.0 + 0.02, "{x}: {off} of {}", change.length());
    }
}

/// A rapid move between two engraved ones that go on in its direction: no rest, and no light.
#[test]
fn rapid_move_without_a_rest_is_dark() {
    let rows = laser("G21 G90\nM3 S1000\nG1 X10 F3000\nG0 X40\nG1 X50\nM5\n");
    let on = rows.iter().filter(|one| one.duty > 0);
    for one in on {
        let middle = f64::midpoint(one.begin()[0], one.end()[0]);
        let half = one.length() / 2.0 + 0.01;
        assert!(middle <= 10.0 + half || middle >= 40.0 - half, "light at {middle}");
    }
    let lit: f64 = rows.iter().filter(|one| one.duty > 0).map(Seen::length).sum();
    assert!((lit - 20.0).abs() < 0.5, "{lit} mm");
}

#[test]
fn probe_move_is_dark() {
    let rows = laser("G21 G90\nM3 S1000\nG1 X10 F3000\nG38.2 X20 F600\nG1 X30 F3000\nM5\n");
    let lit = |from: f64, to: f64| {
        let within = rows.iter().filter(|one| one.begin()[0] >= from && one.end()[0] <= to);
        within.filter(|one| one.duty > 0).map(Seen::length).sum::<f64>()
    };
    assert_eq!(lit(10.0, 20.0), 0.0);
    assert!(lit(0.0, 10.0) > 9.5 && lit(20.0, 30.0) > 9.5);
}

#[test]
fn way_to_an_entry_is_dark() {
    let text = "G21 G90\nM3 S1000\nG1 X10 F3000\nG1 Y5\nG1 X0\nM5\n";
    let (_folder, file) = program_on(&job("laser.toml"), text);
    let path = file.path().to_owned();
    let settings = carrystep_program::Settings {
        from: Some(FromBlock {
            block: 5,
            began_at: [Some(0.0); 6],
            safe_z: None,
            spindle_dwell: None,
        }),
        ..carrystep_program::Settings::default()
    };
    let machine = file.machine().clone();
    let entered =
        carrystep_program::ProgramFile::open(&path, machine, "m.toml".as_ref(), settings).unwrap();
    let (_, rows) = planned(&entered);
    let mut light = Vec::new();
    for one in seen(&rows, entered.row_outputs()) {
        if one.duty > 0 {
            light.push(one.begin());
        }
    }
    // Only the block itself, from 10, 5 to 0, 5.
    assert!(light.len() > 10 && light.iter().all(|at| (at[1] - 5.0).abs() < 0.01), "{light:?}");
}
