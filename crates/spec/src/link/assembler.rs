//! Turns a program with names into what lies in the link machine's memories.

use super::machine::{Code, Condition, DOES, INDEXED, JUMPS, LAST, SETS, STORES, Source, TO_ANSWER, UNLESS, XOR};
use std::collections::BTreeMap;

/// Words of the program memory, and bytes of the data memory.
pub const SIZE: usize = 256;

/// What lies in the memories at configuration.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Image {
    /// The program.
    pub program: Vec<Code>,
    /// The data.
    pub data: Vec<u8>,
}

/// A program that is being written.
#[derive(Debug, Default)]
pub(super) struct Assembler {
    program: Vec<Code>,
    labels: BTreeMap<&'static str, usize>,
    jumps: Vec<(usize, &'static str)>,
    constants: BTreeMap<u8, u8>,
}

/// Constants lie from the top of the data memory downward.
const TOP: u8 = 0xff;

impl Assembler {
    /// The next instruction is called so.
    pub(super) fn label(&mut self, name: &'static str) {
        let before = self.labels.insert(name, self.program.len());
        assert!(before.is_none(), "two labels {name}");
    }

    /// Where a constant lies.
    fn constant(&mut self, value: u8) -> u8 {
        let next = TOP - self.constants.len() as u8;
        *self.constants.entry(value).or_insert(next)
    }

    /// A <= the byte at this address.
    pub(super) fn load(&mut self, address: u8) {
        self.program.push(SETS | Code::from(address));
    }

    /// A <= this number.
    pub(super) fn load_number(&mut self, number: u8) {
        let address = self.constant(number);
        self.load(address);
    }

    /// A <= what this says; `operand` is the byte of a word, or the number of a port.
    pub(super) fn load_from(&mut self, source: Source, operand: u8) {
        self.program.push(SETS | (source as Code) << 8 | Code::from(operand));
    }

    /// A <= A xor the byte at this address.
    pub(super) fn xor(&mut self, address: u8) {
        self.program.push(SETS | XOR | Code::from(address));
    }

    /// A <= A xor this number.
    pub(super) fn xor_number(&mut self, number: u8) {
        let address = self.constant(number);
        self.xor(address);
    }

    /// The byte at this address <= A.
    pub(super) fn store(&mut self, address: u8) {
        self.program.push(STORES | Code::from(address));
    }

    /// The byte at X <= A.
    pub(super) fn store_at_x(&mut self) {
        self.program.push(STORES | INDEXED);
    }

    /// Byte X of the answer <= A; the last one sends it.
    pub(super) fn answer(&mut self, last: bool) {
        self.program.push(STORES | TO_ANSWER | if last { LAST } else { 0 });
    }

    /// Does all of this.
    pub(super) fn does(&mut self, what: Code) {
        self.program.push(DOES | what);
    }

    /// Goes on there.
    pub(super) fn jump(&mut self, to: &'static str) {
        self.jump_if(Condition::Always, to);
    }

    /// Goes on there where the condition holds.
    pub(super) fn jump_if(&mut self, condition: Condition, to: &'static str) {
        self.jumps.push((self.program.len(), to));
        self.program.push(JUMPS | (condition as Code) << 8);
    }

    /// Goes on there where it does not.
    pub(super) fn jump_unless(&mut self, condition: Condition, to: &'static str) {
        self.jump_if(condition, to);
        if let Some(code) = self.program.last_mut() {
            *code |= UNLESS;
        }
    }

    /// The finished program; bytes at addresses below the constants' are as given, or 0.
    pub(super) fn finish(mut self) -> Image {
        for (at, label) in std::mem::take(&mut self.jumps) {
            self.program[at] |= self.labels[label] as Code;
        }
        eprintln!("{} instructions", self.program.len());
        self.program.truncate(SIZE);
        let mut data = vec![0; SIZE];
        for (&value, &address) in &self.constants {
            data[usize::from(address)] = value;
        }
        Image { program: self.program, data }
    }
}
