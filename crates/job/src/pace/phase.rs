//! Aligns the rows with those of the plan where the rate comes back to 1.
//!
//! Where the plan uses the whole of a limit, only its own rows keep that limit. Rows that begin
//! between planned ones spread each change of jerk over two rows, and their jerk reaches up to 1.55
//! times the limit. So where the rate has come back to 1, each row must begin where a planned one
//! does. For that the stretch before has to last a whole number of rows: its rate is made a little
//! smaller, most in the middle of the stretch.

use super::place::Place;
use super::rates::Rates;
use super::track::Track;

/// Fewest planned rows with another rate between two with the rate 1.
const LEAST: u64 = 6;
/// Distance that counts as none, planned ticks.
const NEAR: f64 = 1e-4;
/// Tries to find the rate.
const TRIES: u32 = 40;
/// The least rate.
const SLOWEST: f64 = 0.05;

/// Whether the rate is 1 in a whole row.
fn is_plan(rates: &Rates, row: u64) -> bool {
    let values = [row.saturating_sub(1), row, row + 1].map(|row| rates.of(row));
    values.iter().all(|value| *value == 1.0)
}

/// Makes the rates before `end` such that rows of so many ticks begin where planned rows do,
/// wherever the rate is 1. The motion is at `from` where a row begins.
pub(super) fn align(track: &Track, rates: &mut Rates, from: Place, end: u64, ticks: u32) {
    let mut place = from;
    let mut is_other = from.tick > NEAR;
    let mut row = from.row;
    while row < end {
        if is_plan(rates, row) && !is_other {
            row += 1;
            place = Place { row, tick: 0.0 };
            continue;
        }
        is_other = false;
        let next = (row + 1..end).find(|&next| is_plan(rates, next) && is_plan(rates, next + 1));
        let Some(next) = next else { return };
        let begins_as_planned = place.tick <= NEAR && rates.of(row) == 1.0;
        if next - row < LEAST && begins_as_planned {
            set(rates, row..next, |_, _| 1.0);
        } else {
            stretch(track, rates, place, (row, next), ticks);
        }
        row = next;
        place = Place { row, tick: 0.0 };
    }
}

fn set(rates: &mut Rates, rows: std::ops::Range<u64>, value: impl Fn(u64, f64) -> f64) {
    for row in rows {
        let index = row.checked_sub(rates.first).and_then(|index| usize::try_from(index).ok());
        if let Some(old) = index.and_then(|index| rates.values.get_mut(index)) {
            *old = value(row, *old);
        }
    }
}

/// Lowers the rates between two rows until the motion from a place is at the second one where a row
/// begins.
fn stretch(track: &Track, rates: &mut Rates, place: Place, (begin, end): (u64, u64), ticks: u32) {
    // The rate where the motion is stays, and so does that in the rows at rate 1.
    let first = begin + 1 + u64::from(place.tick > 0.0);
    let last = end.saturating_sub(1);
    if last <= first + 1 {
        return;
    }
    let length = (last - first) as f64;
    let lower = |by: f64| {
        let mut lowered = rates.clone();
        set(&mut lowered, first..last, |row, value| {
            let part = ((row - first) as f64 + 0.5) / length;
            (value - by * (part * std::f64::consts::PI).sin().powi(2)).max(SLOWEST)
        });
        lowered
    };
    let past = |place: Place| {
        let rows = place.row as f64 - end as f64;
        rows * f64::from(ticks) + place.tick
    };
    let (mut count, mut at) = (0_u32, place);
    while past(at) < -NEAR {
        at = at.later(track, rates, ticks);
        count += 1;
    }
    let arrives = |by: f64| {
        let lowered = lower(by);
        past((0..count).fold(place, |at, _| at.later(track, &lowered, ticks)))
    };
    let (mut low, mut far) = (0.0, past(at));
    if far <= NEAR {
        return;
    }
    // Over each row the motion loses about so much of it.
    let mut high = 2.0 * far / (f64::from(ticks) * length);
    let mut short = arrives(high);
    while short > 0.0 {
        if high > 1.0 {
            return;
        }
        (low, far) = (high, short);
        high *= 2.0;
        short = arrives(high);
    }
    for _ in 0..TRIES {
        let part = (far / (far - short)).clamp(0.02, 0.98);
        let by = low + (high - low) * part;
        let found = arrives(by);
        if found.abs() <= NEAR {
            (low, high) = (by, by);
            break;
        }
        if found > 0.0 {
            (low, far) = (by, found);
        } else {
            (high, short) = (by, found);
        }
    }
    *rates = lower(high.min(low.max(high)));
}
