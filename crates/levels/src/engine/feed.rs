//! Planned moves in the order in which an engine has room for them: the queues are filled before the first start,
//! and each later segment is sent as its axis takes one out.
//!
//! ```text
//! x  1 2 3 4 5 6 7    8    9        10       room for segment k: at the begin of segment k - 7
//! y  1 2 3 4 5 6 7        8     9
//!                  ^ start
//! ```

use super::{Act, puts};
use carrystep_spec::engine::{Put, QUEUE, SEGMENT_WORDS};
use carrystep_spec::{Command, Program, Segment};

/// A command, and when it can be taken.
struct Due {
    /// 0: before the first move; n: once tick n has begun.
    room: u64,
    /// Starts after the segments that are due with them; these in the order of their queues.
    place: usize,
    command: Command,
}

/// The segments of an axis so far.
#[derive(Clone, Default)]
struct Lane {
    begins: Vec<u64>,
    end: u64,
    /// When there was room for the last of them.
    room: u64,
}

/// What a host does that never waits for one axis while another could be served.
pub(super) fn acts(program: &Program) -> Vec<Act> {
    let mut due = due(program);
    // Stable: what is due at once stays in the plan's order.
    due.sort_by_key(|due| (due.room, due.place));
    let mut acts = Vec::new();
    let mut row: Vec<(u64, u8, Segment)> = Vec::new();
    for Due { room, command, .. } in due {
        match command {
            Command::Segment { axis, segment } => {
                if row.iter().any(|&(first, other, _)| first != room || other == axis) {
                    acts.extend(side_by_side(&std::mem::take(&mut row)));
                }
                row.push((room, axis, segment));
            }
            other => {
                acts.extend(side_by_side(&std::mem::take(&mut row)));
                acts.extend(alone(other));
            }
        }
    }
    acts.extend(side_by_side(&row));
    acts
}

fn alone(command: Command) -> Option<Act> {
    match command {
        Command::Segment { .. } => None,
        Command::Start { mask } => Some(Act::Start(mask)),
        Command::Wait { clocks } => Some(Act::Wait(clocks)),
        Command::Clear => Some(Act::Clear),
    }
}

/// When there is room for each command of planned moves, in which all axes' segments add up to the same ticks.
fn due(program: &Program) -> Vec<Due> {
    let mut lanes = vec![Lane::default(); 8];
    let mut started = 0;
    let place = |command: &Command| {
        let command = *command;
        match command {
            Command::Segment { axis, segment } => {
                let lane = &mut lanes[usize::from(axis) % 8];
                let place = lane.begins.len();
                lane.room = place.checked_sub(QUEUE).map_or(0, |earlier| lane.begins[earlier] + 1);
                lane.begins.push(lane.end);
                lane.end += u64::from(segment.ticks);
                Due { room: lane.room, place, command }
            }
            // It is armed as soon as the move before has begun and each axis has its first segment.
            _ => {
                let room = lanes.iter().map(|lane| lane.room).fold(started, u64::max);
                let begins = lanes.iter().filter_map(|lane| lane.begins.last());
                started = begins.map(|begin| begin + 1).fold(started, u64::max);
                Due { room, place: usize::MAX, command }
            }
        }
    };
    program.iter().map(place).collect()
}

/// Segments of different axes at once: a word for each in a tick.
fn side_by_side(row: &[(u64, u8, Segment)]) -> Vec<Act> {
    let words: Vec<Vec<Put>> = row.iter().map(|(_, axis, segment)| puts(*axis, segment)).collect();
    let word = |k: usize| words.iter().filter_map(move |words| words.get(k)).map(|put| Act::Put(*put));
    (0..=usize::from(SEGMENT_WORDS)).flat_map(word).collect()
}
