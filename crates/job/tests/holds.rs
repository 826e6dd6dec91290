//! Holds at many places of the test programs: the motion comes to rest, goes on, and keeps the
//! limits, the path and the landing of the plan.

use crate::common;
use crate::common::follow::within;
use crate::common::measure::{planned, programmed};
use crate::common::reader;
use crate::common::replay::Replay;
use crate::repeats;
use carrystep_core::Segment;
use carrystep_job::{Curve, CurvePlace, Hold, Row};

const PROGRAMS: [&str; 4] =
    ["square_and_arc.ngc", "chords_and_star.ngc", "trochoid.ngc", "relief.ngc"];

/// Rows that a hold looks at: more than any of these programs needs to stop and to go on.
const WINDOW: usize = 600;
/// Holds of each program in a run of repeats.
const HOLDS: usize = 125;

/// A row at rest.
fn rest(like: &Row) -> Row {
    let segment = Segment { ticks: 5000, v: 0, a: 0, j: 0, last: false };
    let segments = vec![segment; like.segments.len()];
    Row { ticks: 5000, segments, marks: Vec::new(), ..like.clone() }
}

/// P of each motor before each row.
fn places(rows: &[Row]) -> Vec<Vec<i128>> {
    let mut at = vec![0; rows[0].segments.len()];
    let mut places = Vec::new();
    for row in rows {
        places.push(at.clone());
        let end = CurvePlace { row: 1, tick: 0 };
        at = Curve::new(std::slice::from_ref(row), &at).at(end);
    }
    places
}

/// What came of the holds of a program.
#[derive(Debug, Default)]
struct Found {
    /// The longest time from the row at which a hold was wanted to the one that begins it, ticks.
    waited: u64,
    /// The longest time from there to rest, ticks.
    stopped: u64,
    /// The longest time that a hold was planned.
    planning: std::time::Duration,
    /// The time from the wish to rest of all holds, ticks.
    all: u64,
    holds: usize,
}

/// The rows with a hold that is wanted at a row.
fn held(
    hold: &Hold,
    rows: &[Row],
    places: &[Vec<i128>],
    wanted: usize,
    found: &mut Found,
) -> Vec<Row> {
    let ticks = |rows: &[Row]| rows.iter().map(|row| u64::from(row.ticks)).sum::<u64>();
    let base = wanted.saturating_sub(1);
    let end = rows.len().min(base + WINDOW);
    let curve = Curve::new(&rows[base..end], &places[base]);
    let started = std::time::Instant::now();
    let tried = (wanted - base..end - base).find_map(|first| hold.hold(&curve, first));
    let Some((from, held)) = tried else {
        // The program ends before.
        return rows.to_vec();
    };
    found.planning = found.planning.max(started.elapsed());
    found.waited = found.waited.max(ticks(&rows[wanted..base + from]));
    found.stopped = found.stopped.max(ticks(&held.stop));
    found.all += ticks(&rows[wanted..base + from]) + ticks(&held.stop);
    found.holds += 1;
    let mut all = rows[..base + from].to_vec();
    all.extend(held.stop);
    all.push(rest(&rows[base]));
    all.extend(held.resume);
    all.extend_from_slice(&rows[base + held.next..]);
    all
}

#[test]
fn holds_keep_limits_path_and_landing() {
    let machine = common::machine(&reader::file("machine.toml"));
    let hold = Hold::new(&machine).unwrap();
    for name in PROGRAMS {
        let items = reader::read(&reader::file(name));
        let mut rows = planned(&machine, &items);
        // Each row has a mark of its own.
        (0..).zip(&mut rows).for_each(|(number, row)| row.marks = vec![number]);
        let (places, path) = (places(&rows), programmed(&machine, &items));
        let mut whole = Replay::new(&machine);
        rows.iter().for_each(|row| whole.run(row));
        let mut found = Found::default();
        let step = (rows.len() / repeats::part(HOLDS, 5)).max(1);
        for wanted in (0..rows.len()).step_by(step) {
            let all = held(&hold, &rows, &places, wanted, &mut found);
            let mut replay = Replay::new(&machine);
            for row in &all {
                assert!(row.ticks <= 16_001, "{name} {wanted}: {} ticks", row.ticks);
                replay.run(row);
            }
            replay.assert_limits(&machine);
            let marks = all.iter().flat_map(|row| row.marks.iter().copied());
            assert!(marks.eq(0..rows.len() as u64), "{name} {wanted}: each mark once, in order");
            for (axis, planned) in replay.axes.iter().zip(&whole.axes) {
                assert_eq!(axis.distance, planned.distance, "{name} {wanted}");
            }
            // A long program is compared around the hold only by its motion.
            if rows.len() < 5000 {
                let kept = within(&machine, &path, &all, 1.0, &|motors| motors);
                assert_eq!(kept, Ok(()), "{name} {wanted}");
            }
        }
        eprintln!(
            "FIGURES {} holds in {name}: {} us at most to begin, {} us to rest, planned in {:.1?}",
            found.holds, found.waited, found.stopped, found.planning
        );
        assert!(found.holds > 0, "{name}");
        // 1 us ticks.
        assert!(found.waited <= 110_000, "{name}: {found:?}");
    }
}
