//! Assembles a program with labels and named constants into the contents of the link processor's
//! memories.

use super::processor::{
    ACTS, AND, CONDITION, Code, Condition, GOES, INDEXED, INX, JUMPS, SETS, STORES, TAX, UNLESS,
    ValueSource, WAIT, XOR,
};
use alloc::collections::BTreeMap;
use alloc::vec;
use alloc::vec::Vec;

/// Size of the program memory in words, and of the data memory in bytes.
pub const SIZE: usize = 512;
/// Address of the first constant in the data memory, and the number of constants.
const PAGE: usize = 256;

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
    /// Addresses of the single constants, by their values.
    constants: BTreeMap<u8, u8>,
    /// All constants, by their addresses.
    page: BTreeMap<u8, u8>,
}

impl Assembler {
    /// Defines a label for the next instruction.
    pub(in crate::link) fn label(&mut self, name: &'static str) {
        let before = self.labels.insert(name, self.program.len());
        assert!(before.is_none(), "two labels {name}");
    }

    /// Places these bytes among the constants, from this address on. Tables come before the code.
    pub(in crate::link) fn table(&mut self, at: u8, bytes: &[u8]) {
        for (address, &byte) in (at..=u8::MAX).zip(bytes) {
            let before = self.page.insert(address, byte);
            assert!(before.is_none_or(|before| before == byte), "two tables at {address:#04x}");
        }
    }

    /// The address of a constant; adds the constant if the memory does not hold it yet.
    fn constant(&mut self, value: u8) -> u8 {
        if let Some(&address) = self.constants.get(&value) {
            return address;
        }
        let free = (0..=u8::MAX).find(|address| !self.page.contains_key(address));
        let address = free.unwrap_or_else(|| panic!("too many constants"));
        self.page.insert(address, value);
        self.constants.insert(value, address);
        address
    }

    /// A <= the byte at this address.
    pub(in crate::link) fn load(&mut self, address: u8) {
        self.program.push(SETS | Code::from(address));
    }

    /// A <= this number.
    pub(in crate::link) fn load_number(&mut self, number: u8) {
        let address = self.constant(number);
        self.load_from(ValueSource::Constant, address);
    }

    /// X <= the byte at this address. Changes A.
    pub(in crate::link) fn index(&mut self, address: u8) {
        self.load(address);
        self.acts(TAX);
    }

    /// X <= this number. Changes A.
    pub(in crate::link) fn index_number(&mut self, number: u8) {
        self.load_number(number);
        self.acts(TAX);
    }

    /// The byte at this address <= this number. Changes A.
    pub(in crate::link) fn store_number(&mut self, address: u8, number: u8) {
        self.load_number(number);
        self.store(address);
    }

    /// The byte at this address <= X + 1, and X as well. Changes A.
    pub(in crate::link) fn store_next_x(&mut self, address: u8) {
        self.acts(INX);
        self.load_x();
        self.store(address);
    }

    /// A <= the value of this source. `operand` is the byte of a word, or an item of the engine.
    pub(in crate::link) fn load_from(&mut self, source: ValueSource, operand: u8) {
        self.program.push(SETS | (source as Code) << 8 | Code::from(operand));
    }

    /// A <= the byte at X, then X <= X + 1.
    pub(in crate::link) fn load_next(&mut self) {
        self.program.push(SETS | (ValueSource::DataAtX as Code) << 8 | ACTS | INX);
    }

    /// A <= X.
    pub(in crate::link) fn load_x(&mut self) {
        self.load_from(ValueSource::X, 0);
    }

    /// A <= A xor the byte at this address.
    pub(in crate::link) fn xor(&mut self, address: u8) {
        self.program.push(SETS | XOR | Code::from(address));
    }

    /// A <= A xor the constant at X.
    pub(in crate::link) fn xor_table(&mut self) {
        self.program.push(SETS | XOR | (ValueSource::ConstantAtX as Code) << 8);
    }

    /// A <= A xor this number.
    pub(in crate::link) fn xor_number(&mut self, number: u8) {
        let address = self.constant(number);
        self.program.push(SETS | XOR | (ValueSource::Constant as Code) << 8 | Code::from(address));
    }

    /// A <= A and the byte at this address.
    pub(in crate::link) fn and(&mut self, address: u8) {
        self.program.push(SETS | AND | Code::from(address));
    }

    /// A <= A and the constant at X.
    pub(in crate::link) fn and_table(&mut self) {
        self.program.push(SETS | AND | (ValueSource::ConstantAtX as Code) << 8);
    }

    /// A <= A and this number.
    pub(in crate::link) fn and_number(&mut self, number: u8) {
        let address = self.constant(number);
        self.program.push(SETS | AND | (ValueSource::Constant as Code) << 8 | Code::from(address));
    }

    /// The byte at this address <= A.
    pub(in crate::link) fn store(&mut self, address: u8) {
        self.program.push(STORES | Code::from(address));
    }

    /// The byte at X <= A, then X <= X + 1.
    pub(in crate::link) fn store_next(&mut self) {
        self.program.push(STORES | INDEXED | ACTS | INX);
    }

    /// Sends A to the host.
    pub(in crate::link) fn send(&mut self) {
        self.acts(GOES | WAIT);
    }

    /// Performs all the actions whose bits are set.
    pub(in crate::link) fn acts(&mut self, what: Code) {
        self.program.push(ACTS | what);
    }

    /// Jumps to a label.
    pub(in crate::link) fn jump(&mut self, to: &'static str) {
        self.jump_if(Condition::Always, to);
    }

    /// Jumps to a label if the condition holds.
    pub(in crate::link) fn jump_if(&mut self, condition: Condition, to: &'static str) {
        self.jumps.push((self.program.len(), to));
        self.program.push(JUMPS | (condition as Code) << CONDITION);
    }

    /// Jumps to a label if the condition does not hold.
    pub(in crate::link) fn jump_unless(&mut self, condition: Condition, to: &'static str) {
        self.jump_if(condition, to);
        if let Some(code) = self.program.last_mut() {
            *code |= UNLESS;
        }
    }

    /// Resolves the labels, and returns the finished memories.
    pub(in crate::link) fn finish(mut self) -> Image {
        for (at, label) in core::mem::take(&mut self.jumps) {
            self.program[at] |= self.labels[label] as Code;
        }
        assert!(self.program.len() <= SIZE, "{} instructions are too many", self.program.len());
        let mut data = vec![0; SIZE];
        for (&address, &value) in &self.page {
            data[PAGE + usize::from(address)] = value;
        }
        Image { program: self.program, data }
    }
}
