//! `--json` prints one document whose field names do not change, because scripts depend on them.

use crate::boards::{Peer, Port, folder};
use crate::command::{Folder, GOOD};
use crate::schemas;
use serde_json::Value;
use std::io::Write as _;
use std::process::{Command, Stdio};

const LIMITS: &str = "limits limits.total_ticks limits.total_s limits.tick_ns limits.tick_note limits.axes
    limits.axes[].axis limits.axes[].unit limits.axes[].steps_per_unit limits.axes[].segments limits.axes[].steps limits.axes[].residue
    limits.axes[].speed_steps_per_s limits.axes[].speed_limit_steps_per_s
    limits.axes[].acceleration_steps_per_s2 limits.axes[].acceleration_limit_steps_per_s2
    limits.axes[].start_speed_steps_per_s limits.axes[].start_speed_limit_steps_per_s";

const CHECK: &str = "check check.passed check.origin check.origin_ps check.slack_ns check.phase_ns check.axes
    check.axes[].axis check.axes[].passed check.axes[].failures check.axes[].failures_omitted
    check.axes[].pulses_expected check.axes[].pulses_found check.axes[].pulses_wrong_direction
    check.axes[].position_expected check.axes[].position_found
    check.axes[].error_min_ns check.axes[].error_max_ns check.axes[].error_rms_ns
    check.axes[].error_fit_ns check.axes[].error_bound_ns
    check.axes[].error_std_ns check.axes[].error_std_theory_ns
    check.axes[].step_high_min_ns check.axes[].step_high_required_ns check.axes[].step_low_min_ns check.axes[].step_low_required_ns
    check.axes[].dir_setup_min_ns check.axes[].dir_setup_required_ns check.axes[].dir_hold_min_ns check.axes[].dir_hold_required_ns
    check.axes[].period_jitter_max_ns check.axes[].period_jitter_theory_ns
    check.axes[].speed_ripple_max_percent check.axes[].speed_ripple_theory_percent
    check.axes[].line_off_max_steps check.axes[].line_off_bound_steps";

const TIME_USE: &str = "time_use time_use.causes time_use.causes[].cause time_use.causes[].axis
    time_use.causes[].seconds time_use.causes[].percent time_use.causes[].lines
    time_use.causes[].lines[].from time_use.causes[].lines[].to time_use.causes[].lines[].seconds
    time_use.lines_together time_use.distance_seconds";

const PLAN: &str = "passed tick_ns moves
    moves[].start_tick moves[].rest_ticks moves[].ticks moves[].seconds moves[].axes
    moves[].axes[].axis moves[].axes[].shape moves[].axes[].steps moves[].axes[].rounding_steps
    moves[].axes[].segments moves[].axes[].segments[].ticks moves[].axes[].segments[].v
    moves[].axes[].segments[].a moves[].axes[].segments[].j moves[].axes[].segments[].last";

const RUN: &str = "passed core level clocks run_s faults positions files";

const STATUS: &str =
    "passed port build clock_hz tick_ns phases watchdog_ticks ready idle armed fault halted cause
    meaning remedy held_by stopped ticks waits waits_for_input block moving overrides
    axes axes[].axis axes[].position axes[].place axes[].machine axes[].discarded axes[].seeking
    axes[].culprit";

const SERVED: &str =
    "passed seconds clocks fault files axes axes[].axis axes[].position axes[].discarded";

const LINUXCNC: &str = "passed build_id port baud periods horizon_ms notes files
    joints joints[].axis joints[].letter joints[].home_sequence";

const DRIVEN: &str = "passed port build ended stopped_by cause culprits meaning remedy planned_s run_s
    axes axes[].axis axes[].before axes[].position axes[].steps_planned axes[].unit axes[].steps_per_unit";

const BOARDS: &str = "passed tried_on_hardware boards boards[].name boards[].title boards[].family
    boards[].queue_depth boards[].parts boards[].parts[].name boards[].parts[].package
    boards[].parts[].block_rams
    boards[].oscillator boards[].oscillator.pin boards[].oscillator.hz boards[].oscillator.io
    boards[].clocks boards[].clocks[].clock_hz boards[].clocks[].tick_ns boards[].clocks[].phases
    boards[].clocks[].made_by boards[].clocks[].why boards[].io boards[].wires boards[].wires[].port
    boards[].wires[].pin boards[].wires[].at boards[].wires[].at.connector boards[].wires[].at.label
    boards[].wires[].beside_uart boards[].ties
    boards[].led_low boards[].flash boards[].bitstream boards[].notes boards[].conflicts boards[].sources
    boards[].measured boards[].measured.block_rams boards[].configured boards[].configuration_sources
    boards[].shared";

const ICE40: &str = "boards[].pll boards[].parts[].logic_cells boards[].usb boards[].clocks[].made_by.ice40_pll
    boards[].clocks[].made_by.ice40_pll.divr boards[].clocks[].made_by.ice40_pll.divf
    boards[].clocks[].made_by.ice40_pll.divq boards[].clocks[].made_by.ice40_pll.filter_range
    boards[].measured.logic_cells boards[].measured.nextpnr_mhz boards[].measured.icetime_mhz boards[].measured.seed";

/// What an engine's guard does.
const GUARD: &str = "guard guard.debounce_us guard.debounce_us.least guard.debounce_us.most guard.enable_ms
    guard.enable_ms.least guard.enable_ms.most guard.estop guard.limit_level guard.limit_stop guard.limits
    guard.round_us guard.stop_accel_steps_per_s2 guard.watchdog_ms guard.watchdog_ms.least guard.watchdog_ms.most";

const TIES: &str =
    "boards[].ties[].port boards[].ties[].pin boards[].ties[].level boards[].ties[].why";

/// Only for boards whose ports share pins with the configuration, or wait for a gate.
const SHARED: &str =
    "boards[].gate boards[].shared[].port boards[].shared[].pin boards[].shared[].function boards[].shared[].modes
    boards[].shared[].why boards[].gate.port boards[].gate.pin boards[].gate.wait_ns boards[].gate.holds
    boards[].gate.why";

/// What an ECP5 has beyond an iCE40 and a Spartan.
const ECP5: &str = "boards[].clocks[].made_by.ecp5_pll boards[].clocks[].made_by.ecp5_pll.divide
    boards[].clocks[].made_by.ecp5_pll.multiply boards[].clocks[].made_by.ecp5_pll.out_divide
    boards[].measured.least_mhz";

const GOWIN: &str = "boards[].clocks[].made_by.gowin_pll boards[].clocks[].made_by.gowin_pll.divide
    boards[].clocks[].made_by.gowin_pll.multiply boards[].clocks[].made_by.gowin_pll.out_divide
    boards[].wires[].io";

const SPARTANS: &str =
    "boards[].vccaux boards[].max_baud boards[].parts[].speed boards[].bitgen boards[].clocks[].made_by.dcm
    boards[].clocks[].made_by.dcm.multiply boards[].clocks[].made_by.dcm.divide boards[].clocks[].made_by.mmcm
    boards[].clocks[].made_by.mmcm.multiply boards[].clocks[].made_by.mmcm.divide
    boards[].clocks[].made_by.mmcm.out_divide boards[].measured.luts boards[].measured.flip_flops
    boards[].measured.carries";

/// Every name in a document: `a.b` for the field b of a, and `a[]` for the elements of the list a.
fn names(value: &Value, path: &str, found: &mut Vec<String>) {
    match value {
        Value::Object(fields) => {
            for (name, field) in fields {
                let name = if path.is_empty() { name.clone() } else { format!("{path}.{name}") };
                names(field, &name, found);
                found.push(name);
            }
        }
        Value::Array(entries) => {
            entries.iter().for_each(|entry| names(entry, &format!("{path}[]"), found));
        }
        _ => {}
    }
}

/// Runs the command and checks that its document has exactly these names.
#[track_caller]
fn document(folder: &Folder, arguments: &str, status: i32, expected: &[&str]) -> Value {
    let ran = folder.run(&format!("{arguments} --json"));
    assert_eq!((ran.status, ran.stderr.as_str()), (status, ""), "{arguments}");
    is_document(&ran.stdout, arguments, status, expected)
}

#[track_caller]
fn is_document(text: &str, arguments: &str, status: i32, expected: &[&str]) -> Value {
    let document = schemas::check(text);
    assert_eq!(document["passed"], status == 0, "{arguments}");
    let mut found = Vec::new();
    names(&document, "", &mut found);
    found.sort();
    found.dedup();
    let mut expected: Vec<&str> =
        expected.iter().flat_map(|names| names.split_whitespace()).collect();
    expected.extend(["schema", "schema.name", "schema.version"]);
    expected.sort_unstable();
    assert_eq!(found, expected, "{arguments}");
    document
}

#[test]
fn every_report_keeps_its_names() {
    let folder = Folder::with_move(GOOD);
    document(&folder, "plan move.toml", 0, &[PLAN, LIMITS, TIME_USE]);
    let run = document(
        &folder,
        "simulate move.toml --vcd a.vcd --csv a.csv",
        0,
        &[RUN, LIMITS, TIME_USE, CHECK],
    );
    assert_eq!(run["files"], serde_json::json!(["a.vcd", "a.csv"]));
    assert_eq!(run["positions"], serde_json::json!([4]));
    document(&folder, "check a.vcd move.toml", 0, &["passed capture", CHECK]);
    document(&folder, "verilog --out out", 0, &["passed top tick_ns tick_note files", GUARD]);
    document(
        &folder,
        "verilog --core parallel --out out",
        0,
        &["passed top tick_ns tick_note files"],
    );

    let run = document(&folder, "demo --out demo", 0, &[RUN, LIMITS, TIME_USE, CHECK]);
    for file in run["files"].as_array().expect("a list of files") {
        assert!(folder.path(file.as_str().expect("a path")).is_file(), "{file}");
    }
    document(&folder, "plan demo/demo.toml", 0, &[PLAN, LIMITS, TIME_USE]);
    document(&folder, "check demo/demo.vcd demo/demo.toml", 0, &["passed capture", CHECK]);
}

#[test]
fn linuxcnc_document_keeps_its_field_names() {
    let folder = Folder::new();
    folder.write("m.toml", crate::linuxcnc::MILL);
    let written = document(&folder, "linuxcnc --machine m.toml --out out", 0, &[LINUXCNC]);
    assert_eq!(written["files"], serde_json::json!(["out/m.ini", "out/m.hal", "out/m.tbl"]));
}

#[test]
fn boards_document_keeps_its_field_names() {
    let folder = Folder::new();
    document(&folder, "boards", 0, &[BOARDS, ICE40, ECP5, GOWIN, TIES, SHARED, SPARTANS]);
    let one = document(&folder, "boards icebreaker", 0, &[BOARDS, ICE40]);
    assert_eq!(one["boards"][0]["clocks"][0]["clock_hz"], 37_500_000);
    assert_eq!(one["tried_on_hardware"], false);
}

#[test]
fn status_and_drive_documents_keep_their_field_names() {
    let folder = folder();
    // The device counts one step per tick, so a move along it ends elsewhere.
    let port = Port::new(Peer::Device(Box::new(Peer::board())));
    document(&folder, &format!("status --port {}", port.name), 0, &[STATUS]);
    document(&folder, &format!("stop --port {}", port.name), 0, &[STATUS]);
    let run = document(&folder, &format!("run move.toml --port {}", port.name), 1, &[DRIVEN]);
    assert_eq!((&run["ended"], &run["axes"][0]["steps_planned"]), (&"done".into(), &10.into()));
    port.end();
    let mut command = Command::new(env!("CARGO_BIN_EXE_carrystep"));
    command
        .args(["virtual-board", "--machine", "machine.toml", "--json"])
        .current_dir(folder.path(""));
    let mut board =
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::null()).spawn().unwrap();
    board.stdin.take().unwrap().write_all(b"nonsense\nend\n").unwrap();
    let output = board.wait_with_output().unwrap();
    assert!(output.status.success());
    is_document(&String::from_utf8(output.stdout).unwrap(), "virtual-board", 0, &[SERVED]);
}

#[test]
fn a_failed_check_is_a_document_too() {
    let folder = Folder::with_move(GOOD);
    document(&folder, "simulate move.toml --vcd a.vcd", 0, &[RUN, LIMITS, TIME_USE, CHECK]);
    folder.write("longer.toml", GOOD.replace("x = 2", "x = 3"));
    let checked = document(&folder, "check a.vcd longer.toml", 1, &["passed capture", CHECK]);
    let axis = &checked["check"]["axes"][0];
    assert_eq!((&axis["pulses_expected"], &axis["pulses_found"]), (&21.into(), &16.into()));
    assert!(
        axis["failures"][0].as_str().is_some_and(|sentence| sentence.contains("axis x")),
        "{axis}"
    );
}

#[test]
fn numbers_of_64_bits_are_strings() {
    let folder = Folder::with_move(GOOD);
    let plan = document(&folder, "plan move.toml", 0, &[PLAN, LIMITS, TIME_USE]);
    let segment = &plan["moves"][0]["axes"][0]["segments"][0];
    for name in ["v", "a", "j"] {
        assert!(
            segment[name].as_str().is_some_and(|text| text.parse::<i64>().is_ok()),
            "{segment}"
        );
    }
}
