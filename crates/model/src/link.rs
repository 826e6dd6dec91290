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
//! What the machine's instructions mean is in `carrystep_spec::link::machine`, what they do in its `image()`.

mod check;
mod facts;
mod machine;
mod uart;

use carrystep_spec::EngineBuild;
use carrystep_spec::engine::{EngineInputs, Put};
use carrystep_spec::link::{LinkInputs, LinkOutputs, Uart, image};
use facts::Facts;
use machine::{Inputs, Machine, Waits};
use uart::{Receiver, Transmitter};

/// The link's state; [`Link::outputs`] and [`Link::clock`] are its one clock cycle.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Link {
    /// The axes that there are, a bit each.
    axes: u8,
    receiver: Receiver,
    transmitter: Transmitter,
    machine: Machine,
    facts: Facts,
}

impl Link {
    /// The link of this build over this UART, as it is configured.
    pub fn new(build: &EngineBuild, uart: Uart) -> Self {
        Self {
            axes: ((1_u16 << build.axes()) - 1) as u8,
            receiver: Receiver::new(uart.bit_clocks()),
            transmitter: Transmitter::new(uart.bit_clocks()),
            machine: Machine::new(&image()),
            facts: Facts::new(build, uart.build_id(build)),
        }
    }

    /// The outputs in this clock: all of them come from registers.
    pub fn outputs(&self) -> LinkOutputs {
        let machine = self.machine.outputs();
        let (get_axis, get_item) = self.facts.asks();
        let (axis, word) = (machine.x >> 3 & 7, machine.x & 7);
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
        LinkOutputs { tx: self.transmitter.line(), engine, get_axis, get_item }
    }

    /// Goes to the next clock.
    pub fn clock(&mut self, inputs: &LinkInputs) {
        let machine = self.machine.outputs();
        let taken = self.transmitter.takes(machine.goes);
        self.machine.clock(&Inputs {
            received: self.receiver.byte(),
            taken,
            fact: self.facts.data(),
            scanned: self.facts.scanned(inputs),
            engine: &inputs.engine,
        });
        self.facts.clock(machine.x, inputs);
        self.transmitter.clock(taken.then_some(machine.a));
        self.receiver.clock(inputs.rx);
    }

    /// For so many clocks nothing happens in here, whatever the engine says, while the line from the host stays at
    /// `rx`: the machine waits for a byte or to send one, and no bit is due. 0 where something happens in this clock.
    pub fn quiet(&self, rx: bool) -> u64 {
        let waits = self.machine.waits();
        if waits == Waits::No {
            return 0;
        }
        self.receiver.quiet(rx).min(self.transmitter.quiet(waits == Waits::ToSend))
    }

    /// So many clocks of [`Link::quiet`] have passed, in which the engine had so many turns of axes; `said` is what it
    /// says of an axis and an item.
    pub fn pass(&mut self, clocks: u64, rx: bool, turns: u64, said: impl Fn(u8, u8) -> u32) {
        self.machine.pass(clocks);
        self.receiver.pass(clocks, rx);
        self.transmitter.pass(clocks);
        self.facts.pass(turns, said);
    }
}
