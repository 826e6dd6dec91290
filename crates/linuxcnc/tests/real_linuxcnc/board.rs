//! A virtual board in a thread of its own, in real time. Its inputs depend on the position of axis
//! 0: a home switch at a general input, and a probe, which is there while output 0 is on.

use crate::{CLOCK_HZ, JOINTS, PRIORITIES, machine, prefer};
use carrystep_core::engine::Cause;
use carrystep_core::link::LineKind;
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
}

/// A board in a thread of its own, until `end` is set.
pub fn board(end: Arc<AtomicBool>) -> (String, JoinHandle<Done>) {
    let terminal = Terminal::new().unwrap();
    let name = terminal.name().to_owned();
    let machine = machine();
    let LineKind::Uart(uart) = machine.line().unwrap() else { panic!("a UART") };
    let model = ModelBoard::new(&machine.engine(), uart);
    let mut board = RealTimeBoard::new(model, terminal, Pace::real(CLOCK_HZ), CLOCK_HZ);
    let thread = thread::spawn(move || {
        // Of this thread alone. Without the right to it, the board runs as it is.
        prefer(&[], PRIORITIES[0], &gettid().as_raw_nonzero().to_string());
        let (mut pulses, mut was) = (Pulses::default(), 0_u8);
        let (mut homes, mut probes) = (Vec::new(), Vec::new());
        let (mut round, mut pause) = (Instant::now(), Duration::ZERO);
        while !end.load(Ordering::Relaxed) {
            board.step(&mut pulses).unwrap();
            let position = board.board.position(0);
            let touches = position >= PROBE && board.board.outputs().outputs & 1 != 0;
            let inputs = u8::from(touches) | u8::from(position <= HOME) << 1;
            if inputs != was {
                board.board.press(Switches { inputs: [inputs, 0], ..Switches::default() });
                let rises = inputs & !was;
                probes.extend((rises & 1 != 0).then_some(position));
                homes.extend((rises & 2 != 0).then_some(position));
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
        }
    });
    (name, thread)
}
