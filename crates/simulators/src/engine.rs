//! Programs on a simulated engine: what a host does with each command, and the events around it. A
//! segment is sent as seven words and a commit.

mod fast;
mod feed;
mod host;
pub mod replay;
pub mod run;

pub use host::EngineHost;

use carrystep_core::engine::{COMMIT, Commit, EngineInputs, EngineOutputs, Put, SeekSource};
use carrystep_core::{Command, OutputChange, Segment};

/// An engine that is simulated in Rust, clock by clock.
pub trait EngineCore {
    /// The outputs of this cycle for these inputs.
    fn outputs(&mut self, inputs: &EngineInputs) -> EngineOutputs;
    /// Advances to the next cycle.
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

/// One action of the host.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Act {
    Put(Put),
    Start(u8),
    Wait(u32),
    Clear,
}

/// The words of a segment, and its commit, with what changes at the outputs where it begins.
///
/// A segment of 0 ticks cannot be encoded, because the first word is `ticks - 1`; the sender
/// refuses it.
pub fn puts(axis: u8, segment: &Segment, outputs: OutputChange) -> Vec<Put> {
    let Some(left) = segment.ticks.checked_sub(1) else { return Vec::new() };
    let halves = |x: i64| [x as u32, (x >> 32) as u32];
    let words =
        [[left].as_slice(), &halves(segment.v), &halves(segment.a), &halves(segment.j)].concat();
    let commit = Commit { last: segment.last, outputs };
    let commit = Put { axis, word: COMMIT, data: commit.word() };
    (0..).zip(words).map(|(word, data)| Put { axis, word, data }).chain([commit]).collect()
}

/// The actions of a host that executes one command after the other. `outputs` is what changes with
/// the next segment of axis 0.
fn acts_of(command: &Command, outputs: &mut OutputChange) -> Vec<Act> {
    match *command {
        Command::Segment { axis, segment } => {
            let outputs = if axis == 0 { std::mem::take(outputs) } else { OutputChange::NONE };
            puts(axis, &segment, outputs).into_iter().map(Act::Put).collect()
        }
        Command::Outputs(change) => {
            *outputs = outputs.then(change);
            Vec::new()
        }
        Command::Start { mask } => vec![Act::Start(mask)],
        Command::Wait { clocks } => vec![Act::Wait(clocks)],
        Command::Clear => vec![Act::Clear],
    }
}

/// An event around the host at a given cycle. `true` means active, regardless of the polarity of
/// the pin.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Event {
    /// The e-stop is pressed or released.
    EStop(bool),
    /// New state of the limits at the low ends, a bit for each axis.
    LimitMin(u8),
    /// New state of the limits at the high ends, a bit for each axis.
    LimitMax(u8),
    /// New state of the inputs of row 2, bit 0 the probe.
    Inputs0(u8),
    /// New state of the inputs of row 3, bit 0 the interlock.
    Inputs1(u8),
    /// New state of the latches' pins, bit k that of latch k.
    Latch(u8),
    /// The host requests a controlled stop, or withdraws the request.
    Stop(bool),
    /// The host requests power for the drivers, or removes it.
    Enable(bool),
    /// The host sends a valid request in this cycle, which restarts the watchdog.
    Kick,
    /// The source of seeks from the next cycle on.
    SeekSource(SeekSource),
    /// Mask of the axes that wait for the source from the next cycle on.
    Seek(u8),
    /// The host arms these latches in this cycle, bit k latch k.
    LatchArm(u8),
    /// The host requests a snapshot in this cycle.
    Snapshot,
    /// The host violates the segment protocol in this cycle.
    Broken,
    /// The `reset` input is asserted, or released.
    Reset(bool),
    /// The host numbers its words wrongly from this cycle on: the bits of this mask are inverted in
    /// the number of every word. 0 ends it.
    WordError(u8),
    /// The host names the slot of a cut for an axis, before it goes on with its commands.
    Name(u8, u8),
    /// The host requests a cut in this cycle.
    Cut,
    /// The host sets these bits of every commit of axis 0 from this cycle on, as far as the build
    /// has outputs for them. 0 ends it.
    Outputs(u32),
    /// The host sets these bits of every commit from this cycle on, whatever the build has. 0 ends
    /// it.
    Stray(u32),
}

/// Events, in the order of their cycles.
pub type Events = Vec<(u64, Event)>;
