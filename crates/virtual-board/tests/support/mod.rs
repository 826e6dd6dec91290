//! A host and a board with a line between them that may be bad; time is the board's.
#![allow(dead_code, reason = "each test uses a part")]

pub mod bus;
#[path = "../../../link/tests/support/mod.rs"]
pub mod link;
pub mod words;

pub use link::{random, wire};

use carrystep_core::engine::Limits;
use carrystep_core::link::{BuildId, END, Uart};
use carrystep_core::{AXES, Build, EngineBuild, PinTiming, StartPhase, Timebase};
use carrystep_link::{Clock, Command, Exchanged, Host, HostError, Line, Patience, Segment};
use carrystep_model::fast::{Change, Edge};
use carrystep_virtual_board::{Board, Edges, Gateware, VerilatedBoard};
use random::Random;
use std::cell::RefCell;
use std::collections::VecDeque;
use std::rc::Rc;
use wire::{Faults, Wire};

pub const CLOCK_HZ: u64 = 48_000_000;
pub const TICK_NS: u64 = 2000;
/// Cycles of a millisecond, and of a tick.
pub const MS: u64 = CLOCK_HZ / 1000;
pub const TICK: u64 = CLOCK_HZ * TICK_NS / 1_000_000_000;
/// Of every axis but one: it takes 8192 ticks, 16 ms, from the greatest speed of [`waves`] to rest.
pub const STOP: u64 = 1 << 45;
/// The greatest speed of [`waves`].
pub const FASTEST: i64 = 1 << 58;

pub type BoardHost<B> = Host<End<B>, End<B>>;

/// A kind of board that is to do the same as every other.
pub trait Kind: Gateware + Sized {
    fn new(uart: Uart) -> Self;

    /// On an SPI of this rate, Hz.
    fn on_spi(sck_hz: u64) -> Self;

    /// Segments that wait for the axis in the middle of a move that has fewest, where that can be told.
    fn least_waiting(&self) -> Option<usize>;

    /// To this cycle.
    fn reach(&mut self, end: u64, to: &mut impl Edges) {
        while self.cycle() < end {
            self.run(end, to).unwrap();
        }
    }
}

impl Kind for Board {
    fn new(uart: Uart) -> Self {
        Self::new(&build(), uart)
    }

    fn on_spi(sck_hz: u64) -> Self {
        Self::on_spi(&build(), sck_hz)
    }

    fn least_waiting(&self) -> Option<usize> {
        let core = self.engine().core();
        (0..AXES).filter(|axis| core.in_a_move() >> axis & 1 == 1).map(|axis| core.waiting(axis)).min()
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

/// Six axes with a watchdog of about 100 ms and limits; axis 1 stops as fast as that of docs/protocol.md.
pub fn build() -> EngineBuild {
    let timebase = Timebase::new(CLOCK_HZ, TICK_NS, 16).unwrap();
    let build = Build { timebase, phase: StartPhase::Half, pins: [PinTiming::SHORTEST; AXES] };
    let mut build = EngineBuild::minimal(&build, STOP);
    build.guard.round = 1024;
    build.guard.watchdog = 49;
    build.guard.limits = Limits::Pair;
    build.guard.stop[1] = 1 << 54;
    build
}

/// How much a longer run asks for in its environment; else so much.
pub fn asked(name: &str, usual: u64) -> u64 {
    std::env::var(name).map_or(usual, |text| text.parse().expect(name))
}

/// Edges, and the sum of them all.
#[derive(Default)]
pub struct Seen {
    edges: Vec<Edge>,
    travelled: [i32; AXES],
}

impl Seen {
    /// Edges from this cycle on, their clocks counted from there.
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
    edges: Seen,
    there: Wire,
    back: Wire,
    inbox: VecDeque<u8>,
    /// Bytes that the line carries in a millisecond.
    bytes: usize,
    /// The host dies in this cycle: from then on nothing goes out.
    pub dies: u64,
    /// End of the last millisecond in which the board has heard a byte; a line may say some after its host's death.
    pub heard: u64,
    /// The fewest segments that have waited for an axis in the middle of its move, looked at each millisecond until all of
    /// it is handed over.
    pub least_waiting: usize,
    pub handed_over: bool,
    /// Answers and what else has come, in bytes.
    pub came: u64,
    /// Called each millisecond.
    pub meanwhile: Box<dyn FnMut(&mut B)>,
}

impl<B: Kind> World<B> {
    fn milliseconds(&self) -> u32 {
        (self.board.cycle() / MS) as u32
    }

    /// A millisecond.
    fn pass(&mut self) {
        for byte in self.there.receive(self.milliseconds()) {
            self.board.say(byte);
        }
        let hears = self.board.unsaid() > 0;
        self.board.reach(self.board.cycle() + MS, &mut self.edges);
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

    /// Everything that a line has kept goes nowhere; a host that comes later has a line of its own.
    pub fn revive(&mut self, faults: Faults, seed: u64) {
        (self.there, self.back) = (Wire::new(faults, seed), Wire::new(faults, !seed));
        self.inbox.clear();
        self.dies = u64::MAX;
    }

    /// Edges from this cycle on, their clocks counted from there.
    pub fn edges_since(&self, cycle: u64) -> Vec<Edge> {
        self.edges.since(cycle)
    }

    /// The last edge.
    pub fn last_edge(&self) -> Option<Edge> {
        self.edges.edges.last().copied()
    }

    /// Pulses forward less pulses back of each axis: what the pins have done.
    pub fn travelled(&self, axis: u8) -> i32 {
        self.edges.travelled[usize::from(axis)]
    }

    /// Bytes and pieces that the line has harmed.
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
        Self(Rc::new(RefCell::new(World {
            board: B::new(uart),
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

    /// A host, which refuses any board but this.
    pub fn connect(&self, uart: Uart) -> BoardHost<B> {
        self.connect_to(uart.build_id(&build()), Patience::default()).unwrap()
    }

    /// A host, which refuses any board but this one.
    pub fn connect_to(&self, id: BuildId, patience: Patience) -> Result<BoardHost<B>, HostError<Died>> {
        Host::connect(self.clone(), self.clone(), Some(id.0), patience)
    }

    /// Time passes without a host.
    pub fn wait(&self, milliseconds: u64) {
        (0..milliseconds).for_each(|_| self.0.borrow_mut().pass());
    }
}

impl<B: Kind> Clock for End<B> {
    fn milliseconds(&mut self) -> u32 {
        self.0.borrow().milliseconds()
    }
}

/// The host is no more.
#[derive(Debug, PartialEq, Eq)]
pub struct Died;

impl<B: Kind> Line for End<B> {
    type Error = Died;

    /// A millisecond, as long as a frame of USB.
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
        world.pass();
        let received = world.inbox.len().min(into.len());
        into.iter_mut().zip(world.inbox.drain(..received)).for_each(|(place, byte)| *place = byte);
        Ok(Exchanged { sent, received })
    }
}

/// A move of six axes, so many segments each, each of so many ticks: speeds that swing about, never over [`FASTEST`], each
/// segment beginning where the one before ends; from rest to about rest.
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

/// A frame without its escapes.
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
