//! `adders`: the number of adders of the engine.

use crate::error::{InputError, SourceText};
use carrystep_core::Timebase;
use carrystep_core::engine::{
    Adders, EngineError, MAX_AXES, adder_counts, check_schedule_of_adders,
};
use toml::Spanned;

/// Checks the number of adders; without one, there is one.
pub(super) fn check(
    source: &SourceText,
    given: Option<&Spanned<usize>>,
    axes: usize,
) -> Result<usize, InputError> {
    let Some(given) = given else { return Ok(1) };
    let adders = *given.as_ref();
    // Too few or too many axes are an error of their own.
    if adders == 1 || !(1..=MAX_AXES).contains(&axes) {
        return Ok(1);
    }
    if adder_counts(axes).any(|count| count == adders) {
        return Ok(adders);
    }
    let message = EngineError::Adders(Adders { adders, axes }).to_string();
    Err(InputError::at(source, given.span(), message).help(
        "one adder computes all axes in turn; with two adders half of them at a time, and with as \
         many adders as axes all at once, so that the tick can be shorter",
    ))
}

/// Checks that the tick has room for the time slots of several adders. With one adder it need not:
/// the parallel gateware takes shorter ticks.
pub(super) fn check_tick(
    source: &SourceText,
    given: Option<&Spanned<usize>>,
    axes: usize,
    timebase: &Timebase,
) -> Result<(), InputError> {
    let several = given.filter(|given| *given.as_ref() > 1 && axes <= MAX_AXES);
    let Some(given) = several else { return Ok(()) };
    check_schedule_of_adders(axes, *given.as_ref(), timebase)
        .map_err(|error| InputError::at(source, given.span(), error.to_string()))
}

#[cfg(test)]
mod tests {
    use crate::{Machine, SourceText};

    fn machine(lines: &str, axes: usize) -> Result<Machine, String> {
        let axis = |name| {
            format!(
                "[[machine.axis]]\nname = \"a{name}\"\nsteps_per_unit = 1\nspeed_limit = 1e5\n\
                 accel_limit = 1e6\nstep_ns = 100\ngap_ns = 100\nsetup_ns = 100\nhold_ns = 100\n"
            )
        };
        let text: String = (0..axes).map(axis).collect();
        let text = format!("[machine]\n{lines}\n{text}");
        Machine::from_source(&SourceText { path: "m.toml".into(), text: text.into() })
            .map_err(|error| error.message)
    }

    #[test]
    fn tick_is_the_shortest_for_the_adders() {
        let tick = |adders| {
            let lines = format!("clock_hz = 64_000_000\nphases = 4\nadders = {adders}");
            machine(&lines, 6).unwrap().timebase.tick_ns()
        };
        assert_eq!([1, 2, 6].map(tick), [1250, 750, 250]);
    }

    #[test]
    fn adders_that_no_engine_has_are_refused_with_those_that_there_are() {
        let refused = |lines: &str, axes| machine(lines, axes).unwrap_err();
        assert_eq!(refused("adders = 0", 1), "0 adders: an engine of 1 axis has 1");
        assert_eq!(refused("adders = 4", 6), "4 adders: an engine of 6 axes has 1, 2 or 6");
        assert_eq!(refused("adders = 2", 5), "2 adders: an engine of 5 axes has 1 or 5");
    }

    #[test]
    fn tick_without_room_is_refused_with_the_tick_and_the_clock_that_do() {
        let lines = "clock_hz = 64_000_000\ntick_ns = 500\nphases = 4\nadders = 2";
        assert_eq!(
            machine(lines, 6).unwrap_err(),
            "6 axes on 2 adders need 3 time slots of 13 clocks and three clocks to close the tick, 42 in all, \
             but a tick of 500 ns at 64000000 Hz has 32: a tick of 750 ns, a clock of 88000000 Hz or more adders would do"
        );
    }
}
