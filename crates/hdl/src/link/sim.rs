//! Makes the link of a build, whose number of axes is known only at run time, and simulates it.

use super::Link;
use super::wide::WideLink;
use crate::HdlError;
use crate::line::{LineOutputs, UartSim};
use crate::primitives::word::Word;
use crate::sim::{rising_edge, settle};
use carrystep_core::EngineBuild;
use carrystep_core::engine::{
    Adders, EngineError, EngineInputs, EngineOutputs, Put, STATUS_BITS, SeekSource, StateItem,
    StateWord,
};
use carrystep_core::link::{BuildId, LinkInputs, LinkOutputs, Uart};
use rust_hdl_core::prelude::{Block, Out, Signal, check_all};

/// A link whose number of axes is not part of its type.
pub trait AnyLink: Block {
    /// Applies the inputs and returns the outputs of the present cycle, except those of the line.
    fn settle(&mut self, inputs: &LinkInputs, line: LineOutputs) -> LinkOutputs;
    /// The byte that the link offers to the line, if any.
    fn offered(&self) -> Option<u8>;
    /// Advances to the next cycle. The inputs are those of the last call of `settle`.
    fn clock(&mut self);
}

/// Makes the link of this build, with the number of axes of the build.
///
/// # Errors
/// Returns [`HdlError::Engine`] if a parameter of the build is out of range.
pub fn link(build: &EngineBuild, id: BuildId) -> Result<Box<dyn AnyLink>, HdlError> {
    build.check()?;
    if build.adders > 1 {
        return wide_link(build, id);
    }
    Ok(match build.axes() {
        1 => Box::new(Link::<1>::new(build, id)),
        2 => Box::new(Link::<2>::new(build, id)),
        3 => Box::new(Link::<3>::new(build, id)),
        4 => Box::new(Link::<4>::new(build, id)),
        5 => Box::new(Link::<5>::new(build, id)),
        6 => Box::new(Link::<6>::new(build, id)),
        7 => Box::new(Link::<7>::new(build, id)),
        8 => Box::new(Link::<8>::new(build, id)),
        axes => return Err(EngineError::Axes(axes).into()),
    })
}

/// As [`link`], for several adders; the build has been checked.
fn wide_link(build: &EngineBuild, id: BuildId) -> Result<Box<dyn AnyLink>, HdlError> {
    Ok(match (build.axes(), build.adders) {
        (2, 2) => Box::new(WideLink::<2, 2>::new(build, id)),
        (3, 3) => Box::new(WideLink::<3, 3>::new(build, id)),
        (4, 2) => Box::new(WideLink::<4, 2>::new(build, id)),
        (4, 4) => Box::new(WideLink::<4, 4>::new(build, id)),
        (5, 5) => Box::new(WideLink::<5, 5>::new(build, id)),
        (6, 2) => Box::new(WideLink::<6, 2>::new(build, id)),
        (6, 6) => Box::new(WideLink::<6, 6>::new(build, id)),
        (7, 7) => Box::new(WideLink::<7, 7>::new(build, id)),
        (8, 2) => Box::new(WideLink::<8, 2>::new(build, id)),
        (8, 8) => Box::new(WideLink::<8, 8>::new(build, id)),
        (axes, adders) => return Err(EngineError::Adders(Adders { adders, axes }).into()),
    })
}

/// Implements [`AnyLink`] for a type of link, which has methods for the words of state and for several
/// latches.
macro_rules! any_link {
    ([$($generics:tt)*] $type:ty) => {
        impl<$($generics)*> AnyLink for $type {
            fn settle(&mut self, inputs: &LinkInputs, line: LineOutputs) -> LinkOutputs {
                self.clock.next = false.into();
                self.received.next = Word::from(u64::from(line.received.unwrap_or(0)));
                self.received_valid.next = line.received.is_some();
                self.answer_take.next = line.take;
                let engine = &inputs.engine;
                // Without a fault these two ports keep the values of the last stop. The simulation drives
                // all ones, so that a use of them without a fault shows.
                let (cause, culprits) =
                    engine.fault.map_or((0xf, 0xff), |(cause, culprits)| (cause as u64, culprits));
                self.put_ready.next = engine.put_ready;
                self.room.next = Word::from(u64::from(engine.room.unwrap_or(0)));
                self.room_valid.next = engine.room.is_some();
                self.start_ready.next = engine.start_ready;
                self.settle_words(engine);
                self.refreshed.next = engine.refreshed;
                self.cut_busy.next = engine.cut_busy;
                self.cut_refused.next = engine.cut_refused;
                self.fault.next = engine.fault.is_some();
                self.halted.next = engine.halted;
                self.idle.next = engine.idle;
                self.ready.next = engine.ready;
                self.armed.next = engine.armed;
                self.cause.next = Word::from(cause);
                self.culprits.next = Word::from(u64::from(culprits));
                self.seeking.next = Word::from(u64::from(engine.seeking));
                self.hits.next = Word::from(u64::from(engine.hits));
                self.latch_armed.next = engine.latch_armed & 1 == 1;
                self.latch_edges.next = Word::from(u64::from(engine.latch_edges[0]));
                self.settle_latches(engine);
                settle(self);
                let [axis, word] =
                    [self.put_axis.val().value(), self.put_word.val().value()].map(|place| place as u8);
                let data = self.put_data.val().value() as u32;
                LinkOutputs {
                    tx: true,
                    engine: EngineInputs {
                        put: self.put_valid.val().then_some(Put { axis, word, data }),
                        room_of: axis,
                        start: self.start_valid.val().then(|| self.start_mask.val().value() as u8),
                        cut: self.cut.val(),
                        clear: self.clear.val(),
                        stop: self.stop.val(),
                        broken: self.broken.val(),
                        seek_source: self
                            .seek_source_valid
                            .val()
                            .then(|| SeekSource::of_byte(self.seek_source.val().value() as u8)),
                        seek: self.seek_valid.val().then(|| self.seek_mask.val().value() as u8),
                        latch_arm: self.latches_arm(),
                        snapshot: self.snapshot.val(),
                        kick: self.kick.val(),
                        enable: self.enable.val(),
                        ..EngineInputs::default()
                    },
                }
            }

            fn offered(&self) -> Option<u8> {
                self.answer_valid.val().then(|| self.answer.val().value() as u8)
            }

            fn clock(&mut self) {
                self.clock.next = true.into();
                rising_edge(self);
            }
        }
    };
}

any_link!([const N: usize] Link<N>);
any_link!([const N: usize, const K: usize] WideLink<N, K>);

/// Page, axis, item and word at the ports of a word of state. Bits without a meaning are ones, so
/// that a use of them shows.
fn at_ports(state: Option<StateWord>) -> (Word<2>, Word<3>, Word<3>, Word<32>) {
    let no_meaning = |state: StateWord| match state.item {
        StateItem::Status => state.word | u32::MAX << STATUS_BITS,
        _ => state.word,
    };
    let of_state = |value: fn(StateWord) -> u64| state.map_or(0, value);
    (
        Word::from(of_state(|state| state.page as u64)),
        Word::from(of_state(|state| state.axis.into())),
        Word::from(of_state(|state| state.item as u64)),
        Word::from(u64::from(state.map_or(u32::MAX, no_meaning))),
    )
}

impl<const N: usize> Link<N> {
    /// Applies the word of state that the engine outputs.
    fn settle_words(&mut self, engine: &EngineOutputs) {
        let state = engine.state.of_adder(0);
        self.state_valid.next = state.is_some();
        let (page, axis, item, word) = at_ports(state);
        self.state_page.next = page;
        self.state_axis.next = axis;
        self.state_item.next = item;
        self.state.next = word;
    }

    /// Applies what the engine outputs of several latches.
    fn settle_latches(&mut self, engine: &EngineOutputs) {
        let packed = |numbers: &[u8], bits: usize| {
            numbers.iter().rev().fold(0, |all, number| all << bits | u64::from(*number))
        };
        let (armed, records) =
            (u64::from(engine.latch_armed >> 1), packed(&engine.latch_records, 2));
        let edges = packed(&engine.latch_edges[1..], 4);
        let record = engine.state.of_adder(0).map_or(0, |state| u64::from(state.record));
        self.more_latch_armed.iter_mut().for_each(|port| port.next = Word::from(armed));
        self.more_latch_edges.iter_mut().for_each(|port| port.next = Word::from(edges));
        self.latch_records.iter_mut().for_each(|port| port.next = Word::from(records));
        self.state_record.iter_mut().for_each(|port| port.next = Word::from(record));
    }

    /// The latches that the host arms.
    fn latches_arm(&self) -> u8 {
        let more = |port: &Signal<Out, Word<3>>| (port.val().value() as u8) << 1;
        u8::from(self.latch_arm.val()) | self.more_latch_arm.iter().map(more).sum::<u8>()
    }
}

impl<const N: usize, const K: usize> WideLink<N, K> {
    /// Applies the words of state that the engine outputs.
    fn settle_words(&mut self, engine: &EngineOutputs) {
        for adder in 0..K {
            let state = engine.state.of_adder(adder);
            self.state_valid[adder].next = state.is_some();
            let (page, axis, item, word) = at_ports(state);
            self.state_page[adder].next = page;
            self.state_axis[adder].next = axis;
            self.state_item[adder].next = item;
            self.state[adder].next = word;
        }
    }

    /// Such a link has at most one latch.
    const fn settle_latches(&mut self, _: &EngineOutputs) {}

    fn latches_arm(&self) -> u8 {
        self.latch_arm.val().into()
    }
}

/// A simulated link with a simulated UART.
pub struct LinkSim {
    link: Box<dyn AnyLink>,
    line: UartSim,
    said: LineOutputs,
}

impl LinkSim {
    /// Makes the link and the UART of this build, in cycle 0.
    ///
    /// # Errors
    /// Returns an [`HdlError`] if the build is invalid or Rust-HDL's checks reject a module.
    pub fn new(build: &EngineBuild, uart: Uart) -> Result<Self, HdlError> {
        let mut link = link(build, uart.build_id(build))?;
        link.connect_all();
        check_all(link.as_ref()).map_err(|error| HdlError::Check(format!("{error:?}")))?;
        Ok(Self { link, line: UartSim::new(uart)?, said: LineOutputs::default() })
    }

    /// Applies the inputs and returns the outputs of the present cycle.
    pub fn settle(&mut self, inputs: &LinkInputs) -> LinkOutputs {
        // The offered byte depends on registers only, so it is known before the link settles.
        // Whether the line accepts it is known only after the line has settled.
        let (line, tx) = self.line.settle(inputs.rx, self.link.offered());
        self.said = line;
        LinkOutputs { tx, ..self.link.settle(inputs, line) }
    }

    /// The signals between link and line in the present cycle: the outputs of the line, and the
    /// byte that the link offers.
    pub fn bytes(&self) -> (LineOutputs, Option<u8>) {
        (self.said, self.link.offered())
    }

    /// Advances to the next cycle. The inputs are those of the last call of `settle`.
    pub fn clock(&mut self) {
        self.link.clock();
        self.line.clock();
    }
}
