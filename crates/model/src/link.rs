//! The host link in the gateware, clock by clock: a small processor with a fixed program between a
//! UART or SPI line and the engine. It must stay equal to docs/link.md and to `crates/hdl` in every
//! clock.
//!
//! ```text
//!          .----------. bytes  .-----------. put, start, home, control, snapshot
//!  rx ---->| Receiver |------->|           |------------------------------------> engine
//!          '----------'        | processor | state of stops, room, homing, refreshed
//!          .-------------. A   |           |<------------------------------------ engine
//!  tx <----| Transmitter |<----|           | word   .--------. words of state
//!          '-------------'     '-----------'<-------| mirror |<------------------ engine
//!                                                   '--------'
//! ```
//!
//! The instruction set is defined in `carrystep_core::link::processor`; the program is its
//! `image()`.

mod crc;
mod latch_records;
mod line;
mod processor;
mod register_mirror;
mod spi;
mod uart;

pub use processor::Awaited;
pub(crate) use uart::{Receiver, Transmitter};

use carrystep_core::EngineBuild;
use carrystep_core::engine::{
    EngineInputs, EngineOutputs, MAX_LATCHES, Put, SeekSource, StateWord,
};
use carrystep_core::link::{LineKind, LinkInputs, LinkOutputs, image};
use latch_records::LatchRecords;
use line::End;
use processor::{Inputs, LinkProcessor, Waits};
use register_mirror::RegisterMirror;

/// Levels of SCK and of the active-low chip select of an SPI at rest.
pub const SPI_RESTS: [bool; 2] = [false, true];

/// The bits of all latches.
const LATCHES: u8 = (1 << MAX_LATCHES) - 1;

/// The state of the link. [`Link::outputs`] and [`Link::clock`] together are one clock cycle.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Link {
    /// Mask of the axes that exist, one bit per axis.
    axes: u8,
    line: End,
    processor: LinkProcessor,
    register_mirror: RegisterMirror,
    /// The records of a build with several latches.
    latch_records: Option<LatchRecords>,
}

impl Link {
    /// The link of this build over this line, at configuration.
    pub fn new(build: &EngineBuild, line: impl Into<LineKind>) -> Self {
        let line = line.into();
        Self {
            axes: ((1_u16 << build.axes()) - 1) as u8,
            line: End::new(line),
            processor: LinkProcessor::new(&image(build.has_several_latches())),
            register_mirror: RegisterMirror::new(build, line.build_id(build)),
            latch_records: build.has_several_latches().then(|| LatchRecords::new(build)),
        }
    }

    /// The outputs in this clock. All of them come from registers.
    pub fn outputs(&self) -> LinkOutputs {
        let processor = self.processor.outputs();
        let (axis, word) = (self.room_of(), processor.number);
        let mask = processor.a & self.axes;
        let engine = EngineInputs {
            put: processor.puts.then_some(Put { axis, word, data: processor.word }),
            room_of: axis,
            start: processor.starts.then_some(mask),
            clear: processor.clear,
            stop: processor.stop,
            broken: processor.broken,
            seek_source: processor.sources.then_some(SeekSource::of_byte(processor.a)),
            seek: processor.seeks.then_some(mask),
            latch_arm: self.arms(processor.arms, processor.a),
            snapshot: processor.snapshot,
            cut: processor.cuts,
            kick: processor.kicks,
            enable: processor.enable,
            ..EngineInputs::default()
        };
        LinkOutputs { tx: self.line.level(), engine }
    }

    /// The latches that the processor arms in this clock, with this A.
    fn arms(&self, arms: bool, a: u8) -> u8 {
        match self.latch_records {
            _ if !arms => 0,
            Some(_) => a & LATCHES,
            None => 1,
        }
    }

    /// The word that the processor has read.
    fn fact(&self, engine: &EngineOutputs) -> u32 {
        let records = self.latch_records.as_ref();
        records.and_then(|records| records.data(engine)).unwrap_or(self.register_mirror.data())
    }

    /// The level of the line to the host (TX or MISO) in this clock.
    pub const fn tx(&self) -> bool {
        self.line.level()
    }

    /// Advances by one clock.
    pub fn clock(&mut self, inputs: &LinkInputs) {
        let processor = self.processor.outputs();
        let taken = self.line.takes(processor.goes);
        self.processor.clock(&Inputs {
            received: self.line.byte(),
            taken,
            fact: self.fact(&inputs.engine),
            engine: &inputs.engine,
        });
        self.register_mirror.clock(processor.x, inputs.engine.state);
        if let Some(records) = &mut self.latch_records {
            records.clock(processor.x, processor.arms.then_some(processor.a), &inputs.engine);
        }
        self.line.clock(inputs, taken.then_some(processor.a));
    }

    /// Returns the number of clocks in which nothing happens in the link, whatever the engine
    /// outputs, provided that the line from the host stays at `rx`, and an SPI at rest: the processor
    /// waits for a byte or for the transmitter, and no bit is due. Returns 0 if something happens in
    /// this clock.
    pub fn quiet(&self, rx: bool) -> u64 {
        let waits = self.processor.waits();
        if waits == Waits::No {
            return 0;
        }
        self.line.quiet(rx, SPI_RESTS, waits == Waits::ToSend)
    }

    /// True if this clock does not depend on the engine's outputs and the link's outputs to the
    /// engine stay the same, but for [`Link::room_of`]. What the engine has output in such clocks
    /// must be delivered before the next clock that is not alone, by [`Link::store`].
    pub fn is_alone(&self) -> bool {
        !self.processor.minds_the_engine()
    }

    /// What the link waits for the engine to do, if it waits in this clock. While it waits, its
    /// outputs to the engine stay the same, and it reads no words of state. Words that the engine
    /// outputs meanwhile must be delivered, by [`Link::store`], before the clock in which the wait
    /// ends.
    pub fn awaits(&self) -> Option<Awaited> {
        self.processor.awaits()
    }

    /// As [`Link::run_alone`], for exactly this number of clocks, in which the link waits for the
    /// engine ([`Link::awaits`]).
    pub fn run_waiting(
        &mut self,
        (rx, spi): (bool, [bool; 2]),
        clocks: u64,
        mut changed: impl FnMut(u64, bool),
    ) {
        let inputs = LinkInputs { rx, spi, ..LinkInputs::default() };
        let (mut done, mut level) = (0, self.tx());
        while done < clocks {
            let quiet = self.line.quiet(rx, spi, false).min(clocks - done);
            if quiet == 0 {
                self.clock(&inputs);
            } else {
                self.line.pass(quiet, rx);
            }
            done += quiet.max(1);
            if self.tx() != level {
                level = !level;
                changed(done, level);
            }
        }
    }

    /// Advances by at most `clocks` clocks, and not into the first clock in which the link needs the
    /// engine ([`Link::is_alone`]). Meanwhile the host drives these levels of RX (or MOSI) and of SCK
    /// and chip select. Whenever the line to the host changes, `changed` receives the number of clocks
    /// so far and the new level. Returns the number of clocks that were executed.
    pub fn run_alone(
        &mut self,
        (rx, spi): (bool, [bool; 2]),
        clocks: u64,
        mut changed: impl FnMut(u64, bool),
    ) -> u64 {
        let inputs = LinkInputs { rx, spi, ..LinkInputs::default() };
        let (mut done, mut level) = (0, self.tx());
        while done < clocks && self.is_alone() {
            done += self.advance(&inputs, clocks - done);
            if self.tx() != level {
                level = !level;
                changed(done, level);
            }
        }
        done
    }

    /// Advances by one clock, or, while the line only counts, by up to `most` clocks in which the
    /// processor either works without the engine or waits. Returns the number of clocks.
    fn advance(&mut self, inputs: &LinkInputs, most: u64) -> u64 {
        let waits = self.processor.waits();
        let quiet = self.line.quiet(inputs.rx, inputs.spi, waits == Waits::ToSend);
        let clocks = match quiet.min(most) {
            0 => {
                self.clock(inputs);
                return 1;
            }
            // The word that the memory of registers outputs is not used before the next clock that is
            // not alone, which reads it anew.
            quiet if waits == Waits::No => self.processor.work(quiet, &inputs.engine),
            quiet => {
                self.processor.pass(quiet);
                quiet
            }
        };
        self.line.pass(clocks, inputs.rx);
        clocks
    }

    /// Stores a word of state that the engine has output in a clock that the link has skipped, or
    /// has executed alone. Of several words of one address, the last one is enough.
    pub fn store(&mut self, word: StateWord) {
        self.register_mirror.store(word);
        self.latch_records.iter_mut().for_each(|records| records.store(word));
    }

    /// The axis whose room the link requests in this clock, unless it offers a word.
    pub fn room_of(&self) -> u8 {
        self.processor.room_of()
    }

    /// The word that a host reads at this address, unless it belongs to one of several latches.
    pub fn register(&self, address: u8) -> u32 {
        self.register_mirror.word(address)
    }
}
