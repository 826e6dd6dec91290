//! Makes the engine of a build, whose number of axes is known only at run time, and simulates it.

use super::Engine;
use super::latch_bank::MORE;
use super::store::Store;
use super::wide::WideEngine;
use crate::HdlError;
use crate::primitives::word::Word;
use crate::sim::{mask, rising_edge, settle};
use carrystep_core::EngineBuild;
use carrystep_core::engine::{
    Adders, CAUSES, EngineError, EngineInputs, EngineOutputs, MAX_LATCHES, Put, STATUS_BITS,
    SWITCH_LEVEL, SWITCH_STATE, SeekSource, StateItem, StatePage, StateWord, StateWords,
};
use rust_hdl_core::prelude::{Block, Out, Signal, check_all};

/// An engine whose number of axes is not part of its type.
pub trait AnyEngine: Block {
    /// Applies the inputs and returns the outputs of the present cycle.
    fn settle(&mut self, inputs: &EngineInputs) -> EngineOutputs;
    /// Advances to the next cycle. The inputs are those of the last call of `settle`.
    fn clock(&mut self);
    /// Reads an item of an axis directly from the simulated memory.
    fn kept(&self, axis: usize, item: usize) -> u32;
}

/// Makes the engine of this build, with the number of axes of the build.
///
/// # Errors
/// Returns [`HdlError::Engine`] if a parameter of the build is out of range, and
/// [`HdlError::PinTiming`] if the pin timing of an axis is out of range.
pub fn engine(build: &EngineBuild) -> Result<Box<dyn AnyEngine>, HdlError> {
    build.check()?;
    if build.adders > 1 {
        return wide_engine(build);
    }
    Ok(match build.axes() {
        1 => Box::new(Engine::<1>::new(build)?),
        2 => Box::new(Engine::<2>::new(build)?),
        3 => Box::new(Engine::<3>::new(build)?),
        4 => Box::new(Engine::<4>::new(build)?),
        5 => Box::new(Engine::<5>::new(build)?),
        6 => Box::new(Engine::<6>::new(build)?),
        7 => Box::new(Engine::<7>::new(build)?),
        8 => Box::new(Engine::<8>::new(build)?),
        axes => return Err(EngineError::Axes(axes).into()),
    })
}

/// As [`engine`], for several adders; the build has been checked.
fn wide_engine(build: &EngineBuild) -> Result<Box<dyn AnyEngine>, HdlError> {
    Ok(match (build.axes(), build.adders) {
        (2, 2) => WideEngine::<2, 2>::new(build)?,
        (3, 3) => WideEngine::<3, 3>::new(build)?,
        (4, 2) => WideEngine::<4, 2>::new(build)?,
        (4, 4) => WideEngine::<4, 4>::new(build)?,
        (5, 5) => WideEngine::<5, 5>::new(build)?,
        (6, 2) => WideEngine::<6, 2>::new(build)?,
        (6, 6) => WideEngine::<6, 6>::new(build)?,
        (7, 7) => WideEngine::<7, 7>::new(build)?,
        (8, 2) => WideEngine::<8, 2>::new(build)?,
        (8, 8) => WideEngine::<8, 8>::new(build)?,
        (axes, adders) => return Err(EngineError::Adders(Adders { adders, axes }).into()),
    })
}

/// Implements [`AnyEngine`] for a type of engine, which has a method for its words of state and one
/// for the memory of an axis.
macro_rules! any_engine {
    ([$($generics:tt)*] $type:ty) => {
        impl<$($generics)*> AnyEngine for $type {
            fn settle(&mut self, inputs: &EngineInputs) -> EngineOutputs {
                self.clock.next = false.into();
                let put = inputs.put.unwrap_or(Put { axis: inputs.room_of, word: 0, data: 0 });
                self.put_valid.next = inputs.put.is_some();
                self.put_axis.next = Word::from(u64::from(put.axis));
                self.put_word.next = Word::from(u64::from(put.word));
                self.put_data.next = Word::from(u64::from(put.data));
                self.start_valid.next = inputs.start.is_some();
                self.start_mask.next = Word::from(u64::from(inputs.start.unwrap_or(0)));
                self.cut.next = inputs.cut;
                self.clear.next = inputs.clear;
                self.reset.next = inputs.reset;
                self.stop.next = inputs.stop;
                self.broken.next = inputs.broken;
                self.seek_source_valid.next = inputs.seek_source.is_some();
                self.seek_source.next =
                    Word::from(u64::from(inputs.seek_source.map_or(0, SeekSource::byte)));
                self.seek_valid.next = inputs.seek.is_some();
                self.seek_mask.next = Word::from(u64::from(inputs.seek.unwrap_or(0)));
                self.latch_arm.next = inputs.latch_arm & 1 == 1;
                self.snapshot.next = inputs.snapshot;
                self.kick.next = inputs.kick;
                self.enable.next = inputs.enable;
                self.estop.next = inputs.estop;
                self.limit_min.next = Word::from(u64::from(inputs.limit_min));
                self.limit_max.next = Word::from(u64::from(inputs.limit_max));
                self.inputs_0.next = Word::from(u64::from(inputs.inputs[0]));
                self.inputs_1.next = Word::from(u64::from(inputs.inputs[1]));
                self.latch.next = inputs.latch & 1 == 1;
                self.settle_latches(inputs);
                settle(self);
                let cause = CAUSES[self.cause.val().value() as usize];
                EngineOutputs {
                    put_ready: self.put_ready.val(),
                    start_ready: self.start_ready.val(),
                    cut_busy: self.cut_busy.val(),
                    cut_refused: self.cut_refused.val(),
                    step: mask(&*self.step),
                    dir: mask(&*self.dir),
                    outputs: self.outputs.val().value() as u8,
                    pwm: self.pwm.val(),
                    enabled: self.enabled.val(),
                    idle: self.idle.val(),
                    fault: self.fault.val().then(|| (cause, self.culprits.val().value() as u8)),
                    halted: self.halted.val(),
                    resetting: self.resetting.val(),
                    armed: self.armed.val(),
                    ready: self.ready.val(),
                    seeking: self.seeking.val().value() as u8,
                    hits: self.hits.val().value() as u8,
                    latch_armed: self.latches_armed(),
                    latch_edges: self.latches_edges(),
                    latch_records: std::array::from_fn(|latch| self.records() >> (2 * latch) as u8 & 3),
                    state: self.words_of_state(),
                    refreshed: self.refreshed.val(),
                    room: self.room_valid.val().then(|| self.room.val().value() as u8),
                    started: self.started.val(),
                }
            }

            fn clock(&mut self) {
                self.clock.next = true.into();
                rising_edge(self);
            }

            fn kept(&self, axis: usize, item: usize) -> u32 {
                self.store_of(axis).segments.word(axis << 6 | item << 3 | 7).value() as u32
            }
        }
    };
}

any_engine!([const N: usize] Engine<N>);
any_engine!([const N: usize, const K: usize] WideEngine<N, K>);

impl<const N: usize> Engine<N> {
    /// The latches that wait for their edges.
    fn latches_armed(&self) -> u8 {
        let more = |port: &Signal<Out, Word<MORE>>| (port.val().value() as u8) << 1;
        u8::from(self.latch_armed.val()) | self.more_latch_armed.iter().map(more).sum::<u8>()
    }

    /// The edges that each latch has counted.
    fn latches_edges(&self) -> [u8; MAX_LATCHES] {
        let more = |port: &Signal<Out, Word<12>>| port.val().value() as u16;
        let all = self.more_latch_edges.iter().map(more).sum::<u16>() << 4
            | self.latch_edges.val().value() as u16;
        std::array::from_fn(|latch| (all >> (4 * latch) & 15) as u8)
    }

    /// The records of all latches, two bits each.
    fn records(&self) -> u8 {
        self.latch_records.iter().map(|port| port.val().value() as u8).sum()
    }

    /// Applies the pins of further latches, and which of them the host arms.
    fn settle_latches(&mut self, inputs: &EngineInputs) {
        let (pins, arm) = (inputs.latch >> 1 & 7, inputs.latch_arm >> 1 & 7);
        self.more_latches.iter_mut().for_each(|port| port.next = Word::from(u64::from(pins)));
        self.more_latch_arm.iter_mut().for_each(|port| port.next = Word::from(u64::from(arm)));
    }

    const fn store_of(&self, _: usize) -> &Store {
        &self.store
    }

    fn words_of_state(&self) -> StateWords {
        let record = self.state_record.iter().map(|port| port.val().value() as u8).sum();
        StateWords::of(|adder| {
            (adder == 0 && self.state_valid.val()).then(|| {
                word_of_state(
                    record,
                    self.state_page.val(),
                    self.state_axis.val(),
                    self.state_item.val(),
                    self.state.val(),
                )
            })
        })
    }
}

impl<const N: usize, const K: usize> WideEngine<N, K> {
    /// There is at most one latch.
    const fn settle_latches(&mut self, _: &EngineInputs) {}

    fn latches_armed(&self) -> u8 {
        self.latch_armed.val().into()
    }

    fn latches_edges(&self) -> [u8; MAX_LATCHES] {
        let first = self.latch_edges.val().value() as u8;
        std::array::from_fn(|latch| if latch == 0 { first } else { 0 })
    }

    const fn records(&self) -> u8 {
        0
    }

    fn store_of(&self, axis: usize) -> &Store {
        &self.store[axis % K]
    }

    fn words_of_state(&self) -> StateWords {
        StateWords::of(|adder| {
            (adder < K && self.state_valid[adder].val()).then(|| {
                word_of_state(
                    0,
                    self.state_page[adder].val(),
                    self.state_axis[adder].val(),
                    self.state_item[adder].val(),
                    self.state[adder].val(),
                )
            })
        })
    }
}

/// The word of state at these ports. Bits without a meaning are 0.
fn word_of_state(
    record: u8,
    page: Word<2>,
    axis: Word<3>,
    item: Word<3>,
    word: Word<32>,
) -> StateWord {
    let page = StatePage::of_number(page.value() as u8);
    let item = match item.value() {
        0 => StateItem::Discarded,
        1 => StateItem::Left,
        2 => StateItem::Switch,
        3 => StateItem::Ticks,
        4 => StateItem::PLow,
        5 => StateItem::PHigh,
        6 => StateItem::Position,
        _ => StateItem::Status,
    };
    let bits = match item {
        StateItem::Status => (1 << STATUS_BITS) - 1,
        StateItem::Switch => SWITCH_STATE | SWITCH_LEVEL,
        _ => u32::MAX,
    };
    StateWord { page, record, axis: axis.value() as u8, item, word: word.value() as u32 & bits }
}

/// A simulated engine.
pub struct EngineSim {
    core: Box<dyn AnyEngine>,
}

impl EngineSim {
    /// Makes the engine of this build, in cycle 0.
    ///
    /// # Errors
    /// Returns an [`HdlError`] if the build is invalid or Rust-HDL's checks reject the module.
    pub fn new(build: &EngineBuild) -> Result<Self, HdlError> {
        let mut core = engine(build)?;
        core.connect_all();
        check_all(core.as_ref()).map_err(|error| HdlError::Check(format!("{error:?}")))?;
        Ok(Self { core })
    }

    /// Applies the inputs and returns the outputs of the present cycle. Inputs that are not offered
    /// are driven as zero.
    pub fn settle(&mut self, inputs: &EngineInputs) -> EngineOutputs {
        self.core.settle(inputs)
    }

    /// Advances to the next cycle. The inputs are those of the last call of `settle`.
    pub fn clock(&mut self) {
        self.core.clock();
    }

    /// Reads a word of the state of an axis directly from the simulated memory; `item` is its slot:
    /// 0 and 1 P (low and high half), 2 position, 3 discarded steps.
    pub fn kept(&self, axis: usize, item: usize) -> u32 {
        self.core.kept(axis, item)
    }
}
