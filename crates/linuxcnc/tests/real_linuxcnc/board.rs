//! A virtual board in a thread of its own, in real time. Its inputs depend on the position of axis
//! 0: a home switch at a general input, a probe, which is there while output 0 is on, and index
//! pulses. Or a board that is recorded.

use crate::recorder::{Recorder, Recording};
use crate::{JOINTS, PRIORITIES, prefer};
use carrystep_core::engine::{Cause, LatchSource};
use carrystep_core::link::{LineKind, Uart};
use carrystep_files::Machine;
use carrystep_model::fast::{Change, Edge};
use carrystep_virtual_board::{
    Edges, ModelBoard, Pace, RealTimeBoard, SimulatedBoard as _, Switches, Terminal,
};
use rustix::thread::gettid;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// The home switch is active at this position and below, steps.
pub const HOME: i32 = -1000;
/// The probe is closed at this position and above, steps.
pub const PROBE: i32 = 4000;

/// Index pulses begin at each of these positions and last for two steps: such a distance, and the
/// first one, steps.
const PULSES: (i32, i32) = (200, 100);

/// Rising edges: clock, axis, direction.
#[derive(Default)]
pub struct Pulses(pub Vec<(u64, usize, i32)>);

impl Edges for Pulses {
    fn edge(&mut self, edge: Edge) {
        if edge.change == Change::Rise {
            let step = if edge.backward { -1 } else { 1 };
            self.0.push((edge.clock, edge.axis.into(), step));
        }
    }
}

/// What a board did.
pub struct Done {
    pub pulses: Vec<(u64, usize, i32)>,
    pub loads: Vec<u64>,
    /// The cycle of each stop, and its cause.
    pub stops: Vec<(u64, Cause)>,
    /// The longest time between two rounds of the board's thread.
    pub pause: Duration,
    pub positions: [i32; JOINTS],
    /// The positions of axis 0 at which the home switch became active, and the probe.
    pub homes: Vec<i32>,
    pub probes: Vec<i32>,
    /// The position at which the first index pulse began after the home switch had become active
    /// for the last time.
    pub index: Option<i32>,
}

/// The line of a board.
pub fn uart(machine: &Machine) -> Uart {
    let LineKind::Uart(uart) = machine.line().unwrap() else { panic!("a UART") };
    uart
}

/// A board in a thread of its own, until `end` is set.
pub fn board(machine: &Machine, end: Arc<AtomicBool>) -> (String, JoinHandle<Done>) {
    let terminal = Terminal::new().unwrap();
    let name = terminal.name().to_owned();
    let clock_hz = machine.timebase.clock_hz();
    let model = ModelBoard::new(&machine.engine(), uart(machine));
    let mut board = RealTimeBoard::new(model, terminal, Pace::real(clock_hz), clock_hz);
    let mut latches = machine.guard.latches.iter();
    let own_pin = latches.position(|latch| latch.source == LatchSource::Pin);
    let own_pin = own_pin.map_or(0, |number| 1_u8 << number);
    let thread = thread::spawn(move || {
        // Of this thread alone. Without the right to it, the board runs as it is.
        prefer(&[], PRIORITIES[0], &gettid().as_raw_nonzero().to_string());
        let (mut pulses, mut was) = (Pulses::default(), 0_u8);
        let (mut homes, mut probes, mut index) = (Vec::new(), Vec::new(), None);
        let (mut round, mut pause) = (Instant::now(), Duration::ZERO);
        while !end.load(Ordering::Relaxed) {
            board.step(&mut pulses).unwrap();
            let position = board.board.position(0);
            let touches = position >= PROBE && board.board.outputs().outputs & 1 != 0;
            let pulse = own_pin != 0 && (position - PULSES.1).rem_euclid(PULSES.0) < 2;
            let inputs = u8::from(touches) | u8::from(position <= HOME) << 1 | u8::from(pulse) << 2;
            if inputs != was {
                let latch = if pulse { own_pin } else { 0 };
                let inputs_of_rows = [inputs & 3, 0];
                let switches = Switches { inputs: inputs_of_rows, latch, ..Switches::default() };
                board.board.press(switches);
                let rises = inputs & !was;
                probes.extend((rises & 1 != 0).then_some(position));
                if rises & 2 != 0 {
                    homes.push(position);
                    index = None;
                }
                if rises & 4 != 0 && !homes.is_empty() {
                    index.get_or_insert(position);
                }
                was = inputs;
            }
            pause = pause.max(round.elapsed());
            round = Instant::now();
        }
        let board = board.board;
        Done {
            pulses: pulses.0,
            loads: board.loads().to_vec(),
            stops: board.stops().to_vec(),
            pause,
            positions: [0, 1, 2].map(|axis| board.position(axis)),
            homes,
            probes,
            index,
        }
    });
    (name, thread)
}

/// A board in a thread of its own, until `end` is set, with what reaches it. It is configured when
/// the host has spoken for the first time, so that nothing is replayed in which nothing happens;
/// these first bytes are lost, and the host repeats them.
pub fn recorded(machine: &Machine, end: Arc<AtomicBool>) -> (String, JoinHandle<Recording>) {
    let mut terminal = Terminal::new().unwrap();
    let name = terminal.name().to_owned();
    let clock_hz = machine.timebase.clock_hz();
    let recorder = Recorder::new(ModelBoard::new(&machine.engine(), uart(machine)));
    let thread = thread::spawn(move || {
        prefer(&[], PRIORITIES[0], &gettid().as_raw_nonzero().to_string());
        while terminal.take().is_empty() && !end.load(Ordering::Relaxed) {
            thread::sleep(Duration::from_millis(1));
        }
        let mut board = RealTimeBoard::new(recorder, terminal, Pace::real(clock_hz), clock_hz);
        while !end.load(Ordering::Relaxed) {
            board.step(&mut ()).unwrap();
        }
        board.board.finish()
    });
    (name, thread)
}
