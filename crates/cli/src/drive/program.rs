//! The segments of a plan in the order in which the link asks for them.

use carrystep_core::Segment;
use carrystep_link::{Command, SegmentSource};
use carrystep_plan::{PlannedMove, Survey};
use carrystep_profile::Reader;
use std::collections::VecDeque;
use std::sync::Arc;

/// The segments of a plan, which is made while they are sent.
pub(super) struct PlannedProgram {
    moves: Reader<Arc<PlannedMove>>,
    /// For each axis, the segments of the moves that were read and that have not been sent.
    segments: Vec<VecDeque<Segment>>,
    /// The starts of these moves.
    starts: VecDeque<u8>,
}

impl PlannedProgram {
    pub(super) fn new(survey: &Survey) -> Self {
        let segments = survey.machine().axes.iter().map(|_| VecDeque::new()).collect();
        Self { moves: survey.begin().moves, segments, starts: VecDeque::new() }
    }

    /// Reads the next move; `None` if there is none.
    fn read(&mut self) -> Option<()> {
        for command in self.moves.next()?.commands().iter().filter_map(Command::of) {
            match command {
                Command::Segment { axis, segment } => {
                    self.segments.get_mut(usize::from(axis))?.push_back(segment);
                }
                Command::Start { mask } => self.starts.push_back(mask),
                // Move files change no outputs.
                Command::Outputs(_) => {}
            }
        }
        Some(())
    }
}

impl SegmentSource for PlannedProgram {
    fn segment(&mut self, axis: u8) -> Option<Segment> {
        while self.segments.get(usize::from(axis))?.is_empty() {
            self.read()?;
        }
        self.segments[usize::from(axis)].pop_front()
    }

    fn start(&mut self) -> Option<u8> {
        while self.starts.is_empty() {
            self.read()?;
        }
        self.starts.pop_front()
    }
}
