//! What the checks of captures have in common: where the origin is, and what makes a capture
//! unusable.

use crate::arguments::CheckArguments;
use crate::failure::Failure;
use carrystep_check::{Origin, OwnCapture, TraceError};
use carrystep_core::Timebase;

/// The origin of a capture: the given one, that of a capture by carrystep, or one that is found
/// from the pulses. A capture from other gateware than that of this time base is refused.
pub fn origin(
    arguments: &CheckArguments,
    own: Option<OwnCapture>,
    timebase: &Timebase,
) -> Result<Origin, Failure> {
    if let Some(own) = own.filter(|own| own.timebase != *timebase) {
        return Err(Failure::input(format!(
            "{}: recorded from gateware with {}, but the machine of {} has {}",
            arguments.capture.display(),
            figures(&own.timebase),
            arguments.file.display(),
            figures(timebase)
        )));
    }
    Ok(match (arguments.origin_ps, own) {
        (Some(ps), _) => Origin::Fixed { ps },
        (None, Some(own)) => Origin::Known { ps: own.origin_ps },
        (None, None) => Origin::Midpoint,
    })
}

/// The failure of reading a capture.
pub fn unusable(arguments: &CheckArguments, error: TraceError) -> Failure {
    match error {
        TraceError::Write { .. } | TraceError::Open(_) => error.into(),
        other => Failure::input(format!("{}: {other}", arguments.capture.display())),
    }
}

/// The settings in which two builds must agree to have the same time base.
fn figures(timebase: &Timebase) -> String {
    format!(
        "clock_hz = {}, tick_ns = {}, phases = {}",
        timebase.clock_hz(),
        timebase.tick_ns(),
        timebase.phases()
    )
}
