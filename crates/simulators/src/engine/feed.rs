//! Orders the commands of planned moves by the time at which an engine has room for them. The
//! queues are filled before the first start; each later segment is sent when its axis takes one out
//! of its queue.
//!
//! ```text
//! x  1 2 3 4 5 6 7    8    9        10       there is room for segment k when segment k - 7 begins
//! y  1 2 3 4 5 6 7        8     9
//!                  ^ start
//! ```

use super::{Act, puts};
use carrystep_core::engine::{Put, QUEUE, SEGMENT_WORDS};
use carrystep_core::{Command, Program, Segment};

/// A command, and the time at which the engine can accept it.
struct Due {
    /// 0: before the first move; n: once tick n has begun.
    room: u64,
    /// The first start after all segments that are due with it, a later one after its own; these in
    /// the order of their queues.
    place: usize,
    command: Command,
}

/// The segments of an axis so far.
#[derive(Clone, Default)]
struct AxisFeed {
    begins: Vec<u64>,
    end: u64,
    /// Time at which there was room for the last of them.
    room: u64,
}

/// The actions of a host that never waits for one axis while it could serve another.
pub(super) fn acts(program: &Program) -> Vec<Act> {
    let mut due = due(program);
    // The sort is stable: commands of the same time remain in the plan's order.
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

/// The time at which there is room for each command. In a planned move the segments of all axes
/// have the same total of ticks.
fn due(program: &Program) -> Vec<Due> {
    let mut axis_feeds = vec![AxisFeed::default(); 8];
    let (mut started, mut started_before) = (0, false);
    let place = |command: &Command| {
        let command = *command;
        match command {
            Command::Segment { axis, segment } => {
                let axis_feed = &mut axis_feeds[usize::from(axis) % 8];
                let place = axis_feed.begins.len();
                axis_feed.room =
                    place.checked_sub(QUEUE).map_or(0, |earlier| axis_feed.begins[earlier] + 1);
                axis_feed.begins.push(axis_feed.end);
                axis_feed.end += u64::from(segment.ticks);
                Due { room: axis_feed.room, place, command }
            }
            // A start can be armed as soon as the move before has begun and each axis has its first
            // segment.
            _ => {
                let room =
                    axis_feeds.iter().map(|axis_feed| axis_feed.room).fold(started, u64::max);
                let begins = axis_feeds.iter().filter_map(|axis_feed| axis_feed.begins.last());
                started = begins.map(|begin| begin + 1).fold(started, u64::max);
                // The first waits for full queues. A later one for its own segments only: the move
                // before may be short.
                let own = axis_feeds
                    .iter()
                    .map(|axis_feed| axis_feed.begins.len())
                    .max()
                    .unwrap_or(0)
                    .saturating_sub(1);
                let place = if started_before { own } else { usize::MAX };
                started_before = true;
                Due { room, place, command }
            }
        }
    };
    program.iter().map(place).collect()
}

/// Sends segments of different axes in parallel: one word for each in a tick.
fn side_by_side(row: &[(u64, u8, Segment)]) -> Vec<Act> {
    let words: Vec<Vec<Put>> = row.iter().map(|(_, axis, segment)| puts(*axis, segment)).collect();
    let word =
        |k: usize| words.iter().filter_map(move |words| words.get(k)).map(|put| Act::Put(*put));
    (0..=usize::from(SEGMENT_WORDS)).flat_map(word).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Level;
    use crate::engine::EngineHost;
    use crate::engine::replay::Recording;
    use crate::engine::run::EngineJob;
    use carrystep_core::engine::Cause;
    use carrystep_core::{AXES, Build, EngineBuild, PinTiming, StartPhase, Timebase};

    fn build() -> EngineBuild {
        let timebase = Timebase::new(80_000_000, 1000, 16).unwrap();
        EngineBuild::minimal(
            &Build { timebase, phase: StartPhase::Half, pins: [PinTiming::SHORTEST; AXES] },
            1 << 50,
        )
    }

    /// Moves whose axes have segments of these ticks, in the order in which a plan sends them.
    fn program(moves: &[Vec<Vec<u32>>]) -> Program {
        let mut program = Program::new();
        for axes in moves {
            let mut due = Vec::new();
            for (axis, ticks) in (0_u8..).zip(axes) {
                for (k, &length) in ticks.iter().enumerate() {
                    let (begin, last) = (ticks[..k].iter().sum::<u32>(), k + 1 == ticks.len());
                    due.push((
                        begin,
                        axis,
                        Segment { ticks: length, v: 1 << 60, a: 0, j: 0, last },
                    ));
                }
            }
            due.sort_by_key(|&(begin, axis, _)| (begin, axis));
            let mut commands: Vec<_> = due
                .into_iter()
                .map(|(_, axis, segment)| Command::Segment { axis, segment })
                .collect();
            commands.insert(axes.len(), Command::Start { mask: (1 << axes.len()) - 1 });
            program.extend(commands);
        }
        program
    }

    fn steps(program: &Program, ticks: u64) -> (Vec<i32>, Option<Cause>) {
        let build = build();
        let outcome =
            EngineJob::new(&build, program, ticks).run(Level::Model, &mut |_, _| {}).unwrap();
        (outcome.positions, outcome.fault.map(|(cause, _)| cause))
    }

    #[test]
    fn queues_are_filled_before_the_start_in_order() {
        let acts = acts(&program(&[vec![vec![1; 9], vec![9]], vec![vec![5], vec![5]]]));
        let start = acts.iter().position(|act| matches!(act, Act::Start(_))).unwrap();
        let commits = |acts: &[Act], of: u8| {
            acts.iter()
                .filter(|act| matches!(act, Act::Put(put) if put.axis == of && put.word == 7))
                .count()
        };
        assert_eq!((commits(&acts[..start], 0), commits(&acts[..start], 1)), (QUEUE, 2));
        assert_eq!((commits(&acts, 0), commits(&acts, 1)), (10, 2));
        assert_eq!(acts.iter().filter(|act| matches!(act, Act::Start(0b11))).count(), 2);
    }

    #[test]
    fn moves_of_ten_ticks_start_in_time_however_many_there_are() {
        let build = build();
        for axes in [1, 6] {
            let mut moves = vec![vec![vec![10]; axes]; 12];
            moves.push(vec![vec![20; 9]; axes]);
            let program = program(&moves);
            let mut starts = Vec::new();
            let outcome =
                EngineJob::new(&build, &program, 300).run(Level::Model, &mut |cycle, outputs| {
                    if outputs.started && starts.last() != Some(&cycle) {
                        starts.push(cycle);
                    }
                });
            assert_eq!(outcome.unwrap().fault, None, "{axes} axes");
            let ticks: Vec<u64> = starts.windows(2).map(|pair| pair[1] - pair[0]).collect();
            assert_eq!(ticks, [800; 12], "{axes} axes");
        }
    }

    #[test]
    fn short_segments_are_there_in_time() {
        // A sixteenth of a step a tick, from half a step on.
        let moved = |ticks: i32| (ticks + 8) / 16;
        let begun = program(&[vec![vec![1, 1, 1, 1, 1, 1, 834], vec![840]]]);
        assert_eq!(steps(&begun, 840), ([[moved(840); 2].as_slice(), &[0; 4]].concat(), None));
        let rows =
            [vec![28; 30], vec![40; 21], vec![60; 14], vec![84; 10], vec![120; 7], vec![840]];
        let three = program(&[rows.to_vec(), vec![vec![40]; 6], rows.to_vec()]);
        assert_eq!(steps(&three, 1720), (vec![moved(1720); 6], None));
        // A host that waits for each command in turn is too late.
        let build = build();
        let late = EngineHost::new(&build.guard, &begun, &Vec::new());
        let fault = Recording::of(&build, late, 1_000_000, &[], None)
            .outputs
            .last()
            .and_then(|(_, outputs)| outputs.fault);
        assert_eq!(fault, Some((Cause::Underrun, 1)));
    }

    #[test]
    fn moves_follow_each_other_without_a_gap() {
        let moves = program(&[vec![vec![160]; 6], vec![vec![16]; 6], vec![vec![160]; 6]]);
        let build = build();
        let mut starts = Vec::new();
        let mut see = |cycle, outputs: &carrystep_core::engine::EngineOutputs| {
            starts.extend(outputs.started.then_some(cycle));
        };
        EngineJob::new(&build, &moves, 336).run(Level::Model, &mut see).unwrap();
        let gaps: Vec<u64> = starts.windows(2).map(|pair| (pair[1] - pair[0]) / 80).collect();
        assert_eq!(gaps, [160, 16]);
    }
}
