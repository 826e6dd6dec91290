//! The engine with several adders: as many axes as there are adders share a time slot, so that a tick
//! needs fewer clocks. It makes the same pulses as the engine with one adder (docs/engine.md).
//!
//! ```text
//!            .------------.  beat                     axis i: time slot i / K, lane i % K
//!            | lane_slots |----+------------------+--------------- ...
//!            '------------'    v lane 0           v lane 1
//!  put_*  ------------> .---------------.  .---------------.       found  .----------.   .-------.
//!                       | queue  store  |  | queue  store  | ------------>| findings |-->| stops |
//!                       | adder         |  | adder         |              '----------'   '-------'
//!                       | switches      |  | switches      | hits    .-----------.
//!                       | readout       |  | readout       |-------->| lane_seek |
//!                       | wheel         |  | wheel         |<--------'-----------'
//!                       '---------------'  '---------------'  slows
//!                               v                  v
//!                     .--------------------------------------.
//!                     |     one pulser per axis, the pins    |
//!                     '--------------------------------------'
//! ```
//!
//! A lane is an adder with the memories and the parts that belong to it: those of the engine with
//! one adder, unchanged. They use the numbers of the axes in the whole engine, so that all lanes have
//! the same Verilog. What acts on all axes exists once: stops, resets, supervisor, cuts, starts,
//! latches, outputs, and the seek.
//!
//! Interface: as that of [`super::Engine`]; each lane outputs words of state of its own.
//!
//! Cost: a lane needs about as much as an engine of one axis without its pins. A tick has at least 13
//! clocks per time slot and three more.

use super::adder::Adder;
use super::cut_control::CutControl;
use super::edge_latch::EdgeLatch;
use super::event_wheel::EventWheel;
use super::output_control::OutputControl;
use super::parts_of_any_size::PartsOfAnySize;
use super::pulse_width::PulseWidth;
use super::pulser::Pulser;
use super::queue::Queue;
use super::readout::Readout;
use super::resets::Resets;
use super::step_counts::StepCounts;
use super::stops::Stops;
use super::store::Store;
use super::supervisor::Supervisor;
use super::switches::Switches;
use crate::HdlError;
use crate::parameters::{CLOCKS_PER_TICK, OUTPUTS_OFF_AT_RAMPS};
use crate::primitives::constant::{Literal, Parameter, ParameterRefusal};
use crate::primitives::formula::Formula;
use crate::primitives::per_axis::{PerAxis, PerLane};
use crate::primitives::register::{Input, Register};
use crate::primitives::word::Word;
use carrystep_core::EngineBuild;
use carrystep_core::engine::{CAUSE_BITS, least_clocks_of_adders};
use rust_hdl_core::prelude::*;

pub mod count_place;
pub mod findings;
pub mod lane_counts;
pub mod lane_seek;
pub mod lane_slots;
mod wiring;

use count_place::CountPlace;
use findings::Findings;
use lane_counts::LaneCounts;
use lane_seek::LaneSeek;
use lane_slots::LaneSlots;

/// The engine of N axes on K adders, 2 to N. It has at most one latch.
#[derive(LogicBlock, Default)]
pub struct WideEngine<const N: usize, const K: usize> {
    /// The clock.
    pub clock: Input<Clock>,
    /// The host offers a word of a segment and holds it until the engine accepts it, which takes up
    /// to a tick while the queue has space. Of the axes of one time slot, one can take a word.
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
    /// Each adder outputs a word of the state of an axis in this clock; bit k is adder k. The five
    /// ports of these words have one element for each adder, that of adder 0 lowest.
    pub state_valid: PerAxis<Signal<Out, Bit>, K>,
    /// The copy to which it belongs: 0 hit of a seek, 1 live, 2 snapshot, 3 latch. Of the item 2
    /// it is the row of the switch: 0 and 1 limits at the low and the high ends, 2 and 3 inputs.
    pub state_page: PerAxis<Signal<Out, Word<2>>, K>,
    /// The axis, as a number from 0.
    pub state_axis: PerAxis<Signal<Out, Word<3>>, K>,
    /// The meaning of the word: 0 discarded steps, 1 remaining ticks, 2 switch (bit 7 its debounced
    /// state, bit 6 the level of its pin), 3 number of the tick, 4 and 5 P (low and high half), 6
    /// position in steps, 7 status.
    pub state_item: PerAxis<Signal<Out, Word<3>>, K>,
    /// The word. Of the status only bits 15 to 0 have a meaning.
    pub state: PerAxis<Signal<Out, Word<32>>, K>,
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
    lane_slots: LaneSlots<N>,
    adder: PerLane<Adder, K>,
    queue: PerLane<Queue, K>,
    step_counts: PerLane<StepCounts, K>,
    pub(crate) store: PerLane<Store, K>,
    event_wheel: PerLane<EventWheel<N>, K>,
    switches: PerLane<Switches<N>, K>,
    readout: PerLane<Readout, K>,
    count_place: PerAxis<CountPlace, N>,
    lane_counts: PerLane<LaneCounts<N>, K>,
    findings: Findings<N, K>,
    lane_seek: LaneSeek<N, K>,
    cut_control: CutControl,
    output_control: OutputControl,
    pulse_width: PulseWidth,
    edge_latch: EdgeLatch,
    stops: Stops<N>,
    resets: Resets,
    supervisor: Supervisor,
    pulser: PerLane<Pulser, N>,
    waits: Register<Bit>, // `armed`
    // The axes of the start. The mask rotates with the time slots: bit k is the axis of lane k in
    // the present slot.
    mask: Register<Word<N>>,
    going: Register<Bit>,
    // The lane whose axis has accepted a word of the host in the present time slot that is not a
    // commit, one-hot.
    taken: Register<Word<K>>,
    taken_word: Register<Word<3>>,
    unfed: Register<Bit>,   // an axis of the mask has no waiting segment
    held: Register<Bit>,    // an axis of the mask still runs after this tick
    drops: Register<Bit>,   // an axis of the mask has hit the source of its seek
    active: Register<Bit>,  // an axis runs or has a waiting segment
    rest_1: Register<Bit>,  // no axis was active in the last tick
    rest_2: Register<Bit>,  // no axis was active in the last two ticks
    meeting: Register<Bit>, // in this tick an axis had a reason to output its own hit
    strobe: Signal<Local, Bit>,
    phase_start: Signal<Local, Bit>,
    ends: Signal<Local, Bit>, // the last beat of a time slot
    // Of each lane: its axis as a number, now and in the next clock; one-hot, and as its wheel takes
    // it; the axis is one of the mask; it is `put_axis`.
    axis: PerAxis<Signal<Local, Word<3>>, K>,
    axis_next: PerAxis<Signal<Local, Word<3>>, K>,
    axis_one_hot: PerAxis<Signal<Local, Word<N>>, K>,
    masked: PerAxis<Signal<Local, Bit>, K>,
    is_own: PerAxis<Signal<Local, Bit>, K>,
    own_bit: PerAxis<Signal<Local, Word<K>>, K>,
    own_lane: Signal<Local, Word<K>>, // the lane of `put_axis` in the present time slot
    own_full: Signal<Local, Bit>,
    own_room: Signal<Local, Word<5>>,
    nobody: Signal<Local, Bit>,
    // The axis `put_axis` accepts a word in this clock if its queue has space.
    listens: Signal<Local, Bit>,
    take: Signal<Local, Bit>,
    names: Signal<Local, Bit>, // the offered word names the slot of a cut
    // Collected from all lanes in the last beat.
    some_unfed: Signal<Local, Bit>,
    some_held: Signal<Local, Bit>,
    some_drop: Signal<Local, Bit>,
    some_active: Signal<Local, Bit>,
    some_meet: Signal<Local, Bit>,
    some_miss: Signal<Local, Bit>,
    misplaced: Signal<Local, Bit>,
    // One bit of each lane, for the parts that all lanes share.
    some_run: Signal<Local, Bit>,
    too_fast: Signal<Local, Word<K>>,
    limits: Signal<Local, Word<K>>,
    dries: Signal<Local, Word<K>>,
    states: Signal<Local, Word<K>>,
    goes_on: Signal<Local, Word<K>>,
    fast_bit: PerAxis<Signal<Local, Word<K>>, K>,
    limit_bit: PerAxis<Signal<Local, Word<K>>, K>,
    dry_bit: PerAxis<Signal<Local, Word<K>>, K>,
    state_bit: PerAxis<Signal<Local, Word<K>>, K>,
    going_bit: PerAxis<Signal<Local, Word<K>>, K>,
    // What lane 0 has for the outputs.
    fresh: Signal<Local, Word<5>>,
    live: Signal<Local, Word<5>>,
    follows: Signal<Local, Bit>,
    starts: Signal<Local, Bit>,
    interlock: Signal<Local, Bit>,
    samples: Signal<Local, Bit>,
    events: Signal<Local, Word<N>>,
    backward: Signal<Local, Word<N>>,
    outputs_off: Signal<Local, Bit>,
    may_start: Signal<Local, Bit>,
    free: Signal<Local, Bit>,
    decides: Signal<Local, Bit>,
    go: Signal<Local, Bit>,
    rests: Signal<Local, Bit>,
    pins_busy: Signal<Local, Bit>,
    late: Signal<Local, Word<N>>,
    late_bit: PerAxis<Signal<Local, Word<N>>, N>,
    all_counts: Signal<Local, Word<48>>,
    no_counts: Literal<48, 0>,
    no_axes: Literal<N, 0>,
    no_lanes: Literal<K, 0>,
    no_slot: Literal<5, 0>,
    one_axis: PerAxis<Parameter<N>, N>,
    one_lane: PerAxis<Parameter<K>, K>,
    at_counts: PerAxis<Parameter<6>, N>,
    // The number of each lane; how far the one-hot axis is rotated for its wheel; 1 for lane 0.
    lane_number: PerAxis<Parameter<3>, K>,
    to_wheel: PerAxis<Parameter<4>, K>,
    from_wheel: PerAxis<Parameter<4>, K>,
    is_first: PerAxis<Parameter<1>, K>,
    commit: Literal<4, 7>,
    by_lanes: Parameter<4>,
    to_top: Parameter<4>,
    axes: Parameter<4>,
    off_at_ramps: Parameter<1>,
    outputs_off_at_ramps_out_of_range: ParameterRefusal,
    clocks_per_tick_too_few_for_the_axes: ParameterRefusal,
}

impl<const N: usize, const K: usize> WideEngine<N, K> {
    /// Makes the engine of a build. The caller has checked the build and ensures that it has N axes
    /// and K adders.
    ///
    /// It is made on the heap, by a function of its own for each size: the stack of a thread does not
    /// hold one of each.
    #[inline(never)]
    pub(super) fn new(build: &EngineBuild) -> Result<Box<Self>, HdlError> {
        let mut engine = Box::<Self>::default();
        engine.set(build)?;
        Ok(engine)
    }

    /// Replaces the parts that depend on the build, as in [`super::Engine`].
    fn set(&mut self, build: &EngineBuild) -> Result<(), HdlError> {
        let clocks = CLOCKS_PER_TICK.of::<32>(build.timebase.clocks_per_tick());
        let least = u64::from(least_clocks_of_adders(N, K, build.timebase.phases()));
        let off_at_ramps = OUTPUTS_OFF_AT_RAMPS.of::<32>(build.outputs.off_at_ramps);
        PartsOfAnySize {
            pulsers: &mut self.pulser,
            stores: &mut self.store,
            queues: &mut self.queue,
            readouts: &mut self.readout,
            cut_control: &mut self.cut_control,
            output_control: &mut self.output_control,
            pulse_width: &mut self.pulse_width,
            edge_latch: &mut self.edge_latch,
            supervisor: &mut self.supervisor,
        }
        .set(build)?;
        self.lane_slots = LaneSlots::new(K);
        self.event_wheel = PerLane::from_fn(|_| EventWheel::new(&build.timebase));
        self.switches = PerLane::from_fn(|_| Switches::new(&build.guard));
        self.findings = Findings::new();
        self.lane_seek = LaneSeek::new();
        self.stops = Stops::new(&build.guard);
        self.axes = Parameter::new(N as u64);
        self.off_at_ramps = Parameter::of(&off_at_ramps.bits(0));
        self.outputs_off_at_ramps_out_of_range =
            ParameterRefusal::of(&off_at_ramps.is_outside(0, 1));
        self.clocks_per_tick_too_few_for_the_axes =
            ParameterRefusal::of(&clocks.whole().is_less(&Formula::number(least)));
        self.by_lanes = Parameter::new(K as u64);
        self.to_top = Parameter::new(N as u64 - K as u64);
        self.one_axis = PerAxis::from_fn(|axis| Parameter::new(1 << axis));
        self.at_counts = PerAxis::from_fn(|axis| Parameter::new(6 * axis as u64));
        self.one_lane = PerAxis::from_fn(|lane| Parameter::new(1 << lane));
        self.lane_number = PerAxis::from_fn(|lane| Parameter::new(lane as u64));
        self.is_first = PerAxis::from_fn(|lane| Parameter::new((lane == 0).into()));
        // The wheel finds the axis of the slot before by one step back. In a lane it is K steps
        // back, of which these are the others.
        let back = |lane: usize| (N + lane + 1 - K) % N;
        self.to_wheel = PerAxis::from_fn(|lane| Parameter::new(back(lane) as u64));
        self.from_wheel = PerAxis::from_fn(|lane| Parameter::new((N - back(lane)) as u64));
        self.rest_1 = Register::new(true);
        self.rest_2 = Register::new(true);
        Ok(())
    }
}

#[cfg(test)]
mod tests;
