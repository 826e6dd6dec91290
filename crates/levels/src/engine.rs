//! The engine under the same host as every core: a segment is seven words and a commit.

use carrystep_spec::engine::{COMMIT, EngineInputs, EngineOutputs, Put};
use carrystep_spec::{Command, Program, Segment};

/// An engine that can be stepped in Rust.
pub trait EngineCore {
    /// The outputs of this cycle with these inputs.
    fn outputs(&mut self, inputs: &EngineInputs) -> EngineOutputs;
    /// Goes to the next cycle.
    fn clock(&mut self, inputs: &EngineInputs);
}

impl EngineCore for carrystep_model::Engine {
    fn outputs(&mut self, inputs: &EngineInputs) -> EngineOutputs {
        Self::outputs(self, inputs)
    }
    fn clock(&mut self, inputs: &EngineInputs) {
        Self::clock(self, inputs);
    }
}

impl EngineCore for carrystep_hdl::EngineSim {
    fn outputs(&mut self, inputs: &EngineInputs) -> EngineOutputs {
        self.settle(inputs)
    }
    fn clock(&mut self, _: &EngineInputs) {
        Self::clock(self);
    }
}

/// One thing that the host does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Act {
    Put(Put),
    Start(u8),
    Wait(u32),
    Clear,
}

/// The words of a segment, and the commit.
///
/// A segment of no ticks has no words: the sender refuses it (`ticks - 1` has no sign).
pub fn puts(axis: u8, segment: &Segment) -> Vec<Put> {
    let Some(left) = segment.ticks.checked_sub(1) else { return Vec::new() };
    let halves = |x: i64| [x as u32, (x >> 32) as u32];
    let words = [[left].as_slice(), &halves(segment.v), &halves(segment.a), &halves(segment.j)].concat();
    let commit = Put { axis, word: COMMIT, data: u32::from(segment.last) };
    (0..).zip(words).map(|(word, data)| Put { axis, word, data }).chain([commit]).collect()
}

/// Feeds a program, a command at a time, each until it is taken.
#[derive(Debug, Clone)]
pub struct EngineHost {
    acts: std::vec::IntoIter<Act>,
    current: Option<Act>,
}

impl EngineHost {
    /// A host with this to do.
    pub fn new(program: &Program) -> Self {
        let mut acts = Vec::new();
        for command in program {
            match *command {
                Command::Segment { axis, segment } => acts.extend(puts(axis, &segment).into_iter().map(Act::Put)),
                Command::Start { mask } => acts.push(Act::Start(mask)),
                Command::Wait { clocks } => acts.push(Act::Wait(clocks)),
                Command::Clear => acts.push(Act::Clear),
            }
        }
        let mut acts = acts.into_iter();
        let current = acts.next();
        Self { acts, current }
    }

    /// What is driven in this cycle; nothing but `clear` and waiting while there is a fault.
    pub fn inputs(&self, fault: bool) -> EngineInputs {
        match self.current {
            Some(Act::Put(put)) if !fault => EngineInputs { put: Some(put), ..EngineInputs::default() },
            Some(Act::Start(mask)) if !fault => EngineInputs { start: Some(mask), ..EngineInputs::default() },
            Some(Act::Clear) => EngineInputs { clear: true, ..EngineInputs::default() },
            _ => EngineInputs::default(),
        }
    }

    /// Goes on where the command is done in this cycle.
    pub fn advance(&mut self, outputs: &EngineOutputs) {
        let fault = outputs.fault;
        let done = match &mut self.current {
            None => false,
            Some(Act::Put(_)) => fault || outputs.put_ready,
            Some(Act::Start(_)) => fault || outputs.start_ready,
            Some(Act::Wait(clocks)) => {
                *clocks = clocks.saturating_sub(1);
                *clocks == 0
            }
            Some(Act::Clear) => !fault,
        };
        if done {
            self.current = self.acts.next();
        }
    }

    /// Nothing is left.
    pub fn is_done(&self) -> bool {
        self.current.is_none()
    }
}
