//! The directories of the boards: pins, clocks and scripts must work with the open tools.
#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches unit tests only")]

mod common;

use carrystep_boards::{Board, Family, OSCILLATOR, PORTS, Placer, Way, board, boards};
use carrystep_verilog::{Design, ExportError, Gateware, Prefix, TextFile};
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
/// and place the PLL, and the last tool must make a bitstream. A script whose answer is kept is not
/// run again (docs/decisions/0053). nextpnr for ECP5 is slow, so that a test run builds for one such
/// board only; `cargo xtask long self-test` builds all.
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

/// Starts the script of this folder in another one. The script takes the tools that it finds, and none
/// that a variable names.
const ELSEWHERE: &str = "unset YOSYS NEXTPNR ICEPACK ECPPACK GOWIN_PACK; here=$PWD; cd /; \
    exec sh \"$here/build.sh\"";

fn run_scripts(is_chosen: impl Fn(&Board) -> bool) {
    for board in boards().iter().filter(|board| is_chosen(board)) {
        let folder = folder(board);
        run("sh", &["-c", ELSEWHERE], folder.path());
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

/// Exactly the scripts of the directory are executable.
#[test]
fn only_scripts_are_executable() {
    for board in boards() {
        for file in Gateware::shipped(board, &board.parts[0]).unwrap().files().unwrap() {
            assert_eq!(file.executable, file.name == "build.sh", "{}", file.name);
        }
    }
}
