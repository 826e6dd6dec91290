//! The only adder of the engine. It computes P + V, V + A, A + J, the remaining ticks, the
//! positions and the bisection, with 32 bits per clock.
//!
//! ```text
//!   memory --+--> A --.           beat   sum                beat   sum
//!   put -----'        X --.        3     A + J, low          9     A + J, high
//!           .--> R ---'   |        4     A + V, low         10     A + V, high
//!           |             +--> R   5     P + V, low         11     P + V, high: carry, a step
//!           '-------------+        6     ticks - 1          12     bisection: P + V / 2
//!   memory -----> B ------'        7     position           13-15  bisection: +- V / 4, / 8, / 16
//!                 '-> B / 2        8     (a host's word)           of the slot before
//!                                                         16     the number of the tick + 1, once
//! ```
//!
//! The 64-bit sums are computed as two halves. The carries of the three low halves wait in
//! flip-flops (`carry_0` to `carry_2`) until the high halves are added. The carry of P + V tells
//! whether the tick contains a step.
//!
//! The bisection is non-restoring: if the sum with a part of V carries, the next half of that part
//! is subtracted instead of added. To subtract, the adder adds the half to the complement of the
//! sum; the result is the complement of the difference. The operand X is therefore R or its
//! complement, as `top` selects, and the adder only ever adds. When halving drops the lowest bit of
//! an odd number (`odd`), that bit re-enters as a carry.
//!
//! Cost: one adder of 32 bits with a carry at each end, and three registers of 32 bits. The price
//! is time: one tick of one axis takes 13 clocks, where [`crate::parallel::axis`] takes one clock
//! and three adders of 64 bits.

use super::layout::{
    BEAT_BISECT_1, BEAT_BISECT_2, BEAT_BISECT_3, BEAT_LOAD_A_HIGH, BEAT_LOAD_A_LOW,
    BEAT_LOAD_J_HIGH, BEAT_LOAD_J_LOW, BEAT_LOAD_P_HIGH, BEAT_LOAD_P_LOW, BEAT_LOAD_POSITION,
    BEAT_LOAD_TICK, BEAT_LOAD_TICK_STEP, BEAT_LOAD_TICKS, BEAT_LOAD_V_HIGH, BEAT_LOAD_V_LOW,
    BEAT_OVER_LOAD_TICK_STEP, BEAT_PHASE, BEAT_PUT, BEAT_SUM_P_HIGH, BEAT_SUM_P_LOW, BEAT_SUM_PUT,
    BEAT_SUM_TICKS, BEAT_WRITE_A_LOW, BEAT_WRITE_P_LOW, BEAT_WRITE_TICKS, BEAT_WRITE_V_HIGH,
    BEAT_WRITE_V_LOW, WIDE_SUM, WIDE_TOP, WORD_LOWEST, WORD_SIGN,
};
use crate::primitives::constant::Literal;
use crate::primitives::register::{Input, Register};
use crate::primitives::word::{Word, bit_cast};
use rust_hdl_core::prelude::*;

/// The adder with its operand registers, its sum and the flags derived from the sums.
#[derive(LogicBlock, Default)]
pub struct Adder {
    /// The clock.
    pub clock: Input<Clock>,
    /// The beats of [`super::time_slot`]: bit i is asserted in beat i of a time slot.
    pub beat: Input<Word<17>>,
    /// The word that the memory returns.
    pub word: Input<Word<32>>,
    /// The word that the host offers.
    pub put: Input<Word<32>>,
    /// The axis runs: beat 6 subtracts one from its remaining ticks.
    pub counts: Input<Bit>,
    /// In beat 5: the axis is at rest, and beat 6 adds one to its discarded steps. Never asserted
    /// with `counts`.
    pub lost: Input<Bit>,
    /// In beat 6: beat 7 adds one to the position.
    pub up: Input<Bit>,
    /// In beat 6: beat 7 subtracts one from the position.
    pub down: Input<Bit>,
    /// The sums that replace P are zero.
    pub wipe: Input<Bit>,
    /// A reset: the sum that replaces the discarded steps is zero.
    pub forgets: Input<Bit>,
    /// The sum of the beat before.
    pub sum: Signal<Out, Word<32>>,
    /// From beat 8: the running segment ends with this tick.
    pub ended: Signal<Out, Bit>,
    /// From beat 12: V + A does not fit in 64 bits.
    pub overflow: Signal<Out, Bit>,
    /// From beat 12: V + A and V have different signs.
    pub turned: Signal<Out, Bit>,
    /// In beat 12: the tick contains a step.
    pub crosses: Signal<Out, Bit>,
    /// From beat 12: V < 0.
    pub back: Signal<Out, Bit>,
    /// From beat 12: V = 0.
    pub still: Signal<Out, Bit>,
    /// From beat 12: V = -2^63.
    pub least: Signal<Out, Bit>,
    /// After beat 16: the phase of the step, in 1/16 tick.
    pub q: Signal<Out, Word<4>>,
    a: Register<Word<32>>,
    b: Register<Word<32>>,
    r: Register<Word<32>>,
    top: Register<Bit>,     // bit 32 of the sum of X and the signed B
    carry_0: Register<Bit>, // the carries of the low halves, the latest in `carry_0`
    carry_1: Register<Bit>,
    carry_2: Register<Bit>,
    over: Register<Bit>,      // `ended`
    unfit: Register<Bit>,     // `overflow`
    sign_of_a: Register<Bit>, // the sign of A in the beat before
    sign_of_b: Register<Bit>, // the sign of B in the beat before
    other: Register<Bit>,     // `turned`
    low_zero: Register<Bit>,
    minus: Register<Bit>,   // `back`
    zero: Register<Bit>,    // `still`
    bound: Register<Bit>,   // `least`
    crossed: Register<Bit>, // the last bisection sum but one carried
    bisects: Register<Bit>,
    // The carry in if `top` is 1; computed one beat ahead.
    carry_if_top: Register<Bit>,
    // The carry in if `top` is 0; computed one beat ahead.
    carry_if_not: Register<Bit>,
    bits: Register<Word<4>>, // `q`
    x: Signal<Local, Word<32>>,
    half: Signal<Local, Word<32>>,
    ones_in: Signal<Local, Bit>,
    counting: Signal<Local, Bit>,
    adds_tick: Signal<Local, Bit>, // in the next clock the sum is the number of the tick + 1
    load: Signal<Local, Bit>,
    halve: Signal<Local, Bit>,
    halves_on: Signal<Local, Bit>,
    crosses_now: Signal<Local, Bit>,
    carry_due: Signal<Local, Bit>,
    odd: Signal<Local, Bit>, // halving B drops a 1 at its lowest bit
    odd_beyond: Signal<Local, Bit>,
    carry_in: Signal<Local, Bit>,
    extended: Signal<Local, Word<33>>, // B, sign-extended by one bit
    low: Signal<Local, Word<34>>,
    wide: Signal<Local, Word<34>>,
    empty: Signal<Local, Bit>,
    wiping: Signal<Local, Bit>,
    nothing: Literal<32, 0>,
    ones: Literal<32, 0xffff_ffff>,
    sign: Literal<32, 0x8000_0000>,
    above: Literal<33, 0x1_0000_0000>,
    by_one: Literal<1, 1>,
    carry: Literal<34, 1>,
    no_carry: Literal<34, 0>,
    q_bit: Literal<4, 1>,
}

impl Logic for Adder {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, a, b, r, top, sign_of_b, carry_0, carry_1, carry_2, over, unfit);
        dff_setup!(
            self,
            clock,
            low_zero,
            minus,
            zero,
            bound,
            crossed,
            carry_if_top,
            carry_if_not,
            bits,
            bisects,
            sign_of_a,
            other
        );

        // Operand A is loaded from memory, in beat 7 from the host.
        if self.beat.val().get_bit(BEAT_LOAD_A_LOW)
            | self.beat.val().get_bit(BEAT_LOAD_P_LOW)
            | self.beat.val().get_bit(BEAT_LOAD_TICKS)
            | self.beat.val().get_bit(BEAT_LOAD_POSITION)
            | self.beat.val().get_bit(BEAT_LOAD_A_HIGH)
            | self.beat.val().get_bit(BEAT_LOAD_P_HIGH)
            | self.beat.val().get_bit(BEAT_LOAD_TICK)
        {
            self.a.d.next = self.word.val();
        }
        if self.beat.val().get_bit(BEAT_PUT) {
            self.a.d.next = self.put.val();
        }

        // Operand B is loaded from memory, set to -1 or 0 for counting, or halved for the
        // bisection.
        self.adds_tick.next = self.beat.val().get_bit(BEAT_LOAD_TICK_STEP)
            & !self.beat.val().get_bit(BEAT_OVER_LOAD_TICK_STEP);
        self.counting.next = self.beat.val().get_bit(BEAT_LOAD_TICKS)
            | self.beat.val().get_bit(BEAT_LOAD_POSITION)
            | self.adds_tick.val();
        self.ones_in.next = (self.beat.val().get_bit(BEAT_LOAD_TICKS) & self.counts.val())
            | (self.beat.val().get_bit(BEAT_LOAD_POSITION) & !self.up.val());
        self.load.next = self.beat.val().get_bit(BEAT_LOAD_J_LOW)
            | self.beat.val().get_bit(BEAT_LOAD_V_LOW)
            | self.beat.val().get_bit(BEAT_LOAD_J_HIGH)
            | self.beat.val().get_bit(BEAT_LOAD_V_HIGH);
        self.halve.next = self.beat.val().get_bit(BEAT_SUM_P_HIGH)
            | self.beat.val().get_bit(BEAT_BISECT_1)
            | self.beat.val().get_bit(BEAT_BISECT_2)
            | self.beat.val().get_bit(BEAT_BISECT_3);
        self.half.next = (self.b.q.val() >> self.by_one.val()) | (self.b.q.val() & self.sign.val());
        if self.ones_in.val() {
            self.b.d.next = self.ones.val();
        } else if self.counting.val() {
            self.b.d.next = self.nothing.val();
        } else if self.load.val() {
            self.b.d.next = self.word.val();
        } else if self.halve.val() {
            self.b.d.next = self.half.val();
        }
        // 1 if the bisection continues in the next beat.
        self.halves_on.next = self.beat.val().get_bit(BEAT_BISECT_1)
            | self.beat.val().get_bit(BEAT_BISECT_2)
            | self.beat.val().get_bit(BEAT_BISECT_3);
        self.bisects.d.next = self.halves_on.val();

        // Operand X is A, or in the bisection R or the complement of R.
        self.crosses_now.next = self.top.q.val() ^ self.crossed.q.val();
        self.x.next = self.a.q.val();
        if self.bisects.q.val() {
            self.x.next = self.r.q.val();
            if self.top.q.val() {
                self.x.next = !self.r.q.val();
            }
        }

        // The sum. A carry enters as 1 + 1 in an additional bit below the lowest.
        self.carry_due.next = self.adds_tick.val()
            | (self.beat.val().get_bit(BEAT_LOAD_TICKS) & self.lost.val())
            | (self.beat.val().get_bit(BEAT_LOAD_POSITION) & !self.down.val())
            | ((self.beat.val().get_bit(BEAT_LOAD_A_HIGH)
                | self.beat.val().get_bit(BEAT_LOAD_V_HIGH)
                | self.beat.val().get_bit(BEAT_LOAD_P_HIGH))
                & self.carry_2.q.val());
        self.odd.next = self.halves_on.val() & self.b.q.val().get_bit(WORD_LOWEST);
        self.odd_beyond.next = self.odd.val() & self.bisects.q.val() & self.crosses_now.val();
        self.carry_if_not.d.next = self.carry_due.val() | self.odd_beyond.val();
        self.carry_if_top.d.next = self.carry_due.val() | (self.odd.val() & !self.odd_beyond.val());
        self.carry_in.next = self.carry_if_not.q.val();
        if self.top.q.val() {
            self.carry_in.next = self.carry_if_top.q.val();
        }
        self.low.next = self.no_carry.val();
        if self.carry_in.val() {
            self.low.next = self.carry.val();
        }
        self.extended.next = bit_cast::<33, 32>(self.b.q.val());
        if self.b.q.val().get_bit(WORD_SIGN) {
            self.extended.next = bit_cast::<33, 32>(self.b.q.val()) | self.above.val();
        }
        self.wide.next = ((bit_cast::<34, 32>(self.x.val()) << self.by_one.val())
            | self.carry.val())
            + ((bit_cast::<34, 33>(self.extended.val()) << self.by_one.val()) | self.low.val());
        self.wiping.next = (self.wipe.val()
            & (self.beat.val().get_bit(BEAT_SUM_P_LOW) | self.beat.val().get_bit(BEAT_SUM_P_HIGH)))
            | (self.forgets.val() & self.beat.val().get_bit(BEAT_SUM_TICKS));
        self.r.d.next = self.wide.val().get_bits::<32>(WIDE_SUM);
        if self.beat.val().get_bit(BEAT_SUM_PUT) {
            self.r.d.next = self.x.val();
        }
        if self.wiping.val() {
            self.r.d.next = self.nothing.val();
        }
        self.top.d.next = self.wide.val().get_bit(WIDE_TOP);
        // The carry of a low half is known one beat later: it is the top bit of the sum without the
        // sign extension of B. The high halves use these carries one per beat.
        self.sign_of_b.d.next = self.b.q.val().get_bit(WORD_SIGN);
        if self.beat.val().get_bit(BEAT_WRITE_A_LOW)
            | self.beat.val().get_bit(BEAT_WRITE_V_LOW)
            | self.beat.val().get_bit(BEAT_WRITE_P_LOW)
            | self.beat.val().get_bit(BEAT_LOAD_A_HIGH)
            | self.beat.val().get_bit(BEAT_LOAD_V_HIGH)
        {
            self.carry_0.d.next = self.top.q.val() ^ self.sign_of_b.q.val();
            self.carry_1.d.next = self.carry_0.q.val();
            self.carry_2.d.next = self.carry_1.q.val();
        }

        // The flags: the end of the segment, and the range and sign of V.
        if self.beat.val().get_bit(BEAT_WRITE_TICKS) {
            self.over.d.next = self.top.q.val();
        }
        self.sign_of_a.d.next = self.a.q.val().get_bit(WORD_SIGN);
        if self.beat.val().get_bit(BEAT_WRITE_V_HIGH) {
            self.unfit.d.next =
                self.r.q.val().get_bit(WORD_SIGN) ^ self.top.q.val() ^ self.sign_of_a.q.val();
            self.other.d.next =
                self.r.q.val().get_bit(WORD_SIGN) ^ self.b.q.val().get_bit(WORD_SIGN);
        }
        self.empty.next = !(self.b.q.val() & !self.sign.val()).any();
        if self.beat.val().get_bit(BEAT_SUM_P_LOW) {
            self.low_zero.d.next = self.empty.val() & !self.b.q.val().get_bit(WORD_SIGN);
        }
        if self.beat.val().get_bit(BEAT_SUM_P_HIGH) {
            self.minus.d.next = self.b.q.val().get_bit(WORD_SIGN);
            self.zero.d.next =
                self.low_zero.q.val() & self.empty.val() & !self.b.q.val().get_bit(WORD_SIGN);
            self.bound.d.next =
                self.low_zero.q.val() & self.empty.val() & self.b.q.val().get_bit(WORD_SIGN);
        }

        // The phase: a part of V that does not carry sets its bit.
        if self.beat.val().get_bit(BEAT_BISECT_1) {
            self.crossed.d.next = false;
        }
        if self.bisects.q.val() {
            self.crossed.d.next = self.crosses_now.val();
        }
        if self.bisects.q.val() | self.beat.val().get_bit(BEAT_PHASE) {
            self.bits.d.next = self.bits.q.val() << self.by_one.val();
            if !self.crosses_now.val() {
                self.bits.d.next = (self.bits.q.val() << self.by_one.val()) | self.q_bit.val();
            }
        }

        self.sum.next = self.r.q.val();
        self.ended.next = self.over.q.val();
        self.overflow.next = self.unfit.q.val();
        self.turned.next = self.other.q.val();
        self.crosses.next = self.top.q.val();
        self.back.next = self.minus.q.val();
        self.still.next = self.zero.q.val();
        self.least.next = self.bound.q.val();
        self.q.next = self.bits.q.val();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::assert_synthesizes;

    #[test]
    fn adder_synthesizes() {
        assert_synthesizes(Adder::default(), "carrystep_adder");
    }
}
