//! Lines of a sender, planned in batches: what has come in a hold is planned as a program is, a
//! sender that is late ends a batch at rest, and what is dropped is never given.

use carrystep_files::{Machine, SourceText};
use carrystep_job::{Item, rows};
use carrystep_plan::exact::travel;
use carrystep_program::{LineBreak, Lines, Offsets, PlannedLine, Row};
use carrystep_runner::{BatchEnd, Growing, LINES, MotionGuard};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

const MACHINE: &str = "[machine]\nclock_hz = 48_000_000\ntick_ns = 2000\n\
    [machine.link]\nbaud = 3_000_000\n\
    [[machine.axis]]\nname = \"x\"\nsteps_per_unit = 80\nspeed_limit = 50\n\
    accel_limit = 1000\ndriver = \"tmc2209\"\n\
    [[machine.axis]]\nname = \"y\"\nsteps_per_unit = 80\nspeed_limit = 50\n\
    accel_limit = 1000\ndriver = \"tmc2209\"\n";

fn lines() -> Lines {
    let text = SourceText { path: "machine.toml".into(), text: MACHINE.into() };
    let machine = Machine::from_source(&text).unwrap();
    Lines::new(&machine, [0.0; 6], Offsets::default(), None).unwrap()
}

fn begin(growing: &Growing, lines: &Lines, place: Vec<f64>) {
    growing.begin(lines.planner(&place).unwrap(), place);
}

/// All rows of a batch, and its end.
fn batch(growing: &Growing) -> (Vec<Row>, BatchEnd) {
    let rows = growing.rows().collect();
    (rows, growing.take_end().unwrap())
}

/// Where rows end, in steps.
fn gone(rows: &[Row]) -> Vec<i128> {
    let mut gone = vec![0_i128; 2];
    for row in rows {
        for (gone, segment) in gone.iter_mut().zip(&row.segments) {
            *gone += travel(segment, segment.ticks.into());
        }
    }
    gone.iter().for_each(|gone| assert_eq!(gone & ((1 << 64) - 1), 0, "no whole steps"));
    gone.into_iter().map(|gone| gone >> 64).collect()
}

fn program() -> Vec<String> {
    let point = |n: u32| (f64::from(n) * 0.4).sin_cos();
    (1..200)
        .map(|n| (n, point(n)))
        .map(|(n, (x, y))| format!("G1 X{x:.3} Y{y:.3} F{}", 900 + n))
        .collect()
}

#[test]
fn lines_that_have_all_come_are_planned_as_a_program() {
    let mut given = lines();
    let growing = Growing::default();
    let mut items: Vec<Item> = Vec::new();
    for line in program() {
        let parts = given.execute(&line).unwrap();
        items.extend(parts.iter().map(|part| match part {
            PlannedLine::Item(item) => item.clone(),
            PlannedLine::Break(at) => panic!("{at:?}"),
        }));
        growing.add(parts);
    }
    assert_eq!(growing.free(), LINES - 199);
    growing.add(given.execute("M2").unwrap());
    growing.add(given.execute("G0 X9").unwrap());
    begin(&growing, &given, vec![0.0; 2]);
    let (found, end) = batch(&growing);
    let wanted: Vec<Row> =
        rows(given.planner(&[0.0; 2]).unwrap(), items).map(Result::unwrap).collect();
    assert!(found == wanted && found.len() > 300, "{} {}", found.len(), wanted.len());
    assert_eq!((end.at, &end.error), (Some(LineBreak::End), &None));
    assert!(found.last().unwrap().segments.iter().all(|segment| segment.last));
    // What has come behind the end is the next batch.
    assert!(growing.waits());
    begin(&growing, &given, end.place.clone());
    let (found, end) = batch(&growing);
    assert_eq!((gone(&found)[0] as f64 / 80.0 + wanted_end(&wanted)).round(), 9.0);
    assert_eq!((end.at, end.place[0]), (None, 9.0));
}

fn wanted_end(rows: &[Row]) -> f64 {
    gone(rows)[0] as f64 / 80.0
}

#[test]
fn late_sender_ends_batches_at_rest_and_loses_nothing() {
    let mut given = lines();
    let growing = Growing::default();
    let (mut at, mut all, mut batches) = (vec![0.0; 2], Vec::new(), 0);
    for some in program().chunks(23) {
        let from = growing.clone();
        let parts: Vec<_> = some.iter().map(|line| given.execute(line).unwrap()).collect();
        let feeder = std::thread::spawn(move || {
            for part in parts {
                from.add(part);
                std::thread::sleep(Duration::from_millis(1));
            }
        });
        // The feeder may be late for the beginning, too.
        loop {
            if growing.waits() && !growing.is_planned() {
                begin(&growing, &given, at.clone());
            }
            if growing.is_ready() {
                let (rows, end) = batch(&growing);
                assert!(rows.last().is_none_or(|row| row.segments.iter().all(|one| one.last)));
                all.extend(rows);
                at = end.place;
                batches += 1;
            }
            if feeder.is_finished() && !growing.waits() && !growing.is_planned() {
                break;
            }
            std::thread::sleep(Duration::from_millis(1));
        }
        feeder.join().unwrap();
    }
    assert!(batches >= 9, "{batches}");
    let end = given.end();
    assert_eq!(gone(&all), [end[0], end[1]].map(|at| (at * 80.0).round() as i128));
    assert_eq!(at, end[..2]);
}

#[test]
fn dropped_lines_are_never_given() {
    let mut given = lines();
    let growing = Growing::default();
    for _ in 0..20 {
        for line in program() {
            growing.add(given.execute(&line).unwrap());
        }
        begin(&growing, &given, vec![0.0; 2]);
        let mut rows = growing.rows();
        assert!(rows.next().is_some());
        growing.clear();
        assert_eq!((rows.next(), growing.is_planned(), growing.waits()), (None, false, false));
        given.place([0.0; 6]);
        growing.add(given.execute("G1 X1").unwrap());
        begin(&growing, &given, vec![0.0; 2]);
        let (rows, end) = batch(&growing);
        assert_eq!((gone(&rows), end.place), (vec![80, 0], vec![1.0, 0.0]));
        given.execute("G0 X0").unwrap();
        given.place([0.0; 6]);
    }
}

#[test]
fn pause_amid_a_line_ends_a_batch_and_leaves_the_rest_of_the_line() {
    let mut given = lines();
    let growing = Growing::default();
    growing.add(given.execute("G0 X1").unwrap());
    growing.add(given.execute("T1 M6 G0 X2").unwrap());
    begin(&growing, &given, vec![0.0; 2]);
    let (rows, end) = batch(&growing);
    assert_eq!((gone(&rows)[0], end.at, growing.waits()), (80, Some(LineBreak::Pause), true));
    begin(&growing, &given, end.place);
    let (rows, end) = batch(&growing);
    assert_eq!((gone(&rows)[0], end.at, growing.waits()), (80, None, false));
    // The motion of a line comes before its stop.
    growing.add(given.execute("G0 X3 M0").unwrap());
    begin(&growing, &given, vec![2.0, 0.0]);
    let (rows, end) = batch(&growing);
    assert_eq!((gone(&rows)[0], end.at, growing.waits()), (80, Some(LineBreak::Pause), false));
    // A line that gives nothing does not wait.
    growing.add(given.execute("G90").unwrap());
    assert!(!growing.waits());
}

#[test]
fn batch_that_gathers_lines_begins_in_time() {
    let mut given = lines();
    let growing = Growing::default();
    let parts: Vec<_> = (1..4000)
        .map(|n| given.execute(&format!("G1 X{} F600", f64::from(n) * 0.0125)).unwrap())
        .collect();
    let ends = Arc::new(AtomicBool::new(false));
    let (from, ended) = (growing.clone(), ends.clone());
    let feeder = std::thread::spawn(move || {
        for part in parts {
            if ended.load(Ordering::Relaxed) {
                return false;
            }
            from.add(part);
            std::thread::sleep(Duration::from_millis(8));
        }
        true
    });
    while !growing.waits() {
        std::thread::yield_now();
    }
    begin(&growing, &given, vec![0.0; 2]);
    while !growing.is_ready() {
        std::thread::sleep(Duration::from_millis(1));
    }
    // All lines take half a minute: it does not wait for them.
    ends.store(true, Ordering::Relaxed);
    assert!(!feeder.join().unwrap());
    growing.clear();
}

#[test]
fn faults_of_lines_are_found_before_anything_is_planned() {
    let text =
        MACHINE.replace("driver = \"tmc2209\"\n", "driver = \"tmc2209\"\ntravel = [-5, 5]\n");
    let text = SourceText { path: "machine.toml".into(), text: text.into() };
    let machine = Machine::from_source(&text).unwrap();
    let mut given = Lines::new(&machine, [0.0; 6], Offsets::default(), None).unwrap();
    given.execute("G21 F600").unwrap();
    for (line, travels) in [
        ("G1 X6", true),
        ("G0 X1 Y-5.1", true),
        ("G2 X1 Y0 R-4", true),
        ("G1 Z1", false),
        ("G38.2 X1", false),
        ("M66 P0", false),
        ("G20 X1 X2", false),
    ] {
        let fault = given.execute(line).unwrap_err();
        assert_eq!(fault.is_travel(), travels, "{line}: {fault}");
        assert_eq!((given.end(), given.interpreter().place()), ([0.0; 6], [0.0; 6]), "{line}");
        assert!(!given.interpreter().modes().inches);
    }
    assert_eq!(given.execute("G1 X5").unwrap().len(), 1);
}

/// A batch whose x must not go back at first.
fn guarded(growing: &Growing, given: &Lines, place: Vec<f64>) -> (Vec<Row>, BatchEnd) {
    let guard: MotionGuard =
        Box::new(|ways| if ways[0] < 0 { Err("x is closed".to_owned()) } else { Ok(()) });
    growing.begin_guarded(given.planner(&place).unwrap(), place, Some(guard));
    batch(growing)
}

#[test]
fn batch_ends_before_a_line_that_its_guard_refuses() {
    let (mut given, growing) = (lines(), Growing::default());
    let add = |given: &mut Lines, line: &str| growing.add(given.execute(line).unwrap());
    for line in ["G21 G91 G1 Y1 F600", "G1 X-1 Y1", "G1 Y2"] {
        add(&mut given, line);
    }
    let (rows, end) = guarded(&growing, &given, vec![0.0; 2]);
    assert_eq!((gone(&rows), &end.refused), (vec![0, 80], &None));
    assert!(growing.waits());
    let (rows, end) = guarded(&growing, &given, end.place);
    assert_eq!((rows.len(), end.refused.as_deref()), (0, Some("x is closed")));
    assert_eq!(end.place, [0.0, 1.0]);
    // An axis that has moved away may come back.
    growing.clear();
    given.place([0.0; 6]);
    for line in ["G1 X2 Y-1", "G1 X-1", "G1 Y-1"] {
        add(&mut given, line);
    }
    let (rows, end) = guarded(&growing, &given, vec![0.0; 2]);
    assert_eq!((gone(&rows), end.refused), (vec![80, -160], None));
}
