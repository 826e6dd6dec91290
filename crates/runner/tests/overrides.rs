//! Overrides of the programs in `sim/jobs`, without a board.

use crate::repeats;
use carrystep_core::Segment;
use carrystep_files::{Machine, SourceText};
use carrystep_job::{Hold, Overrides, Pace, Track};
use carrystep_link::SegmentSource as _;
use carrystep_plan::exact::{ExactLimits, speeds, travel};
use carrystep_program::{ProgramFile, Row, Rows, Settings};
use carrystep_runner::{OverrideSetting, Stretches, Wait};
use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::{Rng as _, SeedableRng as _};
use std::path::{Path, PathBuf};

fn jobs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../sim/jobs")
}

struct Job {
    machine: Machine,
    rows: Vec<Row>,
    start: Vec<i128>,
    start_steps: Vec<i64>,
}

fn job(path: &Path, machine: &str) -> Job {
    let text = SourceText { path: "machine.toml".into(), text: machine.into() };
    let machine = Machine::from_source(&text).unwrap();
    let file = ProgramFile::open(path, machine.clone(), &text.path, Settings::default()).unwrap();
    let rows = Rows::new(&file).unwrap().map(Result::unwrap).collect();
    let start_steps = file.start_steps();
    let start = start_steps.iter().map(|&steps| i128::from(steps) << 64).collect();
    Job { machine, rows, start, start_steps }
}

fn paced(job: &Job, mut change: impl FnMut(usize) -> Option<Overrides>) -> Vec<Row> {
    let mut pace = Pace::new(&job.machine, &job.start_steps).unwrap();
    let mut track = Track::new(&job.start_steps);
    let mut rows = job.rows.iter().cloned();
    let mut source = || rows.next();
    let mut out = Vec::new();
    loop {
        if let Some(overrides) = change(out.len()) {
            pace.set(overrides, None);
        }
        let Some(paced) = pace.next(&mut track, &mut source) else { return out };
        pace.forget(&mut track, &paced.from);
        out.push(paced.row);
    }
}

/// What a paced program came to.
#[derive(Debug, Default)]
struct Found {
    seconds: f64,
    /// The greatest distance from the planned curve, mm.
    off: f64,
    /// The greatest speed along the path, as a part of the feed of the rows.
    feed: f64,
}

/// mm or degrees in 2^-64 step.
fn units(machine: &Machine) -> Vec<f64> {
    machine.axes.iter().map(|axis| 1.0 / axis.unit.steps / 2_f64.powi(64)).collect()
}

/// Places of the motors at quarters of each row, mm.
fn places(job: &Job, rows: &[Row]) -> Vec<Vec<f64>> {
    let units = units(&job.machine);
    let mut at = job.start.clone();
    let mut places = Vec::new();
    for row in rows {
        for quarter in 0..4 {
            let n = u64::from(row.ticks) * quarter / 4;
            let motors = at.iter().zip(&row.segments).zip(&units);
            places.push(
                motors.map(|((at, one), unit)| (at + travel(one, n)) as f64 * unit).collect(),
            );
        }
        at.iter_mut().zip(&row.segments).for_each(|(at, one)| *at += travel(one, one.ticks.into()));
    }
    places.push(at.iter().zip(&units).map(|(&at, unit)| at as f64 * unit).collect());
    places
}

/// The square of the distance of a point from a line between two points.
fn distance(point: &[f64], from: &[f64], to: &[f64]) -> f64 {
    let way: Vec<f64> = from.iter().zip(to).map(|(from, to)| to - from).collect();
    let length: f64 = way.iter().map(|x| x * x).sum();
    let along: f64 = point.iter().zip(from).zip(&way).map(|((p, f), w)| (p - f) * w).sum();
    let part = if length > 0.0 { (along / length).clamp(0.0, 1.0) } else { 0.0 };
    point.iter().zip(from).zip(&way).map(|((p, f), w)| (p - f - part * w).powi(2)).sum()
}

/// Checks rows against the limits, exactly, and their end.
fn keeps(job: &Job, rows: &[Row]) {
    let machine = &job.machine;
    let mut at = job.start.clone();
    for (axis, setup) in machine.axes.iter().enumerate() {
        let limits = ExactLimits::new::<f64>(setup);
        let jerk = limits.jerk.unwrap_or(limits.acceleration / 4000);
        let mut before = 0;
        for (number, row) in rows.iter().enumerate() {
            let one = &row.segments[axis];
            at[axis] += travel(one, one.ticks.into());
            let (a, j) = (i128::from(one.a), i128::from(one.j));
            let end = a + (i128::from(one.ticks) - 1) * j;
            assert!(speeds(one).all(|v| v.abs() <= limits.speed), "row {number}: speed");
            assert!(a.abs().max(end.abs()) <= limits.acceleration, "row {number}: acceleration");
            assert!(j.abs() <= jerk, "row {number}: jerk");
            assert!((a - before).abs() <= limits.acceleration / 50, "row {number}: jump");
            assert_eq!(one.ticks, row.ticks, "row {number}");
            before = end;
        }
    }
    let mut goal = job.start.clone();
    for row in &job.rows {
        goal.iter_mut()
            .zip(&row.segments)
            .for_each(|(at, one)| *at += travel(one, one.ticks.into()));
    }
    assert_eq!(at, goal, "the end");
}

/// Checks rows of the whole program, and measures them.
fn check(job: &Job, rows: &[Row]) -> Found {
    keeps(job, rows);
    let marks =
        |rows: &[Row]| -> Vec<u64> { rows.iter().flat_map(|row| row.marks.clone()).collect() };
    assert_eq!(marks(rows), marks(&job.rows));
    let last = |rows: &[Row]| rows.last().map(|row| row.segments.iter().all(|one| one.last));
    assert_eq!(last(rows), last(&job.rows));
    measure(job, rows)
}

/// Measures rows.
fn measure(job: &Job, rows: &[Row]) -> Found {
    let machine = &job.machine;
    let ticks: u64 = rows.iter().map(|row| u64::from(row.ticks)).sum();
    let mut found =
        Found { seconds: ticks as f64 * machine.timebase.tick_seconds(), ..Found::default() };
    let (mut planned, seen) = (places(job, &job.rows), places(job, rows));
    planned.dedup();
    // The line of the planned curve to which a place is near; it only goes on.
    let mut line = 0;
    for place in &seen {
        let of = |line: usize| distance(place, &planned[line], &planned[line + 1]);
        let last = planned.len() - 2;
        // Of lines that are nearly equally near, the first one.
        let cost = |at: usize| of(at).sqrt() + 1e-5 * (at - line) as f64;
        let near =
            (line..=(line + 24).min(last)).min_by(|a, b| cost(*a).total_cmp(&cost(*b))).unwrap();
        line = near;
        found.off = found.off.max(of(near).sqrt());
    }
    let tick = machine.timebase.tick_seconds();
    for (number, row) in rows.iter().enumerate().filter(|(_, row)| row.feed.is_finite()) {
        let quarter = f64::from(row.ticks) * tick / 4.0;
        for pair in seen[4 * number..4 * number + 5].windows(2) {
            let way: f64 = pair[0].iter().zip(&pair[1]).map(|(a, b)| (a - b).powi(2)).sum();
            found.feed = found.feed.max(way.sqrt() / quarter / row.feed);
        }
    }
    found
}

/// The program of the long run, which comes with LinuxCNC.
const CHIPS: &str = "/usr/share/linuxcnc/ncfiles/3D_Chips.ngc";

/// Drives a program, and holds it or changes its overrides before rows. Gives all rows, and the
/// number of holds.
fn driven(
    job: &Job,
    mut random: impl FnMut() -> u64,
    every: u64,
    overrides: bool,
) -> (Vec<Row>, u64) {
    let hold = Hold::new(&job.machine).unwrap();
    let pace = Pace::new(&job.machine, &job.start_steps).unwrap();
    let rows = job.rows.iter().cloned();
    let mut stretches = Stretches::new(rows, &job.start_steps, hold, pace, 31);
    let (mut out, mut holds, axes) = (Vec::new(), 0, job.machine.axes.len() as u8);
    let mut asked = false;
    while let Some(waits) = stretches.begin() {
        holds += waits.iter().filter(|wait| matches!(wait, Wait::Hold(_))).count() as u64;
        asked &= waits.is_empty();
        // The motors rest here.
        let rest = Segment { ticks: 1, v: 0, a: 0, j: 0, last: false };
        let segments = vec![rest; usize::from(axes)];
        out.push(Row { ticks: 1, segments, feed: f64::INFINITY, ..job.rows[0].clone() });
        loop {
            if asked || random().is_multiple_of(every) {
                stretches.hold();
                // Where the limits forbid it, it is tried again.
                asked = !stretches.is_held();
            }
            if overrides && random().is_multiple_of(every / 2 + 1) {
                let mut percent = |most: u64| (10 + random() % (most - 9)) as u8;
                let [feed, rapid, spindle] = [200, 100, 200].map(&mut percent);
                stretches.set_overrides(OverrideSetting { feed, rapid, spindle });
            }
            let segments: Option<Vec<_>> = (0..axes).map(|axis| stretches.segment(axis)).collect();
            let Some(segments) = segments else { break };
            let row = job.rows[0].clone();
            out.push(Row { ticks: segments[0].ticks, segments, feed: f64::INFINITY, ..row });
        }
    }
    (out, holds)
}

#[test]
fn holds_at_random_times_keep_the_limits_the_path_and_the_end() {
    let long = std::env::var("CARRYSTEP_HOLDS").ok();
    let count: u64 = long.as_deref().map_or(20, |count| count.parse().unwrap());
    let machine = std::fs::read_to_string(jobs().join("machine.toml")).unwrap();
    let path =
        if long.is_some() { PathBuf::from(CHIPS) } else { jobs().join("chords_and_star.ngc") };
    let job = job(&path, &machine);
    let mut random = Xoshiro256PlusPlus::seed_from_u64(500);
    for overrides in [false, true] {
        let every = (job.rows.len() as u64 * 3 / 4 / count).max(1);
        let (rows, holds) = driven(&job, || random.next_u64(), every, overrides);
        keeps(&job, &rows);
        let found = measure(&job, &rows);
        let with = if overrides { "with overrides" } else { "without overrides" };
        eprintln!(
            "FIGURES {holds} holds {with}: no axis over a limit, end exact, {:.5} mm off the plan",
            found.off
        );
        assert!(found.off < OFF && holds >= count, "{holds} holds {with}: {found:?}");
    }
}

/// Where the line is so slow that rows last 16 ms, it can carry none that are shorter: only those
/// where the motors rest, which need not lie where a planned row ends, may be.
#[test]
fn holds_need_no_more_of_the_line_than_the_plan() {
    let machine = std::fs::read_to_string(jobs().join("machine.toml")).unwrap();
    let slow = machine.replacen("[machine]\n", "[machine]\nlink.baud = 115_200\n", 1);
    let job = job(&jobs().join("chords_and_star.ngc"), &slow);
    let mut lengths: Vec<u32> = job.rows.iter().map(|row| row.ticks).collect();
    lengths.sort_unstable();
    let usual = lengths[lengths.len() / 2];
    assert!(usual > 15_000, "{usual} ticks of 1 us");
    let mut random = Xoshiro256PlusPlus::seed_from_u64(115_200);
    let (rows, holds) = driven(&job, || random.next_u64(), 30, false);
    keeps(&job, &rows);
    let found = measure(&job, &rows);
    let short = |row: &&Row| row.ticks > 1 && row.ticks < usual - 16;
    let extra = rows.iter().filter(short).count() - job.rows.iter().filter(short).count();
    println!("{holds} holds, {extra} shorter rows, {found:?}");
    assert!(holds >= 10 && extra as u64 <= 4 * holds, "{holds} holds, {extra} shorter rows");
    assert!(found.off < OFF, "{found:?}");
}

/// At half the feed, the motion slows down at its end with less than its acceleration, so that a hold
/// is possible there, and its resumption leads to the end of the program.
#[test]
fn resumption_that_leads_to_the_end_ends_the_move() {
    let job = program("square_and_arc", None);
    let axes = job.machine.axes.len() as u8;
    let new = || {
        let hold = Hold::new(&job.machine).unwrap();
        let pace = Pace::new(&job.machine, &job.start_steps).unwrap();
        let mut new = Stretches::new(job.rows.iter().cloned(), &job.start_steps, hold, pace, 31);
        new.set_overrides(OverrideSetting { feed: 50, ..OverrideSetting::NONE });
        new.begin();
        new
    };
    // Reads up to so many rows of the stretch; returns how many, and whether the last one is marked.
    let read = |from: &mut Stretches<_>, most: usize| {
        let mut ends = Vec::new();
        while ends.len() < most {
            let row: Option<Vec<_>> = (0..axes).map(|axis| from.segment(axis)).collect();
            let Some(row) = row else { break };
            ends.push(row.iter().all(|segment| segment.last));
        }
        (ends.len(), ends.last() == Some(&true))
    };
    let (whole, ends) = read(&mut new(), usize::MAX);
    assert!(ends);
    let mut held = 0;
    for back in 1..60 {
        let mut stretches = new();
        assert_eq!(read(&mut stretches, whole - back), (whole - back, false));
        stretches.hold();
        held += u64::from(stretches.is_held());
        loop {
            let (rows, ends) = read(&mut stretches, usize::MAX);
            assert!(ends, "a hold {back} rows before the end: {rows} rows of a stretch");
            if stretches.begin().is_none() {
                break;
            }
        }
    }
    assert!(held > 20, "{held} holds");
}

const PROGRAMS: [&str; 5] = ["square_and_arc", "trochoid", "chords_and_star", "relief", "outputs"];

/// A program of `sim/jobs`, with this feed instead of its own if one is given.
fn program(name: &str, feed: Option<u32>) -> Job {
    let machine = if name == "outputs" { "outputs.toml" } else { "machine.toml" };
    let machine = std::fs::read_to_string(jobs().join(machine)).unwrap();
    let text = std::fs::read_to_string(jobs().join(name).with_extension("ngc")).unwrap();
    let text = match feed {
        Some(feed) => {
            text.replace("F6000", &format!("F{feed}")).replace("F3000", &format!("F{feed}"))
        }
        None => text,
    };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("job.ngc");
    std::fs::write(&path, text).unwrap();
    job(&path, &machine)
}

/// The greatest distance from the planned curve, mm: the spline's, and that of lines between places.
const OFF: f64 = 0.001;

fn change(random: &mut Xoshiro256PlusPlus) -> Overrides {
    let mut percent = |most: u64| (10 + random.next_u64() % (most - 9)) as f64 / 100.0;
    Overrides { feed: percent(200), rapid: percent(100) }
}

#[test]
fn without_overrides_the_rows_are_those_of_the_plan() {
    for name in PROGRAMS {
        let job = program(name, None);
        let set = |number| (number % 7 == 0).then_some(Overrides::NONE);
        assert_eq!(paced(&job, set), job.rows, "{name}");
    }
}

/// At 10 mm/s the axes reach the feed nearly everywhere, also at twice of it.
#[test]
fn feed_override_changes_the_time_where_the_feed_binds() {
    let name = "square_and_arc";
    let job = program(name, Some(600));
    let plain = check(&job, &job.rows);
    for feed in [0.1, 0.5, 0.95, 1.3, 2.0] {
        let overrides = Overrides { feed, rapid: 1.0 };
        let found = check(&job, &paced(&job, |row| (row == 0).then_some(overrides)));
        let part = found.seconds * feed / plain.seconds;
        println!("{name}, {feed}: {part:.4} of the time, {found:?}");
        assert!((0.99..1.03).contains(&part), "{name}, {feed}: {part} of the time");
        assert!(found.off < OFF && found.feed < feed * 1.001, "{name}, {feed}: {found:?}");
    }
}

/// Where limits bind, a greater feed costs no time.
#[test]
fn feed_override_never_slows_down() {
    for name in PROGRAMS {
        let job = program(name, None);
        let plain = check(&job, &job.rows);
        let overrides = Overrides { feed: 2.0, rapid: 1.0 };
        let found = check(&job, &paced(&job, |row| (row == 0).then_some(overrides)));
        println!("{name}: {:.4} of the time, {found:?}", found.seconds / plain.seconds);
        assert!(found.seconds < plain.seconds * 1.001 && found.off < OFF, "{name}: {found:?}");
    }
}

#[test]
fn changes_at_random_times_keep_the_limits_and_the_path() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(19);
    let settings = [(None, 60), (Some(1200), 400)];
    // An ordinary run takes one setting for each program, in turn.
    let some = if repeats::in_full() { 1 } else { settings.len() };
    for (number, name) in PROGRAMS.into_iter().enumerate() {
        for (to, every) in settings.into_iter().skip(number % some).step_by(some) {
            let job = program(name, to);
            let rows = paced(&job, |row| {
                let changes = row == 0 || random.next_u64().is_multiple_of(every);
                changes.then(|| change(&mut random))
            });
            let found = check(&job, &rows);
            println!("{name} {to:?}, every {every}: {found:?}");
            assert!(found.off < OFF, "{name} {to:?}, every {every}: {found:?}");
        }
    }
}

/// A change with every second row, at any place of the motion.
#[test]
fn changes_many_times_a_second_keep_the_limits_and_the_path() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(20);
    for name in ["square_and_arc", "outputs"] {
        for to in [None, Some(1200)] {
            let job = program(name, to);
            let rows = paced(&job, |row| row.is_multiple_of(2).then(|| change(&mut random)));
            let found = check(&job, &rows);
            assert!(found.off < OFF, "{name} {to:?}: {found:?}");
        }
    }
}
