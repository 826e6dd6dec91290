//! Follows the exact integer positions of rows along a programmed path, with the decision of
//! `free_space.rs`.

use super::free_space::{FLAT, Follow, Programmed};
use super::replay::Replay;
use carrystep_files::Machine;
use carrystep_job::Row;

/// The longest chord of the emitted curve, as a part of the tolerance.
const CHORD: f64 = 0.5;

/// Checks that the rows stay within `scale` times the tolerance, in order, to the path's end.
/// `letters` gives the letters of the motors.
///
/// # Errors
/// Where they do not.
pub fn within(
    machine: &Machine,
    path: &Programmed,
    rows: &[Row],
    scale: f64,
    letters: &dyn Fn(Vec<f64>) -> Vec<f64>,
) -> Result<(), String> {
    let mut replay = Replay::new(machine);
    let mut follow = path.follow(scale);
    for row in rows {
        let at = |tick: u32| letters(replay.at(row, tick));
        // The chord over h ticks is within h^2/8 times the acceleration of the curve, whose
        // greatest value is at an end of the row.
        let [a, b, c] = [0, row.ticks / 2, row.ticks].map(at);
        let half = f64::from(row.ticks / 2);
        let bent: f64 = (0..a.len()).map(|i| (a[i] - 2.0 * b[i] + c[i]).abs()).fold(0.0, f64::max);
        let third = {
            let [d, e] = [row.ticks / 4, row.ticks / 4 * 3].map(at);
            let cubic = |i: usize| (c[i] - 2.0 * e[i] + 2.0 * d[i] - a[i]).abs();
            (0..a.len()).map(cubic).fold(0.0, f64::max)
        };
        let acceleration = 2.0 * (bent + 16.0 * third) / (half * half);
        let length =
            (0..a.len()).map(|i| (b[i] - a[i]).abs().max((c[i] - b[i]).abs())).sum::<f64>();
        let flat = f64::from(row.ticks) * (acceleration / (8.0 * FLAT * follow.tolerance())).sqrt();
        let count = flat.max(2.0 * length / (CHORD * follow.tolerance())).ceil().max(1.0) as u64;
        let count = count.min(row.ticks.into());
        let mut before = 0;
        for k in 1..=count {
            let tick = (k * u64::from(row.ticks) / count) as u32;
            chord(&mut follow, &at, before, tick).map_err(|tick| {
                format!(
                    "line {}, tick {}: {:?}",
                    follow.line(),
                    replay.ticks + u64::from(tick),
                    at(tick)
                )
            })?;
            before = tick;
        }
        replay.run(row);
    }
    if follow.ended() { Ok(()) } else { Err(format!("the path is left in line {}", follow.line())) }
}

/// Goes from one tick to another; in smaller parts where a part is too long to change from one
/// part of the path to the next.
fn chord(
    follow: &mut Follow<'_>,
    at: &impl Fn(u32) -> Vec<f64>,
    from: u32,
    to: u32,
) -> Result<(), u32> {
    if follow.step(&at(to)) {
        return Ok(());
    }
    if to - from <= 1 {
        return Err(to);
    }
    let middle = from + (to - from) / 2;
    chord(follow, at, from, middle)?;
    chord(follow, at, middle, to)
}

/// The least multiple of the tolerance that the rows keep, to 0.002, up to 4.
pub fn deviation(
    machine: &Machine,
    path: &Programmed,
    rows: &[Row],
    letters: &dyn Fn(Vec<f64>) -> Vec<f64>,
) -> f64 {
    let (mut low, mut high) = (0.0, 4.0);
    while high - low > 0.002 {
        let middle = (low + high) / 2.0;
        let good = within(machine, path, rows, middle, letters).is_ok();
        if good { high = middle } else { low = middle }
    }
    high
}
