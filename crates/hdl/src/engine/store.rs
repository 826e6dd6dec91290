//! The memory of all axes. It holds the segments, which also serve as registers, and the state that
//! an axis keeps between moves.
//!
//! ```text
//! address   slot, high bits 2 | axis 3 | slot, low bits 3 | word 3
//! word      0 ticks - 1   1 2 V   3 4 A   5 6 J (low, high)   7: state of the axis, by slot:
//! slot      0 1 P (low, high)   2 position   3 discarded   4 5 -s   6 7 s    s: stop acceleration
//!
//! beat      0    1    2    3    4    5    6    7    8    9    10   11   12
//! reads     A    J    V    P    n    pos  J'   A'   V'   P'   tick      tick
//! writes                        A    V    P    n    pos  put  A'   V'   P'
//!           ': high halves      n: ticks - 1, or at rest the discarded steps
//! ```
//!
//! A word that is read in beat k is added in beat k + 2, and the sum is written in beat k + 3. For
//! A + J both words come from this memory, so one of them (A, then J') is read a beat earlier. Beat
//! 9 writes the word that the host has put. The number of the tick has a word of its own; it is
//! written after the last time slot, in the clock after its beat 16. In a ramp the memory returns
//! -s or s in place of A, so that a ramp needs no additional adder.
//!
//! Cost: one memory of 512 words of 32 bits for eight slots of each axis, 1024 for 16 slots, 2048
//! for 32. Eight axes with eight slots have 1024 words, of which 513 are used.

use super::layout::{
    BEAT_OVER_SUM_TICK, BEAT_READ_A_HIGH, BEAT_READ_A_LOW, BEAT_READ_J_HIGH, BEAT_READ_J_LOW,
    BEAT_READ_P_HIGH, BEAT_READ_P_LOW, BEAT_READ_POSITION, BEAT_READ_TICK, BEAT_READ_TICK_AGAIN,
    BEAT_READ_TICKS, BEAT_READ_V_HIGH, BEAT_READ_V_LOW, BEAT_SUM_TICK, BEAT_WRITE_A_HIGH,
    BEAT_WRITE_A_LOW, BEAT_WRITE_P_HIGH, BEAT_WRITE_P_LOW, BEAT_WRITE_POSITION, BEAT_WRITE_PUT,
    BEAT_WRITE_TICKS, BEAT_WRITE_V_HIGH, BEAT_WRITE_V_LOW, SLOT_DISCARDED, SLOT_DOWN_HIGH,
    SLOT_DOWN_LOW, SLOT_HIGH, SLOT_LOW, SLOT_P_HIGH, SLOT_P_LOW, SLOT_POSITION, SLOT_UP_HIGH,
    SLOT_UP_LOW, TICK_ADDRESS, WORD_A_HIGH, WORD_A_LOW, WORD_J_HIGH, WORD_J_LOW, WORD_STATE,
    WORD_TICKS, WORD_V_HIGH, WORD_V_LOW, state_address,
};
use crate::parameters::{START_HALF, STOP_ACCEL};
use crate::primitives::constant::{Literal, Parameter, ParameterRefusal};
use crate::primitives::formula::Formula;
use crate::primitives::memory::Memory;
use crate::primitives::per_axis::PerAxis;
use crate::primitives::register::{Input, Register};
use crate::primitives::word::{Word, bit_cast};
use carrystep_core::StartPhase;
use carrystep_core::engine::MAX_AXES;
use rust_hdl_core::prelude::*;

/// The memory and the selection of its addresses.
#[derive(LogicBlock, Default)]
pub struct Store {
    /// The clock.
    pub clock: Input<Clock>,
    /// The beats of [`super::time_slot`]: bit i is asserted in beat i of a time slot.
    pub beat: Input<Word<17>>,
    /// The axis of the time slot.
    pub axis: Input<Word<3>>,
    /// The slot of the running segment of the axis.
    pub live: Input<Word<5>>,
    /// The slot that the host writes.
    pub fresh: Input<Word<5>>,
    /// The axis runs in this tick.
    pub running: Input<Bit>,
    /// The axis runs, and V is in range as far as is known.
    pub sound: Input<Bit>,
    /// In beat 12: the axis runs and its V is in range.
    pub moves: Input<Bit>,
    /// The axis ramps down: the stop acceleration replaces A.
    pub slows: Input<Bit>,
    /// The stop acceleration is added (s), because the ramp began with V < 0. Otherwise it is
    /// subtracted (-s).
    pub upward: Input<Bit>,
    /// V stays unchanged in this tick.
    pub steady: Input<Bit>,
    /// P is set to its start value.
    pub wipe: Input<Bit>,
    /// In beat 9: the word of the host is written.
    pub put: Input<Bit>,
    /// The number of that word in its segment.
    pub put_word: Input<Word<3>>,
    /// The sum to write.
    pub sum: Input<Word<32>>,
    /// The word that was read.
    pub word: Signal<Out, Word<32>>,
    pub(crate) segments: Memory<11, 32>,
    counted: Register<Bit>, // the sum is the number of the next tick
    read_slot: Signal<Local, Word<5>>,
    read_word: Signal<Local, Word<3>>,
    write_slot: Signal<Local, Word<5>>,
    write_word: Signal<Local, Word<3>>,
    writes: Signal<Local, Bit>,
    ticks: Literal<3, WORD_TICKS>,
    v_low: Literal<3, WORD_V_LOW>,
    v_high: Literal<3, WORD_V_HIGH>,
    a_low: Literal<3, WORD_A_LOW>,
    a_high: Literal<3, WORD_A_HIGH>,
    j_low: Literal<3, WORD_J_LOW>,
    j_high: Literal<3, WORD_J_HIGH>,
    kept: Literal<3, WORD_STATE>,
    p_low: Literal<5, SLOT_P_LOW>,
    p_high: Literal<5, SLOT_P_HIGH>,
    position: Literal<5, SLOT_POSITION>,
    discarded: Literal<5, SLOT_DISCARDED>,
    down_low: Literal<5, SLOT_DOWN_LOW>,
    down_high: Literal<5, SLOT_DOWN_HIGH>,
    up_low: Literal<5, SLOT_UP_LOW>,
    up_high: Literal<5, SLOT_UP_HIGH>,
    at_3: Literal<4, 3>,
    at_6: Literal<4, 6>,
    at_9: Literal<4, 9>,
    tick_address: Literal<11, TICK_ADDRESS>,
    start_high: Parameter<32>,
    no: Literal<32, 0>,
    all: Literal<32, 0xffff_ffff>,
    start_half_out_of_range: ParameterRefusal,
    stop_accel_out_of_range: PerAxis<ParameterRefusal, MAX_AXES>,
}

impl Store {
    /// Makes the memory. `start` is the start value of P; `stops` are the stop accelerations of the
    /// axes in 2^-64 step per tick^2; `slots` is the number of slots of an axis, 8, 16 or 32. The
    /// first tick has no time slots, so the first number of a tick that is read is 1.
    pub fn new(start: StartPhase, stops: &[u64], slots: usize) -> Self {
        let half = START_HALF.of::<32>(start == StartPhase::Half);
        let high = |start: StartPhase| Formula::number(start.start_value() >> 32);
        let start_high = high(StartPhase::Half).where_or(&half.bits(0), high(StartPhase::Zero));
        let mut kept = Vec::new();
        let mut store = Self::default();
        for (axis, stop) in stops.iter().enumerate() {
            let stop = STOP_ACCEL.of_axis::<64>(axis, *stop);
            let (low, high) = (stop.bits::<32>(0), stop.bits::<32>(32));
            // -s: one more than its complement, whose low half carries where s has zeros only
            // there.
            let carry =
                Formula::number(1).where_or(&low.is(&Formula::number(0)), Formula::number(0));
            let down = [Formula::number(0) - low.clone(), !high.clone() + carry];
            let [down_low, down_high] = down;
            let words = [
                (SLOT_P_HIGH, start_high.clone()),
                (SLOT_DOWN_LOW, down_low),
                (SLOT_DOWN_HIGH, down_high),
                (SLOT_UP_LOW, low),
                (SLOT_UP_HIGH, high),
            ];
            kept.extend(words.map(|(slot, word)| (state_address(axis, slot), word)));
            store.stop_accel_out_of_range[axis] =
                ParameterRefusal::of(&stop.is_outside(1, 1 << 62));
        }
        let bits = (8 * 8 * slots).ilog2() as usize;
        let bits = if stops.len() < MAX_AXES { bits } else { bits.max(10) };
        kept.push((TICK_ADDRESS as usize & ((1 << bits) - 1), Formula::number(1)));
        Self {
            segments: Memory::of_few_formulas(bits, &kept),
            start_high: Parameter::of(&start_high),
            start_half_out_of_range: ParameterRefusal::of(&half.is_outside(0, 1)),
            ..store
        }
    }
}

impl Logic for Store {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, counted);
        clock!(self, clock, segments);

        // The read address.
        self.read_slot.next = self.live.val();
        self.read_word.next = self.kept.val();
        if self.beat.val().get_bit(BEAT_READ_A_LOW) {
            if self.slows.val() {
                self.read_slot.next = self.down_low.val();
                if self.upward.val() {
                    self.read_slot.next = self.up_low.val();
                }
            } else {
                self.read_word.next = self.a_low.val();
            }
        }
        if self.beat.val().get_bit(BEAT_READ_J_LOW) {
            self.read_word.next = self.j_low.val();
        }
        if self.beat.val().get_bit(BEAT_READ_V_LOW) {
            self.read_word.next = self.v_low.val();
        }
        if self.beat.val().get_bit(BEAT_READ_P_LOW) {
            self.read_slot.next = self.p_low.val();
        }
        if self.beat.val().get_bit(BEAT_READ_TICKS) {
            if self.running.val() {
                self.read_word.next = self.ticks.val();
            } else {
                self.read_slot.next = self.discarded.val();
            }
        }
        if self.beat.val().get_bit(BEAT_READ_POSITION) {
            self.read_slot.next = self.position.val();
        }
        if self.beat.val().get_bit(BEAT_READ_J_HIGH) {
            self.read_word.next = self.j_high.val();
        }
        if self.beat.val().get_bit(BEAT_READ_A_HIGH) {
            if self.slows.val() {
                self.read_slot.next = self.down_high.val();
                if self.upward.val() {
                    self.read_slot.next = self.up_high.val();
                }
            } else {
                self.read_word.next = self.a_high.val();
            }
        }
        if self.beat.val().get_bit(BEAT_READ_V_HIGH) {
            self.read_word.next = self.v_high.val();
        }
        if self.beat.val().get_bit(BEAT_READ_P_HIGH) {
            self.read_slot.next = self.p_high.val();
        }
        self.segments.read_address.next =
            (bit_cast::<11, 2>(self.read_slot.val().get_bits::<2>(SLOT_HIGH)) << self.at_9.val())
                | (bit_cast::<11, 3>(self.axis.val()) << self.at_6.val())
                | (bit_cast::<11, 3>(self.read_slot.val().get_bits::<3>(SLOT_LOW))
                    << self.at_3.val())
                | bit_cast::<11, 3>(self.read_word.val());
        if self.beat.val().get_bit(BEAT_READ_TICK) | self.beat.val().get_bit(BEAT_READ_TICK_AGAIN) {
            self.segments.read_address.next = self.tick_address.val();
        }
        self.word.next = self.segments.read_data.val();

        // The write address and the written word.
        self.write_slot.next = self.live.val();
        self.write_word.next = self.kept.val();
        self.writes.next = false;
        if self.beat.val().get_bit(BEAT_WRITE_A_LOW) {
            self.write_word.next = self.a_low.val();
            self.writes.next = self.sound.val();
        }
        if self.beat.val().get_bit(BEAT_WRITE_V_LOW) {
            self.write_word.next = self.v_low.val();
            self.writes.next = self.sound.val() & !self.steady.val();
        }
        if self.beat.val().get_bit(BEAT_WRITE_P_LOW) {
            self.write_slot.next = self.p_low.val();
            self.writes.next = self.sound.val() | self.wipe.val();
        }
        if self.beat.val().get_bit(BEAT_WRITE_TICKS) {
            self.writes.next = true;
            if self.running.val() {
                self.write_word.next = self.ticks.val();
            } else {
                self.write_slot.next = self.discarded.val();
            }
        }
        if self.beat.val().get_bit(BEAT_WRITE_POSITION) {
            self.write_slot.next = self.position.val();
            self.writes.next = true;
        }
        if self.beat.val().get_bit(BEAT_WRITE_PUT) {
            self.write_slot.next = self.fresh.val();
            self.write_word.next = self.put_word.val();
            self.writes.next = self.put.val();
        }
        if self.beat.val().get_bit(BEAT_WRITE_A_HIGH) {
            self.write_word.next = self.a_high.val();
            self.writes.next = self.sound.val();
        }
        if self.beat.val().get_bit(BEAT_WRITE_V_HIGH) {
            self.write_word.next = self.v_high.val();
            self.writes.next = self.sound.val() & !self.steady.val();
        }
        if self.beat.val().get_bit(BEAT_WRITE_P_HIGH) {
            self.write_slot.next = self.p_high.val();
            self.writes.next = self.moves.val() | self.wipe.val();
        }
        self.segments.write_address.next =
            (bit_cast::<11, 2>(self.write_slot.val().get_bits::<2>(SLOT_HIGH)) << self.at_9.val())
                | (bit_cast::<11, 3>(self.axis.val()) << self.at_6.val())
                | (bit_cast::<11, 3>(self.write_slot.val().get_bits::<3>(SLOT_LOW))
                    << self.at_3.val())
                | bit_cast::<11, 3>(self.write_word.val());
        // The tail of the last time slot, which no other one overlaps.
        self.counted.d.next =
            self.beat.val().get_bit(BEAT_SUM_TICK) & !self.beat.val().get_bit(BEAT_OVER_SUM_TICK);
        if self.counted.q.val() {
            self.segments.write_address.next = self.tick_address.val();
            self.writes.next = true;
        }
        self.segments.write_data.next = self.sum.val();
        if self.wipe.val() & self.beat.val().get_bit(BEAT_WRITE_P_HIGH) {
            self.segments.write_data.next = self.sum.val() | self.start_high.val();
        }
        self.segments.write_bits.next = self.no.val();
        if self.writes.val() {
            self.segments.write_bits.next = self.all.val();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::assert_synthesizes;

    #[test]
    fn store_synthesizes() {
        assert_synthesizes(Store::new(StartPhase::Half, &[1 << 40; 6], 8), "carrystep_store");
    }
}
