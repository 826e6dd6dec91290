//! A run of a program on six axes, recorded byte by byte, and replayed on the exported Verilog.
//!
//! The command talks to a board of models, while other commands hold the program, resume it and
//! change its speed. What reached the board reaches the Verilog in the same clocks: all pins, and
//! the line to the host, are the same in every clock.

use crate::board_here::BoardHere;
use crate::command::Folder;
use crate::recorder::Recorder;
use crate::stops::{drives, moving};
use crate::virtual_boards::passed;
use carrystep_core::link::LineKind;
use carrystep_files::Machine;
use carrystep_virtual_board::{ModelBoard, Pace, SimulatedBoard as _, Switches, VerilatedBoard};
use serde_json::Value;
use std::time::Duration;

/// The clock is slow, because the Verilog takes time for each clock.
const CLOCK_HZ: u64 = 20_000_000;
const BAUD: u64 = 2_500_000;

/// Bits of a byte on the line.
const BITS: u64 = 10;

const HEAD: &str = r#"[machine]
clock_hz = 20_000_000
tick_ns = 4000
queue_depth = 31
cuts = true

[machine.guard]
watchdog_ms = 4000
debounce_us = 100

[machine.link]
baud = 2_500_000

[machine.inputs]
probe = "low"

[machine.outputs]
count = 4
pwm_divider = 2
spindle = 0
flood = 1
spindle_rpm = 24_000
"#;

/// Six axes, and drivers with different pin timings.
fn machine() -> String {
    let axes = [
        ("x", 80, 100, 2000, "tmc2209"),
        ("y", 80, 100, 2000, "a4988"),
        ("z", 400, 50, 1000, "drv8825"),
        ("a", 40, 400, 8000, "dm542"),
        ("b", 44, 400, 8000, "tmc5160"),
        ("c", 10, 400, 8000, "tb6600"),
    ];
    axes.iter().fold(HEAD.to_owned(), |text, (name, steps, speed, accel, driver)| {
        text + &format!(
            "\n[[machine.axis]]\nname = \"{name}\"\nsteps_per_unit = {steps}\nspeed_limit = \
             {speed}\naccel_limit = {accel}\ndriver = \"{driver}\"\n"
        )
    })
}

/// All axes move, output 3 is switched in motion, and z probes.
const JOB: &str = "G21 G90 G64 P0.05 F1800\nM3 S12000 M8\nG1 X2 Y1 A10\nM62 P3\n\
    G1 X4 Y4 A-10 B8\nG3 X4 Y4 I-3 J1 C12\nM63 P3\nG1 X-4 Y2 A20 Z0.5\nG3 X-4 Y2 I3 J1 B-4\n\
    G1 X0 Y0 A0 C-6\nM9\nG38.2 Z-3 F240\nG1 Z[#5063 + 1] F900\nG1 X1 A5 B0 C0\nM5\nM2\n";

/// z is at -200 steps at the plate of the probe.
const PLATE: i32 = -200;

/// How far the board runs without a byte from its host: longer than the bytes last that wait.
const AHEAD: u64 = 3 * CLOCK_HZ / 1000;

fn switches(board: &Recorder) -> Switches {
    let mut switches = Switches::default();
    switches.touch_probe(board.position(2) <= PLATE);
    switches
}

fn status(folder: &Folder, port: &str) -> Value {
    let ran = folder.run(&format!("status --port {port} --machine machine.toml --json"));
    serde_json::from_str(&ran.stdout).unwrap_or_default()
}

#[test]
fn recorded_run_replayed_on_the_verilog_is_the_same_in_every_clock() {
    let folder = Folder::new();
    folder.write("machine.toml", machine());
    folder.write("job.ngc", JOB);
    let machine = Machine::load(&folder.path("machine.toml")).unwrap();
    let engine = machine.engine();
    let Ok(LineKind::Uart(uart)) = machine.line() else { panic!("a UART") };
    let model = || ModelBoard::new(&engine, uart);
    let pace = Pace::fast(CLOCK_HZ, AHEAD);
    let board = BoardHere::new(Recorder::new(model()), (), (pace, CLOCK_HZ), switches);
    let port = board.port.clone();
    let asks = |what: &str| passed(&folder.run(&format!("{what} --port {port}")));

    let mut child = drives(&folder, "run job.ngc --machine machine.toml", &port);
    moving(&folder, &mut child, &port);
    asks("override --feed 60");
    asks("hold");
    while !status(&folder, &port)["waits"].as_str().is_some_and(|at| at.starts_with("hold in ")) {
        if child.try_wait().unwrap().is_some() {
            let output = child.wait_with_output().unwrap();
            panic!("it has ended: {}", String::from_utf8_lossy(&output.stdout));
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    asks("override --feed 120");
    asks("resume");
    let output = child.wait_with_output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(said.contains("line 12: the probe has tripped"), "{said}");
    let told: Value = serde_json::from_slice(&output.stdout).unwrap();
    let (program, feed) = (&told["program"], &told["program"]["overrides"]["feed"]);
    assert_eq!((&program["waits"], feed), (&1.into(), &120.into()));
    let positions = [0, 1, 3, 4, 5].map(|axis| told["axes"][axis]["position"].clone());
    assert_eq!(positions, [80, 0, 200, 0, 0]);

    let recording = board.end().0.finish();
    let levels: Vec<u8> = recording.levels.iter().map(|&(_, levels)| levels).collect();
    assert_eq!(levels, [0b0011, 0b1011, 0b0011, 0b0001, 0]);
    let pins = recording.pins(model());
    let verilog = || VerilatedBoard::new(&engine, uart).unwrap();
    let (bytes, heard) = (recording.events.len(), recording.answers.len());
    assert_eq!(recording.difference(verilog(), &pins), None);
    eprintln!(
        "{} clocks, {bytes} bytes and switches to the board, {heard} bytes of answers, {} \
         changes of pins, {} cuts: no difference",
        recording.clocks,
        pins.len(),
        program["cuts"],
    );

    let (late, clocks) = recording.with_a_late_byte(BITS * CLOCK_HZ / BAUD);
    let found = late.difference(verilog(), &pins);
    assert!(found.is_some(), "a byte that is {clocks} clocks late");
}
