//! A line and a clock with a gateware in miniature behind them; both ways may be faulty, and the test can reach in.

use super::device::Device;
use super::soak::TICKS;
use super::wire::{Faults, Wire};
use carrystep_link::{Clock, Exchanged, Line};
use std::cell::RefCell;
use std::collections::VecDeque;
use std::convert::Infallible;
use std::rc::Rc;

/// What is at the other end.
pub enum Peer {
    /// The gateware.
    Gateware,
    /// Nobody.
    Nobody,
    /// Something that talks, whatever it is told.
    Chatter(Vec<u8>),
    /// The host's own bytes come back.
    Echo,
}

pub struct World {
    pub device: Device,
    pub peer: Peer,
    pub now: u32,
    /// Called each millisecond.
    pub meanwhile: Box<dyn FnMut(&mut Device)>,
    there: Wire,
    back: Wire,
    /// What has come and was not taken yet.
    inbox: VecDeque<u8>,
}

/// One end of it, to be a line and a clock.
#[derive(Clone)]
pub struct End(pub Rc<RefCell<World>>);

impl End {
    pub fn new(faults: Faults, seed: u64) -> Self {
        let (there, back) = (Wire::new(faults, seed), Wire::new(faults, !seed));
        let device = Device::new(6, seed as u8);
        let meanwhile = Box::new(|_: &mut Device| ());
        Self(Rc::new(RefCell::new(World {
            device,
            peer: Peer::Gateware,
            now: 1_000_000,
            meanwhile,
            there,
            back,
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

    /// A millisecond, in which at most 300 bytes go out.
    fn exchange(&mut self, out: &[u8], into: &mut [u8]) -> Result<Exchanged, Infallible> {
        let world = &mut *self.0.borrow_mut();
        let World { device, peer, now, meanwhile, there, back, inbox } = world;
        *now += 1;
        let sent = out.len().min(300);
        for piece in out[..sent].split_inclusive(|&byte| byte == 0xc0) {
            there.send(*now, piece);
        }
        for byte in there.receive(*now) {
            match peer {
                Peer::Gateware => {
                    let answer = device.byte(byte);
                    if !answer.is_empty() {
                        back.send(*now, &answer);
                    }
                }
                Peer::Echo => back.send(*now, &[byte]),
                Peer::Nobody | Peer::Chatter(_) => {}
            }
        }
        if let Peer::Chatter(words) = peer {
            back.send(*now, words);
        }
        device.elapse(TICKS);
        meanwhile(device);
        inbox.extend(back.receive(*now));
        let received = inbox.len().min(into.len());
        into.iter_mut().zip(inbox.drain(..received)).for_each(|(place, byte)| *place = byte);
        Ok(Exchanged { sent, received })
    }
}
