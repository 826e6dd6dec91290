//! The gateware's end of the host link, clock by clock: a machine with a program between a UART and the engine.
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
//! What the machine's instructions mean is in `carrystep_core::link::machine`, what they do in its `image()`.

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

/// The link's state; [`Link::outputs`] and [`Link::clock`] are its one clock cycle.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Link {
    /// The axes that there are, a bit each.
    axes: u8,
    line: End,
    machine: Machine,
    facts: Facts,
}

impl Link {
    /// The link of this build over this line, as it is configured.
    pub fn new(build: &EngineBuild, line: impl Into<Line>) -> Self {
        let line = line.into();
        Self {
            axes: ((1_u16 << build.axes()) - 1) as u8,
            line: End::new(line),
            machine: Machine::new(&image()),
            facts: Facts::new(build, line.build_id(build)),
        }
    }

    /// The outputs in this clock: all of them come from registers.
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

    /// The line to the host in this clock.
    pub const fn tx(&self) -> bool {
        self.line.level()
    }

    /// Goes to the next clock.
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

    /// For so many clocks nothing happens in here, whatever the engine says, while the line from the host stays at
    /// `rx`: the machine waits for a byte or to send one, and no bit is due. 0 where something happens in this clock.
    pub fn quiet(&self, rx: bool) -> u64 {
        let waits = self.machine.waits();
        if waits == Waits::No {
            return 0;
        }
        self.line.quiet(rx, waits == Waits::ToSend)
    }

    /// Nothing that the engine says matters to this clock, and nothing is told to it but what it is told already.
    pub fn is_alone(&self) -> bool {
        !self.machine.minds_the_engine()
    }

    /// Goes to the next clock, alone.
    pub fn clock_alone(&mut self, rx: bool, spi: [bool; 2]) {
        self.clock(&LinkInputs { rx, spi, ..LinkInputs::default() });
    }

    /// So many clocks of [`Link::quiet`] have passed.
    pub fn pass(&mut self, clocks: u64, rx: bool) {
        self.machine.pass(clocks);
        self.line.pass(clocks, rx);
    }

    /// Meanwhile the engine has had so many turns of axes; `said` is what it says of an axis and an item. Before anything
    /// of it is read, the program waits until it has been asked for anew.
    pub fn catch_up(&mut self, turns: u64, said: impl Fn(u8, u8) -> u32) {
        self.facts.pass(turns, said);
    }

    /// Meanwhile the engine has said where an axis is that waits for its limit.
    pub fn latch(&mut self, axis: u8, position: u32) {
        self.facts.latch(axis, position);
    }
}
