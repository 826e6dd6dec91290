//! `carrystep boards`: the supported boards and the assignment of their pins.

use crate::arguments::Boards;
use crate::failure::Failure;
use crate::output;
use carrystep_boards::{Board, BoardError, Mapped, Measured, Part, Place, Placed, board, boards};
use carrystep_core::tick::mhz;
use carrystep_files::SourceText;
use carrystep_verilog::Gateware;
use schemars::JsonSchema;
use serde::Serialize;
use std::borrow::Cow;
use std::fmt::Write as _;
use std::path::Path;

/// The notice under every list: no board has been tested.
const UNTRIED: &str =
    "None of these boards was at hand: nothing of carrystep was ever run on one.\n";

/// What `--json` prints.
#[derive(JsonSchema, Serialize)]
pub struct ShownBoards<'a> {
    passed: bool,
    /// Whether carrystep was ever tested on real hardware.
    tried_on_hardware: bool,
    boards: Vec<ShownBoard<'a>>,
}

#[derive(JsonSchema, Serialize)]
struct ShownBoard<'a> {
    #[serde(flatten)]
    board: &'a Board,
    /// The resources that the shipped gateware uses.
    #[serde(skip_serializing_if = "Option::is_none")]
    measured: Option<Measured>,
}

/// Shows all boards, or one.
pub fn run(arguments: &Boards) -> Result<(), Failure> {
    let one = arguments.board.as_deref().map(find).transpose()?;
    let shown = one.as_deref().map_or(boards(), std::slice::from_ref);
    if arguments.json {
        let boards =
            shown.iter().map(|board| ShownBoard { board, measured: board.measured() }).collect();
        return output::print_json(&ShownBoards { passed: true, tried_on_hardware: false, boards });
    }
    output::print(&one.as_deref().map_or_else(list, in_full))
}

/// A board by its name, or from a board file.
pub fn find(name: &str) -> Result<Cow<'static, Board>, Failure> {
    match board(name) {
        Ok(board) => Ok(Cow::Borrowed(board)),
        Err(_) if Path::new(name).extension().is_some_and(|extension| extension == "toml") => {
            Ok(Cow::Owned(Board::load(Path::new(name))?))
        }
        Err(error @ BoardError::Unknown { .. }) => {
            Err(Failure::input(format!("{error}; or the file of a board of your own, BOARD.toml")))
        }
        Err(error) => Err(error.into()),
    }
}

/// The gateware of a machine file, or of the shipped machine, for one of the board's parts.
pub fn gateware<'a>(
    board: &'a Board,
    part: Option<&str>,
    machine: Option<&Path>,
) -> Result<Gateware<'a>, Failure> {
    let part = board.part(part)?;
    Ok(match machine {
        Some(path) => Gateware::new(board, part, SourceText::read(path)?)?,
        None => Gateware::shipped(board, part)?,
    })
}

/// The list of all boards, one line each.
fn list() -> String {
    let mut text = format!(
        "{:<13}  {:<9}  {:>5}  {:>4}  {:>6}  {:>16}  {:>8}  {:>5}  board\n",
        "name", "part", "MHz", "tick", "phases", "logic", "RAMs", "Fmax"
    );
    for board in boards() {
        let (part, clock) = (&board.parts[0], &board.clocks[0]);
        let [logic, rams, fmax] = match board.measured() {
            Some(Measured::Placed(Placed {
                logic_cells,
                block_rams,
                nextpnr_mhz,
                least_mhz,
                ..
            })) => [
                part.logic_cells.map_or_else(String::new, |of| {
                    let unit = if least_mhz.is_some() { "LUTs" } else { "LC" };
                    format!("{logic_cells}/{of} {unit}")
                }),
                format!("{block_rams}/{}", part.block_rams),
                format!("{nextpnr_mhz:.1}"),
            ],
            Some(Measured::Mapped(Mapped { luts, block_rams, .. })) => [
                format!("{luts} LUTs"),
                format!("{block_rams}/{}", part.block_rams),
                "-".to_owned(),
            ],
            None => ["-".to_owned(), "-".to_owned(), "-".to_owned()],
        };
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "{:<13}  {:<9}  {:>5}  {:>4}  {:>6}  {logic:>16}  {rams:>8}  {fmax:>5}  {}",
            board.name,
            part.name,
            mhz(clock.clock_hz),
            clock.tick_ns,
            clock.phases,
            board.title
        );
    }
    text + "tick in ns, Fmax in MHz by nextpnr; what a Spartan reaches only ISE or Vivado can say. `carrystep boards BOARD` shows its\n\
            pins, and its other parts and clocks.\n"
        + UNTRIED
}

/// All data of one board.
fn in_full(board: &Board) -> String {
    let parts: Vec<String> = board.parts.iter().map(Part::ordered).collect();
    let mut text = format!(
        "{}: {}, {}\nmade by      {}\noscillator   {} MHz on pin {}\nload it      {}\n\n",
        board.name,
        board.title,
        parts.join(" or "),
        board.family.facts().toolchain(),
        mhz(board.oscillator.hz),
        board.oscillator.pin,
        board.flash
    );
    for (index, clock) in board.clocks.iter().enumerate() {
        let which = if index == 0 { "clock" } else { "or" };
        let _ = writeln!(
            text,
            "{which:<11}  {} MHz, ticks of {} ns in {} phases: {}",
            mhz(clock.clock_hz),
            clock.tick_ns,
            clock.phases,
            clock.why
        );
    }
    let first = &board.parts[0];
    let _ = match board.measured() {
        Some(Measured::Placed(Placed {
            logic_cells,
            block_rams,
            nextpnr_mhz,
            icetime_mhz,
            least_mhz,
            ..
        })) => writeln!(
            text,
            "measured     {logic_cells} of {} {}, {block_rams} of {} block RAMs, {nextpnr_mhz:.1} MHz by nextpnr{}{}",
            first.logic_cells.unwrap_or_default(),
            board.family.facts().cells(),
            first.block_rams,
            least_mhz
                .map(|mhz| format!(", {mhz:.1} MHz or more with each of five seeds"))
                .unwrap_or_default(),
            icetime_mhz.map(|mhz| format!(", {mhz:.1} MHz by icetime")).unwrap_or_default()
        ),
        Some(Measured::Mapped(Mapped { luts, flip_flops, block_rams, .. })) => writeln!(
            text,
            "measured     {luts} LUTs, {flip_flops} flip-flops, {block_rams} of {} block RAMs by yosys; never placed",
            first.block_rams
        ),
        None => Ok(()),
    };
    if board.measured().is_some() {
        let compared = board.family.compared();
        let _ = writeln!(text, "compared     {compared}, with Rust-HDL on every pin");
    }
    let _ = writeln!(text, "\n{:<12}  {:<4}  at", "port", "pin");
    for wire in &board.wires {
        let at = wire.at.as_ref().map_or_else(
            || "on the board".to_owned(),
            |Place { connector, label }| format!("{connector}, {label}"),
        );
        let _ = writeln!(text, "{:<12}  {:<4}  {at}", wire.port, wire.pin);
    }
    for tie in &board.ties {
        let _ = writeln!(text, "{:<12}  {:<4}  {}", tie.port, tie.pin, tie.why);
    }
    let _ = writeln!(text, "pins are 3.3 V\n");
    for note in &board.notes {
        let _ = writeln!(text, "note: {note}");
    }
    for conflict in &board.conflicts {
        let _ = writeln!(text, "sources disagree: {conflict}");
    }
    text + UNTRIED
}
