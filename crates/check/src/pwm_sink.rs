//! The check of the PWM's pin for a run that goes on: the plan is read as far as the run has come.

use crate::edge::{PinChange, PinSink};
use crate::error::TraceError;
use crate::pwm_check::{PwmCheck, PwmReport, PwmTiming};

/// Takes the levels of the pin of a run. `due` gives the duties that the plan sets, in order, with
/// their times of the capture: all that are due up to the time of the pin.
#[derive(Debug)]
pub struct PwmSink<F> {
    check: PwmCheck,
    due: F,
    report: Option<PwmReport>,
}

impl<F: FnMut() -> Option<(u64, u16)>> PwmSink<F> {
    /// A check of a run from configuration on.
    pub fn new(timing: PwmTiming, due: F) -> Self {
        Self { check: PwmCheck::new(timing, Some(0), Some(0), 0), due, report: None }
    }

    /// The result, after the end of the run.
    pub fn finish(self) -> Option<PwmReport> {
        self.report
    }

    fn read(&mut self) {
        while let Some((ps, duty)) = (self.due)() {
            self.check.due(i64::try_from(ps).unwrap_or(i64::MAX), duty);
        }
    }
}

impl<F: FnMut() -> Option<(u64, u16)>> PinSink for PwmSink<F> {
    fn change(&mut self, _: PinChange) -> Result<(), TraceError> {
        Ok(())
    }

    fn changes(&mut self, _: &[PinChange]) -> Result<(), TraceError> {
        Ok(())
    }

    fn pwm(&mut self, ps: u64, level: bool) -> Result<(), TraceError> {
        self.read();
        self.check.pin(ps, level);
        Ok(())
    }

    fn end(&mut self, ps: u64) -> Result<(), TraceError> {
        self.read();
        self.report = Some(self.check.end(ps));
        Ok(())
    }
}
