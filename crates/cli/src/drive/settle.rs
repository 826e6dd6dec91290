//! What brings axes that rest anywhere between two steps to where moves and programs begin: P at
//! its start value, without a step.

use crate::connection::{ConnectedBoard, ConnectedBoardError};
use carrystep_core::Segment;
use carrystep_files::Machine;
use carrystep_link::{AxisState, SegmentSource, Wish};
use carrystep_runner::settling;
use std::collections::VecDeque;

/// Time in which P of the axes goes to its start value, s.
const SETTLING: f64 = 0.004;

/// P of an axis where moves begin.
const START_P: i128 = 1 << 63;

/// The same time in ticks of the machine.
pub(super) fn settling_ticks(machine: &Machine) -> u32 {
    (SETTLING / machine.timebase.tick_seconds()).ceil() as u32
}

/// Brings P of all axes, which rest, to its start value. No axis makes a step.
pub fn settle(board: &mut ConnectedBoard, machine: &Machine) -> Result<(), ConnectedBoardError> {
    let snapshot = board.snapshot()?;
    let places: Vec<i128> = snapshot.axes.iter().take(machine.axes.len()).map(off).collect();
    let parts = settling(&places, settling_ticks(machine));
    board.stream(&mut Parts::new(parts), |_| Wish::GoOn).map(drop)
}

/// How far P of an axis is from its start value, 2^-64 step.
fn off(state: &AxisState) -> i128 {
    i128::from(state.p) - START_P
}

/// The position of an axis in steps, with the part of a step that P shows.
pub fn exact_position(state: &AxisState) -> f64 {
    f64::from(state.commanded()) + off(state) as f64 / 2f64.powi(64)
}

/// Segments of all axes, which start together.
pub(super) struct Parts {
    segments: Vec<VecDeque<Segment>>,
    start: Option<u8>,
}

impl Parts {
    pub fn new(segments: Vec<Vec<Segment>>) -> Self {
        let start = Some(((1_u16 << segments.len()) - 1) as u8);
        Self { segments: segments.into_iter().map(VecDeque::from).collect(), start }
    }
}

impl SegmentSource for Parts {
    fn segment(&mut self, axis: u8) -> Option<Segment> {
        self.segments.get_mut(usize::from(axis))?.pop_front()
    }

    fn start(&mut self) -> Option<u8> {
        self.start.take()
    }
}
