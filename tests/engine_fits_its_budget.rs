//! The engine's size and speed: a change that goes over budget fails here. The rows are those of `hdl-out/resources.md`, which
//! `cargo xtask resources` measures as a whole; sizes are measured here for all of them, speed for those marked `always`.

use carrystep_export::ENGINE_NAME;
use carrystep_synthesis::resources::{self, EIGHT_TO_SIX, FAMILIES, LINES, LINK_BUDGET, PAGE, ROWS, Row};
use carrystep_synthesis::{ice40, kept, xilinx};
use carrystep_tests::effort;

#[test]
fn every_row_is_small_enough() {
    let mut netlists = Vec::new();
    for row in &ROWS {
        // Parts share what is synthesised for one clock and tick.
        let build = (row.axes, row.clock_hz, row.tick_ns);
        if !netlists.iter().any(|(other, _)| *other == build) {
            let verilog = resources::verilog(row).expect("a fine engine");
            netlists.push((build, ice40::synthesise(&verilog, ENGINE_NAME).expect("a netlist")));
        }
        let (_, netlist) = netlists.iter().find(|(other, _)| *other == build).expect("a netlist");
        let found = netlist.size(row.part).expect("a size");
        effort::say(&format!("{} at {} ns: {found:?}", row.part.device, row.tick_ns));
        let fits = found.logic_cells <= row.budget.logic_cells && found.block_rams <= row.budget.block_rams;
        assert!(fits, "{found:?} used of {row:?}");
    }
    kept::say();
}

#[test]
fn eight_axes_cost_little_more_than_six() {
    let (eight, six, most) = EIGHT_TO_SIX;
    let [eight, six] = [eight, six].map(|row| {
        let verilog = resources::verilog(&row).expect("a fine engine");
        let netlist = ice40::synthesise(&verilog, ENGINE_NAME).expect("a netlist");
        f64::from(netlist.size(row.part).expect("a size").logic_cells)
    });
    effort::say(&format!("eight axes {eight}, six {six} logic cells: {:.1} % more", (eight / six - 1.0) * 100.0));
    kept::say();
    assert!(eight <= six * most, "{eight} logic cells for eight axes, {six} for six");
}

#[test]
fn the_clock_is_reached() {
    let reached = |row: &Row| {
        let mut speeds = resources::placed(row).expect("a netlist").map(|mhz| mhz.expect("a placed design"));
        speeds.find(|mhz| mhz * 1e6 >= row.clock_hz as f64)
    };
    for row in ROWS.iter().filter(|row| row.always) {
        let mhz = reached(row);
        effort::say(&format!("{} at {} ns: {mhz:?} MHz", row.part.device, row.tick_ns));
        assert!(mhz.is_some(), "no seed reaches the clock of {row:?}");
    }
    kept::say();
}

#[test]
fn the_link_is_small_enough() {
    for (name, found) in LINES.iter().zip(resources::links().expect("two links")) {
        effort::say(&format!("{name}: {found:?}"));
        assert!(found.logic_cells <= LINK_BUDGET.logic_cells, "{name}: {found:?} of {LINK_BUDGET:?}");
        assert!(found.block_rams <= LINK_BUDGET.block_rams, "{name}: {found:?} of {LINK_BUDGET:?}");
    }
    kept::say();
}

#[test]
fn other_families_are_small_enough() {
    for family in &FAMILIES {
        let verilog = resources::verilog(&family.of).expect("a fine engine");
        let found = xilinx::cells(&verilog, ENGINE_NAME, family.name).expect("cells");
        effort::say(&format!("{}: {found:?}", family.name));
        let budget = family.budget;
        let fits = found.luts <= budget.luts
            && found.flip_flops <= budget.flip_flops
            && found.carries <= budget.carries
            && found.block_rams <= budget.block_rams;
        assert!(fits, "{found:?} used of {family:?}");
    }
    kept::say();
}

#[test]
fn the_table_is_of_these_rows() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/..").to_owned() + "/" + PAGE;
    assert_eq!(resources::check(&std::fs::read_to_string(file).expect("the table")), Ok(()));
}
