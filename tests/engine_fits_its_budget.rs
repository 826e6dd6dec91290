//! The engine's size and speed, placed and routed by nextpnr: a change that goes over budget fails here.
//! Size is that of the core alone; speed is that of the core between registers (budget_harness.v), the best of
//! three fixed seeds.

use carrystep_export::{ENGINE_NAME, write_engine};
use carrystep_spec::{EngineBuild, Machine, Timebase};
use carrystep_tests::effort;
use std::path::{Path, PathBuf};
use std::process::Command;

const HARNESS: &str = include_str!("budget_harness.v");

/// A device and a build; what it may cost.
struct Budget {
    device: &'static str,
    package: &'static str,
    clock_hz: u64,
    tick_ns: u64,
    logic_cells: u32,
    block_rams: u32,
}

const BUDGETS: [Budget; 5] = [
    Budget { device: "hx8k", package: "ct256", clock_hz: 48_000_000, tick_ns: 2000, logic_cells: 850, block_rams: 8 },
    Budget { device: "hx8k", package: "ct256", clock_hz: 80_000_000, tick_ns: 1000, logic_cells: 864, block_rams: 8 },
    Budget { device: "hx1k", package: "tq144", clock_hz: 48_000_000, tick_ns: 2000, logic_cells: 850, block_rams: 8 },
    Budget { device: "lp8k", package: "cm81", clock_hz: 48_000_000, tick_ns: 2000, logic_cells: 850, block_rams: 8 },
    Budget { device: "up5k", package: "sg48", clock_hz: 40_000_000, tick_ns: 2000, logic_cells: 850, block_rams: 8 },
];

fn run(folder: &Path, tool: &str, arguments: &[&str]) -> (bool, String) {
    let output = Command::new(tool).args(arguments).current_dir(folder).output();
    let output = output.unwrap_or_else(|_| panic!("{tool} is not installed: `cargo xtask tools` installs it"));
    let text = String::from_utf8_lossy(&output.stdout) + String::from_utf8_lossy(&output.stderr);
    (output.status.success(), text.into_owned())
}

/// The number behind a name in nextpnr's report of what it has packed.
fn used(log: &str, name: &str) -> u32 {
    let line = log.lines().find(|line| line.contains(name) && line.contains('%'));
    let number = line.and_then(|line| line.split(name).nth(1)?.split('/').next()?.trim().parse().ok());
    number.unwrap_or_else(|| panic!("no {name} in:\n{log}"))
}

fn synthesise(folder: &Path, files: &str, top: &str) {
    let script = format!("read_verilog {files}; synth_ice40 -top {top} -json {top}.json");
    let (ok, said) = run(folder, "yosys", &["-q", "-p", &script]);
    assert!(ok, "{said}");
}

/// The machine that is measured.
fn machine_file() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../sim/engine.toml")
}

/// Percent of the logic of six axes that eight may take, with the same clock and tick.
const EIGHT_TO_SIX: u32 = 115;

#[test]
fn eight_axes_cost_little_more_than_six() {
    let machine = Machine::load(&machine_file()).expect("a fine machine").engine();
    // Eight axes need 105 clocks; axes 6 and 7 have the drivers of axes 0 and 1.
    let timebase = Timebase::new(56_000_000, 2000, 16).expect("a fine timebase");
    let cells = [6, 8].map(|axes| {
        let mut build = EngineBuild { timebase, ..machine.clone() };
        build.pins = build.pins.iter().copied().cycle().take(axes).collect();
        build.guard.stop = build.guard.stop.iter().copied().cycle().take(axes).collect();
        let folder = tempfile::tempdir().expect("a folder");
        write_engine(folder.path(), &build, "a test").expect("a fine engine");
        synthesise(folder.path(), &format!("{ENGINE_NAME}.v"), ENGINE_NAME);
        let json = format!("{ENGINE_NAME}.json");
        let arguments = ["--hx8k", "--package", "ct256", "--json", &json, "--pack-only"];
        used(&run(folder.path(), "nextpnr-ice40", &arguments).1, "ICESTORM_LC:")
    });
    let [six, eight] = cells;
    effort::say(&format!("six axes {six} logic cells, eight axes {eight}"));
    assert!(100 * eight <= EIGHT_TO_SIX * six, "eight axes take {eight} logic cells, six {six}");
}

#[test]
fn the_engine_fits_its_budget() {
    let text = std::fs::read_to_string(machine_file()).expect("the machine file");
    for budget in &BUDGETS {
        let Budget { device, package, clock_hz, tick_ns, logic_cells, block_rams } = *budget;
        let folder = tempfile::tempdir().expect("a folder");
        let text = text.replace("48_000_000", &clock_hz.to_string()).replace("2000", &tick_ns.to_string());
        std::fs::write(folder.path().join("machine.toml"), text).expect("a file");
        let machine = Machine::load(&folder.path().join("machine.toml")).expect("a fine machine");
        write_engine(folder.path(), &machine.engine(), "a test").expect("a fine engine");
        std::fs::write(folder.path().join("harness.v"), HARNESS).expect("a file");
        let core = format!("{ENGINE_NAME}.v");
        synthesise(folder.path(), &core, ENGINE_NAME);
        synthesise(folder.path(), &format!("{core} harness.v"), "budget_harness");

        let place = |top: &str, more: &[&str]| {
            let (device, json) = (format!("--{device}"), format!("{top}.json"));
            let mhz = (clock_hz as f64 / 1e6).to_string();
            let common = [&device, "--package", package, "--json", &json, "--freq", &mhz, "--pcf-allow-unconstrained"];
            run(folder.path(), "nextpnr-ice40", &[common.as_slice(), more].concat())
        };
        let (_, log) = place(ENGINE_NAME, &["--pack-only"]);
        let found = (used(&log, "ICESTORM_LC:"), used(&log, "ICESTORM_RAM:"));
        let seed = ["1", "2", "3"].into_iter().find(|seed| place("budget_harness", &["--seed", seed]).0);
        effort::say(&format!(
            "{device} at {tick_ns} ns: {} logic cells, {} block RAMs, seed {seed:?}",
            found.0, found.1
        ));
        assert!(found.0 <= logic_cells && found.1 <= block_rams, "{device} at {tick_ns} ns: {found:?} used");
        assert!(seed.is_some(), "{device}: {clock_hz} Hz is not reached by three seeds");
    }
}
