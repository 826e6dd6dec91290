//! The engine: one adder serves up to eight axes and makes the same pulses as that many parallel
//! axes (docs/engine.md).
//!
//! ```text
//!             .------.  beat, axis                                    estop, kick, enable
//!             | slot |-----+----------+-----------+                         v
//!             '------'     v          v           v                     .------------.
//!  put_*  -------------> .-------.  .-------.   .-------. steps, phases | supervisor |
//!                        | queue |->| store |==>| adder |-------.       '------------'
//!                        '-------'  '-------'<==|       |       v           v
//!                          ^ pulses, losses     '-------'   .-------.   .-------.
//!                          |                        v V     | wheel |   | stops |
//!                        .--------.            .----------. '-------'   '-------'
//!   step, dir <----------| pulser |<--.        | switches |-----|-> found ^   | frozen, ramp,
//!                        '--------'   |        '----------'     |             v halted, cause
//!                        one per axis '---- the events of this phase
//! ```
//!
//! In each tick every axis has a time slot of 13 clocks, in which the adder advances its P, V and
//! A. A clock of a time slot is a beat. Results of all time slots
//! are committed together at the end of the tick, the strobe.
//!
//! Interface: the host writes segments word by word (`put`) into a queue of 7, 15 or 31 segments
//! per axis and starts axes by a mask. The engine outputs the state of all axes in every tick
//! (`state`), on request as a snapshot. The inputs `estop`, `limit_min`, `limit_max`, `inputs_0`,
//! `inputs_1`, `latch` and `more_latches` come directly from pins.
//!
//! Cost: the state of an axis is in block RAM, except the pin timers of its pulser. The logic
//! therefore grows little with the number of axes. The price is time: a tick must have at least 13
//! clocks per axis and two more.
//!
//! This file contains the ports and the parts; `wiring` connects them. Further terms of the code:
//! `event_wheel` holds pending steps, which wait for their phase; `held_back` is a step that
//! the pin timing holds back; `late` means that a second step arrived while one was held back;
//! `dry` means that a queue is empty when its next segment is due.

use crate::HdlError;
use crate::parameters::{CLOCKS_PER_TICK, OUTPUTS_OFF_AT_RAMPS};
use crate::primitives::constant::{Literal, Parameter, ParameterRefusal};
use crate::primitives::formula::Formula;
use crate::primitives::optional::Optional;
use crate::primitives::per_axis::PerAxis;
use crate::primitives::register::{Input, Register};
use crate::primitives::word::Word;
use carrystep_core::EngineBuild;
use carrystep_core::engine::{CAUSE_BITS, least_clocks};
use rust_hdl_core::prelude::*;
use std::slice::from_mut;

pub mod adder;
pub mod cut_control;
pub mod edge_latch;
pub mod event_wheel;
pub mod latch_bank;
pub mod layout;
pub mod output_control;
mod parts_of_any_size;
pub mod pulse_width;
pub mod pulser;
pub mod queue;
pub mod readout;
pub mod resets;
pub mod seek_control;
#[cfg(not(test))] // crates/hdl/tests/engine.rs says why
pub(crate) mod sim;
pub mod step_counts;
pub mod stops;
pub mod store;
pub mod supervisor;
pub mod switches;
pub mod time_slot;
pub mod wide;
mod wiring;

use adder::Adder;
use cut_control::CutControl;
use edge_latch::EdgeLatch;
use event_wheel::EventWheel;
use latch_bank::{LatchBank, MORE};
use output_control::OutputControl;
use parts_of_any_size::PartsOfAnySize;
use pulse_width::PulseWidth;
use pulser::Pulser;
use queue::Queue;
use readout::Readout;
use resets::Resets;
use seek_control::SeekControl;
use step_counts::StepCounts;
use stops::Stops;
use store::Store;
use supervisor::Supervisor;
use switches::Switches;
use time_slot::TimeSlot;

/// The engine of N axes, 1 to 8. The ports and the part of further latches exist in a build with several
/// latches only.
#[derive(LogicBlock, Default)]
pub struct Engine<const N: usize> {
    /// The clock.
    pub clock: Input<Clock>,
    /// The host offers a word of a segment and holds it until the engine accepts it, which takes up
    /// to a tick while the queue has space.
    pub put_valid: Input<Bit>,
    /// The axis of the offered word, as a number from 0. Also the axis whose free queue space
    /// `room` reports.
    pub put_axis: Input<Word<3>>,
    /// The number of the word. The words of a segment come in order: 0 is its duration in ticks
    /// less 1; 1 and 2 are the initial V, 3 and 4 the initial A, 5 and 6 J, low half first; 7
    /// commits the segment. A word 8 belongs to no segment: its bits 4 to 0 are the slot of the
    /// last segment that the next cut keeps.
    pub put_word: Input<Word<4>>,
    /// The offered word. In a commit, bit 0 is 1 if the segment is the last of its move. In a
    /// commit of axis 0, bits 11 to 4 are the outputs that change where the segment begins, bits 19
    /// to 12 their levels, and bits 31 to 20 the duty of the PWM, which changes if bit 1 is 1.
    pub put_data: Input<Word<32>>,
    /// The engine accepts an offered word in this clock.
    pub put_ready: Signal<Out, Bit>,
    /// The host offers a start and holds it until the engine accepts it, which it does in the last
    /// clock of a tick.
    pub start_valid: Input<Bit>,
    /// The axes to start; bit i is axis i.
    pub start_mask: Input<Word<N>>,
    /// The engine accepts an offered start in this clock.
    pub start_ready: Signal<Out, Bit>,
    /// The host requests a cut in all axes for which it has offered a word 8; asserted for one
    /// clock.
    pub cut: Input<Bit>,
    /// A cut was requested and is not decided yet.
    pub cut_busy: Signal<Out, Bit>,
    /// The last cut was refused: nothing was dropped.
    pub cut_refused: Signal<Out, Bit>,
    /// Clears a stop. The host holds it until `fault` falls.
    pub clear: Input<Bit>,
    /// Stops the engine and returns it to its state at configuration; the positions stay. It is
    /// synchronous, unlike the pins, and begins in any clock. A host that does not need it ties it
    /// to 0.
    pub reset: Input<Bit>,
    /// The host requests a controlled stop by a ramp; asserted for one clock or longer.
    pub stop: Input<Bit>,
    /// The host has broken the segment protocol; asserted for one clock or longer. The engine
    /// freezes all axes.
    pub broken: Input<Bit>,
    /// The host replaces the source of seeks.
    pub seek_source_valid: Input<Bit>,
    /// The source from the next clock on, valid with `seek_source_valid`: in bits 2 to 0 the axis
    /// and in bits 4 and 3 the row of a switch; in bit 5 that each axis waits for its own switch in
    /// that row; in bit 6 the debounced state that is the hit, 1 active.
    pub seek_source: Input<Word<7>>,
    /// The host replaces the mask of the axes that wait for the source.
    pub seek_valid: Input<Bit>,
    /// The axes that wait for the source from the next clock on, valid with `seek_valid`; bit i is
    /// axis i. A mask of 0 ends the seek.
    pub seek_mask: Input<Word<N>>,
    /// The host arms the latch for one edge, and sets the count of further edges to 0.
    pub latch_arm: Input<Bit>,
    /// The host requests a snapshot of the state of all axes; asserted for one clock or longer.
    pub snapshot: Input<Bit>,
    /// A sign of life of the host: the watchdog restarts in each clock in which it is asserted.
    pub kick: Input<Bit>,
    /// The host requests power for the motor drivers, as long as it is asserted.
    pub enable: Input<Bit>,
    /// The e-stop pin; asynchronous. The parameter `ESTOP_LOW` gives its active level. It stops the
    /// axes if it is active for a whole tick.
    pub estop: Input<Bit>,
    /// The pins of the limit switches at the low ends; bit i is axis i; asynchronous. `LIMITS`
    /// tells how they are wired, `LIMITS_LOW` their active level. Each is sampled once per round.
    pub limit_min: Input<Word<N>>,
    /// The pins of the limit switches at the high ends; bit i is axis i; asynchronous. They are
    /// used only if `LIMITS` is 1.
    pub limit_max: Input<Word<N>>,
    /// The pins of the inputs that `INPUTS_0` names; bit 0 is the probe; asynchronous. Each is
    /// debounced as the limits are.
    pub inputs_0: Input<Word<N>>,
    /// The pins of the inputs that `INPUTS_1` names; bit 0 is the interlock, which stops all axes
    /// by a ramp; asynchronous.
    pub inputs_1: Input<Word<N>>,
    /// The pin of the latch; asynchronous. It is used unless `LATCH_LOOKS` is 0.
    pub latch: Input<Bit>,
    /// A word of the state of an axis is output in this clock.
    pub state_valid: Signal<Out, Bit>,
    /// The copy to which it belongs: 0 hit of a seek, 1 live, 2 snapshot, 3 latch. Of the item 2
    /// it is the row of the switch: 0 and 1 limits at the low and the high ends, 2 and 3 inputs.
    pub state_page: Signal<Out, Word<2>>,
    /// The axis, as a number from 0.
    pub state_axis: Signal<Out, Word<3>>,
    /// The meaning of the word: 0 discarded steps, 1 remaining ticks, 2 switch (bit 7 its debounced
    /// state, bit 6 the level of its pin), 3 number of the tick, 4 and 5 P (low and high half), 6
    /// position in steps, 7 status.
    pub state_item: Signal<Out, Word<3>>,
    /// The word. Of the status only bits 15 to 0 have a meaning.
    pub state: Signal<Out, Word<32>>,
    /// All live words of this tick have been output; asserted for one clock.
    pub refreshed: Signal<Out, Bit>,
    /// The number of segments for which the queue of the axis `put_axis` has space.
    pub room: Signal<Out, Word<5>>,
    /// `room` is valid in this clock, once in the time slot of that axis.
    pub room_valid: Signal<Out, Bit>,
    /// The STEP pins; bit i is axis i. A rising edge is a step.
    pub step: PerAxis<Signal<Out, Bit>, N>,
    /// The DIR pins; bit i is axis i; 1 is backward.
    pub dir: PerAxis<Signal<Out, Bit>, N>,
    /// The outputs, which change where a segment of axis 0 begins; 1 is active.
    pub outputs: Signal<Out, Word<8>>,
    /// The pin of the PWM; 1 is active.
    pub pwm: Signal<Out, Bit>,
    /// The motor drivers are to be powered.
    pub enabled: Signal<Out, Bit>,
    /// All axes are at rest and no start is armed.
    pub idle: Signal<Out, Bit>,
    /// A stop has been called and has not been cleared.
    pub fault: Signal<Out, Bit>,
    /// The stop is complete: no axis moves any more.
    pub halted: Signal<Out, Bit>,
    /// The engine is returning to its state at configuration, after `reset`.
    pub resetting: Signal<Out, Bit>,
    /// The first cause of the stop: 0 e-stop, 1 overrun, 2 protocol, 3 watchdog,
    /// 4 overspeed, 5 limit, 6 underrun, 7 stop of the host, 8 interlock. It has no meaning while
    /// `fault` is not asserted.
    pub cause: Signal<Out, Word<CAUSE_BITS>>,
    /// The axes that caused the stop; bit i is axis i. It has no meaning while `fault` is not
    /// asserted.
    pub culprits: Signal<Out, Word<N>>,
    /// A start is armed.
    pub armed: Signal<Out, Bit>,
    /// The host requests power for the drivers and they have been powered for long enough, so that
    /// a start can be accepted.
    pub ready: Signal<Out, Bit>,
    /// The axes that wait for the source of their seek; bit i is axis i.
    pub seeking: Signal<Out, Word<N>>,
    /// The axes that have hit the source, until the host ends the seek; bit i is axis i.
    pub hits: Signal<Out, Word<N>>,
    /// The latch waits for its edge.
    pub latch_armed: Signal<Out, Bit>,
    /// The edges since the latch was armed that it did not latch, at most 15.
    pub latch_edges: Signal<Out, Word<4>>,
    /// Axes start at the end of this clock; asserted for one clock per start.
    pub started: Signal<Out, Bit>,
    /// The pins of latches 1 to 3; asynchronous. `LATCH_LOOKS_1` and the following tell which of
    /// them are used.
    pub more_latches: Optional<Input<Word<MORE>>>,
    /// The host arms each of these latches for one edge, and sets the count of its further edges to
    /// 0; bit 0 is latch 1. A latch that the build does not have must not be armed.
    pub more_latch_arm: Optional<Input<Word<MORE>>>,
    /// These latches wait for their edges; bit 0 is latch 1.
    pub more_latch_armed: Optional<Signal<Out, Word<MORE>>>,
    /// The edges since each of them was armed that it did not latch, at most 15, in four bits each,
    /// those of latch 1 lowest.
    pub more_latch_edges: Optional<Signal<Out, Word<12>>>,
    /// The number of the record that each latch holds, in two bits each, that of latch 0 lowest.
    pub latch_records: Optional<Signal<Out, Word<8>>>,
    /// The number of the record to which the words of page 3 belong in this tick.
    pub state_record: Optional<Signal<Out, Word<2>>>,
    time_slot: TimeSlot<N>,
    adder: Adder,
    queue: Queue,
    step_counts: StepCounts,
    cut_control: CutControl,
    pub(crate) store: Store,
    event_wheel: EventWheel<N>,
    output_control: OutputControl,
    pulse_width: PulseWidth,
    switches: Switches<N>,
    seek_control: SeekControl<N>,
    edge_latch: EdgeLatch,
    latch_bank: Optional<LatchBank>,
    readout: Readout,
    stops: Stops<N>,
    resets: Resets,
    supervisor: Supervisor,
    pulser: PerAxis<Pulser, N>,
    waits: Register<Bit>, // `armed`
    // The axes of the start. The mask rotates with the time slots: bit 0 is the axis of the present
    // slot.
    mask: Register<Word<N>>,
    going: Register<Bit>,
    // The word of the host was accepted in the present time slot, and is not a commit.
    taken: Register<Bit>,
    taken_word: Register<Word<3>>,
    unfed: Register<Bit>,  // an axis of the mask has no waiting segment
    held: Register<Bit>,   // an axis of the mask still runs after this tick
    drops: Register<Bit>,  // an axis of the mask has hit the source of its seek
    active: Register<Bit>, // an axis runs or has a waiting segment
    rest_1: Register<Bit>, // no axis was active in the last tick
    rest_2: Register<Bit>, // no axis was active in the last two ticks
    strobe: Signal<Local, Bit>,
    masked: Signal<Local, Bit>,
    nobody: Signal<Local, Bit>,
    // The axis `put_axis` accepts a word in this clock if its queue has space.
    listens: Signal<Local, Bit>,
    is_own: Signal<Local, Bit>, // the time slot is that of the axis `put_axis`
    take: Signal<Local, Bit>,
    names: Signal<Local, Bit>, // the offered word names the slot of a cut
    outputs_off: Signal<Local, Bit>,
    may_start: Signal<Local, Bit>,
    free: Signal<Local, Bit>,
    decides: Signal<Local, Bit>,
    go: Signal<Local, Bit>,
    rests: Signal<Local, Bit>,
    pins_busy: Signal<Local, Bit>,
    late: Signal<Local, Word<N>>,
    late_bit: PerAxis<Signal<Local, Word<N>>, N>,
    counted: PerAxis<Signal<Local, Word<6>>, N>,
    counts: Signal<Local, Word<6>>,
    none: Literal<6, 0>,
    no_axes: Literal<N, 0>,
    one_axis: PerAxis<Parameter<N>, N>,
    commit: Literal<4, 7>,
    by_one: Literal<1, 1>,
    to_top: Parameter<3>,
    axes: Parameter<4>,
    off_at_ramps: Parameter<1>,
    outputs_off_at_ramps_out_of_range: ParameterRefusal,
    clocks_per_tick_too_few_for_the_axes: ParameterRefusal,
}

impl<const N: usize> Engine<N> {
    /// Makes the engine of a build. The caller has checked the build and ensures that it has N axes.
    fn new(build: &EngineBuild) -> Result<Self, HdlError> {
        let mut engine = Self::default();
        engine.set(build)?;
        Ok(engine)
    }

    /// Replaces the parts that depend on the build. An expression `Self { .. }` with
    /// `..Self::default()` would move each of the other fields by itself, for each N.
    fn set(&mut self, build: &EngineBuild) -> Result<(), HdlError> {
        let clocks = CLOCKS_PER_TICK.of::<32>(build.timebase.clocks_per_tick());
        let least = u64::from(least_clocks(N, build.timebase.phases()));
        let off_at_ramps = OUTPUTS_OFF_AT_RAMPS.of::<32>(build.outputs.off_at_ramps);
        PartsOfAnySize {
            pulsers: &mut *self.pulser,
            stores: from_mut(&mut self.store),
            queues: from_mut(&mut self.queue),
            readouts: from_mut(&mut self.readout),
            cut_control: &mut self.cut_control,
            output_control: &mut self.output_control,
            pulse_width: &mut self.pulse_width,
            edge_latch: &mut self.edge_latch,
            supervisor: &mut self.supervisor,
        }
        .set(build)?;
        self.time_slot = TimeSlot::new();
        self.event_wheel = EventWheel::new(&build.timebase);
        self.switches = Switches::new(&build.guard);
        self.seek_control = SeekControl::new();
        let several = build.has_several_latches();
        self.more_latches = Optional::when(several);
        self.more_latch_arm = Optional::when(several);
        self.more_latch_armed = Optional::when(several);
        self.more_latch_edges = Optional::when(several);
        self.latch_records = Optional::when(several);
        self.state_record = Optional::when(several);
        self.latch_bank = Optional::of(several.then(|| LatchBank::new(&build.guard)));
        self.stops = Stops::new(&build.guard);
        self.axes = Parameter::new(N as u64);
        self.off_at_ramps = Parameter::of(&off_at_ramps.bits(0));
        self.outputs_off_at_ramps_out_of_range =
            ParameterRefusal::of(&off_at_ramps.is_outside(0, 1));
        self.clocks_per_tick_too_few_for_the_axes =
            ParameterRefusal::of(&clocks.whole().is_less(&Formula::number(least)));
        self.to_top = Parameter::new(N as u64 - 1);
        self.one_axis = PerAxis::from_fn(|axis| Parameter::new(1 << axis));
        self.rest_1 = Register::new(true);
        self.rest_2 = Register::new(true);
        Ok(())
    }
}

#[cfg(test)]
mod tests;
