//! Makes the link of a build, whose number of axes is known only at run time, and simulates it.

use super::Link;
use crate::HdlError;
use crate::line::{LineOutputs, UartSim};
use crate::primitives::word::Word;
use crate::sim::{rising_edge, settle};
use carrystep_core::EngineBuild;
use carrystep_core::engine::{
    EngineError, EngineInputs, Put, STATUS_BITS, SeekSource, StateItem, StateWord,
};
use carrystep_core::link::{BuildId, LinkInputs, LinkOutputs, Uart};
use rust_hdl::prelude::{Block, check_all};

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

impl<const N: usize> AnyLink for Link<N> {
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
        // Bits without a meaning are ones, so that a use of them shows.
        let no_meaning = |state: StateWord| match state.item {
            StateItem::Status => state.word | u32::MAX << STATUS_BITS,
            _ => state.word,
        };
        let of_state = |value: fn(StateWord) -> u64| engine.state.map_or(0, value);
        self.state_valid.next = engine.state.is_some();
        self.state_page.next = Word::from(of_state(|state| state.page as u64));
        self.state_axis.next = Word::from(of_state(|state| state.axis.into()));
        self.state_item.next = Word::from(of_state(|state| state.item as u64));
        self.state.next = Word::from(u64::from(engine.state.map_or(u32::MAX, no_meaning)));
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
        self.latch_armed.next = engine.latch_armed;
        self.latch_edges.next = Word::from(u64::from(engine.latch_edges));
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
                latch_arm: self.latch_arm.val(),
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
