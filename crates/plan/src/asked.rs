//! A move that is asked for.

use carrystep_files::Move;

/// A move that is asked for, and its number, counted from 0.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Asked<'a> {
    pub index: usize,
    pub moved: &'a Move,
}
