//! The key `adders` of a machine: which numbers there are, and the shortest tick that each needs.

use carrystep_files::{Machine, SourceText};

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
         but a tick of 500 ns at 64000000 Hz has 32: a tick of 750 ns, a clock of 88000000 Hz or \
         more adders would do"
    );
}
