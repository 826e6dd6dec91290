//! What a line gives: a queue of moves and actions, with a drilling cycle in its middle, and a
//! jump.

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
    /// M98 or M99.
    pub(crate) jump: Option<Jump>,
}

/// A jump by an M code, with the column of the code.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Jump {
    /// M98: calls subroutine `number`, some times.
    Call { number: u32, times: u32, column: u32 },
    /// M99.
    Return { column: u32 },
}
