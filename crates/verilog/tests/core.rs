//! The cores as files: ports, names, lint, synthesis, and whether the committed files are up to
//! date.
#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches unit tests only")]

mod common;

use carrystep_core::engine::{Guard, LimitWiring};
use carrystep_core::{AXES, Build, EngineBuild, PinTiming, StartPhase, Timebase};
use carrystep_files::Machine;
use carrystep_verilog::{
    ENGINE_NAME, ENGINE_WAIVERS, ExportError, PARALLEL_WAIVERS, Prefix, engine_verilog,
    generated_files, parallel_name, parallel_verilog, write_engine, write_parallel,
};
use common::run;
use std::path::{Path, PathBuf};

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");

/// A generated core, and the machine file of the committed one.
struct Core {
    name: &'static str,
    of_machine: fn(&Machine, &str) -> Result<String, ExportError>,
    write: fn(&Path, &Build, &str) -> Result<Vec<PathBuf>, ExportError>,
    waivers: &'static str,
    machine: &'static str,
    /// Clock (Hz), tick (ns) and phases of some builds.
    timebases: [(u64, u64, u32); 3],
}

const CORES: [Core; 2] = [
    Core {
        name: "carrystep_parallel_6",
        of_machine: |machine, description| {
            parallel_verilog(&machine.build().unwrap(), AXES, description)
        },
        write: |folder, build, about| {
            write_parallel(folder, build, AXES, &Prefix::default(), about)
        },
        waivers: PARALLEL_WAIVERS,
        machine: "sim/six-axis.toml",
        timebases: [(48_000_000, 1000, 16), (20_000_000, 1000, 4), (16_000_000, 1000, 1)],
    },
    Core {
        name: ENGINE_NAME,
        of_machine: |machine, description| engine_verilog(&machine.engine(), description),
        write: |folder, build, about| {
            write_engine(folder, &guarded(build), &Prefix::default(), about)
        },
        waivers: ENGINE_WAIVERS,
        machine: "sim/six-axis.toml",
        timebases: [(48_000_000, 2000, 16), (12_000_000, 10_000, 4), (90_000_000, 1000, 1)],
    },
];

fn pins() -> [PinTiming; AXES] {
    [PinTiming { step_high: 96, step_low: 5, dir_setup: 2, dir_hold: 7 }; AXES]
}

/// An engine whose guard watches something of every kind.
fn guarded(build: &Build) -> EngineBuild {
    let engine = EngineBuild::minimal(build, 1 << 40);
    let guard =
        Guard { watchdog: 100, enable: 5, debounce: 3, limits: LimitWiring::Pair, ..engine.guard };
    EngineBuild { guard, ..engine }
}

/// The same engine with this number of axes.
fn engine_of(axes: usize) -> EngineBuild {
    let timebase = Timebase::new(56_000_000, 2000, 16).unwrap();
    let mut engine = guarded(&Build { timebase, phase: StartPhase::Half, pins: pins() });
    engine.pins = vec![pins()[0]; axes];
    engine.guard.stop = vec![1 << 40; axes];
    engine
}

fn build(clock_hz: u64, phases: u32) -> Build {
    let timebase = Timebase::new(clock_hz, 1000, phases).unwrap();
    Build { timebase, phase: StartPhase::Half, pins: pins() }
}

/// Runs a tool on each core in some builds, and on cores of each number of axes, each in a fresh
/// directory.
fn on_each_core(tool: &str, arguments: fn(&str) -> Vec<String>, fine: fn(bool, &str) -> bool) {
    for core in &CORES {
        for (clock_hz, tick_ns, phases) in core.timebases {
            let timebase = Timebase::new(clock_hz, tick_ns, phases).unwrap();
            let folder = tempfile::tempdir().unwrap();
            let build = Build { timebase, phase: StartPhase::Half, pins: pins() };
            (core.write)(folder.path(), &build, "a test").unwrap();
            let (ok, said) = run(tool, &arguments(core.name), folder.path());
            assert!(fine(ok, &said), "{}, {phases} phases: {said}", core.name);
        }
    }
    for axes in 1..=AXES {
        let (folder, build) = (tempfile::tempdir().unwrap(), build(20_000_000, 4));
        write_parallel(folder.path(), &build, axes, &Prefix::default(), "a test").unwrap();
        let name = parallel_name(axes);
        let (ok, said) = run(tool, &arguments(&name), folder.path());
        assert!(fine(ok, &said), "{name}: {said}");
    }
    for axes in 1..=8 {
        let folder = tempfile::tempdir().unwrap();
        write_engine(folder.path(), &engine_of(axes), &Prefix::default(), "a test").unwrap();
        let (ok, said) = run(tool, &arguments(ENGINE_NAME), folder.path());
        assert!(fine(ok, &said), "{ENGINE_NAME} of {axes} axes: {said}");
    }
}

#[test]
fn engine_has_the_axes_of_its_build() {
    for axes in 1..=8 {
        let text = engine_verilog(&engine_of(axes), "a test").unwrap();
        assert_eq!(text.matches("    carrystep_pulser #(").count(), axes);
    }
}

#[test]
fn parallel_core_has_the_axes_that_its_name_says() {
    for axes in 1..=AXES {
        let text = parallel_verilog(&build(48_000_000, 16), axes, "a test").unwrap();
        assert!(text.contains(&format!("\nmodule carrystep_parallel_{axes} #(\n")));
        assert_eq!(text.matches("    carrystep_shaper #(").count(), axes);
    }
    for axes in [0, 7] {
        let error = parallel_verilog(&build(48_000_000, 16), axes, "a test").unwrap_err();
        assert_eq!(error.to_string(), format!("{axes} axes: the parallel core has 1 to 6"));
    }
}

#[test]
fn equal_modules_are_written_once_and_named_by_kind() {
    let text = parallel_verilog(&build(48_000_000, 16), 6, "a test").unwrap();
    let modules: Vec<&str> = text.lines().filter_map(|line| line.strip_prefix("module ")).collect();
    let heads = ["tick #", "sequencer ", "step_edge ", "axis #", "shaper #", "parallel_6 #"];
    assert_eq!(modules, heads.map(|head| format!("carrystep_{head}(")));
    assert!(!text.contains('$'));
}

#[test]
fn same_build_gives_the_same_text() {
    let build = build(20_000_000, 4);
    let text = || parallel_verilog(&build, 3, "a").unwrap();
    assert_eq!(text(), text());
}

#[test]
fn timing_that_cannot_be_counted_is_refused_and_nothing_is_written() {
    let mut build = build(48_000_000, 16);
    build.pins[3].step_low = 0;
    let folder = tempfile::tempdir().unwrap();
    let write = |axes| write_parallel(folder.path(), &build, axes, &Prefix::default(), "a test");
    let error = write(AXES).unwrap_err();
    assert!(error.to_string().contains("step_low is 0 clocks"), "{error}");
    assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 0);
    // The timing is that of axis 3, which a core of three axes does not have.
    assert_eq!(write(3).unwrap().len(), 3);
}

#[test]
fn engine_whose_turns_do_not_fit_is_refused_with_the_arithmetic() {
    let folder = tempfile::tempdir().unwrap();
    let engine = guarded(&build(48_000_000, 16));
    let error = write_engine(folder.path(), &engine, &Prefix::default(), "a test").unwrap_err();
    assert_eq!(
        error.to_string(),
        "6 axes need 13 clocks each and two to close the tick, 80 in all, but a tick of 1000 ns at 48000000 Hz has 48: \
         a tick of 2000 ns, a clock of 80000000 Hz or fewer axes would do"
    );
    assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 0);
}

#[test]
fn engine_with_invalid_parameters_is_refused_by_name() {
    let phase_of_one_clock = |build: &mut EngineBuild| {
        (build.pins, build.guard.stop) = (vec![PinTiming::SHORTEST], vec![1]);
        build.timebase = Timebase::new(16_000_000, 1000, 16).unwrap();
    };
    let nine_axes = |build: &mut EngineBuild| {
        build.pins = vec![PinTiming::SHORTEST; 9];
        build.guard.stop = vec![1; 9];
    };
    type Spoil = fn(&mut EngineBuild);
    let refusals: [(Spoil, &str); 6] = [
        (nine_axes, "9 axes: an engine has 1 to 8"),
        (|build| build.pins.clear(), "0 axes: an engine has 1 to 8"),
        (|build| build.guard.stop.truncate(4), "4 stop accelerations for 6 axes"),
        (phase_of_one_clock, "16 phases in the 16 clocks of a tick"),
        (|build| build.pins[5].step_high = 0, "axis 5: step_high is 0 clocks"),
        (
            |build| build.pins[1].dir_setup = 65_537,
            "axis 1: dir_setup is 65537 clocks: from 1 to 65536 can be counted",
        ),
    ];
    for (spoil, says) in refusals {
        let mut build = engine_of(6);
        spoil(&mut build);
        let folder = tempfile::tempdir().unwrap();
        let error = write_engine(folder.path(), &build, &Prefix::default(), "a test").unwrap_err();
        let error = error.to_string();
        assert!(error.contains(says), "{error}, not: {says}");
        assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 0);
    }
}

/// A machine file is refused before there is a build if its greatest speed exceeds the driver's
/// width and gap, or if its phases do not divide the tick.
#[test]
fn a_machine_that_no_engine_can_drive_is_refused_by_name() {
    let text = std::fs::read_to_string(Path::new(ROOT).join("sim/six-axis.toml")).unwrap();
    let refusals = [
        (
            "driver = \"tmc2209\"",
            "step_high_ns = 15000\nstep_low_ns = 15000\ndir_setup_ns = 20\ndir_hold_ns = 20",
            "step_high and step_low",
        ),
        (
            "tick_ns = 1000",
            "tick_ns = 1050",
            "84 clocks per tick do not divide into 16 equal phases",
        ),
    ];
    for (was, becomes, says) in refusals {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("machine.toml");
        assert!(text.contains(was), "the text is gone: {was}");
        std::fs::write(&file, text.replace(was, becomes)).unwrap();
        let error = Machine::load(&file).unwrap_err().to_string();
        assert!(error.contains(says), "{error}, not: {says}");
    }
}

#[test]
fn verilator_lint_reports_no_warning() {
    let arguments = |name: &str| {
        let words = [
            "--lint-only",
            "-Wall",
            "--top-module",
            name,
            &format!("{name}.vlt"),
            &format!("{name}.v"),
        ];
        words.map(String::from).to_vec()
    };
    on_each_core("verilator", arguments, |ok, said| ok && said.is_empty());
}

#[test]
fn yosys_finds_no_latch_and_no_undriven_wire() {
    let arguments = |name: &str| {
        let script = format!(
            "read_verilog {name}.v; hierarchy -check -top {name}; proc; check -assert; select -assert-none t:$dlatch"
        );
        ["-q", "-p", &script].map(String::from).to_vec()
    };
    on_each_core("yosys", arguments, |ok, said| ok && !said.contains("Warning"));
}

#[test]
fn committed_cores_are_up_to_date() {
    for core in &CORES {
        let machine = Machine::load(&Path::new(ROOT).join(core.machine)).unwrap();
        let read = |extension| {
            let path =
                Path::new(ROOT).join("hdl-out/core").join(core.name).with_extension(extension);
            std::fs::read_to_string(path).unwrap()
        };
        let how = "run `cargo xtask generate`";
        assert!(
            read("v") == (core.of_machine)(&machine, core.machine).unwrap(),
            "{}: {how}",
            core.name
        );
        assert!(read("vlt") == core.waivers, "{}: {how}", core.name);
    }
}

#[test]
fn files_generated_from_tables_are_up_to_date() {
    for file in generated_files().unwrap() {
        let committed =
            std::fs::read_to_string(Path::new(ROOT).join(&file.name)).unwrap_or_default();
        assert!(committed == file.text, "{}: run `cargo xtask generate`", file.name);
    }
}
