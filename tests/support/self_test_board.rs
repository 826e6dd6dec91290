//! The self-test of a board from its pins: a walk of all outputs, every input pulled to ground and
//! released, and a byte from the terminal, as the model does it. The recording of the pins is the
//! reference for the board's Verilog.

use crate::self_test_bench::SelfTestBench;
use carrystep_boards::{Board, Way};
use carrystep_core::SelfTest;
use carrystep_core::link::Uart;
use carrystep_core::self_test::SelfTestOutputs;
use carrystep_simulators::vectors::{Bits, Vectors};
use carrystep_verilog::SelfTestGateware;

/// Cycles from the lock of the PLL to the first edge of the gated clock (docs/decisions/0033).
const LATE: u64 = 1026;

/// Clocks of a bit and of half a period in simulations: the fewest clocks of a bit that a UART can
/// have, and a period in which the longest line can be sent.
const BIT_CLOCKS: u32 = 8;
const HALF_CLOCKS: u32 = 3000;

/// A board's self-test with short times, and a session with it.
pub struct SelfTestSession {
    board: &'static Board,
    gateware: SelfTestGateware<'static>,
    /// The self-test with these times.
    pub test: SelfTest,
    bench: SelfTestBench,
    vectors: Vectors,
    /// Each value of the active output, and the number of cycles for which it lasted.
    pub walk: Vec<(u64, u64)>,
    /// The Verilog of the whole board with these times.
    pub verilog: String,
}

impl SelfTestSession {
    /// A session up to the first edge of the gated clock.
    ///
    /// # Panics If the board has no self-test.
    pub fn new(board: &'static Board, spi: bool) -> Self {
        let gateware = SelfTestGateware::new(board, &board.parts[0], spi).expect("a self-test");
        let uart = Uart::new(8_000_000, 1_000_000).expect("a UART");
        assert_eq!(uart.bit_clocks(), BIT_CLOCKS);
        let test = gateware.test().with_times(uart, HALF_CLOCKS.into()).expect("times in range");
        let files = gateware.verilog().expect("its Verilog").into_iter();
        let text: String = files.map(|file| file.text).collect();
        let text = overridden(&text, "BIT_CLOCKS", BIT_CLOCKS);
        let verilog = overridden(&text, "HALF_CLOCKS", HALF_CLOCKS);
        let bench = SelfTestBench::of_model(&test);
        let vectors = ports(board, &gateware);
        let mut session = Self { board, gateware, test, bench, vectors, walk: Vec::new(), verilog };
        for _ in 0..LATE {
            session.record();
        }
        session
    }

    /// Name of the top module.
    pub fn top(&self) -> String {
        self.gateware.top()
    }

    /// The pin constraints of an iCE40.
    ///
    /// # Panics If the files cannot be generated.
    pub fn pcf(&self) -> String {
        let files = self.gateware.files().expect("its files");
        files.into_iter().find(|file| file.name.ends_with(".pcf")).expect("constraints").text
    }

    /// Clock of the gateware, Hz.
    pub fn clock_hz(&self) -> u64 {
        self.gateware.clock_hz()
    }

    /// Executes this number of cycles.
    pub fn run(&mut self, clocks: u64) {
        for _ in 0..clocks {
            self.bench.clock();
            self.record();
            let active = self.bench.outputs.active;
            match self.walk.last_mut() {
                Some((last, count)) if *last == active => *count += 1,
                _ => self.walk.push((active, 1)),
            }
        }
    }

    /// Executes cycles until a value has become active for the `count`th time.
    pub fn run_until_active(&mut self, row: usize, count: usize) {
        let begun = |walk: &[(u64, u64)]| walk.iter().filter(|(mask, _)| *mask == 1 << row).count();
        while begun(&self.walk) < count {
            self.run(1);
        }
    }

    /// Sets the level of an input.
    pub fn jumper(&mut self, row: usize, level: bool) {
        let bit = 1_u64 << row;
        self.bench.pins = if level { self.bench.pins | bit } else { self.bench.pins & !bit };
    }

    /// Sends bytes from the terminal.
    pub fn send(&mut self, bytes: &[u8]) {
        self.bench.send(bytes);
    }

    /// Takes the text that the terminal has received since the last call.
    pub fn text(&mut self) -> String {
        String::from_utf8(std::mem::take(&mut self.bench.text)).expect("ASCII")
    }

    /// Executes cycles until the terminal has received a line, or this number of cycles; takes the
    /// text that it has received.
    pub fn run_until_said(&mut self, line: &str, clocks: u64) -> String {
        let limit = self.cycles() + clocks;
        while !self.bench.text.ends_with(line.as_bytes()) && self.cycles() < limit {
            self.run(1);
        }
        self.text()
    }

    /// Clocks in which the longest line is sent.
    pub fn longest_line(&self) -> u64 {
        let lengths = (0..=self.test.last_row()).map(|row| self.test.line(row, true).len() as u64);
        // A letter has ten bits and some clocks for the memory.
        lengths.max().unwrap_or(0) * (10 * u64::from(BIT_CLOCKS) + 3)
    }

    /// The rows of inputs.
    pub fn inputs(&self) -> std::ops::RangeInclusive<usize> {
        self.test.first_input()..=self.test.last_input()
    }

    /// Number of cycles in the session.
    pub fn cycles(&self) -> u64 {
        self.vectors.cycles()
    }

    /// The first cycle in which a pin of this Verilog differs from the recording.
    ///
    /// # Panics If Icarus is missing or rejects the Verilog.
    pub fn difference(&self, verilog: &str) -> Option<String> {
        self.vectors.difference(&self.top(), verilog).expect("Icarus")
    }

    /// Records the last cycle, or a cycle before the first edge of the clock.
    fn record(&mut self) {
        let (pins, shown) = (self.bench.pins, self.bench.outputs);
        let rows = self.gateware.rows();
        let mut inputs = Bits::default();
        let mut outputs = Bits::default();
        let first = self.test.first_input();
        for (name, way, width) in self.gateware.ports() {
            let bits = |mask: u64, ports: &[String], first| {
                (0..width)
                    .fold(0, |bits, bit| bits | port_level(mask, ports, first, name, bit) << bit)
            };
            match (name, way) {
                ("uart_rx", _) => inputs = inputs.and(1, u64::from(self.bench.rx)),
                ("uart_tx", _) => outputs = outputs.and(1, self.sent(shown)),
                ("led", _) => outputs = outputs.and(1, u64::from(shown.lit != self.board.led_low)),
                ("enable_n", _) => outputs = outputs.and(1, 1),
                (_, Way::Out) => {
                    outputs = outputs.and(width as u32, bits(shown.active, &rows.outputs, 1));
                }
                _ => inputs = inputs.and(width as u32, bits(pins, &rows.inputs, first)),
            }
        }
        outputs = self.board.ties.iter().fold(outputs, |all, tie| all.and(1, u64::from(tie.level)));
        if self.board.gate.is_some() {
            inputs = inputs.and(1, 1);
        }
        self.vectors.add(inputs, outputs);
    }

    /// The level of `uart_tx`, which is not compared while a gate holds it.
    fn sent(&self, shown: SelfTestOutputs) -> Option<u64> {
        let waits = self
            .board
            .gate
            .as_ref()
            .map_or(0, |gate| (1_u64 << (gate.counter_bits(self.gateware.clock_hz()) - 1)) + 4);
        (self.bench.clocks >= waits).then_some(u64::from(shown.tx))
    }
}

/// The level of a bit of a port in a mask of rows.
fn port_level(mask: u64, ports: &[String], first: usize, name: &str, bit: usize) -> u64 {
    let is_bit = |port: &&String| **port == format!("{name}[{bit}]") || **port == name;
    let place = ports.iter().position(|port| is_bit(&port)).expect("a row");
    mask >> (first + place) & 1
}

/// An empty recording of the pins of a board.
fn ports(board: &'static Board, gateware: &SelfTestGateware<'_>) -> Vectors {
    let side = |out: bool| {
        let ports = gateware.ports().into_iter();
        ports
            .filter(move |(_, way, _)| (*way == Way::Out) == out)
            .map(|(name, _, width)| (name, width as u32))
            .collect::<Vec<_>>()
    };
    let (mut inputs, mut outputs) = (side(false), side(true));
    outputs.extend(board.ties.iter().map(|tie| (tie.port.as_str(), 1)));
    inputs.extend(board.gate.iter().map(|gate| (gate.port.as_str(), 1)));
    let mut vectors = Vectors::new(inputs, outputs);
    vectors.clock = "oscillator";
    vectors
}

/// The Verilog with another value of a parameter of the self-test.
fn overridden(text: &str, name: &str, value: u32) -> String {
    let begin = format!(".{name}(");
    let (before, rest) = text.split_once(&begin).unwrap_or_else(|| panic!("no {name}"));
    let (_, after) = rest.split_once(')').expect("its end");
    format!("{before}{begin}32'd{value}){after}")
}
