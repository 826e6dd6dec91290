//! Runs of programs on six axes, recorded byte by byte, and replayed on the exported Verilog.
//!
//! The command talks to a board of models, while other commands hold the program, resume it, change
//! its speed, jog in a pause, and ramp the axes down. What reached the board reaches the Verilog in
//! the same clocks: all pins, and the line to the host, are the same in every clock.

use crate::board_here::BoardHere;
use crate::command::Folder;
use crate::recorder::Recorder;
use crate::stops::{drives, said};
use crate::virtual_boards::{document, passed};
use carrystep_core::link::{LineKind, Uart};
use carrystep_files::Machine;
use carrystep_virtual_board::{ModelBoard, Pace, SimulatedBoard as _, Switches, VerilatedBoard};
use serde_json::Value;
use std::process::Child;
use std::time::Duration;

/// The clock is slow, because the Verilog takes time for each clock.
const CLOCK_HZ: u64 = 5_000_000;
const BAUD: u64 = 625_000;

/// Bits of a byte on the line.
const BITS: u64 = 10;

const HEAD: &str = r#"[machine]
clock_hz = 5_000_000
tick_ns = 16_000
queue_depth = 31
cuts = true

[machine.guard]
watchdog_ms = 4000
debounce_us = 100

[machine.link]
baud = 625_000

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

/// Behind a pause all axes move, output 3 is switched in motion, and z probes.
const JOB: &str = "G21 G90 G64 P0.05 F1800\nM0\nM3 S12000 M8\nG1 X2 Y1 A10\nM62 P3\n\
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

/// What a board of models was told while commands drove it.
struct Recorded {
    folder: Folder,
    machine: Machine,
    board: BoardHere<Recorder, ()>,
}

impl Recorded {
    fn new(job: &str) -> Self {
        let folder = Folder::new();
        folder.write("machine.toml", machine());
        folder.write("job.ngc", job);
        let machine = Machine::load(&folder.path("machine.toml")).unwrap();
        let model = ModelBoard::new(&machine.engine(), uart(&machine));
        let pace = (Pace::fast(CLOCK_HZ, AHEAD), CLOCK_HZ);
        let board = BoardHere::new(Recorder::new(model), (), pace, switches);
        Self { folder, machine, board }
    }

    /// Executes another command on the board.
    #[track_caller]
    fn asks(&self, what: &str) {
        passed(&self.folder.run(&format!("{what} --port {}", self.board.port)));
    }

    fn begins(&self) -> Child {
        let Self { folder, board, .. } = self;
        drives(folder, "run job.ngc --machine machine.toml", &board.port)
    }

    /// Waits until an axis has another position.
    fn goes_on(&self, child: &mut Child) {
        let Self { folder, board, .. } = self;
        let before = positions(&status(folder, &board.port));
        while positions(&status(folder, &board.port)) == before {
            assert_eq!(child.try_wait().unwrap(), None, "it has ended: {}", said(child));
        }
    }

    /// Waits until the program waits for this.
    fn waits(&self, child: &mut Child, what: &str) {
        let Self { folder, board, .. } = self;
        while !status(folder, &board.port)["waits"].as_str().is_some_and(|at| at.starts_with(what))
        {
            assert_eq!(child.try_wait().unwrap(), None, "it has ended: {}", said(child));
            std::thread::sleep(Duration::from_millis(5));
        }
    }

    /// Replays it on the Verilog, and compares each clock; `cuts` is reported. Returns the levels of
    /// the outputs, one after the other.
    #[allow(clippy::print_stderr, reason = "figures")]
    fn replayed(self, cuts: &Value) -> Vec<u8> {
        let (engine, uart) = (self.machine.engine(), uart(&self.machine));
        let recording = self.board.end().0.finish();
        let pins = recording.pins(ModelBoard::new(&engine, uart));
        let verilog = || VerilatedBoard::new(&engine, uart).unwrap();
        let (bytes, heard) = (recording.events.len(), recording.answers.len());
        assert_eq!(recording.difference(verilog(), &pins), None);
        eprintln!(
            "{} clocks, {bytes} bytes and switches to the board, {heard} bytes of answers, {} \
             changes of pins, {cuts} cuts: no difference",
            recording.clocks,
            pins.len(),
        );
        let levels = recording.levels.iter().map(|&(_, levels)| levels).collect();
        let (late, clocks) = recording.with_a_late_byte(BITS * CLOCK_HZ / BAUD);
        let found = late.difference(verilog(), &pins);
        assert!(found.is_some(), "a byte that is {clocks} clocks late");
        levels
    }
}

fn uart(machine: &Machine) -> Uart {
    let Ok(LineKind::Uart(uart)) = machine.line() else { panic!("a UART") };
    uart
}

/// The positions of the axes that do not probe.
fn positions(told: &Value) -> [Value; 5] {
    [0, 1, 3, 4, 5].map(|axis| told["axes"][axis]["position"].clone())
}

#[test]
fn recorded_run_replayed_on_the_verilog_is_the_same_in_every_clock() {
    let recorded = Recorded::new(JOB);
    let mut child = recorded.begins();
    recorded.waits(&mut child, "pause in line 2");
    // The board is faster than the commands: it must still be in motion when it is told to hold.
    recorded.asks("override --feed 10");
    recorded.asks("resume");
    recorded.goes_on(&mut child);
    recorded.asks("hold");
    recorded.waits(&mut child, "hold in ");
    recorded.asks("override --feed 120");
    recorded.asks("resume");
    let output = child.wait_with_output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(said.contains("line 13: the probe has tripped"), "{said}");
    let told: Value = serde_json::from_slice(&output.stdout).unwrap();
    let (program, feed) = (&told["program"], &told["program"]["overrides"]["feed"]);
    assert_eq!((&program["waits"], feed), (&2.into(), &120.into()));
    assert_eq!(positions(&told), [80, 0, 200, 0, 0]);
    let levels = recorded.replayed(&program["cuts"]);
    assert_eq!(levels, [0b0011, 0b1011, 0b0011, 0b0001, 0]);
}

/// A pause, a path of some 20 seconds, and a last block.
const LONG: &str = "G21 G90 G64 P0.05 F1800\nG1 X1 Y1 A5\nM0\no1 repeat [40]\nG1 X4 Y4 B4\n\
    G1 X-4 Y2 Z0.4 C3\no1 endrepeat\nG1 X1 Y2 A2 B0 C0\nM2\n";
/// Block 4 begins the loop, whose rounds have three blocks each.
const LAST_BLOCK: u64 = 5 + 3 * 40;

/// In a pause an axis is jogged and set to zero; then the axes ramp down in motion, and the program
/// goes on at its last block.
#[test]
fn recorded_pause_ramp_and_entry_are_the_same_in_every_clock() {
    let recorded = Recorded::new(LONG);
    let mut child = recorded.begins();
    recorded.waits(&mut child, "pause in line 3");
    recorded.asks("jog y 0.5 --machine machine.toml --set G54");
    recorded.asks("resume");
    let Recorded { folder, board, .. } = &recorded;
    while status(folder, &board.port)["block"]["number"].as_u64() < Some(5) {
        assert_eq!(child.try_wait().unwrap(), None, "it has ended: {}", said(&mut child));
    }
    recorded.asks("stop --machine machine.toml");
    let told = document(child);
    assert_eq!((&told["ended"], &told["stopped_by"]), (&"stopped".into(), &"stop".into()));
    recorded.asks(&format!(
        "run job.ngc --machine machine.toml --from-block {LAST_BLOCK} --began-at x=0,y=0,z=0 --yes"
    ));
    let ended = status(folder, &board.port);
    // y was set to zero at 1.5 mm, and z is where the ramp has left it, or higher.
    assert_eq!(positions(&ended), [80, 280, 80, 0, 0]);
    recorded.replayed(&told["program"]["cuts"]);
}
