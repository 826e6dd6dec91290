//! The boards' folders: constraints as they were, and what the open tools say of them.
#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches unit tests only")]

use carrystep_export::{BoardFile, Design, ExportError};
use carrystep_spec::board::{Board, OSCILLATOR, PORTS, Toolchain, Way, board, boards};
use std::path::Path;
use std::process::Command;

const GOLDEN: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/boards");

/// All ports of a board, bit by bit.
fn ports(board: &Board) -> Vec<&str> {
    board.wires.iter().map(|wire| wire.port.as_str()).collect()
}

/// The files of a top level with these ports.
fn files(board: &Board, ports: &[&str]) -> Result<Vec<BoardFile>, ExportError> {
    let (part, clock_hz) = (&board.parts[0], board.clocks[0].clock_hz);
    Design { board, part, clock_hz, top: "top", sources: &["carrystep_clock.v", "top.v"], ports }.files()
}

/// A top level that uses every pin: inputs meet in a register, outputs are that register.
fn top(board: &Board) -> String {
    let bits = |way: fn(Way) -> bool| {
        let names = PORTS.iter().filter(move |port| way(port.way));
        let counted = names.map(|port| (port.name, port.per_axis, board.bits(port.name)));
        counted.filter(|(_, _, bits)| *bits > 0).collect::<Vec<_>>()
    };
    let (inputs, outputs) = (bits(|way| way != Way::Out), bits(|way| way == Way::Out));
    let range = |per_axis, bits: usize| if per_axis { format!("[{}:0] ", bits - 1) } else { String::new() };
    let mut list = vec![format!("input wire {OSCILLATOR}")];
    list.extend(inputs.iter().map(|(name, per_axis, bits)| format!("input wire {}{name}", range(*per_axis, *bits))));
    list.extend(outputs.iter().map(|(name, per_axis, bits)| format!("output wire {}{name}", range(*per_axis, *bits))));
    list.extend(board.ties.iter().map(|tie| format!("output wire {}", tie.port)));
    let all: Vec<String> = inputs.iter().map(|(name, ..)| format!("^{name}")).collect();
    let mut body = format!(
        "wire clock, locked; carrystep_clock made (.oscillator({OSCILLATOR}), .clock(clock), .locked(locked));\n\
         reg r = 1'b0; always @(posedge clock) r <= locked ^ {};\n",
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

/// A folder with everything that the script needs; its name has a blank.
fn folder(board: &Board) -> tempfile::TempDir {
    let folder = tempfile::Builder::new().prefix("a board ").tempdir().unwrap();
    for file in files(board, &ports(board)).unwrap() {
        std::fs::write(folder.path().join(file.name), file.text).unwrap();
    }
    std::fs::write(folder.path().join("top.v"), top(board)).unwrap();
    folder
}

fn run(tool: &str, arguments: &[&str], folder: &Path) {
    let output = Command::new(tool).args(arguments).current_dir(folder).output();
    let output = output.unwrap_or_else(|_| panic!("{tool} is not installed: `cargo xtask tools` installs it"));
    let said = String::from_utf8_lossy(&output.stdout) + String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{tool} {arguments:?}: {said}");
}

/// nextpnr knows every pin and finds a place for the PLL; icepack makes a bitstream. By the script that a user runs, from
/// another folder.
#[test]
fn every_ice40_board_is_placed_on_all_its_pins_by_its_own_script() {
    for board in boards().iter().filter(|board| board.family.toolchain() == Toolchain::Open) {
        let folder = folder(board);
        run("sh", &[folder.path().join("build.sh").to_str().unwrap()], Path::new("/"));
        assert!(std::fs::metadata(folder.path().join("top.bin")).unwrap().len() > 30_000, "{}", board.name);
    }
}

/// yosys knows the cells of every Spartan's clock, and their ports.
#[test]
fn every_spartan_s_clock_is_of_cells_that_yosys_knows() {
    for name in ["s3board", "nexys2", "papilio-pro", "arty-s7"] {
        let board = board(name).unwrap();
        let folder = folder(board);
        let family = board.family.yosys().unwrap();
        let script = format!(
            "read_verilog carrystep_clock.v top.v; synth_xilinx -family {family} -nowidelut -flatten -top top; \
             check -assert; select -assert-count 1 t:DCM* t:MMCM*"
        );
        run("yosys", &["-q", "-p", &script], folder.path());
    }
}

/// One of each toolchain; `CARRYSTEP_GOLDEN=write` writes them anew.
#[test]
fn constraints_clocks_and_scripts_are_as_they_were() {
    for name in ["icestick", "tinyfpga-bx", "nexys2", "mojo-v3", "arty-s7"] {
        let board = board(name).unwrap();
        for file in files(board, &ports(board)).unwrap() {
            let path = Path::new(GOLDEN).join(name).join(&file.name);
            if std::env::var("CARRYSTEP_GOLDEN").is_ok() {
                std::fs::create_dir_all(path.parent().unwrap()).unwrap();
                std::fs::write(&path, &file.text).unwrap();
            }
            let golden = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
            assert_eq!(file.text, golden, "{}", path.display());
            assert_eq!(file.executable, file.name == "build.sh");
        }
    }
}

#[test]
fn a_top_level_gets_the_pins_of_its_ports_and_no_others() {
    let board = board("icestick").unwrap();
    let text = files(board, &["uart_rx", "step[0]", "dir"]).unwrap().remove(1).text;
    let lines: Vec<&str> = text.lines().filter(|line| line.starts_with("set_io")).collect();
    assert_eq!(lines, ["set_io oscillator 21", "set_io -pullup yes uart_rx 9", "set_io step[0] 112", "set_io dir 62"]);
    let refused = files(board, &["limit_max[0]"]).unwrap_err().to_string();
    assert_eq!(refused, "icestick has no pin for limit_max[0]");
}

#[test]
fn a_clock_that_the_board_cannot_make_is_refused() {
    let board = board("alchitry-cu").unwrap();
    let part = &board.parts[0];
    let design = Design { board, part, clock_hz: 48_000_000, top: "top", sources: &[], ports: &[] };
    let refused = design.files().unwrap_err().to_string();
    assert!(
        refused.starts_with("alchitry-cu: the PLL makes no clock of 48 MHz from 100 MHz; the nearest"),
        "{refused}"
    );
}
