//! The component without HAL and port against the models of engine and link, in simulated time: the
//! pulses follow the commands, position-fb has no part of the queue's delay, and whatever is wrong
//! is a named fault with all joints disabled and a true position.
#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches unit tests only")]

mod support;

use carrystep_core::link::Uart;
use carrystep_core::{AXES, Build, EngineBuild, PinTiming, StartPhase, Timebase};
use carrystep_virtual_board::{ModelBoard, SimulatedBoard, Switches};
use std::fmt::Write as _;
use support::{Bench, Running};

const CLOCK_HZ: u64 = 48_000_000;
/// Cycles per millisecond.
const MS: u64 = CLOCK_HZ / 1000;
const JOINTS: usize = 3;
/// Steps per unit.
const SCALE: f64 = 100.0;
/// Period of the servo thread, ns.
const PERIOD: i64 = 1_000_000;
/// Deceleration of a stop by ramps, 2^-64 step per tick^2.
const STOP: u64 = 1 << 45;

/// Numbers of the faults in carrystep_servo.h.
mod fault {
    pub const NO_ANSWER: u32 = 3;
    pub const OTHER_BOARD: u32 = 4;
    pub const SESSION: u32 = 5;
    pub const NOT_READY: u32 = 6;
    pub const NOT_A_NUMBER: u32 = 9;
    pub const OUT_OF_RANGE: u32 = 10;
    pub const JUMP: u32 = 11;
    pub const PERIOD: u32 = 13;
    pub const SCALE: u32 = 14;
    pub const ESTOP: u32 = 20;
    pub const UNDERRUN: u32 = 26;
    pub const STOP: u32 = 27;
}

/// What the real-time function says in a period.
#[derive(Debug, Clone, Copy, Default)]
struct Says {
    fault: u32,
    running: bool,
    disabled: bool,
    culprits: u32,
    lead_ns: i64,
    reserve_ns: i64,
    feedback: [f64; JOINTS],
}

/// A computer with the component, and a board.
struct World {
    bench: Running,
    board: ModelBoard,
    now: u64,
    /// Whether the cable is in.
    cable: bool,
    says: Says,
    command: [f64; JOINTS],
    period: i64,
}

fn build() -> EngineBuild {
    let timebase = Timebase::new(CLOCK_HZ, 2000, 16).unwrap();
    let build = Build { timebase, phase: StartPhase::Half, pins: [PinTiming::SHORTEST; AXES] };
    let mut build = EngineBuild::minimal(&build, STOP);
    build.guard.round = 1024;
    build.guard.watchdog = 49;
    build.queue = 31;
    build
}

impl World {
    fn new(periods: u32, id: u64) -> Self {
        let mut bench = Bench::component().run("");
        let most = 300.0;
        assert_eq!(
            bench.say(&format!("begin {JOINTS} {periods} 40000 {id:x} {SCALE} {most}")),
            "ok"
        );
        // A segment of each joint in each period is more than 921 600 baud carry.
        let baud = if periods == 1 { 3_000_000 } else { 921_600 };
        let board = ModelBoard::new(&build(), Uart::new(CLOCK_HZ, baud).unwrap());
        let (says, command) = (Says::default(), [0.0; JOINTS]);
        Self { bench, board, now: 0, cable: true, says, command, period: PERIOD }
    }

    /// A world whose board is ready.
    fn ready(periods: u32) -> Self {
        let mut world = Self::new(periods, 0);
        world.until(1000, |world| !world.servo(false).disabled);
        world
    }

    /// A millisecond of the thread and of the board.
    fn pass(&mut self) {
        for _ in 0..4 {
            self.now += 250;
            let mut hex = String::new();
            while let Some(byte) = self.board.next_byte() {
                if self.cable {
                    write!(hex, "{byte:02x}").unwrap();
                }
            }
            let sent = self.bench.say(&format!("line {} {hex}-", self.now));
            let sent = sent.trim_end_matches('-').as_bytes();
            for pair in sent.chunks(2).filter(|_| self.cable) {
                let text = std::str::from_utf8(pair).unwrap();
                self.board.say(u8::from_str_radix(text, 16).unwrap());
            }
            let end = self.now * MS / 1000;
            while self.board.cycle() < end {
                self.board.run(end, &mut ());
            }
        }
    }

    /// A servo period with the command of `self.command`, without passing time.
    fn servo(&mut self, enable: bool) -> Says {
        let mut words = format!("servo {} {}", self.period, u8::from(enable));
        for command in self.command {
            write!(words, " {command:?}").unwrap();
        }
        let said = self.bench.say(&words);
        let said: Vec<&str> = said.split(' ').collect();
        self.says = Says {
            fault: said[0].parse().unwrap(),
            running: said[1] == "1",
            disabled: said[2] == "1",
            culprits: said[3].parse().unwrap(),
            lead_ns: said[4].parse().unwrap(),
            reserve_ns: said[5].parse().unwrap(),
            feedback: [6, 7, 8].map(|at| said[at].parse().unwrap()),
        };
        self.says
    }

    fn until(&mut self, most_ms: u32, mut done: impl FnMut(&mut Self) -> bool) {
        for _ in 0..most_ms {
            self.pass();
            if done(self) {
                return;
            }
        }
        panic!("not within {most_ms} ms: {:?}", self.says);
    }

    /// As LinuxCNC does while the machine is off: the command follows the feedback.
    fn off(&mut self, ms: u32) {
        for _ in 0..ms {
            self.command = self.says.feedback;
            self.servo(false);
            self.pass();
        }
    }

    /// Enabled for `ms` periods, in which `place` gives the commands. The feedback must equal the
    /// command to 10^-6 units.
    fn follow(&mut self, ms: u32, mut place: impl FnMut(f64) -> [f64; JOINTS]) {
        for period in 1..=ms {
            self.command = place(f64::from(period) / 1000.0);
            let says = self.servo(true);
            assert_eq!((says.fault, says.running), (0, true), "in period {period}");
            for joint in 0..JOINTS {
                let late = says.feedback[joint] - self.command[joint];
                assert!(late.abs() < 1e-6, "joint {joint} is {late} off in period {period}");
            }
            self.pass();
        }
    }

    /// Enabled until this fault.
    fn fails(&mut self, wanted: u32, most_ms: u32) {
        self.until(most_ms, |world| world.servo(true).fault != 0);
        assert_eq!((self.says.fault, self.says.running), (wanted, false));
        assert!(self.says.disabled);
    }

    /// After a fault: the joints are disabled, the board comes to rest, the feedback is where it
    /// is, and a move is possible again.
    fn recovers(&mut self) {
        self.until(1500, |world| {
            world.command = world.says.feedback;
            !world.servo(false).disabled
        });
        assert_eq!(self.says.fault, 0);
        self.off(50);
        self.positions_are_those_of_the_board();
        let from = self.command;
        self.follow(300, |time| from.map(|from| from + wave(time.min(0.1))));
        self.rest();
        let steps = (from[0] * SCALE).round() as i32 + 250;
        assert_eq!(self.board.position(0), steps);
    }

    fn rest(&mut self) {
        let command = self.command;
        self.follow(100, |_| command);
    }

    fn positions_are_those_of_the_board(&self) {
        for joint in 0..JOINTS {
            let place = self.says.feedback[joint] * SCALE;
            let pulses = f64::from(self.board.position(joint));
            assert!((place - pulses).abs() < 1e-6, "joint {joint}: {place}, {pulses} pulses");
        }
    }
}

/// A smooth move of 2.5 units that takes 0.1 s.
fn wave(time: f64) -> f64 {
    let u = time / 0.1;
    2.5 * u * u * (3.0 - 2.0 * u)
}

/// A move of joint 0 that takes long, for faults in its middle: 25 units/s.
fn long(time: f64) -> [f64; JOINTS] {
    let ramp = time.min(0.1);
    [125.0 * ramp * ramp + 25.0 * (time - ramp), 0.0, 0.0]
}

#[test]
fn pulses_follow_the_commands_and_feedback_is_not_late() {
    for periods in [1, 4, 8] {
        let mut world = World::ready(periods);
        let mut least = i64::MAX;
        for (number, turns) in [(0, 1.0), (1, 3.0)] {
            let from = world.command;
            world.follow(1000, |time| {
                let angle = std::f64::consts::TAU * turns * (10.0 * wave(time / 10.0) / 25.0);
                let way = 10.0 * wave(time / 10.0) * 1.234_56;
                [from[0] + way, from[1] + 3.0 * angle.sin(), from[2] - way / 7.0]
            });
            world.rest();
            assert!(world.says.reserve_ns <= world.says.lead_ns);
            least = least.min(world.says.reserve_ns);
            for joint in 0..JOINTS {
                let wanted = (world.command[joint] * SCALE + 0.5).floor() as i32;
                assert_eq!(world.board.position(joint), wanted, "joint {joint}, move {number}");
            }
            // Switched off and on again: nothing moves.
            let before: Vec<i32> = (0..JOINTS).map(|joint| world.board.position(joint)).collect();
            world.off(60);
            let after: Vec<i32> = (0..JOINTS).map(|joint| world.board.position(joint)).collect();
            assert_eq!(before, after);
            assert_eq!((world.says.fault, world.says.disabled), (0, false));
            world.positions_are_those_of_the_board();
        }
        assert!((25_000_000..60_000_000).contains(&least), "{least} ns");
        assert_eq!((world.board.discarded(0), world.board.fault()), (Some(0), None));
        world.bench.end();
    }
}

#[test]
fn switching_off_in_motion_ramps_down_and_position_stays_true() {
    let mut world = World::ready(4);
    world.follow(300, long);
    world.servo(false);
    // The ramps take their time: until then the joints cannot be enabled.
    world.fails(fault::NOT_READY, 2);
    world.recovers();
    world.bench.end();
}

#[test]
fn bad_commands_are_faults_by_name() {
    for (command, wanted) in [
        (f64::NAN, fault::NOT_A_NUMBER),
        (f64::INFINITY, fault::NOT_A_NUMBER),
        (1e200, fault::OUT_OF_RANGE),
        (30.0, fault::JUMP),
    ] {
        let mut world = World::ready(4);
        world.follow(300, long);
        world.command[0] = command;
        world.fails(wanted, 1);
        assert_eq!(world.says.culprits, 1, "{:?}", world.says);
        world.recovers();
        world.bench.end();
    }
}

#[test]
fn period_or_scale_that_changes_is_a_fault() {
    for wanted in [fault::PERIOD, fault::SCALE] {
        let mut world = World::ready(4);
        world.follow(300, long);
        if wanted == fault::PERIOD {
            world.period = 1_100_000;
        } else {
            world.bench.say("scale");
        }
        world.fails(wanted, 1);
        world.period = PERIOD;
        world.until(1500, |world| {
            world.command = world.says.feedback;
            !world.servo(false).disabled
        });
        world.bench.end();
    }
}

#[test]
fn servo_thread_that_is_late_by_less_than_the_horizon_changes_nothing() {
    let mut world = World::ready(4);
    world.follow(300, long);
    // 25 ms without a period, which the thread then makes up for at once.
    (0..25).for_each(|_| world.pass());
    for late in 1..=25 {
        world.command = long(0.3 + f64::from(late) / 1000.0);
        assert_eq!(world.servo(true).fault, 0);
    }
    let from = world.command;
    world.follow(400, |time| [from[0] + 24.98 * time.min(0.2), 0.0, 0.0]);
    world.rest();
    let wanted = (world.command[0] * SCALE + 0.5).floor() as i32;
    assert_eq!((world.board.position(0), world.board.stops().len()), (wanted, 1));
    world.bench.end();
}

#[test]
fn servo_thread_that_is_later_is_an_underrun() {
    let mut world = World::ready(4);
    world.follow(300, long);
    (0..80).for_each(|_| world.pass());
    world.command = long(0.301);
    world.fails(fault::UNDERRUN, 1);
    world.recovers();
    world.bench.end();
}

#[test]
fn stops_of_the_board_disable_the_joints_until_they_are_over() {
    let mut world = World::ready(4);
    world.follow(300, long);
    world.board.press(Switches { estop: true, ..Switches::default() });
    world.fails(fault::ESTOP, 20);
    for _ in 0..100 {
        world.command = world.says.feedback;
        world.servo(false);
        world.pass();
        assert!(world.says.disabled, "the e-stop is still pressed");
    }
    world.board.press(Switches::default());
    world.recovers();
    // Also at rest.
    world.off(10);
    world.board.press(Switches { estop: true, ..Switches::default() });
    world.until(100, |world| world.servo(false).fault == fault::ESTOP);
    world.board.press(Switches::default());
    world.recovers();
    // A stop by another program, which needs no session.
    let from = world.command;
    world.follow(200, |time| from.map(|from| from + time));
    for byte in stop_frame() {
        world.board.say(byte);
    }
    let command = world.command;
    world.follow_until_fault(command, fault::STOP);
    world.recovers();
    world.bench.end();
}

impl World {
    fn follow_until_fault(&mut self, command: [f64; JOINTS], wanted: u32) {
        self.command = command;
        self.fails(wanted, 30);
    }
}

/// STOP of a host without a session (docs/protocol.md).
fn stop_frame() -> Vec<u8> {
    frame(&[0, 0xa6, 0, 0, 0, 0, 0, 0])
}

/// OPEN with force by another host.
fn open_frame() -> Vec<u8> {
    frame(&[0, 0xa5, 9, 9, 1, 0, 0, 0])
}

fn frame(content: &[u8]) -> Vec<u8> {
    let mut crc = u32::MAX;
    for &byte in content {
        crc ^= u32::from(byte);
        for _ in 0..8 {
            crc = crc >> 1 ^ if crc & 1 == 1 { 0xedb8_8320 } else { 0 };
        }
    }
    let mut line = vec![0xc0];
    for byte in content.iter().copied().chain((!crc).to_le_bytes()) {
        match byte {
            0xc0 => line.extend([0xdb, 0xdc]),
            0xdb => line.extend([0xdb, 0xdd]),
            byte => line.push(byte),
        }
    }
    line.push(0xc0);
    line
}

#[test]
fn cable_that_is_pulled_disables_the_joints() {
    let mut world = World::ready(4);
    world.follow(300, long);
    world.cable = false;
    // Nothing comes any more: the board stops by its watchdog or by an empty queue, and the
    // component says so when it has waited for an answer.
    world.fails(fault::NO_ANSWER, 550);
    world.off(100);
    assert!(world.board.rests());
    assert_eq!((world.says.fault, world.says.disabled), (fault::NO_ANSWER, true));
    // The cable is back.
    world.cable = true;
    assert_eq!(world.bench.say("again"), "ok");
    world.recovers();
    world.bench.end();
}

#[test]
fn another_program_that_takes_the_board_is_named() {
    let mut world = World::ready(4);
    world.off(20);
    for byte in open_frame() {
        world.board.say(byte);
    }
    world.until(200, |world| world.servo(false).fault != 0);
    assert_eq!(world.says.fault, fault::SESSION);
    world.bench.end();
}

#[test]
fn another_build_is_refused_before_anything_is_written() {
    let mut world = World::new(4, 0x1234);
    world.until(1000, |world| world.servo(false).fault == fault::OTHER_BOARD);
    assert_eq!(world.servo(true).fault, fault::OTHER_BOARD);
    assert!(world.says.disabled);
    assert_eq!(world.board.stops().len(), 0);
    world.bench.end();
}
