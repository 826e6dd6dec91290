//! A board on an SPI bus, as embedded-hal has it; time is the board's, and a transfer takes a microsecond more than its bits.

use super::{CLOCK_HZ, Kind as _, MS, build};
use carrystep_board::Board;
use carrystep_link::Clock;
use embedded_hal::spi::{ErrorType, Operation, SpiDevice};
use std::cell::RefCell;
use std::convert::Infallible;
use std::rc::Rc;

/// The board, and what is looked at.
pub struct Wired {
    pub board: Board,
    /// As of [`super::World`].
    pub least_waiting: usize,
    pub handed_over: bool,
}

/// The bus and its clock.
#[derive(Clone)]
pub struct Bus(pub Rc<RefCell<Wired>>);

impl Bus {
    pub fn new(sck_hz: u64) -> Self {
        let board = Board::on_spi(&build(), sck_hz);
        Self(Rc::new(RefCell::new(Wired { board, least_waiting: usize::MAX, handed_over: false })))
    }
}

impl Clock for Bus {
    fn milliseconds(&mut self) -> u32 {
        (self.0.borrow().board.cycle() / MS) as u32
    }
}

impl ErrorType for Bus {
    type Error = Infallible;
}

impl SpiDevice for Bus {
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), Infallible> {
        let wired = &mut *self.0.borrow_mut();
        let Wired { board, .. } = wired;
        for operation in operations {
            let Operation::TransferInPlace(bytes) = operation else {
                panic!("{operation:?} is not what the driver does")
            };
            bytes.iter().for_each(|&byte| board.say(byte));
            while board.unsaid() > 0 {
                let end = board.cycle() + 8;
                board.run(end, &mut ());
            }
            bytes.iter_mut().for_each(|byte| *byte = board.next_byte().expect("a byte for each"));
        }
        let end = board.cycle() + CLOCK_HZ / 1_000_000;
        while board.cycle() < end {
            board.run(end, &mut ());
        }
        let waiting = board.least_waiting().filter(|_| !wired.handed_over);
        wired.least_waiting = waiting.unwrap_or(usize::MAX).min(wired.least_waiting);
        Ok(())
    }
}
