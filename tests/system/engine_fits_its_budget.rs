//! Size and speed of the engine: a change that exceeds the budget fails here. The rows are those of
//! `hdl-out/resources.md`, which `cargo xtask resources` measures completely. This test measures
//! the size of all rows, and the clock of the rows marked `always`.

use carrystep_boards::{Ice40Synthesis, Mapped, block_rams, board};
use carrystep_core::engine::{LimitWiring, QUEUE_DEPTHS};
use carrystep_files::SourceText;
use carrystep_tests::{effort, moves, pages};
use carrystep_tools::ice40::{self, NextpnrPart};
use carrystep_tools::resources::{
    self, ECP5, EIGHT_TO_SIX, EngineRow, FAMILIES, FamilyRow, GOWIN, LINES, LINK_BUDGET, PAGE, ROWS,
};
use carrystep_tools::{adders, kept, xilinx};
use carrystep_verilog::{ENGINE_NAME, Gateware, shipped_machine};

#[test]
fn every_engine_build_fits_its_budget_of_logic_cells() {
    let mut netlists = Vec::new();
    for row in &ROWS {
        // Rows of the same engine whose parts are synthesised alike share one netlist.
        let synthesis = Ice40Synthesis::of(row.part.device, ENGINE_NAME);
        let build = (row.axes, row.clock_hz, row.tick_ns, row.queue, row.all, synthesis);
        if !netlists.iter().any(|(other, _)| *other == build) {
            netlists.push((build.clone(), resources::synthesised(row).expect("a netlist")));
        }
        let (_, netlist) = netlists.iter().find(|(other, _)| *other == build).expect("a netlist");
        let found = netlist.size(row.part).expect("a size");
        effort::say(&format!("{} at {} ns: {found:?}", row.part.device, row.tick_ns));
        let fits = found.logic_cells <= row.budget.logic_cells
            && found.block_rams <= row.budget.block_rams;
        assert!(fits, "{found:?} used of {row:?}");
    }
    kept::say();
}

#[test]
fn eight_axes_need_few_more_logic_cells_than_six() {
    let (eight, six, most) = EIGHT_TO_SIX;
    let [eight, six] = [eight, six].map(|row| {
        let netlist = resources::synthesised(&row).expect("a netlist");
        f64::from(netlist.size(row.part).expect("a size").logic_cells)
    });
    effort::say(&format!(
        "eight axes {eight}, six {six} logic cells: {:.1} % more",
        (eight / six - 1.0) * 100.0
    ));
    kept::say();
    assert!(eight <= six * most, "{eight} logic cells for eight axes, {six} for six");
}

#[test]
fn placed_engines_reach_their_clock() {
    let reached = |row: &EngineRow| {
        let mut speeds =
            resources::placed(row).expect("a netlist").map(|mhz| mhz.expect("a placed design"));
        speeds.find(|mhz| mhz * 1e6 >= row.clock_hz as f64)
    };
    for row in ROWS.iter().filter(|row| row.always) {
        let mhz = reached(row);
        effort::say(&format!("{} at {} ns: {mhz:?} MHz", row.part.device, row.tick_ns));
        assert!(mhz.is_some(), "no seed reaches the clock of {row:?}");
    }
    kept::say();
}

/// Further inputs and outputs on the pins of the SPI, with a latch.
const BESIDE_UART: &str = "\
[machine.inputs]
probe = \"low\"
interlock = \"high\"
latches = [{ source = \"probe\", edge = \"falling\", looks = 2 }]

[machine.outputs]
count = 2

";

/// The most logic cells that this engine, link and UART may take of the 1280 of an iCEstick.
const ICESTICK_CELLS: u32 = 1270;

#[test]
fn an_icestick_has_probe_interlock_latch_and_two_outputs_beside_six_axes() {
    let icestick = board("icestick").expect("a board");
    let text = shipped_machine(icestick, &icestick.clocks[0]).expect("a machine");
    let text = text.replace("[machine.link]", &format!("{BESIDE_UART}[machine.link]"));
    let source = SourceText { path: "machine.toml".into(), text: text.into() };
    let gateware = Gateware::new(icestick, &icestick.parts[0], source).expect("gateware");
    let build = gateware.build();
    assert_eq!(
        (build.axes(), build.guard.latches.len(), build.outputs.exist),
        (6, 1, 0b11),
        "{BESIDE_UART} has an effect"
    );

    let files = gateware.files().expect("its files");
    let pcf = files.into_iter().find(|file| file.name.ends_with(".pcf")).expect("its pins").text;
    let verilog = gateware.verilog().expect("its Verilog").into_iter().map(|file| file.text);
    let part = &icestick.parts[0];
    let part = NextpnrPart { device: &part.name, package: &part.package };
    let netlist = ice40::synthesise(&verilog.collect::<String>(), &gateware.top(), part.device);
    let clock_hz = build.timebase.clock_hz();
    let placed = netlist.expect("a netlist").place_on(part, &pcf, clock_hz, 1).expect("a design");
    let (size, mhz) = (placed.size, placed.mhz);
    effort::say(&format!("icestick with all that its pins hold: {size:?}, {mhz} MHz"));
    kept::say();
    assert!(size.logic_cells <= ICESTICK_CELLS, "{size:?}");
    assert!(mhz * 1e6 >= clock_hz as f64, "{mhz} MHz");
    let told = format!("{} of the 1280 logic cells", size.logic_cells);
    assert!(icestick.notes.iter().any(|note| note.contains(&told)), "the board's notes: {told}");
}

#[test]
fn link_fits_its_budget() {
    for (name, found) in LINES.iter().zip(resources::links().expect("two links")) {
        effort::say(&format!("{name}: {found:?}"));
        assert!(
            found.logic_cells <= LINK_BUDGET.logic_cells,
            "{name}: {found:?} of {LINK_BUDGET:?}"
        );
        assert!(found.block_rams <= LINK_BUDGET.block_rams, "{name}: {found:?} of {LINK_BUDGET:?}");
    }
    kept::say();
}

#[test]
fn engines_of_other_families_fit_their_budgets() {
    for family in &FAMILIES {
        let verilog = resources::verilog(&family.of).expect("a fine engine");
        let found = xilinx::cells(&verilog, ENGINE_NAME, family.name).expect("cells");
        effort::say(&format!("{}: {found:?}", family.name));
        assert_within(&found, family);
    }
    kept::say();
}

/// With everything that can be left out, and the link with its UART.
#[test]
fn engine_and_link_with_all_options_fit_their_budget_of_an_ecp5() {
    let found = resources::ecp5().expect("cells");
    effort::say(&format!("ECP5: {found:?}"));
    assert_within(&found, &ECP5);
    kept::say();
}

/// The same on a Gowin part.
#[test]
fn engine_and_link_with_all_options_fit_their_budget_of_a_gowin_part() {
    let found = resources::gowin().expect("cells");
    effort::say(&format!("Gowin: {found:?}"));
    assert_within(&found, &GOWIN);
    kept::say();
}

/// A family's cells are within its budget.
fn assert_within(found: &Mapped, family: &FamilyRow) {
    let budget = family.budget;
    let fits = found.luts <= budget.luts
        && found.flip_flops <= budget.flip_flops
        && found.carries <= budget.carries
        && found.block_rams <= budget.block_rams;
    assert!(fits, "{found:?} used of {family:?}");
}

/// Of six axes, on parts whose block RAMs have 18 kbit.
#[test]
fn engine_page_gives_the_block_rams_of_adders() {
    let orangecrab = board("orangecrab").expect("a board");
    let taken = |adders: usize, limits| {
        let (file, _) = moves::six_fast_axes();
        let mut build = file.machine.engine();
        (build.adders, build.guard.limits) = (adders, limits);
        assert_eq!((build.axes(), build.queue), (6, QUEUE_DEPTHS[0]));
        for board in [orangecrab, board("tang-nano-20k").expect("a board")] {
            assert_eq!(block_rams(&build, board.family), block_rams(&build, orangecrab.family));
        }
        u64::from(block_rams(&build, orangecrab.family).whole())
    };
    let [one, two] = [1, 2].map(|adders| taken(adders, LimitWiring::None));
    let (adder, all) = (two - one, taken(6, LimitWiring::Pair));
    assert_eq!(all - taken(6, LimitWiring::None), 6, "one more for each adder");
    pages::says(
        "docs/engine.md",
        &[
            format!("takes {} block RAMs of 18 kbit", pages::word(adder)),
            format!("{} are those of the link", pages::word(one - adder)),
            format!("six adders with limits need {all}"),
            format!("the smaller ECP5 has {}:", orangecrab.parts[0].block_rams),
        ],
    );
}

/// `cargo xtask adders` places these rows, which takes minutes.
#[test]
fn adders_page_lists_exactly_these_rows() {
    assert_eq!(adders::check(&pages::file(adders::PAGE)), Ok(()));
}

#[test]
fn resources_page_lists_exactly_these_rows() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/..").to_owned() + "/" + PAGE;
    assert_eq!(resources::check(&std::fs::read_to_string(file).expect("the table")), Ok(()));
}
