//! A computer that does not run the driver for seconds, while the board goes on: no request is sent
//! twice for it, and the line is not taken for dead.

use crate::support::wire::Faults;
use crate::support::{CLOCK_HZ, Died, End, SESSION, build};
use carrystep_core::link::{END, Uart};
use carrystep_link::registers::{SEEK, TICKS};
use carrystep_link::{Clock, Exchanged, Host, HostError, Line, Patience};
use carrystep_virtual_board::ModelBoard;
use std::cell::Cell;
use std::rc::Rc;

/// A pause of the driver, ms: longer than a host waits for an answer of a line that is not dead.
const PAUSE: u64 = 2500;
/// Exchanges from one pause to the next: any place of a request and its answer meets a pause.
const BETWEEN: [u32; 4] = [1, 2, 3, 5];

/// The board's end of the line.
#[derive(Clone)]
struct Busy {
    end: End<ModelBoard>,
    /// Exchanges from one pause to the next; 0: no pause.
    between: u32,
    exchanges: Rc<Cell<u32>>,
    /// Frames that were sent.
    sent: Rc<Cell<u32>>,
    is_dead: Rc<Cell<bool>>,
}

impl Clock for Busy {
    fn milliseconds(&mut self) -> u32 {
        self.end.milliseconds()
    }
}

impl Line for Busy {
    type Error = Died;

    fn exchange(&mut self, out: &[u8], into: &mut [u8]) -> Result<Exchanged, Died> {
        self.exchanges.set(self.exchanges.get() + 1);
        let pauses = self.between > 0 && self.exchanges.get().is_multiple_of(self.between);
        // Half of the pauses come before bytes are passed on, and half behind.
        let before = (self.exchanges.get() / self.between.max(1)).is_multiple_of(2);
        if pauses && before {
            self.end.wait(PAUSE);
        }
        let done = self.end.exchange(if self.is_dead.get() { &[] } else { out }, into)?;
        let ends = out[..done.sent].iter().filter(|byte| **byte == END).count();
        self.sent.set(self.sent.get() + ends as u32);
        if pauses && !before {
            self.end.wait(PAUSE);
        }
        Ok(if self.is_dead.get() { Exchanged { sent: out.len(), ..done } } else { done })
    }
}

type BusyHost = Host<Busy, Busy>;

fn host(between: u32) -> (BusyHost, Busy) {
    // A request and its answer take some exchanges.
    let uart = Uart::new(CLOCK_HZ, 115_200).unwrap();
    let end = End::<ModelBoard>::new(uart, Faults::default(), 1);
    let busy = Busy {
        end,
        between,
        exchanges: Rc::default(),
        sent: Rc::default(),
        is_dead: Rc::default(),
    };
    let id = uart.build_id(&build()).0;
    let host = Host::connect(busy.clone(), busy.clone(), Some(id), Patience::default()).unwrap();
    (host, busy)
}

/// Reads and writes; returns how many frames were sent.
fn exchanged(between: u32) -> u32 {
    let (mut host, busy) = host(between);
    host.open(SESSION).unwrap();
    for _ in 0..20 {
        host.register(TICKS).unwrap();
        host.write(SEEK, 0).unwrap();
    }
    busy.sent.get()
}

#[test]
fn pauses_of_the_driver_send_nothing_twice_and_are_no_silence_of_the_line() {
    let without = exchanged(0);
    for between in BETWEEN {
        assert_eq!(exchanged(between), without, "a pause behind {between} exchanges");
    }
}

#[test]
fn dead_line_is_noticed_in_spite_of_pauses() {
    for between in [0, 1, 5] {
        let (mut host, busy) = host(between);
        busy.is_dead.set(true);
        let error = host.register(TICKS).err();
        assert!(matches!(error, Some(HostError::Lost { .. })), "{error:?}");
    }
}
