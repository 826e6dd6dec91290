//! A bench with link and engine, and a host at the other end of the line. The link is Rust-HDL's
//! module, and its model runs in lock-step with it. The engine is a model, because a bench with
//! Rust-HDL's engine takes six times as long; rung 4 compares these two in every clock. A bench in
//! which the link, too, is only a model is the fastest.

mod board;
mod frames;
mod host;
mod hosts;
mod ports;

pub use board::BoardPins;
pub use frames::{Said, on_the_line, owners_read, read, summed, unframe, wide, write};
pub use host::Host;
pub use ports::Both;

use hosts::SpiHost;
pub(crate) use hosts::{Receiver, Sender};

use carrystep_core::EngineBuild;
use carrystep_core::engine::{EngineInputs, EngineOutputs};
use carrystep_core::link::{END, LineKind, LinkInputs, LinkOutputs, Uart};
use carrystep_hdl::{AnyLink, EngineSim, LinkSim, SpiSim, link};
use carrystep_model::{Engine, Link};
use std::collections::VecDeque;

/// Both modules, the line and the host's end of it.
pub struct LinkBench {
    wire: Wire,
    engine: AnyEngine,
    /// Bytes that are still to be sent.
    bytes: VecDeque<u8>,
    /// Inputs from the switches.
    pub pins: EngineInputs,
    /// The outputs of the engine in the last cycle.
    pub outputs: EngineOutputs,
    /// Number of cycles so far.
    pub clocks: u64,
    /// Rising edges of STEP so far, of all axes.
    pub steps: u64,
    /// The recorded inputs and outputs of link and line, if they are recorded.
    pub vectors: Option<Both>,
    /// The recorded pins of a board, if they are recorded.
    pub board: Option<BoardPins>,
}

/// The link with its line, and the host's end of that line.
enum Wire {
    Uart { link: LinkSim, model: Link, sender: Sender, receiver: Receiver },
    Spi { link: Box<dyn AnyLink>, line: SpiSim, model: Link, host: SpiHost },
    Model { model: Box<Link>, sender: Sender, receiver: Receiver },
}

/// The engine, in Rust-HDL or as a model.
enum AnyEngine {
    RustHdl(EngineSim),
    Model(Box<Engine>),
}

impl LinkBench {
    /// Link and engine at configuration, connected by a UART that is idle.
    pub fn uart(build: &EngineBuild, uart: Uart) -> Self {
        let bit_clocks = uart.bit_clocks();
        let link = LinkSim::new(build, uart).expect("a link");
        let (sender, receiver) = (Sender::new(bit_clocks), Receiver::new(bit_clocks));
        Self::new(build, Wire::Uart { link, model: Link::new(build, uart), sender, receiver })
    }

    /// The same with the engine, too, as Rust-HDL's module.
    pub fn rust_hdl(build: &EngineBuild, uart: Uart) -> Self {
        let engine = AnyEngine::RustHdl(EngineSim::new(build).expect("an engine"));
        Self { engine, ..Self::uart(build, uart) }
    }

    /// The same over SPI; `tenths` is half a period of SCK in tenths of a clock.
    pub fn spi(build: &EngineBuild, tenths: u32) -> Self {
        let mut link = link(build, LineKind::Spi.build_id(build)).expect("a link");
        link.connect_all();
        let model = Link::new(build, LineKind::Spi);
        Self::new(
            build,
            Wire::Spi {
                link,
                line: SpiSim::new().expect("a line"),
                model,
                host: SpiHost::new(tenths),
            },
        )
    }

    /// The models of link and engine, connected by a UART.
    pub fn models(build: &EngineBuild, uart: Uart) -> Self {
        let bit_clocks = uart.bit_clocks();
        let (sender, receiver) = (Sender::new(bit_clocks), Receiver::new(bit_clocks));
        let model = Box::new(Link::new(build, uart));
        Self::new(build, Wire::Model { model, sender, receiver })
    }

    fn new(build: &EngineBuild, wire: Wire) -> Self {
        Self {
            wire,
            engine: AnyEngine::Model(Box::new(Engine::new(build))),
            bytes: VecDeque::new(),
            pins: EngineInputs::default(),
            outputs: EngineOutputs::default(),
            clocks: 0,
            steps: 0,
            vectors: None,
            board: None,
        }
    }

    /// Appends bytes to those that are to be sent.
    pub fn send(&mut self, bytes: &[u8]) {
        self.bytes.extend(bytes);
    }

    /// True if all bytes are sent.
    pub fn has_sent(&self) -> bool {
        let busy = match &self.wire {
            Wire::Uart { sender, .. } | Wire::Model { sender, .. } => sender.left > 0,
            Wire::Spi { host, .. } => host.sends.is_some_and(|byte| byte != END),
        };
        self.bytes.is_empty() && !busy
    }

    /// Executes one cycle and returns the byte that the host has received in it.
    pub fn clock(&mut self) -> Option<u8> {
        let mut seen = LinkInputs::default();
        match &mut self.wire {
            Wire::Uart { sender, .. } | Wire::Model { sender, .. } => {
                seen.rx = sender.clock(&mut self.bytes);
            }
            Wire::Spi { host, .. } => {
                host.clock(&mut self.bytes);
                let [sck, select_n, mosi] = host.pins();
                (seen.spi, seen.rx) = ([sck, select_n], mosi);
            }
        }
        let asked = self.wire.settle(&seen).0;
        let told = asked.engine.with_pins(&self.pins);
        let outputs = match &mut self.engine {
            AnyEngine::RustHdl(engine) => engine.settle(&told),
            AnyEngine::Model(engine) => engine.outputs(&told),
        };
        let before = std::mem::replace(&mut self.outputs, outputs).step;
        self.steps += u64::from((self.outputs.step & !before).count_ones());
        seen.engine = self.outputs;
        let (shown, level) = self.wire.settle(&seen);
        if let Some(both) = &mut self.vectors {
            self.wire.keep(&seen, &shown, level, both);
        }
        if let Some(board) = &mut self.board {
            board.add(seen.rx, &self.pins, shown.tx, &self.outputs);
        }
        let byte = self.wire.clock(&seen, &shown, level, self.clocks);
        match &mut self.engine {
            AnyEngine::RustHdl(engine) => engine.clock(),
            AnyEngine::Model(engine) => engine.clock(&told),
        }
        self.clocks += 1;
        byte
    }

    /// Executes cycles in which the host must receive nothing.
    pub fn rest(&mut self, clocks: u64) {
        for _ in 0..clocks {
            let byte = self.clock();
            assert_eq!(byte, None, "an answer that nobody asked for");
        }
    }

    /// The bytes of the next answer between its ENDs; `None` if it does not come within this many
    /// cycles.
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
            Self::Spi { link, line, host, .. } => {
                let (line, miso) = line.settle(host.pins(), link.offered());
                (LinkOutputs { tx: miso, ..link.settle(seen, line) }, miso)
            }
            Self::Model { model, .. } => {
                let shown = model.outputs();
                (shown, shown.tx)
            }
        }
    }

    /// Records the inputs and outputs of the modules in the present cycle.
    fn keep(&self, seen: &LinkInputs, shown: &LinkOutputs, level: bool, both: &mut Both) {
        let (bytes, offered) = match self {
            Self::Uart { link, .. } => link.bytes(),
            Self::Spi { link, line, .. } => (line.last(), link.offered()),
            Self::Model { .. } => return,
        };
        match self {
            Self::Uart { .. } => {
                both.add(seen, shown, (bytes, offered), &[("rx", seen.rx), ("tx", level)]);
            }
            Self::Spi { host, .. } => {
                let [sck, select_n, mosi] = host.pins();
                let pins = [("sck", sck), ("select_n", select_n), ("mosi", mosi), ("miso", level)];
                both.add(seen, shown, (bytes, offered), &pins);
            }
            Self::Model { .. } => {}
        }
    }

    /// Advances by one cycle and returns the byte that the host has received.
    fn clock(
        &mut self,
        seen: &LinkInputs,
        shown: &LinkOutputs,
        level: bool,
        clocks: u64,
    ) -> Option<u8> {
        match self {
            Self::Uart { link, model, receiver, .. } => {
                assert_eq!(model.outputs(), *shown, "cycle {clocks}: model and Rust-HDL");
                model.clock(seen);
                link.clock();
                receiver.clock(level)
            }
            Self::Spi { link, line, model, host } => {
                assert_eq!(model.outputs(), *shown, "cycle {clocks}: model and Rust-HDL");
                model.clock(seen);
                link.clock();
                line.clock();
                host.look(level)
            }
            Self::Model { model, receiver, .. } => {
                model.clock(seen);
                receiver.clock(level)
            }
        }
    }
}
