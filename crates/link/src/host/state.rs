//! What a machine is in: powered, stopped, cleared; and waiting for that.

use super::{Clock, Ended, Host, HostError, Progress, Status, Wish};
use crate::frame::{Answer, of_axis};
use crate::line::Line;
use crate::registers as map;

/// The e-stop's place in [`map::CAUSES`].
const ESTOP: u8 = 0;
/// For so long after its release an e-stop may bounce, ms.
const RELEASED_MS: u32 = 20;

impl<L: Line, C: Clock, const N: usize> Host<L, C, N> {
    /// Powers the drivers, and waits until starts are taken.
    ///
    /// # Errors
    /// [`HostError::TooLong`] where that does not come; others.
    pub fn enable(&mut self) -> Result<(), HostError<L::Error>> {
        self.enable_while(|_| Wish::GoOn).map(drop)
    }

    /// The same; `watch` is called after each exchange with the line, and may have it stopped.
    ///
    /// # Errors
    /// As [`Self::enable`].
    pub fn enable_while(&mut self, mut watch: impl FnMut(&Progress<'_>) -> Wish) -> Result<Ended, HostError<L::Error>> {
        self.write(map::CONTROL, map::CONTROL_ENABLE)?;
        let mut asked = Wish::GoOn;
        self.wait_while(
            "the drivers' power",
            |answer| answer.ready,
            |status| {
                asked = watch(&Progress { status, handed_over: false });
                asked
            },
        )?;
        if asked == Wish::Stop {
            self.stop()?;
            return Ok(Ended::Stopped);
        }
        self.powered = true;
        Ok(Ended::Done)
    }

    /// Takes the drivers' power away, as soon as all axes are done.
    ///
    /// # Errors
    /// [`HostError`].
    pub fn disable(&mut self) -> Result<(), HostError<L::Error>> {
        self.powered = false;
        self.write(map::CONTROL, 0)
    }

    /// Stops all axes by their ramps, and waits until they rest. What was queued is gone; [`Self::clear`] resumes.
    ///
    /// # Errors
    /// [`HostError`].
    pub fn stop(&mut self) -> Result<Status, HostError<L::Error>> {
        self.stop_while(|_| ())
    }

    /// The same; `watch` sees the machine ramp down.
    ///
    /// # Errors
    /// [`HostError`].
    pub fn stop_while(&mut self, mut watch: impl FnMut(&Status)) -> Result<Status, HostError<L::Error>> {
        self.session.withdraw();
        self.write(map::CONTROL, self.power() | map::CONTROL_STOP)?;
        self.wait_while(
            "the stop",
            |answer| answer.fault && answer.halted,
            |status| {
                watch(status);
                Wish::GoOn
            },
        )?;
        self.look()
    }

    /// Resumes after a stop of any cause; queues are empty then. Does nothing where there was none.
    ///
    /// # Errors
    /// [`HostError::StillPressed`], some 20 ms after the first try; [`HostError::TooLong`] where the fault stays for another reason.
    pub fn clear(&mut self) -> Result<(), HostError<L::Error>> {
        let begin = self.clock.milliseconds();
        self.look()?;
        if self.status.answer.fault {
            self.write(map::CONTROL, self.power())?;
            self.wait("the stop", |answer| answer.halted)?;
        }
        let first = self.clock.milliseconds();
        while self.status.answer.fault {
            self.write(map::CLEAR, 0)?;
            self.look()?;
            let Answer { fault, cause, .. } = self.status.answer;
            // A CLEAR forgets every cause that is over: an e-stop that is there again at once is pressed. A released
            // one may bounce for some milliseconds.
            let tried = self.clock.milliseconds().wrapping_sub(first);
            if fault && cause == ESTOP && tried > RELEASED_MS {
                return Err(HostError::StillPressed);
            }
            if self.clock.milliseconds().wrapping_sub(begin) > self.patience.change {
                let cause = self.status.answer.cause_name();
                return Err(HostError::TooLong { what: "the clear", cause, ms: self.patience.change });
            }
        }
        Ok(())
    }

    /// Stops and clears a machine that another host left in the middle of something; one at rest stays as it is.
    ///
    /// # Errors
    /// As [`Self::stop`] and [`Self::clear`].
    pub fn settle(&mut self) -> Result<(), HostError<L::Error>> {
        let Answer { idle, fault, .. } = self.look()?.answer;
        if !idle && !fault {
            self.stop()?;
        }
        self.clear()
    }

    /// The drivers keep the power that they have, whoever gave it.
    const fn power(&self) -> u32 {
        if self.powered || self.status.answer.ready { map::CONTROL_ENABLE } else { 0 }
    }

    /// Looks at the machine until it is as wished.
    pub(super) fn wait(
        &mut self,
        what: &'static str,
        wish: impl Fn(&Answer) -> bool,
    ) -> Result<(), HostError<L::Error>> {
        self.wait_while(what, wish, |_| Wish::GoOn)
    }

    /// The same, or until `watch`, which is called after each exchange, does not want to wait any longer.
    fn wait_while(
        &mut self,
        what: &'static str,
        wish: impl Fn(&Answer) -> bool,
        mut watch: impl FnMut(&Status) -> Wish,
    ) -> Result<(), HostError<L::Error>> {
        let begin = self.clock.milliseconds();
        while !wish(&self.status.answer) {
            self.register(of_axis(map::POSITION, 0))?;
            if watch(&self.status) == Wish::Stop {
                return Ok(());
            }
            if self.clock.milliseconds().wrapping_sub(begin) > self.patience.change {
                let cause = self.status.answer.cause_name();
                return Err(HostError::TooLong { what, cause, ms: self.patience.change });
            }
        }
        Ok(())
    }
}
