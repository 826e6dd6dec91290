//! The self-test gateware, clock by clock: one output at a time is active for a second, changes of
//! inputs are reported over the UART, and a byte from the host is answered with a list of all pins.
//! It must stay equal to docs/self-test.md and to `crates/hdl` in every clock.

use crate::link::{Receiver, Transmitter};
use carrystep_core::self_test::{LAST, LEVEL, ROW_BYTES, SelfTestInputs, SelfTestOutputs};

/// What is being sent.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Line {
    row: usize,
    letter: usize,
    /// The letter has come out of the memory.
    fetched: bool,
    /// All rows follow, up to the last one.
    listing: bool,
}

/// The state of the self-test. [`SelfTest::outputs`] and [`SelfTest::clock`] together are one clock
/// cycle.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SelfTest {
    build: carrystep_core::SelfTest,
    image: Vec<u8>,
    receiver: Receiver,
    transmitter: Transmitter,
    /// Clocks that are left of this half of the period.
    timer: u32,
    /// The period is in its second half.
    second: bool,
    /// The row of the output that is 1; 0: none is.
    slot: usize,
    /// The levels of the inputs one clock ago, two clocks ago, and as they were reported last.
    sync: u64,
    now: u64,
    seen: u64,
    /// The input that is compared next.
    scan: usize,
    /// The line that is being sent, if any.
    line: Option<Line>,
    /// The last byte from the host, until it is sent back.
    echo: Option<u8>,
}

impl SelfTest {
    /// The self-test of this build, at configuration.
    pub fn new(build: &carrystep_core::SelfTest) -> Self {
        let bit_clocks = build.uart().bit_clocks();
        Self {
            build: build.clone(),
            image: build.image(),
            receiver: Receiver::new(bit_clocks),
            transmitter: Transmitter::new(bit_clocks),
            timer: build.half_clocks() - 1,
            second: false,
            slot: 0,
            sync: build.inputs(),
            now: build.inputs(),
            seen: build.inputs(),
            scan: build.first_input(),
            line: Some(Line { row: 0, letter: 0, fetched: false, listing: false }),
            echo: None,
        }
    }

    /// The outputs in this clock. All of them come from registers.
    pub const fn outputs(&self) -> SelfTestOutputs {
        SelfTestOutputs { tx: self.transmitter.line(), lit: !self.second, active: 1 << self.slot }
    }

    /// Advances by one clock.
    pub fn clock(&mut self, inputs: &SelfTestInputs) {
        let (line, received) = (self.line, self.receiver.byte());
        let taken = self.offered().filter(|_| self.transmitter.takes(true));
        let idle = line.is_none() && self.echo.is_none();
        let due = self.second && self.timer == 0;

        self.walk(idle && due);
        if idle && !due {
            self.compare();
        }
        match line {
            Some(line) => self.line = self.after(line, taken.is_some()),
            None if taken.is_some() => {
                self.line = Some(Line { row: 0, letter: 0, fetched: false, listing: true });
                self.echo = None;
            }
            None => {}
        }
        self.echo = received.or(self.echo);
        (self.sync, self.now) = (inputs.pins, self.sync);
        self.transmitter.clock(taken);
        self.receiver.clock(inputs.rx);
    }

    /// The byte that is offered to the transmitter.
    fn offered(&self) -> Option<u8> {
        let Some(line) = self.line else { return self.echo };
        let level = (self.seen >> line.row & 1) as u8 | u8::from(line.row == self.slot);
        line.fetched.then(|| match self.text(line) & !LAST {
            LEVEL => b'0' + level,
            byte => byte,
        })
    }

    fn text(&self, line: Line) -> u8 {
        self.image[line.row * ROW_BYTES + line.letter]
    }

    /// Counts the period, and makes the next output 1 if `walks`.
    fn walk(&mut self, walks: bool) {
        let whole = self.build.half_clocks() - 1;
        if walks {
            self.slot = if self.slot == self.build.last_output() { 0 } else { self.slot + 1 };
            (self.timer, self.second) = (whole, false);
            self.begin(self.slot);
        } else if self.timer > 0 {
            self.timer -= 1;
        } else if !self.second {
            (self.timer, self.second) = (whole, true);
        }
    }

    /// Compares one input with the level that was reported last.
    fn compare(&mut self) {
        let row = self.scan;
        if row > self.build.last_input() {
            return; // there is no input
        }
        self.scan = if row == self.build.last_input() { self.build.first_input() } else { row + 1 };
        if (self.now ^ self.seen) >> row & 1 == 1 {
            self.seen ^= 1 << row;
            self.begin(row);
        }
    }

    fn begin(&mut self, row: usize) {
        self.line = Some(Line { row, letter: 0, fetched: false, listing: false });
    }

    /// What is sent in the next clock; `taken`: the transmitter accepts a letter in this one.
    fn after(&self, line: Line, taken: bool) -> Option<Line> {
        if !taken {
            return Some(Line { fetched: true, ..line });
        }
        let next = Line { letter: line.letter + 1, fetched: false, ..line };
        if self.text(line) & LAST == 0 {
            return Some(next);
        }
        let more = line.listing && line.row != self.build.last_row();
        more.then_some(Line { row: line.row + 1, letter: 0, ..next })
    }
}
