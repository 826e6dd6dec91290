//! Block RAM with one read port and one write port, both of which are registered.
//!
//! ```text
//! clock         __/^^\__/^^\__/^^\__
//! read_address  ==< a >=============
//! read_data     ========<  a's  >===      valid in the cycle after the address
//! ```
//!
//! Two values are undefined in the hardware: `read_data` before the first clock edge, and a word
//! that is read in the cycle in which it is written. Real block RAMs differ there. A design that
//! needs neither value costs no bypass logic. The simulation returns zero and the old word.

use crate::primitives::constant::{ERROR, TextParameter};
use crate::primitives::formula::{Formula, ParameterValue};
use crate::primitives::register::Input;
use crate::primitives::word::Word;
use rust_hdl_core::prelude::*;

const BLOCK: &str = "\"block\"";

/// The Verilog that refuses a memory style other than block and distributed RAM: it instantiates a
/// module that does not exist.
fn style_check(style: &str) -> String {
    let error = format!("{ERROR}{}_out_of_range", style.to_lowercase());
    format!(
        "// Words of different lengths are compared.\n// verilator lint_off WIDTH\ngenerate\n    if (({style} != {BLOCK}) && ({style} != \"distributed\")) begin : refused\n        \
         {error} error ();\n    end\nendgenerate\n// verilator lint_on WIDTH\n\n"
    )
}

/// A memory of 2^A words of W bits, or of fewer ([`Memory::of_few_formulas`]).
pub struct Memory<const A: usize, const W: usize> {
    /// The clock.
    pub clock: Input<Clock>,
    /// The address of the word to read.
    pub read_address: Input<Word<A>>,
    /// The word at the address of the cycle before.
    pub read_data: Signal<Out, Word<W>>,
    /// The address of the word to write.
    pub write_address: Input<Word<A>>,
    /// The write enable of each bit.
    pub write_bits: Input<Word<W>>,
    /// The new values of the bits that are written.
    pub write_data: Input<Word<W>>,
    words: Vec<Word<W>>,
    rose: bool,
    /// The parameter of the Verilog that places the memory; `None`: it is in block RAM, and its
    /// words are always written whole.
    placed_by: Option<&'static str>,
    /// Number of equal parts of a word that are written separately, unless `placed_by` is given.
    parts: usize,
    initial: Vec<(usize, Formula<W>)>,
    given: Vec<TextParameter>,
}

impl<const A: usize, const W: usize> Memory<A, W> {
    /// Makes a memory whose words are always written whole. The parent drives `write_bits` with all
    /// ones or with zero. `initial` is a list of addresses and words; the other words are zero.
    ///
    /// # Panics
    /// Panics if an address of `initial` is 2^A or more.
    pub fn of_words(initial: &[(usize, Word<W>)]) -> Self {
        let numbers: Vec<_> =
            initial.iter().map(|&(address, word)| (address, Formula::from(word))).collect();
        Self::of_formulas(&numbers)
    }

    /// The same with words that follow from parameters of the Verilog.
    pub fn of_formulas(initial: &[(usize, Formula<W>)]) -> Self {
        let mut memory = Self::of_zeros();
        let mut given: Vec<ParameterValue> = Vec::new();
        for (address, word) in initial {
            memory.words[*address] = word.value();
            given.extend(
                word.given().iter().filter(|one| !given.contains(one)).cloned().collect::<Vec<_>>(),
            );
        }
        memory.given = given.into_iter().map(TextParameter::new).collect();
        memory.initial = initial.to_vec();
        memory
    }

    /// As [`Self::of_formulas`], with 2^`bits` words: only the lowest `bits` bits of an address
    /// have an effect.
    ///
    /// # Panics
    /// Panics if `bits` is 0 or greater than A, or if an address of `initial` is 2^`bits` or more.
    pub fn of_few_formulas(bits: usize, initial: &[(usize, Formula<W>)]) -> Self {
        assert!((1..=A).contains(&bits), "{bits} of {A} bits of an address");
        let mut memory = Self::of_formulas(initial);
        memory.words.truncate(1 << bits);
        memory
    }

    /// As [`Self::of_formulas`], but the halves of a word are written separately: the parent drives
    /// each half of `write_bits` with all ones or with zero.
    ///
    /// # Panics
    /// Panics if W is odd, or if an address of `initial` is 2^A or more.
    pub fn of_halves(initial: &[(usize, Formula<W>)]) -> Self {
        assert!(W.is_multiple_of(2), "{W} bits have no halves");
        Self { parts: 2, ..Self::of_formulas(initial) }
    }

    /// Makes a memory with a write enable for each bit. All its words are initially zero. Not every
    /// FPGA has block RAM with such enables: the parameter `placed_by` of the Verilog places it.
    pub fn of_bits(placed_by: &'static str) -> Self {
        let style =
            ParameterValue { name: placed_by.to_owned(), bits: 0, literal: BLOCK.to_owned() };
        let given = vec![TextParameter::new(style)];
        Self { placed_by: Some(placed_by), given, ..Self::of_zeros() }
    }

    fn of_zeros() -> Self {
        Self {
            clock: Input::default(),
            read_address: Input::default(),
            read_data: Signal::default(),
            write_address: Input::default(),
            write_bits: Input::default(),
            write_data: Input::default(),
            words: vec![Word::default(); 1 << A],
            rose: false,
            placed_by: None,
            parts: 1,
            initial: Vec::new(),
            given: Vec::new(),
        }
    }

    /// The word at an address. Only the simulation can read it without the port.
    ///
    /// # Panics
    /// Panics if the address is 2^A or more.
    pub fn word(&self, address: usize) -> Word<W> {
        self.words[address]
    }

    /// The bits of an address that have an effect, as Verilog.
    fn index(&self, address: &str) -> String {
        match self.words.len().ilog2() as usize {
            bits if bits < A => format!("{address}[{}:0]", bits - 1),
            _ => address.to_owned(),
        }
    }

    /// The Verilog that names the bits of addresses without an effect, so that no tool reports
    /// them.
    fn unused_bits(&self) -> String {
        let bits = self.words.len().ilog2() as usize;
        if bits == A {
            return String::new();
        }
        let top = A - 1;
        format!("wire unused = &{{read_address[{top}:{bits}], write_address[{top}:{bits}]}};\n\n")
    }

    /// The Verilog that writes whole words, or each part of them.
    fn write_text(&self, address: &str) -> String {
        if W == 1 {
            return format!("    if (write_bits) words[{address}] <= write_data;\nend");
        }
        if self.parts == 1 {
            return format!("    if (write_bits[0]) words[{address}] <= write_data;\nend");
        }
        let bits = W / self.parts;
        let mut text = String::new();
        for low in (0..W).step_by(bits) {
            let range = format!("{}:{low}", low + bits - 1);
            text.push_str(&format!(
                "    if (write_bits[{low}]) words[{address}][{range}] <= write_data[{range}];\n"
            ));
        }
        text + "end"
    }

    fn verilog_text(&self) -> String {
        let top = W - 1;
        let range = if W == 1 { String::new() } else { format!("[{top}:0] ") };
        let words = self.words.len();
        let [read, written] = ["read_address", "write_address"].map(|name| self.index(name));
        let unused = self.unused_bits();
        let (style, check) = match self.placed_by {
            None => (BLOCK, String::new()),
            Some(style) => (style, style_check(style)),
        };
        let mut text = format!(
            "{check}{unused}// No word that is read in the clock in which it is written is ever used: no bypass is needed.\n\
             (* no_rw_check, ram_style = {style} *) reg {range}words [0:{}];\nreg {range}value; // a block RAM gives no value before its first clock\ninteger i;\n\n\
             assign read_data = value;\n\ninitial begin\n    for (i = 0; i < {words}; i = i + 1) words[i] = 0;\n",
            words - 1
        );
        // The words have been zero already.
        let is_zero = |word: &Formula<W>| word.given().is_empty() && !word.value().any();
        for (address, word) in self.initial.iter().filter(|(_, word)| !is_zero(word)) {
            let text_of_word = match word.given().is_empty() {
                true => format!("{W}'h{:x}", word.value().value()),
                false => word.text().to_owned(),
            };
            text.push_str(&format!("    words[{address}] = {text_of_word};\n"));
        }
        text.push_str(&format!(
            "end\n\nalways @(posedge clock) begin\n    value <= words[{read}];\n"
        ));
        if self.placed_by.is_none() || W == 1 {
            text.push_str(&self.write_text(&written));
        }
        if self.placed_by.is_some() && W > 1 {
            text.push_str(&format!(
                "    for (i = 0; i < {W}; i = i + 1) begin\n        \
                 if (write_bits[i]) words[{written}][i] <= write_data[i];\n    end\nend"
            ));
        }
        text
    }
}

impl<const A: usize, const W: usize> Default for Memory<A, W> {
    fn default() -> Self {
        Self::of_words(&[])
    }
}

impl<const A: usize, const W: usize> Logic for Memory<A, W> {
    #[inline]
    fn update(&mut self) {
        let high = self.clock.val().clk;
        if high && !self.rose {
            let last = self.words.len() - 1;
            self.read_data.next = self.words[self.read_address.val().value() as usize & last];
            let bits = self.write_bits.val();
            if bits.any() {
                let word = &mut self.words[self.write_address.val().value() as usize & last];
                *word = (*word & !bits) | (self.write_data.val() & bits);
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

impl<const A: usize, const W: usize> Block for Memory<A, W> {
    fn connect_all(&mut self) {
        self.connect();
    }
    #[inline]
    fn update_all(&mut self) {
        self.update();
        self.clock.update_all();
        self.read_address.update_all();
        self.write_address.update_all();
        self.write_bits.update_all();
        self.write_data.update_all();
        self.read_data.update_all();
    }
    /// The write port is ignored, because no kernel reads it.
    #[inline]
    fn has_changed(&self) -> bool {
        self.read_data.changed() || self.read_address.changed()
    }
    fn accept(&self, name: &str, probe: &mut dyn Probe) {
        probe.visit_start_scope(name, self);
        self.clock.accept("clock", probe);
        self.read_address.accept("read_address", probe);
        self.read_data.accept("read_data", probe);
        self.write_address.accept("write_address", probe);
        self.write_bits.accept("write_bits", probe);
        self.write_data.accept("write_data", probe);
        for given in &self.given {
            given.accept(given.name(), probe);
        }
        probe.visit_end_scope(name, self);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::{rising_edge, settle};

    fn clock<const A: usize>(memory: &mut Memory<A, 8>) -> u128 {
        memory.clock.next = false.into();
        settle(memory);
        memory.clock.next = true.into();
        rising_edge(memory);
        settle(memory);
        memory.read_data.val().value()
    }

    #[test]
    fn memory_returns_a_word_in_the_cycle_after_its_address() {
        let mut memory = Memory::<4, 8>::of_words(&[(3, Word::from(7_u64))]);
        memory.connect_all();
        memory.read_address.next = Word::from(3_u64);
        assert_eq!(clock(&mut memory), 7);
        memory.write_address.next = Word::from(3_u64);
        memory.write_data.next = Word::from(0xab_u64);
        memory.write_bits.next = Word::from(0xff_u64);
        assert_eq!(clock(&mut memory), 7);
        assert_eq!(clock(&mut memory), 0xab);
    }

    #[test]
    fn memory_writes_only_the_enabled_bits() {
        let mut memory = Memory::<4, 8>::of_bits("PLACE");
        memory.connect_all();
        memory.write_data.next = Word::from(0xff_u64);
        memory.write_bits.next = Word::from(0x5a_u64);
        clock(&mut memory);
        memory.write_bits.next = Word::default();
        assert_eq!(clock(&mut memory), 0x5a);
    }

    #[test]
    fn upper_bits_of_an_address_have_no_effect_in_a_memory_of_few_words() {
        let mut memory = Memory::<4, 8>::of_few_formulas(3, &[(7, Formula::number(9))]);
        memory.connect_all();
        memory.read_address.next = Word::from(15_u64);
        assert_eq!(clock(&mut memory), 9);
        assert!(memory.verilog_text().contains("words [0:7]"));
    }

    #[test]
    fn halves_of_a_word_are_written_separately() {
        let mut memory = Memory::<4, 8>::of_halves(&[(1, Formula::number(0x34))]);
        memory.connect_all();
        memory.read_address.next = Word::from(1_u64);
        memory.write_address.next = Word::from(1_u64);
        memory.write_data.next = Word::from(0xff_u64);
        memory.write_bits.next = Word::from(0xf_u64);
        clock(&mut memory);
        memory.write_bits.next = Word::default();
        assert_eq!(clock(&mut memory), 0x3f);
        let text = memory.verilog_text();
        assert!(text.contains("if (write_bits[4]) words[write_address][7:4] <= write_data[7:4];"));
    }
}
