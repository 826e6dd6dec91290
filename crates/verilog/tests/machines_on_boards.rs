//! What the gateware of a board makes of a machine file: its line, latches, inputs and outputs in the
//! top level. What the board cannot do is refused, with an alternative.
#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches unit tests only")]

use carrystep_boards::{board, boards};
use carrystep_files::SourceText;
use carrystep_verilog::{Gateware, shipped_machine};

/// One more axis, in front of the first one.
const ONE_MORE: &str = "[[machine.axis]]\nname = \"u\"\nsteps_per_unit = 1\nspeed_limit = 1\n\
    accel_limit = 1\ndriver = \"a4988\"\n\n[[machine.axis]]";

/// The error for a board with one thing changed in the shipped machine file.
fn asked(name: &str, was: &str, becomes: &str) -> Result<(), String> {
    let board = board(name).unwrap();
    let text = shipped_machine(board, &board.clocks[0]).unwrap();
    assert!(text.contains(was), "the text is gone: {was}");
    let source =
        SourceText { path: "machine.toml".into(), text: text.replacen(was, becomes, 1).into() };
    Gateware::new(board, &board.parts[0], source).map(|_| ()).map_err(|error| error.to_string())
}

#[test]
fn impossible_request_is_refused_with_an_alternative() {
    asked("icestick", "limits", "limits").unwrap();
    let refused = [
        (
            "alchitry-cu",
            "80000000\ntick_ns = 1000",
            "48000000\ntick_ns = 2000",
            "alchitry-cu: the PLL makes no clock of 48 MHz from 100 MHz; the nearest",
        ),
        (
            "icestick",
            "\"each\"",
            "\"pair\"",
            "too few for two for each of 6 axes: limits = \"each\" or \"one\" would do",
        ),
        (
            "icestick",
            "tick_ns = 2000",
            "tick_ns = 1000",
            "6 axes need 13 clocks each and two to close the tick",
        ),
        (
            "s3board",
            "115200",
            "921600",
            "s3board's serial chip takes at most 115200 baud, not 921600",
        ),
        (
            "icestick",
            "3000000",
            "5600000",
            "a clock of 48000000 Hz does not make 5600000 baud within 2 %",
        ),
        (
            "icestick",
            "driver = \"a4988\"",
            "driver = \"a4988\"\nstep_high_ns = 9000000",
            "step_high_ns",
        ),
        (
            "icestick",
            "[[machine.axis]]",
            ONE_MORE,
            "icestick has pins for 6 axes, and none for 'c': leave out axes, or take another board",
        ),
        (
            "tang-nano-9k",
            "48000000",
            "56000000",
            "tang-nano-9k: the PLL makes no clock of 56 MHz from 27 MHz; the nearest that it makes is 57 MHz",
        ),
        (
            "tang-nano-9k",
            "tick_ns = 2000",
            "tick_ns = 1000",
            "6 axes need 13 clocks each and two to close the tick",
        ),
        (
            "tang-nano-20k",
            "\"each\"",
            "\"pair\"",
            "too few for two for each of 6 axes: limits = \"each\" or \"one\" would do",
        ),
        (
            "tang-nano-20k",
            "[[machine.axis]]",
            ONE_MORE,
            "tang-nano-20k has pins for 6 axes, and none for 'c': leave out axes, or take another board",
        ),
    ];
    for (name, was, becomes, says) in refused {
        let said = asked(name, was, becomes).unwrap_err();
        assert!(said.contains(says), "{said}, not: {says}");
    }
}

/// A user's board without a line to the host that the link supports.
#[test]
fn board_without_a_uart_is_refused() {
    let mut board = board("icestick").unwrap().clone();
    board.wires.retain(|wire| !wire.port.starts_with("uart"));
    let refused = Gateware::shipped(&board, &board.parts[0]).unwrap_err().to_string();
    assert_eq!(refused, "icestick has no pin for uart_rx");
}

/// Uses the SPI instead of the UART if the board has the pins for it.
#[test]
fn machine_can_use_an_spi() {
    let mut on_spi = 0;
    for board in boards() {
        let text = shipped_machine(board, &board.clocks[0]).unwrap();
        let (head, tail) = text.split_once("[machine.link]\n").unwrap();
        let (_, tail) = tail.split_once('\n').unwrap();
        let text = format!("{head}[machine.link]\nspi = true\n{tail}");
        let gateware = Gateware::new(
            board,
            &board.parts[0],
            SourceText { path: "spi.toml".into(), text: text.into() },
        );
        if board.bits("spi_sck") == 0 {
            let refused = gateware.unwrap_err().to_string();
            assert!(refused.contains("spi_"), "{}: {refused}", board.name);
            continue;
        }
        on_spi += 1;
        let files = gateware.unwrap().files().unwrap();
        let all: String = files.iter().map(|file| file.text.as_str()).collect();
        for port in ["spi_sck", "spi_cs_n", "spi_mosi", "spi_miso"] {
            assert!(all.contains(port), "{}: {port}", board.name);
        }
        assert!(!all.contains("uart_rx"), "{}", board.name);
        assert!(files.iter().any(|file| file.name == "carrystep_spi.v"), "{}", board.name);
    }
    assert!(on_spi >= 10, "{on_spi} boards have an SPI");
}

/// Latches at the pins of the probe and of a limit, and one at its own: the top level connects
/// these pins twice, and link and engine with the ports of several latches.
#[test]
fn top_level_connects_each_latch_to_its_source() {
    let board = board("hx8k-evn").unwrap();
    let with = |latches: &str| {
        let text = shipped_machine(board, &board.clocks[0]).unwrap().replace(
            "[machine.link]",
            &format!("[machine.inputs]\nprobe = \"low\"\nlatches = [{latches}]\n\n[machine.link]"),
        );
        let machine = SourceText { path: "machine.toml".into(), text: text.into() };
        Gateware::new(board, &board.parts[0], machine)
    };
    let top = |latches: &str| with(latches).unwrap().files().unwrap().swap_remove(0).text;
    let probe = "{ source = \"probe\", edge = \"falling\" }";
    let limit = "{ source = \"limit_min\", axis = \"y\", edge = \"rising\", looks = 2 }";
    let text = top(&format!("{probe}, {{ edge = \"rising\" }}, {limit}"));
    for line in [
        "    input wire latch,\n",
        ".latch(probe),",
        ".more_latches({1'b0, limit_min[1], latch}),",
        "wire [2:0] more_latch_arm;",
        ".latch_records(latch_records),",
        ".LATCH_LOOKS_2(32'd2)",
        ".LATCH_LOOKS_3(32'd0)",
    ] {
        assert!(text.contains(line), "{line}\n{text}");
    }
    // The only latch may share a pin, too.
    let text = top(probe);
    assert!(text.contains(".latch(probe),") && !text.contains("input wire latch"), "{text}");
    assert!(!text.contains("more_latch"), "{text}");
    let refused = with("{ edge = \"rising\" }, { edge = \"falling\" }").unwrap_err().to_string();
    assert!(refused.contains("1 of the 2 pins that this machine needs for latches"), "{refused}");
}

/// Probe, interlock, general inputs, latch, outputs and PWM: the top level connects each to its pin,
/// and the general inputs take turns in the two rows of the engine.
#[test]
fn top_level_connects_the_inputs_and_outputs_of_the_machine() {
    let board = board("hx8k-evn").unwrap();
    let text = shipped_machine(board, &board.clocks[0]).unwrap().replace(
        "[machine.link]",
        "[machine.inputs]\nprobe = \"low\"\ninterlock = \"low\"\ngeneral = [\"low\", \"high\", \"low\"]\n\
         latch = \"rising\"\n\n[machine.outputs]\ncount = 3\npwm_divider = 16\n\n[machine.link]",
    );
    let machine = SourceText { path: "machine.toml".into(), text: text.into() };
    let files = Gateware::new(board, &board.parts[0], machine).unwrap().files().unwrap();
    let text_of = |end: &str| {
        let file = files.iter().find(|file| file.name.ends_with(end)).unwrap();
        file.text.clone()
    };
    let (top, pins) = (text_of("_top.v"), text_of(".pcf"));
    for line in [
        "input wire [2:0] general,",
        "output wire [2:0] outputs,",
        "assign outputs = levels[2:0];",
        ".inputs_0({1'b0, 1'b0, 1'b0, general[2], general[0], probe}),",
        ".inputs_1({1'b0, 1'b0, 1'b0, 1'b0, general[1], interlock}),",
        ".latch(latch),",
        ".pwm(pwm),",
    ] {
        assert!(top.contains(line), "{line}\n{top}");
    }
    for (port, pulled_up) in [
        ("probe", true),
        ("interlock", true),
        ("latch", true),
        ("general[2]", true),
        ("outputs[2]", false),
        ("pwm", false),
    ] {
        let pin = &board.wire(port).unwrap().pin;
        let line = format!("set_io {}{port} {pin}\n", if pulled_up { "-pullup yes " } else { "" });
        assert!(pins.contains(&line), "{line}{pins}");
    }
}
