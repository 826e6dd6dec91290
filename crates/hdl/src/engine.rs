//! The engine: one adder for six axes, the same pulses as six parallel ones (docs/engine.md).
//!
//! ```text
//!             .------.  beat, axis
//!             | turn |-----+----------+-----------+
//!             '------'     v          v           v
//!  put_*  -------------> .-------.  .-------.   .-------.  steps, phases
//!                        | queue |->| store |==>| adder |------------.
//!                        '-------'  '-------'<==|       |            v
//!                          ^ pulses, losses     '-------'        .-------.
//!                          |                                     | wheel |
//!                        .--------.   the events of this phase   '-------'
//!   step, dir <----------| pulser |<---------------------------------'
//!                        '--------' six of them
//! ```
//!
//! All state of an axis is in block RAM but its pins' timers. In each tick every axis has its turn; what
//! the turns have found takes effect at the strobe that ends the tick, for all axes at once.

use crate::HdlError;
use crate::constant::Literal;
use crate::register::{Input, Register};
use crate::word::Word;
use carrystep_spec::{AXES, Build, engine};
use rust_hdl::prelude::*;

pub mod adder;
pub mod pulser;
pub mod queue;
pub mod store;
pub mod turn;
pub mod wheel;

use adder::Adder;
use pulser::Pulser;
use queue::Queue;
use store::Store;
use turn::Turn;
use wheel::Wheel;

/// The engine.
#[derive(LogicBlock, Default)]
pub struct Engine {
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
    pub start_mask: Input<Word<AXES>>,
    /// The offered start is taken in this cycle.
    pub start_ready: Signal<Out, Bit>,
    /// Resume after a fault: hold it until `fault` falls.
    pub clear: Input<Bit>,
    /// The axis that the host asks about.
    pub get_axis: Input<Word<3>>,
    /// What it asks for: 0 and 1 P, low and high, 2 position, 3 discarded steps.
    pub get_item: Input<Word<2>>,
    /// The answer,
    pub get_data: Signal<Out, Word<32>>,
    /// in this cycle, to what was asked in the cycle before.
    pub get_valid: Signal<Out, Bit>,
    /// The STEP pins.
    pub step: [Signal<Out, Bit>; AXES],
    /// The DIR pins, 1 is backward.
    pub dir: [Signal<Out, Bit>; AXES],
    /// All axes are done and no start is armed.
    pub idle: Signal<Out, Bit>,
    /// Nothing new rises.
    pub fault: Signal<Out, Bit>,
    /// No axis is added any more.
    pub halted: Signal<Out, Bit>,
    /// Fault: a second step was owed.
    pub overrun: [Signal<Out, Bit>; AXES],
    /// Fault, told while halted: V left (-2^63, 2^63).
    pub overspeed: Signal<Out, Word<AXES>>,
    /// Fault, told while halted: the queue ran dry.
    pub underrun: Signal<Out, Word<AXES>>,
    /// Fault: the host broke the protocol.
    pub protocol: Signal<Out, Bit>,
    /// Axes start at the end of this cycle.
    pub started: Signal<Out, Bit>,
    turn: Turn,
    adder: Adder,
    queue: Queue,
    pub(crate) store: Store,
    wheel: Wheel,
    pulser: [Pulser; AXES],
    armed: Register<Bit>,
    mask: Register<Word<AXES>>,
    going: Register<Bit>,
    taken: Register<Bit>,
    taken_word: Register<Word<3>>,
    frozen: Register<Bit>,  // `fault`
    halt: Register<Bit>,    // `halted`
    settled: Register<Bit>, // halted for a whole tick
    clearing: Register<Bit>,
    broken: Register<Bit>,      // `protocol`
    fast: Register<Word<AXES>>, // `overspeed`
    dry: Register<Word<AXES>>,  // `underrun`
    found: Register<Bit>,       // either, in this tick
    unfed: Register<Bit>,       // a masked axis has nothing waiting
    held: Register<Bit>,        // a masked axis runs on
    active: Register<Bit>,      // an axis runs or waits
    rest_1: Register<Bit>,      // none did in the last tick,
    rest_2: Register<Bit>,      // and none in the two before
    strobe: Signal<Local, Bit>,
    masked: Signal<Local, Bit>,
    nobody: Signal<Local, Bit>,
    take: Signal<Local, Bit>,
    stop: Signal<Local, Bit>,
    go: Signal<Local, Bit>,
    starves: Signal<Local, Bit>,
    over: Signal<Local, Bit>,
    cleared: Signal<Local, Bit>,
    pins_busy: Signal<Local, Bit>,
    steps_high: Signal<Local, Bit>,
    overruns: Signal<Local, Bit>,
    breaks: Signal<Local, Bit>,
    counted: [Signal<Local, Word<6>>; AXES],
    counts: Signal<Local, Word<6>>,
    none: Literal<6, 0>,
    no_axes: Literal<AXES, 0>,
    commit: Literal<3, 7>,
    six: Literal<3, 6>,
}

impl Engine {
    /// The engine of this build.
    ///
    /// # Errors
    /// [`HdlError::Schedule`] where the turns do not fit into the tick, [`HdlError::PinTiming`] where an axis'
    /// timing is out of range.
    pub fn new(build: &Build) -> Result<Self, HdlError> {
        engine::check_schedule(&build.timebase)?;
        let mut pulser: [Pulser; AXES] = Default::default();
        for (pulser, pins) in pulser.iter_mut().zip(&build.pins) {
            *pulser = Pulser::new(pins)?;
        }
        Ok(Self {
            store: Store::new(build.phase),
            wheel: Wheel::new(&build.timebase),
            pulser,
            rest_1: Register::new(true),
            rest_2: Register::new(true),
            ..Self::default()
        })
    }
}

impl Logic for Engine {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, armed, mask, going, taken, taken_word, frozen, halt, settled, clearing, broken);
        dff_setup!(self, clock, fast, dry, found, unfed, held, active, rest_1, rest_2);
        clock!(self, clock, turn, adder, queue, store, wheel);

        self.strobe.next = self.wheel.strobe.val();
        self.masked.next = (self.turn.lane.val() & self.mask.q.val()).any();

        // The host's words.
        self.nobody.next = self.put_axis.val() >= self.six.val();
        self.put_ready.next = !self.frozen.q.val()
            & (self.nobody.val()
                | (self.turn.beat.val().get_bit(7)
                    & (self.turn.axis.val() == self.put_axis.val())
                    & !self.queue.full.val()));
        self.take.next = self.put_valid.val() & self.put_ready.val() & !self.nobody.val();
        self.taken.d.next = self.taken.q.val() & !self.turn.beat.val().get_bit(9);
        if self.take.val() {
            self.taken.d.next = self.put_word.val() != self.commit.val();
        }
        if self.turn.beat.val().get_bit(7) {
            self.taken_word.d.next = self.put_word.val();
        }

        // Starts: armed at a strobe, then at the first strobe at which every axis of the mask rests and waits.
        self.start_ready.next = self.strobe.val() & !self.armed.q.val() & !self.frozen.q.val();
        self.stop.next = self.frozen.q.val() | self.found.q.val();
        self.starves.next = self.strobe.val() & self.armed.q.val() & !self.stop.val() & self.unfed.q.val();
        self.go.next =
            self.strobe.val() & self.armed.q.val() & !self.stop.val() & !self.unfed.q.val() & !self.held.q.val();
        if self.strobe.val() {
            self.going.d.next = self.go.val();
        }
        if self.start_ready.val() & self.start_valid.val() {
            self.armed.d.next = true;
            self.mask.d.next = self.start_mask.val();
        }
        if self.go.val() | self.frozen.q.val() {
            self.armed.d.next = false;
        }

        // What the turns find.
        if self.turn.beat.val().get_bit(12) {
            self.unfed.d.next = self.unfed.q.val() | (self.masked.val() & self.queue.empty.val());
            self.held.d.next = self.held.q.val() | (self.masked.val() & self.queue.goes_on.val());
            self.active.d.next = self.active.q.val() | self.queue.running.val() | !self.queue.empty.val();
            self.found.d.next = self.found.q.val() | self.queue.too_fast.val() | self.queue.dry.val();
            if self.queue.too_fast.val() {
                self.fast.d.next = self.fast.q.val() | self.turn.lane.val();
            }
            if self.queue.dry.val() {
                self.dry.d.next = self.dry.q.val() | self.turn.lane.val();
            }
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

        // Faults: the pins freeze at once, the axes halt at the strobe.
        self.pins_busy.next = false;
        self.steps_high.next = false;
        self.overruns.next = false;
        for i in 0..6 {
            self.pins_busy.next = self.pins_busy.val() | self.pulser[i].owed.val() | self.pulser[i].step.val();
            self.steps_high.next = self.steps_high.val() | self.pulser[i].step.val();
            self.overruns.next = self.overruns.val() | self.pulser[i].overruns.val();
        }
        self.breaks.next = (self.put_valid.val() & self.nobody.val() & !self.frozen.q.val()) | self.starves.val();
        self.over.next = self.overruns.val() | self.breaks.val() | (self.strobe.val() & self.found.q.val());
        self.cleared.next = self.strobe.val() & self.clearing.q.val();
        if self.over.val() {
            self.frozen.d.next = true;
        }
        if self.breaks.val() {
            self.broken.d.next = true;
        }
        if self.strobe.val() {
            self.halt.d.next = self.stop.val();
            self.settled.d.next = self.halt.q.val();
            self.clearing.d.next =
                self.clear.val() & self.settled.q.val() & !self.steps_high.val() & !self.clearing.q.val();
        }
        if self.cleared.val() {
            self.frozen.d.next = false;
            self.halt.d.next = false;
            self.settled.d.next = false;
            self.broken.d.next = false;
            self.found.d.next = false;
            self.fast.d.next = self.no_axes.val();
            self.dry.d.next = self.no_axes.val();
        }

        // The pins.
        self.counts.next = self.none.val();
        for i in 0..6 {
            self.pulser[i].clock.next = self.clock.val();
            self.pulser[i].frozen.next = self.frozen.q.val();
            self.pulser[i].clear.next = self.cleared.val();
            self.pulser[i].request.next = self.wheel.events.val().get_bit(i) & self.wheel.phase_start.val();
            self.pulser[i].request_back.next = self.wheel.backward.val().get_bit(i);
            self.pulser[i].has_sign.next = self.wheel.events.val().get_bit(i) & self.strobe.val();
            self.pulser[i].sign_back.next = self.wheel.backward.val().get_bit(i);
            self.counted[i].next = self.none.val();
            if self.turn.lane.val().get_bit(i) {
                self.counted[i].next = self.pulser[i].counts.val();
            }
            self.counts.next = self.counts.val() | self.counted[i].val();
            self.step[i].next = self.pulser[i].step.val();
            self.dir[i].next = self.pulser[i].dir.val();
            self.overrun[i].next = self.pulser[i].overrun.val();
        }

        // The modules.
        self.turn.strobe.next = self.strobe.val();
        self.queue.beat.next = self.turn.beat.val();
        self.queue.axis.next = self.turn.axis.val();
        self.queue.axis_next.next = self.turn.axis_next.val();
        self.queue.starts.next = self.going.q.val() & self.masked.val();
        self.queue.halted.next = self.halt.q.val();
        self.queue.clear.next = self.clearing.q.val();
        self.queue.take.next = self.take.val();
        self.queue.commit.next = self.put_word.val() == self.commit.val();
        self.queue.last.next = self.put_data.val().get_bit(0);
        self.queue.ended.next = self.adder.ended.val();
        self.queue.overflow.next = self.adder.overflow.val();
        self.queue.least.next = self.adder.least.val();
        self.queue.pulses.next = self.counts.val().get_bits::<3>(0);
        self.queue.losses.next = self.counts.val().get_bits::<3>(3);

        self.adder.beat.next = self.turn.beat.val();
        self.adder.word.next = self.store.word.val();
        self.adder.put.next = self.put_data.val();
        self.adder.counts.next = self.queue.running.val();
        self.adder.lost.next = self.queue.lost.val();
        self.adder.up.next = self.queue.up.val();
        self.adder.down.next = self.queue.down.val();
        self.adder.wipe.next = self.clearing.q.val();

        self.store.beat.next = self.turn.beat.val();
        self.store.axis.next = self.turn.axis.val();
        self.store.live.next = self.queue.live.val();
        self.store.fresh.next = self.queue.fresh.val();
        self.store.running.next = self.queue.running.val();
        self.store.sound.next = self.queue.sound.val();
        self.store.moves.next = self.queue.moves.val();
        self.store.wipe.next = self.clearing.q.val();
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
        self.idle.next = self.rest_2.q.val() & !self.armed.q.val() & !self.pins_busy.val();
        self.fault.next = self.frozen.q.val();
        self.halted.next = self.halt.q.val();
        self.overspeed.next = self.fast.q.val();
        self.underrun.next = self.dry.q.val();
        self.protocol.next = self.broken.q.val();
        self.started.next = self.go.val();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use carrystep_spec::{PinTiming, StartPhase, Timebase};

    #[test]
    fn engine_synthesizes() {
        let timebase = Timebase::new(80_000_000, 1000, 16).unwrap();
        let build = Build { timebase, phase: StartPhase::Half, pins: [PinTiming::SHORTEST; AXES] };
        crate::sim::assert_synthesizes(Engine::new(&build).unwrap(), "carrystep_engine");
    }

    #[test]
    fn a_tick_without_room_for_the_turns_is_refused() {
        let timebase = Timebase::new(48_000_000, 1000, 16).unwrap();
        let build = Build { timebase, phase: StartPhase::Half, pins: [PinTiming::SHORTEST; AXES] };
        assert!(matches!(Engine::new(&build), Err(HdlError::Schedule(_))));
    }
}
