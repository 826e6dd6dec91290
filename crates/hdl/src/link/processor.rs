//! A small processor that reads requests, executes them and writes the answers.
//!
//! `carrystep_core::link::processor` defines its instructions, and `carrystep_core::link::program`
//! is its program. It has an accumulator A and an index X, and takes three clocks per instruction.
//! A wait or a step of the CRC extends the third.
//!
//! ```text
//! stage     | fetch | address | execute |
//!             |       |         '-- writes A, X, data memory and ports
//!             |       '-- reads the data memory
//!             '-- reads the program memory
//! ```
//!
//! Received bytes enter a ring buffer (`ring`) of 512 bytes, from which the program reads them.
//!
//! Cost: three memories of 512 words: the program with 16 bits per word, the data and the ring
//! buffer with 8.

use super::crc::CrcUnit;
use crate::primitives::compiled_once;
use crate::primitives::constant::Literal;
use crate::primitives::memory::Memory;
use crate::primitives::register::{Input, Register};
use crate::primitives::word::{Word, bit_cast};
use carrystep_core::engine::CAUSE_BITS;
use carrystep_core::link::Image;
use rust_hdl_core::prelude::*;

/// The processor of the link for N axes.
#[derive(LogicBlock, Default)]
pub struct LinkProcessor<const N: usize> {
    /// The clock.
    pub clock: Input<Clock>,
    /// The line has received a byte; asserted for one clock per byte.
    pub received: Input<Bit>,
    /// The received byte.
    pub received_data: Input<Word<8>>,
    /// A is a byte of the answer. The machine offers it until the line accepts it.
    pub answer_valid: Signal<Out, Bit>,
    /// The line accepts the offered byte in this clock.
    pub answer_take: Input<Bit>,
    /// X: the address of the facts that are read.
    pub x: Signal<Out, Word<8>>,
    /// A: the byte of the answer, the axis of an offered word, the axes of a start, or the axes
    /// that wait for their limit.
    pub a: Signal<Out, Word<8>>,
    /// The word of the facts at address X.
    pub facts: Input<Word<32>>,
    /// The machine offers a word of a segment to the engine.
    pub put_valid: Signal<Out, Bit>,
    /// The number of the offered word: 0 to 7 in its segment, or 8 where it names the slot of a
    /// cut.
    pub put_word: Signal<Out, Word<4>>,
    /// The offered word.
    pub put_data: Signal<Out, Word<32>>,
    /// The engine accepts the offered word in this clock.
    pub put_ready: Input<Bit>,
    /// The machine offers a start of the axes in A.
    pub start_valid: Signal<Out, Bit>,
    /// The engine accepts an offered start in this clock.
    pub start_ready: Input<Bit>,
    /// The engine clears a stop.
    pub clear: Signal<Out, Bit>,
    /// The host has broken the segment protocol.
    pub broken: Signal<Out, Bit>,
    /// A replaces the source of seeks.
    pub seek_source_valid: Signal<Out, Bit>,
    /// A replaces the mask of the axes that wait for the source of their seek.
    pub seek_valid: Signal<Out, Bit>,
    /// The latch is armed.
    pub latch_arm: Signal<Out, Bit>,
    /// The host requests a snapshot.
    pub snapshot: Signal<Out, Bit>,
    /// The host requests a cut.
    pub cut: Signal<Out, Bit>,
    /// The owner of the session has sent a valid request.
    pub kick: Signal<Out, Bit>,
    /// The host requests power for the motor drivers.
    pub enable: Signal<Out, Bit>,
    /// The host requests a controlled stop of all axes.
    pub stop: Signal<Out, Bit>,
    /// The engine has output all live words of a tick.
    pub refreshed: Input<Bit>,
    /// The engine has refused the last cut.
    pub cut_refused: Input<Bit>,
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
    /// The first cause of the stop. Without a fault its value and that of `culprits` have no
    /// meaning.
    pub cause: Input<Word<CAUSE_BITS>>,
    /// The number of segments for which the queue of the axis in A has space.
    pub room: Input<Word<5>>,
    /// `room` is valid in this clock.
    pub room_valid: Input<Bit>,
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
    instructions: Memory<9, 16>,
    data: Memory<9, 8>,
    ring: Memory<9, 8>,
    crc: CrcUnit,
    stage: Register<Word<2>>,
    pc: Register<Word<9>>,
    sum: Register<Word<8>>,   // A
    index: Register<Word<8>>, // X
    // The address of the next byte to write in the ring buffer.
    written: Register<Word<9>>,
    // The address of the next byte to read in the ring buffer.
    read: Register<Word<9>>,
    word: Register<Word<3>>,  // the number of the next word of a segment
    space: Register<Word<5>>, // the least `room` that was reported
    power: Register<Bit>,     // `enable`
    clears: Register<Bit>,    // `clear`
    code: Signal<Local, Word<16>>,
    executes: Signal<Local, Bit>,
    sets: Signal<Local, Bit>,
    stores: Signal<Local, Bit>,
    jumps: Signal<Local, Bit>,
    acts: Signal<Local, Bit>,
    only_acts: Signal<Local, Bit>, // it acts, and neither sets nor stores nor jumps
    does: Signal<Local, Bit>,      // it executes, and only acts
    reports: Signal<Local, Bit>,   // `room` counts
    is_segment: Signal<Local, Bit>, // an offered word is one of a segment
    waits: Signal<Local, Bit>,
    waited: Signal<Local, Bit>,
    steps: Signal<Local, Bit>,
    over: Signal<Local, Bit>,
    state: Signal<Local, Word<8>>,
    place: Signal<Local, Word<8>>,
    page: Signal<Local, Word<9>>,
    port: Signal<Local, Word<8>>,
    other: Signal<Local, Word<8>>,
    value: Signal<Local, Word<8>>,
    holds: Signal<Local, Bit>,
    empty: Signal<Local, Bit>,
    fetch: Literal<2, 0>,
    execute: Literal<2, 2>,
    next_stage: Literal<2, 1>,
    one: Literal<8, 1>,
    next_place: Literal<9, 1>,
    next_word: Literal<3, 1>,
    last_word: Literal<3, 7>,
    constants: Literal<9, 0x100>,
    from_ring: Literal<3, 4>,
    none: Literal<8, 0>,
    no_place: Literal<9, 0>,
    no_code: Literal<16, 0>,
    all: Literal<8, 0xff>,
    any_space: Literal<5, 31>,
    slot_of_cut: Literal<4, 8>,
    top: Literal<4, 15>,
    bit_0: Literal<8, 1>,
    bit_1: Literal<8, 2>,
    bit_2: Literal<8, 4>,
    bit_4: Literal<8, 16>,
    bit_6: Literal<8, 64>,
    bit_7: Literal<8, 128>,
    if_zero: Literal<3, 1>,
    if_x7: Literal<3, 2>,
    if_full: Literal<3, 3>,
    if_nothing: Literal<3, 4>,
    if_fault: Literal<3, 5>,
    if_commit: Literal<3, 6>,
    if_special: Literal<3, 7>,
}

impl<const N: usize> LinkProcessor<N> {
    /// Makes the machine with this initial content of its program and data memories.
    pub fn new(image: &Image) -> Self {
        let program: Vec<_> = image
            .program
            .iter()
            .enumerate()
            .map(|(at, code)| (at, Word::from(u64::from(*code))))
            .collect();
        let data: Vec<_> = image
            .data
            .iter()
            .enumerate()
            .map(|(at, byte)| (at, Word::from(u64::from(*byte))))
            .collect();
        Self {
            instructions: Memory::of_words(&program),
            data: Memory::of_words(&data),
            ring: Memory::of_words(&[]),
            ..Self::default()
        }
    }
}

compiled_once::logic!(LinkProcessor<N = 7>);

impl<const N: usize> compiled_once::Kernel for LinkProcessor<N> {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, stage, pc, sum, index, written, read, word, space, power, clears);
        clock!(self, clock, instructions, data, ring, crc);

        // The present instruction, decoded.
        self.instructions.read_address.next = self.pc.q.val();
        self.instructions.write_address.next = self.no_place.val();
        self.instructions.write_data.next = self.no_code.val();
        self.instructions.write_bits.next = self.no_code.val();
        self.code.next = self.instructions.read_data.val();
        self.executes.next = self.stage.q.val() == self.execute.val();
        self.sets.next = self.executes.val() & self.code.val().get_bit(15);
        self.stores.next =
            self.executes.val() & self.code.val().get_bit(14) & !self.code.val().get_bit(15);
        self.jumps.next = self.code.val().get_bit(13);
        self.acts.next =
            self.executes.val() & self.code.val().get_bit(12) & !self.code.val().get_bit(13);
        self.only_acts.next = !self.code.val().get_bit(13)
            & !self.code.val().get_bit(14)
            & !self.code.val().get_bit(15);
        self.does.next = self.executes.val() & self.only_acts.val();
        self.steps.next = self.does.val() & self.code.val().get_bit(2);
        self.waits.next = self.does.val() & self.code.val().get_bit(5);
        self.state.next = self.none.val();
        if self.fault.val() {
            self.state.next = self.state.val() | self.bit_0.val();
        }
        if self.ready.val() {
            self.state.next = self.state.val() | self.bit_1.val();
        }
        if self.armed.val() {
            self.state.next = self.state.val() | self.bit_2.val();
        }
        if self.cut_refused.val() {
            self.state.next = self.state.val() | self.bit_4.val();
        }
        if self.idle.val() {
            self.state.next = self.state.val() | self.bit_6.val();
        }
        if self.halted.val() {
            self.state.next = self.state.val() | self.bit_7.val();
        }
        self.waited.next =
            self.refreshed.val() | (self.code.val().get_bit(3) & self.room_valid.val());
        if self.code.val().get_bit(11) {
            self.waited.next = self.put_ready.val() | self.fault.val();
        }
        if self.code.val().get_bit(9) {
            self.waited.next = self.answer_take.val();
        }
        if self.code.val().get_bit(10) {
            self.waited.next = self.start_ready.val() | self.fault.val();
        }
        self.over.next =
            (!self.waits.val() | self.waited.val()) & (!self.steps.val() | self.crc.over.val());
        if !self.executes.val() {
            self.stage.d.next = self.stage.q.val() + self.next_stage.val();
        } else if self.over.val() {
            self.stage.d.next = self.fetch.val();
        }

        // The condition of a jump, and the address of the next instruction.
        self.empty.next = self.read.q.val() == self.written.q.val();
        self.holds.next = true;
        if self.code.val().get_bits::<3>(9) == self.if_zero.val() {
            self.holds.next = !self.sum.q.val().any();
        }
        if self.code.val().get_bits::<3>(9) == self.if_x7.val() {
            self.holds.next = self.index.q.val().get_bit(7);
        }
        if self.code.val().get_bits::<3>(9) == self.if_full.val() {
            self.holds.next = self.index.q.val().get_bits::<4>(4) == self.top.val();
        }
        if self.code.val().get_bits::<3>(9) == self.if_nothing.val() {
            self.holds.next = self.empty.val();
        }
        if self.code.val().get_bits::<3>(9) == self.if_fault.val() {
            self.holds.next = self.fault.val();
        }
        if self.code.val().get_bits::<3>(9) == self.if_commit.val() {
            self.holds.next = self.word.q.val() == self.last_word.val();
        }
        if self.code.val().get_bits::<3>(9) == self.if_special.val() {
            self.holds.next = self.sum.q.val().get_bit(7) & self.sum.q.val().get_bit(6);
        }
        if self.executes.val() & self.over.val() {
            self.pc.d.next = self.pc.q.val() + self.next_place.val();
            if self.jumps.val() & (self.holds.val() ^ self.code.val().get_bit(12)) {
                self.pc.d.next = self.code.val().get_bits::<9>(0);
            }
        }

        // The value that an instruction writes to A.
        self.port.next = self.state.val();
        if self.code.val().get_bit(0) {
            self.port.next = bit_cast::<8, 5>(self.space.q.val());
        }
        if self.code.val().get_bit(1) {
            self.port.next = self.none.val();
            if self.fault.val() {
                self.port.next = bit_cast::<8, N>(self.culprits.val());
            }
            if self.code.val().get_bit(0) {
                self.port.next = bit_cast::<8, N>(self.seeking.val());
            }
        }
        if self.code.val().get_bit(2) {
            self.port.next = bit_cast::<8, N>(self.hits.val());
            if self.code.val().get_bit(0) {
                self.port.next = bit_cast::<8, 4>(self.latch_edges.val());
                if self.latch_armed.val() {
                    self.port.next = bit_cast::<8, 4>(self.latch_edges.val()) | self.bit_4.val();
                }
            }
            if self.code.val().get_bit(1) {
                self.port.next = bit_cast::<8, CAUSE_BITS>(self.cause.val());
            }
        }
        // The source in bits 10 to 8: bit 10 is 0 for the data memory.
        self.other.next = self.ring.read_data.val();
        if self.code.val().get_bit(8) {
            self.other.next = self.index.q.val();
        }
        if self.code.val().get_bit(9) {
            self.other.next = self.crc.word_out.val().get_bits::<8>(0);
            if self.code.val().get_bit(8) {
                self.other.next = self.port.val();
            }
        }
        self.value.next = self.data.read_data.val();
        if self.code.val().get_bit(10) {
            self.value.next = self.other.val();
        }
        if self.sets.val() {
            self.sum.d.next = self.value.val();
            if self.code.val().get_bit(11) {
                self.sum.d.next = self.sum.q.val() ^ self.value.val();
            }
            if self.code.val().get_bit(14) {
                self.sum.d.next = self.sum.q.val() & self.value.val();
            }
        }
        if self.acts.val() & self.code.val().get_bit(0) {
            self.index.d.next = self.sum.q.val();
        }
        if self.acts.val() & self.code.val().get_bit(1) & self.over.val() {
            self.index.d.next = self.index.q.val() + self.one.val();
        }

        // The data memory.
        self.place.next = self.code.val().get_bits::<8>(0);
        if self.code.val().get_bit(8) {
            self.place.next = self.index.q.val();
        }
        self.page.next = bit_cast::<9, 8>(self.place.val());
        if self.code.val().get_bit(9) {
            self.page.next = bit_cast::<9, 8>(self.place.val()) | self.constants.val();
        }
        self.data.read_address.next = self.page.val();
        self.data.write_address.next = self.page.val();
        self.data.write_data.next = self.sum.q.val();
        self.data.write_bits.next = self.none.val();
        if self.stores.val() {
            self.data.write_bits.next = self.all.val();
        }

        // The CRC and word register.
        self.crc.begins.next = self.does.val() & self.code.val().get_bit(4);
        self.crc.step.next = self.steps.val();
        self.crc.feed.next = self.code.val().get_bit(3);
        self.crc.data.next = self.sum.q.val();
        self.crc.word.next = self.facts.val();

        // The ring buffer of received bytes.
        self.ring.read_address.next = self.read.q.val();
        if self.sets.val() & (self.code.val().get_bits::<3>(8) == self.from_ring.val()) {
            self.read.d.next = self.read.q.val() + self.next_place.val();
        }
        self.ring.write_address.next = self.written.q.val();
        self.ring.write_data.next = self.received_data.val();
        self.ring.write_bits.next = self.none.val();
        if self.received.val() {
            self.ring.write_bits.next = self.all.val();
        }
        if self.received.val() {
            self.written.d.next = self.written.q.val() + self.next_place.val();
        }

        // The ports of the engine.
        self.reports.next = self.only_acts.val()
            & self.code.val().get_bit(5)
            & self.code.val().get_bit(3)
            & self.room_valid.val();
        if self.does.val() & self.code.val().get_bit(4) {
            self.space.d.next = self.any_space.val();
        }
        if self.reports.val() & (self.room.val() < self.space.q.val()) {
            self.space.d.next = self.room.val();
        }
        if self.does.val()
            & self.code.val().get_bit(6)
            & !self.code.val().get_bit(7)
            & !self.code.val().get_bit(8)
        {
            self.power.d.next = self.sum.q.val().get_bit(0);
            self.clears.d.next = self.code.val().get_bit(9);
        }
        self.seek_valid.next = self.does.val()
            & self.code.val().get_bit(6)
            & self.code.val().get_bit(7)
            & !self.code.val().get_bit(8);
        self.seek_source_valid.next = self.does.val()
            & self.code.val().get_bit(6)
            & self.code.val().get_bit(7)
            & self.code.val().get_bit(8);
        self.latch_arm.next = self.does.val()
            & self.code.val().get_bit(7)
            & self.code.val().get_bit(9)
            & !self.code.val().get_bit(6)
            & !self.code.val().get_bit(8);
        self.kick.next = self.does.val()
            & self.code.val().get_bit(7)
            & !self.code.val().get_bit(6)
            & !self.code.val().get_bit(8);
        self.broken.next = self.does.val()
            & self.code.val().get_bit(8)
            & !self.code.val().get_bit(6)
            & !self.code.val().get_bit(7);
        self.stop.next = self.does.val()
            & self.code.val().get_bit(7)
            & self.code.val().get_bit(8)
            & !self.code.val().get_bit(6);
        self.snapshot.next = self.does.val()
            & self.code.val().get_bit(8)
            & self.code.val().get_bit(6)
            & !self.code.val().get_bit(7)
            & !self.code.val().get_bit(9);
        self.cut.next = self.does.val()
            & self.code.val().get_bit(8)
            & self.code.val().get_bit(6)
            & !self.code.val().get_bit(7)
            & self.code.val().get_bit(9);
        self.clear.next = self.clears.q.val();
        self.answer_valid.next = self.waits.val() & self.code.val().get_bit(9);
        self.start_valid.next = self.does.val() & self.code.val().get_bit(10);
        self.put_valid.next = self.does.val() & self.code.val().get_bit(11);
        self.is_segment.next = self.sum.q.val().get_bit(3);
        if self.put_valid.val() & self.over.val() & self.is_segment.val() {
            self.word.d.next = self.word.q.val() + self.next_word.val();
        }
        self.put_word.next = self.slot_of_cut.val();
        if self.is_segment.val() {
            self.put_word.next = bit_cast::<4, 3>(self.word.q.val());
        }
        self.put_data.next = self.crc.word_out.val();
        self.enable.next = self.power.q.val();
        self.x.next = self.index.q.val();
        self.a.next = self.sum.q.val();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::primitives::compiled_once::assert_sizes_agree;
    use crate::sim::assert_synthesizes;

    #[test]
    fn statements_are_those_of_each_size() {
        assert_sizes_agree::<LinkProcessor<1>>();
        assert_sizes_agree::<LinkProcessor<6>>();
    }

    #[test]
    fn machine_synthesizes() {
        assert_synthesizes(
            LinkProcessor::<6>::new(&carrystep_core::link::image(false)),
            "carrystep_processor",
        );
    }
}
