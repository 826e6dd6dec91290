//! The directories of the boards: pins, clocks and scripts must work with the open tools, and
//! impossible requests must be refused.
#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches unit tests only")]

mod common;

use carrystep_boards::{Board, Family, OSCILLATOR, PORTS, Placer, Way, board, boards};
use carrystep_files::SourceText;
use carrystep_verilog::{Design, ExportError, Gateware, Prefix, TextFile, shipped_machine};
use std::collections::BTreeMap;
use std::path::Path;

/// All bits of a board's ports that have pins of their own.
fn ports(board: &Board) -> Vec<String> {
    let own = board.wires.iter().filter(|wire| !wire.beside_uart);
    own.map(|wire| wire.port.clone()).collect()
}

/// The files of a top level with these ports.
fn files(board: &Board, ports: &[String]) -> Result<Vec<TextFile>, ExportError> {
    let (part, clock_hz, top) = (&board.parts[0], board.clocks[0].clock_hz, "top".to_owned());
    Design {
        board,
        part,
        clock_hz,
        uart: None,
        top,
        prefix: &Prefix::default(),
        sources: &["carrystep_clock.v", "top.v"],
        ports,
    }
    .files()
}

/// A top level that uses every pin: all inputs are combined in a register, and the outputs are that
/// register.
fn top(board: &Board) -> String {
    let bits = |way: fn(Way) -> bool| {
        let names = PORTS.iter().filter(move |port| way(port.way));
        let own =
            |name| ports(board).iter().filter(|port| port.split('[').next() == Some(name)).count();
        let counted = names.map(|port| (port.name, port.is_list, own(port.name)));
        counted.filter(|(_, _, bits)| *bits > 0).collect::<Vec<_>>()
    };
    let (inputs, outputs) = (bits(|way| way != Way::Out), bits(|way| way == Way::Out));
    let range =
        |is_list, bits: usize| if is_list { format!("[{}:0] ", bits - 1) } else { String::new() };
    let mut list = vec![format!("input wire {OSCILLATOR}")];
    list.extend(
        inputs
            .iter()
            .map(|(name, is_list, bits)| format!("input wire {}{name}", range(*is_list, *bits))),
    );
    list.extend(
        outputs
            .iter()
            .map(|(name, is_list, bits)| format!("output wire {}{name}", range(*is_list, *bits))),
    );
    list.extend(board.ties.iter().map(|tie| format!("output wire {}", tie.port)));
    list.extend(board.gate.iter().map(|gate| format!("input wire {}", gate.port)));
    let all: Vec<String> = inputs.iter().map(|(name, ..)| format!("^{name}")).collect();
    let mut body = format!(
        "wire clock; carrystep_clock made (.oscillator({OSCILLATOR}), .clock(clock));\n\
         reg r = 1'b0; always @(posedge clock) r <= {};\n",
        all.join(" ^ ")
    );
    for (name, _, bits) in &outputs {
        body += &format!("assign {name} = {{{bits}{{r}}}};\n");
    }
    for tie in &board.ties {
        body += &format!("assign {} = 1'b{};\n", tie.port, tie.level);
    }
    format!("module top ({});\n{body}endmodule\n", list.join(", "))
}

/// A directory with everything that the script needs. Its name contains a space.
fn folder(board: &Board) -> tempfile::TempDir {
    let folder = tempfile::Builder::new().prefix("a board ").tempdir().unwrap();
    for file in files(board, &ports(board)).unwrap() {
        std::fs::write(folder.path().join(file.name), file.text).unwrap();
    }
    std::fs::write(folder.path().join("top.v"), top(board)).unwrap();
    folder
}

fn run(tool: &str, arguments: &[&str], folder: &Path) {
    let (ok, said) = common::run(tool, arguments, folder);
    assert!(ok, "{tool} {arguments:?}: {said}");
}

/// Builds with the script that users run, started in another directory. nextpnr must know every pin
/// and place the PLL, and the last tool must make a bitstream. nextpnr for ECP5 is slow,
/// so that a test run builds for one such board only; `cargo xtask long self-test` builds all.
#[test]
fn script_of_every_placed_board_builds_a_bitstream_with_all_pins() {
    run_scripts(|board| match board.family.facts().placer() {
        Some(Placer::Ice40) => true,
        Some(Placer::Ecp5) => is_every_board() || board.name == "ulx3s",
        Some(Placer::Gowin) | None => false,
    });
}

/// The same for Gowin boards: one in a test run, and all by `cargo xtask long gowin`.
#[test]
fn script_of_a_gowin_board_builds_a_bitstream_with_all_pins() {
    run_scripts(|board| {
        board.family == Family::Gowin && (is_every_board() || board.name == "tang-nano-9k")
    });
}

fn is_every_board() -> bool {
    std::env::var_os("CARRYSTEP_BOARDS").is_some()
}

fn run_scripts(is_chosen: impl Fn(&Board) -> bool) {
    for board in boards().iter().filter(|board| is_chosen(board)) {
        let folder = folder(board);
        run("sh", &[folder.path().join("build.sh").to_str().unwrap()], Path::new("/"));
        let bitstream = folder.path().join(format!("top.{}", board.bitstream));
        assert!(std::fs::metadata(bitstream).unwrap().len() > 30_000, "{}", board.name);
    }
}

/// yosys must know the cells and the ports of the clock module of a board of every Spartan.
#[test]
fn clock_module_of_every_spartan_uses_known_cells() {
    for of_one_family in boards().chunk_by(|a, b| a.family == b.family) {
        let board = &of_one_family[0];
        let Some(family) = board.family.facts().yosys() else { continue };
        let folder = folder(board);
        let script = format!(
            "read_verilog carrystep_clock.v top.v; synth_xilinx -family {family} -nowidelut -flatten -top top; \
             check -assert; select -assert-count 1 t:DCM* t:MMCM*"
        );
        run("yosys", &["-q", "-p", &script], folder.path());
    }
}

#[test]
fn constraints_contain_exactly_the_ports_of_the_top_level() {
    let board = board("icestick").unwrap();
    let text =
        files(board, &["uart_rx", "step[0]", "dir"].map(str::to_owned)).unwrap().remove(1).text;
    let lines: Vec<&str> = text.lines().filter(|line| line.starts_with("set_io")).collect();
    assert_eq!(
        lines,
        [
            "set_io oscillator 21",
            "set_io -pullup yes uart_rx 9",
            "set_io step[0] 112",
            "set_io dir 62"
        ]
    );
    let refused = files(board, &["limit_max[0]".to_owned()]).unwrap_err().to_string();
    assert_eq!(refused, "icestick has no pin for limit_max[0]");
}

/// The constraints of every ECP5 board place each port on the pin that the board's file gives it,
/// and nothing else.
#[test]
fn constraints_of_an_ecp5_place_every_port_on_its_pin() {
    for board in boards().iter().filter(|board| board.family == Family::Ecp5) {
        let files = files(board, &ports(board)).unwrap();
        let text = &files.iter().find(|file| file.name.ends_with(".lpf")).unwrap().text;
        let quoted = |line: &str| {
            let mut words = line.strip_prefix("LOCATE COMP ")?.split('"');
            Some((words.nth(1)?.to_owned(), words.nth(1)?.to_owned()))
        };
        let found: BTreeMap<String, String> = text.lines().filter_map(quoted).collect();
        let wires = board.wires.iter().filter(|wire| !wire.beside_uart);
        let pins = wires.map(|wire| (wire.port.clone(), wire.pin.clone()));
        let ties = board.ties.iter().map(|tie| (tie.port.clone(), tie.pin.clone()));
        let oscillator = [(OSCILLATOR.to_owned(), board.oscillator.pin.clone())];
        let known: BTreeMap<String, String> = pins.chain(ties).chain(oscillator).collect();
        assert_eq!(found, known, "{}", board.name);
    }
}

/// The constraints of every Gowin board place each port on the pin that the board's file gives it,
/// with the voltage of its bank, and nothing else.
#[test]
fn constraints_of_a_gowin_part_place_every_port_on_its_pin() {
    for board in boards().iter().filter(|board| board.family == Family::Gowin) {
        let files = files(board, &ports(board)).unwrap();
        let text = &files.iter().find(|file| file.name.ends_with(".cst")).unwrap().text;
        let rows = |kind: &str| -> BTreeMap<String, String> {
            let row = |line: &str| {
                let (port, rest) =
                    line.strip_prefix(kind)?.strip_prefix(" \"")?.split_once("\" ")?;
                Some((port.to_owned(), rest.split([' ', ';']).next()?.to_owned()))
            };
            text.lines().filter_map(row).collect()
        };
        let wires = || board.wires.iter().filter(|wire| !wire.beside_uart);
        let oscillator = &board.oscillator;
        let pins = wires().map(|wire| (wire.port.clone(), wire.pin.clone()));
        let known: BTreeMap<String, String> =
            pins.chain([(OSCILLATOR.to_owned(), oscillator.pin.clone())]).collect();
        assert_eq!(rows("IO_LOC"), known, "{}", board.name);
        let standard =
            |port: &str| format!("IO_TYPE={}", if port == "led" { "LVCMOS18" } else { "LVCMOS33" });
        let known: BTreeMap<String, String> =
            known.into_keys().map(|port| (port.clone(), standard(&port))).collect();
        assert_eq!(rows("IO_PORT"), known, "{}", board.name);
    }
}

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
            "[[machine.axis]]\nname = \"u\"\nsteps_per_unit = 1\nspeed_limit = 1\naccel_limit = 1\ndriver = \"a4988\"\n\n[[machine.axis]]",
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
            "[[machine.axis]]\nname = \"u\"\nsteps_per_unit = 1\nspeed_limit = 1\naccel_limit = 1\ndriver = \"a4988\"\n\n[[machine.axis]]",
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

/// Exactly the scripts of the directory are executable.
#[test]
fn only_scripts_are_executable() {
    for board in boards() {
        for file in Gateware::shipped(board, &board.parts[0]).unwrap().files().unwrap() {
            assert_eq!(file.executable, file.name == "build.sh", "{}", file.name);
        }
    }
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
