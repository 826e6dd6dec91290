//! A computer with the component, and a board, in simulated time.

use super::line::WINDOW;
pub use super::line::{Line, SCK_HZ};
use super::{Bench, Running};
use carrystep_core::link::Uart;
use carrystep_core::{AXES, Build, EngineBuild, PinTiming, StartPhase, Timebase};
use carrystep_virtual_board::{ModelBoard, SimulatedBoard, Switches};
use std::fmt::Write as _;

pub const CLOCK_HZ: u64 = 48_000_000;
/// Cycles per millisecond.
pub const MS: u64 = CLOCK_HZ / 1000;
pub const JOINTS: usize = 3;
/// Cycles between two looks at inputs that depend on the position: 10 us.
pub const SLICE: u64 = MS / 100;
/// Steps per unit.
pub const SCALE: f64 = 100.0;
/// Period of the servo thread, ns.
pub const PERIOD: i64 = 1_000_000;
/// Deceleration of a stop by ramps, 2^-64 step per tick^2.
pub const STOP: u64 = 1 << 45;

/// Numbers of the faults in carrystep_servo.h.
pub mod fault {
    pub const NO_PORT: u32 = 1;
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
    pub const PROTOCOL: u32 = 22;
    pub const UNDERRUN: u32 = 26;
    pub const STOP: u32 = 27;
}

/// What the real-time function says in a period.
#[derive(Debug, Clone, Copy, Default)]
pub struct Says {
    pub fault: u32,
    pub running: bool,
    pub disabled: bool,
    pub culprits: u32,
    pub lead_ns: i64,
    pub reserve_ns: i64,
    /// Joints that wait for an index pulse, and the register INPUTS as it is shown.
    pub index: u32,
    pub inputs: u32,
    pub feedback: [f64; JOINTS],
}

/// A computer with the component, and a board.
pub struct World<B = ModelBoard> {
    pub bench: Running,
    pub board: B,
    pub(super) line: Line,
    /// us
    pub now: u64,
    /// Whether the cable is in.
    pub cable: bool,
    /// Whether the computer has its spidev.
    pub device: bool,
    pub says: Says,
    pub command: [f64; JOINTS],
    pub period: i64,
    /// The inputs of the board, from the number of the cycle and the position of axis 0.
    pub inputs: Option<fn(u64, i32) -> Switches>,
}

pub fn build() -> EngineBuild {
    let timebase = Timebase::new(CLOCK_HZ, 2000, 16).unwrap();
    let build = Build { timebase, phase: StartPhase::Half, pins: [PinTiming::SHORTEST; AXES] };
    let mut build = EngineBuild::minimal(&build, STOP);
    build.guard.round = 1024;
    build.guard.watchdog = 49;
    build.queue = 31;
    build
}

impl World {
    pub fn new(line: Line, periods: u32, id: u64) -> Self {
        Self::on(line, periods, id, &build(), "0 0 255 255")
    }

    /// A world with this board at a UART; `has` are its outputs, its PWM, and the latches of probe
    /// and index.
    pub fn with(periods: u32, id: u64, build: &EngineBuild, has: &str) -> Self {
        Self::on(Line::Uart, periods, id, build, has)
    }

    fn on(line: Line, periods: u32, id: u64, build: &EngineBuild, has: &str) -> Self {
        // A segment of each joint in each period is more than 921 600 baud carry.
        let baud = if periods == 1 { 3_000_000 } else { 921_600 };
        let board = match line {
            Line::Uart => ModelBoard::new(build, Uart::new(CLOCK_HZ, baud).unwrap()),
            Line::Spi => ModelBoard::on_spi(build, SCK_HZ),
        };
        Self::of(board, line, periods, id, has)
    }

    /// A world whose board is ready.
    pub fn ready(line: Line, periods: u32) -> Self {
        Self::new(line, periods, 0).made_ready()
    }
}

impl<B: SimulatedBoard> World<B> {
    /// A world with this board, which is at such a line; the rest as in [`World::with`].
    pub fn of(board: B, line: Line, periods: u32, id: u64, has: &str) -> Self {
        let mut bench = Bench::component().run("");
        let window = if line == Line::Spi { WINDOW } else { 0 };
        if line == Line::Spi {
            // An SPI of mode 0 with 8 bits, and so many unacknowledged writes.
            let said = bench.say(&format!("prepare {SCK_HZ}"));
            assert_eq!(said, format!("1 1 0 8 {SCK_HZ} {WINDOW}"));
        }
        assert_eq!(bench.say(&format!("has {has} {window}")), "ok");
        let most = 300.0;
        assert_eq!(
            bench.say(&format!("begin {JOINTS} {periods} 40000 {id:x} {SCALE} {most}")),
            "ok"
        );
        Self {
            bench,
            board,
            line,
            now: 0,
            cable: true,
            device: true,
            says: Says::default(),
            command: [0.0; JOINTS],
            period: PERIOD,
            inputs: None,
        }
    }

    pub fn made_ready(mut self) -> Self {
        self.until(1000, |world| !world.servo(false).disabled);
        self
    }

    /// A millisecond of the thread and of the board.
    pub fn pass(&mut self) {
        // The transfers of an SPI take time of this millisecond.
        let end = self.now / 1000 * 1000 + 1000;
        while self.now < end {
            self.now = (self.now + 250).min(end);
            match self.line {
                Line::Uart => self.serial(),
                Line::Spi => self.transfers(),
            }
            self.reach(self.now * MS / 1000);
        }
    }

    /// Runs the board up to a cycle.
    pub(super) fn reach(&mut self, end: u64) {
        while self.board.cycle() < end {
            let mut next = end;
            if let Some(inputs) = self.inputs {
                next = end.min(self.board.cycle() + SLICE);
                self.board.press(inputs(self.board.cycle(), self.board.position(0)));
            }
            self.board.run(next, &mut ()).unwrap();
        }
    }

    /// A servo period with the command of `self.command`, without passing time.
    pub fn servo(&mut self, enable: bool) -> Says {
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
            index: said[6].parse().unwrap(),
            inputs: said[7].parse().unwrap(),
            feedback: [8, 9, 10].map(|at| said[at].parse().unwrap()),
        };
        self.says
    }

    pub fn until(&mut self, most_ms: u32, mut done: impl FnMut(&mut Self) -> bool) {
        for _ in 0..most_ms {
            self.pass();
            if done(self) {
                return;
            }
        }
        panic!("not within {most_ms} ms: {:?}", self.says);
    }

    /// As LinuxCNC does while the machine is off: the command follows the feedback.
    pub fn off(&mut self, ms: u32) {
        for _ in 0..ms {
            self.command = self.says.feedback;
            self.servo(false);
            self.pass();
        }
    }

    /// Enabled for `ms` periods, in which `place` gives the commands. The feedback must equal the
    /// command to 10^-6 units.
    pub fn follow(&mut self, ms: u32, mut place: impl FnMut(f64) -> [f64; JOINTS]) {
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
    pub fn fails(&mut self, wanted: u32, most_ms: u32) {
        self.until(most_ms, |world| world.servo(true).fault != 0);
        assert_eq!((self.says.fault, self.says.running), (wanted, false));
        assert!(self.says.disabled);
    }

    /// After a fault: the joints are disabled, the board comes to rest, the feedback is where it
    /// is, and a move is possible again.
    pub fn recovers(&mut self) {
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

    pub fn rest(&mut self) {
        let command = self.command;
        self.follow(100, |_| command);
    }

    pub fn positions_are_those_of_the_board(&self) {
        for joint in 0..JOINTS {
            let place = self.says.feedback[joint] * SCALE;
            let pulses = f64::from(self.board.position(joint));
            assert!((place - pulses).abs() < 1e-6, "joint {joint}: {place}, {pulses} pulses");
        }
    }
}

/// A smooth move of 2.5 units that takes 0.1 s.
pub fn wave(time: f64) -> f64 {
    let u = time / 0.1;
    2.5 * u * u * (3.0 - 2.0 * u)
}

/// A move of joint 0 that takes long, for faults in its middle: 25 units/s.
pub fn long(time: f64) -> [f64; JOINTS] {
    let ramp = time.min(0.1);
    [125.0 * ramp * ramp + 25.0 * (time - ramp), 0.0, 0.0]
}
