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
use carrystep_spec::link::{Uart, image};
use facts::Facts;
use machine::{Inputs, Machine, Waits};
use uart::{Receiver, Transmitter};

/// What goes into the link in a clock.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct LinkInputs {
    /// The line from the host; high at rest.
    pub rx: bool,
    /// The offered word is taken.
    pub put_ready: bool,
    /// The axis of `put_axis` has room for so many segments,
    pub room: u8,
    /// in this clock.
    pub room_valid: bool,
    /// The offered start is taken.
    pub start_ready: bool,
    /// What was asked of the engine,
    pub get_data: u32,
    /// in this clock.
    pub get_valid: bool,
    /// `get_data` is the position
    pub latch: bool,
    /// of this axis, which waits for its limit.
    pub latch_axis: u8,
    /// A stop has been called.
    pub fault: bool,
    /// No axis moves any more.
    pub halted: bool,
    /// All axes are done.
    pub idle: bool,
    /// Starts can be taken.
    pub ready: bool,
    /// A start is armed.
    pub armed: bool,
    /// Why, 0 to 7.
    pub cause: u8,
    /// The axes that a stop came from.
    pub culprits: u8,
    /// The axes that wait for their limit.
    pub homing: u8,
}

/// What comes out of the link in a clock.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct LinkOutputs {
    /// The line to the host.
    pub tx: bool,
    /// A word of a segment is offered,
    pub put_valid: bool,
    /// for this axis, whose room is asked for at any time,
    pub put_axis: u8,
    /// the word of this place,
    pub put_word: u8,
    /// this one.
    pub put_data: u32,
    /// A start is offered,
    pub start_valid: bool,
    /// of these axes.
    pub start_mask: u8,
    /// Resume after a stop.
    pub clear: bool,
    /// The host's controlled stop.
    pub stop: bool,
    /// The host has broken the segment protocol.
    pub broken: bool,
    /// The host says anew which axes wait for their limit,
    pub home_valid: bool,
    /// namely these.
    pub home_mask: u8,
    /// The host was heard of.
    pub kick: bool,
    /// The drivers are to be powered.
    pub enable: bool,
    /// What is asked of the engine: of this axis,
    pub get_axis: u8,
    /// this item.
    pub get_item: u8,
}

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
        LinkOutputs {
            tx: self.transmitter.line(),
            put_valid: machine.puts,
            put_axis: machine.x >> 3 & 7,
            put_word: machine.x & 7,
            put_data: machine.word,
            start_valid: machine.starts,
            start_mask: machine.a & self.axes,
            clear: machine.clear,
            stop: machine.stop,
            broken: machine.broken,
            home_valid: machine.homes,
            home_mask: machine.a & self.axes,
            kick: machine.kicks,
            enable: machine.enable,
            get_axis,
            get_item,
        }
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
            engine: inputs,
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

    /// So many clocks of [`Link::quiet`] have passed, in which the engine had so many turns of axes, and these axes waited
    /// for their limit; `said` is what it says of an axis and an item.
    pub fn pass(&mut self, clocks: u64, rx: bool, (turns, homing): (u64, u8), said: impl Fn(u8, u8) -> u32) {
        self.machine.pass(clocks);
        self.receiver.pass(clocks, rx);
        self.transmitter.pass(clocks);
        self.facts.pass(turns, homing, said);
    }
}
