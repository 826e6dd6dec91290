//! Opens a session: from then on the gateware takes the writes of this host, and of no other.

use super::{Clock, Ended, Host, HostError, Progress, Wish};
use crate::line::Line;
use crate::registers as map;
use core::num::NonZeroU16;

impl<L: Line, C: Clock, const N: usize> Host<L, C, N> {
    /// Opens a session with this number, and so takes the gateware from any other host. Numbers
    /// should differ from host to host: [`random_session`] draws one.
    ///
    /// The gateware opens one only if no axis moves and no segment waits, or if a stop is complete.
    /// As long as it is busy, this waits: for the time after which the gateware's watchdog stops
    /// the axes of a host that has died, and [`Patience::change`](super::Patience::change) more. It
    /// stops nothing by itself: [`Self::stop`] does, and needs no session.
    ///
    /// The drivers keep their power, and a stop stays in force until [`Self::clear`].
    ///
    /// # Errors
    /// [`HostError::Occupied`] if the gateware is still busy then. Other errors concern the line.
    pub fn open(&mut self, number: NonZeroU16) -> Result<(), HostError<L::Error>> {
        self.open_while(number, |_| Wish::GoOn).map(drop)
    }

    /// As [`Self::open`]. `watch` is called while the gateware is busy, and can end the wait by
    /// [`Wish::Stop`]; then no session is open, and nothing was stopped.
    ///
    /// # Errors
    /// As [`Self::open`].
    pub fn open_while(
        &mut self,
        number: NonZeroU16,
        mut watch: impl FnMut(&Progress<'_>) -> Wish,
    ) -> Result<Ended, HostError<L::Error>> {
        let watchdog = u64::from(self.facts.watchdog_ticks) * u64::from(self.facts.tick_ns);
        let watchdog = u32::try_from(watchdog / 1_000_000).unwrap_or(u32::MAX);
        let most = watchdog.saturating_add(self.patience.change);
        let begin = self.clock.milliseconds();
        loop {
            self.listen();
            self.session.open(number, self.axes());
            while self.session.opening() {
                self.pump(&mut |_| ())?;
            }
            self.read_status()?;
            if self.session.number().is_some() {
                self.powered = self.status.answer.ready;
                return Ok(Ended::Done);
            }
            if watch(&Progress {
                status: &self.status,
                handed_over: false,
                snapshot: None,
                queues: None,
            }) == Wish::Stop
            {
                return Ok(Ended::Stopped);
            }
            let ms = self.clock.milliseconds().wrapping_sub(begin);
            if ms > most {
                return Err(HostError::Occupied { ms });
            }
        }
    }

    /// Number of the session that this host has opened and not lost.
    pub fn session(&self) -> Option<NonZeroU16> {
        self.session.number()
    }

    /// Whether the gateware still keeps the session with this number, so that no other host has
    /// opened one since and the gateware was not restarted. This host has no session afterwards.
    ///
    /// # Errors
    /// [`HostError`] if the connection fails.
    pub fn keeps(&mut self, number: NonZeroU16) -> Result<bool, HostError<L::Error>> {
        self.session.assume(number);
        let read = self.register(map::POSITION);
        self.session.leave();
        match read {
            Ok(_) => Ok(true),
            Err(HostError::SessionLost(_) | HostError::Restarted) => Ok(false),
            Err(error) => Err(error),
        }
    }
}

/// A session number that another host hardly has.
#[cfg(feature = "std")]
pub fn random_session() -> NonZeroU16 {
    use std::hash::{BuildHasher as _, Hasher as _, RandomState};
    // The system seeds this hasher at random.
    let drawn = RandomState::new().build_hasher().finish() as u16;
    NonZeroU16::new(drawn).unwrap_or(NonZeroU16::MAX)
}
