//! The host link of an engine with several adders: as [`super::Link`], with a register mirror for each
//! adder, because in a tick of few clocks the words of state of all axes need as many memories.
//!
//! ```text
//! address   page 2 | item 3 | axis 3        the axis selects the mirror: that of its adder
//! mirror k  the words of the axes k, k + K, ...; all of them hold the constants of the build
//! ```
//!
//! Interface: as that of [`super::Link`], with the ports of the words of state once for each adder.
//!
//! Cost: block RAM for each adder, and the selection of the word that is read.

use super::formulas;
use super::processor::LinkProcessor;
use super::register_mirror::RegisterMirror;
use crate::primitives::compiled_once;
use crate::primitives::constant::{Literal, Parameter};
use crate::primitives::per_axis::{PerAxis, PerLane};
use crate::primitives::register::{Input, Register};
use crate::primitives::word::Word;
use carrystep_core::EngineBuild;
use carrystep_core::engine::{CAUSE_BITS, MAX_AXES};
use carrystep_core::link::{BuildId, image};
use rust_hdl_core::prelude::*;

/// The link for an engine of N axes on K adders, which has at most one latch.
#[derive(LogicBlock, Default)]
pub struct WideLink<const N: usize, const K: usize> {
    /// The clock.
    pub clock: Input<Clock>,
    /// The line has received a byte; asserted for one clock per byte.
    pub received_valid: Input<Bit>,
    /// The received byte.
    pub received: Input<Word<8>>,
    /// The link offers a byte of the answer and holds it until the line accepts it.
    pub answer_valid: Signal<Out, Bit>,
    /// The offered byte.
    pub answer: Signal<Out, Word<8>>,
    /// The line accepts the offered byte in this clock.
    pub answer_take: Input<Bit>,
    /// The link offers a word of a segment to the engine.
    pub put_valid: Signal<Out, Bit>,
    /// The axis of the offered word. Also the axis whose free queue space the link reads.
    pub put_axis: Signal<Out, Word<3>>,
    /// The number of the offered word in its segment, 7 of which commits it; 8 names the slot of a
    /// cut.
    pub put_word: Signal<Out, Word<4>>,
    /// The offered word.
    pub put_data: Signal<Out, Word<32>>,
    /// The engine accepts the offered word in this clock.
    pub put_ready: Input<Bit>,
    /// The number of segments for which the queue of the axis `put_axis` has space.
    pub room: Input<Word<5>>,
    /// `room` is valid in this clock.
    pub room_valid: Input<Bit>,
    /// The link offers a start to the engine.
    pub start_valid: Signal<Out, Bit>,
    /// The axes to start; bit i is axis i.
    pub start_mask: Signal<Out, Word<N>>,
    /// The engine accepts an offered start in this clock.
    pub start_ready: Input<Bit>,
    /// The host requests a cut in the axes whose slots were named; asserted for one clock.
    pub cut: Signal<Out, Bit>,
    /// A cut was requested and is not decided yet.
    pub cut_busy: Input<Bit>,
    /// The last cut was refused: nothing was dropped.
    pub cut_refused: Input<Bit>,
    /// The engine clears a stop.
    pub clear: Signal<Out, Bit>,
    /// The host requests a controlled stop.
    pub stop: Signal<Out, Bit>,
    /// The host has broken the segment protocol.
    pub broken: Signal<Out, Bit>,
    /// The host replaces the source of seeks.
    pub seek_source_valid: Signal<Out, Bit>,
    /// The source: axis in bits 2..0, row in bits 4..3, own in bit 5, level in bit 6.
    pub seek_source: Signal<Out, Word<7>>,
    /// The host replaces the mask of the axes that wait for the source of their seek.
    pub seek_valid: Signal<Out, Bit>,
    /// The axes that wait for it, valid with `seek_valid`; bit i is axis i.
    pub seek_mask: Signal<Out, Word<N>>,
    /// The host arms the latch.
    pub latch_arm: Signal<Out, Bit>,
    /// The host requests a snapshot of the state of all axes.
    pub snapshot: Signal<Out, Bit>,
    /// The owner of the session has sent a valid request: the watchdog restarts.
    pub kick: Signal<Out, Bit>,
    /// The host requests power for the motor drivers, as long as it is asserted.
    pub enable: Signal<Out, Bit>,
    /// Each adder of the engine outputs a word of the state of an axis in this clock; bit k is adder k.
    /// The five ports of these words have one element for each adder, that of adder 0 lowest.
    pub state_valid: PerAxis<Input<Bit>, K>,
    /// The copy to which it belongs: 0 hit of a seek, 1 live, 2 snapshot, 3 latch.
    pub state_page: PerAxis<Input<Word<2>>, K>,
    /// Its axis, as a number from 0.
    pub state_axis: PerAxis<Input<Word<3>>, K>,
    /// Its meaning, numbered as at the port `state_item` of the engine.
    pub state_item: PerAxis<Input<Word<3>>, K>,
    /// The word.
    pub state: PerAxis<Input<Word<32>>, K>,
    /// All live words of this tick have been output.
    pub refreshed: Input<Bit>,
    /// The engine has latched a stop.
    pub fault: Input<Bit>,
    /// No axis moves any more after a stop.
    pub halted: Input<Bit>,
    /// All axes are at rest and no start is armed.
    pub idle: Input<Bit>,
    /// The host requests power for the drivers and they have been powered for long enough, so that
    /// the engine can accept a start.
    pub ready: Input<Bit>,
    /// A start is armed.
    pub armed: Input<Bit>,
    /// The first cause of the stop, numbered as at the port `cause` of the engine.
    pub cause: Input<Word<CAUSE_BITS>>,
    /// The axes that caused the stop; bit i is axis i.
    pub culprits: Input<Word<N>>,
    /// The axes that wait for the source of their seek; bit i is axis i.
    pub seeking: Input<Word<N>>,
    /// The axes that have hit it, until the host ends the seek; bit i is axis i.
    pub hits: Input<Word<N>>,
    /// The latch waits for its edge.
    pub latch_armed: Input<Bit>,
    /// The edges since the latch was armed that it did not latch, at most 15.
    pub latch_edges: Input<Word<4>>,
    processor: LinkProcessor<N>,
    register_mirror: PerLane<RegisterMirror, K>,
    axis_read: Register<Word<3>>, // the axis of the address of the clock before
    read: Signal<Local, Word<32>>,
    chosen: PerAxis<Signal<Local, Word<8>>, K>, // bit 0: the mirror has the words of that axis
    word: PerAxis<Signal<Local, Word<32>>, K>,
    axes: PerAxis<Parameter<8>, K>, // the axes of each adder, one bit each
    nothing: Literal<32, 0>,
}

impl<const N: usize, const K: usize> WideLink<N, K> {
    /// Makes the link of this build.
    pub(super) fn new(build: &EngineBuild, id: BuildId) -> Self {
        let axes = |adder| (0..MAX_AXES).filter(move |axis| axis % K == adder);
        let mask = |adder| axes(adder).fold(0, |mask, axis| mask | 1 << axis);
        Self {
            processor: LinkProcessor::new(&image(false)),
            register_mirror: PerLane::from_fn(|_| RegisterMirror::new(&formulas(build, id))),
            axes: PerAxis::from_fn(|adder| Parameter::new(mask(adder))),
            ..Self::default()
        }
    }
}

compiled_once::logic!(WideLink<N = 8, K = 6>);

impl<const N: usize, const K: usize> compiled_once::Kernel for WideLink<N, K> {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, axis_read);
        clock!(self, clock, processor);
        self.processor.received.next = self.received_valid.val();
        self.processor.received_data.next = self.received.val();
        self.answer.next = self.processor.a.val();
        self.answer_valid.next = self.processor.answer_valid.val();
        self.processor.answer_take.next = self.answer_take.val();

        self.put_valid.next = self.processor.put_valid.val();
        self.put_axis.next = self.processor.a.val().get_bits::<3>(0);
        self.put_word.next = self.processor.put_word.val();
        self.put_data.next = self.processor.put_data.val();
        self.processor.put_ready.next = self.put_ready.val();
        self.processor.room.next = self.room.val();
        self.processor.room_valid.next = self.room_valid.val();
        self.start_valid.next = self.processor.start_valid.val();
        self.start_mask.next = self.processor.a.val().get_bits::<N>(0);
        self.processor.start_ready.next = self.start_ready.val();
        self.seek_source_valid.next = self.processor.seek_source_valid.val();
        self.seek_source.next = self.processor.a.val().get_bits::<7>(0);
        self.latch_arm.next = self.processor.latch_arm.val();
        self.seek_valid.next = self.processor.seek_valid.val();
        self.seek_mask.next = self.processor.a.val().get_bits::<N>(0);
        self.clear.next = self.processor.clear.val();
        self.stop.next = self.processor.stop.val();
        self.broken.next = self.processor.broken.val();
        self.snapshot.next = self.processor.snapshot.val();
        self.cut.next = self.processor.cut.val();
        self.processor.cut_refused.next = self.cut_refused.val();
        self.kick.next = self.processor.kick.val();
        self.enable.next = self.processor.enable.val();

        self.processor.refreshed.next = self.refreshed.val();
        self.processor.fault.next = self.fault.val();
        self.processor.halted.next = self.halted.val();
        self.processor.idle.next = self.idle.val();
        self.processor.ready.next = self.ready.val();
        self.processor.armed.next = self.armed.val();
        self.processor.cause.next = self.cause.val();
        self.processor.culprits.next = self.culprits.val();
        self.processor.seeking.next = self.seeking.val();
        self.processor.hits.next = self.hits.val();
        self.processor.latch_armed.next = self.latch_armed.val();
        self.processor.latch_edges.next = self.latch_edges.val();

        // The mirrors, and the one that has the word.
        self.axis_read.d.next = self.processor.x.val().get_bits::<3>(0);
        self.read.next = self.nothing.val();
        for k in 0..K {
            self.register_mirror[k].clock.next = self.clock.val();
            self.register_mirror[k].address.next = self.processor.x.val();
            self.register_mirror[k].state_valid.next = self.state_valid[k].val();
            self.register_mirror[k].state_page.next = self.state_page[k].val();
            self.register_mirror[k].state_axis.next = self.state_axis[k].val();
            self.register_mirror[k].state_item.next = self.state_item[k].val();
            self.register_mirror[k].state.next = self.state[k].val();
            self.chosen[k].next = self.axes[k].val() >> self.axis_read.q.val();
            self.word[k].next = self.nothing.val();
            if self.chosen[k].val().get_bit(0) {
                self.word[k].next = self.register_mirror[k].data.val();
            }
            self.read.next = self.read.val() | self.word[k].val();
        }
        self.processor.facts.next = self.read.val();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::primitives::compiled_once::assert_sizes_agree;
    use crate::sim::assert_synthesizes;
    use carrystep_core::link::LineKind;
    use carrystep_core::{AXES, Build, PinTiming, StartPhase, Timebase};

    #[test]
    fn statements_are_those_of_each_size() {
        assert_sizes_agree::<WideLink<3, 3>>();
        assert_sizes_agree::<WideLink<6, 2>>();
    }

    #[test]
    fn wide_link_synthesizes() {
        let timebase = Timebase::new(48_000_000, 2000, 16).unwrap();
        let build = Build { timebase, phase: StartPhase::Half, pins: [PinTiming::SHORTEST; AXES] };
        let build = EngineBuild { adders: 6, ..EngineBuild::minimal(&build, 1) };
        let id = LineKind::Spi.build_id(&build);
        assert_synthesizes(WideLink::<6, 6>::new(&build, id), "carrystep_wide_link");
    }
}
