//! A host and a board with a line between them that may be bad. Time is the board's.
#![allow(dead_code, reason = "each test uses a part")]

pub mod bus;
#[path = "../../../link/tests/support/mod.rs"]
pub mod link;
pub mod recorder;
pub mod requests;
pub mod words;

pub use link::{random, wire};

use carrystep_core::engine::LimitWiring;
use carrystep_core::link::{BuildId, END, Uart};
use carrystep_core::{AXES, Build, EngineBuild, PinTiming, StartPhase, Timebase};
use carrystep_link::{Clock, Command, Exchanged, Host, HostError, Line, Patience, Segment, Timing};
use carrystep_model::fast::{Change, Edge};
use carrystep_virtual_board::{Edges, ModelBoard, SimulatedBoard, VerilatedBoard};
use random::Random;
use recorder::Recorder;
use std::cell::RefCell;
use std::collections::VecDeque;
use std::num::NonZeroU16;
use std::rc::Rc;
use wire::{Faults, Wire};

pub const CLOCK_HZ: u64 = 48_000_000;
pub const TICK_NS: u64 = 2000;
/// Cycles per millisecond.
pub const MS: u64 = CLOCK_HZ / 1000;
/// Cycles per tick.
pub const TICK: u64 = CLOCK_HZ * TICK_NS / 1_000_000_000;
/// Stop acceleration of every axis but axis 1: a stop from [`FASTEST`] takes 8192 ticks, 16 ms.
pub const STOP: u64 = 1 << 45;
/// Greatest speed of [`waves`], 2^-64 step per tick.
pub const FASTEST: i64 = 1 << 58;

/// Number of the session of these hosts.
pub const SESSION: NonZeroU16 = NonZeroU16::new(0xdbc0).unwrap();

/// A host that gives up soon, on a line that is quick.
pub const QUICK: Patience = Patience {
    timing: Timing { resend: 12, pause: 2 },
    silence: 500,
    lost: 500,
    change: 100,
    status_period: 20,
};

pub type BoardHost<B> = Host<End<B>, End<B>>;

/// A kind of board; all kinds must behave the same.
pub trait Kind: SimulatedBoard + Sized {
    fn new(uart: Uart) -> Self;

    /// A board with an SPI of this rate, Hz.
    fn on_spi(sck_hz: u64) -> Self;

    /// Fewest queued segments of all axes that are in the middle of a move, if the board can report
    /// it.
    fn least_waiting(&self) -> Option<usize>;

    /// Runs up to this cycle.
    fn reach(&mut self, end: u64, to: &mut dyn Edges) {
        while self.cycle() < end {
            self.run(end, to).unwrap();
        }
    }
}

impl Kind for ModelBoard {
    fn new(uart: Uart) -> Self {
        Self::new(&build(), uart)
    }

    fn on_spi(sck_hz: u64) -> Self {
        Self::on_spi(&build(), sck_hz)
    }

    fn least_waiting(&self) -> Option<usize> {
        let core = self.engine().core();
        (0..AXES)
            .filter(|axis| core.in_a_move() >> axis & 1 == 1)
            .map(|axis| core.waiting(axis))
            .min()
    }
}

impl Kind for Recorder {
    fn new(uart: Uart) -> Self {
        Self::new(<ModelBoard as Kind>::new(uart))
    }

    fn on_spi(sck_hz: u64) -> Self {
        Self::new(<ModelBoard as Kind>::on_spi(sck_hz))
    }

    fn least_waiting(&self) -> Option<usize> {
        self.model().least_waiting()
    }
}

impl Kind for VerilatedBoard {
    fn new(uart: Uart) -> Self {
        Self::new(&build(), uart).unwrap()
    }

    fn on_spi(sck_hz: u64) -> Self {
        Self::on_spi(&build(), sck_hz).unwrap()
    }

    fn least_waiting(&self) -> Option<usize> {
        None
    }
}

/// A build of six axes with a watchdog of about 100 ms and limits. Axis 1 stops as fast as in
/// docs/protocol.md.
pub fn build() -> EngineBuild {
    let timebase = Timebase::new(CLOCK_HZ, TICK_NS, 16).unwrap();
    let build = Build { timebase, phase: StartPhase::Half, pins: [PinTiming::SHORTEST; AXES] };
    let mut build = EngineBuild::minimal(&build, STOP);
    build.guard.round = 1024;
    build.guard.watchdog = 49;
    build.guard.limits = LimitWiring::Pair;
    build.guard.stop[1] = 1 << 54;
    build.cuts = true;
    build
}

/// The value of an environment variable that requests a longer run, or the usual value.
pub fn asked(name: &str, usual: u64) -> u64 {
    std::env::var(name).map_or(usual, |text| text.parse().expect(name))
}

/// Collects edges and a checksum of them.
#[derive(Default)]
pub struct Seen {
    edges: Vec<Edge>,
    travelled: [i32; AXES],
}

impl Seen {
    /// The edges from this cycle on, with clocks counted from there.
    pub fn since(&self, cycle: u64) -> Vec<Edge> {
        let since = self.edges.iter().filter(|edge| edge.clock >= cycle);
        since.map(|edge| Edge { clock: edge.clock - cycle, ..*edge }).collect()
    }
}

impl Edges for Seen {
    fn edge(&mut self, edge: Edge) {
        if edge.change == Change::Rise {
            self.travelled[usize::from(edge.axis)] += if edge.backward { -1 } else { 1 };
        }
        self.edges.push(edge);
    }
}

pub struct World<B> {
    pub board: B,
    /// Clocks of a millisecond.
    ms: u64,
    /// Milliseconds of an exchange.
    turn: usize,
    edges: Seen,
    there: Wire,
    back: Wire,
    inbox: VecDeque<u8>,
    /// Number of bytes per millisecond that the line carries.
    bytes: usize,
    /// The cycle in which the host dies; nothing is sent from then on.
    pub dies: u64,
    /// End of the last millisecond in which the board received a byte. A line may deliver bytes
    /// after its host's death.
    pub heard: u64,
    /// Fewest queued segments of an axis in the middle of its move, sampled each millisecond until
    /// the whole program was sent.
    pub least_waiting: usize,
    pub handed_over: bool,
    /// Number of bytes received from the board.
    pub came: u64,
    /// Called each millisecond.
    pub meanwhile: Box<dyn FnMut(&mut B)>,
}

impl<B: Kind> World<B> {
    fn milliseconds(&self) -> u32 {
        (self.board.cycle() / self.ms) as u32
    }

    /// Advances by one millisecond.
    fn pass(&mut self) {
        for byte in self.there.receive(self.milliseconds()) {
            self.board.say(byte);
        }
        let hears = self.board.unsaid() > 0;
        self.board.reach(self.board.cycle() + self.ms, &mut self.edges);
        if hears {
            self.heard = self.board.cycle();
        }
        (self.meanwhile)(&mut self.board);
        let waiting = self.board.least_waiting().filter(|_| !self.handed_over);
        self.least_waiting = waiting.unwrap_or(usize::MAX).min(self.least_waiting);
        let mut piece = Vec::new();
        while let Some(byte) = self.board.next_byte() {
            self.came += 1;
            piece.push(byte);
            if byte == END {
                self.back.send(self.milliseconds(), &std::mem::take(&mut piece));
            }
        }
        self.back.send(self.milliseconds(), &piece);
        self.inbox.extend(self.back.receive(self.milliseconds()));
    }

    /// Discards everything that is still on the line, and replaces it by a new line for the next
    /// host.
    pub fn revive(&mut self, faults: Faults, seed: u64) {
        (self.there, self.back) = (Wire::new(faults, seed), Wire::new(faults, !seed));
        self.inbox.clear();
        self.dies = u64::MAX;
    }

    /// The edges from this cycle on, with clocks counted from there.
    pub fn edges_since(&self, cycle: u64) -> Vec<Edge> {
        self.edges.since(cycle)
    }

    /// The edges since the last call, which are not kept.
    pub fn take_edges(&mut self) -> Vec<Edge> {
        std::mem::take(&mut self.edges.edges)
    }

    /// The last edge.
    pub fn last_edge(&self) -> Option<Edge> {
        self.edges.edges.last().copied()
    }

    /// Pulses forward minus pulses backward of an axis, as counted at the pins.
    pub fn travelled(&self, axis: u8) -> i32 {
        self.edges.travelled[usize::from(axis)]
    }

    /// Number of bytes and pieces that the line has damaged.
    pub fn harmed(&self) -> u64 {
        self.there.harmed + self.back.harmed
    }
}

/// The host's end of the line, and its clock.
pub struct End<B>(pub Rc<RefCell<World<B>>>);

impl<B> Clone for End<B> {
    fn clone(&self) -> Self {
        Self(self.0.clone())
    }
}

impl<B: Kind> End<B> {
    pub fn new(uart: Uart, faults: Faults, seed: u64) -> Self {
        Self::of(B::new(uart), uart, faults, seed)
    }

    /// The end of the line to this board.
    pub fn of(board: B, uart: Uart, faults: Faults, seed: u64) -> Self {
        Self(Rc::new(RefCell::new(World {
            board,
            ms: MS,
            turn: 1,
            edges: Seen::default(),
            there: Wire::new(faults, seed),
            back: Wire::new(faults, !seed),
            inbox: VecDeque::new(),
            bytes: (uart.baud() / 10_000) as usize,
            dies: u64::MAX,
            heard: 0,
            least_waiting: usize::MAX,
            handed_over: false,
            came: 0,
            meanwhile: Box::new(|_| ()),
        })))
    }

    /// The same for a board with a clock of so many Hz, and exchanges of so many milliseconds.
    pub fn clocked(self, clock_hz: u64, turn: usize) -> Self {
        let world = &mut *self.0.borrow_mut();
        (world.ms, world.turn) = (clock_hz / 1000, turn);
        world.bytes *= turn;
        self.clone()
    }

    /// Connects a host that refuses any other build, and opens a session.
    pub fn connect(&self, uart: Uart) -> BoardHost<B> {
        let mut host = self.connect_to(uart.build_id(&build()), Patience::default()).unwrap();
        host.open(SESSION).unwrap();
        host
    }

    /// Connects a host that refuses any other build than `id`.
    pub fn connect_to(
        &self,
        id: BuildId,
        patience: Patience,
    ) -> Result<BoardHost<B>, HostError<Died>> {
        Host::connect(self.clone(), self.clone(), Some(id.0), patience)
    }

    /// Advances without a host.
    pub fn wait(&self, milliseconds: u64) {
        (0..milliseconds).for_each(|_| self.0.borrow_mut().pass());
    }
}

impl<B: Kind> Clock for End<B> {
    fn milliseconds(&mut self) -> u32 {
        self.0.borrow().milliseconds()
    }
}

/// The error of a host that has died.
#[derive(Debug, PartialEq, Eq)]
pub struct Died;

impl<B: Kind> Line for End<B> {
    type Error = Died;

    /// An exchange lasts one millisecond, like a frame of USB, or longer.
    fn exchange(&mut self, out: &[u8], into: &mut [u8]) -> Result<Exchanged, Died> {
        let world = &mut *self.0.borrow_mut();
        if world.board.cycle() >= world.dies {
            return Err(Died);
        }
        let sent = out.len().min(world.bytes.saturating_sub(world.board.unsaid()));
        let now = world.milliseconds();
        for piece in out[..sent].split_inclusive(|&byte| byte == END) {
            world.there.send(now, piece);
        }
        (0..world.turn).for_each(|_| world.pass());
        let received = world.inbox.len().min(into.len());
        into.iter_mut().zip(world.inbox.drain(..received)).for_each(|(place, byte)| *place = byte);
        Ok(Exchanged { sent, received })
    }
}

/// A move of six axes with `segments` segments of `ticks` ticks each. Speeds swing, but stay within
/// [`FASTEST`]. Each segment starts with the final speed of the one before; the move starts at rest
/// and ends nearly at rest.
pub fn waves(random: &mut Random, segments: u32, ticks: u32) -> Vec<Command> {
    let mut due = Vec::new();
    for axis in 0..AXES as u8 {
        let mut v = 0_i64;
        for k in 0..segments {
            let last = k + 1 == segments;
            let aim = if last { 0 } else { random.below(2 * FASTEST as u64) as i64 - FASTEST };
            let a = (aim - v) / i64::from(ticks);
            due.push((k, axis, Segment { ticks, v, a, j: 0, last }));
            v += a * i64::from(ticks);
        }
    }
    due.sort_by_key(|&(k, axis, _)| (k, axis));
    let of = |&(_, axis, segment): &(u32, u8, Segment)| Command::Segment { axis, segment };
    let (first, rest) = due.split_at(AXES);
    let start = Command::Start { mask: 0b11_1111 };
    first.iter().map(of).chain([start]).chain(rest.iter().map(of)).collect()
}

/// Removes the escapes of a frame.
pub fn unescaped(line: &[u8]) -> Vec<u8> {
    let mut bytes = line.iter();
    let mut frame = Vec::new();
    while let Some(&byte) = bytes.next() {
        frame.push(if byte != 0xdb {
            byte
        } else if bytes.next() == Some(&0xdc) {
            0xc0
        } else {
            0xdb
        });
    }
    frame
}
