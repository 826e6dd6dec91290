//! The engine under the same host as every core: a segment is seven words and a commit.

mod fast;
mod feed;
pub mod replay;
pub mod run;

use carrystep_core::engine::{COMMIT, EngineInputs, EngineOutputs, Guard, Put};
use carrystep_core::{Command, Program, Segment};

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

/// What happens around the host, at a cycle; `true` is active, whatever the polarity of the pin.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Event {
    /// The e-stop.
    EStop(bool),
    /// The limits at the low ends.
    LimitMin(u8),
    /// The limits at the high ends.
    LimitMax(u8),
    /// The host's controlled stop.
    Stop(bool),
    /// The wish for power.
    Enable(bool),
    /// A sign of life, in this cycle.
    Kick,
    /// These axes wait for their limit from this cycle on.
    Home(u8),
    /// The segment protocol is broken, in this cycle.
    Broken,
}

/// Events in order of their cycles.
pub type Events = Vec<(u64, Event)>;

/// Feeds a program, a command at a time, each until it is taken, while events go on around it.
#[derive(Debug, Clone)]
pub struct EngineHost {
    acts: std::vec::IntoIter<Act>,
    current: Option<Act>,
    events: std::iter::Peekable<std::vec::IntoIter<(u64, Event)>>,
    cycle: u64,
    /// The host is heard of in every cycle.
    awake: bool,
    /// There was a fault in the cycle before.
    fault: bool,
    /// What is driven beside the program.
    around: EngineInputs,
    estop_low: bool,
    limits_low: u8,
}

impl EngineHost {
    /// A host with this to do, command by command; the drivers are enabled until an event says otherwise.
    pub fn new(guard: &Guard, program: &Program, events: &Events) -> Self {
        let mut acts = Vec::new();
        for command in program {
            match *command {
                Command::Segment { axis, segment } => acts.extend(puts(axis, &segment).into_iter().map(Act::Put)),
                Command::Start { mask } => acts.push(Act::Start(mask)),
                Command::Wait { clocks } => acts.push(Act::Wait(clocks)),
                Command::Clear => acts.push(Act::Clear),
            }
        }
        Self::doing(guard, acts, events.clone(), false)
    }

    /// A host that keeps the queues of planned moves full, and is heard of all the time.
    pub fn feeding(guard: &Guard, program: &Program) -> Self {
        Self::doing(guard, feed::acts(program), Events::new(), true)
    }

    fn doing(guard: &Guard, acts: Vec<Act>, events: Events, awake: bool) -> Self {
        let mut acts = acts.into_iter();
        let current = acts.next();
        let events = events.into_iter().peekable();
        let around = EngineInputs { enable: true, ..EngineInputs::default() };
        let limits_low = if guard.limits_low { 0xff } else { 0 };
        let estop_low = guard.estop_low;
        let mut host = Self { acts, current, events, cycle: 0, awake, fault: false, around, estop_low, limits_low };
        host.happen();
        host
    }

    /// Takes the events of this cycle.
    fn happen(&mut self) {
        self.around = EngineInputs { kick: self.awake, broken: false, home: None, ..self.around };
        while let Some((_, event)) = self.events.next_if(|(cycle, _)| *cycle <= self.cycle) {
            match event {
                Event::EStop(active) => self.around.estop = active,
                Event::LimitMin(active) => self.around.limit_min = active,
                Event::LimitMax(active) => self.around.limit_max = active,
                Event::Stop(asked) => self.around.stop = asked,
                Event::Enable(wanted) => self.around.enable = wanted,
                Event::Kick => self.around.kick = true,
                Event::Home(axes) => self.around.home = Some(axes),
                Event::Broken => self.around.broken = true,
            }
        }
    }

    /// What is driven in this cycle; of the program nothing but `clear` and waiting while there is a fault.
    pub fn inputs(&self, fault: bool) -> EngineInputs {
        let inputs = EngineInputs {
            estop: self.around.estop != self.estop_low,
            limit_min: self.around.limit_min ^ self.limits_low,
            limit_max: self.around.limit_max ^ self.limits_low,
            ..self.around
        };
        match self.current {
            Some(Act::Put(put)) if !fault => EngineInputs { put: Some(put), ..inputs },
            Some(Act::Start(mask)) if !fault => EngineInputs { start: Some(mask), ..inputs },
            Some(Act::Clear) => EngineInputs { clear: true, ..inputs },
            _ => inputs,
        }
    }

    /// Goes on where the command is done in this cycle.
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
            self.current = self.acts.next();
        }
        self.cycle += 1;
        self.happen();
    }

    /// One cycle of a core under this host: what goes in, and what comes out.
    pub fn step(&mut self, core: &mut impl EngineCore) -> (EngineInputs, EngineOutputs) {
        let (inputs, outputs) = self.meet(|inputs| core.outputs(inputs));
        self.advance(&outputs);
        core.clock(&inputs);
        (inputs, outputs)
    }

    /// What goes into a core in this cycle, and what comes out of it.
    pub fn meet(&mut self, mut core: impl FnMut(&EngineInputs) -> EngineOutputs) -> (EngineInputs, EngineOutputs) {
        let mut inputs = self.inputs(self.fault);
        let mut outputs = core(&inputs);
        // The host sees this cycle's fault: ask again where it has just changed.
        if outputs.fault.is_some() != self.fault {
            self.fault = outputs.fault.is_some();
            inputs = self.inputs(self.fault);
            outputs = core(&inputs);
        }
        (inputs, outputs)
    }

    /// How many cycles the host drives the same, as long as the outputs let it wait and there is no new fault.
    pub fn patience(&mut self, outputs: &EngineOutputs) -> u64 {
        let fault = outputs.fault.is_some();
        let blocked = match self.current {
            Some(Act::Wait(clocks)) => clocks.saturating_sub(1).into(),
            Some(Act::Put(_)) if fault || outputs.put_ready => 0,
            Some(Act::Start(_)) if fault || outputs.start_ready => 0,
            Some(Act::Clear) if !fault => 0,
            _ => u64::MAX,
        };
        let lasting = self.around.kick == self.awake && !self.around.broken && self.around.home.is_none();
        // The last cycle before an event is one of `advance`.
        let eventless = self.events.peek().map_or(u64::MAX, |(cycle, _)| (cycle - 1).saturating_sub(self.cycle));
        if lasting { blocked.min(eventless) } else { 0 }
    }

    /// So many cycles of [`EngineHost::patience`] have passed.
    pub fn wait(&mut self, cycles: u64) {
        if let Some(Act::Wait(clocks)) = &mut self.current {
            // Never more than its patience, which fits.
            *clocks = clocks.saturating_sub(u32::try_from(cycles).unwrap_or(u32::MAX));
        }
        self.cycle += cycles;
    }

    /// Nothing is left.
    pub fn is_done(&mut self) -> bool {
        self.current.is_none() && self.events.peek().is_none()
    }
}
