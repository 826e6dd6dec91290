//! The machine that reads requests, does what they ask for and writes answers: three clocks an instruction.
//!
//! Its memories give in a clock what they were asked for in the one before, and the old value of a word that was written then.

use super::check::{Check, Told};
use carrystep_core::engine::EngineOutputs;
use carrystep_core::link::Image;
use carrystep_core::link::machine::{
    ACTS, BROKEN, CLEARING, CONTROL, CRC_BEGIN, CRC_FEED, CRC_STEP, CULPRITS, Code, Condition, FOR_ROOM, GOES, HOMING,
    INDEXED, INX, JUMPS, KICK, PUTS, ROOM, SETS, STARTS, STORES, Source, TAX, UNLESS, WAIT, XOR,
};
use carrystep_core::link::registers::{CONTROL_ENABLE, CONTROL_STOP};
use std::sync::Arc;

/// Words of each memory of bytes, and of the program.
const SIZE: usize = 256;

/// The clock of an instruction in which it does what it does.
const EXECUTE: u8 = 2;

#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Machine {
    program: Arc<[Code]>,
    data: [u8; SIZE],
    ring: [u8; SIZE],
    /// What the memories give.
    code: Code,
    read: u8,
    received: u8,
    check: Check,
    stage: u8,
    pc: u8,
    a: u8,
    x: u8,
    /// Where the ring is written next,
    written: u8,
    /// and where it is read.
    read_from: u8,
    /// What an axis has last said of its room.
    room: u8,
    control: u8,
    clear: bool,
}

/// What goes in, in a clock.
pub(super) struct Inputs<'a> {
    /// A byte has come.
    pub received: Option<u8>,
    /// The byte that goes is taken.
    pub taken: bool,
    /// The fact at X.
    pub fact: u32,
    /// All items of all axes were asked for.
    pub scanned: bool,
    pub engine: &'a EngineOutputs,
}

/// What comes out.
pub(super) struct Outputs {
    pub a: u8,
    pub x: u8,
    /// The word of a segment.
    pub word: u32,
    pub puts: bool,
    pub starts: bool,
    /// A goes to the host.
    pub goes: bool,
    pub homes: bool,
    pub kicks: bool,
    pub broken: bool,
    pub clear: bool,
    pub stop: bool,
    pub enable: bool,
}

/// What it waits for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Waits {
    /// Nothing, or the engine.
    No,
    /// A byte.
    ForByte,
    /// The transmitter.
    ToSend,
}

impl Machine {
    pub(super) fn new(image: &Image) -> Self {
        let mut program = vec![0; SIZE];
        program[..image.program.len()].copy_from_slice(&image.program);
        let mut data = [0; SIZE];
        data[..image.data.len()].copy_from_slice(&image.data);
        Self {
            program: program.into(),
            data,
            ring: [0; SIZE],
            code: 0,
            read: 0,
            received: 0,
            check: Check::default(),
            stage: 0,
            pc: 0,
            a: 0,
            x: 0,
            written: 0,
            read_from: 0,
            room: 0,
            control: 0,
            clear: false,
        }
    }

    /// An instruction with this bit does what it does.
    fn executes(&self, bit: Code) -> bool {
        self.stage == EXECUTE && self.code & bit != 0
    }

    /// Does what these bits of an instruction say that neither sets nor stores.
    fn does(&self, bits: Code) -> bool {
        self.executes(ACTS) && self.code & (SETS | STORES) == 0 && self.code & bits == bits
    }

    pub(super) fn outputs(&self) -> Outputs {
        let Self { a, x, clear, control, .. } = *self;
        let control = u32::from(control);
        Outputs {
            a,
            x,
            word: self.check.word(),
            puts: self.does(PUTS),
            starts: self.does(STARTS),
            goes: self.does(WAIT | GOES),
            homes: self.does(CONTROL | KICK),
            kicks: self.does(KICK) && !self.does(CONTROL),
            broken: self.does(BROKEN),
            clear,
            stop: control & CONTROL_STOP != 0,
            enable: control & CONTROL_ENABLE != 0,
        }
    }

    pub(super) fn clock(&mut self, inputs: &Inputs<'_>) {
        let Self { code, a, x, .. } = *self;
        let place = usize::from(if code & INDEXED != 0 { x } else { code as u8 });
        let over = self.is_over(inputs);
        let told = self.tells_check(inputs.fact);
        let next_pc = if code & JUMPS != 0 && self.holds(inputs.engine) != (code & UNLESS != 0) {
            code as u8
        } else {
            self.pc.wrapping_add(1)
        };
        let value = self.value(inputs.engine);
        let [sets, stores, acts] = [SETS, STORES, ACTS].map(|bit| self.executes(bit));
        let controls = self.does(CONTROL) && code & KICK == 0;

        // The memories, before anything of this clock is written.
        self.code = self.program[usize::from(self.pc)];
        self.read = self.data[place];
        self.received = self.ring[usize::from(self.read_from)];

        self.check.clock(told);
        if self.stage != EXECUTE {
            self.stage += 1;
        } else if over {
            (self.stage, self.pc) = (0, next_pc);
        }
        if sets {
            self.a = if code & XOR != 0 { a ^ value } else { value };
        }
        if sets && code >> 8 & 7 == Source::Received as Code {
            self.read_from = self.read_from.wrapping_add(1);
        }
        if stores {
            self.data[place] = a;
        }
        if acts && code & TAX != 0 {
            self.x = a;
        }
        if acts && code & INX != 0 && over {
            self.x = x.wrapping_add(1);
        }
        if controls {
            self.control = a & 3;
            self.clear = code & CLEARING != 0;
        }
        if let Some(room) = inputs.engine.room {
            self.room = room;
        }
        if let Some(byte) = inputs.received {
            self.ring[usize::from(self.written)] = byte;
            self.written = self.written.wrapping_add(1);
        }
    }

    /// The instruction that executes is over in this clock.
    fn is_over(&self, inputs: &Inputs<'_>) -> bool {
        let waited = if self.code & STARTS != 0 {
            inputs.engine.start_ready || inputs.engine.fault.is_some()
        } else if self.code & GOES != 0 {
            inputs.taken
        } else if self.code & PUTS != 0 {
            inputs.engine.put_ready || inputs.engine.fault.is_some()
        } else {
            inputs.scanned || (self.code & FOR_ROOM != 0 && inputs.engine.room.is_some())
        };
        (!self.does(WAIT) || waited) && (!self.does(CRC_STEP) || self.check.over())
    }

    fn tells_check(&self, fact: u32) -> Told {
        let feed = self.code & CRC_FEED != 0;
        match (self.does(CRC_BEGIN), self.does(CRC_STEP)) {
            (true, _) => Told::Begin(if feed { fact } else { u32::MAX }),
            (false, true) if feed => Told::Feed(self.a),
            (false, true) => Told::Shift(self.a),
            (false, false) => Told::Nothing,
        }
    }

    /// Whether the condition of a jump holds.
    fn holds(&self, engine: &EngineOutputs) -> bool {
        match self.code >> 8 & 7 {
            c if c == Condition::Zero as Code => self.a == 0,
            c if c == Condition::X7 as Code => self.x & 0x80 != 0,
            c if c == Condition::X6 as Code => self.x & 0x40 != 0,
            c if c == Condition::Nothing as Code => self.read_from == self.written,
            c if c == Condition::Fault as Code => engine.fault.is_some(),
            c if c == Condition::Startable as Code => engine.ready && !engine.armed,
            c if c == Condition::Special as Code => self.a >= 0xc0,
            _ => true,
        }
    }

    /// What A would take.
    fn value(&self, engine: &EngineOutputs) -> u8 {
        match self.code >> 8 & 7 {
            s if s == Source::Data as Code || s == Source::DataAtX as Code => self.read,
            s if s == Source::Received as Code => self.received,
            s if s == Source::X as Code => self.x,
            s if s == Source::Crc as Code => self.check.word() as u8,
            _ => match self.code as u8 & 3 {
                ROOM => self.room,
                CULPRITS => engine.fault.map_or(0, |(_, culprits)| culprits),
                HOMING => engine.homing,
                _ => {
                    let cause = engine.fault.map_or(0, |(cause, _)| cause as u8);
                    let bits = [engine.fault.is_some(), engine.halted, engine.idle, engine.ready, engine.armed];
                    bits.iter().rev().fold(cause, |state, &bit| state << 1 | u8::from(bit))
                }
            },
        }
    }

    /// What it does in this clock depends on what the engine says, or tells it something.
    pub(super) fn minds_the_engine(&self) -> bool {
        const TELLS: Code = PUTS | STARTS | BROKEN | KICK | CONTROL;
        let acts = self.does(0) && self.code & TELLS != 0;
        let waits = self.does(WAIT) && !self.does(GOES);
        let reads = self.executes(SETS) && self.code >> 8 & 7 == Source::Engine as Code;
        let asks = self.executes(JUMPS)
            && [Condition::Fault, Condition::Startable].iter().any(|&asked| self.code >> 8 & 7 == asked as Code);
        acts || waits || reads || asks
    }

    pub(super) fn waits(&self) -> Waits {
        let polls = JUMPS | (Condition::Nothing as Code) << 8 | Code::from(self.pc);
        if self.code == polls && self.read_from == self.written {
            Waits::ForByte
        } else if self.does(WAIT | GOES) {
            Waits::ToSend
        } else {
            Waits::No
        }
    }

    /// So many clocks have passed in which it waited.
    pub(super) fn pass(&mut self, clocks: u64) {
        if self.waits() == Waits::ForByte {
            self.stage = ((u64::from(self.stage) + clocks) % 3) as u8;
        }
    }
}
