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

/// What a port of the board shows, or is given.
enum Port {
    /// The line from the terminal.
    Heard,
    /// The line to the terminal.
    Sent,
    /// The light.
    Light,
    /// The drivers' power, which stays off.
    Power,
    /// Outputs: the row of each bit, from bit 0 on.
    Outputs(Vec<usize>),
    /// Inputs: the row of each bit, from bit 0 on.
    Inputs(Vec<usize>),
}

/// A board's self-test with short times, and a session with it.
pub struct SelfTestSession {
    board: &'static Board,
    gateware: SelfTestGateware<'static>,
    /// The self-test with these times.
    pub test: SelfTest,
    bench: SelfTestBench,
    ports: Vec<Port>,
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
        let (ports, vectors) = (ports(&gateware), recording(board, &gateware));
        let walk = Vec::new();
        let mut session = Self { board, gateware, test, bench, ports, vectors, walk, verilog };
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
        let (mut inputs, mut outputs) = (Bits::default(), Bits::default());
        let levels = |mask: u64, rows: &[usize]| {
            rows.iter().rev().fold(0, |bits, row| bits << 1 | mask >> row & 1)
        };
        for port in &self.ports {
            match port {
                Port::Heard => inputs = inputs.and(1, u64::from(self.bench.rx)),
                Port::Sent => outputs = outputs.and(1, self.sent(shown)),
                Port::Light => {
                    outputs = outputs.and(1, u64::from(shown.lit != self.board.led_low));
                }
                Port::Power => outputs = outputs.and(1, 1),
                Port::Outputs(rows) => {
                    outputs = outputs.and(rows.len() as u32, levels(shown.active, rows));
                }
                Port::Inputs(rows) => inputs = inputs.and(rows.len() as u32, levels(pins, rows)),
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

/// The ports of a board, in the order of its gateware.
fn ports(gateware: &SelfTestGateware<'_>) -> Vec<Port> {
    let rows = gateware.rows();
    let rows_of = |names: &[String], first: usize, name: &str, width: usize| {
        let row = |bit| {
            let bit_name = format!("{name}[{bit}]");
            let is_bit = |row: &String| *row == bit_name || row == name;
            first + names.iter().position(is_bit).expect("a row")
        };
        (0..width).map(row).collect()
    };
    let port = |(name, way, width)| match (name, way) {
        ("uart_rx", _) => Port::Heard,
        ("uart_tx", _) => Port::Sent,
        ("led", _) => Port::Light,
        ("enable_n", _) => Port::Power,
        (_, Way::Out) => Port::Outputs(rows_of(&rows.outputs, 1, name, width)),
        _ => Port::Inputs(rows_of(&rows.inputs, rows.test.first_input(), name, width)),
    };
    gateware.ports().into_iter().map(port).collect()
}

/// An empty recording of the pins of a board.
fn recording(board: &'static Board, gateware: &SelfTestGateware<'_>) -> Vectors {
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
