//! Writes `hdl-out/boards.md`: the resources that the gateware of each board uses, and the clock
//! that it reaches.

use super::{BuildJob, Built, build};
use crate::resources::failed;
use crate::{SynthesisError, ice40, xilinx};
use carrystep_boards::{AllMeasured, Board, Mapped, Measured, Placed, boards};
use carrystep_core::tick::mhz;
use carrystep_verilog::Gateware;

/// Path of the page, from the root of the workspace.
pub const PAGE: &str = "hdl-out/boards.md";

/// Builds the committed gateware of a board.
///
/// # Errors
/// [`SynthesisError`] if there is no such gateware, or if a tool is missing or refuses it.
pub fn built(board: &Board) -> Result<Built, SynthesisError> {
    let gateware = gateware(board)?;
    let files = gateware.files().map_err(failed)?;
    let texts = |extension: &str| -> String {
        files
            .iter()
            .filter(|file| file.name.ends_with(extension))
            .map(|file| file.text.as_str())
            .collect()
    };
    let part = gateware.part();
    let job = BuildJob {
        verilog: &texts(".v"),
        top: &gateware.top(),
        pcf: &texts(".pcf"),
        part: ice40::NextpnrPart { device: &part.name, package: &part.package },
        clock_hz: gateware.build().timebase.clock_hz(),
    };
    build(&job, &mut |_| {})
}

/// The figures of an iCE40 board as they are published: clocks are rounded to 0.1 MHz, but a missed
/// clock is not rounded up to the required one.
pub fn placed(board: &Board, built: &Built) -> Placed {
    let reached = built.reaches(board.clocks[0].clock_hz);
    let tenths =
        |mhz: f64| if reached { (mhz * 10.0).round() } else { (mhz * 10.0).floor() } / 10.0;
    Placed {
        logic_cells: built.size.logic_cells,
        block_rams: built.size.block_rams,
        nextpnr_mhz: tenths(built.mhz),
        icetime_mhz: tenths(built.icetime_mhz),
        seed: built.seed,
    }
}

/// Builds all boards; `say` is called with a line for each.
///
/// # Errors
/// As [`built`].
pub fn measure(say: &mut dyn FnMut(&str)) -> Result<AllMeasured, SynthesisError> {
    let mut all = AllMeasured::new();
    for board in boards() {
        let family = board.family.facts();
        let measured = match (family.toolchain().by_hand, family.yosys()) {
            (Some(_), Some(family)) => Measured::Mapped(cells(board, family)?),
            _ => Measured::Placed(placed(board, &built(board)?)),
        };
        say(row(board, &measured).trim());
        all.insert(board.name.clone(), measured);
    }
    Ok(all)
}

/// The row of a board in the table.
pub fn row(board: &Board, measured: &Measured) -> String {
    let (part, clock) = (&board.parts[0], &board.clocks[0]);
    let time = format!("{} | {} | {}", mhz(clock.clock_hz), clock.tick_ns, clock.phases);
    match *measured {
        Measured::Placed(Placed { logic_cells, block_rams, nextpnr_mhz, icetime_mhz, seed }) => {
            format!(
                "| `{}` | {} | {logic_cells} of {} | {block_rams} of {} | {time} | {nextpnr_mhz:.1} | {icetime_mhz:.1} | {seed} | {} |\n",
                board.name,
                part.name,
                part.logic_cells.unwrap_or_default(),
                part.block_rams,
                if nextpnr_mhz * 1e6 >= clock.clock_hz as f64 { "yes" } else { "**no**" },
            )
        }
        Measured::Mapped(Mapped { luts, flip_flops, carries, block_rams }) => format!(
            "| `{}` | {} | {luts} | {flip_flops} | {carries} | {block_rams} of {} | {time} |\n",
            board.name,
            part.ordered(),
            part.block_rams,
        ),
    }
}

/// The whole page.
pub fn page(all: &AllMeasured) -> String {
    let (mut ours, mut theirs) = (String::new(), String::new());
    for (board, measured) in
        boards().iter().filter_map(|board| Some((board, all.get(&board.name)?)))
    {
        let rows = if matches!(measured, Measured::Placed(_)) { &mut ours } else { &mut theirs };
        rows.push_str(&row(board, measured));
    }
    let in_luts = boards().iter().filter(|board| !board.family.facts().writes_parts_of_words());
    let in_luts: Vec<String> = in_luts.map(|board| format!("`{}`", board.name)).collect();
    let in_luts = match in_luts.as_slice() {
        [before @ .., last] if !before.is_empty() => format!("{} and {last}", before.join(", ")),
        few => few.concat(),
    };
    format!(
        "\
# Boards

What the gateware of each board takes: the shipped machine's six axes, UART link with CRC, limits, e-stop and watchdog, all in the folders beside this page. `cargo xtask long boards` builds all of them and writes
this page; the tests build `icestick` and `icesugar` and compare their rows. None was ever tried on real hardware.

By yosys 0.23, nextpnr 0.4 and icetime, on the pins of the board; the first of five seeds that reaches the clock, or else the best. A tick is as short as the part's clock makes it: six axes take 80 clocks.

| board | part | logic cells | block RAMs | clock, MHz | tick, ns | phases | nextpnr, MHz | icetime, MHz | seed | reached |
|---|---|---|---|---|---|---|---|---|---|---|
{ours}
What yosys makes of it for the Spartans. Their own tools place it, which nobody here has done: whether the clock is reached is not known. A Spartan-3 or 3E cannot write single bits of a block RAM,
so on {in_luts} the engine's wheel of events, the one memory that is written bit by bit, lies in LUTs.

| board | part | LUTs | flip-flops | carry cells | block RAMs | clock, MHz | tick, ns | phases |
|---|---|---|---|---|---|---|---|---|
{theirs}"
    )
}

fn gateware(board: &Board) -> Result<Gateware<'_>, SynthesisError> {
    Gateware::shipped(board, &board.parts[0]).map_err(failed)
}

fn cells(board: &Board, family: &str) -> Result<Mapped, SynthesisError> {
    let gateware = gateware(board)?;
    let verilog: String =
        gateware.verilog().map_err(failed)?.into_iter().map(|file| file.text).collect();
    xilinx::cells(&verilog, &gateware.top(), family)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ice40::Size;
    use carrystep_boards::board;

    #[test]
    fn clock_that_is_narrowly_missed_is_not_rounded_up() {
        let icebreaker = board("icebreaker").expect("a board");
        for (mhz, reached) in [(37.46, false), (37.5, true), (37.56, true)] {
            let size = Size { logic_cells: 1, block_rams: 1 };
            let built = Built { size, seed: 1, mhz, icetime_mhz: mhz, bitstream: Vec::new() };
            let row = row(icebreaker, &Measured::Placed(placed(icebreaker, &built)));
            assert_eq!(row.ends_with("| yes |\n"), reached, "{row}");
        }
    }
}
