//! Generates `docs/boards/` (a page for each board and one for all) and `docs/drivers.md` from the
//! data of `spec`.

use super::{kind, place, rendered};
use crate::ExportError;
use crate::write::TextFile;
use carrystep_boards::{Board, Clocking, ConfigurationMode, Gate, PullUps, Shared, Wire, boards};
use carrystep_core::engine::QUEUE_DEPTHS;
use carrystep_core::tick::mhz;
use carrystep_files::driver::{Driver, drivers};
use minijinja::{Value, context};

/// Bits of a block RAM of an iCE40.
const RAM_BITS: usize = 4096;

/// Block RAMs of engine and link with the shortest queues (`hdl-out/resources.md`).
const SHORTEST_RAMS: usize = 15;

/// The pages, with their paths in the workspace.
///
/// # Errors
/// [`ExportError::Template`] if a template uses a value that does not exist.
pub(crate) fn pages() -> Result<Vec<TextFile>, ExportError> {
    let all: Vec<Value> = boards().iter().map(values).collect();
    let mut pages = vec![
        TextFile::new(
            "docs/boards/index.md",
            rendered("index.md", context! { boards => all.clone() })?,
        ),
        TextFile::new(
            "docs/drivers.md",
            rendered("drivers.md", context! { drivers => all_drivers() })?,
        ),
    ];
    for (board, values) in boards().iter().zip(all) {
        pages.push(TextFile::new(
            format!("docs/boards/{}.md", board.name),
            rendered("page.md", values)?,
        ));
    }
    Ok(pages)
}

fn all_drivers() -> Vec<Value> {
    let row = |(name, driver): (&String, &Driver)| {
        let Driver { step_high_ns, step_low_ns, dir_setup_ns, dir_hold_ns, evidence } = driver;
        let (step_high_ns, step_low_ns, dir_setup_ns, dir_hold_ns) =
            (*step_high_ns, *step_low_ns, *dir_setup_ns, *dir_hold_ns);
        context! { name, step_high_ns, step_low_ns, dir_setup_ns, dir_hold_ns, evidence }
    };
    drivers().iter().map(row).collect()
}

/// The values of a board's page.
fn values(board: &Board) -> Value {
    context! {
        name => &board.name,
        title => &board.title,
        family => board.family.to_string(),
        placed => board.family.facts().placer().is_some(),
        cells => board.family.facts().cells(),
        toolchain => board.family.facts().toolchain().to_string(),
        compared => board.family.compared(),
        parts => board.parts.iter().map(|part| context! {
            name => &part.name,
            ordered => part.ordered(),
            logic_cells => part.logic_cells,
            block_rams => part.block_rams,
        }).collect::<Vec<_>>(),
        oscillator => context! { mhz => mhz(board.oscillator.hz), pin => &board.oscillator.pin, io => board.oscillator.io.name() },
        io => board.io.name(),
        clocks => board.clocks.iter().map(clocking).collect::<Vec<_>>(),
        wires => board.wires.iter().map(wire).collect::<Vec<_>>(),
        limits => context! { low => board.bits("limit_min"), high => board.bits("limit_max") },
        queue_depth => board.queue_depth,
        queues => QUEUE_DEPTHS.map(|depth| {
            // A slot has eight words of 32 bits for each of eight axes.
            let more = (depth + 1) * 8 * 8 * 32 / RAM_BITS - 4;
            context! { depth, block_rams => SHORTEST_RAMS + more }
        }).to_vec(),
        pull_ups => pull_ups(board.family.facts().pull_ups()),
        ties => super::ties(board),
        gate => board.gate.as_ref().map(gate),
        configured => listed(&board.configured),
        shared => board.shared.iter().map(shared).collect::<Vec<_>>(),
        configuration_sources => board.configuration_sources.join("; "),
        flash => board.flash.replace("FILE", &format!("carrystep.{}", board.bitstream)),
        usb => &board.usb,
        vccaux => &board.vccaux,
        notes => &board.notes,
        conflicts => &board.conflicts,
        sources => &board.sources,
    }
}

/// The values of a page that say what pins are until the FPGA is configured.
fn pull_ups(pull_ups: PullUps) -> Value {
    let (always, pin, strongest) = match pull_ups {
        PullUps::Always => (true, None, None),
        PullUps::Unknown => (false, None, None),
        PullUps::ChosenBy { pin, strongest } => (false, Some(pin), strongest),
    };
    let strongest = strongest.map(|one| {
        context! { ua => one.most_ua, source => one.source, ohm => one.resistor_ohm() }
    });
    context! { always, pin, strongest }
}

fn gate(gate: &Gate) -> Value {
    let holds: Vec<String> = gate.holds.iter().map(|port| format!("`{port}`")).collect();
    let wait_us = thousandths(gate.wait_ns);
    context! { port => &gate.port, pin => &gate.pin, why => &gate.why, count => holds.len(), holds => holds.join(" and "), wait_us }
}

fn shared(shared: &Shared) -> Value {
    let Shared { port, pin, function, modes, why } = shared;
    context! { port, pin, function, modes => listed(modes), why }
}

/// The modes of configuration as a list in words.
fn listed(modes: &[ConfigurationMode]) -> String {
    modes.iter().map(ConfigurationMode::to_string).collect::<Vec<_>>().join("; ")
}

fn clocking(clock: &Clocking) -> Value {
    let Clocking { clock_hz, tick_ns, phases, made_by, why } = clock;
    context! {
        mhz => mhz(*clock_hz),
        tick_ns => *tick_ns,
        phases => *phases,
        // The product is a whole number of clocks; the board's check ensures it.
        clocks => clock_hz * tick_ns / 1_000_000_000,
        phase_ns => thousandths(tick_ns * 1000 / u64::from(*phases)),
        khz => 500_000 / tick_ns,
        made_by => made_by.to_string(),
        why => why,
    }
}

fn wire(wire: &Wire) -> Value {
    let (connector, label) = place(wire);
    let beside_uart = wire.beside_uart;
    context! { port => &wire.port, pin => &wire.pin, connector, label, beside_uart, what => kind(wire).map_or("", |port| port.what) }
}

/// A number given in thousandths, without trailing zeros.
fn thousandths(number: u64) -> String {
    let text = format!("{}.{:03}", number / 1000, number % 1000);
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}
