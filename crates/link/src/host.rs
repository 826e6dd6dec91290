//! The driver: controls one gateware on one line, from connecting to a clean stop. Every call
//! blocks until it has finished. A host that only looks or stops needs no session; all others call
//! [`Host::open`] first.

mod cancelled;
mod cutting;
mod error;
mod homing;
mod latches;
mod motion;
mod seek;
mod session;
mod snapshot;
mod state;
mod time;

pub use error::{HomingFault, HostError};
pub use homing::{AxisHoming, Homed, Homing, HomingStage, Wiring};
pub use latches::{Latches, MOST_LATCHES};
pub use motion::{Ended, Progress, Queues, Wish};
pub use seek::SeekSource;
#[cfg(feature = "std")]
pub use session::random_session;
pub use snapshot::{AxisState, Snapshot};
#[cfg(feature = "std")]
pub use time::SystemClock;
pub use time::{Clock, Moment, Patience};

use crate::facts::BuildFacts;
use crate::frame::{Answer, Body, Request, of_axis};
use crate::line::Line;
use crate::registers as map;
use crate::registers::{LONGEST_REQUEST, MOST_AXES};
use crate::session::{Session, SessionLost, WriteError};
use crate::slip;
use crate::ticks::{ClockComparison, ClockDifference, TickCount};

/// Room for bytes that wait for the line: a typical frame of all axes, and the longest one.
const OUT: usize = 640;

/// The most that the time between two looks at the line counts, ms.
const MOST_OF_A_LOOK: u32 = 5;

/// State of the machine, from the last answers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Status {
    /// The last answer, with the state of the machine.
    pub answer: Answer,
    /// Position of each axis: steps forward minus steps backward.
    pub positions: [i32; MOST_AXES as usize],
}

/// A connected gateware. Up to `N` writes, at most 127, can be unacknowledged at a time.
#[derive(Debug)]
pub struct Host<L, C, const N: usize = 64> {
    line: L,
    clock: C,
    patience: Patience,
    session: Session<N>,
    facts: BuildFacts,
    status: Status,
    /// Whether the drivers were seen with power. They keep it until this host removes it.
    powered: bool,
    ticks: TickCount,
    clocks: ClockComparison,
    /// Number of the read of TICKS without an answer, and the time before it was first sent, us.
    ticks_asked: Option<(u8, u64)>,
    /// Bytes that are waiting for the line.
    out: [u8; OUT],
    queued: usize,
    /// The time in which this driver has run, and when it looked at the clock last, ms.
    time: u32,
    looked: u32,
    /// When the last answer came, in that time, ms.
    heard: u32,
    noise: u32,
}

impl<L: Line, C: Clock, const N: usize> Host<L, C, N> {
    /// Connects: reads the facts of the gateware, and checks that this driver was made for build
    /// `wanted` (`None`: for any build). Writes nothing.
    ///
    /// # Errors
    /// [`HostError::Silence`] if nothing answers, [`HostError::Noise`] if the bytes received are no
    /// frames, [`HostError::Refused`] if it is another gateware.
    pub fn connect(
        line: L,
        clock: C,
        wanted: Option<u64>,
        patience: Patience,
    ) -> Result<Self, HostError<L::Error>> {
        let mut host = Self {
            line,
            clock,
            patience,
            session: Session::new(patience.timing),
            facts: BuildFacts::default(),
            status: Status::default(),
            powered: false,
            ticks: TickCount::default(),
            clocks: ClockComparison::default(),
            ticks_asked: None,
            out: [0; OUT],
            queued: 0,
            time: 0,
            looked: 0,
            heard: 0,
            noise: 0,
        };
        let [identity] = host.registers([map::IDENTITY])?;
        host.facts.identity = identity;
        if identity == map::IDENTITY_VALUE {
            let first = [map::PROTOCOL, map::BUILD_LOW, map::BUILD_HIGH, map::AXIS_COUNT];
            let [protocol, low, high, axes] = host.registers(first)?;
            let rest =
                [map::CLOCK_HZ, map::TICK_NS, map::PHASES, map::WATCHDOG_TICKS, map::QUEUE_DEPTH];
            let [clock_hz, tick_ns, phases, watchdog_ticks, queue_depth] = host.registers(rest)?;
            let build = u64::from(high) << 32 | u64::from(low);
            host.facts = BuildFacts {
                identity,
                protocol,
                build,
                axes,
                clock_hz,
                tick_ns,
                phases,
                watchdog_ticks,
                queue_depth,
            };
        }
        host.facts.check(wanted)?;
        host.read_status()?;
        Ok(host)
    }

    /// Number of axes of the build.
    fn axes(&self) -> u8 {
        self.facts.axes.min(MOST_AXES.into()) as u8
    }

    /// The facts that the gateware reported.
    pub const fn facts(&self) -> &BuildFacts {
        &self.facts
    }

    /// The state from the last answers. [`Self::read_status`] reads it again.
    pub const fn status(&self) -> &Status {
        &self.status
    }

    /// Reads the number of the gateware's tick, without the wraps of TICKS ([`TickCount`]).
    ///
    /// # Errors
    /// [`HostError`] if the connection fails.
    pub fn tick(&mut self) -> Result<i64, HostError<L::Error>> {
        let ticks = self.register(map::TICKS)?;
        Ok(self.ticks.see(ticks))
    }

    /// By how much the gateware's clock is faster than the host's, from all reads of TICKS so far;
    /// [`Self::stream`] and [`Self::tick`] read it. `None` before two reads.
    pub fn clock_difference(&self) -> Option<ClockDifference> {
        self.clocks.difference()
    }

    /// Returns the line.
    pub fn free(self) -> L {
        self.line
    }

    /// Reads the state and all positions. Positions are read one after the other; if the state tells
    /// that the axes rest, all of them were read at rest.
    ///
    /// # Errors
    /// [`HostError`] if the connection fails.
    pub fn read_status(&mut self) -> Result<Status, HostError<L::Error>> {
        let rests = |answer: &Answer| answer.idle || answer.halted;
        loop {
            self.register(of_axis(map::POSITION, 0))?;
            let rested = rests(&self.status.answer);
            for axis in 1..self.axes() {
                self.register(of_axis(map::POSITION, axis))?;
            }
            // The axes may have come to rest meanwhile.
            if rested || self.axes() < 2 || !rests(&self.status.answer) {
                return Ok(self.status);
            }
        }
    }

    /// Reads a register.
    ///
    /// # Errors
    /// [`HostError`] if the connection fails.
    pub fn register(&mut self, address: u8) -> Result<u32, HostError<L::Error>> {
        self.registers([address]).map(|[word]| word)
    }

    fn registers<const K: usize>(
        &mut self,
        addresses: [u8; K],
    ) -> Result<[u32; K], HostError<L::Error>> {
        let mut words = [None; K];
        self.listen();
        for address in addresses {
            // At most eight reads are in progress, and no others are open: there is room.
            let _ = self.session.read(address);
        }
        while words.iter().any(Option::is_none) {
            self.pump(&mut |answer| {
                for (word, address) in words.iter_mut().zip(addresses) {
                    if answer.is_read_of(address) {
                        *word = Some(answer.data);
                    }
                }
            })?;
        }
        Ok(words.map(Option::unwrap_or_default))
    }

    /// Writes a register, and waits until the gateware has executed the write.
    ///
    /// # Errors
    /// [`HostError::NoSession`] if [`Self::open`] was not called; [`HostError`] if the connection
    /// fails.
    pub fn write(&mut self, address: u8, word: u32) -> Result<(), HostError<L::Error>> {
        self.listen();
        let body = Body::Write { address, word };
        loop {
            match self.session.write(body) {
                Ok(()) => break,
                Err(WriteError::Full(_)) => self.pump(&mut |_| ())?,
                Err(WriteError::NoSession) => return Err(HostError::NoSession),
                Err(WriteError::NoPower(error)) => return Err(error.into()),
            }
        }
        while self.session.writing() {
            self.pump(&mut |_| ())?;
        }
        Ok(())
    }

    /// Starts to measure silence, if no request was open before.
    fn listen(&mut self) {
        if !self.session.waiting() {
            (self.heard, self.noise) = (self.time(), 0);
        }
    }

    /// For how long this driver has run and could have read an answer, ms. If a busy computer does not
    /// run it for a while, answers may wait to be read, so the time between two looks at the line
    /// counts for at most [`MOST_OF_A_LOOK`].
    fn time(&mut self) -> u32 {
        let now = self.clock.milliseconds();
        let passed = now.wrapping_sub(core::mem::replace(&mut self.looked, now));
        self.time = self.time.wrapping_add(passed.min(MOST_OF_A_LOOK));
        self.time
    }

    /// Performs one exchange with the line. `seen` is called with each answer.
    ///
    /// All closures inside this driver are `dyn`: it is then compiled once for a line and a clock,
    /// and not once more for each caller.
    fn pump(&mut self, seen: &mut dyn FnMut(&Answer)) -> Result<(), HostError<L::Error>> {
        let mut now = self.time();
        while self.queued + slip::line_bytes(LONGEST_REQUEST) <= self.out.len() {
            let Some(request) = self.session.transmit(now) else { break };
            if let Request { sequence, body: Body::Read { address: map::TICKS }, .. } = request
                && self.ticks_asked.is_none_or(|(asked, _)| asked != sequence)
            {
                self.ticks_asked = Some((sequence, self.clock.moment().us));
            }
            for byte in slip::encode(request.to_bytes().as_slice()) {
                self.out.get_mut(self.queued).into_iter().for_each(|place| *place = byte);
                self.queued += 1;
            }
        }
        let mut came = [0; 256];
        let out = self.out.get(..self.queued).unwrap_or_default();
        let done = self.line.exchange(out, &mut came).map_err(HostError::Line)?;
        let sent = done.sent.min(self.queued);
        self.out.copy_within(sent..self.queued, 0);
        self.queued -= sent;
        now = self.time();
        for &byte in came.iter().take(done.received) {
            self.noise += u32::from(byte != map::END);
            let answer = match self.session.receive(byte, now) {
                Ok(None) => continue,
                Ok(Some(answer)) => answer,
                Err(lost) => return Err(self.lost(lost)),
            };
            (self.heard, self.noise) = (now, 0);
            if answer.is_read_of(map::TICKS)
                && let Some((_, before)) =
                    self.ticks_asked.take_if(|(asked, _)| *asked == answer.sequence)
            {
                let Moment { us, resolution_us } = self.clock.moment();
                let (tick, after) = (self.ticks.see(answer.data), us + u64::from(resolution_us));
                self.clocks.observe(self.facts.tick_ns, tick, before, after);
            }
            self.status.answer = answer;
            if let Some(axis) = axis_with_position(&answer)
                && let Some(position) = self.status.positions.get_mut(usize::from(axis))
            {
                *position = answer.data.cast_signed();
            }
            seen(&answer);
        }
        let silence = now.wrapping_sub(self.heard);
        let known = self.facts.identity == map::IDENTITY_VALUE;
        let patience = if known { self.patience.lost } else { self.patience.silence };
        let gives_up = self.session.waiting() && silence > patience;
        if gives_up {
            // A caller that goes on nevertheless waits as long again.
            self.heard = now;
        }
        match (gives_up, self.noise) {
            (false, _) => Ok(()),
            (true, bytes) if known => Err(HostError::Lost { ms: silence, bytes }),
            (true, 0) => Err(HostError::Silence { ms: silence }),
            (true, bytes) => Err(HostError::Noise { bytes }),
        }
    }

    /// The error for a session that the gateware does not keep any more.
    fn lost(&mut self, lost: SessionLost) -> HostError<L::Error> {
        self.status.answer = lost.answer;
        let SessionLost { answer: Answer { ready, next, .. } } = lost;
        // Only a restart takes the power away and leaves no session behind.
        let restarted = core::mem::take(&mut self.powered) && !ready && next == 0;
        if restarted { HostError::Restarted } else { lost.into() }
    }
}

/// The axis whose position is in this answer: after a read of its position, and after every
/// segment.
fn axis_with_position(answer: &Answer) -> Option<u8> {
    let axis = answer.axis()?;
    (answer.written || answer.address == of_axis(map::POSITION, axis)).then_some(axis)
}
