//! Assembles a program with labels and named constants into the contents of the link processor's
//! memories.

use super::processor::{
    ACTS, Code, Condition, GOES, INDEXED, INX, JUMPS, SETS, STORES, TAX, UNLESS, ValueSource, WAIT,
    XOR,
};
use alloc::collections::BTreeMap;
use alloc::vec;
use alloc::vec::Vec;

/// Size of the program memory in words, and of the data memory in bytes.
pub const SIZE: usize = 256;

/// The contents of the memories when the FPGA has been configured.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Image {
    /// The program memory.
    pub program: Vec<Code>,
    /// The data memory.
    pub data: Vec<u8>,
}

/// A program that is being assembled.
#[derive(Debug, Default)]
pub(super) struct Assembler {
    program: Vec<Code>,
    labels: BTreeMap<&'static str, usize>,
    jumps: Vec<(usize, &'static str)>,
    constants: BTreeMap<u8, u8>,
    table: [u8; 4],
}

/// Address of the four bytes that a loop compares. They lie at the top of the data memory, so that
/// bit 7 of X becomes 0 behind the last one.
const TABLE: u8 = 0xfc;
/// Address of the first constant; further constants follow downward.
const TOP: u8 = TABLE - 1;

impl Assembler {
    /// Defines a label for the next instruction.
    pub(super) fn label(&mut self, name: &'static str) {
        let before = self.labels.insert(name, self.program.len());
        assert!(before.is_none(), "two labels {name}");
    }

    /// The address of a constant; adds the constant if the memory does not hold it yet.
    fn constant(&mut self, value: u8) -> u8 {
        let next = TOP - self.constants.len() as u8;
        *self.constants.entry(value).or_insert(next)
    }

    /// X <= the address of these bytes, which reach to the end of the memory. Changes A.
    pub(super) fn index_table(&mut self, bytes: [u8; 4]) {
        self.table = bytes;
        self.load_number(TABLE);
        self.acts(TAX);
    }

    /// A <= the byte at this address.
    pub(super) fn load(&mut self, address: u8) {
        self.program.push(SETS | Code::from(address));
    }

    /// A <= this number, from a constant in the data memory.
    pub(super) fn load_number(&mut self, number: u8) {
        let address = self.constant(number);
        self.load(address);
    }

    /// A <= the value of this source. `operand` is the byte of a word, or an item of the engine.
    pub(super) fn load_from(&mut self, source: ValueSource, operand: u8) {
        self.program.push(SETS | (source as Code) << 8 | Code::from(operand));
    }

    /// A <= the byte at X, then X <= X + 1.
    pub(super) fn load_next(&mut self) {
        self.program.push(SETS | (ValueSource::DataAtX as Code) << 8 | ACTS | INX);
    }

    /// A <= X.
    pub(super) fn load_x(&mut self) {
        self.load_from(ValueSource::X, 0);
    }

    /// A <= A xor the byte at this address.
    pub(super) fn xor(&mut self, address: u8) {
        self.program.push(SETS | XOR | Code::from(address));
    }

    /// A <= A xor the byte at X.
    pub(super) fn xor_at_x(&mut self) {
        self.program.push(SETS | XOR | (ValueSource::DataAtX as Code) << 8);
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

    /// The byte at X <= A, then X <= X + 1.
    pub(super) fn store_next(&mut self) {
        self.program.push(STORES | INDEXED | ACTS | INX);
    }

    /// Sends A to the host.
    pub(super) fn send(&mut self) {
        self.acts(GOES | WAIT);
    }

    /// Performs all the actions whose bits are set.
    pub(super) fn acts(&mut self, what: Code) {
        self.program.push(ACTS | what);
    }

    /// Jumps to a label.
    pub(super) fn jump(&mut self, to: &'static str) {
        self.jump_if(Condition::Always, to);
    }

    /// Jumps to a label if the condition holds.
    pub(super) fn jump_if(&mut self, condition: Condition, to: &'static str) {
        self.jumps.push((self.program.len(), to));
        self.program.push(JUMPS | (condition as Code) << 8);
    }

    /// Jumps to a label if the condition does not hold.
    pub(super) fn jump_unless(&mut self, condition: Condition, to: &'static str) {
        self.jump_if(condition, to);
        if let Some(code) = self.program.last_mut() {
            *code |= UNLESS;
        }
    }

    /// Resolves the labels, and returns the finished memories.
    pub(super) fn finish(mut self) -> Image {
        for (at, label) in core::mem::take(&mut self.jumps) {
            self.program[at] |= self.labels[label] as Code;
        }
        assert!(self.program.len() <= SIZE, "{} instructions are too many", self.program.len());
        let mut data = vec![0; SIZE];
        for (&value, &address) in &self.constants {
            data[usize::from(address)] = value;
        }
        data[TABLE.into()..].copy_from_slice(&self.table);
        Image { program: self.program, data }
    }
}
