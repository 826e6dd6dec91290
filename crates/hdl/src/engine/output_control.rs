//! The outputs that change with the motion: each commit of axis 0 may name outputs and give their
//! levels, and give the duty of the PWM. They change where its segment begins.
//!
//! ```text
//! tick        |      m      |    m + 1    |    m + 2    |     the segment begins with tick m
//! beat 12     _____/^\___________/^\___________/^\______      of axis 0
//! begun       _______/^^^^^^^^^^^^^\_____________________
//! beat 0      _/^\___________/^\___________/^\___________     of axis 0: the first clock of a tick
//! due         _________________/^^^^^^^^^^^^^\___________
//! word        _________________< its commit  >___________     as the memories return it
//! strobe      ____________/^\___________/^\______________     the duty changes at the end of m + 1
//! pins        _________________________________/^^^^^^^^^     with the latency of a step
//! ```
//!
//! A commit is stored in the slot of its segment. It is read in the first clock of the tick after
//! the one with which the segment begins, and the memories keep it until the next read. So no other
//! register delays it.
//!
//! Interface: `off` turns all outputs off; [`super::pwm`] makes the PWM of the duty. A commit with
//! a bit for something that the build does not have, or with any bit but the lowest for another
//! axis than the first, is a fault of the host (`stray`).
//!
//! Cost: a memory of one block RAM for the outputs and one for the duties, a flip-flop for each
//! output, some ten for the slot and the order of events, and some ten cells for the fault. A build
//! without outputs and without PWM has none of them.

use super::layout::{
    BEAT_FIRST, BEAT_LAST, COMMIT_DUTY, COMMIT_MASK, COMMIT_SETS_DUTY, DUTY_STEPS, DUTY_VALID,
    OUTPUT_LEVELS, OUTPUT_MASK,
};
use crate::parameters::{OUTPUTS, PWM_DIVIDER};
use crate::primitives::constant::{Literal, Parameter, ParameterRefusal};
use crate::primitives::formula::Formula;
use crate::primitives::held_memory::HeldMemory;
use crate::primitives::register::{Input, Register};
use crate::primitives::word::{Word, bit_cast};
use carrystep_core::engine::Outputs;
use rust_hdl_core::prelude::*;

/// The outputs, and the duties for the PWM.
#[derive(LogicBlock, Default)]
pub struct OutputControl {
    /// The clock.
    pub clock: Input<Clock>,
    /// The beats of [`super::time_slot`]: bit i is asserted in beat i of a time slot.
    pub beat: Input<Word<17>>,
    /// The time slot is that of axis 0.
    pub first: Input<Bit>,
    /// The engine accepts a word of the host in this clock, for the axis of the time slot.
    pub take: Input<Bit>,
    /// The number of that word.
    pub put_word: Input<Word<4>>,
    /// That word.
    pub put_data: Input<Word<32>>,
    /// The slot that the host writes.
    pub fresh: Input<Word<5>>,
    /// The slot of the running segment.
    pub live: Input<Word<5>>,
    /// The axis starts in this tick.
    pub starts: Input<Bit>,
    /// In beat 12: the next segment of the axis begins with the next tick.
    pub follows: Input<Bit>,
    /// All outputs are off from the next clock on.
    pub off: Input<Bit>,
    /// The pins; 1 is active.
    pub pins: Signal<Out, Word<8>>,
    /// At a strobe: the duty of the PWM changes.
    pub sets_duty: Signal<Out, Bit>,
    /// The new duty, valid with `sets_duty`.
    pub duty: Signal<Out, Word<12>>,
    /// Fault: the commit accepted in the clock before had bits that it must not have.
    pub stray: Signal<Out, Bit>,
    output_words: HeldMemory<5, 16>,
    duty_words: HeldMemory<5, 13>,
    levels: Register<Word<8>>,   // `pins`
    place: Register<Word<5>>,    // the slot of the segment that axis 0 ran last
    follower: Register<Bit>,     // it begins with this tick, after another segment
    begun: Register<Bit>,        // it has begun with this tick
    due: Register<Bit>,          // the word in the memories' output is to be applied
    wrong: Register<Bit>,        // `stray`
    applies: Signal<Local, Bit>, // the first clock of a tick
    commits: Signal<Local, Bit>,
    stores: Signal<Local, Bit>,
    never: Signal<Local, Word<32>>,
    of_others: Signal<Local, Word<32>>,
    mask: Signal<Local, Word<8>>,
    new_levels: Signal<Local, Word<8>>,
    sets_bit: Signal<Local, Word<13>>,
    exist: Parameter<8>,
    has_pwm: Parameter<1>,
    lacks: Parameter<32>, // the bits that no commit may have
    has: Parameter<32>,   // the bits that only a commit of axis 0 may have
    commit: Literal<4, 7>,
    duty_valid: Literal<13, { 1 << DUTY_VALID }>,
    no_duty: Literal<13, 0>,
    no_levels: Literal<8, 0>,
    outputs_out_of_range: ParameterRefusal,
}

impl OutputControl {
    /// Makes the outputs of this build, whose axes have this number of slots. The caller has
    /// checked it.
    pub fn new(build: &Outputs, slots: usize) -> Self {
        let exist = OUTPUTS.of::<32>(build.exist);
        let divider = PWM_DIVIDER.of::<32>(build.pwm_divider);
        let has_pwm = divider.whole().is_not(&Formula::number(0));
        let number = Formula::<32>::number;
        let pwm_bits = number(0xfff0_0002).where_or(&has_pwm, number(0));
        let has = (exist.whole() * number(0x1010)) | pwm_bits;
        let is_any = exist.whole().is_not(&number(0)) | has_pwm.clone();
        let lacks = (!(has.clone() | number(1))).where_or(&is_any, number(0));
        Self {
            output_words: HeldMemory::of_few(slots.ilog2() as usize),
            duty_words: HeldMemory::of_few(slots.ilog2() as usize),
            exist: Parameter::of(&exist.bits(0)),
            has_pwm: Parameter::of(&has_pwm),
            lacks: Parameter::of(&lacks),
            has: Parameter::of(&has),
            outputs_out_of_range: ParameterRefusal::of(&exist.is_outside(0, 0xff)),
            ..Self::default()
        }
    }
}

impl Logic for OutputControl {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, levels, place, follower, begun, due, wrong);
        clock!(self, clock, output_words, duty_words);

        // Stores the commit of axis 0, and examines every commit.
        self.commits.next = self.take.val() & (self.put_word.val() == self.commit.val());
        self.stores.next = self.commits.val() & self.first.val();
        self.output_words.write.next = self.stores.val();
        self.output_words.write_address.next = self.fresh.val();
        self.output_words.write_data.next = self.put_data.val().get_bits::<16>(COMMIT_MASK);
        self.sets_bit.next = self.no_duty.val();
        if self.put_data.val().get_bit(COMMIT_SETS_DUTY) {
            self.sets_bit.next = self.duty_valid.val();
        }
        self.duty_words.write.next = self.stores.val();
        self.duty_words.write_address.next = self.fresh.val();
        self.duty_words.write_data.next =
            bit_cast::<13, 12>(self.put_data.val().get_bits::<12>(COMMIT_DUTY))
                | self.sets_bit.val();
        self.never.next = self.put_data.val() & self.lacks.val();
        self.of_others.next = self.put_data.val() & self.has.val();
        self.wrong.d.next = self.commits.val()
            & (self.never.val().any() | (!self.first.val() & self.of_others.val().any()));

        // Which segment begins with which tick.
        if self.first.val() & self.beat.val().get_bit(BEAT_LAST) {
            self.place.d.next = self.live.val();
            self.begun.d.next = self.starts.val() | self.follower.q.val();
            self.follower.d.next = self.follows.val();
        }
        self.applies.next = self.first.val() & self.beat.val().get_bit(BEAT_FIRST);
        self.output_words.read.next = self.applies.val();
        self.output_words.read_address.next = self.place.q.val();
        self.duty_words.read.next = self.applies.val();
        self.duty_words.read_address.next = self.place.q.val();
        if self.applies.val() {
            self.due.d.next = self.begun.q.val();
        }

        // The pins.
        self.mask.next =
            self.output_words.read_data.val().get_bits::<8>(OUTPUT_MASK) & self.exist.val();
        self.new_levels.next = self.output_words.read_data.val().get_bits::<8>(OUTPUT_LEVELS);
        if self.applies.val() & self.due.q.val() {
            self.levels.d.next = (self.levels.q.val() & !self.mask.val())
                | (self.new_levels.val() & self.mask.val());
        }
        if self.off.val() {
            self.levels.d.next = self.no_levels.val();
        }

        self.pins.next = self.levels.q.val();
        self.sets_duty.next = self.due.q.val()
            & self.duty_words.read_data.val().get_bit(DUTY_VALID)
            & self.has_pwm.val().any();
        self.duty.next = self.duty_words.read_data.val().get_bits::<12>(DUTY_STEPS);
        self.stray.next = self.wrong.q.val();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::assert_synthesizes;

    #[test]
    fn output_control_synthesizes() {
        let build = Outputs { exist: 0x35, pwm_divider: 7, off_at_ramps: true };
        assert_synthesizes(OutputControl::new(&build, 8), "carrystep_output_control");
    }
}
