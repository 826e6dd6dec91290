//! The watch: compares the inputs, one in each clock, with the levels that were reported last.
//!
//! ```text
//! scan     | F | F+1 | ... | G | F | F+1 |       while `scans`
//! changed  ______/^^^\____________________       input F+1 differs: its new level is reported
//! ```
//!
//! Interface: `changed` is asserted in the clock in which a difference is found, with the row of
//! the input. The reported level is part of `seen` from the next clock on.
//!
//! Cost: three flip-flops for each input and two multiplexers of them.

use crate::primitives::constant::{Literal, Parameter};
use crate::primitives::register::{Input, Register};
use crate::primitives::word::Word;
use carrystep_core::SelfTest;
use rust_hdl_core::prelude::*;

/// The inputs and their reported levels.
#[derive(LogicBlock, Default)]
pub struct Watch {
    /// The clock.
    pub clock: Input<Clock>,
    /// The levels of the inputs, each at the bit of its row, and 0 at the other bits; asynchronous.
    pub pins: Input<Word<64>>,
    /// An input is compared in this clock.
    pub scans: Input<Bit>,
    /// The compared input differs from its reported level.
    pub changed: Signal<Out, Bit>,
    /// The row of the compared input.
    pub scanned: Signal<Out, Word<6>>,
    /// The levels that were reported last.
    pub seen: Signal<Out, Word<64>>,
    sync: Register<Word<64>>,
    now: Register<Word<64>>,
    reported: Register<Word<64>>, // `seen`
    scan: Register<Word<6>>,
    compared: Signal<Local, Word<64>>, // the bit of the compared input
    differ: Signal<Local, Word<64>>,
    differs: Signal<Local, Bit>,
    at_end: Signal<Local, Bit>,
    first_row: Parameter<6>,
    last_row: Parameter<6>,
    inputs: Parameter<64>,
    one_row: Literal<6, 1>,
    lowest: Literal<64, 1>,
}

impl Watch {
    /// Makes the watch of this build. Every input was reported as 1, the level of an open input.
    pub fn new(build: &SelfTest) -> Self {
        let high = || Register::new(Word::from(build.inputs()));
        let (first, last) = (build.first_input() as u64, build.last_input() as u64);
        Self {
            sync: high(),
            now: high(),
            reported: high(),
            scan: Register::new(Word::from(first)),
            first_row: Parameter::new(first),
            last_row: Parameter::new(last),
            inputs: Parameter::new(build.inputs()),
            ..Self::default()
        }
    }
}

impl Logic for Watch {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, sync, now, reported, scan);
        self.sync.d.next = self.pins.val();
        self.now.d.next = self.sync.q.val();

        self.compared.next = self.lowest.val() << self.scan.q.val();
        self.differ.next =
            (self.now.q.val() ^ self.reported.q.val()) & self.compared.val() & self.inputs.val();
        self.differs.next = self.scans.val() & self.differ.val().any();
        self.at_end.next = self.scan.q.val() == self.last_row.val();
        if self.scans.val() {
            self.scan.d.next = self.scan.q.val() + self.one_row.val();
            if self.at_end.val() {
                self.scan.d.next = self.first_row.val();
            }
        }
        if self.differs.val() {
            self.reported.d.next = self.reported.q.val() ^ self.compared.val();
        }

        self.changed.next = self.differs.val();
        self.scanned.next = self.scan.q.val();
        self.seen.next = self.reported.q.val();
    }
}
