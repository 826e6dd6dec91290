//! Changes the state of the machine (power, stop, clear) and waits until the change is complete.

use super::{Clock, Ended, Host, HostError, Progress, Status, Wish};
use crate::frame::{Answer, of_axis};
use crate::line::Line;
use crate::registers as map;

/// Index of the e-stop in [`map::CAUSES`].
const ESTOP: u8 = 0;
/// Time for which an e-stop may bounce after its release, ms.
const RELEASED_MS: u32 = 20;

impl<L: Line, C: Clock, const N: usize> Host<L, C, N> {
    /// Powers the drivers, and waits until the gateware accepts starts.
    ///
    /// # Errors
    /// [`HostError::TooLong`] if it does not accept them in time. Other errors concern the line.
    pub fn enable(&mut self) -> Result<(), HostError<L::Error>> {
        self.enable_while(|_| Wish::GoOn).map(drop)
    }

    /// As [`Self::enable`]. `watch` is called after each exchange with the line and can stop the
    /// machine.
    ///
    /// # Errors
    /// As [`Self::enable`].
    pub fn enable_while(
        &mut self,
        mut watch: impl FnMut(&Progress<'_>) -> Wish,
    ) -> Result<Ended, HostError<L::Error>> {
        self.write(map::CONTROL, map::CONTROL_ENABLE)?;
        let mut asked = Wish::GoOn;
        self.wait_while("the drivers' power", &|answer| answer.ready, &mut |status| {
            asked = watch(&Progress { status, handed_over: false, snapshot: None, queues: None });
            asked
        })?;
        if asked == Wish::Stop {
            self.stop()?;
            return Ok(Ended::Stopped);
        }
        self.powered = true;
        Ok(Ended::Done)
    }

    /// Removes the drivers' power as soon as all axes have finished.
    ///
    /// # Errors
    /// [`HostError`] if the connection fails.
    pub fn disable(&mut self) -> Result<(), HostError<L::Error>> {
        self.powered = false;
        self.write(map::CONTROL, 0)
    }

    /// Stops all axes by their ramps, and waits until they rest. Segments in the queues are
    /// discarded. [`Self::clear`] ends the stop. No session is needed: this stops the axes of any
    /// host.
    ///
    /// # Errors
    /// [`HostError`] if the connection fails or the axes do not rest in time.
    pub fn stop(&mut self) -> Result<Status, HostError<L::Error>> {
        self.stop_while(|_| ())
    }

    /// As [`Self::stop`]. `watch` is called with each state while the axes ramp down.
    ///
    /// # Errors
    /// As [`Self::stop`].
    pub fn stop_while(
        &mut self,
        mut watch: impl FnMut(&Status),
    ) -> Result<Status, HostError<L::Error>> {
        self.listen();
        self.session.stop();
        while self.session.stopping() || self.session.writing() {
            self.pump(&mut |_| ())?;
        }
        self.wait_while("the stop", &|answer| answer.fault && answer.halted, &mut |status| {
            watch(status);
            Wish::GoOn
        })?;
        self.read_status()
    }

    /// Ends a stop of any cause as soon as it is complete; the queues are empty then. Does nothing if
    /// no stop is in force.
    ///
    /// # Errors
    /// [`HostError::StillPressed`] if the e-stop is still asserted some 20 ms after the first try.
    /// [`HostError::TooLong`] if the fault remains for another reason.
    pub fn clear(&mut self) -> Result<(), HostError<L::Error>> {
        let begin = self.clock.milliseconds();
        self.read_status()?;
        if self.status.answer.fault {
            self.wait("the stop", |answer| answer.halted)?;
        }
        let first = self.clock.milliseconds();
        while self.status.answer.fault {
            self.write(map::CLEAR, 0)?;
            self.read_status()?;
            let Answer { fault, cause, .. } = self.status.answer;
            // A CLEAR removes every cause that is over. If the e-stop comes back at once, it is
            // still pressed; after its release it may bounce for some milliseconds.
            let tried = self.clock.milliseconds().wrapping_sub(first);
            if fault && cause == ESTOP && tried > RELEASED_MS {
                return Err(HostError::StillPressed);
            }
            if self.clock.milliseconds().wrapping_sub(begin) > self.patience.change {
                let cause = self.status.answer.cause_name();
                return Err(HostError::TooLong {
                    what: "the clear",
                    cause,
                    ms: self.patience.change,
                });
            }
        }
        Ok(())
    }

    /// Reads the state until it is as wanted.
    pub(super) fn wait(
        &mut self,
        what: &'static str,
        wish: impl Fn(&Answer) -> bool,
    ) -> Result<(), HostError<L::Error>> {
        self.wait_while(what, &wish, &mut |_| Wish::GoOn)
    }

    /// As `wait`. Ends earlier if `watch`, which is called after each exchange, asks for it.
    fn wait_while(
        &mut self,
        what: &'static str,
        wish: &dyn Fn(&Answer) -> bool,
        watch: &mut dyn FnMut(&Status) -> Wish,
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
