//! A line and a clock for tests, with a gateware in miniature or another device at the far end.

use super::device::{Device, Done};
use super::soak::TICKS;
use carrystep_link::{Clock, Exchanged, Line};
use std::cell::RefCell;
use std::collections::VecDeque;
use std::convert::Infallible;
use std::rc::Rc;

/// The device at the far end.
pub enum Peer {
    /// The gateware in miniature.
    Gateware,
    /// No device.
    Nobody,
    /// A device that sends these bytes, regardless of what it receives.
    Chatter(Vec<u8>),
    /// The host's own bytes return.
    Echo,
}

pub struct World {
    pub device: Device,
    pub peer: Peer,
    pub now: u32,
    /// Time when the gateware executed a stop, ms.
    pub stopped: Option<u32>,
    /// Bytes received and not read yet.
    inbox: VecDeque<u8>,
}

/// One end of the bench; it serves as line and as clock.
#[derive(Clone)]
pub struct End(pub Rc<RefCell<World>>);

impl End {
    pub fn new() -> Self {
        let device = Device::new(6, 1);
        Self(Rc::new(RefCell::new(World {
            device,
            peer: Peer::Gateware,
            now: 1_000_000,
            stopped: None,
            inbox: VecDeque::new(),
        })))
    }
}

impl Clock for End {
    fn milliseconds(&mut self) -> u32 {
        self.0.borrow().now
    }
}

impl Line for End {
    type Error = Infallible;

    /// An exchange lasts one millisecond, in which at most 300 bytes are sent.
    fn exchange(&mut self, out: &[u8], into: &mut [u8]) -> Result<Exchanged, Infallible> {
        let World { device, peer, now, stopped, inbox } = &mut *self.0.borrow_mut();
        *now += 1;
        let sent = out.len().min(300);
        match peer {
            Peer::Gateware => {
                let done = device.log.len();
                inbox.extend(out[..sent].iter().flat_map(|&byte| device.byte(byte)));
                let is_stop = |done: &Done| matches!(*done, Done::Write(0x26, _));
                if device.log[done..].iter().any(is_stop) {
                    stopped.get_or_insert(*now);
                }
            }
            Peer::Nobody => {}
            Peer::Chatter(words) => inbox.extend(words.iter()),
            Peer::Echo => inbox.extend(&out[..sent]),
        }
        device.elapse(TICKS);
        let received = inbox.len().min(into.len());
        into.iter_mut().zip(inbox.drain(..received)).for_each(|(place, byte)| *place = byte);
        Ok(Exchanged { sent, received })
    }
}
