//! A board on an SPI bus with the embedded-hal interface. Time is the board's; a transfer takes one
//! microsecond more than its bits.

use super::wire::{Faults, Wire};
use super::{CLOCK_HZ, Kind, SESSION, Seen, build};
use carrystep_core::link::{BuildId, LineKind};
use carrystep_link::line::spi::SpiLine;
use carrystep_link::{Clock, Host, Patience, Timing};
use carrystep_model::fast::Edge;
use embedded_hal::spi::{ErrorType, Operation, SpiDevice};
use std::cell::RefCell;
use std::convert::Infallible;
use std::rc::Rc;

/// A host with at most six unacknowledged segments (docs/protocol.md).
pub type BusHost<B> = Host<SpiLine<Bus<B>>, Bus<B>, 6>;

/// The board, and the values that the tests check.
pub struct Wired<B> {
    pub board: B,
    edges: Seen,
    sck_hz: u64,
    /// The board's clock, Hz.
    clock_hz: u64,
    there: Wire,
    back: Wire,
    /// As in [`super::World`].
    pub least_waiting: usize,
    pub handed_over: bool,
}

impl<B> Wired<B> {
    /// The edges from this cycle on, with clocks counted from there.
    pub fn edges_since(&self, cycle: u64) -> Vec<Edge> {
        self.edges.since(cycle)
    }

    /// Number of bytes that the bus has damaged.
    pub fn harmed(&self) -> u64 {
        self.there.harmed + self.back.harmed
    }
}

/// The bus and its clock.
pub struct Bus<B>(pub Rc<RefCell<Wired<B>>>);

impl<B> Clone for Bus<B> {
    fn clone(&self) -> Self {
        Self(self.0.clone())
    }
}

impl<B: Kind> Bus<B> {
    pub fn new(sck_hz: u64) -> Self {
        Self::bad(sck_hz, 0, 0)
    }

    /// A bus that flips one bit in `flip` of a million bytes. An SPI can neither lose nor repeat
    /// bytes.
    pub fn bad(sck_hz: u64, flip: u32, seed: u64) -> Self {
        Self::of(B::on_spi(sck_hz), sck_hz, Faults { flip, ..Faults::default() }, seed)
    }

    /// The bus to this board.
    pub fn of(board: B, sck_hz: u64, faults: Faults, seed: u64) -> Self {
        Self(Rc::new(RefCell::new(Wired {
            board,
            edges: Seen::default(),
            sck_hz,
            clock_hz: CLOCK_HZ,
            there: Wire::new(faults, seed),
            back: Wire::new(faults, !seed),
            least_waiting: usize::MAX,
            handed_over: false,
        })))
    }

    /// The same for a board with another clock, Hz.
    pub fn clocked(self, clock_hz: u64) -> Self {
        self.0.borrow_mut().clock_hz = clock_hz;
        self
    }

    /// Connects a host that refuses any other build, and opens a session.
    pub fn connect(&self) -> BusHost<B> {
        self.connect_to(LineKind::Spi.build_id(&build()))
    }

    /// Connects a host that refuses any other build than `id`, and opens a session.
    pub fn connect_to(&self, id: BuildId) -> BusHost<B> {
        // No USB bridge delays an answer here.
        let patience = Patience { timing: Timing { resend: 5, pause: 1 }, ..Patience::default() };
        let line = SpiLine::new(self.clone());
        let mut host = Host::connect(line, self.clone(), Some(id.0), patience).unwrap();
        host.open(SESSION).unwrap();
        host
    }
}

impl<B: Kind> Clock for Bus<B> {
    fn milliseconds(&mut self) -> u32 {
        let wired = self.0.borrow();
        (wired.board.cycle() / (wired.clock_hz / 1000)) as u32
    }
}

impl<B> ErrorType for Bus<B> {
    type Error = Infallible;
}

impl<B: Kind> SpiDevice for Bus<B> {
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), Infallible> {
        let wired = &mut *self.0.borrow_mut();
        let Wired { board, edges, sck_hz, clock_hz, there, back, .. } = wired;
        for operation in operations {
            let Operation::TransferInPlace(bytes) = operation else {
                panic!("{operation:?} is not what the driver does")
            };
            there.send(0, bytes);
            there.receive(0).into_iter().for_each(|byte| board.say(byte));
            // The bits of the bytes, and half a period before and behind them.
            let halves = 16 * bytes.len() as u64 + 2;
            board.reach(board.cycle() + (halves * *clock_hz).div_ceil(2 * *sck_hz), edges);
            assert_eq!(board.unsaid(), 0, "the bus is slower than its clock");
            let heard: Vec<u8> = std::iter::from_fn(|| board.next_byte()).collect();
            back.send(0, &heard);
            bytes.copy_from_slice(&back.receive(0));
        }
        board.reach(board.cycle() + *clock_hz / 1_000_000, edges);
        let waiting = board.least_waiting().filter(|_| !wired.handed_over);
        wired.least_waiting = waiting.unwrap_or(usize::MAX).min(wired.least_waiting);
        Ok(())
    }
}
