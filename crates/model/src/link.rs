//! The host link in the gateware, clock by clock: a small processor with a fixed program between a
//! UART or SPI line and the engine. It must stay equal to docs/link.md and to `crates/hdl` in every
//! clock.
//!
//! ```text
//!          .---------. bytes  .---------. put, start, home, control
//!  rx ---->| Receiver |------>|         |--------------------------------> engine
//!          '---------'        |processor| state, room, culprits, homing
//!          .-------------. A  |         |<-------------------------------- engine
//!  tx <----| Transmitter |<---|         | facts  .-------. get, latch
//!          '-------------'    '---------'<-------| Facts |<--------------- engine
//!                                                '-------'
//! ```
//!
//! The instruction set is defined in `carrystep_core::link::processor`; the program is its
//! `image()`.

mod crc;
mod line;
mod processor;
mod register_mirror;
mod spi;
mod uart;

use carrystep_core::EngineBuild;
use carrystep_core::engine::{EngineInputs, Put};
use carrystep_core::link::{LineKind, LinkInputs, LinkOutputs, image};
use line::End;
use processor::{Inputs, LinkProcessor, Waits};
use register_mirror::RegisterMirror;

/// The state of the link. [`Link::outputs`] and [`Link::clock`] together are one clock cycle.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Link {
    /// Mask of the axes that exist, one bit per axis.
    axes: u8,
    line: End,
    processor: LinkProcessor,
    register_mirror: RegisterMirror,
}

impl Link {
    /// The link of this build over this line, at configuration.
    pub fn new(build: &EngineBuild, line: impl Into<LineKind>) -> Self {
        let line = line.into();
        Self {
            axes: ((1_u16 << build.axes()) - 1) as u8,
            line: End::new(line),
            processor: LinkProcessor::new(&image()),
            register_mirror: RegisterMirror::new(build, line.build_id(build)),
        }
    }

    /// The outputs in this clock. All of them come from registers.
    pub fn outputs(&self) -> LinkOutputs {
        let processor = self.processor.outputs();
        let (get_axis, get_item) = self.register_mirror.asks();
        let (axis, word) = (processor.a >> 3 & 7, processor.x >> 2 & 7);
        let mask = processor.a & self.axes;
        let engine = EngineInputs {
            put: processor.puts.then_some(Put { axis, word, data: processor.word }),
            room_of: axis,
            start: processor.starts.then_some(mask),
            clear: processor.clear,
            stop: processor.stop,
            broken: processor.broken,
            home: processor.homes.then_some(mask),
            kick: processor.kicks,
            enable: processor.enable,
            ..EngineInputs::default()
        };
        LinkOutputs { tx: self.line.level(), engine, get_axis, get_item }
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
            fact: self.register_mirror.data(),
            scanned: self.register_mirror.scanned(inputs),
            engine: &inputs.engine,
        });
        self.register_mirror.clock(processor.x, inputs);
        self.line.clock(inputs, taken.then_some(processor.a));
    }

    /// Returns the number of clocks in which nothing happens in the link, whatever the engine
    /// outputs, provided that the line from the host stays at `rx`: the processor waits for a byte
    /// or for the transmitter, and no bit is due. Returns 0 if something happens in this clock.
    pub fn quiet(&self, rx: bool) -> u64 {
        let waits = self.processor.waits();
        if waits == Waits::No {
            return 0;
        }
        self.line.quiet(rx, waits == Waits::ToSend)
    }

    /// True if this clock does not depend on the engine's outputs and the link's outputs to the
    /// engine stay the same.
    pub fn is_alone(&self) -> bool {
        !self.processor.minds_the_engine()
    }

    /// Advances by one clock with default inputs from the engine; valid while [`Link::is_alone`].
    pub fn clock_alone(&mut self, rx: bool, spi: [bool; 2]) {
        self.clock(&LinkInputs { rx, spi, ..LinkInputs::default() });
    }

    /// Skips `clocks` clocks, at most [`Link::quiet`], with the line from the host at `rx`.
    pub fn pass(&mut self, clocks: u64, rx: bool) {
        self.processor.pass(clocks);
        self.line.pass(clocks, rx);
    }

    /// Updates the memory of facts after `time_slots` time slots of axes that were skipped; `said`
    /// returns the engine's current answer for an axis and an item. The order in time does not
    /// matter: the program waits for a complete new scan before it reads any of these words.
    pub fn catch_up(&mut self, time_slots: u64, said: impl Fn(u8, u8) -> u32) {
        self.register_mirror.pass(time_slots, said);
    }

    /// Stores the latched position (in steps) that the engine output in a skipped clock for an axis
    /// that waits for its limit.
    pub fn latch(&mut self, axis: u8, position: u32) {
        self.register_mirror.latch(axis, position);
    }
}
