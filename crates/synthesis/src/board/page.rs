//! `hdl-out/boards.md`: what the gateware of each board takes, and the clock that it reaches.

use super::{Built, Job, build};
use crate::resources::failed;
use crate::xilinx::{self, Cells};
use crate::{SynthesisError, ice40};
use carrystep_export::Gateware;
use carrystep_spec::board::{Board, boards};
use carrystep_spec::clock::mhz;

/// Where it is, seen from the root of the workspace.
pub const PAGE: &str = "hdl-out/boards.md";

/// The committed gateware of a board, built.
///
/// # Errors
/// [`SynthesisError`]: there is no such gateware, or a tool is missing or refuses it.
pub fn built(board: &Board) -> Result<Built, SynthesisError> {
    let gateware = gateware(board)?;
    let files = gateware.files().map_err(failed)?;
    let texts = |extension: &str| -> String {
        files.iter().filter(|file| file.name.ends_with(extension)).map(|file| file.text.as_str()).collect()
    };
    let part = gateware.part();
    let job = Job {
        verilog: &texts(".v"),
        top: &gateware.top(),
        pcf: &texts(".pcf"),
        part: ice40::Part { device: &part.name, package: &part.package },
        clock_hz: gateware.build().timebase.clock_hz(),
    };
    build(&job, &mut |_| {})
}

/// The row of an iCE40 board.
pub fn row(board: &Board, built: &Built) -> String {
    let (part, clock) = (&board.parts[0], &board.clocks[0]);
    let (cells, rams) = (built.size.logic_cells, built.size.block_rams);
    let of = part.logic_cells.unwrap_or_default();
    let reached = if built.reaches(clock.clock_hz) { "yes" } else { "**no**" };
    format!(
        "| `{}` | {} | {cells} of {of} | {rams} of {} | {} | {} | {} | {:.1} | {:.1} | {} | {reached} |\n",
        board.name,
        part.name,
        part.block_rams,
        mhz(clock.clock_hz),
        clock.tick_ns,
        clock.phases,
        built.mhz,
        built.icetime_mhz,
        built.seed
    )
}

/// The whole page; `say` hears of each row.
///
/// # Errors
/// As [`built`].
pub fn page(say: &mut dyn FnMut(&str)) -> Result<String, SynthesisError> {
    let (mut ours, mut theirs) = (String::new(), String::new());
    for board in boards() {
        let (rows, row) = match board.family.yosys() {
            None => (&mut ours, row(board, &built(board)?)),
            Some(family) => (&mut theirs, cells_row(board, &cells(board, family)?)),
        };
        say(row.trim());
        rows.push_str(&row);
    }
    Ok(format!(
        "\
# Boards

What the gateware of each board takes: the shipped machine's six axes, UART link with CRC, limits, e-stop and watchdog, all in the folders beside this page. `cargo xtask long boards` builds all of them and writes
this page; the tests build `icestick` and `icesugar` and compare their rows. None was ever tried on real hardware.

By yosys 0.23, nextpnr 0.4 and icetime, on the pins of the board; the first of five seeds that reaches the clock, or else the best. A tick is as short as the part's clock makes it: six axes take 79 clocks.

| board | part | logic cells | block RAMs | clock, MHz | tick, ns | phases | nextpnr, MHz | icetime, MHz | seed | reached |
|---|---|---|---|---|---|---|---|---|---|---|
{ours}
What yosys makes of it for the Spartans. Their own tools place it, which nobody here has done: whether the clock is reached is not known. A Spartan-3 or 3E cannot write single bits of a block RAM,
so on `s3board`, `nexys2` and `papilio-one` the engine's wheel of events, the one memory that is written bit by bit, lies in LUTs.

| board | part | LUTs | flip-flops | carry cells | block RAMs | clock, MHz | tick, ns | phases |
|---|---|---|---|---|---|---|---|---|
{theirs}"
    ))
}

fn gateware(board: &Board) -> Result<Gateware<'_>, SynthesisError> {
    Gateware::shipped(board, &board.parts[0]).map_err(failed)
}

fn cells(board: &Board, family: &str) -> Result<Cells, SynthesisError> {
    let gateware = gateware(board)?;
    let verilog: String = gateware.verilog().map_err(failed)?.into_iter().map(|file| file.text).collect();
    xilinx::cells(&verilog, &gateware.top(), family)
}

fn cells_row(board: &Board, cells: &Cells) -> String {
    let (part, clock) = (&board.parts[0], &board.clocks[0]);
    let Cells { luts, flip_flops, carries, block_rams } = cells;
    format!(
        "| `{}` | {} | {luts} | {flip_flops} | {carries} | {block_rams} of {} | {} | {} | {} |\n",
        board.name,
        part.ordered(),
        part.block_rams,
        mhz(clock.clock_hz),
        clock.tick_ns,
        clock.phases
    )
}
