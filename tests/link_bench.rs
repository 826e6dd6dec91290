//! The link and the engine together, with a host at the other end of the line: Rust-HDL's modules of both, the model of the
//! link in lock-step.

use carrystep_hdl::{AnyLink, EngineSim, LinkSim, SpiSim, link};
use carrystep_model::Link;
use carrystep_spec::EngineBuild;
use carrystep_spec::engine::{CAUSES, Cause, EngineInputs, EngineOutputs};
use carrystep_spec::link::{END, ESC, ESC_END, ESC_ESC, Line, LinkInputs, LinkOutputs, Uart};
use std::collections::VecDeque;

/// Both modules, the line between them and the test.
pub struct LinkBench {
    wire: Wire,
    engine: EngineSim,
    /// Bytes to be sent.
    bytes: VecDeque<u8>,
    /// The pins of switches.
    pub pins: EngineInputs,
    /// What the engine showed last.
    pub outputs: EngineOutputs,
    /// Cycles so far.
    pub clocks: u64,
    /// Rising edges of STEP so far, of all axes.
    pub steps: u64,
}

/// The link with its line, and the host's end of that.
#[expect(clippy::large_enum_variant, reason = "there is one of them")]
enum Wire {
    Uart { link: LinkSim, model: Link, sender: Sender, receiver: Receiver },
    Spi { link: Box<dyn AnyLink>, line: SpiSim, host: SpiHost },
}

impl LinkBench {
    /// Both as they are configured, the line at rest.
    pub fn uart(build: &EngineBuild, uart: Uart) -> Self {
        let bit_clocks = uart.bit_clocks();
        let link = LinkSim::new(build, uart).expect("a link");
        let (sender, receiver) = (Sender::new(bit_clocks), Receiver::new(bit_clocks));
        Self::new(build, Wire::Uart { link, model: Link::new(build, uart), sender, receiver })
    }

    /// The same over SPI, SCK's half period in tenths of a clock.
    pub fn spi(build: &EngineBuild, tenths: u32) -> Self {
        let mut link = link(build, Line::Spi.build_id(build)).expect("a link");
        link.connect_all();
        Self::new(build, Wire::Spi { link, line: SpiSim::new().expect("a line"), host: SpiHost::new(tenths) })
    }

    fn new(build: &EngineBuild, wire: Wire) -> Self {
        Self {
            wire,
            engine: EngineSim::new(build).expect("an engine"),
            bytes: VecDeque::new(),
            pins: EngineInputs::default(),
            outputs: EngineOutputs::default(),
            clocks: 0,
            steps: 0,
        }
    }

    /// Bytes that are to be sent.
    pub fn send(&mut self, bytes: &[u8]) {
        self.bytes.extend(bytes);
    }

    /// All bytes are sent.
    pub fn has_sent(&self) -> bool {
        let busy = match &self.wire {
            Wire::Uart { sender, .. } => sender.left > 0,
            Wire::Spi { host, .. } => host.sends.is_some_and(|byte| byte != END),
        };
        self.bytes.is_empty() && !busy
    }

    /// One cycle; a byte that has come.
    pub fn clock(&mut self) -> Option<u8> {
        let mut seen = LinkInputs::default();
        match &mut self.wire {
            Wire::Uart { sender, .. } => seen.rx = sender.clock(&mut self.bytes),
            Wire::Spi { host, .. } => host.clock(&mut self.bytes),
        }
        let asked = self.wire.settle(&seen).0;
        let EngineInputs { estop, limit_min, limit_max, .. } = self.pins;
        let told = EngineInputs { estop, limit_min, limit_max, ..asked.engine };
        let (axis, item) = (asked.get_axis.into(), asked.get_item.into());
        self.engine.get(axis, item);
        let before = std::mem::replace(&mut self.outputs, self.engine.settle(&told)).step;
        self.steps += u64::from((self.outputs.step & !before).count_ones());
        seen.engine = self.outputs;
        seen.get_valid = self.engine.get(axis, item).is_some();
        seen.get_data = self.engine.latched();
        let (shown, level) = self.wire.settle(&seen);
        let byte = self.wire.clock(&seen, &shown, level, self.clocks);
        self.engine.clock();
        self.clocks += 1;
        byte
    }

    /// So many cycles in which nothing comes.
    pub fn rest(&mut self, clocks: u64) {
        for _ in 0..clocks {
            let byte = self.clock();
            assert_eq!(byte, None, "an answer that nobody asked for");
        }
    }

    /// The bytes of the next answer between its ENDs, within so many cycles.
    pub fn answer(&mut self, within: u64) -> Option<Vec<u8>> {
        let mut frame = Vec::new();
        let end = self.clocks + within;
        while self.clocks < end {
            match self.clock() {
                Some(END) if frame.is_empty() => {}
                Some(END) => return Some(frame),
                Some(byte) => frame.push(byte),
                None => {}
            }
        }
        None
    }
}

impl Wire {
    /// The outputs of the present cycle, and the level of the line to the host.
    fn settle(&mut self, seen: &LinkInputs) -> (LinkOutputs, bool) {
        match self {
            Self::Uart { link, .. } => {
                let shown = link.settle(seen);
                (shown, shown.tx)
            }
            Self::Spi { link, line, host } => {
                let (line, miso) = line.settle(host.pins(), link.offered());
                (link.settle(seen, line), miso)
            }
        }
    }

    /// To the next cycle; a byte that has come.
    fn clock(&mut self, seen: &LinkInputs, shown: &LinkOutputs, level: bool, clocks: u64) -> Option<u8> {
        match self {
            Self::Uart { link, model, receiver, .. } => {
                assert_eq!(model.outputs(), *shown, "cycle {clocks}: model and Rust-HDL");
                model.clock(seen);
                link.clock();
                receiver.clock(level)
            }
            Self::Spi { link, line, host } => {
                link.clock();
                line.clock();
                host.look(level)
            }
        }
    }
}

/// A whole request.
pub fn frame(sequence: u8, address: u8, words: &[u32]) -> Vec<u8> {
    let head = [sequence, address];
    let words = words.iter().flat_map(|word| word.to_le_bytes());
    let frame: Vec<u8> = head.into_iter().chain(words).collect();
    let sum = crc(&frame).to_le_bytes();
    [frame, sum.to_vec()].concat()
}

/// A frame between ENDs, escaped.
pub fn on_the_line(frame: &[u8]) -> Vec<u8> {
    let escaped = frame.iter().flat_map(|&byte| match byte {
        END => vec![ESC, ESC_END],
        ESC => vec![ESC, ESC_ESC],
        _ => vec![byte],
    });
    std::iter::once(END).chain(escaped).chain([END]).collect()
}

/// A frame without its escapes and its CRC, which is right.
pub fn unframe(line: &[u8]) -> Option<Vec<u8>> {
    let mut frame = Vec::new();
    let mut bytes = line.iter();
    while let Some(&byte) = bytes.next() {
        frame.push(match byte {
            ESC => match bytes.next()? {
                &ESC_END => END,
                &ESC_ESC => ESC,
                _ => return None,
            },
            END => return None,
            byte => byte,
        });
    }
    let sum = frame.split_off(frame.len().checked_sub(4)?);
    (crc(&frame).to_le_bytes()[..] == sum).then_some(frame)
}

/// CRC-32 bit by bit.
fn crc(bytes: &[u8]) -> u32 {
    let shift = |sum: u32| sum >> 1 ^ if sum & 1 == 1 { 0xedb8_8320 } else { 0 };
    !bytes.iter().fold(u32::MAX, |sum, byte| (0..8).fold(sum ^ u32::from(*byte), |sum, _| shift(sum)))
}

/// An answer, its fields apart: written from the page, not from the table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs, reason = "docs/protocol.md, \"The answer\"")]
pub struct Said {
    pub sequence: u8,
    pub address: u8,
    pub next: u8,
    pub fault: Option<Cause>,
    pub halted: bool,
    pub idle: bool,
    pub ready: bool,
    pub armed: bool,
    pub free: u8,
    pub refused: bool,
    pub culprits: u8,
    pub homing: u8,
    pub data: u32,
}

impl Said {
    /// The answer in this frame without its CRC.
    pub fn of(frame: &[u8]) -> Self {
        let &[sequence, address, next, state, room, culprits, homing, a, b, c, d] = frame else {
            panic!("{frame:02x?} is not as long as an answer")
        };
        let bit = |bit: u8| state >> bit & 1 == 1;
        let cause = CAUSES[usize::from(state >> 5)];
        assert!(bit(0) || state >> 5 == 0, "a cause without a fault");
        Self {
            sequence,
            address,
            next,
            fault: bit(0).then_some(cause),
            halted: bit(1),
            idle: bit(2),
            ready: bit(3),
            armed: bit(4),
            free: room & 7,
            refused: room & 8 != 0,
            culprits,
            homing,
            data: u32::from_le_bytes([a, b, c, d]),
        }
    }
}

/// The host's transmitter.
struct Sender {
    bit_clocks: u32,
    /// Bits of the present byte, the next one lowest: start, eight, stop.
    bits: u32,
    /// Clocks that they take yet.
    left: u32,
}

impl Sender {
    fn new(bit_clocks: u32) -> Self {
        Self { bit_clocks, bits: 0, left: 0 }
    }

    /// The line in this cycle.
    fn clock(&mut self, bytes: &mut VecDeque<u8>) -> bool {
        if self.left == 0 {
            let Some(byte) = bytes.pop_front() else { return true };
            self.bits = 1 << 9 | u32::from(byte) << 1;
            self.left = 10 * self.bit_clocks;
        }
        let line = self.bits & 1 == 1;
        self.left -= 1;
        if self.left % self.bit_clocks == 0 {
            self.bits >>= 1;
        }
        line
    }
}

/// The host's receiver: looks at the middle of each bit.
struct Receiver {
    bit_clocks: u32,
    /// Clocks since the start bit began.
    since: Option<u32>,
    bits: u32,
}

impl Receiver {
    fn new(bit_clocks: u32) -> Self {
        Self { bit_clocks, since: None, bits: 0 }
    }

    /// One cycle of the line; a byte that is whole with it.
    fn clock(&mut self, line: bool) -> Option<u8> {
        let since = match self.since {
            None if line => return None,
            None => 0,
            Some(since) => since + 1,
        };
        self.since = Some(since);
        if since % self.bit_clocks == self.bit_clocks / 2 {
            self.bits = self.bits >> 1 | u32::from(line) << 9;
            if since / self.bit_clocks == 9 {
                self.since = None;
                assert!(line, "no stop bit");
                return Some((self.bits >> 1) as u8);
            }
        }
        None
    }
}

/// A host that speaks SPI all the time, mode 0: END where it has nothing to say. It lets go of select behind each seventh byte.
struct SpiHost {
    /// Half a period of SCK, and when its next edge is, in tenths of a clock from now.
    half: u32,
    due: u32,
    sends: Option<u8>,
    bit: u32,
    bytes: u32,
    rest: u32,
    sck: bool,
    rises: bool,
    comes: u8,
}

impl SpiHost {
    fn new(half: u32) -> Self {
        Self { half, due: 0, sends: None, bit: 0, bytes: 0, rest: 0, sck: false, rises: false, comes: 0 }
    }

    /// SCK, select (low), MOSI.
    fn pins(&self) -> [bool; 3] {
        let mosi = self.sends.is_some_and(|byte| byte << self.bit >> 7 == 1);
        [self.sck, self.sends.is_none(), mosi]
    }

    /// What the pins are in this cycle.
    fn clock(&mut self, bytes: &mut VecDeque<u8>) {
        self.rises = false;
        if self.rest > 0 {
            self.rest -= 1;
            return;
        }
        if self.sends.is_none() {
            self.sends = Some(bytes.pop_front().unwrap_or(END));
            (self.bit, self.due) = (0, self.half);
            return;
        }
        if self.due >= 10 {
            self.due -= 10;
            return;
        }
        self.due += self.half - 10;
        self.sck = !self.sck;
        self.rises = self.sck;
        if !self.sck {
            self.bit += 1;
        }
        if self.bit == 8 {
            self.bit = 0;
            self.bytes += 1;
            self.sends = if self.bytes % 7 == 0 { None } else { Some(bytes.pop_front().unwrap_or(END)) };
            self.rest = if self.sends.is_none() { 9 } else { 0 };
        }
    }

    /// Looks at MISO as SCK rises; a byte that is whole with it.
    fn look(&mut self, miso: bool) -> Option<u8> {
        if !self.rises {
            return None;
        }
        self.comes = self.comes << 1 | u8::from(miso);
        (self.bit == 7).then_some(self.comes)
    }
}
