//! The host link: receives requests and sends answers (docs/protocol.md).
//!
//! ```text
//!          .------. received .---------. put, start, home, control
//!  rx ---->|      |--------->|         |--------------------------------> engine
//!          | line |          |processor| state, room, culprits, seeking
//!          |      | answer   |         |<-------------------------------- engine
//!  tx <----|      |<---------|         | facts  .-------. words
//!          '------'          '---------'<-------| facts |<--------------- engine
//!                                               '-------'
//! ```
//!
//! A small processor with its program ([`processor`]) handles the protocol. It stores a request in
//! block RAM until the CRC has arrived and is correct; only then does a word of the request reach
//! the engine. The module [`register_mirror`] stores what the host can read: the constants of the
//! build and the state of each axis.
//!
//! Interface: bytes on the side of the line, the ports of the engine on the other side. The link
//! accepts any [`crate::line`].
//!
//! Cost: block RAM for the program, its data, the received bytes and the facts, and the few
//! registers of the processor. The same protocol without a processor would need hundreds of logic
//! cells.

use crate::parameters::{BUILD_ID, CLOCK_HZ, ROUND_TICKS, TICK_NS, WATCHDOG_ROUNDS};
use crate::primitives::compiled_once;
use crate::primitives::formula::Formula;
use crate::primitives::optional::Optional;
use crate::primitives::register::Input;
use crate::primitives::word::Word;
use carrystep_core::EngineBuild;
use carrystep_core::engine::CAUSE_BITS;
use carrystep_core::link::registers::{self, BUILD_HIGH, BUILD_LOW, WATCHDOG_TICKS};
use carrystep_core::link::{BuildId, facts, image};
use rust_hdl_core::prelude::*;

pub mod crc;
pub mod latch_view;
pub mod processor;
pub mod register_mirror;
#[cfg(not(test))] // crates/hdl/tests/engine.rs says why
pub(crate) mod sim;
pub mod wide;

use latch_view::LatchView;
use processor::LinkProcessor;
use register_mirror::RegisterMirror;

/// The link for an engine of N axes. Its ports are those of the line and of the engine. The ports and
/// the part of several latches exist in a build that has them only.
#[derive(LogicBlock, Default)]
pub struct Link<const N: usize> {
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
    /// The engine outputs a word of the state of an axis in this clock.
    pub state_valid: Input<Bit>,
    /// The copy to which it belongs: 0 hit of a seek, 1 live, 2 snapshot, 3 latch.
    pub state_page: Input<Word<2>>,
    /// Its axis, as a number from 0.
    pub state_axis: Input<Word<3>>,
    /// Its meaning, numbered as at the port `state_item` of the engine.
    pub state_item: Input<Word<3>>,
    /// The word.
    pub state: Input<Word<32>>,
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
    /// The host arms these latches; bit 0 is latch 1.
    pub more_latch_arm: Optional<Signal<Out, Word<3>>>,
    /// These latches wait for their edges; bit 0 is latch 1.
    pub more_latch_armed: Optional<Input<Word<3>>>,
    /// The edges since each of them was armed that it did not latch, in four bits each.
    pub more_latch_edges: Optional<Input<Word<12>>>,
    /// The number of the record that each latch from 0 on holds, in two bits each.
    pub latch_records: Optional<Input<Word<8>>>,
    /// The number of the record to which the words of page 3 belong.
    pub state_record: Optional<Input<Word<2>>>,
    processor: LinkProcessor<N>,
    register_mirror: RegisterMirror,
    latch_view: Optional<LatchView>,
}

impl<const N: usize> Link<N> {
    /// Makes the link of this build.
    fn new(build: &EngineBuild, id: BuildId) -> Self {
        let mut link = Self::default();
        link.set(build, id);
        link
    }

    /// Replaces the parts that depend on the build, for the same reason as `Engine::set`.
    fn set(&mut self, build: &EngineBuild, id: BuildId) {
        self.processor = LinkProcessor::new(&image(build.has_several_latches()));
        self.register_mirror = RegisterMirror::new(&formulas(build, id));
        let several = build.has_several_latches();
        self.more_latch_arm = Optional::when(several);
        self.more_latch_armed = Optional::when(several);
        self.more_latch_edges = Optional::when(several);
        self.latch_records = Optional::when(several);
        self.state_record = Optional::when(several);
        self.latch_view = Optional::of(several.then(|| LatchView::new(&build.guard)));
    }
}

/// What the build says of itself: address, and the number as it follows from parameters of the
/// Verilog.
fn formulas(build: &EngineBuild, id: BuildId) -> Vec<(u8, Formula<32>)> {
    let number = |value: u64| value as u32;
    let build_id = BUILD_ID.of::<64>(id.0);
    let rounds = WATCHDOG_ROUNDS.of::<32>(build.guard.watchdog).whole();
    let silence = rounds * ROUND_TICKS.of::<32>(build.guard.round).whole();
    let formula = |(address, fact): (u8, u32)| {
        let formula = match address {
            BUILD_LOW => build_id.bits(0),
            BUILD_HIGH => build_id.bits(32),
            registers::CLOCK_HZ => CLOCK_HZ.of(number(build.timebase.clock_hz())).whole(),
            registers::TICK_NS => TICK_NS.of(number(build.timebase.tick_ns())).whole(),
            WATCHDOG_TICKS => silence.clone(),
            _ => Formula::number(fact.into()),
        };
        (address, formula)
    };
    facts(build, id).into_iter().map(formula).collect()
}

compiled_once::logic!(Link<N = 8>, latch_view);

impl<const N: usize> compiled_once::Kernel for Link<N> {
    #[hdl_gen]
    fn update(&mut self) {
        clock!(self, clock, processor, register_mirror);
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
        self.processor.facts.next = self.register_mirror.data.val();

        self.register_mirror.address.next = self.processor.x.val();
        self.register_mirror.state_valid.next = self.state_valid.val();
        self.register_mirror.state_page.next = self.state_page.val();
        self.register_mirror.state_axis.next = self.state_axis.val();
        self.register_mirror.state_item.next = self.state_item.val();
        self.register_mirror.state.next = self.state.val();

        // Several latches: their view is between the register mirror and the processor.
        for i in 0..self.latch_view.len() {
            self.latch_view[i].clock.next = self.clock.val();
            self.latch_view[i].address.next = self.processor.x.val();
            self.latch_view[i].facts.next = self.register_mirror.data.val();
            self.latch_view[i].writes.next = self.processor.latch_arm.val();
            self.latch_view[i].byte.next = self.processor.a.val();
            self.latch_view[i].first_armed.next = self.latch_armed.val();
            self.latch_view[i].first_edges.next = self.latch_edges.val();
            self.latch_view[i].armed.next = self.more_latch_armed[i].val();
            self.latch_view[i].edges.next = self.more_latch_edges[i].val();
            self.latch_view[i].records.next = self.latch_records[i].val();
            self.latch_view[i].state_valid.next = self.state_valid.val();
            self.latch_view[i].state_page.next = self.state_page.val();
            self.latch_view[i].state_record.next = self.state_record[i].val();
            self.latch_view[i].state_axis.next = self.state_axis.val();
            self.latch_view[i].state_item.next = self.state_item.val();
            self.latch_view[i].state.next = self.state.val();
            self.processor.facts.next = self.latch_view[i].data.val();
            self.latch_arm.next = self.latch_view[i].first_arm.val();
            self.more_latch_arm[i].next = self.latch_view[i].arm.val();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::primitives::compiled_once::{assert_sizes_agree, assert_sizes_agree_of};
    use crate::sim::assert_synthesizes;
    use carrystep_core::link::LineKind;
    use carrystep_core::{AXES, Build, PinTiming, StartPhase, Timebase};

    /// A build without several latches.
    fn build() -> EngineBuild {
        let timebase = Timebase::new(48_000_000, 2000, 16).unwrap();
        let build = Build { timebase, phase: StartPhase::Half, pins: [PinTiming::SHORTEST; AXES] };
        EngineBuild::minimal(&build, 1)
    }

    #[test]
    fn formulas_are_the_facts_of_the_build() {
        let mut build = build();
        build.guard.watchdog = 4095;
        let id = LineKind::Spi.build_id(&build);
        let values: Vec<_> = formulas(&build, id)
            .iter()
            .map(|(at, fact)| (*at, fact.value().value() as u32))
            .collect();
        assert_eq!(values, facts(&build, id));
    }

    #[test]
    fn statements_are_those_of_each_size() {
        assert_sizes_agree::<Link<1>>();
        assert_sizes_agree_of(&Link::<7>::new(&build(), BuildId(0)));
    }

    #[test]
    fn link_synthesizes() {
        let build = build();
        let id = LineKind::Spi.build_id(&build);
        assert_synthesizes(Link::<6>::new(&build, id), "carrystep_link");
    }
}
