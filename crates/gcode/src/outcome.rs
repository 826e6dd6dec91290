//! What a line gives: a queue of moves and actions, with a drilling cycle in its middle.

use crate::canon::Canon;
use crate::cycle::Cycle;
use std::collections::VecDeque;

/// What a line gives and has not been taken yet, in this order.
#[derive(Debug, Default)]
pub(crate) struct Outcome {
    pub(crate) before: VecDeque<Canon>,
    pub(crate) cycle: Option<Box<Cycle>>,
    pub(crate) after: VecDeque<Canon>,
    /// M2 or M30.
    pub(crate) ends: bool,
}
