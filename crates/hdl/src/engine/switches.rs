//! Samples and debounces the switches: limits, probe, interlock and general inputs. Reports when an
//! axis has reached a limit.
//!
//! ```text
//! word     state | count, 7 bits                      address   axis 3 | row 2
//! row      0 limit_min     1 limit_max     2 inputs_0     3 inputs_1
//! tick     |   0   |   1   |   2   |   3   |   4   | ...     of a round
//! samples  | row 0 | row 1 | row 2 | row 3 | none            one switch in each time slot
//! ```
//!
//! A memory holds one word per switch: `state` is the debounced state, and `count` is the number of
//! consecutive samples that differ from it. The state changes after as many different samples in
//! sequence as the build specifies (1 to 127). Each switch is sampled once per round of ticks, in
//! the tick of its row and in the time slot of its axis.
//!
//! The pin of the slot's axis is selected first and then passes two flip-flops. These synchronize
//! it, and it has the whole slot to settle.
//!
//! Cost: one synchronizer and one debouncer for all switches, and a memory of 32 words of 8 bits.

use super::layout::{ROW_IS_ODD, ROW_OF_INPUTS, SLOT_OF_FIRST, SWITCH_COUNT, SWITCH_STATE};
use crate::parameters::{
    DEBOUNCE_SAMPLES, INPUTS_0, INPUTS_0_LOW, INPUTS_1, INPUTS_1_LOW, LIMITS, LIMITS_LOW,
    ROUND_TICKS,
};
use crate::primitives::compiled_once;
use crate::primitives::constant::{Literal, Parameter, ParameterRefusal};
use crate::primitives::formula::{Formula, Given};
use crate::primitives::memory::Memory;
use crate::primitives::register::{Input, Register};
use crate::primitives::word::{Word, bit_cast};
use carrystep_core::engine::{Guard, LimitWiring as Wiring, MAX_DEBOUNCE_SAMPLES};
use rust_hdl_core::prelude::*;

/// The debouncer of all switches, and the decision whether a limit is found.
#[derive(LogicBlock, Default)]
pub struct Switches<const N: usize> {
    /// The clock.
    pub clock: Input<Clock>,
    /// Asserted in the last beat of a time slot.
    pub time_slot_ends: Input<Bit>,
    /// The axis of the slot, as a number.
    pub axis: Input<Word<3>>,
    /// The axis of the next clock, as a number.
    pub axis_next: Input<Word<3>>,
    /// The axis of the slot, one-hot.
    pub axis_one_hot: Input<Word<N>>,
    /// The number of the tick in its round, modulo 4.
    pub row: Input<Word<2>>,
    /// The tick is one of the first four of a round.
    pub begins_round: Input<Bit>,
    /// The pins at the low ends. With one switch per axis, the pin of that switch; with one for all
    /// axes, bit 0. Asynchronous.
    pub limit_min: Input<Word<N>>,
    /// The pins at the high ends; asynchronous.
    pub limit_max: Input<Word<N>>,
    /// The pins of row 2; asynchronous.
    pub inputs_0: Input<Word<N>>,
    /// The pins of row 3; asynchronous.
    pub inputs_1: Input<Word<N>>,
    /// The axis moves in this tick, with V != 0.
    pub goes: Input<Bit>,
    /// V < 0 in this tick.
    pub back: Input<Bit>,
    /// A reset: all switches become inactive, as at configuration.
    pub resetting: Input<Bit>,
    /// In this tick a switch is sampled in each time slot.
    pub samples: Signal<Out, Bit>,
    /// From beat 2: the level of the switch's pin two clocks ago.
    pub level: Signal<Out, Bit>,
    /// From beat 1: the debounced state of the switch before this sample.
    pub earlier: Signal<Out, Bit>,
    /// In the last beat: the debounced state after this sample.
    pub state: Signal<Out, Bit>,
    /// In the last beat: the switch is a limit, and the axis has reached it.
    pub found: Signal<Out, Bit>,
    /// The debounced state of the interlock: it is open.
    pub interlock: Signal<Out, Bit>,
    switch_memory: Memory<5, 8>,
    is_row: Signal<Local, Bit>,
    sampled: Signal<Local, Bit>, // `samples`
    inputs: Signal<Local, Bit>,  // the row is 2 or 3
    pins: Signal<Local, Word<N>>,
    chosen: Signal<Local, Word<N>>,
    sync: Register<Bit>, // first flip-flop of the synchronizer
    now: Register<Bit>,  // the synchronized pin
    open: Register<Bit>, // `interlock`
    row_written: Signal<Local, Word<2>>,
    word: Signal<Local, Word<8>>,
    differs: Signal<Local, Bit>,
    flips: Signal<Local, Bit>,
    state_now: Signal<Local, Bit>,
    count: Signal<Local, Word<7>>,
    next_word: Signal<Local, Word<8>>,
    rows: Parameter<4>,
    pair: Parameter<1>,
    one_for_all: Parameter<1>,
    has_inputs: Parameter<1>,
    has_row_3: Parameter<1>,
    has_interlock: Parameter<1>,
    levels: Parameter<N>,
    exist_0: Parameter<N>,
    exist_1: Parameter<N>,
    low_0: Parameter<N>,
    low_1: Parameter<N>,
    last_sample: Parameter<7>,
    first_one_hot: Literal<N, 1>,
    first_row: Literal<4, 1>,
    one: Literal<7, 1>,
    none: Literal<7, 0>,
    active: Literal<8, { 1 << SWITCH_STATE }>,
    no: Literal<8, 0>,
    all: Literal<8, 0xff>,
    to_inputs: Literal<2, { 1 << ROW_OF_INPUTS }>,
    limits_only: Literal<2, { 1 << ROW_IS_ODD }>,
    by_two: Literal<2, 2>,
    limits_out_of_range: ParameterRefusal,
    limits_low_out_of_range: ParameterRefusal,
    debounce_samples_out_of_range: ParameterRefusal,
    inputs_0_out_of_range: ParameterRefusal,
    inputs_1_out_of_range: ParameterRefusal,
    inputs_0_low_out_of_range: ParameterRefusal,
    inputs_1_low_out_of_range: ParameterRefusal,
    round_ticks_too_few_for_inputs: ParameterRefusal,
}

impl<const N: usize> Switches<N> {
    /// Makes the switches of this guard. The caller has checked the guard.
    pub fn new(guard: &Guard) -> Self {
        let mut switches = Self::default();
        switches.set(guard);
        switches
    }

    /// Replaces the parameters, for the same reason as `Engine::set`.
    fn set(&mut self, guard: &Guard) {
        let all = Formula::<N>::number((1 << N) - 1);
        let given = GivenSwitches::of(guard, (1 << N) - 1);
        let [first, second] = &given.inputs;
        self.rows = Parameter::of(&given.sampled);
        self.pair = Parameter::of(&given.is_pair);
        self.one_for_all = Parameter::of(&given.is_one);
        self.has_inputs = Parameter::of(&given.has_inputs);
        self.has_row_3 = Parameter::of(&second.has_row);
        self.has_interlock = Parameter::of(&second.exist.bits(0));
        self.levels = Parameter::of(&all.where_or(&given.limits_low, Formula::number(0)));
        self.exist_0 = Parameter::of(&first.exist.bits(0));
        self.exist_1 = Parameter::of(&second.exist.bits(0));
        self.low_0 = Parameter::of(&first.low.bits(0));
        self.low_1 = Parameter::of(&second.low.bits(0));
        self.last_sample = Parameter::of(&given.last_sample);
        let [limits, limits_low, samples, round] = given.refusals;
        self.limits_out_of_range = limits;
        self.limits_low_out_of_range = limits_low;
        self.debounce_samples_out_of_range = samples;
        let [[inputs_0, inputs_0_low], [inputs_1, inputs_1_low]] =
            given.inputs.map(|row| row.refusals);
        self.inputs_0_out_of_range = inputs_0;
        self.inputs_1_out_of_range = inputs_1;
        self.inputs_0_low_out_of_range = inputs_0_low;
        self.inputs_1_low_out_of_range = inputs_1_low;
        self.round_ticks_too_few_for_inputs = round;
    }
}

/// What the parameters say of the switches. It does not depend on N, so that it is compiled once.
struct GivenSwitches {
    /// The rows that are sampled.
    sampled: Formula<4>,
    is_pair: Formula<1>,
    is_one: Formula<1>,
    has_inputs: Formula<1>,
    limits_low: Formula<1>,
    last_sample: Formula<7>,
    inputs: [GivenRow; 2],
    /// Of the limits, their level, the samples of the debouncing, and the round.
    refusals: [ParameterRefusal; 4],
}

/// What the parameters say of a row of inputs.
struct GivenRow {
    exist: Given<32>,
    low: Given<32>,
    has_row: Formula<1>,
    /// Of the inputs that exist, and of those that are active low.
    refusals: [ParameterRefusal; 2],
}

impl GivenSwitches {
    /// `all` has a 1 for each axis.
    fn of(guard: &Guard, all: u64) -> Self {
        let number = |wiring| match wiring {
            Wiring::None => 0_u32,
            Wiring::Pair => 1,
            Wiring::Each => 2,
            Wiring::One => 3,
        };
        let wiring = LIMITS.of::<32>(number(guard.limits));
        let is = |one| wiring.whole().is(&Formula::number(number(one).into()));
        let has_limits = wiring.whole().is_not(&Formula::number(number(Wiring::None).into()));
        let (limits_low, samples) =
            (LIMITS_LOW.of::<32>(guard.limits_low), DEBOUNCE_SAMPLES.of::<32>(guard.debounce));
        let [first, second] = guard.inputs;
        let inputs = [
            GivenRow::of(INPUTS_0.of(first.exist), INPUTS_0_LOW.of(first.low), all),
            GivenRow::of(INPUTS_1.of(second.exist), INPUTS_1_LOW.of(second.low), all),
        ];
        let [first, second] = &inputs;
        let has_inputs = first.has_row.clone() | second.has_row.clone();
        let rows = [has_limits, is(Wiring::Pair), first.has_row.clone(), second.has_row.clone()];
        let sampled = (0..).zip(rows).fold(Formula::<4>::number(0), |rows, (row, exists)| {
            rows | Formula::number(1 << row).where_or(&exists, Formula::number(0))
        });
        let round = ROUND_TICKS.of::<32>(guard.round);
        let refusals = [
            wiring.is_outside(0, 3),
            limits_low.is_outside(0, 1),
            samples.is_outside(1, MAX_DEBOUNCE_SAMPLES.into()),
            round.whole().is_less(&Formula::number(4)) & has_inputs.clone(),
        ];
        Self {
            sampled,
            is_pair: is(Wiring::Pair),
            is_one: is(Wiring::One),
            has_inputs,
            limits_low: limits_low.bits(0),
            last_sample: samples.bits(0) - Formula::number(1),
            inputs,
            refusals: refusals.map(|refused| ParameterRefusal::of(&refused)),
        }
    }
}

impl GivenRow {
    fn of(exist: Given<32>, low: Given<32>, all: u64) -> Self {
        let has_row = exist.whole().is_not(&Formula::number(0));
        let is_no_input = exist.whole().is_more(&Formula::number(all));
        let is_low_alone = (low.whole() & !exist.whole()).is_not(&Formula::number(0));
        let refusals = [ParameterRefusal::of(&is_no_input), ParameterRefusal::of(&is_low_alone)];
        Self { exist, low, has_row, refusals }
    }
}

compiled_once::logic!(Switches<N = 7>);

impl<const N: usize> compiled_once::Kernel for Switches<N> {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, sync, now, open);
        clock!(self, clock, switch_memory);

        // Selects and synchronizes the pin of this time slot.
        self.is_row.next = (self.rows.val() & (self.first_row.val() << self.row.val())).any();
        self.sampled.next = self.begins_round.val() & self.is_row.val();
        self.inputs.next = self.row.val().get_bit(ROW_OF_INPUTS) & self.has_inputs.val().any();
        self.pins.next = self.limit_min.val() ^ self.levels.val();
        if self.row.val().get_bit(ROW_IS_ODD) {
            self.pins.next = self.limit_max.val() ^ self.levels.val();
        }
        if self.inputs.val() {
            self.pins.next = (self.inputs_0.val() ^ self.low_0.val()) & self.exist_0.val();
            if self.row.val().get_bit(ROW_IS_ODD) & self.has_row_3.val().any() {
                self.pins.next = (self.inputs_1.val() ^ self.low_1.val()) & self.exist_1.val();
            }
        }
        self.chosen.next = self.pins.val() & self.axis_one_hot.val();
        if self.one_for_all.val().any() & !self.inputs.val() {
            self.chosen.next = self.pins.val() & self.first_one_hot.val();
        }
        self.sync.d.next = self.chosen.val().any();
        self.now.d.next = self.sync.q.val();

        // The debounced state and its count. The two ticks of a reset have the rows 0 and 1; they
        // write the words of the rows 2 and 3 before the last beat.
        self.row_written.next = self.row.val() & self.limits_only.val();
        if self.inputs.val()
            | (self.resetting.val() & self.has_inputs.val().any() & !self.time_slot_ends.val())
        {
            self.row_written.next = self.row.val() | self.to_inputs.val();
        }
        self.switch_memory.read_address.next = (bit_cast::<5, 3>(self.axis_next.val())
            << self.by_two.val())
            | bit_cast::<5, 2>(self.row.val());
        self.switch_memory.write_address.next = (bit_cast::<5, 3>(self.axis.val())
            << self.by_two.val())
            | bit_cast::<5, 2>(self.row_written.val());
        self.word.next = self.switch_memory.read_data.val();
        self.differs.next = self.now.q.val() ^ self.word.val().get_bit(SWITCH_STATE);
        self.flips.next = self.differs.val()
            & (self.word.val().get_bits::<7>(SWITCH_COUNT) == self.last_sample.val());
        self.state_now.next =
            (self.word.val().get_bit(SWITCH_STATE) ^ self.flips.val()) & !self.resetting.val();
        self.count.next = self.none.val();
        if self.differs.val() & !self.flips.val() & !self.resetting.val() {
            self.count.next = self.word.val().get_bits::<7>(SWITCH_COUNT) + self.one.val();
        }
        self.next_word.next = bit_cast::<8, 7>(self.count.val());
        if self.state_now.val() {
            self.next_word.next = bit_cast::<8, 7>(self.count.val()) | self.active.val();
        }
        self.switch_memory.write_data.next = self.next_word.val();
        self.switch_memory.write_bits.next = self.no.val();
        if (self.sampled.val() & self.time_slot_ends.val())
            | (self.resetting.val() & self.has_inputs.val().any())
        {
            self.switch_memory.write_bits.next = self.all.val();
        }

        // A switch of a pair stops the axis in one direction, as long as it is active. A single
        // switch stops the axis only when it becomes active, so that the axis can leave it in
        // either direction.
        self.found.next = self.sampled.val()
            & self.time_slot_ends.val()
            & self.goes.val()
            & self.state_now.val()
            & !self.inputs.val()
            & ((self.pair.val().any() & (self.back.val() ^ self.row.val().get_bit(ROW_IS_ODD)))
                | (!self.pair.val().any() & self.flips.val()));

        if self.sampled.val()
            & self.time_slot_ends.val()
            & self.inputs.val()
            & self.row.val().get_bit(ROW_IS_ODD)
            & self.axis_one_hot.val().get_bit(SLOT_OF_FIRST)
            & self.has_interlock.val().any()
        {
            self.open.d.next = self.state_now.val();
        }
        if self.resetting.val() {
            self.open.d.next = false;
        }

        self.samples.next = self.sampled.val();
        self.level.next = self.now.q.val();
        self.earlier.next = self.word.val().get_bit(SWITCH_STATE);
        self.state.next = self.state_now.val();
        self.interlock.next = self.open.q.val();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::assert_synthesizes;
    use carrystep_core::engine::InputRow;

    #[test]
    fn switches_synthesizes() {
        let inputs = [InputRow { exist: 1, low: 0 }, InputRow { exist: 3, low: 1 }];
        let guard = Guard::minimal(Vec::new());
        let guard = Guard { limits: Wiring::Pair, debounce: 10, round: 4, inputs, ..guard };
        assert_synthesizes(Switches::<6>::new(&guard), "carrystep_switches");
    }
}
