//! The host link: requests in, answers out (docs/protocol.md), by a little machine and its program.
//!
//! ```text
//!          .---------. bytes  .---------. put, start, home, control
//!  rx ---->| uart_in |------->|         |--------------------------------> engine
//!          '---------'        | machine | state, room, culprits, homing
//!          .----------. bytes |         |<-------------------------------- engine
//!  tx <----| uart_out |<------|         | facts  .-------. get, latch
//!          '----------'       '---------'<-------| facts |<--------------- engine
//!                                                '-------'
//! ```
//!
//! A request lies in block RAM until its CRC has come; only then a word of it reaches the engine.

use crate::register::Input;
use crate::word::Word;
use carrystep_spec::EngineBuild;
use carrystep_spec::link::{Uart, facts, image};
use rust_hdl::prelude::*;

pub mod check;
pub mod facts;
pub mod machine;
mod sim;
pub mod uart_in;
pub mod uart_out;

pub use sim::{AnyLink, LinkSim, uart_link};

use self::facts::Facts;
use machine::Machine;
use uart_in::UartIn;
use uart_out::UartOut;

/// The link over a UART, for an engine of N axes; its other ports are the engine's.
#[derive(LogicBlock, Default)]
pub struct UartLink<const N: usize> {
    /// The clock.
    pub clock: Input<Clock>,
    /// The line from the host, asynchronous.
    pub rx: Input<Bit>,
    /// The line to the host.
    pub tx: Signal<Out, Bit>,
    /// A word of a segment is offered,
    pub put_valid: Signal<Out, Bit>,
    /// for this axis,
    pub put_axis: Signal<Out, Word<3>>,
    /// the word of this place,
    pub put_word: Signal<Out, Word<3>>,
    /// this one.
    pub put_data: Signal<Out, Word<32>>,
    /// It is taken.
    pub put_ready: Input<Bit>,
    /// The axis of `put_axis` has room for so many segments,
    pub room: Input<Word<3>>,
    /// in this cycle.
    pub room_valid: Input<Bit>,
    /// A start is offered,
    pub start_valid: Signal<Out, Bit>,
    /// of these axes.
    pub start_mask: Signal<Out, Word<N>>,
    /// It is taken.
    pub start_ready: Input<Bit>,
    /// Resume after a stop.
    pub clear: Signal<Out, Bit>,
    /// The host's controlled stop.
    pub stop: Signal<Out, Bit>,
    /// The host has broken the segment protocol.
    pub broken: Signal<Out, Bit>,
    /// The host says anew which axes wait for their limit,
    pub home_valid: Signal<Out, Bit>,
    /// namely these.
    pub home_mask: Signal<Out, Word<N>>,
    /// The host was heard of.
    pub kick: Signal<Out, Bit>,
    /// The drivers are to be powered.
    pub enable: Signal<Out, Bit>,
    /// What is asked of the engine: of this axis,
    pub get_axis: Signal<Out, Word<3>>,
    /// this item.
    pub get_item: Signal<Out, Word<2>>,
    /// Its answer,
    pub get_data: Input<Word<32>>,
    /// in this cycle.
    pub get_valid: Input<Bit>,
    /// `get_data` is a position,
    pub latch: Input<Bit>,
    /// of this axis, which waits for its limit.
    pub latch_axis: Input<Word<3>>,
    /// A stop has been called.
    pub fault: Input<Bit>,
    /// No axis moves any more.
    pub halted: Input<Bit>,
    /// All axes are done.
    pub idle: Input<Bit>,
    /// Starts can be taken.
    pub ready: Input<Bit>,
    /// A start is armed.
    pub armed: Input<Bit>,
    /// Why.
    pub cause: Input<Word<3>>,
    /// The axes that a stop came from.
    pub culprits: Input<Word<N>>,
    /// The axes that wait for their limit.
    pub homing: Input<Word<N>>,
    uart_in: UartIn,
    uart_out: UartOut,
    machine: Machine<N>,
    facts: Facts,
}

impl<const N: usize> UartLink<N> {
    /// The link of this build, with this line.
    fn new(build: &EngineBuild, uart: Uart) -> Self {
        let bit_clocks = uart.bit_clocks();
        Self {
            uart_in: UartIn::new(bit_clocks),
            uart_out: UartOut::new(bit_clocks),
            machine: Machine::new(&image()),
            facts: Facts::new(&facts(build, uart)),
            ..Self::default()
        }
    }
}

impl<const N: usize> Logic for UartLink<N> {
    #[hdl_gen]
    fn update(&mut self) {
        clock!(self, clock, uart_in, uart_out, machine, facts);
        self.uart_in.line.next = self.rx.val();
        self.machine.received.next = self.uart_in.valid.val();
        self.machine.received_data.next = self.uart_in.data.val();
        self.uart_out.data.next = self.machine.a.val();
        self.uart_out.valid.next = self.machine.answer_valid.val();
        self.machine.answer_take.next = self.uart_out.take.val();
        self.tx.next = self.uart_out.line.val();

        self.put_valid.next = self.machine.put_valid.val();
        self.put_axis.next = self.machine.x.val().get_bits::<3>(3);
        self.put_word.next = self.machine.x.val().get_bits::<3>(0);
        self.put_data.next = self.machine.put_data.val();
        self.machine.put_ready.next = self.put_ready.val();
        self.machine.room.next = self.room.val();
        self.machine.room_valid.next = self.room_valid.val();
        self.start_valid.next = self.machine.start_valid.val();
        self.start_mask.next = self.machine.a.val().get_bits::<N>(0);
        self.machine.start_ready.next = self.start_ready.val();
        self.home_valid.next = self.machine.home_valid.val();
        self.home_mask.next = self.machine.a.val().get_bits::<N>(0);
        self.clear.next = self.machine.clear.val();
        self.stop.next = self.machine.stop.val();
        self.broken.next = self.machine.broken.val();
        self.kick.next = self.machine.kick.val();
        self.enable.next = self.machine.enable.val();

        self.machine.scanned.next = self.facts.scanned.val();
        self.machine.fault.next = self.fault.val();
        self.machine.halted.next = self.halted.val();
        self.machine.idle.next = self.idle.val();
        self.machine.ready.next = self.ready.val();
        self.machine.armed.next = self.armed.val();
        self.machine.cause.next = self.cause.val();
        self.machine.culprits.next = self.culprits.val();
        self.machine.homing.next = self.homing.val();
        self.machine.facts.next = self.facts.data.val();

        self.facts.address.next = self.machine.x.val().get_bits::<7>(0);
        self.facts.get_data.next = self.get_data.val();
        self.facts.get_valid.next = self.get_valid.val();
        self.facts.latch.next = self.latch.val();
        self.facts.latch_axis.next = self.latch_axis.val();
        self.get_axis.next = self.facts.get_axis.val();
        self.get_item.next = self.facts.get_item.val();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::assert_synthesizes;
    use carrystep_spec::{AXES, Build, PinTiming, StartPhase, Timebase};

    #[test]
    fn link_synthesizes() {
        let timebase = Timebase::new(48_000_000, 2000, 16).unwrap();
        let build = Build { timebase, phase: StartPhase::Half, pins: [PinTiming::SHORTEST; AXES] };
        let uart = Uart::new(48_000_000, 3_000_000).unwrap();
        assert_synthesizes(UartLink::<6>::new(&EngineBuild::minimal(&build, 1), uart), "carrystep_link");
    }
}
