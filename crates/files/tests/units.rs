//! Tests of axes described by their mechanics: units, turns of the motor, speeds per minute. The
//! build equals that of the same axis in steps and seconds.

use carrystep_core::link::{BuildId, LineKind};
use carrystep_files::{BigDecimal, InputError, Machine, MoveFile, SourceText};

/// A machine with one axis that has these lines.
fn read(lines: &str) -> Result<Machine, InputError> {
    let text = format!(
        "[machine]\n[[machine.axis]]\nname = \"x\"\naccel_limit = 4000\ndriver = \"tmc2209\"\n{lines}"
    );
    Machine::from_source(&SourceText { path: "machine.toml".into(), text: text.into() })
}

fn build_id(machine: &Machine) -> BuildId {
    LineKind::Spi.build_id(&machine.engine())
}

fn number(text: &str) -> BigDecimal {
    text.parse().unwrap()
}

const PLAIN: &str = "steps_per_unit = 80\nspeed_limit = 100\nstart_speed = 5\n";

#[test]
fn mechanics_give_the_same_build_as_steps_and_seconds() {
    let plain = read(PLAIN).unwrap();
    assert_eq!(plain.axes[0].unit.name, "units");
    for lines in [
        "unit = \"mm\"\nsteps_per_unit = 80\nspeed_limit = 100\nstart_speed = 5\n",
        "lead = 40\nsteps_per_rev = 200\nmicrosteps = 16\nspeed_limit = 100\nstart_speed = 5\n",
        "unit = \"mm\"\nsteps_per_unit = 80\nspeed_limit_per_min = 6_000\nstart_speed_per_min = 300\n",
        "lead = 40\nsteps_per_rev = 200\nmicrosteps = 16\nspeed_limit_per_min = 6e3\nstart_speed = 5\n",
    ] {
        let machine = read(lines).unwrap();
        assert_eq!(build_id(&machine), build_id(&plain), "{lines}");
        let (axis, same) = (&machine.axes[0], &plain.axes[0]);
        assert_eq!(axis.steps_per_unit, same.steps_per_unit, "{lines}");
        assert_eq!(
            (&axis.speed_limit, &axis.start_speed),
            (&same.speed_limit, &same.start_speed),
            "{lines}"
        );
    }
    assert_ne!(
        build_id(&read(&PLAIN.replace("80", "90")).unwrap()),
        build_id(&plain),
        "a stop ramp that differs"
    );
}

#[test]
fn periodic_steps_per_unit_round_as_the_fraction_does() {
    // With 3200 / 360 steps per degree, 0.05625 degrees are half a step, which is rounded away from
    // zero.
    let axis = "unit = \"deg\"\nlead = 360\nsteps_per_rev = 200\nmicrosteps = 16\nspeed_limit_per_min = 1000\n";
    let text = |to: &str| {
        format!(
            "[machine]\n[[machine.axis]]\nname = \"x\"\naccel_limit = 4000\ndriver = \"tmc2209\"\n{axis}\
             [[move]]\nprofile = \"ranade\"\nto = {{ x = {to} }}\n"
        )
    };
    let moved = |to: &str| {
        let file =
            MoveFile::from_source(SourceText { path: "m".into(), text: text(to).into() }).unwrap();
        (file.moves[0].steps[0], file.moves[0].rounding[0])
    };
    assert_eq!(moved("45"), (400, 0.0));
    assert_eq!(moved("-360e3"), (-3_200_000, 0.0));
    assert_eq!(moved("0.05625"), (1, -0.5));
    assert_eq!(moved("-0.05625"), (-1, 0.5));
    assert_eq!(moved("0.05624"), (0, 0.499_911_111_111_111_1));
    let machine = read(axis).unwrap();
    // 1000 / 60 x 3200 / 360 = 148.148148... steps/s.
    let speed = &machine.axes[0].speed_limit.steps;
    assert!(
        *speed > number("148.148148148148148148148148148")
            && *speed < number("148.148148148148148148148148149")
    );
}

#[test]
fn contradictory_or_incomplete_mechanics_are_refused_at_their_place() {
    let rows = [
        (
            "steps_per_unit = 80\nlead = 40\nspeed_limit = 1\n",
            7,
            "both steps_per_unit and lead are given",
        ),
        (
            "steps_per_unit = 80\nmicrosteps = 4\nspeed_limit = 1\n",
            7,
            "both steps_per_unit and microsteps are given",
        ),
        ("lead = 40\nspeed_limit = 1\n", 6, "missing field: steps_per_rev and microsteps"),
        ("steps_per_rev = 200\nmicrosteps = 4\nspeed_limit = 1\n", 6, "missing field: lead"),
        ("speed_limit = 1\n", 2, "missing field `steps_per_unit`"),
        ("steps_per_unit = 80\n", 2, "missing field `speed_limit`"),
        (
            "steps_per_unit = 80\nspeed_limit = 1\nspeed_limit_per_min = 60\n",
            8,
            "both speed_limit and speed_limit_per_min",
        ),
        (
            "steps_per_unit = 80\nspeed_limit_per_min = 60\nstart_speed_per_min = 61\n",
            8,
            "start_speed_per_min is over speed_limit_per_min",
        ),
        (
            "lead = 0\nsteps_per_rev = 200\nmicrosteps = 4\nspeed_limit = 1\n",
            6,
            "lead = 0: must be over zero",
        ),
        (
            "lead = 4\nsteps_per_rev = 0\nmicrosteps = 4\nspeed_limit = 1\n",
            7,
            "steps_per_rev = 0: must be over zero",
        ),
        (
            "unit = \"mm per turn\"\nsteps_per_unit = 80\nspeed_limit = 1\n",
            6,
            "\"mm per turn\" cannot name a unit",
        ),
        ("unit = \"\"\nsteps_per_unit = 80\nspeed_limit = 1\n", 6, "\"\" cannot name a unit"),
    ];
    for (lines, line, says) in rows {
        let error = read(lines).unwrap_err();
        assert!(error.message.contains(says), "{lines}: {error}");
        assert_eq!(error.line_column().unwrap().0, line, "{lines}: {error}");
        assert!(error.help.is_some() || says.ends_with("over zero"), "{lines}: {error}");
    }
}

#[test]
fn errors_give_the_axis_unit_and_steps() {
    let fast =
        read("unit = \"mm\"\nsteps_per_unit = 80\nspeed_limit_per_min = 600_000\n").unwrap_err();
    assert_eq!(
        fast.message,
        "speed_limit is 10000 mm/s (800000 steps/s): half a step per tick or more"
    );
    assert_eq!(fast.help.unwrap(), "with ticks of 1000 ns stay under 6250 mm/s (500000 steps/s)");
    let steps = read("steps_per_unit = 1\nspeed_limit = 800_000\n").unwrap_err();
    assert_eq!(steps.message, "speed_limit is 800000 steps/s: half a step per tick or more");
}

#[test]
fn fewer_phases_are_proposed_where_a_long_tick_forbids_a_speed() {
    let text = "[machine]\nclock_hz = 27_000_000\n[[machine.axis]]\nname = \"x\"\nunit = \"mm\"\nsteps_per_unit = 80\n\
                speed_limit = 500\naccel_limit = 100\ndriver = \"tmc2209\"\n";
    let at = |text: &str| Machine::from_source(&SourceText { path: "m".into(), text: text.into() });
    let help = at(text).unwrap_err().help.unwrap();
    assert!(help.ends_with("16000 ns is long: `phases = 4` would allow 4000 ns"), "{help}");
    let quick = at(&text.replace("27_000_000", "27_000_000\nphases = 4")).unwrap();
    assert_eq!(
        (quick.timebase.tick_ns(), quick.chosen_tick.unwrap().fewer_phases_ns),
        (4000, None)
    );
}

#[test]
fn tick_is_chosen_only_without_tick_ns_at_other_clocks() {
    let at = |head: &str, axes: usize| {
        let axis = |i| {
            format!(
                "[[machine.axis]]\nname = \"x{i}\"\nsteps_per_unit = 1\nspeed_limit = 9\naccel_limit = 9\ndriver = \"a4988\"\n"
            )
        };
        let text = format!("[machine]\n{head}\n{}", (0..axes).map(axis).collect::<String>());
        Machine::from_source(&SourceText { path: "m".into(), text: text.into() })
    };
    for (mhz, tick_ns) in [(25, 3200), (27, 16_000), (50, 1600), (80, 1000), (100, 800), (125, 640)]
    {
        let machine = at(&format!("clock_hz = {mhz}_000_000"), 6).unwrap();
        assert_eq!(machine.timebase.tick_ns(), tick_ns, "{mhz} MHz");
        machine.engine().check().unwrap();
        // At the default clock the tick is not chosen.
        assert_eq!(
            machine.chosen_tick.map(|chosen| chosen.tick_ns),
            (mhz != 80).then_some(tick_ns)
        );
        // With the same tick given explicitly the machine is equal, and no tick was chosen.
        let given = at(&format!("clock_hz = {mhz}_000_000\ntick_ns = {tick_ns}"), 6).unwrap();
        assert_eq!((given.timebase, given.chosen_tick), (machine.timebase, None));
    }
    for head in ["", "clock_hz = 80_000_000", "phases = 4"] {
        let machine = at(head, 6).unwrap();
        assert_eq!((machine.timebase.tick_ns(), machine.chosen_tick), (1000, None), "{head}");
    }
    // Seven time slots do not fit into its tick.
    for (axes, tick_ns) in [(7, 1200), (8, 1400)] {
        let machine = at("", axes).unwrap();
        assert_eq!(machine.chosen_tick.map(|chosen| chosen.tick_ns), Some(tick_ns));
        machine.engine().check().unwrap();
    }
    let machine = at("clock_hz = 48_000_000", 6).unwrap();
    assert_eq!(machine.chosen_tick.map(|chosen| chosen.tick_ns), Some(2000));
    let error = at("clock_hz = 25_000_000\ntick_ns = 1000", 6).unwrap_err();
    assert_eq!(
        error.help.unwrap(),
        "at 25 MHz in 16 phases, 640 ns and 1280 ns are the nearest ticks; an engine of 6 axes takes 3200 ns or more; \
         `phases = 4` allows multiples of 160 ns"
    );
    let error = at("clock_hz = 33_333_333", 1).unwrap_err();
    assert_eq!(error.message, "a clock of 33333333 Hz has no tick");
    assert!(error.help.unwrap().contains("a multiple of 1 MHz has ticks"));
}
