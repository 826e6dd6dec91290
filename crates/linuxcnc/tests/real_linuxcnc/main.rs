//! The real LinuxCNC, headless, drives a virtual board through the component: it runs programs,
//! pauses, aborts, jogs and stops, homes on a switch and on an index pulse, probes, and is killed in
//! motion. The pulses are compared with the motor-pos-cmd of every servo period. What reaches the
//! board in a short program is replayed on the exported Verilog.
//!
//! LinuxCNC and the board run in real time, so this is a longer run: `cargo xtask long linuxcnc`. It
//! needs the packages linuxcnc-uspace and linuxcnc-uspace-dev, and root or write access to the folder
//! of LinuxCNC's modules. Without CARRYSTEP_LINUXCNC the tests do nothing.
#![cfg(unix)]
#![allow(clippy::print_stderr, reason = "figures and void runs, for the page of longer runs")]
#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches unit tests only")]

mod board;
mod compare;
mod installation;
#[path = "../../../virtual-board/tests/support/recorder.rs"]
#[allow(dead_code, reason = "the tests of other crates use the rest")]
mod recorder;
mod replay;

use board::{Done, board};
use carrystep_core::engine::Cause;
use carrystep_files::{Machine, SourceText};
use compare::{compare, samples};
use installation::{Module, Ran, linuxcnc, prefer};
use std::fs::{self, Permissions};
use std::os::unix::fs::PermissionsExt as _;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use tempfile::TempDir;

const CLOCK_HZ: u64 = 80_000_000;
const TICK_NS: u64 = 1000;
const TICK: u64 = CLOCK_HZ * TICK_NS / 1_000_000_000;
const JOINTS: usize = 3;
const SCALES: [f64; JOINTS] = [80.0, 80.0, 400.0];
/// Servo periods in a segment. Long segments and a long horizon: bytes through a pseudo-terminal
/// can take 100 ms and more while other programs use all of the computer's cores.
const PERIODS: usize = 8;
const HORIZON_MS: u32 = 200;
/// The greatest distance between pulses and commands: half a step by which pulses are whole, and the
/// cubics' own error.
const BOUND: f64 = 1.0;
/// Speed of the last approach to the home switch, steps/s.
const LATCH_SPEED: f64 = 160.0;
/// Priorities under SCHED_FIFO of the board and of LinuxCNC's real-time process, where the user may
/// set them: both run in real time, beside whatever else this computer does.
const PRIORITIES: [&str; 2] = ["10", "11"];

/// The machine of most runs.
fn machine() -> Machine {
    machine_with(&[])
}

/// The same with other words in its file.
fn machine_with(changes: &[(&str, &str)]) -> Machine {
    let mut text = include_str!("machine.toml").to_owned();
    for (old, new) in changes {
        assert_eq!(text.matches(old).count(), 1, "{old}");
        text = text.replace(old, new);
    }
    let source = SourceText { path: "machine.toml".into(), text: text.into() };
    Machine::from_source(&source).unwrap()
}

/// One LinuxCNC runs on a computer.
static ALONE: Mutex<()> = Mutex::new(());

/// What came of a run.
enum Outcome {
    Good(String),
    /// The computer was later than the horizon, or samples were lost.
    Void(String),
}

/// What all runs need: the component among LinuxCNC's modules, and programs.
struct Workshop {
    folder: TempDir,
    _module: Module,
    /// Our own program, where the user nobody can read it.
    square: PathBuf,
    /// LinuxCNC's programs of CARRYSTEP_LINUXCNC.
    others: Vec<PathBuf>,
}

impl Workshop {
    /// `None` without CARRYSTEP_LINUXCNC.
    fn new() -> Option<Self> {
        let asked = std::env::var("CARRYSTEP_LINUXCNC").ok()?;
        let own = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../sim/jobs/square_and_arc.ngc");
        let folder = TempDir::new().unwrap();
        fs::set_permissions(folder.path(), Permissions::from_mode(0o755)).unwrap();
        let square = folder.path().join("square_and_arc.ngc");
        fs::copy(own, &square).unwrap();
        let others = asked.split(':').filter(|name| !name.is_empty() && *name != "square_and_arc");
        let place = |name| PathBuf::from(format!("/usr/share/linuxcnc/ncfiles/{name}.ngc"));
        let others = others.map(place).collect();
        let _module = Module::build(folder.path());
        Some(Self { folder, _module, square, others })
    }

    /// Makes a run until one is not void; three void runs fail.
    fn until_not_void(&self, name: &str, attempt: impl Fn(&Path) -> Outcome) {
        for _ in 0..3 {
            match attempt(self.folder.path()) {
                Outcome::Good(figures) => {
                    eprintln!("FIGURES {figures} ({name})");
                    return;
                }
                Outcome::Void(why) => eprintln!("void: {name}: {why}"),
            }
        }
        panic!("{name}: three runs were void");
    }

    /// A run whose pulses must follow the commands.
    fn follows(&self, name: &str, what: &str, program: &Path) {
        self.until_not_void(name, |folder| {
            let (ran, done) = one(folder, &machine(), what, program);
            if let Some(void) = void(&ran, &done) {
                return void;
            }
            is_whole(&ran);
            match follows(&ran, &done) {
                Ok(figures) => Outcome::Good(figures),
                Err(void) => void,
            }
        });
    }
}

/// Runs LinuxCNC with a new board. `None` if the computer was too late.
fn one(folder: &Path, machine: &Machine, what: &str, program: &Path) -> (Ran, Done) {
    let end = Arc::new(AtomicBool::new(false));
    let (port, thread) = board(machine, Arc::clone(&end));
    let ran = linuxcnc(folder, machine, &port, what, program);
    end.store(true, Ordering::Relaxed);
    (ran, thread.join().unwrap())
}

fn void(ran: &Ran, done: &Done) -> Option<Outcome> {
    ran.late().then(|| {
        Outcome::Void(format!(
            "later than the horizon, longest pause of the board {:?}: {}",
            done.pause, ran.result
        ))
    })
}

fn is_whole(ran: &Ran) {
    assert!(ran.result.contains("\"whole\": true"), "{}\n{}", ran.result, ran.said);
    assert!(ran.result.contains("\"errors\": []"), "{}\n{}", ran.result, ran.said);
}

/// The pulses follow the commands in every servo period, and the end is exact.
fn follows(ran: &Ran, done: &Done) -> Result<String, Outcome> {
    let samples = samples(&ran.samples);
    let samples = samples.ok_or_else(|| Outcome::Void("halsampler lost samples".to_owned()))?;
    let (worst, compared) = compare(&samples, done);
    assert!(worst.iter().all(|&worst| worst <= BOUND), "{worst:?} of {compared} periods");
    let last = samples.last().unwrap();
    for joint in 0..JOINTS {
        let wanted = last.steps[joint].round();
        assert_eq!(f64::from(done.positions[joint]), wanted, "joint {joint}\n{}", ran.result);
    }
    Ok(format!(
        "{compared} servo periods, {} pulses; pulses within {:.2}, {:.2}, {:.2} steps of \
         motor-pos-cmd, end exact; least reserve {:.1} of {HORIZON_MS} ms",
        done.pulses.len(),
        worst[0],
        worst[1],
        worst[2],
        ran.number("reserve_min_ms")
    ))
}

/// Feed hold, abort, jog, e-stop; and each program of its own.
#[test]
fn the_real_linuxcnc_drives_a_virtual_board() {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    let Some(workshop) = Workshop::new() else { return };
    workshop.follows("cases", "cases", &workshop.square);
    for program in &workshop.others {
        let name = program.file_stem().unwrap().to_string_lossy();
        workshop.follows(&name, "program", program);
    }
}

/// A home switch at a general input; G38.2 with a latch, behind an output that M64 switches on.
#[test]
fn the_real_linuxcnc_homes_and_probes() {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    let Some(workshop) = Workshop::new() else { return };
    workshop.until_not_void("home and probe", |folder| {
        let (ran, done) = one(folder, &machine(), "home_and_probe", &workshop.square);
        if let Some(void) = void(&ran, &done) {
            return void;
        }
        is_whole(&ran);
        let figures = match follows(&ran, &done) {
            Ok(figures) => figures,
            Err(void) => return void,
        };
        // The latch gives the place of the edge. The board's thread has seen it between two pulses.
        let (probe, &edge) = (ran.number("probed_steps"), done.probes.last().unwrap());
        let off = probe - (f64::from(edge) - 0.5);
        assert!((-0.01..=1.01).contains(&off), "{probe}, {edge}\n{}", ran.result);
        // The snapshot that shows the switch first is up to 100 ms away from its edge.
        let (home, &edge) = (ran.number("home_steps"), done.homes.last().unwrap());
        let late = home - f64::from(edge);
        assert!(late.abs() <= 1.0 + LATCH_SPEED * 0.1, "{home}, {edge}\n{}", ran.result);
        Outcome::Good(format!("probe {off:.2} steps behind its edge, home {late:.2}; {figures}"))
    });
}

/// A home switch, and behind it the first index pulse, whose edge a latch has: its place gets the
/// coordinate.
#[test]
fn the_real_linuxcnc_homes_on_an_index_pulse() {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    let Some(workshop) = Workshop::new() else { return };
    let latches = ("edge = \"rising\" }]", "edge = \"rising\" }, { edge = \"rising\" }]");
    workshop.until_not_void("home on an index pulse", |folder| {
        let machine = machine_with(&[latches]);
        let (ran, done) = one(folder, &machine, "home_on_index", &workshop.square);
        if let Some(void) = void(&ran, &done) {
            return void;
        }
        is_whole(&ran);
        let figures = match follows(&ran, &done) {
            Ok(figures) => figures,
            Err(void) => return void,
        };
        // The axis moves backward: the edge lies half a step before the pulse that leads to it.
        let (home, edge) = (ran.number("home_steps"), f64::from(done.index.unwrap()) + 0.5);
        let off = edge - home;
        assert!((-0.01..=1.01).contains(&off), "{home}, {edge}\n{}", ran.result);
        Outcome::Good(format!("{off:.2} steps behind the edge at {edge}; {figures}"))
    });
}

/// SIGKILL for LinuxCNC's real-time process: the board ramps down, and the next LinuxCNC has the
/// true position.
#[test]
fn the_real_linuxcnc_is_killed_in_motion() {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    let Some(workshop) = Workshop::new() else { return };
    workshop.until_not_void("killed in motion", |folder| {
        let end = Arc::new(AtomicBool::new(false));
        let machine = machine();
        let (port, thread) = board(&machine, Arc::clone(&end));
        let killed = linuxcnc(folder, &machine, &port, "killed", &workshop.square);
        let next = linuxcnc(folder, &machine, &port, "look", &workshop.square);
        end.store(true, Ordering::Relaxed);
        let done = thread.join().unwrap();
        if let Some(void) = void(&killed, &done) {
            return void;
        }
        is_whole(&killed);
        is_whole(&next);
        let alone = |cause| matches!(cause, Cause::Underrun | Cause::Watchdog);
        let stop = done.stops.iter().find(|stop| alone(stop.1));
        let &(stop, cause) = stop.unwrap_or_else(|| panic!("no stop: {:?}", done.stops));
        for (joint, scale) in SCALES.iter().enumerate() {
            let pulses = done.pulses.iter().filter(|pulse| pulse.1 == joint);
            let sum: i32 = pulses.map(|pulse| pulse.2).sum();
            assert_eq!(done.positions[joint], sum, "joint {joint}");
            let shown = next.number(&format!("feedback_{joint}")) * scale;
            assert!((shown - f64::from(sum)).abs() < 1e-3, "joint {joint}: {shown}, {sum} pulses");
        }
        // The steps of the fastest axis become longer until it rests: a ramp.
        let gaps = |axis: usize| {
            let behind = done.pulses.iter().filter(move |pulse| pulse.1 == axis && pulse.0 > stop);
            let clocks: Vec<u64> = behind.map(|pulse| pulse.0).collect();
            clocks.windows(2).map(|pair| pair[1] - pair[0]).collect::<Vec<u64>>()
        };
        let ramp = (0..JOINTS).map(gaps).max_by_key(Vec::len).unwrap();
        assert!(ramp.windows(2).skip(2).all(|pair| pair[1] + 8 >= pair[0]), "{ramp:?}");
        Outcome::Good(format!("{cause}, a ramp of {} steps, positions true", ramp.len() + 1))
    });
}
