//! The host link in the gateware, clock by clock: a small processor with a fixed program between a
//! UART or SPI line and the engine. It must stay equal to docs/link.md and to `crates/hdl` in every
//! clock.
//!
//! ```text
//!          .---------. bytes  .---------. put, start, home, control
//!  rx ---->| Receiver |------>|         |--------------------------------> engine
//!          '---------'        | Machine | state, room, culprits, homing
//!          .-------------. A  |         |<-------------------------------- engine
//!  tx <----| Transmitter |<---|         | facts  .-------. get, latch
//!          '-------------'    '---------'<-------| Facts |<--------------- engine
//!                                                '-------'
//! ```
//!
//! The instruction set is defined in `carrystep_core::link::machine`; the program is its `image()`.

mod check;
mod facts;
mod line;
mod machine;
mod spi;
mod uart;

use carrystep_core::EngineBuild;
use carrystep_core::engine::{EngineInputs, Put};
use carrystep_core::link::{Line, LinkInputs, LinkOutputs, image};
use facts::Facts;
use line::End;
use machine::{Inputs, Machine, Waits};

/// The state of the link. [`Link::outputs`] and [`Link::clock`] together are one clock cycle.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Link {
    /// Mask of the axes that exist, one bit per axis.
    axes: u8,
    line: End,
    machine: Machine,
    facts: Facts,
}

impl Link {
    /// The link of this build over this line, at configuration.
    pub fn new(build: &EngineBuild, line: impl Into<Line>) -> Self {
        let line = line.into();
        Self {
            axes: ((1_u16 << build.axes()) - 1) as u8,
            line: End::new(line),
            machine: Machine::new(&image()),
            facts: Facts::new(build, line.build_id(build)),
        }
    }

    /// The outputs in this clock. All of them come from registers.
    pub fn outputs(&self) -> LinkOutputs {
        let machine = self.machine.outputs();
        let (get_axis, get_item) = self.facts.asks();
        let (axis, word) = (machine.a >> 3 & 7, machine.x >> 2 & 7);
        let mask = machine.a & self.axes;
        let engine = EngineInputs {
            put: machine.puts.then_some(Put { axis, word, data: machine.word }),
            room_of: axis,
            start: machine.starts.then_some(mask),
            clear: machine.clear,
            stop: machine.stop,
            broken: machine.broken,
            home: machine.homes.then_some(mask),
            kick: machine.kicks,
            enable: machine.enable,
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
        let machine = self.machine.outputs();
        let taken = self.line.takes(machine.goes);
        self.machine.clock(&Inputs {
            received: self.line.byte(),
            taken,
            fact: self.facts.data(),
            scanned: self.facts.scanned(inputs),
            engine: &inputs.engine,
        });
        self.facts.clock(machine.x, inputs);
        self.line.clock(inputs, taken.then_some(machine.a));
    }

    /// Returns the number of clocks in which nothing happens in the link, whatever the engine
    /// outputs, provided that the line from the host stays at `rx`: the processor waits for a byte
    /// or for the transmitter, and no bit is due. Returns 0 if something happens in this clock.
    pub fn quiet(&self, rx: bool) -> u64 {
        let waits = self.machine.waits();
        if waits == Waits::No {
            return 0;
        }
        self.line.quiet(rx, waits == Waits::ToSend)
    }

    /// True if this clock does not depend on the engine's outputs and the link's outputs to the
    /// engine stay the same.
    pub fn is_alone(&self) -> bool {
        !self.machine.minds_the_engine()
    }

    /// Advances by one clock with default inputs from the engine; valid while [`Link::is_alone`].
    pub fn clock_alone(&mut self, rx: bool, spi: [bool; 2]) {
        self.clock(&LinkInputs { rx, spi, ..LinkInputs::default() });
    }

    /// Skips `clocks` clocks, at most [`Link::quiet`], with the line from the host at `rx`.
    pub fn pass(&mut self, clocks: u64, rx: bool) {
        self.machine.pass(clocks);
        self.line.pass(clocks, rx);
    }

    /// Updates the memory of facts after `turns` time slots of axes that were skipped; `said`
    /// returns the engine's current answer for an axis and an item. The order in time does not
    /// matter: the program waits for a complete new scan before it reads any of these words.
    pub fn catch_up(&mut self, turns: u64, said: impl Fn(u8, u8) -> u32) {
        self.facts.pass(turns, said);
    }

    /// Stores the latched position (in steps) that the engine output in a skipped clock for an axis
    /// that waits for its limit.
    pub fn latch(&mut self, axis: u8, position: u32) {
        self.facts.latch(axis, position);
    }
}
