//! What those need who instantiate the exported modules in designs of their own: comments on all
//! ports, names with a prefix, templates of instances, constraints, and the file for FuseSoC.
#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches unit tests only")]

mod common;

use carrystep_boards::board;
use carrystep_core::engine::{ENGINE_PORTS, Latch, LimitWiring};
use carrystep_core::link::{LineKind, Uart, line_ports};
use carrystep_core::ports::{Direction, Peer, Port};
use carrystep_core::{AXES, Build, EngineBuild, PinTiming, StartPhase, Timebase};
use carrystep_verilog::{
    Gateware, Prefix, TextFile, engine_verilog, generated_files, line_verilog, link_verilog,
    parallel_verilog, write_engine, write_parallel,
};
use common::run;
use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::path::Path;

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");

fn build() -> Build {
    let timebase = Timebase::new(80_000_000, 2000, 16).unwrap();
    Build { timebase, phase: StartPhase::Half, pins: [PinTiming::SHORTEST; AXES] }
}

fn engine_of(axes: usize) -> EngineBuild {
    let mut engine = EngineBuild::minimal(&build(), 1 << 40);
    engine.pins = vec![PinTiming::SHORTEST; axes];
    engine.guard.stop = vec![1 << 40; axes];
    engine.guard.limits = LimitWiring::Pair;
    engine.guard.latches = vec![Latch::of_pin(false, 1)];
    engine
}

fn uart() -> LineKind {
    LineKind::Uart(Uart::new(80_000_000, 921_600).unwrap())
}

/// The generated files of `hdl-out/core`, by their names in this folder.
fn core_files() -> Vec<TextFile> {
    let files = generated_files().unwrap().into_iter();
    files
        .filter_map(|file| {
            let name = file.name.strip_prefix("hdl-out/core/")?.to_owned();
            Some(TextFile { name, ..file })
        })
        .collect()
}

fn save(folder: &Path, files: &[TextFile]) {
    for file in files {
        std::fs::write(folder.join(&file.name), &file.text).unwrap();
    }
}

fn read(folder: &Path, name: &str) -> String {
    std::fs::read_to_string(folder.join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// Elaborates all Verilog files of a folder in Icarus without a warning.
fn elaborates(folder: &Path, top: &str) {
    let names = std::fs::read_dir(folder).unwrap();
    let names = names.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let sources: Vec<String> = names.filter(|name| name.ends_with(".v")).collect();
    let mut arguments = vec!["-g2005", "-Wall", "-s", top, "-o", "elaborated"];
    arguments.extend(sources.iter().map(String::as_str));
    let (fine, said) = run("iverilog", &arguments, folder);
    assert!(fine && said.is_empty(), "{top}: {said}");
}

/// A port of a template: its name, and its comment.
fn ports_of(template: &str) -> Vec<(&str, &str)> {
    let ports = template.lines().filter_map(|line| {
        let (name, comment) = line.trim().strip_prefix('.')?.split_once("(")?;
        Some((name, comment.split_once("// ")?.1))
    });
    ports.collect()
}

/// A module with the instance of a template. Each port is connected to a net of its width, and the
/// nets of the inputs are constant.
fn around(template: &str, name: &str) -> String {
    let mut text = format!("module {name} ();\n");
    let mut instance = template.to_owned();
    for (port, comment) in ports_of(template) {
        let (way, range) = comment.split_once(' ').unwrap_or((comment, ""));
        let value = match way {
            "input" => " = 0",
            "output" => "",
            _ => panic!("{comment}"),
        };
        let _ = writeln!(text, "wire {range} {port}{value};");
        instance = instance.replace(&format!(".{port}()"), &format!(".{port}({port})"));
    }
    text + &instance + "endmodule\n"
}

#[test]
fn every_module_and_every_port_has_a_comment() {
    let mut texts: Vec<String> =
        [1, 6].map(|axes| parallel_verilog(&build(), axes, "a test").unwrap()).into();
    for axes in [1, 6, 8] {
        texts.push(engine_verilog(&engine_of(axes), "a test").unwrap());
        texts.push(link_verilog(&engine_of(axes), uart(), "a test").unwrap());
    }
    texts.extend([uart(), LineKind::Spi].map(|line| line_verilog(line, "a test").unwrap()));
    for text in texts {
        let lines: Vec<&str> = text.lines().collect();
        let mut ports = 0;
        for (place, line) in lines.iter().enumerate() {
            let is_port = ["    input  wire", "    output wire", "    output reg "]
                .iter()
                .any(|begin| line.starts_with(begin));
            if is_port || line.starts_with("module ") {
                let comment = lines[place - 1].trim_start().strip_prefix("// ");
                let comment = comment.unwrap_or_else(|| panic!("{line} has no comment"));
                assert!(comment.ends_with('.') && !comment.contains("[`"), "{comment}");
                ports += usize::from(is_port);
            }
            let is_comment = line.trim_start().starts_with("//");
            assert!(!is_comment || line.chars().count() <= 100, "{line}");
        }
        assert!(ports > 5, "{ports} ports");
    }
}

/// The numbers of the causes are in the comment of the port, because Verilog has no enumerations.
#[test]
fn port_of_the_cause_lists_the_causes() {
    let text = engine_verilog(&engine_of(6), "a test").unwrap();
    let text = text.lines().map(|line| line.trim().trim_start_matches("// "));
    let text = text.collect::<Vec<_>>().join(" ");
    for (number, cause) in carrystep_core::engine::CAUSES.iter().enumerate() {
        assert!(text.contains(&format!("{number} {cause}")), "{number} {cause}");
    }
}

#[test]
fn two_engines_with_different_prefixes_are_in_one_design() {
    let folder = tempfile::tempdir().unwrap();
    let prefix = |text: &str| text.parse::<Prefix>().unwrap();
    let mut top = String::new();
    let mut instances = String::new();
    for (name, axes) in [("left_", 2), ("right_", 8)] {
        let files = write_engine(folder.path(), &engine_of(axes), &prefix(name), "a test").unwrap();
        for file in &files {
            let file = file.file_name().unwrap().to_str().unwrap();
            assert!(file.starts_with(&format!("{name}engine.")), "{file}");
            for line in read(folder.path(), file).lines() {
                let others = line.replace("carrystep_error_", "");
                assert!(!others.contains("carrystep_"), "{file}: {line}");
            }
        }
        top.push_str(&around(&read(folder.path(), &format!("{name}engine.veo")), name));
        let _ = writeln!(instances, "    {name} instance_of_{name} ();");
        let (fine, said) = run(
            "verilator",
            &["--lint-only", "-Wall", &format!("{name}engine.vlt"), &format!("{name}engine.v")],
            folder.path(),
        );
        assert!(fine && said.is_empty(), "{name}: {said}");
    }
    // The parallel core has modules of the same names as the engine.
    write_parallel(folder.path(), &build(), 3, &prefix("all_"), "a test").unwrap();
    top.push_str(&around(&read(folder.path(), "all_parallel_3.veo"), "all_"));
    let top = format!("{top}module both ();\n{instances}    all_ instance_of_all ();\nendmodule\n");
    std::fs::write(folder.path().join("both.v"), top).unwrap();
    elaborates(folder.path(), "both");
    let script = "read_verilog left_engine.v right_engine.v all_parallel_3.v both.v; \
                  hierarchy -check -top both";
    let (fine, said) = run("yosys", &["-q", "-p", script], folder.path());
    assert!(fine && !said.contains("Warning"), "{said}");
    // A parameter out of range is refused by the usual name.
    let arguments = ["-g2005", "-s", "left_engine", "-Pleft_engine.LIMITS=4", "left_engine.v"];
    let (fine, said) = run("iverilog", &arguments, folder.path());
    assert!(!fine && said.contains("carrystep_error_limits_out_of_range"), "{said}");
}

#[test]
fn prefix_renames_every_module_and_every_file_of_a_board() {
    let board = board("icestick").unwrap();
    let prefix: Prefix = "my_".parse().unwrap();
    let gateware = Gateware::shipped(board, &board.parts[0]).unwrap().with_prefix(prefix);
    assert_eq!(gateware.top(), "my_icestick_top");
    let folder = tempfile::tempdir().unwrap();
    let files = gateware.files().unwrap();
    save(folder.path(), &files);
    let verilog: Vec<&TextFile> = files.iter().filter(|file| file.name.ends_with(".v")).collect();
    for TextFile { name, text, .. } in &verilog {
        assert!(name.starts_with("my_"), "{name}");
        let modules = text.lines().filter_map(|line| line.strip_prefix("module "));
        assert!(modules.clone().count() > 0 && modules.into_iter().all(|m| m.starts_with("my_")));
    }
    let listed = read(folder.path(), "files.f");
    let names: Vec<&str> = verilog.iter().map(|file| file.name.as_str()).collect();
    assert_eq!(listed.lines().collect::<Vec<_>>(), names);
    let script = format!(
        "read_verilog -lib +/ice40/cells_sim.v; read_verilog {}; \
         hierarchy -check -top my_icestick_top",
        names.join(" ")
    );
    let (fine, said) = run("yosys", &["-q", "-p", &script], folder.path());
    assert!(fine, "{said}");
}

#[test]
fn templates_are_instances() {
    let files = core_files();
    let templates: Vec<_> = files.iter().filter(|file| file.name.ends_with(".veo")).collect();
    assert_eq!(templates.len(), 5);
    for template in templates {
        let name = template.name.trim_end_matches(".veo");
        let verilog = files.iter().find(|file| file.name == format!("{name}.v")).unwrap();
        let folder = tempfile::tempdir().unwrap();
        save(folder.path(), std::slice::from_ref(verilog));
        let user = folder.path().join("user.v");
        std::fs::write(&user, around(&template.text, "user")).unwrap();
        elaborates(folder.path(), "user");
        // As it is, with nothing connected, it is an instance too.
        std::fs::write(user, format!("module user ();\n{}endmodule\n", template.text)).unwrap();
        let arguments = ["-g2005", "-s", "user", "-o", "elaborated", "user.v", &verilog.name];
        let (fine, said) = run("iverilog", &arguments, folder.path());
        assert!(fine && said.is_empty(), "{name}: {said}");
        // Each parameter with its default, and each port with its direction and width.
        let (_, module) = verilog.text.split_once(&format!("\nmodule {name} ")).unwrap();
        let (head, _) = module.split_once("\n);").unwrap();
        for line in head.lines().filter(|line| !line.trim_start().starts_with("//")) {
            let words: Vec<&str> = line.trim().trim_end_matches(',').split_whitespace().collect();
            match words[..] {
                ["parameter", .., name, "=", value] => {
                    assert!(template.text.contains(&format!("    .{name}({value})")), "{line}");
                }
                [way @ ("input" | "output"), _, ref range @ .., name] => {
                    let comment = [&[way], range].concat().join(" ");
                    assert!(ports_of(&template.text).contains(&(name, &comment)), "{line}");
                }
                _ => assert!(!line.contains('.'), "{line}"),
            }
        }
    }
}

/// The two registers of each synchronizer in an XDC file, in the names of the flattened netlist.
fn synchronizers(xdc: &str) -> [BTreeSet<String>; 2] {
    let mut sets = [BTreeSet::new(), BTreeSet::new()];
    let lines = xdc.lines().filter_map(|line| line.split_once("[get_cells {"));
    for (_, cells) in lines {
        let cells = cells.trim_end_matches("}]").split(' ');
        for (set, cell) in sets.iter_mut().zip(cells) {
            set.insert(cell.trim_end_matches("_reg").replace('/', "."));
        }
    }
    sets
}

/// Yosys finds the flip-flops behind the pins without the exporter.
fn assert_only_synchronizers(text: &str, name: &str, ports: &[Port], xdc: Option<&str>) {
    let is_pin = |port: &&Port| port.peer == Peer::Pins && port.direction == Direction::Input;
    let pins: Vec<&str> = ports.iter().filter(is_pin).map(|port| port.name).collect();
    let Some(xdc) = xdc else {
        assert!(pins.is_empty(), "{name}: {pins:?}");
        return;
    };
    let named = xdc.lines().filter_map(|line| line.strip_prefix("# "));
    let named: Vec<&str> = named.flat_map(|line| line.split(", ")).collect();
    for pin in &pins {
        assert!(named.contains(pin), "{name}: {pin} has no constraint");
    }
    let [first, second] = synchronizers(xdc);
    assert!(!first.is_empty());
    for cell in &first {
        let path = format!("set_false_path -to [get_pins {{{}_reg/D}}]", cell.replace('.', "/"));
        assert!(xdc.contains(&path), "{path}");
    }
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("core.v"), text).unwrap();
    let inputs: String = pins.iter().map(|pin| format!(" i:{pin}")).collect();
    let union = " %u".repeat(pins.len() - 1);
    let script = format!(
        "read_verilog core.v; hierarchy -check -top {name}; proc; flatten; opt_clean\n\
         select -set cone{inputs}{union} %coe*\n\
         select -set first @cone %co1 t:$dff %i\n\
         select -set others @cone %co1 t:$* %i t:$dff %d @cone %d\n\
         select -assert-none @others\n\
         select -assert-none @cone o:* %i\n\
         select -set values @first %co1:+[Q] w:* %i\n\
         select -write first @values\n\
         select -write reached @values %coe*\n\
         select -write second @values %co1 t:$dff %i %co1:+[Q] w:* %i\n"
    );
    std::fs::write(folder.path().join("cones.ys"), script).unwrap();
    let (fine, said) = run("yosys", &["-q", "-s", "cones.ys"], folder.path());
    assert!(fine, "{name}: {said}");
    let found = |file: &str| -> BTreeSet<String> {
        let lines = read(folder.path(), file);
        lines.lines().map(|line| line.rsplit('/').next().unwrap().to_owned()).collect()
    };
    assert_eq!(found("first"), first, "{name}");
    assert_eq!(found("reached"), first, "{name}: logic behind the first flip-flop");
    assert_eq!(found("second"), second, "{name}");
}

#[test]
fn asynchronous_pins_reach_only_the_synchronizers_of_the_constraints() {
    for axes in [1, 6, 8] {
        let folder = tempfile::tempdir().unwrap();
        write_engine(folder.path(), &engine_of(axes), &Prefix::default(), "a test").unwrap();
        let [text, xdc] = ["v", "xdc"]
            .map(|extension| read(folder.path(), &format!("carrystep_engine.{extension}")));
        assert_only_synchronizers(&text, "carrystep_engine", ENGINE_PORTS, Some(&xdc));
    }
    let files = core_files();
    let find = |name: &str| files.iter().find(|file| file.name == name);
    for (line, name) in [(uart(), "carrystep_uart"), (LineKind::Spi, "carrystep_spi")] {
        let text = line_verilog(line, "a test").unwrap();
        let xdc = find(&format!("{name}.xdc")).map(|file| file.text.as_str());
        let ports: Vec<Port> = line_ports(line).collect();
        assert_only_synchronizers(&text, name, &ports, xdc);
    }
    for name in ["carrystep_link", "carrystep_parallel_6"] {
        assert!(find(&format!("{name}.xdc")).is_none() && find(&format!("{name}.v")).is_some());
    }
    // The constraints for Quartus name the same registers.
    for xdc in files.iter().filter(|file| file.name.ends_with(".xdc")) {
        let sdc = &find(&xdc.name.replace(".xdc", ".sdc")).unwrap().text;
        let [first, second] = synchronizers(&xdc.text);
        let last = |cell: &String| cell.rsplit('.').next().unwrap().to_owned();
        for cell in &first {
            assert!(sdc.contains(&format!(":*|{}}}]\n", last(cell))), "{cell}: {sdc}");
        }
        for cell in first.iter().chain(&second) {
            assert!(sdc.contains(&format!(":*|{}\"\n", last(cell))), "{cell}: {sdc}");
        }
    }
}

#[test]
fn fusesoc_lists_the_files_of_the_folder() {
    let folder = Path::new(ROOT).join("hdl-out/core");
    let text = read(&folder, "carrystep.core");
    let listed: Vec<&str> = text
        .lines()
        .filter_map(|line| line.strip_prefix("      - ")?.split_once(": {file_type: "))
        .map(|(name, _)| name)
        .collect();
    let entries = std::fs::read_dir(&folder).unwrap();
    let mut names: Vec<String> =
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.retain(|name| name != "carrystep.core");
    names.sort();
    let mut sorted = listed.clone();
    sorted.sort_unstable();
    assert_eq!(sorted, names, "run `cargo xtask generate`");
}

/// What the file for FuseSoC says is true of the generated files.
#[test]
fn fusesoc_names_modules_and_parameters_that_exist() {
    let files = core_files();
    let text = &files.iter().find(|file| file.name == "carrystep.core").unwrap().text;
    assert!(text.starts_with("CAPI=2:\n"));
    for target in ["  default:\n", "  lint:\n"] {
        assert!(text.contains(target), "{target}");
    }
    let tops: BTreeSet<&str> =
        text.lines().filter_map(|line| line.strip_prefix("    toplevel: ")).collect();
    assert_eq!(tops.len(), 5);
    for top in tops {
        let verilog = files.iter().find(|file| file.name == format!("{top}.v")).unwrap();
        let (_, module) = verilog.text.split_once(&format!("\nmodule {top} ")).unwrap();
        let (head, _) = module.split_once("\n);").unwrap();
        let fileset = top.trim_start_matches("carrystep_");
        let begin = format!("parameters: &{fileset}_parameters\n      [");
        let (_, list) = text.split_once(&begin).unwrap();
        let (list, _) = list.split_once(']').unwrap();
        for name in list.split(',').map(str::trim).filter(|name| !name.is_empty()) {
            assert!(head.contains(&format!(" {name} = ")), "{top} has no {name}");
            assert!(text.contains(&format!("\n  {name}:\n    datatype: ")), "{name}");
        }
    }
}
