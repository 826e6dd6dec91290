//! The ports of the exported modules are those of the tables in `core`, and so are the ports in all
//! texts that are written by hand: benches, harnesses, the boards' top level and the documentation.
#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches unit tests only")]

use carrystep_core::engine::{ENGINE_PORTS, Latch, MORE_LATCH_PORTS, engine_ports};
use carrystep_core::link::{LineKind, Uart, line_ports, link_ports};
use carrystep_core::ports::{Direction, PARALLEL_PORTS, Peer, Port, Width};
use carrystep_core::{AXES, Build, EngineBuild, PinTiming, StartPhase, Timebase};
use carrystep_verilog::{
    ENGINE_NAME, LINK_NAME, engine_verilog, line_name, line_verilog, link_verilog, parallel_name,
    parallel_verilog,
};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");

/// Direction and width in bits of each port, by name.
type Ports = BTreeMap<String, (bool, u32)>;

fn build() -> Build {
    let timebase = Timebase::new(80_000_000, 2000, 16).unwrap();
    Build { timebase, phase: StartPhase::Half, pins: [PinTiming::SHORTEST; AXES] }
}

fn engine_of(axes: usize) -> EngineBuild {
    let mut engine = EngineBuild::minimal(&build(), 1 << 40);
    engine.pins = vec![PinTiming::SHORTEST; axes];
    engine.guard.stop = vec![1 << 40; axes];
    engine
}

/// The same with this number of latches.
fn with_latches(mut engine: EngineBuild, count: usize) -> EngineBuild {
    engine.guard.latches = vec![Latch::of_pin(false, 1); count];
    engine
}

fn read(path: impl AsRef<Path>) -> String {
    let path = Path::new(ROOT).join(path);
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The ports of a table in a build with this number of axes.
fn tabled(ports: impl IntoIterator<Item = Port>, axes: usize) -> Ports {
    let row = |port: Port| {
        (port.name.to_owned(), (port.direction == Direction::Input, port.width.of(axes)))
    };
    ports.into_iter().map(row).collect()
}

/// The ports of a module, in order, from its Verilog.
fn declared(text: &str, module: &str) -> Vec<(String, (bool, u32))> {
    let (_, module) = text.split_once(&format!("module {module} ")).unwrap();
    let (head, _) = module.split_once("\n);").unwrap();
    let (_, ports) = head.rsplit_once("(\n").unwrap();
    let port = |line: &str| {
        let words: Vec<&str> = line.trim().trim_end_matches(',').split_whitespace().collect();
        let [way, "wire", range @ .., name] = &words[..] else { panic!("{line} is no port") };
        let high = range.first().and_then(|range| range[1..].split_once(':'));
        let width = high.map_or(1, |(high, _)| high.parse::<u32>().unwrap() + 1);
        ((*name).to_owned(), (*way == "input", width))
    };
    ports.lines().filter(|line| !line.trim_start().starts_with("//")).map(port).collect()
}

/// The names that an instance of a module connects: `.name(`.
fn connected(text: &str, instance: &str) -> BTreeSet<String> {
    let (_, ports) = text.split_once(instance).unwrap_or_else(|| panic!("no {instance}"));
    let (ports, _) = ports.split_once(");\n").unwrap();
    let name = |part: &str| part.split_once('(').map(|(name, _)| name.trim().to_owned());
    ports.split('.').skip(1).filter_map(name).collect()
}

fn names<'a>(ports: impl IntoIterator<Item = &'a Port>) -> BTreeSet<String> {
    ports.into_iter().map(|port| port.name.to_owned()).collect()
}

#[test]
fn exported_modules_have_the_ports_of_their_tables() {
    for axes in 1..=AXES {
        let text = parallel_verilog(&build(), axes, "a test").unwrap();
        let core = declared(&text, &parallel_name(axes));
        let order = PARALLEL_PORTS.iter().map(|port| port.name);
        assert!(core.iter().map(|(name, _)| name.as_str()).eq(order), "{axes} axes");
        let table = tabled(PARALLEL_PORTS, axes);
        assert_eq!(core.into_iter().collect::<Ports>(), table, "{axes} axes");
    }
    let uart = LineKind::Uart(Uart::new(80_000_000, 921_600).unwrap());
    let builds = (1..=8).map(|axes| (axes, 1)).chain([(6, 0), (6, 2), (6, 4), (1, 3)]);
    for (axes, latches) in builds {
        let build = with_latches(engine_of(axes), latches);
        let engine = declared(&engine_verilog(&build, "a test").unwrap(), ENGINE_NAME);
        let order = engine_ports(&build).map(|port| port.name);
        assert!(engine.iter().map(|(name, _)| name.as_str()).eq(order), "{axes} axes");
        let table = tabled(engine_ports(&build).copied(), axes);
        assert_eq!(engine.into_iter().collect::<Ports>(), table, "{axes} axes");
        let link = declared(&link_verilog(&build, uart, "a test").unwrap(), LINK_NAME);
        assert_eq!(
            link.into_iter().collect::<Ports>(),
            tabled(link_ports(&build), axes),
            "{axes} axes"
        );
    }
    for (axes, adders) in [(2, 2), (6, 2), (6, 6), (8, 8)] {
        let build = EngineBuild { adders, ..engine_of(axes) };
        let width = |port: &Port| {
            let width = port.width.with_adders(axes, adders);
            (port.name.to_owned(), (port.direction == Direction::Input, width))
        };
        let engine = declared(&engine_verilog(&build, "a test").unwrap(), ENGINE_NAME);
        let table: Ports = engine_ports(&build).map(width).collect();
        assert_eq!(engine.into_iter().collect::<Ports>(), table, "{axes} axes, {adders} adders");
        let link = declared(&link_verilog(&build, uart, "a test").unwrap(), LINK_NAME);
        let table: Ports = link_ports(&build).map(|port| width(&port)).collect();
        assert_eq!(link.into_iter().collect::<Ports>(), table, "{axes} axes, {adders} adders");
    }
    for line in [uart, LineKind::Spi] {
        let found = declared(&line_verilog(line, "a test").unwrap(), line_name(line));
        assert_eq!(found.into_iter().collect::<Ports>(), tabled(line_ports(line), AXES), "{line}");
    }
}

#[test]
fn outputs_are_valid_with_outputs_of_their_own_table() {
    let build = with_latches(engine_of(6), 2);
    let engine: Vec<Port> = engine_ports(&build).copied().collect();
    let link: Vec<Port> = link_ports(&build).collect();
    for table in [&PARALLEL_PORTS[..], ENGINE_PORTS, &engine, &link] {
        for name in table.iter().filter_map(|port| port.valid_with) {
            let with = table.iter().find(|port| port.name == name).unwrap();
            assert!([Width::Bits(1), Width::PerAdder(1)].contains(&with.width), "{name}");
        }
    }
}

#[test]
fn hand_written_verilog_connects_every_port() {
    let harness = read("crates/tools/src/resources/harness.v");
    assert_eq!(connected(&harness, "carrystep_engine core ("), names(ENGINE_PORTS));
    let bench = read("crates/simulators/bench/parallel_bench.v");
    assert_eq!(connected(&bench, "`CORE core ("), names(&PARALLEL_PORTS));
    for folder in std::fs::read_dir(Path::new(ROOT).join("hdl-out")).unwrap() {
        let board = folder.unwrap().file_name().into_string().unwrap();
        let top = format!("hdl-out/{board}/carrystep_{}_top.v", board.replace('-', "_"));
        if !Path::new(ROOT).join(&top).exists() {
            continue;
        }
        assert_eq!(connected(&read(&top), ") engine ("), names(ENGINE_PORTS), "{top}");
        let link: Vec<Port> = link_ports(&engine_of(6)).collect();
        assert_eq!(connected(&read(&top), ") link ("), names(&link), "{top}");
    }
}

#[test]
fn harness_has_a_register_for_every_bit_of_the_engine() {
    let harness = read("crates/tools/src/resources/harness.v");
    let sum = |direction, axes: usize| -> u32 {
        let ports = ENGINE_PORTS.iter();
        ports
            .filter(|port| port.direction == direction && port.peer != Peer::Clock)
            // As on the boards, `reset` is tied to 0.
            .filter(|port| !port.name.starts_with("reset"))
            .map(|port| port.width.of(axes))
            .sum()
    };
    // One input more selects between loading and shifting the outputs.
    for (name, direction, more) in
        [("INPUTS", Direction::Input, 1), ("OUTPUTS", Direction::Output, 0)]
    {
        let (fixed, all) = (sum(direction, 0) + more, sum(direction, 1) + more);
        let line = format!("localparam {name} = {fixed} + {} * AXES;", all - fixed);
        assert!(harness.contains(&line), "{line}");
    }
}

#[test]
fn hand_written_simulations_use_every_port() {
    let bench = read("crates/simulators/bench/parallel_bench.cpp");
    for port in PARALLEL_PORTS {
        assert!(bench.contains(&format!("core.{}", port.name)), "{}", port.name);
    }
    // This one never has to resume.
    let toggle = read("crates/xtask/benches/levels/harness/toggle.cpp");
    for port in PARALLEL_PORTS.iter().filter(|port| port.direction == Direction::Input) {
        let used = toggle.contains(&format!("core.{}", port.name));
        assert_eq!(used, port.name != "clear", "{}", port.name);
    }
}

/// The rows of a table of the page with the columns `port` and `bits`: that in which this port is.
fn documented(page: &str, port: &str) -> BTreeMap<String, (bool, String)> {
    let tables = page.split("| port | bits | |\n|---|---|---|\n").skip(1);
    let tables = tables.map(|table| table.split("\n\n").next().unwrap());
    let table = tables.into_iter().find(|table| table.contains(&format!("`{port}`"))).unwrap();
    let mut found = BTreeMap::new();
    for line in table.lines() {
        let cells: Vec<&str> = line.split('|').map(str::trim).collect();
        let names = cells[1].split_whitespace().map(|name| name.trim_matches('`'));
        let (way, widths) = cells[2].split_once(' ').unwrap();
        let widths: Vec<&str> = widths.split_whitespace().collect();
        let names: Vec<&str> = names.collect();
        assert_eq!(names.len(), widths.len(), "{line}");
        for (name, width) in names.into_iter().zip(widths) {
            found.insert(name.to_owned(), (way == "in", width.to_owned()));
        }
    }
    found
}

#[test]
fn page_has_the_ports_of_the_tables() {
    let page = read("docs/clock-by-clock.md");
    let tables = [
        (&PARALLEL_PORTS[..], "seg_valid"),
        (ENGINE_PORTS, "put_valid"),
        (MORE_LATCH_PORTS, "more_latches"),
    ];
    for (table, one) in tables {
        let row = |port: &Port| {
            let width = match port.width {
                Width::Bits(bits) => bits.to_string(),
                Width::Axes => "N".to_owned(),
                Width::WordPerAxis => "32N".to_owned(),
                // The table is that of one adder.
                Width::PerAdder(bits) => bits.to_string(),
            };
            (port.name.to_owned(), (port.direction == Direction::Input, width))
        };
        assert_eq!(documented(&page, one), table.iter().map(row).collect());
    }
}
