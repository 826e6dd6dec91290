//! Block RAM: one read port, one write port, both registered.
//!
//! ```text
//! clock         __/^^\__/^^\__/^^\__
//! read_address  ==< a >=============
//! read_data     ========<  a's  >===      the cycle after
//! ```
//!
//! Before the first clock nothing has been read, and a word that is read in the cycle in which it is written has no
//! defined value: real block RAMs differ there, and a design that needs neither costs no bypass. In simulation
//! they are zero and the old value.

use crate::parameters::EVENT_MEMORY;
use crate::primitives::constant::{ERROR, Given};
use crate::primitives::formula::{Formula, ParameterValue};
use crate::primitives::register::Input;
use crate::primitives::word::Word;
use rust_hdl::prelude::*;

const BLOCK: &str = "\"block\"";

/// Another style than these is the name of a module that does not exist.
fn style_check() -> String {
    let style = EVENT_MEMORY.name;
    let error = format!("{ERROR}{}_out_of_range", style.to_lowercase());
    format!(
        "// Words of different lengths are compared.\n// verilator lint_off WIDTH\ngenerate\n    if (({style} != {BLOCK}) && ({style} != \"distributed\")) begin : refused\n        \
         {error} error ();\n    end\nendgenerate\n// verilator lint_on WIDTH\n\n"
    )
}

/// 2^A words of W bits.
pub struct Memory<const A: usize, const W: usize> {
    /// The clock.
    pub clock: Input<Clock>,
    /// The word to be read.
    pub read_address: Input<Word<A>>,
    /// What was read.
    pub read_data: Signal<Out, Word<W>>,
    /// The word to be written.
    pub write_address: Input<Word<A>>,
    /// The bits of it that are written.
    pub write_bits: Input<Word<W>>,
    /// Their new values.
    pub write_data: Input<Word<W>>,
    words: Vec<Word<W>>,
    rose: bool,
    whole_words: bool,
    initial: Vec<(usize, Formula<W>)>,
    given: Vec<Given>,
}

impl<const A: usize, const W: usize> Memory<A, W> {
    /// A memory whose words are written whole, or not at all: `write_bits` is all ones or zero.
    pub fn of_words(initial: &[(usize, Word<W>)]) -> Self {
        let numbers: Vec<_> = initial.iter().map(|&(address, word)| (address, Formula::from(word))).collect();
        Self::of_formulas(&numbers)
    }

    /// The same with words that follow from parameters of the Verilog.
    pub fn of_formulas(initial: &[(usize, Formula<W>)]) -> Self {
        let mut memory = Self::of_bits();
        memory.whole_words = true;
        let mut given: Vec<ParameterValue> = Vec::new();
        for (address, word) in initial {
            memory.words[*address] = word.value();
            given.extend(word.given().iter().filter(|one| !given.contains(one)).cloned().collect::<Vec<_>>());
        }
        memory.given = given.into_iter().map(Given::new).collect();
        memory.initial = initial.to_vec();
        memory
    }

    /// A memory of zeros whose bits are written one by one. Not every part has block RAM that can do that: a parameter
    /// of the Verilog says where it lies.
    pub fn of_bits() -> Self {
        let words = vec![Word::default(); 1 << A];
        let style = ParameterValue { name: EVENT_MEMORY.name.to_owned(), bits: 0, literal: BLOCK.to_owned() };
        Self {
            clock: Input::default(),
            read_address: Input::default(),
            read_data: Signal::default(),
            write_address: Input::default(),
            write_bits: Input::default(),
            write_data: Input::default(),
            initial: Vec::new(),
            given: vec![Given::new(style)],
            words,
            rose: false,
            whole_words: false,
        }
    }

    /// The word at an address, in simulation.
    pub fn word(&self, address: usize) -> Word<W> {
        self.words[address]
    }

    fn verilog_text(&self) -> String {
        let top = W - 1;
        let range = if W == 1 { String::new() } else { format!("[{top}:0] ") };
        let words = self.words.len();
        let (style, check) = match self.whole_words {
            true => (BLOCK, String::new()),
            false => (EVENT_MEMORY.name, style_check()),
        };
        let mut text = format!(
            "{check}// No word that is read in the clock in which it is written is ever used: no bypass is needed.\n\
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
        text.push_str("end\n\nalways @(posedge clock) begin\n    value <= words[read_address];\n");
        text.push_str(match (self.whole_words, W) {
            (true, 1) | (false, 1) => "    if (write_bits) words[write_address] <= write_data;\nend",
            (true, _) => "    if (write_bits[0]) words[write_address] <= write_data;\nend",
            (false, _) => "",
        });
        if !self.whole_words && W > 1 {
            text.push_str(&format!(
                "    for (i = 0; i < {W}; i = i + 1) begin\n        \
                 if (write_bits[i]) words[write_address][i] <= write_data[i];\n    end\nend"
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
            self.read_data.next = self.words[self.read_address.val().value() as usize];
            let bits = self.write_bits.val();
            if bits.any() {
                let word = &mut self.words[self.write_address.val().value() as usize];
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
    /// What is written changes nothing that a kernel reads.
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

    fn clock(memory: &mut Memory<4, 8>) -> u128 {
        memory.clock.next = false.into();
        settle(memory);
        memory.clock.next = true.into();
        rising_edge(memory);
        settle(memory);
        memory.read_data.val().value()
    }

    #[test]
    fn a_word_is_read_the_cycle_after() {
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
    fn bits_are_written_one_by_one() {
        let mut memory = Memory::<4, 8>::of_bits();
        memory.connect_all();
        memory.write_data.next = Word::from(0xff_u64);
        memory.write_bits.next = Word::from(0x5a_u64);
        clock(&mut memory);
        memory.write_bits.next = Word::default();
        assert_eq!(clock(&mut memory), 0x5a);
    }
}
