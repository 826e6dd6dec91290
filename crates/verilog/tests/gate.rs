//! A board with a gate: its host is not ready at once, and no line to the host may be driven before
//! the gate's input allows it.
#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches unit tests only")]

mod common;

use carrystep_boards::{Board, Way, board, boards};
use carrystep_files::SourceText;
use carrystep_verilog::{CLOCK_NAME, Gateware, shipped_machine};

/// A replacement for the board's clock module that passes the oscillator through.
const CLOCK: &str = "module carrystep_clock (input wire oscillator, output wire clock); assign clock = oscillator; endmodule\n";

/// The gateware of the shipped machine on the board's UART or on its SPI.
fn gateware(board: &'static Board, spi: bool) -> Gateware<'static> {
    let text = shipped_machine(board, &board.clocks[0]).unwrap();
    let (head, tail) = text.split_once("[machine.link]\n").unwrap();
    let (baud, axes) = tail.split_once('\n').unwrap();
    let line = if spi { "spi = true" } else { baud };
    let text = format!("{head}[machine.link]\n{line}\n{axes}");
    Gateware::new(
        board,
        &board.parts[0],
        SourceText { path: "machine.toml".into(), text: text.into() },
    )
    .unwrap()
}

/// The Verilog of the gateware, with the clock module of this bench.
fn verilog(gateware: &Gateware<'_>) -> String {
    let files = gateware.verilog().unwrap().into_iter();
    let ours = files.filter(|file| file.name != format!("{CLOCK_NAME}.v"));
    ours.map(|file| file.text).collect::<String>() + CLOCK
}

/// The output of the Icarus bench: `right`, or the first error.
///
/// The gate's input is low, high for slightly less than its wait time, low for a clock, high for
/// long enough, and low again.
fn seen(gateware: &Gateware<'_>, spi: bool, verilog: &str) -> String {
    let board = board("mojo-v3").unwrap();
    let gate = board.gate.as_ref().unwrap();
    let clocks = 1_u64 << (gate.counter_bits(gateware.build().timebase.clock_hz()) - 1);
    let (out, others) = if spi {
        ("spi_miso", ".spi_sck(1'b0), .spi_cs_n(select_n), .spi_mosi(1'b1)")
    } else {
        ("uart_tx", ".uart_rx(1'b1)")
    };
    let bench = format!(
        "module bench;
    reg oscillator = 1'b0, go = 1'b0, select_n = 1'b0;
    always #5 oscillator = !oscillator;
    wire out;
    {top} dut (.oscillator(oscillator), .{port}(go), .{out}(out), {others}, .estop(1'b0), .limit_min(6'd0));
    integer i;
    task all(input integer count, input z);
        for (i = 0; i < count; i = i + 1) begin
            @(negedge oscillator);
            if ((out === 1'bz) !== z || out === 1'bx) begin
                $display(\"%s at %0t\", z ? \"driven\" : \"not driven\", $time);
                $finish;
            end
        end
    endtask
    initial begin
        all(2000, 1'b1);
        go = 1'b1; all({clocks} - 8, 1'b1);
        go = 1'b0; all(4, 1'b1);
        go = 1'b1; all({clocks}, 1'b1);
        repeat (8) @(negedge oscillator);
        all(2000, 1'b0);
        select_n = 1'b1; #1;
        if ({spi} && out !== 1'bz) $display(\"driven although not selected\");
        select_n = 1'b0;
        go = 1'b0;
        repeat (8) @(negedge oscillator);
        all(2000, 1'b1);
        $display(\"right\");
        $finish;
    end
endmodule
",
        top = gateware.top(),
        port = gate.port,
        spi = u8::from(spi),
    );
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("all.v"), bench + verilog).unwrap();
    let run = |tool: &str, arguments: &[&str]| {
        let (ok, said) = common::run(tool, arguments, folder.path());
        assert!(ok, "{tool}: {said}");
        said.trim().to_owned()
    };
    run("iverilog", &["-g2005", "-s", "bench", "-o", "bench.vvp", "all.v"]);
    run("vvp", &["-n", "bench.vvp"])
}

/// The gate must hold every output of the board that is connected to the host.
#[test]
fn gate_holds_every_line_to_the_host() {
    let gated: Vec<&Board> = boards().iter().filter(|board| board.gate.is_some()).collect();
    assert_eq!(gated.iter().map(|board| board.name.as_str()).collect::<Vec<_>>(), ["mojo-v3"]);
    let out = |port: &str| {
        carrystep_boards::PORTS.iter().any(|known| port == known.name && known.way == Way::Out)
    };
    let to_host: Vec<&str> = gated[0].wires.iter().map(|wire| wire.port.as_str()).collect();
    let to_host: Vec<&str> = to_host
        .into_iter()
        .filter(|port| out(port) && (port.starts_with("uart") || port.starts_with("spi")))
        .collect();
    assert_eq!(to_host, gated[0].gate.as_ref().unwrap().holds);
}

#[test]
fn no_line_to_the_host_is_driven_before_the_gate_allows_it() {
    let board = board("mojo-v3").unwrap();
    for spi in [false, true] {
        let gateware = gateware(board, spi);
        let text = verilog(&gateware);
        assert_eq!(seen(&gateware, spi, &text), "right", "spi: {spi}");
        // Mutations: lines that are always driven, and a gate that is not reset when its input
        // becomes low.
        let planted = [
            ("wire driven = cclk_waited[15];", "wire driven = 1'b1;"),
            ("if (!cclk_seen[1]) cclk_waited", "if (1'b0) cclk_waited"),
        ];
        for (right, wrong) in planted {
            assert!(text.contains(right), "the text is gone: {right}");
            assert_ne!(
                seen(&gateware, spi, &text.replace(right, wrong)),
                "right",
                "spi: {spi}, {wrong}"
            );
        }
    }
}

/// The text without the overrides of parameters, which modules that yosys makes from their
/// instances do not have.
fn without_overrides(text: &str) -> String {
    let mut parts = text.split(" #(\n");
    let first = parts.next().unwrap().to_owned();
    parts.fold(first, |text, part| text + " " + part.split_once("\n    ) ").unwrap().1)
}

/// Both toolchains for a Spartan-6 turn such a line into a buffer with an output enable; yosys
/// shows it here.
#[test]
fn held_line_becomes_a_buffer_with_an_output_enable() {
    let board = board("mojo-v3").unwrap();
    for spi in [false, true] {
        let gateware = gateware(board, spi);
        let top = gateware.verilog().unwrap().remove(0);
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("top.v"), without_overrides(&top.text)).unwrap();
        let script = format!(
            "read_verilog top.v; hierarchy -generate carrystep_* o:clock i:*; synth_xilinx -family xc6s -ise -nowidelut -top {}; \
             select -assert-count 1 t:OBUFT",
            gateware.top()
        );
        let (fine, said) = common::run("yosys", &["-q", "-p", &script], folder.path());
        assert!(fine, "spi: {spi}: {said}");
    }
}
