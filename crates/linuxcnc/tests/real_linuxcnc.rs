//! The real LinuxCNC, headless, drives a virtual board through the component: it runs programs,
//! pauses, aborts, jogs and stops, and the pulses are compared with the motor-pos-cmd of every servo
//! period.
//!
//! LinuxCNC and the board run in real time, so this is a longer run: `cargo xtask long linuxcnc`. It
//! needs the packages linuxcnc-uspace and linuxcnc-uspace-dev, and root or write access to the folder
//! of LinuxCNC's modules. Without CARRYSTEP_LINUXCNC the test does nothing.
#![cfg(unix)]
#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches unit tests only")]

use carrystep_core::link::Uart;
use carrystep_core::{AXES, Build, EngineBuild, PinTiming, StartPhase, Timebase};
use carrystep_linuxcnc::{Configuration, Homing, Joint, OutputNets, component};
use carrystep_model::fast::{Change, Edge};
use carrystep_virtual_board::{Edges, ModelBoard, Pace, RealTimeBoard, SimulatedBoard, Terminal};
use rustix::thread::gettid;
use std::fs::{self, Permissions};
use std::os::unix::fs::PermissionsExt as _;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

const CLOCK_HZ: u64 = 80_000_000;
const TICK_NS: u64 = 1000;
const TICK: u64 = CLOCK_HZ * TICK_NS / 1_000_000_000;
const JOINTS: usize = 3;
const SCALES: [f64; JOINTS] = [80.0, 80.0, 400.0];
/// Servo periods in a segment. Long segments and a long horizon: bytes through a pseudo-terminal
/// can take 100 ms and more while other programs use all of the computer's cores.
const PERIODS: usize = 8;
const HORIZON_MS: u32 = 200;
const BAUD: u32 = 921_600;
/// Stop acceleration, 2^-64 step per tick^2: 119 000 steps/s^2.
const STOP: u64 = 1 << 41;
/// The greatest distance between pulses and commands: half a step by which pulses are whole, and the
/// cubics' own error.
const BOUND: f64 = 1.0;
/// Priorities under SCHED_FIFO of the board and of LinuxCNC's real-time process, where the user may
/// set them: both run in real time, beside whatever else this computer does.
const PRIORITIES: [&str; 2] = ["10", "11"];
/// Where LinuxCNC looks for modules.
const MODULES: &str = "/usr/lib/linuxcnc/modules";

/// Rising edges: clock, axis, direction.
#[derive(Default)]
struct Pulses(Vec<(u64, usize, i32)>);

impl Edges for Pulses {
    fn edge(&mut self, edge: Edge) {
        if edge.change == Change::Rise {
            let step = if edge.backward { -1 } else { 1 };
            self.0.push((edge.clock, edge.axis.into(), step));
        }
    }
}

/// What a board did.
struct Done {
    pulses: Vec<(u64, usize, i32)>,
    loads: Vec<u64>,
    stops: Vec<u64>,
    /// The longest time between two rounds of the board's thread.
    pause: Duration,
    positions: [i32; JOINTS],
}

/// A board in a thread of its own, until `end` is set.
fn board(end: Arc<AtomicBool>) -> (String, JoinHandle<Done>) {
    let timebase = Timebase::new(CLOCK_HZ, TICK_NS, 16).unwrap();
    let build = Build { timebase, phase: StartPhase::Half, pins: [PinTiming::SHORTEST; AXES] };
    let mut build = EngineBuild::minimal(&build, STOP);
    build.guard.round = 1024;
    build.guard.watchdog = 391;
    build.queue = 31;
    let terminal = Terminal::new().unwrap();
    let name = terminal.name().to_owned();
    let model = ModelBoard::new(&build, Uart::new(CLOCK_HZ, BAUD).unwrap());
    let mut board = RealTimeBoard::new(model, terminal, Pace::real(CLOCK_HZ), CLOCK_HZ);
    let thread = thread::spawn(move || {
        // Of this thread alone. Without the right to it, the board runs as it is.
        prefer(&[], PRIORITIES[0], &gettid().as_raw_nonzero().to_string());
        let mut pulses = Pulses::default();
        let (mut round, mut pause) = (Instant::now(), Duration::ZERO);
        while !end.load(Ordering::Relaxed) {
            board.step(&mut pulses).unwrap();
            pause = pause.max(round.elapsed());
            round = Instant::now();
        }
        let board = board.board;
        Done {
            pulses: pulses.0,
            loads: board.loads().to_vec(),
            stops: board.stops().iter().map(|stop| stop.0).collect(),
            pause,
            positions: [0, 1, 2].map(|axis| board.position(axis)),
        }
    });
    (name, thread)
}

/// The component in LinuxCNC's folder of modules, while this exists.
struct Module(PathBuf);

impl Module {
    fn build(folder: &Path) -> Self {
        let own = folder.join("component");
        fs::create_dir(&own).unwrap();
        for (name, text) in component() {
            fs::write(own.join(name), text).unwrap();
        }
        run(Command::new("make").current_dir(&own));
        let to = Path::new(MODULES).join("carrystep.so");
        fs::copy(own.join("carrystep.so"), &to)
            .unwrap_or_else(|error| panic!("{}: {error}", to.display()));
        Self(to)
    }
}

impl Drop for Module {
    fn drop(&mut self) {
        let _ = fs::remove_file(&self.0);
    }
}

fn run(command: &mut Command) {
    let output = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}"));
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{command:?}: {said}");
}

/// Gives a thread, or with `-a` all threads of a process, a priority under SCHED_FIFO. Without the
/// right to it, nothing changes.
fn prefer(which: &[&str], priority: &str, id: &str) {
    let _ = Command::new("chrt").args(which).args(["-f", "-p", priority, id]).output();
}

/// Gives LinuxCNC's real-time process its priority, from when it appears until `end` is set.
fn raise_real_time(end: Arc<AtomicBool>) -> JoinHandle<()> {
    thread::spawn(move || {
        while !end.load(Ordering::Relaxed) {
            let found = Command::new("pgrep").args(["-x", "rtapi_app"]).output().unwrap();
            let text = String::from_utf8_lossy(&found.stdout).into_owned();
            text.split_whitespace().for_each(|id| prefer(&["-a"], PRIORITIES[1], id));
            thread::sleep(Duration::from_millis(300));
        }
    })
}

fn configuration(port: &str) -> Configuration {
    let joint = |number: usize, letter, speed, acceleration, reach: f64| Joint {
        letter,
        scale: SCALES[number],
        speed,
        acceleration,
        travel: Some((-reach, reach)),
        angular: false,
        homing: Homing::InPlace { at: 0.0 },
        sequence: 0,
    };
    Configuration {
        name: "virtual".to_owned(),
        port: port.to_owned(),
        baud: BAUD,
        build: None,
        periods: PERIODS as u32,
        horizon_ms: HORIZON_MS,
        inches: false,
        joints: vec![
            joint(0, 'X', 100.0, 1000.0, 400.0),
            joint(1, 'Y', 100.0, 1000.0, 400.0),
            joint(2, 'Z', 50.0, 500.0, 400.0),
        ],
        limits: false,
        probe: false,
        outputs: OutputNets::default(),
        display: "./ui.py".to_owned(),
        hal_files: vec!["sampler.hal".to_owned()],
    }
}

const SAMPLER: &str = "\
loadrt sampler cfg=fffbuf depth=30000
addf sampler.0 servo-thread
net joint-0-cmd => sampler.0.pin.0
net joint-1-cmd => sampler.0.pin.1
net joint-2-cmd => sampler.0.pin.2
net running carrystep.0.running => sampler.0.pin.3
net end-ticks carrystep.0.end-ticks => sampler.0.pin.4
net reserve carrystep.0.reserve-ms => sampler.0.pin.5
";

/// A servo period.
struct Sample {
    number: u64,
    steps: [f64; JOINTS],
    running: bool,
    end_ticks: u64,
}

/// The samples, or `None` if some were lost.
fn samples(text: &str) -> Option<Vec<Sample>> {
    let lines = text.lines().filter(|line| line.split_whitespace().count() == 7);
    let all: Vec<Sample> = lines
        .map(|line| {
            let words: Vec<&str> = line.split_whitespace().collect();
            Sample {
                number: words[0].parse().unwrap(),
                steps: [0, 1, 2].map(|at| words[1 + at].parse::<f64>().unwrap() * SCALES[at]),
                running: words[4] == "1",
                end_ticks: words[5].parse().unwrap(),
            }
        })
        .collect();
    let whole = all.windows(2).all(|pair| pair[1].number == pair[0].number + 1);
    (whole && !text.contains("overrun")).then_some(all)
}

/// The greatest distance of the pulses from the commands, for each joint, and how many servo periods
/// were compared.
fn compare(samples: &[Sample], done: &Done) -> ([f64; JOINTS], usize) {
    let (mut worst, mut compared) = ([0.0_f64; JOINTS], 0);
    let (mut at, mut places) = (0, [0_i32; JOINTS]);
    let streams: Vec<&[Sample]> =
        samples.chunk_by(|a, b| a.running == b.running).filter(|run| run[0].running).collect();
    assert_eq!(streams.len(), done.loads.len(), "each stream has one start");
    for (stream, &load) in streams.iter().zip(&done.loads) {
        let stop = done.stops.iter().copied().find(|&stop| stop > load).unwrap_or(u64::MAX);
        // A block is known one period after its end.
        let ends: Vec<(usize, u64)> = (1..stream.len())
            .filter(|&at| stream[at].end_ticks != stream[at - 1].end_ticks)
            .map(|at| (at - 1, stream[at].end_ticks))
            .collect();
        for pair in ends.windows(2) {
            let [(first, begin), (last, end)] = [pair[0], pair[1]];
            if last - first != PERIODS || end < begin {
                continue;
            }
            for number in first + 1..=last {
                let part = (number - first) as u64 * (end - begin) / PERIODS as u64;
                let clock = load + (begin + part) * TICK;
                if clock >= stop {
                    break;
                }
                while done.pulses.get(at).is_some_and(|pulse| pulse.0 <= clock) {
                    let (_, axis, step) = done.pulses[at];
                    if axis < JOINTS {
                        places[axis] += step;
                    }
                    at += 1;
                }
                for joint in 0..JOINTS {
                    let off = stream[number].steps[joint] - f64::from(places[joint]);
                    worst[joint] = worst[joint].max(off.abs());
                }
                compared += 1;
            }
        }
    }
    (worst, compared)
}

/// What came of a run.
enum Outcome {
    Good(String),
    /// The computer was later than the horizon, or samples were lost.
    Void(String),
}

fn number(json: &str, key: &str) -> f64 {
    let (_, rest) =
        json.split_once(&format!("\"{key}\":")).unwrap_or_else(|| panic!("{key}: {json}"));
    let end = rest.find([',', '\n', '}']).unwrap();
    rest[..end].trim().parse().unwrap()
}

fn attempt(folder: &Path, programs: &[String]) -> Outcome {
    let end = Arc::new(AtomicBool::new(false));
    let (port, thread) = board(Arc::clone(&end));
    fs::set_permissions(&port, Permissions::from_mode(0o666)).unwrap();
    let run = tempfile::tempdir_in(folder).unwrap();
    let own = run.path();
    fs::set_permissions(own, Permissions::from_mode(0o777)).unwrap();
    for (name, text) in configuration(&port).files() {
        fs::write(own.join(name), text).unwrap();
    }
    fs::write(own.join("sampler.hal"), SAMPLER).unwrap();
    fs::write(own.join("ui.py"), include_str!("bench/ui.py")).unwrap();
    fs::set_permissions(own.join("ui.py"), Permissions::from_mode(0o755)).unwrap();
    // LinuxCNC refuses root.
    let nobody = ["--reuid=65534", "--regid=65534", "--clear-groups", "linuxcnc", "-r"];
    let raised = raise_real_time(Arc::clone(&end));
    let output = Command::new("timeout")
        .args(["-k", "20", "900", "setpriv"])
        .args(nobody)
        .arg("virtual.ini")
        .current_dir(own)
        .env("HOME", own)
        .env("RTAPI_UID", "65534")
        .env("RTAPI_FIFO_PATH", own.join("fifo"))
        .env("PROGRAMS", programs.join(":"))
        .output()
        .unwrap();
    end.store(true, Ordering::Relaxed);
    raised.join().unwrap();
    let done = thread.join().unwrap();
    let said = String::from_utf8_lossy(&output.stdout) + String::from_utf8_lossy(&output.stderr);
    let result = fs::read_to_string(own.join("result.json")).unwrap_or_else(|_| panic!("{said}"));
    let reserve = number(&result, "reserve_min_ms");
    // The component names what a computer that is too late causes.
    if ["fault 3:", "fault 7:", "fault 23:", "fault 26:"].iter().any(|late| said.contains(late)) {
        return Outcome::Void(format!(
            "later than the horizon, least reserve {reserve} ms, longest pause of the board {:?}: {result}",
            done.pause
        ));
    }
    assert!(result.contains("\"whole\": true"), "{result}\n{said}");
    assert!(result.contains("\"errors\": []"), "{result}\n{said}");
    let text = fs::read_to_string(own.join("samples.txt")).unwrap();
    let Some(samples) = samples(&text) else {
        return Outcome::Void("halsampler lost samples".to_owned());
    };
    let (worst, compared) = compare(&samples, &done);
    assert!(worst.iter().all(|&worst| worst <= BOUND), "{worst:?} of {compared} periods");
    // Exact at the end, and position-fb is the place of the board.
    let last = samples.last().unwrap();
    for joint in 0..JOINTS {
        let wanted = last.steps[joint].round();
        assert_eq!(f64::from(done.positions[joint]), wanted, "joint {joint}\n{result}");
    }
    Outcome::Good(format!(
        "{} programs, {compared} servo periods, {} pulses; pulses within {:.2}, {:.2}, {:.2} steps \
         of motor-pos-cmd, end exact; least reserve {reserve:.1} of {HORIZON_MS} ms",
        programs.len(),
        done.pulses.len(),
        worst[0],
        worst[1],
        worst[2]
    ))
}

#[test]
fn the_real_linuxcnc_drives_a_virtual_board() {
    let Ok(asked) = std::env::var("CARRYSTEP_LINUXCNC") else {
        return;
    };
    let own = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../sim/jobs/square_and_arc.ngc");
    let folder = tempfile::tempdir().unwrap();
    fs::set_permissions(folder.path(), Permissions::from_mode(0o755)).unwrap();
    // Where the user nobody can read it.
    let square = folder.path().join("square_and_arc.ngc");
    fs::copy(own, &square).unwrap();
    let others = asked.split(':').filter(|name| !name.is_empty() && *name != "square_and_arc");
    let programs: Vec<String> = std::iter::once(square.display().to_string())
        .chain(others.map(|name| format!("/usr/share/linuxcnc/ncfiles/{name}.ngc")))
        .collect();
    let _module = Module::build(folder.path());
    for _ in 0..3 {
        match attempt(folder.path(), &programs) {
            Outcome::Good(figures) => {
                eprintln!("FIGURES {figures}");
                return;
            }
            Outcome::Void(why) => eprintln!("void: {why}"),
        }
    }
    panic!("three runs were void");
}
