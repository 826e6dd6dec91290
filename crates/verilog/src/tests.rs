//! Tests of the translation with small kernels: the Verilog must mean the same as the Rust code, or
//! the translation must fail.

use crate::module::module_text;
use crate::netlist;
use crate::synchronizers::{self, Synchronizer};
use carrystep_hdl::dff_setup;
use carrystep_hdl::primitives::constant::Literal;
use carrystep_hdl::primitives::register::{Input, Register};
use carrystep_hdl::primitives::word::{Word, bit_cast};
use rust_hdl_core::prelude::*;

fn verilog(mut block: impl Block) -> String {
    translate(&mut block).unwrap()
}

fn refusal(mut block: impl Block) -> String {
    translate(&mut block).unwrap_err()
}

fn translate(block: &mut impl Block) -> Result<String, String> {
    block.connect_all();
    let module = netlist::read(block).map_err(|error| error.to_string())?;
    module_text(&module, "toy", &[]).map_err(|error| error.to_string())
}

#[derive(LogicBlock, Default)]
struct Operators {
    a: Input<Word<8>>,
    b: Input<Word<8>>,
    c: Input<Word<8>>,
    masked: Signal<Out, Bit>,
    wrapped: Signal<Out, Word<9>>,
    carried: Signal<Out, Word<9>>,
    apart: Signal<Out, Word<8>>,
    none: Signal<Out, Bit>,
}

impl Logic for Operators {
    #[hdl_gen]
    fn update(&mut self) {
        self.masked.next = self.a.val() & self.b.val() == self.c.val();
        self.wrapped.next = bit_cast::<9, 8>(self.a.val() + self.b.val());
        self.carried.next = bit_cast::<9, 8>(self.a.val()) + bit_cast::<9, 8>(self.b.val());
        self.apart.next = self.a.val() - (self.b.val() - self.c.val());
        self.none.next = !self.a.val().any();
    }
}

#[test]
fn operators_have_the_same_meaning_as_in_rust() {
    let text = verilog(Operators::default());
    for line in [
        "assign masked = (a & b) == c;",
        "assign wrapped = {1'b0, a + b};",
        "assign carried = {1'b0, a} + {1'b0, b};",
        "assign apart = a - (b - c);",
        "assign none = a == 8'd0;",
    ] {
        assert!(text.contains(line), "{line}\n{text}");
    }
}

#[derive(LogicBlock, Default)]
struct Counter {
    clock: Input<Clock>,
    up: Input<Bit>,
    count: Signal<Out, Word<4>>,
    seen: Register<Bit>,
    value: Register<Word<4>>,
    one: Literal<4, 1>,
}

impl Logic for Counter {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, seen, value);
        self.seen.d.next = self.up.val();
        if self.up.val() {
            self.value.d.next = self.value.q.val() + self.one.val();
        }
        self.count.next = self.value.q.val();
    }
}

#[test]
fn registers_are_written_in_clocked_blocks() {
    let expected = "\
module toy (
    input  wire         clock,
    input  wire         up,
    output wire   [3:0] count
);
    localparam [3:0] ONE = 4'd1;

    reg seen = 1'b0;
    reg [3:0] value = 4'd0;

    assign count = value;

    always @(posedge clock) begin
        seen <= up;
        if (up) begin
            value <= value + ONE;
        end
    end
endmodule
";
    assert_eq!(verilog(Counter::default()), expected);
}

#[derive(LogicBlock, Default)]
struct Between {
    a: Input<Bit>,
    early: Signal<Out, Bit>,
    late: Signal<Out, Bit>,
    value: Signal<Local, Bit>,
}

impl Logic for Between {
    #[hdl_gen]
    fn update(&mut self) {
        self.value.next = self.a.val();
        self.early.next = self.value.val();
        self.value.next = !self.a.val();
        self.late.next = self.value.val();
    }
}

#[test]
fn read_between_two_writes_is_refused() {
    assert!(refusal(Between::default()).contains("a read of value between two writes"));
}

#[derive(LogicBlock, Default)]
struct Literals {
    a: Input<Bits<8>>,
    sum: Signal<Out, Bits<8>>,
}

impl Logic for Literals {
    #[hdl_gen]
    fn update(&mut self) {
        self.sum.next = self.a.val() + 1;
    }
}

#[test]
fn literal_without_a_width_is_refused() {
    assert!(refusal(Literals::default()).contains("a (8 bits) + 32'd1 (32 bits)"));
}

#[derive(LogicBlock, Default)]
struct Pins {
    clock: Input<Clock>,
    pin: Input<Bit>,
    logic: Input<Bit>,
    twice: Input<Bit>,
    through: Input<Bit>,
    nowhere: Input<Bit>,
    other: Input<Bit>,
    out: Signal<Out, Bit>,
    past: Signal<Out, Bit>,
    first: Register<Bit>,
    second: Register<Bit>,
    logic_1: Register<Bit>,
    logic_2: Register<Bit>,
    twice_1: Register<Bit>,
    twice_2: Register<Bit>,
    twice_3: Register<Bit>,
}

impl Logic for Pins {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, first, second, logic_1, logic_2, twice_1, twice_2, twice_3);
        self.first.d.next = self.pin.val() ^ self.other.val();
        self.second.d.next = self.first.q.val();
        self.logic_1.d.next = self.logic.val();
        if self.other.val() {
            self.logic_2.d.next = self.logic_1.q.val();
        }
        self.twice_1.d.next = self.twice.val();
        self.twice_2.d.next = self.twice_1.q.val();
        self.twice_3.d.next = self.twice_1.q.val();
        self.past.next = self.through.val() & self.other.val();
        self.out.next = self.second.q.val()
            & self.logic_2.q.val()
            & self.twice_2.q.val()
            & self.twice_3.q.val();
    }
}

/// The synchronizers of `Pins` if this input is asynchronous.
fn synchronizers_of(input: &str) -> Result<Vec<Synchronizer>, String> {
    let mut block = Pins::default();
    block.connect_all();
    let mut module = netlist::read(&block).unwrap();
    let port = module.atoms.iter_mut().find(|atom| atom.name == input).unwrap();
    port.about = Some("A pin; asynchronous.");
    synchronizers::of(&module).map_err(|error| error.to_string())
}

#[test]
fn synchronizer_is_two_registers_with_nothing_between_them() {
    let found = synchronizers_of("pin").unwrap();
    let [Synchronizer { pins, path, first, second, .. }] = &found[..] else { panic!("{found:?}") };
    assert_eq!((pins.as_slice(), path.len()), (&["pin".to_owned()][..], 0));
    assert_eq!((first.name.as_str(), second.name.as_str()), ("first", "second"));
}

#[test]
fn asynchronous_input_without_a_synchronizer_is_refused() {
    for (input, says) in [
        ("logic", "the register logic_1, behind which there is logic"),
        ("twice", "the register twice_1, which not exactly one other register reads"),
        ("through", "the output past"),
        ("nowhere", "no register"),
    ] {
        let error = synchronizers_of(input).unwrap_err();
        assert!(error.contains(&format!("{input}, which reaches {says}")), "{error}");
    }
}
