//! Tests of `travel`, `home` and `home_order`: the values in steps and ticks, and every kind of
//! mistake.

use carrystep_files::machine::{End, overrun};
use carrystep_files::{InputError, Machine, SourceText};

const HOME: &str = "home = { toward = \"min\", seek_speed = 20, slow_speed = 2, move_off = 5, max_travel = 330, pull_off = 2, position = 0 }";

/// Lines 1 to 3 describe the machine and lines 4 to 11 the axis x; travel and home are lines 10 and
/// 11.
fn text(order: &str, travel: &str, home: &str) -> String {
    format!(
        "[machine]\n{order}\n\n[[machine.axis]]\nname = \"x\"\nsteps_per_unit = 80\nspeed_limit = 100\naccel_limit = 1000\n\
         driver = \"a4988\"\n{travel}\n{home}\n"
    )
}

fn read(text: &str) -> Result<Machine, InputError> {
    Machine::from_source(&SourceText { path: "machine.toml".into(), text: text.into() })
}

#[test]
fn missing_home_keys_follow_from_the_travel() {
    let machine = read(&text("", "travel = [-1, 300]", HOME)).unwrap();
    let home = machine.axes[0].home.unwrap();
    assert_eq!(machine.axes[0].travel, Some([-80, 24_000]));
    assert_eq!((home.toward, home.position), (End::Min, 0));
    assert_eq!((home.move_off, home.max_travel, home.pull_off), (400, 26_400, 160));
    // 1600 and 160 steps/s, and 80000 steps/s^2, in 2^-64 step per us and per us^2.
    assert_eq!(
        (home.start, home.seek, home.slow),
        (0, 29_514_790_517_935_282, 2_951_479_051_793_528)
    );
    assert_eq!(home.accel, 1_475_739_525_896);
    let short = HOME.replace("move_off = 5, max_travel = 330, ", "");
    let machine = read(&text("", "travel = [-1, 300]", &short)).unwrap();
    let home = machine.axes[0].home.unwrap();
    // 8000 steps/s stop within 400 steps. 17 rounds of 32 us and 4 us more are 4.4 steps. A
    // hundredth of 24080 is 241.
    assert_eq!((home.move_off, home.max_travel), (405 + 241, 24_080 + 2 * 646));
    assert_eq!(overrun(home.seek, machine.axes[0].stop, &machine.guard), 17);
    // Homing parameters are not part of the gateware's build.
    assert_eq!(machine.engine(), read(&text("", "", "")).unwrap().engine());
}

#[test]
fn z_homes_first_by_default() {
    let axis = |name: &str, home: &str| {
        text("", "", home).split_once("\n\n").unwrap().1.replace("\"x\"", &format!("\"{name}\""))
    };
    let with = |order: &str| {
        let axes: Vec<String> =
            ["x", "y", "Z", "a"].map(|name| axis(name, if name == "a" { "" } else { HOME })).into();
        read(&format!("[machine]\n{order}\n{}", axes.concat()))
    };
    assert_eq!(with("").unwrap().home_order, [vec![2], vec![0, 1]]);
    assert_eq!(
        with("home_order = [[\"y\"], [], [\"x\", \"Z\"]]").unwrap().home_order,
        [vec![1], vec![0, 2]]
    );
    for (order, column, says) in [
        ("home_order = [[\"y\"], [\"x\"]]", 14, "home_order leaves out axis 'Z'"),
        ("home_order = [[\"y\", \"x\"], [\"y\", \"Z\"]]", 28, "home_order names axis 'y' twice"),
        ("home_order = [[\"y\", \"x\"], [\"w\"]]", 28, "home_order names 'w', which is no axis"),
        ("home_order = [[\"a\"]]", 16, "home_order names axis 'a', which has no home table"),
        ("home_order = [\"x\"]", 15, "expected"),
        ("home_order = 3", 14, "a list in brackets"),
    ] {
        let error = with(order).unwrap_err();
        assert!(error.message.contains(says), "wanted {says}, found {error}");
        assert_eq!(error.line_column(), Some((2, column)), "{order}: {error}");
    }
    let only = "home_order = []";
    assert!(read(&format!("[machine]\n{only}\n{}", axis("x", ""))).unwrap().home_order.is_empty());
}

#[test]
fn mistake_in_homing_is_refused_at_its_place() {
    let rows = [
        // Columns: a part of the home table; its replacement, with `^` where the error must point;
        // words of the message.
        ("toward = \"min\"", "toward = ^\"low\"", "unknown variant `low`, expected `min` or `max`"),
        ("seek_speed = 20", "seek_speed = ^101", "seek_speed is over speed_limit"),
        ("seek_speed = 20", "seek_speed = ^0", "must be over zero"),
        ("seek_speed = 20", "seek_speed = ^nan", "not a usable number"),
        ("slow_speed = 2,", "slow_speed = ^20.1,", "slow_speed is over seek_speed"),
        ("slow_speed = 2,", "slow_speed = ^1e-20,", "slow_speed is under 2^-64 step per tick"),
        ("slow_speed = 2,", "slow_speed = ^1e-3,", "at this speed the search takes up to 10000 s"),
        (
            "move_off = 5",
            "move_off = ^0.1",
            "move_off is 0.1 units (8 steps): from seek_speed the axis runs 0.2125 units (17 steps) over its switch",
        ),
        ("move_off = 5", "move_off = ^-5", "must be over zero"),
        ("move_off = 5", "move_off = ^0.001", "move_off is less than half a step"),
        (
            "max_travel = 330",
            "max_travel = ^5",
            "max_travel is 5 units (400 steps): not over move_off, which is 5 units (400 steps)",
        ),
        ("max_travel = 330", "max_travel = ^1e9", "max_travel is over 2147483647 steps"),
        (
            "pull_off = 2",
            "pull_off = ^0.0125",
            "pull_off is 0.0125 units (1 steps): the axis would rest on its switch",
        ),
        ("pull_off = 2", "pull_off = ^301", "pull_off ends outside of travel"),
        ("position = 0", "position = ^-0.1", "position is outside of travel"),
        ("position = 0", "position = ^1e20", "position is over 2147483647 steps from zero"),
        ("position = 0", "position = ^\"0\"", "expected a number"),
        (", position = 0", "", "missing field `position`"),
        ("toward = \"min\"", "^colour = 1, toward = \"min\"", "unknown field `colour`"),
    ];
    for (old, new, says) in rows {
        assert_eq!(HOME.matches(old).count(), 1, "{old}");
        let home = HOME.replace(old, new);
        let error = read(&text("", "travel = [0, 300]", &home.replace('^', ""))).unwrap_err();
        assert!(error.message.contains(says), "wanted {says}, found {error}");
        if let Some(place) = home.find('^') {
            assert_eq!(error.line_column(), Some((11, place + 1)), "{error}");
        }
    }
    for (travel, column, says) in [
        ("travel = [0]", 10, "travel has two numbers"),
        ("travel = [0, 1, 2]", 10, "travel has two numbers"),
        ("travel = [300, 0]", 10, "travel ends where it begins, or before"),
        ("travel = [5, 5]", 10, "travel ends where it begins, or before"),
        ("travel = [0, 1e12]", 14, "travel reaches over 2147483647 steps from zero"),
        ("travel = [-26e6, 26e6]", 10, "travel is over 2147483647 steps long"),
        ("travel = 300", 10, "a list in brackets"),
        ("travel = [0, \"x\"]", 14, "expected a number"),
    ] {
        let error = read(&text("", travel, HOME)).unwrap_err();
        assert!(error.message.contains(says), "wanted {says}, found {error}");
        assert_eq!(error.line_column(), Some((10, column)), "{travel}: {error}");
    }
    for (travel, drop, says) in [
        ("", "move_off = 5, ", "the home table of axis 'x' has no move_off"),
        ("", "max_travel = 330, ", "the home table of axis 'x' has no max_travel"),
        ("travel = [0, 9]", "move_off = 5, max_travel = 330, ", "over half of the travel"),
    ] {
        let error = read(&text("", travel, &HOME.replace(drop, ""))).unwrap_err();
        assert!(error.message.contains(says), "wanted {says}, found {error}");
        assert_eq!(error.line_column(), Some((11, 8)), "{error}");
    }
}

#[test]
fn approach_is_at_most_a_step_per_sample_of_the_limit() {
    let with = |guard: &str| read(&format!("{}[machine.guard]\n{guard}\n", text("", "", HOME)));
    let error = with("limits = \"none\"").unwrap_err();
    assert!(error.message.contains("axis 'x' has no limit switch to home with"), "{error}");
    assert_eq!(error.line_column(), Some((11, 8)));
    assert!(with("limits = \"one\"").is_ok());
    // 160 steps/s make a step in 6.25 ms. A watchdog of 4 s needs rounds of 1024 us, the longest
    // possible.
    assert!(with("watchdog_ms = 4000").is_ok());
    let fast = HOME.replace("slow_speed = 2", "slow_speed = 15");
    let slow_samples = format!("{}[machine.guard]\nwatchdog_ms = 4000\n", text("", "", &fast));
    let error = read(&slow_samples).unwrap_err();
    assert!(
        error.message.contains("slow_speed is over a step between two samples of the switch"),
        "{error}"
    );
    assert_eq!(error.line_column(), Some((11, fast.find("15").unwrap() + 1)));
    assert!(read(&text("", "", &fast)).is_ok(), "the usual round is 32 us");
}
