//! Orders the commands of planned moves by the time at which an engine has room for them. The
//! queues are filled before the first start; each later segment is sent when its axis takes one out
//! of its queue. The commands are read as far ahead as this order needs.
//!
//! ```text
//! x  1 2 3 4 5 6 7    8    9        10       a queue of 7: there is room for segment k when segment
//!                                            k - 7 begins
//! y  1 2 3 4 5 6 7        8     9
//!                  ^ start
//! ```

use super::{Act, acts_of, puts};
use carrystep_core::engine::{Put, SEGMENT_WORDS};
use carrystep_core::{Command, OutputChange, Segment};
use std::collections::{BTreeMap, VecDeque};

/// When a command is sent. Of two commands, the one with the lesser value is sent first.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Due {
    /// When the engine can accept the command. 0: before the first move; n: once tick n has begun.
    room: u64,
    /// The first start after all segments that are due with it, a later one after its own; these in
    /// the order of their queues.
    place: u64,
    /// Number of the command: those of the same time and place remain in the plan's order.
    number: u64,
}

/// The segments of an axis so far.
#[derive(Default)]
struct AxisFeed {
    /// Number of segments.
    count: u64,
    /// The ticks at which the last of them begin, as many as the queue holds.
    begins: VecDeque<u64>,
    end: u64,
    /// Time at which there was room for the last of them.
    room: u64,
}

/// The actions of a host that never waits for one axis while it could serve another.
///
/// In a planned move the segments of all axes have the same total of ticks, and every axis that
/// moves at all has segments in every move.
pub(super) struct Acts<'a> {
    commands: Box<dyn Iterator<Item = Command> + 'a>,
    axis_feeds: [AxisFeed; 8],
    /// Number of segments that the queue of an axis holds.
    queue: usize,
    /// The tick at which the last move that was read begins, plus one.
    started: u64,
    started_before: bool,
    /// Number of commands that were read.
    read: u64,
    /// Commands that were read and are not sent yet, each with what it changes at the outputs.
    waiting: BTreeMap<Due, (Command, OutputChange)>,
    /// What changes with the next segment of axis 0 that is read.
    outputs: OutputChange,
    /// Segments of different axes for which there is room at the same time.
    row: Vec<Sent>,
    ready: VecDeque<Act>,
}

impl<'a> Acts<'a> {
    pub(super) fn new(commands: Box<dyn Iterator<Item = Command> + 'a>, queue: usize) -> Self {
        Self {
            commands,
            axis_feeds: Default::default(),
            queue,
            started: 0,
            started_before: false,
            read: 0,
            waiting: BTreeMap::new(),
            outputs: OutputChange::NONE,
            row: Vec::new(),
            ready: VecDeque::new(),
        }
    }

    /// The next command, once no command that has not been read can come before it.
    fn next_due(&mut self) -> Option<(Due, (Command, OutputChange))> {
        loop {
            // There is room for a later segment of an axis at the same time as for its last one or
            // later, and for a later start not before there is room for its segments.
            let axes = self.axis_feeds.iter().filter(|axis_feed| axis_feed.count > 0);
            let known = axes.map(|axis_feed| axis_feed.room).min().unwrap_or(0);
            let first = self.waiting.first_entry();
            if let Some(first) =
                first.filter(|first| self.started_before && first.key().room < known)
            {
                return Some(first.remove_entry());
            }
            let Some(command) = self.commands.next() else { return self.waiting.pop_first() };
            let outputs = match command {
                Command::Outputs(change) => {
                    self.outputs = self.outputs.then(change);
                    continue;
                }
                Command::Segment { axis: 0, .. } => std::mem::take(&mut self.outputs),
                _ => OutputChange::NONE,
            };
            let due = self.due(&command);
            self.waiting.insert(due, (command, outputs));
        }
    }

    /// When a command that was read now is sent.
    fn due(&mut self, command: &Command) -> Due {
        let number = self.read;
        self.read += 1;
        if let Command::Segment { axis, segment } = command {
            let axis_feed = &mut self.axis_feeds[usize::from(*axis) % 8];
            let place = axis_feed.count;
            if axis_feed.begins.len() == self.queue {
                axis_feed.room = axis_feed.begins.pop_front().map_or(0, |begin| begin + 1);
            }
            axis_feed.count += 1;
            axis_feed.begins.push_back(axis_feed.end);
            axis_feed.end += u64::from(segment.ticks);
            return Due { room: axis_feed.room, place, number };
        }
        // A start can be armed as soon as the move before has begun and each axis has its first
        // segment.
        let axis_feeds = &self.axis_feeds;
        let room = axis_feeds.iter().map(|axis_feed| axis_feed.room).fold(self.started, u64::max);
        let begins = axis_feeds.iter().filter_map(|axis_feed| axis_feed.begins.back());
        self.started = begins.map(|begin| begin + 1).fold(self.started, u64::max);
        // The first waits for full queues. A later one for its own segments only: the move before
        // may be short.
        let own = axis_feeds.iter().map(|axis_feed| axis_feed.count).max().unwrap_or(0);
        let place = if self.started_before { own.saturating_sub(1) } else { u64::MAX };
        self.started_before = true;
        Due { room, place, number }
    }

    /// Makes the segments that were collected ready to be sent.
    fn end_row(&mut self) {
        self.ready.extend(side_by_side(&std::mem::take(&mut self.row)));
    }
}

impl Iterator for Acts<'_> {
    type Item = Act;

    fn next(&mut self) -> Option<Act> {
        while self.ready.is_empty() {
            match self.next_due() {
                Some((Due { room, .. }, (Command::Segment { axis, segment }, outputs))) => {
                    if self.row.iter().any(|sent| sent.room != room || sent.axis == axis) {
                        self.end_row();
                    }
                    self.row.push(Sent { room, axis, segment, outputs });
                }
                Some((_, (other, mut outputs))) => {
                    self.end_row();
                    self.ready.extend(acts_of(&other, &mut outputs));
                }
                None if self.row.is_empty() => return None,
                None => self.end_row(),
            }
        }
        self.ready.pop_front()
    }
}

/// A segment, when there is room for it, and what changes at the outputs where it begins.
struct Sent {
    room: u64,
    axis: u8,
    segment: Segment,
    outputs: OutputChange,
}

/// Sends segments of different axes in parallel: one word for each in a tick.
fn side_by_side(row: &[Sent]) -> Vec<Act> {
    let words: Vec<Vec<Put>> =
        row.iter().map(|sent| puts(sent.axis, &sent.segment, sent.outputs)).collect();
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
    use carrystep_core::{AXES, Build, EngineBuild, PinTiming, Program, StartPhase, Timebase};

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
        let program = program(&[vec![vec![1; 9], vec![9]], vec![vec![5], vec![5]]]);
        let acts: Vec<Act> = Acts::new(Box::new(program.into_iter()), 7).collect();
        let start = acts.iter().position(|act| matches!(act, Act::Start(_))).unwrap();
        let commits = |acts: &[Act], of: u8| {
            acts.iter()
                .filter(|act| matches!(act, Act::Put(put) if put.axis == of && put.word == 7))
                .count()
        };
        assert_eq!((commits(&acts[..start], 0), commits(&acts[..start], 1)), (7, 2));
        assert_eq!((commits(&acts, 0), commits(&acts, 1)), (10, 2));
        assert_eq!(acts.iter().filter(|act| matches!(act, Act::Start(0b11))).count(), 2);
    }

    #[test]
    fn commands_are_read_no_further_ahead_than_their_order_needs() {
        // One axis has a segment a move, the other one 40.
        let moves = vec![vec![vec![25; 40], vec![1000]]; 500];
        let program = program(&moves);
        let read = std::cell::Cell::new(0);
        let commands = program.iter().copied().inspect(|_| read.set(read.get() + 1));
        let mut sent = 0;
        for act in Acts::new(Box::new(commands), 7) {
            sent += usize::from(!matches!(act, Act::Put(put) if put.word != 7));
            assert!(read.get() <= sent + 10 * 42, "{} read, {sent} sent", read.get());
        }
        assert_eq!(sent, program.len());
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
        let late = EngineHost::new(&build, &begun, &Vec::new());
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
