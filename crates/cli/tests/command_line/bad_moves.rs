//! Malformed moves and impossible moves: the refusal names the limit and a value that works.

use crate::command::{Folder, GOOD, all_refused};

#[test]
fn malformed_moves_are_refused() {
    all_refused(&[
        (
            "profile = \"ranade\"",
            "profile = \"ranade\"\n^too = 1",
            "unknown field `too`, expected one of `profile`, `path`, `time`, `fit_ns`, `to`",
        ),
        ("[[move]]\nprofile = \"ranade\"", "^[[move]]", "missing field `profile`"),
        (
            "[[move]]\nprofile = \"ranade\"\nto = { x = 2 }",
            "^[[move]]\nprofile = \"ranade\"",
            "missing field `to`",
        ),
        (
            "\"ranade\"",
            "^\"fast\"",
            "unknown variant `fast`, expected one of `ranade`, `trapezoid`, ",
        ),
        ("{ x = 2 }", "^[2]", "expected distances, as in { x = 1.5 }"),
        ("{ x = 2 }", "{ x = ^\"2\" }", "string \"2\", expected a number"),
        ("{ x = 2 }", "{ x = 2, ^q = 1 }", "the machine has no axis \"q\""),
        ("{ x = 2 }", "{ x = 2, ^q = 1 }", "its axes are x"),
        ("{ x = 2 }", "{ x = ^nan }", "x = nan: not a usable number"),
        ("{ x = 2 }", "{ x = ^-inf }", "x = -inf: not a usable number"),
        ("{ x = 2 }", "{ x = ^1e999999999 }", "the number is too great"),
        ("{ x = 2 }", "{ x = ^1e-999999999 }", "not a usable number"),
        ("time = 0.05", "time = ^nan", "time = nan: not a usable number"),
        ("time = 0.05", "time = ^0", "time = 0: must be over zero"),
        ("time = 0.05", "time = ^-0.5", "time = -0.5: must be over zero"),
        ("time = 0.05", "time = ^1000001", "time = 1000001 s: a move takes at most 10^6 s"),
        ("time = 0.05", "time = ^\"soon\"", "string \"soon\", expected a number"),
        ("time = 0.05", "fit_ns = ^0", "fit_ns = 0: no fit is without an error"),
        ("time = 0.05", "fit_ns = ^-1", "integer `-1`, expected"),
        (
            "time = 0.05",
            "path = ^\"crooked\"",
            "unknown variant `crooked`, expected `free` or `straight`",
        ),
        ("\"ranade\"", "^\"scurve\"", "axis \"x\" has no jerk_limit"),
    ]);
}

/// The refusal states the limit and the least time that works, and that time must work.
#[test]
fn curves_in_too_short_a_time_are_refused_with_a_time_that_works() {
    let jerk = GOOD.replace("driver =", "jerk_limit = 40_000\ndriver =");
    for (profile, limit) in
        [("sine", "accel_limit"), ("logistic", "accel_limit"), ("scurve", "accel_limit")]
    {
        let timed =
            |time: &str| jerk.replace("\"ranade\"", &format!("\"{profile}\"\ntime = {time}"));
        let ran = Folder::with_move(timed("0.001")).run("plan move.toml");
        ran.refuses(&format!("over {limit} 5000 units/s^2 (25000 steps/s^2); at least "));
        let least =
            ran.stderr.split("at least ").nth(1).and_then(|rest| rest.split(' ').next()).unwrap();
        assert_eq!(
            Folder::with_move(timed(least)).run("plan move.toml").status,
            0,
            "{profile} in {least} s"
        );
    }
}

#[test]
fn distances_beyond_the_position_register_are_refused() {
    all_refused(&[
        (
            "x = 2 ",
            "x = ^429496730 ",
            "axis 'x' would stand at 429496730 units (2147483650 steps), beyond its register",
        ),
        ("x = 2 ", "x = ^-429496730 ", "would stand at -429496730 units (-2147483650 steps)"),
        ("x = 2 ", "x = ^1e29 ", "beyond its register"),
        (
            "x = 2 ",
            "x = ^1e29 ",
            "the sum of all moves must stay within +-429496729 units (2147483647 steps) of the start",
        ),
        // Each move fits, but their sum does not.
        ("x = -1.3", "x = ^429496728", "would stand at 429496730 units"),
    ]);
}

#[test]
fn file_without_a_machine_or_moves_is_refused() {
    let moves = &GOOD[GOOD.find("[[move]]").unwrap()..];
    let machine = &GOOD[..GOOD.find("[[move]]").unwrap()];
    Folder::with_move(moves).run("plan move.toml").refuses_at("move.toml", (1, 1), "no machine");
    Folder::with_move(machine).run("plan move.toml").refuses_at("move.toml", (1, 1), "no moves");
}

#[test]
fn times_that_are_too_short_name_the_limit_and_the_least_time() {
    all_refused(&[
        (
            "[[move]]\nprofile = \"ranade\"",
            "^[[move]]\nprofile = \"ranade\"\ntime = 0.001",
            "move 1, axis x: needs 2000 units/s (10000 steps/s), over speed_limit 1000 units/s (5000 steps/s); at least 0.00944",
        ),
        (
            "[[move]]\nprofile = \"trapezoid\"\ntime = 0.05",
            "^[[move]]\nprofile = \"trapezoid\"\ntime = 0.01",
            "move 2, axis x: needs 48000 units/s^2 (240000 steps/s^2), over accel_limit 5000 units/s^2 (25000 steps/s^2); at least 0.0",
        ),
        (
            "[[move]]\nprofile = \"ranade\"",
            "^[[move]]\nprofile = \"constant\"\ntime = 0.001",
            "move 1, axis x: needs 2000 units/s (10000 steps/s), over start_speed 200 units/s (1000 steps/s); at least 0.01 s would do",
        ),
    ]);
    let (rest, times) =
        (GOOD.replace("start_speed = 200", "start_speed = 0"), "profile = \"constant\"\ntime = 1");
    let ran =
        Folder::with_move(rest.replacen("profile = \"ranade\"", times, 1)).run("plan move.toml");
    ran.refuses_at(
        "move.toml",
        (15, 1),
        "needs a start_speed over 0 units/s (0 steps/s); raise it, or take another profile",
    );
}

#[test]
fn phase_zero_needs_whole_ticks() {
    let zero = GOOD.replace("\"half\"", "\"zero\"").replace("time = 0.05", "time = 0.0412345678");
    let ran = Folder::with_move(zero).run("plan move.toml");
    let says = "move 2: time = 0.0412345678 s is not a whole number of ticks of 1000 ns, which phase = \"zero\" needs; \
                take 0.041235 s, or phase = \"half\"";
    ran.refuses_at("move.toml", (19, 1), says);
}

#[test]
fn moves_that_take_longer_than_any_capture_are_refused() {
    let machine = &GOOD[..GOOD.find("[[move]]").unwrap()];
    let move_of_days = "[[move]]\nprofile = \"ranade\"\ntime = 1e6\nto = { x = 20 }\n";
    let folder = Folder::with_move(format!("{machine}{}", move_of_days.repeat(5)));
    assert_eq!(folder.run("plan move.toml").status, 0);
    folder
        .run("simulate move.toml --vcd a.vcd")
        .refuses("a capture holds at most 4000000 s; split the file");
    folder.write("a.vcd", "");
    folder
        .run("check a.vcd move.toml")
        .refuses("a capture holds at most 4000000 s; split the file");

    let crawling = GOOD
        .replace("start_speed = 200", "")
        .replace("speed_limit = 1000", "speed_limit = 2e-4")
        .replace("to = { x = 2 }", "to = { x = 1e5 }");
    let says = "is over 2^42 ticks of 1000 ns; raise the limits that make it slow";
    Folder::with_move(crawling).run("plan move.toml").refuses_at("move.toml", (15, 1), says);
}
