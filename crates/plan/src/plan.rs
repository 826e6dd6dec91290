//! The result of planning: for each move and axis a profile, and the segments that follow it.
//!
//! The fields of these structs are public and read by the command, the checker and the simulator.
//! Only `planner.rs` builds them.

use crate::peaks::Peaks;
use carrystep_core::{Build, Command, ProfileKind, Program, Segment, Timebase};
use carrystep_files::PathKind;
use carrystep_profile::{Course, Leg, SharedProfile, Timeline};

/// All moves of a file, ready for the gateware. The origin of all ticks is the first tick of the
/// first move.
#[derive(Debug, Clone)]
pub struct Plan {
    /// The build of the gateware that the plan is for.
    pub build: Build,
    /// The moves, without gaps between them.
    pub moves: Vec<PlannedMove>,
}

/// One move of all axes.
#[derive(Debug, Clone)]
pub struct PlannedMove {
    /// First tick of the motion, after the rest, counted from 0 at the origin.
    pub start_tick: u64,
    /// Ticks of rest before the motion, which direction set-up and hold need.
    pub rest_ticks: u64,
    /// Ticks of the motion, without the rest.
    pub ticks: u64,
    /// Duration of the motion as given or derived, seconds. It may end inside the last tick.
    pub seconds: f64,
    /// Whether the file gives the duration.
    pub given: bool,
    /// Tolerance of a fitted profile: how far an edge may be from the profile, seconds. It is 0 if
    /// the profile is followed exactly.
    pub fit_seconds: f64,
    /// The kind of profile that was asked for.
    pub kind: ProfileKind,
    /// Whether the axes move independently or along a straight line.
    pub path: PathKind,
    /// The move of each axis, in the order of the machine file.
    pub axes: Vec<PlannedAxis>,
}

/// One move of one axis.
#[derive(Debug, Clone)]
pub struct PlannedAxis {
    /// Steps of the move; negative is backward.
    pub steps: i64,
    /// Exact target minus rounded target after the move, steps.
    pub rounding_steps: f64,
    /// The segments, with the rest before the motion. The last one is marked.
    pub segments: Vec<Segment>,
    /// The float reference, in steps and seconds, in the direction of travel.
    pub profile: SharedProfile,
    /// The name of the profile's shape: that of its kind, or triangle, constant or rest where the
    /// kind makes such a move.
    pub shape: &'static str,
    /// Greatest speed, acceleration and jerk, and the start speed, computed from the integers.
    pub peaks: Peaks,
}

impl Plan {
    /// Ticks from the origin to the end of the last move.
    pub fn total_ticks(&self) -> u64 {
        self.moves.last().map_or(0, |last| last.start_tick + last.ticks)
    }

    /// The courses of all moves, which the checker needs for its tolerance across a line.
    pub fn courses(&self) -> Vec<Course> {
        self.moves.iter().map(|planned| planned.course(&self.build.timebase)).collect()
    }

    /// The segments of one axis in order, each with its first tick from the origin.
    pub fn axis_segments(&self, axis: usize) -> impl Iterator<Item = (u64, Segment)> + '_ {
        self.moves.iter().flat_map(move |planned| planned.axis_segments(axis))
    }

    /// The commands that a host sends: every segment, in the order in which the axes need them.
    pub fn program(&self) -> Program {
        self.moves.iter().flat_map(PlannedMove::commands).collect()
    }

    /// The float reference of each axis over all moves, for the checker and for waveforms.
    pub fn timelines(&self) -> Vec<Timeline> {
        let axes = self.moves.first().map_or(0, |first| first.axes.len());
        let timeline = |axis| {
            let legs = self.moves.iter().filter_map(|planned| planned.leg(axis));
            Timeline::new(self.build.timebase.tick_seconds(), legs.collect::<Vec<_>>())
        };
        (0..axes).map(timeline).collect()
    }
}

impl PlannedMove {
    /// The course of the axes, which the checker needs for its tolerance across a line.
    pub fn course(&self, timebase: &Timebase) -> Course {
        let per_second = 2_f64.powi(-64) / timebase.tick_seconds();
        let part = |axis: &PlannedAxis| {
            axis.peaks.speed as f64 * per_second / axis.steps.unsigned_abs() as f64
        };
        let moving = self.axes.iter().filter(|axis| axis.steps != 0);
        let line_speed = moving.map(part).fold(0.0, f64::max);
        Course {
            steps: self.axes.iter().map(|axis| axis.steps).collect(),
            line_speed: (self.path == PathKind::Straight).then_some(line_speed),
        }
    }

    /// The move of an axis with its float reference; `None` if the axis does not move.
    pub fn leg(&self, axis: usize) -> Option<Leg> {
        let moved = self.axes.get(axis).filter(|axis| axis.steps != 0)?;
        Some(Leg {
            start_tick: self.start_tick,
            backward: moved.steps < 0,
            steps: moved.steps.unsigned_abs(),
            profile: moved.profile.clone(),
            fit_seconds: self.fit_seconds,
        })
    }

    /// The segments of one axis in order, each with its first tick from the origin.
    pub fn axis_segments(&self, axis: usize) -> impl Iterator<Item = (u64, Segment)> + '_ {
        let segments = self.axes.get(axis).map_or(&[][..], |axis| &axis.segments);
        let mut tick = self.start_tick - self.rest_ticks;
        segments.iter().map(move |&segment| {
            let start = tick;
            tick += u64::from(segment.ticks);
            (start, segment)
        })
    }

    /// The commands that a host sends for this move.
    ///
    /// Their order never blocks as long as each axis holds one running and one waiting segment. A
    /// move is started while the last segments of the move before it still run, so that moves
    /// follow each other without a gap.
    pub fn commands(&self) -> Program {
        let mut due: Vec<(u64, u8, Segment)> = Vec::new();
        for axis in 0..self.axes.len() {
            // A machine has at most 8 axes.
            let of_axis = |(tick, segment)| (tick, axis as u8, segment);
            due.extend(self.axis_segments(axis).map(of_axis));
        }
        due.sort_by_key(|&(tick, axis, _)| (tick, axis));
        let first_of_each = self.axes.len().min(due.len());
        let send = |(_, axis, segment)| Command::Segment { axis, segment };
        let mut commands: Program = due.into_iter().map(send).collect();
        commands.insert(first_of_each, Command::Start { mask: (1 << first_of_each) - 1 });
        commands
    }
}
