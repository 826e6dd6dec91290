//! A whole board, clocked from its pins: bytes into the UART, pulses out. Its Verilog and its bitstream, read back, show on every
//! pin in every cycle what link and engine show in Rust-HDL. The PLL is one model of the bench at both stages: it hands its
//! reference on, locked.

use carrystep_export::{Gateware, shipped_machine};
use carrystep_spec::board::board;
use carrystep_spec::engine::Cause;
use carrystep_spec::link::registers::{CLEAR, CONTROL, POSITION, SEGMENT, START, of_axis};
use carrystep_spec::{AXES, Source};
use carrystep_synthesis::ice40::{self, Part};
use carrystep_tests::link_bench::{LinkBench, Said, frame, on_the_line, ports, unframe};

/// Cycles from the lock to the first edge of the late clock (docs/decisions/0033).
const LATE: u64 = 1026;

const PLL: &str = "
module bench_pll #(
    parameter FEEDBACK_PATH = 0, DELAY_ADJUSTMENT_MODE_FEEDBACK = 0, DELAY_ADJUSTMENT_MODE_RELATIVE = 0, PLLOUT_SELECT = 0,
    parameter SHIFTREG_DIV_MODE = 0, FDA_FEEDBACK = 0, FDA_RELATIVE = 0, DIVR = 0, DIVF = 0, DIVQ = 0, FILTER_RANGE = 0,
    parameter ENABLE_ICEGATE = 0, TEST_MODE = 0
) (
    input REFERENCECLK, EXTFEEDBACK, BYPASS, RESETB, LATCHINPUTVALUE, SDI, SCLK,
    input [7:0] DYNAMICDELAY,
    output PLLOUTCORE, PLLOUTGLOBAL, LOCK, SDO
);
    assign PLLOUTCORE = REFERENCECLK;
    assign PLLOUTGLOBAL = REFERENCECLK;
    assign LOCK = 1'b1;
endmodule
";

/// With yosys' models of its cells, but for the PLL.
fn simulated(verilog: &str) -> String {
    ice40::simulated(&verilog.replace("SB_PLL40_CORE", "bench_pll")).expect("models of its cells") + PLL
}

/// Sends a request and takes its answer.
fn ask(bench: &mut LinkBench, sequence: u8, address: u8, words: &[u32]) -> Said {
    bench.send(&on_the_line(&frame(sequence, address, words)));
    let answer = bench.answer(60_000).expect("an answer");
    Said::of(&unframe(&answer).expect("a frame"))
}

/// Power, a move of two axes, an e-stop, and on again; all on the pins.
fn session(bench: &mut LinkBench) {
    let mut next = 0;
    let mut write = |bench: &mut LinkBench, address: u8, words: &[u32]| {
        let said = ask(bench, next, 0x80 | address, words);
        next += 1;
        assert_eq!(said.next, next, "{said:?}");
    };
    write(bench, CONTROL, &[1]);
    let cruise = |v: i64| [149, v as u32, (v >> 32) as u32, 0, 0x0020_0000, 0xdbc0, 0, 1];
    write(bench, of_axis(SEGMENT, 0), &cruise(1 << 60));
    write(bench, of_axis(SEGMENT, 5), &cruise(-(1 << 60)));
    write(bench, START, &[0b10_0001]);
    bench.rest(9_000);
    // A freeze is over at once, where a ramp takes a hundred thousand cycles.
    bench.pins.estop = true;
    bench.rest(3_000);
    let said = ask(bench, 9, of_axis(POSITION, 5), &[]);
    assert_eq!(said.fault, Some(Cause::EStop), "{said:?}");
    assert!(said.halted, "{said:?}");
    bench.pins.estop = false;
    bench.rest(3_000);
    write(bench, CLEAR, &[0]);
    assert_eq!(ask(bench, 9, POSITION, &[]).fault, None);
    assert!(bench.steps > 5, "{} steps", bench.steps);
}

#[test]
fn on_the_icestick() {
    let icestick = board("icestick").expect("a board");
    // Nothing that takes milliseconds.
    let text = shipped_machine(icestick, &icestick.clocks[0]).expect("a machine");
    let quick = "[machine.guard]\nenable_ms = 0\ndebounce_us = 0\nwatchdog_ms = 0\n";
    let text = text.replace("[machine.guard]\n", quick);
    let source = Source { path: "machine.toml".into(), text: text.into() };
    let gateware = Gateware::new(icestick, &icestick.parts[0], source).expect("gateware");
    let uart = gateware.uart().expect("a UART");
    assert_eq!(gateware.build().axes(), AXES);

    let mut bench = LinkBench::uart(gateware.build(), uart);
    bench.board = Some(ports::board(LATE));
    session(&mut bench);
    let vectors = bench.board.expect("what was kept");

    let files = gateware.files().expect("its files");
    let text = |end: &str| {
        files.iter().filter(|file| file.name.ends_with(end)).map(|file| file.text.as_str()).collect::<String>()
    };
    let (verilog, pcf) = (text(".v"), text(".pcf"));
    let compare = |verilog: &str| vectors.difference(&gateware.top(), &simulated(verilog)).expect("Icarus");
    assert_eq!(compare(&verilog), None, "the Verilog");
    // Wires crossed on the way to the pins are seen.
    for (wire, other) in [(".dir(dir)", ".dir(step)"), ("enable_n = !enabled", "enable_n = enabled")] {
        let crossed = verilog.replace(wire, other);
        assert_ne!(crossed, verilog, "{wire} is not there");
        assert!(compare(&crossed).is_some(), "{other} is not seen");
    }

    let part = Part { device: &icestick.parts[0].name, package: &icestick.parts[0].package };
    let netlist = ice40::synthesise_tight(&verilog, &gateware.top()).expect("a netlist");
    let placed = netlist.place_on(part, &pcf, gateware.build().timebase.clock_hz(), 1).expect("a placed design");
    let read_back = placed.read_back(&netlist, &placed.asc).expect("a bitstream");
    assert_eq!(compare(&read_back), None, "the bitstream");
}
