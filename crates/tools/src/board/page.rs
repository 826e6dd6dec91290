//! Writes `hdl-out/boards.md`: the resources that the gateware of each board uses, and the clock
//! that it reaches.

use super::{BuildJob, Built, build, clocks_of_seeds};
use crate::resources::failed;
use crate::{SynthesisError, xilinx};
use carrystep_boards::{AllMeasured, Board, Mapped, Measured, Placed, Placer, board, boards};
use carrystep_core::tick::mhz;
use carrystep_verilog::Gateware;
use std::sync::Mutex;

/// Path of the page, from the root of the workspace.
pub const PAGE: &str = "hdl-out/boards.md";

/// Builds the committed gateware of a board.
///
/// # Errors
/// [`SynthesisError`] if there is no such gateware, or if a tool is missing or refuses it.
pub fn built(board: &Board) -> Result<Built, SynthesisError> {
    of_job(board, |job| build(job, &mut |_| {}))
}

/// The least clock, MHz, of all seeds for a board that must reach its clock with each of them.
///
/// # Errors
/// As [`built`].
pub fn least_clock(board: &Board) -> Result<Option<f64>, SynthesisError> {
    let clocks = of_job(board, clocks_of_seeds)?;
    Ok(clocks.map(|clocks| clocks.into_iter().fold(f64::INFINITY, f64::min)))
}

/// What is made of the committed gateware of a board.
fn of_job<T>(
    board: &Board,
    make: impl Fn(&BuildJob<'_>) -> Result<T, SynthesisError>,
) -> Result<T, SynthesisError> {
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
        constraints: &texts(board.family.facts().toolchain().constraints_end()),
        part,
        clock_hz: gateware.build().timebase.clock_hz(),
    };
    make(&job)
}

/// The figures of a placed board as they are published: clocks are rounded to 0.1 MHz, but a missed
/// clock is not rounded up to the required one. `least_mhz` is that of [`least_clock`].
pub fn placed(board: &Board, built: &Built, least_mhz: Option<f64>) -> Placed {
    let needed = board.clocks[0].clock_hz;
    let tenths = |mhz: f64| {
        let reached = mhz * 1e6 >= needed as f64;
        (if reached { (mhz * 10.0).round() } else { (mhz * 10.0).floor() }) / 10.0
    };
    Placed {
        least_mhz: least_mhz.map(tenths),
        logic_cells: built.size.logic_cells,
        block_rams: built.size.block_rams,
        nextpnr_mhz: tenths(built.mhz),
        icetime_mhz: built.icetime_mhz.map(tenths),
        seed: built.seed,
    }
}

/// Whether a board is measured where no name is given. Those of Gowin are named, because
/// `cargo xtask long gowin` builds them.
pub fn is_measured_unasked(board: &Board) -> bool {
    board.family.facts().placer() != Some(Placer::Gowin)
}

/// Builds the boards of these names, or those of [`is_measured_unasked`] if there is none, as many
/// at a time as the computer has cores. The others keep their figures. `say` is called with a line
/// for each board that is built.
///
/// # Errors
/// As [`built`], or if there is no board of a name.
pub fn measure(
    names: &[String],
    say: &(dyn Fn(&str) + Sync),
) -> Result<AllMeasured, SynthesisError> {
    if let Some(error) = names.iter().find_map(|name| board(name).err()) {
        return Err(failed(error));
    }
    let is_asked = |board: &&Board| match names {
        [] => is_measured_unasked(board),
        names => names.contains(&board.name),
    };
    let asked = Mutex::new(boards().iter().filter(is_asked));
    let next = || asked.lock().ok().and_then(|mut asked| asked.next());
    let worker = || {
        let mut done = Vec::new();
        while let Some(board) = next() {
            let measured = of_board(board)?;
            say(row(board, &measured).trim());
            done.push((board.name.clone(), measured));
        }
        Ok(done)
    };
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let done: Result<Vec<_>, SynthesisError> = std::thread::scope(|scope| {
        let workers: Vec<_> = (0..cores).map(|_| scope.spawn(worker)).collect();
        let ended = workers.into_iter().map(|worker| worker.join());
        ended.map(|done| done.unwrap_or_else(|_| Err(failed("a build ended early")))).collect()
    });
    let known = boards().iter().filter_map(|board| Some((board.name.clone(), board.measured()?)));
    Ok(known.chain(done?.into_iter().flatten()).collect())
}

/// The figures of a board.
fn of_board(board: &Board) -> Result<Measured, SynthesisError> {
    Ok(match board.family.facts().yosys() {
        Some(family) => Measured::Mapped(cells(board, family)?),
        None => Measured::Placed(placed(board, &built(board)?, least_clock(board)?)),
    })
}

/// The row of a board in the table.
pub fn row(board: &Board, measured: &Measured) -> String {
    let (part, clock) = (&board.parts[0], &board.clocks[0]);
    let time = format!("{} | {} | {}", mhz(clock.clock_hz), clock.tick_ns, clock.phases);
    match *measured {
        Measured::Placed(Placed {
            logic_cells,
            block_rams,
            nextpnr_mhz,
            icetime_mhz,
            seed,
            least_mhz,
        }) => {
            let also =
                |mhz: Option<f64>| mhz.map_or_else(String::new, |mhz| format!("{mhz:.1} | "));
            let counts = least_mhz.unwrap_or(nextpnr_mhz);
            format!(
                "| `{}` | {} | {logic_cells} of {} | {block_rams} of {} | {time} | {nextpnr_mhz:.1} | {}{seed} | {}{} |\n",
                board.name,
                part.name,
                part.logic_cells.unwrap_or_default(),
                part.block_rams,
                also(icetime_mhz),
                also(least_mhz),
                if counts * 1e6 >= clock.clock_hz as f64 { "yes" } else { "**no**" },
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
    let [mut ice40, mut ecp5, mut gowin, mut spartan] = [const { String::new() }; 4];
    for (board, measured) in
        boards().iter().filter_map(|board| Some((board, all.get(&board.name)?)))
    {
        let rows = match board.family.facts().placer() {
            Some(Placer::Ice40) => &mut ice40,
            Some(Placer::Ecp5) => &mut ecp5,
            Some(Placer::Gowin) => &mut gowin,
            None => &mut spartan,
        };
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

By yosys 0.70, nextpnr 0.4 and icetime, on the pins of the board; the first of five seeds with which
nextpnr reaches the clock, or else the best. A tick is as short as the part's clock makes it: six
axes take 80 clocks.

| board | part | logic cells | block RAMs | clock, MHz | tick, ns | phases | nextpnr, MHz | icetime, MHz | seed | reached |
|---|---|---|---|---|---|---|---|---|---|---|
{ice40}
The same on an ECP5, by yosys 0.23 and nextpnr 0.11. LUTs are counted with those of carry chains. Such a board must reach its clock with each of the five seeds, not with one of them.
No way back from a bitstream of this family to Verilog is known to us: what is compared with Rust-HDL on every pin is the netlist that yosys makes and nextpnr places.

| board | part | LUTs | block RAMs | clock, MHz | tick, ns | phases | nextpnr, MHz | seed | least of five seeds, MHz | each reached |
|---|---|---|---|---|---|---|---|---|---|---|
{ecp5}
The same on a Gowin part, by yosys 0.70, nextpnr 0.11 and apycula 0.32. Such a board
must reach its clock with each of the five seeds, too. What is compared is the netlist again: what
`gowin_unpack` reads from a bitstream lacks the kinds and contents of block RAMs. `cargo xtask long
gowin` builds these boards.

| board | part | LUTs | block RAMs | clock, MHz | tick, ns | phases | nextpnr, MHz | seed | least of five seeds, MHz | each reached |
|---|---|---|---|---|---|---|---|---|---|---|
{gowin}
What yosys makes of it for the Spartans. Their own tools place it, which nobody here has done: whether the clock is reached is not known. A Spartan-3 or 3E cannot write single bits of a block RAM,
so on {in_luts} the engine's wheel of events, the one memory that is written bit by bit, lies in LUTs.

| board | part | LUTs | flip-flops | carry cells | block RAMs | clock, MHz | tick, ns | phases |
|---|---|---|---|---|---|---|---|---|
{spartan}"
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

    #[test]
    fn clock_that_is_narrowly_missed_is_not_rounded_up() {
        let icebreaker = board("icebreaker").expect("a board");
        for (mhz, reached) in [(37.46, false), (37.5, true), (37.56, true)] {
            let size = Size { logic_cells: 1, block_rams: 1 };
            let built = Built { size, seed: 1, mhz, icetime_mhz: Some(mhz), bitstream: Vec::new() };
            let row = row(icebreaker, &Measured::Placed(placed(icebreaker, &built, None)));
            assert_eq!(row.ends_with("| yes |\n"), reached, "{row}");
        }
    }
}
