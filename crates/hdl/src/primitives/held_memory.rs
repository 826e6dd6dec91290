//! Block RAM whose read port keeps its word until the next read, with one write port.
//!
//! ```text
//! clock         __/^^\__/^^\__/^^\__/^^\__
//! read          ___/^^^^^\________________
//! read_address  ==< a >===================
//! read_data     ========<  a's   =========      until the next read
//! ```
//!
//! The output register of the block RAM serves as a register of the design, which costs no cells.
//! Two values are undefined in the hardware: `read_data` before the first read, and a word that is
//! read in the cycle in which it is written. The simulation returns zero and the old word.

use crate::primitives::register::Input;
use crate::primitives::word::Word;
use rust_hdl_core::prelude::*;

/// A memory of 2^A words of W bits, or of fewer ([`HeldMemory::of_few`]). At first all are zero.
pub struct HeldMemory<const A: usize, const W: usize> {
    /// The clock.
    pub clock: Input<Clock>,
    /// Reads a word in this cycle.
    pub read: Input<Bit>,
    /// The address of the word to read.
    pub read_address: Input<Word<A>>,
    /// The word that was read last.
    pub read_data: Signal<Out, Word<W>>,
    /// Writes a word in this cycle.
    pub write: Input<Bit>,
    /// The address of the word to write.
    pub write_address: Input<Word<A>>,
    /// The new word.
    pub write_data: Input<Word<W>>,
    words: Vec<Word<W>>,
    rose: bool,
}

impl<const A: usize, const W: usize> HeldMemory<A, W> {
    /// Makes a memory of 2^`bits` words: only the lowest `bits` bits of an address have an effect.
    ///
    /// # Panics
    /// Panics if `bits` is 0 or greater than A.
    pub fn of_few(bits: usize) -> Self {
        assert!((1..=A).contains(&bits), "{bits} of {A} bits of an address");
        Self {
            clock: Input::default(),
            read: Input::default(),
            read_address: Input::default(),
            read_data: Signal::default(),
            write: Input::default(),
            write_address: Input::default(),
            write_data: Input::default(),
            words: vec![Word::default(); 1 << bits],
            rose: false,
        }
    }

    fn verilog_text(&self) -> String {
        let words = self.words.len();
        let bits = words.ilog2() as usize;
        let (index, unused) = match bits < A {
            true => (
                format!("[{}:0]", bits - 1),
                format!(
                    "wire unused = &{{read_address[{0}:{bits}], write_address[{0}:{bits}]}};\n\n",
                    A - 1
                ),
            ),
            false => (String::new(), String::new()),
        };
        format!(
            "{unused}// No word that is read in the clock in which it is written is ever used: no bypass is needed.\n\
             (* no_rw_check, ram_style = \"block\" *) reg [{}:0] words [0:{}];\n\
             reg [{}:0] value; // a block RAM gives no value before its first clock\ninteger i;\n\n\
             assign read_data = value;\n\n\
             initial begin\n    for (i = 0; i < {words}; i = i + 1) words[i] = 0;\nend\n\n\
             always @(posedge clock) begin\n    if (read) value <= words[read_address{index}];\n    \
             if (write) words[write_address{index}] <= write_data;\nend",
            W - 1,
            words - 1,
            W - 1
        )
    }
}

impl<const A: usize, const W: usize> Default for HeldMemory<A, W> {
    fn default() -> Self {
        Self::of_few(A)
    }
}

impl<const A: usize, const W: usize> Logic for HeldMemory<A, W> {
    #[inline]
    fn update(&mut self) {
        let high = self.clock.val().clk;
        if high && !self.rose {
            let last = self.words.len() - 1;
            if self.read.val() {
                self.read_data.next = self.words[self.read_address.val().value() as usize & last];
            }
            if self.write.val() {
                self.words[self.write_address.val().value() as usize & last] =
                    self.write_data.val();
            }
        }
        self.rose = high;
    }
    fn connect(&mut self) {
        self.read_data.connect();
    }
    fn hdl(&self) -> Verilog {
        Verilog::Custom(self.verilog_text())
    }
}

impl<const A: usize, const W: usize> Block for HeldMemory<A, W> {
    fn connect_all(&mut self) {
        self.connect();
    }
    #[inline]
    fn update_all(&mut self) {
        self.update();
        self.clock.update_all();
        self.read.update_all();
        self.read_address.update_all();
        self.write.update_all();
        self.write_address.update_all();
        self.write_data.update_all();
        self.read_data.update_all();
    }
    /// The write port is ignored, because no kernel reads it.
    #[inline]
    fn has_changed(&self) -> bool {
        self.read_data.changed() || self.read_address.changed() || self.read.changed()
    }
    fn accept(&self, name: &str, probe: &mut dyn Probe) {
        probe.visit_start_scope(name, self);
        self.clock.accept("clock", probe);
        self.read.accept("read", probe);
        self.read_address.accept("read_address", probe);
        self.read_data.accept("read_data", probe);
        self.write.accept("write", probe);
        self.write_address.accept("write_address", probe);
        self.write_data.accept("write_data", probe);
        probe.visit_end_scope(name, self);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::{rising_edge, settle};

    fn clock(memory: &mut HeldMemory<3, 8>) -> u128 {
        memory.clock.next = false.into();
        settle(memory);
        memory.clock.next = true.into();
        rising_edge(memory);
        settle(memory);
        memory.read_data.val().value()
    }

    #[test]
    fn memory_keeps_the_word_that_was_read_last() {
        let mut memory = HeldMemory::<3, 8>::of_few(2);
        memory.connect_all();
        memory.write.next = true;
        memory.write_address.next = Word::from(7_u64);
        memory.write_data.next = Word::from(0xab_u64);
        assert_eq!(clock(&mut memory), 0);
        memory.write.next = false;
        memory.read.next = true;
        memory.read_address.next = Word::from(3_u64);
        assert_eq!(clock(&mut memory), 0xab);
        memory.read.next = false;
        memory.read_address.next = Word::from(0_u64);
        assert_eq!(clock(&mut memory), 0xab);
        memory.read.next = true;
        assert_eq!(clock(&mut memory), 0);
    }
}
