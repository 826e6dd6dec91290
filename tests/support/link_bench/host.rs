//! A host with a session, written from docs/protocol.md: it opens, writes with consecutive numbers,
//! and reads.

use super::{LinkBench, Said, frames};
use carrystep_core::link::registers::{CONTROL, OPEN, POSITION, SNAPSHOT, START, of_axis};

/// Number of cycles within which an answer must come.
const PATIENCE: u64 = 60_000;

/// The host that owns the gateware.
#[derive(Debug, Clone, Copy)]
pub struct Host {
    /// Its session number.
    pub session: u16,
    /// The number of its next write.
    pub next: u8,
}

impl LinkBench {
    /// Sends a frame and receives its answer.
    ///
    /// # Panics If the answer does not come, is damaged or is another request's.
    pub fn ask(&mut self, frame: &[u8]) -> Said {
        self.send(&frames::on_the_line(frame));
        self.said((frame[0], frame[1]))
    }

    /// Receives the answer to the request with this number and address.
    ///
    /// # Panics As [`LinkBench::ask`].
    pub fn said(&mut self, request: (u8, u8)) -> Said {
        let answer = self.answer(PATIENCE).unwrap_or_else(|| panic!("no answer to {request:02x?}"));
        let frame = frames::unframe(&answer).unwrap_or_else(|| panic!("{answer:02x?} is no frame"));
        let said = Said::of(&frame);
        assert_eq!((said.sequence, said.address), request);
        said
    }

    /// A read of anyone.
    pub fn read(&mut self, register: u8) -> Said {
        self.ask(&frames::read(0, register))
    }

    /// The state of the machine, by a read of anyone.
    pub fn status(&mut self) -> Said {
        self.read(POSITION)
    }
}

impl Host {
    /// Opens a session.
    ///
    /// # Panics If the gateware refuses it.
    pub fn open(bench: &mut LinkBench, session: u16) -> Self {
        let said = bench.ask(&frames::write(0x5a, OPEN, session, &[0]));
        assert_eq!((said.reason, said.next, said.seeking), (0, 0, 0), "{said:?}");
        Self { session, next: 0 }
    }

    /// Opens a session, switches the drivers on and waits until starts are accepted.
    pub fn powered(bench: &mut LinkBench) -> Self {
        let mut host = Self::open(bench, 0xc0db);
        host.write(bench, CONTROL, &[1]);
        while !bench.status().ready {}
        host
    }

    /// The frame of a write with a number that is `ahead` of the next one.
    pub fn frame(&self, ahead: u8, register: u8, words: &[u32]) -> Vec<u8> {
        frames::write(self.next.wrapping_add(ahead), register, self.session, words)
    }

    /// Sends the next write, which must be executed; returns its answer.
    ///
    /// # Panics If it is not executed.
    pub fn write(&mut self, bench: &mut LinkBench, register: u8, words: &[u32]) -> Said {
        let said = bench.ask(&self.frame(0, register, words));
        self.next = self.next.wrapping_add(1);
        assert_eq!((said.next, said.reason, said.written), (self.next, 0, true), "{said:?}");
        said
    }

    /// Starts these axes and waits until nothing moves.
    pub fn run(&mut self, bench: &mut LinkBench, axes: u32) {
        self.write(bench, START, &[axes]);
        while !bench.status().idle {}
    }

    /// The state of all axes in one tick: the words of the snapshot of each axis.
    pub fn snapshot(&mut self, bench: &mut LinkBench, registers: &[u8], axes: u8) -> Vec<u32> {
        self.write(bench, SNAPSHOT, &[0]);
        let all =
            registers.iter().flat_map(|&register| (0..axes).map(move |axis| (register, axis)));
        all.map(|(register, axis)| bench.read(of_axis(register, axis)).data).collect()
    }
}
