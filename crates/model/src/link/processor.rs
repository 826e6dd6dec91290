//! The processor of the link. It reads requests, executes them and writes answers; an instruction
//! takes three clocks or more. It must stay equal to docs/link.md in every clock.
//!
//! Its memories are synchronous: the word of an address is output one clock later. A word that is
//! written in the same clock is output with its old value.

mod alone;

pub use alone::Awaited;
pub(super) use alone::Waits;

use super::crc::{CrcUnit, Told};
use carrystep_core::engine::{CUT_WORD, EngineOutputs};
use carrystep_core::link::Image;
use carrystep_core::link::processor::{
    ACTS, AND, BROKEN, CAUSE, CLEARING, CONDITION, CONSTANTS, CONTROL, CRC_BEGIN, CRC_FEED,
    CRC_STEP, CULPRITS, Code, Condition, FOR_ROOM, GOES, HITS, INDEXED, INX, JUMPS, KICK, LATCH,
    PUTS, ROOM, SEEKING, SETS, STARTS, STORES, TARGET, TAX, UNLESS, ValueSource, WAIT, XOR,
};
use std::sync::Arc;

/// Number of entries in each byte memory and in the program.
const SIZE: usize = 512;

/// Number of words of a segment, the commit included.
const SEGMENT_WORDS: u8 = 8;

/// The bits of an instruction during which reports of room count.
const ROOM_WAIT: Code = WAIT | FOR_ROOM;

/// The room before any report: the greatest number of its field.
const MOST_ROOM: u8 = 31;

/// The clock of an instruction in which it is executed.
const EXECUTE: u8 = 2;

#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct LinkProcessor {
    program: Arc<[Code]>,
    data: [u8; SIZE],
    ring: [u8; SIZE],
    /// The outputs of the memories.
    code: Code,
    read: u8,
    received: u8,
    crc: CrcUnit,
    stage: u8,
    /// Index of the next instruction.
    pc: u16,
    a: u8,
    x: u8,
    /// Index in the ring at which the next byte is written.
    written: u16,
    /// Index in the ring from which the next byte is read.
    read_from: u16,
    /// Number of words of a segment that the engine has taken since the last commit.
    put: u8,
    /// The least room that axes have reported since the CRC register was initialised, in segments.
    room: u8,
    enable: bool,
    clear: bool,
}

/// The inputs in one clock.
pub(super) struct Inputs<'a> {
    /// The byte that is received in this clock.
    pub received: Option<u8>,
    /// The byte to the host is accepted.
    pub taken: bool,
    /// The word that a host reads at address X.
    pub fact: u32,
    pub engine: &'a EngineOutputs,
}

/// The outputs in one clock.
pub(super) struct Outputs {
    pub a: u8,
    pub x: u8,
    /// A word for an axis.
    pub word: u32,
    /// Its number.
    pub number: u8,
    pub puts: bool,
    pub starts: bool,
    /// A is offered to the transmitter.
    pub goes: bool,
    /// A is a new mask of the axes that seek.
    pub seeks: bool,
    /// A is a new source of seeks.
    pub sources: bool,
    /// The latch is armed, or those of several latches that A names.
    pub arms: bool,
    pub kicks: bool,
    pub broken: bool,
    /// A snapshot is requested.
    pub snapshot: bool,
    /// A cut is requested.
    pub cuts: bool,
    pub clear: bool,
    pub stop: bool,
    pub enable: bool,
}

impl LinkProcessor {
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
            crc: CrcUnit::default(),
            stage: 0,
            pc: 0,
            a: 0,
            x: 0,
            written: 0,
            read_from: 0,
            put: 0,
            room: 0,
            enable: false,
            clear: false,
        }
    }

    /// True if an instruction that contains one of these bits is executed in this clock.
    #[inline]
    fn executes(&self, bit: Code) -> bool {
        self.stage == EXECUTE && self.code & bit != 0
    }

    /// True if an instruction that neither sets nor stores nor jumps is executed in this clock and
    /// contains all of these bits.
    #[inline]
    fn does(&self, bits: Code) -> bool {
        let acts = self.executes(ACTS) && self.code & (SETS | STORES | JUMPS) == 0;
        acts && self.code & bits == bits
    }

    /// True if a word that is offered belongs to a segment.
    const fn is_segment(&self) -> bool {
        self.a & 8 != 0
    }

    /// True if reports of room count in this clock.
    #[inline]
    fn asks_room(&self) -> bool {
        self.code & (SETS | STORES | JUMPS) == 0 && self.code & ROOM_WAIT == ROOM_WAIT
    }

    /// The axis whose room is requested.
    pub(super) const fn room_of(&self) -> u8 {
        self.a & 7
    }

    #[inline]
    pub(super) fn outputs(&self) -> Outputs {
        let Self { a, x, clear, enable, .. } = *self;
        Outputs {
            a,
            x,
            word: self.crc.word(),
            number: if self.is_segment() { self.put } else { CUT_WORD },
            puts: self.does(PUTS),
            starts: self.does(STARTS),
            goes: self.does(WAIT | GOES),
            seeks: self.tells(CONTROL | KICK),
            sources: self.tells(CONTROL | KICK | BROKEN),
            arms: self.tells(KICK) && self.code & CLEARING != 0,
            kicks: self.tells(KICK),
            broken: self.tells(BROKEN),
            snapshot: self.tells(CONTROL | BROKEN) && self.code & CLEARING == 0,
            cuts: self.tells(CONTROL | BROKEN) && self.code & CLEARING != 0,
            clear,
            stop: self.tells(KICK | BROKEN),
            enable,
        }
    }

    /// True if an instruction is executed that contains these and no others of three bits, each
    /// combination of which has a meaning of its own.
    #[inline]
    fn tells(&self, bits: Code) -> bool {
        self.does(bits) && self.code & (CONTROL | KICK | BROKEN) == bits
    }

    pub(super) fn clock(&mut self, inputs: &Inputs<'_>) {
        let room = inputs.engine.room.filter(|_| self.asks_room());
        let begins = self.does(CRC_BEGIN);
        if self.stage == EXECUTE {
            self.execute(inputs);
        } else {
            self.read_memories();
            self.stage += 1;
        }
        if let Some(room) = room.filter(|&room| room < self.room) {
            self.room = room;
        } else if begins {
            self.room = MOST_ROOM;
        }
        if let Some(byte) = inputs.received {
            self.ring[usize::from(self.written)] = byte;
            self.written = after(self.written);
        }
    }

    /// The address in the data memory that the instruction has.
    fn place(&self) -> usize {
        let page = usize::from(self.code & CONSTANTS) >> 1;
        page + usize::from(if self.code & INDEXED != 0 { self.x } else { self.code as u8 })
    }

    /// The memories output the words of their addresses.
    fn read_memories(&mut self) {
        self.read = self.data[self.place()];
        self.code = self.program[usize::from(self.pc)];
        self.received = self.ring[usize::from(self.read_from)];
    }

    /// The last clock of an instruction, or one in which it waits.
    fn execute(&mut self, inputs: &Inputs<'_>) {
        let Self { code, a, x, .. } = *self;
        let place = self.place();
        let over = self.is_over(inputs);
        let told = self.tells_check(inputs.fact);
        let next_pc = if code & JUMPS != 0 && self.holds(inputs.engine) != (code & UNLESS != 0) {
            code & TARGET
        } else {
            after(self.pc)
        };
        let sets = code & SETS != 0;
        let value = if sets { self.value(inputs.engine) } else { 0 };
        let stores = code & STORES != 0 && !sets;
        let acts = code & ACTS != 0 && code & JUMPS == 0;
        let controls = self.tells(CONTROL);
        let puts = self.does(PUTS) && over && self.is_segment();

        // The memories are read before this clock writes to them.
        self.read_memories();
        self.crc.clock(told);
        if over {
            (self.stage, self.pc) = (0, next_pc);
        }
        if sets {
            self.a = match (code & AND != 0, code & XOR != 0) {
                (false, false) => value,
                (false, true) => a ^ value,
                (true, _) => a & value,
            };
        }
        if sets && code >> 8 & 7 == ValueSource::Received as Code {
            self.read_from = after(self.read_from);
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
            self.enable = a & 1 == 1;
            self.clear = code & CLEARING != 0;
        }
        if puts {
            self.put = (self.put + 1) % SEGMENT_WORDS;
        }
    }

    /// True if the instruction that is being executed ends in this clock.
    fn is_over(&self, inputs: &Inputs<'_>) -> bool {
        let waited = if self.code & STARTS != 0 {
            inputs.engine.start_ready || inputs.engine.fault.is_some()
        } else if self.code & GOES != 0 {
            inputs.taken
        } else if self.code & PUTS != 0 {
            inputs.engine.put_ready || inputs.engine.fault.is_some()
        } else {
            inputs.engine.refreshed || (self.code & FOR_ROOM != 0 && inputs.engine.room.is_some())
        };
        (!self.does(WAIT) || waited) && (!self.does(CRC_STEP) || self.crc.over())
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

    /// True if the condition of a jump holds.
    fn holds(&self, engine: &EngineOutputs) -> bool {
        match self.code >> CONDITION & 7 {
            c if c == Condition::Zero as Code => self.a == 0,
            c if c == Condition::X7 as Code => self.x & 0x80 != 0,
            c if c == Condition::Full as Code => self.x >= 0xf0,
            c if c == Condition::Nothing as Code => self.read_from == self.written,
            c if c == Condition::Fault as Code => engine.fault.is_some(),
            c if c == Condition::Commit as Code => self.put == SEGMENT_WORDS - 1,
            c if c == Condition::Special as Code => self.a >= 0xc0,
            _ => true,
        }
    }

    /// The value that A would take.
    fn value(&self, engine: &EngineOutputs) -> u8 {
        match self.code >> 8 & 7 {
            s if s == ValueSource::Received as Code => self.received,
            s if s == ValueSource::X as Code => self.x,
            s if s == ValueSource::Crc as Code => self.crc.word() as u8,
            s if s == ValueSource::Engine as Code => self.item(engine),
            _ => self.read,
        }
    }

    /// The item of the engine that the operand selects.
    fn item(&self, engine: &EngineOutputs) -> u8 {
        let (cause, culprits) =
            engine.fault.map_or((0, 0), |(cause, culprits)| (cause as u8, culprits));
        match self.code as u8 & 7 {
            ROOM => self.room,
            CAUSE => cause,
            CULPRITS => culprits,
            SEEKING => engine.seeking,
            HITS => engine.hits,
            LATCH => (engine.latch_armed & 1) << 4 | engine.latch_edges[0],
            _ => {
                let bits = [
                    (engine.fault.is_some(), 0),
                    (engine.ready, 1),
                    (engine.armed, 2),
                    (engine.cut_refused, 4),
                    (engine.idle, 6),
                    (engine.halted, 7),
                ];
                bits.iter().fold(0, |state, &(bit, at)| state | u8::from(bit) << at)
            }
        }
    }
}

/// The next index in a memory.
const fn after(index: u16) -> u16 {
    (index + 1) % SIZE as u16
}
