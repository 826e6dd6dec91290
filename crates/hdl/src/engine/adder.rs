//! The one adder: P + V, V + A, A + J, ticks - 1, positions, and the bisection, a word a beat.
//!
//! ```text
//!   memory --+--> A --.           beat   sum                beat   sum
//!   put -----'        X --.        3     A + J, low          9     A + J, high
//!           .--> R ---'   |        4     A + V, low         10     A + V, high
//!           |             +--> R   5     P + V, low         11     P + V, high: carry, a step
//!           '-------------+        6     ticks - 1          12     bisection: P + V / 2
//!   memory -----> B ------'        7     position           13-15  bisection: +- V / 4, / 8, / 16
//!                 '-> B / 2        8     (a host's word)           of the turn before
//! ```
//!
//! The bisection does not restore: where a part of V crosses, the next half of it is taken back, not
//! added. Its sum then stays in R as its complement (`top` says so), so that the adder only ever adds:
//! X is R, or not R. What halving an odd number loses (`odd`) comes back as a carry.

use crate::primitives::constant::Literal;
use crate::primitives::register::{Input, Register};
use crate::primitives::word::{Word, bit_cast};
use rust_hdl::prelude::*;

/// Operands, sum, and what the sums say.
#[derive(LogicBlock, Default)]
pub struct Adder {
    /// The clock.
    pub clock: Input<Clock>,
    /// The beats of [`super::turn`].
    pub beat: Input<Word<17>>,
    /// What the memory gives.
    pub word: Input<Word<32>>,
    /// What the host puts.
    pub put: Input<Word<32>>,
    /// The axis runs: beat 6 counts its ticks down.
    pub counts: Input<Bit>,
    /// Otherwise it counts a discarded step, if this is set; never both.
    pub lost: Input<Bit>,
    /// Beat 7 counts a step forward.
    pub up: Input<Bit>,
    /// Beat 7 counts a step back.
    pub down: Input<Bit>,
    /// P becomes zero.
    pub wipe: Input<Bit>,
    /// The sum of the beat before.
    pub sum: Signal<Out, Word<32>>,
    /// From beat 8: the segment is over after this tick.
    pub ended: Signal<Out, Bit>,
    /// From beat 12: V + A does not fit.
    pub overflow: Signal<Out, Bit>,
    /// From beat 12: V + A has the other sign than V.
    pub turned: Signal<Out, Bit>,
    /// In beat 12: the tick steps.
    pub crosses: Signal<Out, Bit>,
    /// From beat 12: V < 0.
    pub back: Signal<Out, Bit>,
    /// From beat 12: V = 0.
    pub still: Signal<Out, Bit>,
    /// From beat 12: V = -2^63.
    pub least: Signal<Out, Bit>,
    /// After beat 16: the phase.
    pub q: Signal<Out, Word<4>>,
    a: Register<Word<32>>,
    b: Register<Word<32>>,
    r: Register<Word<32>>,
    top: Register<Bit>,     // bit 32 of the sum of R and a signed B
    carry_0: Register<Bit>, // of the low halves, the last one first
    carry_1: Register<Bit>,
    carry_2: Register<Bit>,
    over: Register<Bit>,      // `ended`
    unfit: Register<Bit>,     // `overflow`
    sign_of_a: Register<Bit>, // a beat ago
    sign_of_b: Register<Bit>, // likewise
    other: Register<Bit>,     // `turned`
    low_zero: Register<Bit>,
    minus: Register<Bit>,   // `back`
    zero: Register<Bit>,    // `still`
    bound: Register<Bit>,   // `least`
    crossed: Register<Bit>, // the bisection's last sum but one was beyond the step
    bisects: Register<Bit>,
    carry_if_top: Register<Bit>, // the carry that comes in where `top` is set,
    carry_if_not: Register<Bit>, // and where it is not: all else is known a beat ahead
    bits: Register<Word<4>>,     // `q`
    x: Signal<Local, Word<32>>,
    half: Signal<Local, Word<32>>,
    ones_in: Signal<Local, Bit>,
    counting: Signal<Local, Bit>,
    load: Signal<Local, Bit>,
    halve: Signal<Local, Bit>,
    halves_on: Signal<Local, Bit>,
    crosses_now: Signal<Local, Bit>,
    carry_due: Signal<Local, Bit>,
    odd: Signal<Local, Bit>, // halving B loses its lowest bit
    odd_beyond: Signal<Local, Bit>,
    carry_in: Signal<Local, Bit>,
    extended: Signal<Local, Word<33>>, // B with its sign once more
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

        // A: from memory, in beat 7 from the host.
        if self.beat.val().get_bit(1)
            | self.beat.val().get_bit(4)
            | self.beat.val().get_bit(5)
            | self.beat.val().get_bit(6)
            | self.beat.val().get_bit(8)
            | self.beat.val().get_bit(10)
        {
            self.a.d.next = self.word.val();
        }
        if self.beat.val().get_bit(7) {
            self.a.d.next = self.put.val();
        }

        // B: from memory; -1 or 0 for counting; its own half.
        self.counting.next = self.beat.val().get_bit(5) | self.beat.val().get_bit(6);
        self.ones_in.next =
            (self.beat.val().get_bit(5) & self.counts.val()) | (self.beat.val().get_bit(6) & !self.up.val());
        self.load.next = self.beat.val().get_bit(2)
            | self.beat.val().get_bit(3)
            | self.beat.val().get_bit(7)
            | self.beat.val().get_bit(9);
        self.halve.next = self.beat.val().get_bit(11)
            | self.beat.val().get_bit(12)
            | self.beat.val().get_bit(13)
            | self.beat.val().get_bit(14);
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
        // The bisection goes on in the next beat.
        self.halves_on.next = self.beat.val().get_bit(12) | self.beat.val().get_bit(13) | self.beat.val().get_bit(14);
        self.bisects.d.next = self.halves_on.val();

        // X: A; in the bisection R, straight or as its complement.
        self.crosses_now.next = self.top.q.val() ^ self.crossed.q.val();
        self.x.next = self.a.q.val();
        if self.bisects.q.val() {
            self.x.next = self.r.q.val();
            if self.top.q.val() {
                self.x.next = !self.r.q.val();
            }
        }

        // The sum; a carry comes in as 1 + 1 below the lowest bit.
        self.carry_due.next = (self.beat.val().get_bit(5) & self.lost.val())
            | (self.beat.val().get_bit(6) & !self.down.val())
            | ((self.beat.val().get_bit(8) | self.beat.val().get_bit(9) | self.beat.val().get_bit(10))
                & self.carry_2.q.val());
        self.odd.next = self.halves_on.val() & self.b.q.val().get_bit(0);
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
        if self.b.q.val().get_bit(31) {
            self.extended.next = bit_cast::<33, 32>(self.b.q.val()) | self.above.val();
        }
        self.wide.next = ((bit_cast::<34, 32>(self.x.val()) << self.by_one.val()) | self.carry.val())
            + ((bit_cast::<34, 33>(self.extended.val()) << self.by_one.val()) | self.low.val());
        self.wiping.next = self.wipe.val() & (self.beat.val().get_bit(5) | self.beat.val().get_bit(11));
        self.r.d.next = self.wide.val().get_bits::<32>(1);
        if self.beat.val().get_bit(8) {
            self.r.d.next = self.x.val();
        }
        if self.wiping.val() {
            self.r.d.next = self.nothing.val();
        }
        self.top.d.next = self.wide.val().get_bit(33);
        // The carries of the low halves, a beat later: the sum's top bit without that of B. Then they come in, one a beat.
        self.sign_of_b.d.next = self.b.q.val().get_bit(31);
        if self.beat.val().get_bit(4)
            | self.beat.val().get_bit(5)
            | self.beat.val().get_bit(6)
            | self.beat.val().get_bit(8)
            | self.beat.val().get_bit(9)
        {
            self.carry_0.d.next = self.top.q.val() ^ self.sign_of_b.q.val();
            self.carry_1.d.next = self.carry_0.q.val();
            self.carry_2.d.next = self.carry_1.q.val();
        }

        // What the sums say: the end of the segment, and V.
        if self.beat.val().get_bit(7) {
            self.over.d.next = self.top.q.val();
        }
        self.sign_of_a.d.next = self.a.q.val().get_bit(31);
        if self.beat.val().get_bit(11) {
            self.unfit.d.next = self.r.q.val().get_bit(31) ^ self.top.q.val() ^ self.sign_of_a.q.val();
            self.other.d.next = self.r.q.val().get_bit(31) ^ self.b.q.val().get_bit(31);
        }
        self.empty.next = !(self.b.q.val() & !self.sign.val()).any();
        if self.beat.val().get_bit(5) {
            self.low_zero.d.next = self.empty.val() & !self.b.q.val().get_bit(31);
        }
        if self.beat.val().get_bit(11) {
            self.minus.d.next = self.b.q.val().get_bit(31);
            self.zero.d.next = self.low_zero.q.val() & self.empty.val() & !self.b.q.val().get_bit(31);
            self.bound.d.next = self.low_zero.q.val() & self.empty.val() & self.b.q.val().get_bit(31);
        }

        // The phase: a bit for each part of V that does not cross.
        if self.beat.val().get_bit(12) {
            self.crossed.d.next = false;
        }
        if self.bisects.q.val() {
            self.crossed.d.next = self.crosses_now.val();
        }
        if self.bisects.q.val() | self.beat.val().get_bit(16) {
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
