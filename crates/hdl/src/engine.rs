//! The engine: one adder for up to eight axes, the same pulses as that many parallel ones (docs/engine.md).
//!
//! ```text
//!             .------.  beat, axis                                    estop, kick, enable
//!             | turn |-----+----------+-----------+                         v
//!             '------'     v          v           v                     .-------.
//!  put_*  -------------> .-------.  .-------.   .-------. steps, phases | watch |
//!                        | queue |->| store |==>| adder |-------.       '-------'
//!                        '-------'  '-------'<==|       |       v           v
//!                          ^ pulses, losses     '-------'   .-------.   .-------.
//!                          |                        v V     | wheel |   | stops |
//!                        .--------.             .--------.  '-------'   '-------'
//!   step, dir <----------| pulser |<--.         | limits |------|--> hit  ^   | frozen, ramp,
//!                        '--------'   |         '--------'      |             v halted, cause
//!                        one an axis  '---- the events of this phase
//! ```
//!
//! All state of an axis is in block RAM but its pins' timers. In each tick every axis has its turn; what
//! the turns have found takes effect at the strobe that ends the tick, for all axes at once.

use crate::HdlError;
use crate::constant::{Literal, Parameter};
use crate::lanes::Lanes;
use crate::register::{Input, Register};
use crate::word::{Word, bit_cast};
use carrystep_spec::EngineBuild;
use rust_hdl::prelude::*;

pub mod adder;
pub mod homes;
pub mod limits;
pub mod pulser;
pub mod queue;
mod sim;
pub mod stops;
pub mod store;
pub mod turn;
pub mod watch;
pub mod wheel;

pub use sim::{AnyEngine, EngineSim, engine};

use adder::Adder;
use homes::Homes;
use limits::Limits;
use pulser::Pulser;
use queue::Queue;
use stops::Stops;
use store::Store;
use turn::Turn;
use watch::Watch;
use wheel::Wheel;

/// The engine of N axes.
#[derive(LogicBlock, Default)]
pub struct Engine<const N: usize> {
    /// The clock.
    pub clock: Input<Clock>,
    /// A word of a segment is offered; it stays until it is taken.
    pub put_valid: Input<Bit>,
    /// For this axis.
    pub put_axis: Input<Word<3>>,
    /// Which word; 7 commits.
    pub put_word: Input<Word<3>>,
    /// The word; bit 0 of a commit: the segment is the last of its move.
    pub put_data: Input<Word<32>>,
    /// The offered word is taken in this cycle.
    pub put_ready: Signal<Out, Bit>,
    /// A start is offered; it stays until it is taken.
    pub start_valid: Input<Bit>,
    /// Of these axes.
    pub start_mask: Input<Word<N>>,
    /// The offered start is taken in this cycle.
    pub start_ready: Signal<Out, Bit>,
    /// Resume after a stop: hold it until `fault` falls.
    pub clear: Input<Bit>,
    /// The host's controlled stop.
    pub stop: Input<Bit>,
    /// The host has broken the segment protocol: stop.
    pub broken: Input<Bit>,
    /// The host says anew which axes wait for their limit,
    pub home_valid: Input<Bit>,
    /// namely these.
    pub home_mask: Input<Word<N>>,
    /// The host was heard of: the watchdog starts anew.
    pub kick: Input<Bit>,
    /// The host wants the drivers to be powered.
    pub enable: Input<Bit>,
    /// The e-stop's pin, asynchronous.
    pub estop: Input<Bit>,
    /// The limit pins at the low ends, asynchronous.
    pub limit_min: Input<Word<N>>,
    /// The limit pins at the high ends, asynchronous.
    pub limit_max: Input<Word<N>>,
    /// The axis that the host asks about.
    pub get_axis: Input<Word<3>>,
    /// What it asks for: 0 and 1 P, low and high, 2 position, 3 discarded steps.
    pub get_item: Input<Word<2>>,
    /// The answer,
    pub get_data: Signal<Out, Word<32>>,
    /// in this cycle, to what was asked in the cycle before.
    pub get_valid: Signal<Out, Bit>,
    /// `get_data` is the position of the axis of `turn`, which waits for its limit.
    pub latch: Signal<Out, Bit>,
    /// The axis whose turn it is.
    pub latch_axis: Signal<Out, Word<3>>,
    /// Segments that the axis of `put_axis` has room for,
    pub room: Signal<Out, Word<3>>,
    /// in this cycle.
    pub room_valid: Signal<Out, Bit>,
    /// The STEP pins.
    pub step: Lanes<Signal<Out, Bit>, N>,
    /// The DIR pins, 1 is backward.
    pub dir: Lanes<Signal<Out, Bit>, N>,
    /// The drivers are to be powered.
    pub enabled: Signal<Out, Bit>,
    /// All axes are done and no start is armed.
    pub idle: Signal<Out, Bit>,
    /// A stop has been called,
    pub fault: Signal<Out, Bit>,
    /// and no axis moves any more.
    pub halted: Signal<Out, Bit>,
    /// Why, numbered as [`carrystep_spec::engine::Cause`];
    pub cause: Signal<Out, Word<3>>,
    /// the axes that it came from.
    pub culprits: Signal<Out, Word<N>>,
    /// A start is armed.
    pub armed: Signal<Out, Bit>,
    /// The drivers have had power for long enough, and shall have it: starts can be taken.
    pub ready: Signal<Out, Bit>,
    /// The axes that wait for their limit.
    pub homing: Signal<Out, Word<N>>,
    /// Axes start at the end of this cycle.
    pub started: Signal<Out, Bit>,
    turn: Turn<N>,
    adder: Adder,
    queue: Queue,
    pub(crate) store: Store,
    wheel: Wheel<N>,
    limits: Limits<N>,
    homes: Homes<N>,
    stops: Stops<N>,
    watch: Watch,
    pulser: Lanes<Pulser, N>,
    waits: Register<Bit>,    // `armed`
    mask: Register<Word<N>>, // of the start, turning with the turns: bit 0 is the present axis
    going: Register<Bit>,
    taken: Register<Bit>,
    taken_word: Register<Word<3>>,
    unfed: Register<Bit>,  // a masked axis has nothing waiting
    held: Register<Bit>,   // a masked axis runs on
    active: Register<Bit>, // an axis runs or waits
    rest_1: Register<Bit>, // none did in the last tick,
    rest_2: Register<Bit>, // and none in the two before
    strobe: Signal<Local, Bit>,
    masked: Signal<Local, Bit>,
    nobody: Signal<Local, Bit>,
    listens: Signal<Local, Bit>, // the axis of `put_axis` looks at the port
    take: Signal<Local, Bit>,
    may_start: Signal<Local, Bit>,
    free: Signal<Local, Bit>,
    decides: Signal<Local, Bit>,
    go: Signal<Local, Bit>,
    rests: Signal<Local, Bit>,
    pins_busy: Signal<Local, Bit>,
    late: Signal<Local, Word<N>>,
    late_bit: Lanes<Signal<Local, Word<N>>, N>,
    counted: Lanes<Signal<Local, Word<6>>, N>,
    counts: Signal<Local, Word<6>>,
    none: Literal<6, 0>,
    no_axes: Literal<N, 0>,
    one_axis: Lanes<Parameter<N>, N>,
    commit: Literal<3, 7>,
    by_one: Literal<1, 1>,
    to_top: Parameter<3>,
    axes: Parameter<4>,
}

impl<const N: usize> Engine<N> {
    /// The engine of this build, which has been checked and has N axes.
    fn new(build: &EngineBuild) -> Result<Self, HdlError> {
        let mut pulser = Lanes::<Pulser, N>::default();
        for (pulser, pins) in pulser.iter_mut().zip(&build.pins) {
            *pulser = Pulser::new(pins)?;
        }
        Ok(Self {
            turn: Turn::new(),
            store: Store::new(build.phase, &build.guard.stop),
            wheel: Wheel::new(&build.timebase),
            limits: Limits::new(&build.guard),
            homes: Homes::new(),
            stops: Stops::new(&build.guard),
            watch: Watch::new(&build.guard),
            pulser,
            axes: Parameter::new(N as u64),
            to_top: Parameter::new(N as u64 - 1),
            one_axis: Lanes::from_fn(|axis| Parameter::new(1 << axis)),
            rest_1: Register::new(true),
            rest_2: Register::new(true),
            ..Self::default()
        })
    }
}

impl<const N: usize> Logic for Engine<N> {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, waits, mask, going, taken, taken_word, unfed, held, active, rest_1, rest_2);
        clock!(self, clock, turn, adder, queue, store, wheel, limits, homes, stops, watch);

        self.strobe.next = self.wheel.strobe.val();
        self.masked.next = self.mask.q.val().get_bit(0);

        // The host's words.
        self.nobody.next = bit_cast::<4, 3>(self.put_axis.val()) >= self.axes.val();
        self.listens.next = self.turn.beat.val().get_bit(7) & (self.turn.axis.val() == self.put_axis.val());
        self.put_ready.next =
            !self.stops.fault.val() & (self.nobody.val() | (self.listens.val() & !self.queue.full.val()));
        self.room.next = self.queue.room.val();
        self.room_valid.next = self.listens.val();
        self.take.next = self.put_valid.val() & self.put_ready.val() & !self.nobody.val();
        self.taken.d.next = self.taken.q.val() & !self.turn.beat.val().get_bit(9);
        if self.take.val() {
            self.taken.d.next = self.put_word.val() != self.commit.val();
        }
        if self.turn.beat.val().get_bit(7) {
            self.taken_word.d.next = self.put_word.val();
        }

        // Starts: armed at a strobe, then at the first strobe at which every axis of the mask rests and waits.
        self.may_start.next = self.enable.val() & self.watch.warm.val();
        self.start_ready.next =
            self.strobe.val() & !self.waits.q.val() & !self.stops.fault.val() & self.may_start.val();
        self.free.next = !self.stops.fault.val() & !self.stops.finds.val();
        self.decides.next = self.strobe.val() & self.waits.q.val() & self.free.val();
        self.go.next = self.decides.val() & !self.unfed.q.val() & !self.held.q.val();
        if self.strobe.val() {
            self.going.d.next = self.go.val();
        }
        if self.turn.beat.val().get_bit(12) {
            self.mask.d.next = (self.mask.q.val() >> self.by_one.val()) | (self.mask.q.val() << self.to_top.val());
        }
        if self.start_ready.val() & self.start_valid.val() {
            self.waits.d.next = true;
            self.mask.d.next = self.start_mask.val();
        }
        if self.go.val() | self.stops.fault.val() {
            self.waits.d.next = false;
        }

        // What the turns find.
        if self.turn.beat.val().get_bit(12) {
            self.unfed.d.next = self.unfed.q.val() | (self.masked.val() & self.queue.empty.val());
            self.held.d.next =
                self.held.q.val() | (self.masked.val() & (self.queue.goes_on.val() | self.homes.slows.val()));
            self.active.d.next = self.active.q.val() | self.queue.running.val() | !self.queue.empty.val();
        }
        if self.strobe.val() {
            self.unfed.d.next = false;
            self.held.d.next = false;
            self.active.d.next = false;
            self.rest_1.d.next = !self.active.q.val();
            self.rest_2.d.next = !self.active.q.val() & self.rest_1.q.val();
        }
        if self.take.val() {
            self.rest_1.d.next = false;
            self.rest_2.d.next = false;
        }

        // The pins.
        self.counts.next = self.none.val();
        self.pins_busy.next = false;
        self.late.next = self.no_axes.val();
        for i in 0..N {
            self.pulser[i].clock.next = self.clock.val();
            self.pulser[i].frozen.next = self.stops.frozen.val();
            self.pulser[i].request.next = self.wheel.events.val().get_bit(i) & self.wheel.phase_start.val();
            self.pulser[i].request_back.next = self.wheel.backward.val().get_bit(i);
            self.pulser[i].has_sign.next = self.wheel.events.val().get_bit(i) & self.strobe.val();
            self.pulser[i].sign_back.next = self.wheel.backward.val().get_bit(i);
            self.counted[i].next = self.none.val();
            if self.turn.lane.val().get_bit(i) {
                self.counted[i].next = self.pulser[i].counts.val();
            }
            self.counts.next = self.counts.val() | self.counted[i].val();
            self.late_bit[i].next = self.no_axes.val();
            if self.pulser[i].overruns.val() {
                self.late_bit[i].next = self.one_axis[i].val();
            }
            self.late.next = self.late.val() | self.late_bit[i].val();
            self.pins_busy.next = self.pins_busy.val() | self.pulser[i].owed.val() | self.pulser[i].step.val();
            self.step[i].next = self.pulser[i].step.val();
            self.dir[i].next = self.pulser[i].dir.val();
        }
        self.rests.next = self.rest_2.q.val() & !self.waits.q.val() & !self.pins_busy.val();

        // The modules.
        self.turn.strobe.next = self.strobe.val();
        self.queue.beat.next = self.turn.beat.val();
        self.queue.axis.next = self.turn.axis.val();
        self.queue.axis_next.next = self.turn.axis_next.val();
        self.queue.starts.next = self.going.q.val() & self.masked.val();
        self.queue.halted.next = self.stops.halted.val();
        self.queue.ramp.next = self.stops.ramp.val() | self.homes.slows.val();
        self.queue.empties.next = self.homes.slows.val() & !self.queue.goes_on.val();
        self.queue.clear.next = self.stops.clearing.val();
        self.queue.take.next = self.take.val();
        self.queue.commit.next = self.put_word.val() == self.commit.val();
        self.queue.last.next = self.put_data.val().get_bit(0);
        self.queue.ended.next = self.adder.ended.val();
        self.queue.overflow.next = self.adder.overflow.val();
        self.queue.least.next = self.adder.least.val();
        self.queue.turned.next = self.adder.turned.val();
        self.queue.back.next = self.adder.back.val();
        self.queue.pulses.next = self.counts.val().get_bits::<3>(0);
        self.queue.losses.next = self.counts.val().get_bits::<3>(3);

        self.adder.beat.next = self.turn.beat.val();
        self.adder.word.next = self.store.word.val();
        self.adder.put.next = self.put_data.val();
        self.adder.counts.next = self.queue.running.val();
        self.adder.lost.next = self.queue.lost.val();
        self.adder.up.next = self.queue.up.val();
        self.adder.down.next = self.queue.down.val();
        self.adder.wipe.next = self.stops.clearing.val();

        self.store.beat.next = self.turn.beat.val();
        self.store.axis.next = self.turn.axis.val();
        self.store.live.next = self.queue.live.val();
        self.store.fresh.next = self.queue.fresh.val();
        self.store.running.next = self.queue.running.val();
        self.store.sound.next = self.queue.sound.val();
        self.store.moves.next = self.queue.moves.val();
        self.store.slows.next = self.queue.slows.val();
        self.store.upward.next = self.queue.upward.val();
        self.store.steady.next = self.queue.steady.val();
        self.store.wipe.next = self.stops.clearing.val();
        self.store.put.next = self.taken.q.val();
        self.store.put_word.next = self.taken_word.q.val();
        self.store.get_axis.next = self.get_axis.val();
        self.store.get_item.next = self.get_item.val();
        self.store.sum.next = self.adder.sum.val();

        self.wheel.turn_ends.next = self.turn.beat.val().get_bit(12);
        self.wheel.lane.next = self.turn.lane.val();
        self.wheel.crosses.next = self.queue.moves.val() & self.adder.crosses.val();
        self.wheel.has_sign.next = self.queue.moves.val() & !self.adder.still.val();
        self.wheel.back.next = self.adder.back.val();
        self.wheel.phase_known.next = self.turn.beat.val().get_bit(16);
        self.wheel.q.next = self.adder.q.val();

        self.get_data.next = self.store.word.val();
        self.get_valid.next = self.turn.beat.val().get_bit(11);
        self.latch.next = self.turn.beat.val().get_bit(6) & self.homes.waits.val();
        self.latch_axis.next = self.turn.axis.val();
        self.limits.turn_ends.next = self.turn.beat.val().get_bit(12);
        self.limits.axis.next = self.turn.axis.val();
        self.limits.axis_next.next = self.turn.axis_next.val();
        self.limits.lane.next = self.turn.lane.val();
        self.limits.tick_0.next = self.watch.tick_0.val();
        self.limits.tick_1.next = self.watch.tick_1.val();
        self.limits.limit_min.next = self.limit_min.val();
        self.limits.limit_max.next = self.limit_max.val();
        self.limits.goes.next = self.queue.moves.val() & !self.adder.still.val();
        self.limits.back.next = self.adder.back.val();

        self.homes.set.next = self.home_valid.val();
        self.homes.mask.next = self.home_mask.val();
        self.homes.turn_ends.next = self.turn.beat.val().get_bit(12);
        self.homes.lane.next = self.turn.lane.val();
        self.homes.hit.next = self.limits.hit.val();
        self.homes.goes_on.next = self.queue.goes_on.val();

        self.stops.strobe.next = self.strobe.val();
        self.stops.turn_ends.next = self.turn.beat.val().get_bit(12);
        self.stops.lane.next = self.turn.lane.val();
        self.stops.runs.next = self.queue.running.val();
        self.stops.too_fast.next = self.queue.too_fast.val();
        self.stops.limit.next = self.limits.hit.val() & !self.homes.waits.val() & !self.homes.slows.val();
        self.stops.dry.next = self.queue.dry.val();
        self.stops.late.next = self.late.val();
        self.stops.pressed.next = self.watch.pressed.val();
        self.stops.breaks.next = (((self.put_valid.val() & self.nobody.val()) | self.broken.val())
            & !self.stops.fault.val())
            | (self.decides.val() & self.unfed.q.val());
        self.stops.missed.next = self.watch.missed.val() & !self.rest_2.q.val();
        self.stops.asked.next = self.stop.val();
        self.stops.clear.next = self.clear.val();
        self.stops.pins_busy.next = self.pins_busy.val();

        self.watch.strobe.next = self.strobe.val();
        self.watch.estop.next = self.estop.val();
        self.watch.kick.next = self.kick.val();
        self.watch.enable.next = self.enable.val();
        self.watch.idle.next = self.rests.val();

        self.enabled.next = self.watch.enabled.val();
        self.idle.next = self.rests.val();
        self.fault.next = self.stops.fault.val();
        self.halted.next = self.stops.halted.val();
        self.cause.next = self.stops.cause.val();
        self.culprits.next = self.stops.culprits.val();
        self.armed.next = self.waits.q.val();
        self.ready.next = self.may_start.val();
        self.homing.next = self.homes.axes.val();
        self.started.next = self.go.val();
    }
}

#[cfg(test)]
mod tests;
