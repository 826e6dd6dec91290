//! The host of an engine: it offers words, starts and clears one after the other, while events happen
//! around it.

use super::{Act, EngineCore, Event, Events, acts_of, feed};
use crate::Commands;
use carrystep_core::engine::{
    COMMIT, CUT_WORD, Commit, EngineBuild, EngineInputs, EngineOutputs, Guard, MAX_AXES, Put,
    SEGMENT_WORDS,
};
use carrystep_core::{OutputChange, Program};
use std::collections::VecDeque;
use std::fmt;

/// Most words that a host tells in advance: a segment of each axis.
const TOLD: usize = MAX_AXES * (SEGMENT_WORDS as usize + 1);

/// The host: offers the commands of a program one after the other, each until it is accepted, while
/// events happen around it.
pub struct EngineHost<'a> {
    acts: Box<dyn Iterator<Item = Act> + 'a>,
    current: Option<Act>,
    /// Actions after the current one: read ahead, or interrupted by an event.
    later: VecDeque<Act>,
    /// The words that are told in advance.
    told: Vec<Put>,
    events: std::iter::Peekable<std::vec::IntoIter<(u64, Event)>>,
    cycle: u64,
    /// Whether the watchdog is restarted in every cycle.
    awake: bool,
    /// Whether there was a fault in the cycle before.
    fault: bool,
    /// The inputs other than those of the program.
    around: EngineInputs,
    guard: Guard,
    word_error: u8,
    /// The bits that a commit of axis 0 may have.
    commit_bits: u32,
    /// The bits that the host sets in a commit of axis 0, and in that of any axis.
    outputs: u32,
    stray: u32,
}

impl fmt::Debug for EngineHost<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("EngineHost")
            .field("current", &self.current)
            .field("cycle", &self.cycle)
            .finish_non_exhaustive()
    }
}

impl EngineHost<'static> {
    /// A host that executes a program command by command. The drivers have power until an event
    /// removes it.
    pub fn new(build: &EngineBuild, program: &Program, events: &Events) -> Self {
        let mut outputs = OutputChange::NONE;
        let acts: Vec<Act> =
            program.iter().flat_map(|command| acts_of(command, &mut outputs)).collect();
        Self::doing(build, Box::new(acts.into_iter()), events.clone(), false)
    }
}

impl<'a> EngineHost<'a> {
    /// A host that keeps the queues of planned moves full, and restarts the watchdog in every
    /// cycle.
    pub fn feeding(build: &EngineBuild, program: &'a dyn Commands) -> Self {
        let acts = Box::new(feed::Acts::new(program.commands(), build.queue));
        Self::doing(build, acts, Events::new(), true)
    }

    fn doing(
        build: &EngineBuild,
        acts: Box<dyn Iterator<Item = Act> + 'a>,
        events: Events,
        awake: bool,
    ) -> Self {
        let mut acts: Box<dyn Iterator<Item = Act> + 'a> = Box::new(acts.fuse());
        let current = acts.next();
        let events = events.into_iter().peekable();
        let around = EngineInputs { enable: true, ..EngineInputs::default() };
        let mut host = Self {
            acts,
            current,
            later: VecDeque::new(),
            told: Vec::new(),
            events,
            cycle: 0,
            awake,
            fault: false,
            around,
            guard: build.guard.clone(),
            word_error: 0,
            commit_bits: build.outputs.commit_bits() & !Commit::LAST,
            outputs: 0,
            stray: 0,
        };
        host.happen();
        host
    }

    /// Applies the events of this cycle.
    fn happen(&mut self) {
        self.around = EngineInputs {
            kick: self.awake,
            broken: false,
            seek_source: None,
            seek: None,
            latch_arm: 0,
            snapshot: false,
            cut: false,
            ..self.around
        };
        while let Some((_, event)) = self.events.next_if(|(cycle, _)| *cycle <= self.cycle) {
            match event {
                Event::EStop(active) => self.around.estop = active,
                Event::LimitMin(active) => self.around.limit_min = active,
                Event::LimitMax(active) => self.around.limit_max = active,
                Event::Inputs0(active) => self.around.inputs[0] = active,
                Event::Inputs1(active) => self.around.inputs[1] = active,
                Event::Latch(active) => self.around.latch = active,
                Event::Stop(asked) => self.around.stop = asked,
                Event::Enable(wanted) => self.around.enable = wanted,
                Event::Kick => self.around.kick = true,
                Event::SeekSource(source) => self.around.seek_source = Some(source),
                Event::Seek(axes) => self.around.seek = Some(axes),
                Event::LatchArm(latches) => self.around.latch_arm |= latches,
                Event::Snapshot => self.around.snapshot = true,
                Event::Broken => self.around.broken = true,
                Event::Reset(asserted) => self.around.reset = asserted,
                Event::WordError(mask) => self.word_error = mask,
                Event::Name(axis, slot) => {
                    let put = Put { axis, word: CUT_WORD, data: slot.into() };
                    let interrupted = self.current.replace(Act::Put(put));
                    interrupted.into_iter().for_each(|act| self.later.push_front(act));
                }
                Event::Cut => self.around.cut = true,
                Event::Outputs(bits) => self.outputs = bits & self.commit_bits,
                Event::Stray(bits) => self.stray = bits,
            }
        }
    }

    /// The inputs of this cycle. During a fault the program only clears and waits.
    pub fn inputs(&self, fault: bool) -> EngineInputs {
        let inputs = self.around.levels(&self.guard);
        match self.current {
            Some(Act::Put(put)) if !fault => EngineInputs { put: Some(self.sent(put)), ..inputs },
            Some(Act::Start(mask)) if !fault => EngineInputs { start: Some(mask), ..inputs },
            Some(Act::Clear) => EngineInputs { clear: true, ..inputs },
            _ => inputs,
        }
    }

    /// A word as the host sends it: with its wrong number, and the outputs of a commit.
    fn sent(&self, put: Put) -> Put {
        let outputs = if put.axis == 0 { self.outputs } else { 0 };
        let bits = if put.word == COMMIT { outputs | self.stray } else { 0 };
        Put { word: put.word ^ self.word_error, data: put.data | bits, ..put }
    }

    /// Continues with the next command if the current one was accepted in this cycle.
    pub fn advance(&mut self, outputs: &EngineOutputs) {
        let fault = outputs.fault.is_some();
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
            self.go_on();
        }
        self.cycle += 1;
        self.happen();
    }

    /// Continues with the next action.
    fn go_on(&mut self) {
        self.current = self.later.pop_front().or_else(|| self.acts.next());
    }

    /// The word that the host offers now and the words after it: up to its next action that is no
    /// word, or to the last commit of the segments that it sends side by side. Empty if the host
    /// offers no word now.
    pub fn offered(&mut self) -> &[Put] {
        self.told.clear();
        let mut act = self.current.filter(|_| !self.fault);
        let mut ends = false;
        while let Some(Act::Put(put)) = act {
            if ends && put.word != COMMIT {
                break;
            }
            ends = put.word == COMMIT;
            self.told.push(self.sent(put));
            if self.told.len() == TOLD {
                break;
            }
            if self.told.len() > self.later.len() {
                self.later.extend(self.acts.next());
            }
            act = self.later.get(self.told.len() - 1).copied();
        }
        &self.told
    }

    /// Simulates one cycle of a core under this host, and returns its inputs and outputs.
    pub fn step(&mut self, core: &mut impl EngineCore) -> (EngineInputs, EngineOutputs) {
        let (inputs, outputs) = self.meet(|inputs| core.outputs(inputs));
        self.advance(&outputs);
        core.clock(&inputs);
        (inputs, outputs)
    }

    /// The inputs of a core in this cycle, and the outputs that they cause.
    pub fn meet(
        &mut self,
        mut core: impl FnMut(&EngineInputs) -> EngineOutputs,
    ) -> (EngineInputs, EngineOutputs) {
        let mut inputs = self.inputs(self.fault);
        let mut outputs = core(&inputs);
        // The host's inputs depend on the fault of the same cycle: evaluate again if the fault has
        // just changed.
        if outputs.fault.is_some() != self.fault {
            self.fault = outputs.fault.is_some();
            inputs = self.inputs(self.fault);
            outputs = core(&inputs);
        }
        (inputs, outputs)
    }

    /// Number of cycles in which the host's inputs stay the same, as long as the outputs make it
    /// wait and no new fault occurs.
    pub fn patience(&mut self, outputs: &EngineOutputs) -> u64 {
        match self.current {
            Some(Act::Put(_)) if outputs.put_ready => 0,
            _ => self.patience_but_for_words(outputs),
        }
    }

    /// As [`EngineHost::patience`], where words are accepted meanwhile.
    pub fn patience_but_for_words(&mut self, outputs: &EngineOutputs) -> u64 {
        let fault = outputs.fault.is_some();
        let blocked = match self.current {
            Some(Act::Wait(clocks)) => clocks.saturating_sub(1).into(),
            Some(Act::Put(_)) if fault => 0,
            Some(Act::Start(_)) if fault || outputs.start_ready => 0,
            Some(Act::Clear) if !fault => 0,
            _ => u64::MAX,
        };
        let EngineInputs { kick, broken, seek_source, seek, latch_arm, snapshot, cut, .. } =
            self.around;
        let lasting = kick == self.awake
            && !(broken || latch_arm != 0 || snapshot || cut)
            && seek_source.is_none()
            && seek.is_none();
        // The cycle before an event must be simulated by `advance`.
        let eventless = self
            .events
            .peek()
            .map_or(u64::MAX, |(cycle, _)| (cycle - 1).saturating_sub(self.cycle));
        if lasting { blocked.min(eventless) } else { 0 }
    }

    /// Skips this number of cycles, at most [`EngineHost::patience`].
    pub fn wait(&mut self, cycles: u64) {
        if let Some(Act::Wait(clocks)) = &mut self.current {
            // The number is at most the patience, which fits.
            *clocks = clocks.saturating_sub(u32::try_from(cycles).unwrap_or(u32::MAX));
        }
        self.cycle += cycles;
    }

    /// Continues after this many of the [`offered`](EngineHost::offered) words.
    pub fn accepted(&mut self, words: usize) {
        (0..words).for_each(|_| self.go_on());
    }

    /// Whether no command is left.
    pub fn is_done(&mut self) -> bool {
        self.current.is_none() && self.events.peek().is_none()
    }
}
