//! The planned rows around a hold: those that are sent as planned, those that bring the motion to
//! rest, and those that lead back to the plan.
//!
//! ```text
//! window   | r0 | r1 | r2 | r3 | r4 | r5 | r6 | r7 |     r0: sent; the hold may begin with r1
//! before        | r1 | s0 | s1 | s2 |                    s: the stop, from r2 on; rest in r4
//! behind                            | t0 | t1 | r7 |     t: the resumption, from the place of rest
//! ```

use carrystep_job::{Curve, Hold};
use carrystep_program::Row;

/// Rows that a hold looks at, and where P of each axis is where the first of them begins.
#[derive(Debug)]
pub(crate) struct Window {
    /// The rows of one stretch.
    pub rows: Vec<Row>,
    /// P of each axis, 2^-64 step from machine zero.
    pub at: Vec<i128>,
    /// The first row that has not been sent.
    pub first: usize,
    /// Whether the stretch ends with these rows.
    pub ends: bool,
}

/// A hold among the rows of a window.
#[derive(Debug)]
pub(crate) struct Held {
    /// The row with which it begins.
    pub from: usize,
    /// The rows that follow those before it, up to the rest.
    pub stop: Vec<Row>,
    /// The rows from the rest on, up to `next`.
    pub resume: Vec<Row>,
    /// The row of the window that follows.
    pub next: usize,
    /// The line of the program in which it rests.
    pub line: u64,
}

impl Window {
    /// The hold; `None` if none can begin with the next rows.
    pub fn held(&self, hold: &Hold) -> Option<Held> {
        let curve = Curve::new(&self.rows, &self.at);
        let (from, carrystep_job::Held { stop, resume, place, next }) =
            hold.hold(&curve, self.first)?;
        // Behind the window, the resumption would not be checked.
        if next == self.rows.len() && !self.ends {
            return None;
        }
        let line = self.rows.get(place.row)?.line;
        Some(Held { from, stop, resume, next, line })
    }
}
