//! Inputs and registers that need few simulation passes.
//!
//! Rust-HDL simulates by passes over the tree of blocks until nothing changes. Its own inputs show
//! a new value one pass late, so that a clock edge takes one pass for each level of the hierarchy
//! and one for the flip-flop. An [`Input`] of this module shows the driven value at once, and a
//! [`Register`] loads its value in the pass in which its clock rises:
//!
//! ```text
//! one pass:  parent's kernel -> inputs -> child's kernel -> d, clock -> q
//!            (reads old q)                (reads old q)              (new)
//! ```
//!
//! All kernels of the tree run on the values from before the edge, because outputs travel upwards
//! only in the next pass. A clock edge therefore takes one pass at any depth of the hierarchy.

use crate::primitives::formula::{Formula, Note};
use crate::primitives::word::Word;
use rust_hdl_core::ast::VerilogLiteral;
use rust_hdl_core::prelude::{
    Atom, AtomKind, Block, Clock, Logic, Out, PinConstraint, Probe, Signal, Synth, TimingInfo,
    TypeDescriptor, VCDValue, Verilog,
};
use rust_hdl_core::signal::get_signal_id;

/// The register's Verilog text writes this before the note of its initial value.
pub const NOTE: &str = "\n//\t";

/// An input port. Kernels and the Verilog treat it as `Signal<In, T>`.
#[derive(Debug)]
pub struct Input<T: Synth> {
    /// The value that the parent drives.
    pub next: T,
    seen: T,
    changed: bool,
    connected: bool,
    id: usize,
}

impl<T: Synth> Input<T> {
    /// The value that the parent drives, visible in the same pass.
    #[inline]
    pub fn val(&self) -> T {
        self.next
    }
}

impl<T: Synth> Default for Input<T> {
    // An engine has some fifty inputs; in its constructors, which exist for each size, each would be
    // written out.
    #[inline(never)]
    fn default() -> Self {
        Self {
            next: T::default(),
            seen: T::default(),
            changed: false,
            connected: false,
            id: get_signal_id(),
        }
    }
}

impl<T: Synth> Logic for Input<T> {
    fn update(&mut self) {}
    fn connect(&mut self) {
        self.connected = true;
    }
}

impl<T: Synth> Block for Input<T> {
    fn connect_all(&mut self) {}
    #[inline]
    fn update_all(&mut self) {
        self.changed = self.seen != self.next;
        self.seen = self.next;
    }
    #[inline]
    fn has_changed(&self) -> bool {
        self.changed
    }
    fn accept(&self, name: &str, probe: &mut dyn Probe) {
        probe.visit_atom(name, self);
    }
}

impl<T: Synth> Atom for Input<T> {
    fn bits(&self) -> usize {
        T::BITS
    }
    fn connected(&self) -> bool {
        self.connected
    }
    fn changed(&self) -> bool {
        self.changed
    }
    fn kind(&self) -> AtomKind {
        AtomKind::InputParameter
    }
    fn descriptor(&self) -> TypeDescriptor {
        T::descriptor()
    }
    fn vcd(&self) -> VCDValue {
        self.seen.vcd()
    }
    fn id(&self) -> usize {
        self.id
    }
    fn verilog(&self) -> VerilogLiteral {
        self.seen.verilog()
    }
    fn constraints(&self) -> Vec<PinConstraint> {
        Vec::new()
    }
}

/// A D flip-flop for each bit, with an initial value.
#[derive(Debug)]
pub struct Register<T: Synth> {
    /// The value that the register loads at the next rising edge.
    pub d: Input<T>,
    /// The present value.
    pub q: Signal<Out, T>,
    /// The clock.
    pub clock: Input<Clock>,
    initial: T,
    note: Option<Note>,
}

impl<const N: usize> Register<Word<N>> {
    /// A register that configures to what follows from parameters of the Verilog.
    pub fn of(initial: &Formula<N>) -> Self {
        Self { note: Some(Note::of(initial, false)), ..Self::new(initial.value()) }
    }
}

impl<T: Synth> Register<T> {
    /// Makes a register that holds `initial` after configuration of the FPGA.
    pub fn new(initial: T) -> Self {
        let d = Input { next: initial, ..Input::default() };
        Self {
            d,
            q: Signal::new_with_default(initial),
            clock: Input::default(),
            initial,
            note: None,
        }
    }
}

/// Connects registers of a module to its clock and lets each hold its value. A kernel begins with
/// this; what it assigns to a register's `d` afterwards is loaded instead.
///
/// Rust-HDL's `#[hdl_gen]` knows the macro by this name and writes the same assignments in the
/// Verilog.
#[macro_export]
macro_rules! dff_setup {
    ($module:ident, $clock:ident, $($register:ident),+) => {$(
        $module.$register.clock.next = $module.$clock.val();
        $module.$register.d.next = $module.$register.q.val();
    )+};
}

impl<T: Synth> Default for Register<T> {
    fn default() -> Self {
        Self::new(T::default())
    }
}

impl<T: Synth> Logic for Register<T> {
    #[inline]
    fn update(&mut self) {
        if self.clock.next.clk && !self.clock.seen.clk {
            self.q.next = self.d.next;
        }
    }
    fn connect(&mut self) {
        self.q.connect();
    }
    fn hdl(&self) -> Verilog {
        let initial = self.initial.verilog();
        let note =
            self.note.as_ref().map_or(String::new(), |note| format!("{NOTE}{}", note.written()));
        Verilog::Custom(format!("initial q = {initial};\nalways @(posedge clock) q <= d;{note}"))
    }
    fn timing(&self) -> Vec<TimingInfo> {
        vec![TimingInfo {
            name: "register".into(),
            clock: "clock".into(),
            inputs: vec!["d".into()],
            outputs: vec!["q".into()],
        }]
    }
}

impl<T: Synth> Block for Register<T> {
    fn connect_all(&mut self) {
        self.connect();
    }
    #[inline]
    fn update_all(&mut self) {
        self.update();
        self.clock.update_all();
        self.d.update_all();
        self.q.update_all();
    }
    /// The clock is ignored, because no kernel reads it.
    #[inline]
    fn has_changed(&self) -> bool {
        self.d.changed || self.q.changed
    }
    fn accept(&self, name: &str, probe: &mut dyn Probe) {
        probe.visit_start_scope(name, self);
        self.d.accept("d", probe);
        self.q.accept("q", probe);
        self.clock.accept("clock", probe);
        probe.visit_end_scope(name, self);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn register_loads_d_only_at_the_rising_edge() {
        let mut register = Register::new(Word::<4>::from(5_u64));
        register.connect_all();
        register.d.next = Word::from(9_u64);
        register.update_all();
        assert_eq!(register.q.val().value(), 5);
        register.clock.next = true.into();
        register.update_all();
        assert_eq!(register.q.val().value(), 9);
        register.d.next = Word::from(3_u64);
        register.update_all();
        register.clock.next = false.into();
        register.update_all();
        assert_eq!(register.q.val().value(), 9);
    }
}
