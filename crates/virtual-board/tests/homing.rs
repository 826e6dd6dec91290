//! Homing from every start in each wiring, on boards of models and of exported Verilog. It must
//! find the place where the switch closes, twice the same, and must never overrun a closed switch
//! by more than the ramp requires.

use crate::asked::homing_of;
use crate::axes::{self, Bench, Make, Start, machine};
use crate::random::Random;
use crate::repeats;
use carrystep_core::engine::Cause;
use carrystep_files::Machine;
use carrystep_files::machine::{End, overrun};
use carrystep_link::{AxisHoming, Homed, HomingFault, HomingStage, HostError, Wish};
use carrystep_virtual_board::{ModelBoard, VerilatedBoard};

const WIRINGS: [&str; 3] = ["pair", "each", "one"];
const STARTS: [Start; 3] = [Start::Open, Start::Closed, Start::Bouncing];

/// A machine of two axes, one toward each end; the first axis homes alone.
fn two(limits: &str, stop: &str, level: &str) -> Machine {
    machine(&format!(
        r#"[machine]
clock_hz = 8_000_000
tick_ns = 4000
home_order = [["y"], ["x"]]
[machine.guard]
watchdog_ms = 60
enable_ms = 1
debounce_us = 400
limits = "{limits}"
limit_stop = "{stop}"
limit_level = "{level}"
[machine.link]
baud = 500_000
[[machine.axis]]
name = "x"
steps_per_unit = 10
speed_limit = 200
accel_limit = 4000
stop_accel = 8000
driver = "a4988"
travel = [0, 60]
home = {{ toward = "min", seek_speed = 150, slow_speed = 8, pull_off = 1, position = 0 }}
[[machine.axis]]
name = "y"
steps_per_unit = 4
start_speed = 10
speed_limit = 500
accel_limit = 10_000
driver = "a4988"
travel = [-150, 0]
home = {{ toward = "max", seek_speed = 300, slow_speed = 20, move_off = 15, max_travel = 220, pull_off = 3, position = -1 }}
"#
    ))
}

/// Homes, checks the result, and returns the positions at which the limits were accepted.
fn homes<B: Make>(bench: &Bench<B>, machine: &Machine, what: &str) -> Vec<i32> {
    let mut host = bench.connect(machine);
    host.enable().unwrap();
    let homing = homing_of(machine);
    let mut stage = HomingStage::MoveOff;
    let homed = host.home(&homing.as_homing(), |_, now, _| {
        stage = now;
        Wish::GoOn
    });
    let homed =
        homed.unwrap_or_else(|error| panic!("{what}: {error}, while it {stage}; {machine:?}"));
    let Homed::At(edges) = homed else { panic!("{what}: stopped") };
    let answer = host.read_status().unwrap().answer;
    assert!(answer.idle && !answer.fault && answer.seeking == 0, "{what}: {answer:?}");
    let guard = &machine.guard;
    for (number, axis) in machine.axes.iter().enumerate() {
        let Some(home) = axis.home else { continue };
        let (sign, edge) = (if home.toward == End::Max { 1 } else { -1 }, edges[number]);
        let switch = bench.edge(number);
        // The limit is accepted behind the place where it closes, at most by the distance at the
        // slow speed until then.
        let ticks = u128::from(guard.debounce) * u128::from(guard.round)
            + 4
            + u128::from(bench.slice_ticks());
        let late = ((u128::from(home.slow) * ticks) >> 64) as i32;
        let beyond = (edge - switch) * sign;
        assert!(
            (0..=late + 1).contains(&beyond),
            "{what}: axis {number} at {edge}, its switch at {switch}, {late} late"
        );
        assert_eq!(
            host.status().positions[number],
            edge - sign * home.pull_off as i32,
            "{what}: axis {number}"
        );
        // No pulse went deeper into the switch than the search overruns it, or than the axis stood
        // at the start.
        let ran = overrun(home.seek, axis.stop, guard)
            + 1
            + ((u128::from(home.seek) * u128::from(bench.slice_ticks())) >> 64) as u64;
        let (deepest, stood) = (bench.deepest(number), bench.stood(number));
        assert!(
            deepest <= (ran as i32).max(stood),
            "{what}: axis {number} is {deepest} in its switch, {ran} or {stood} are explained"
        );
    }
    edges[..machine.axes.len()].to_vec()
}

/// Homes from these starts, as often as this kind of board does, and finds the same places each
/// time.
fn homes_to_the_same<B: Make>(machine: &Machine, starts: &[Start], seed: u64) {
    let what = format!("{:?}, {starts:?}, seed {seed}", machine.guard.limits);
    let bench = Bench::<B>::new(machine, starts, seed);
    let first = homes(&bench, machine, &what);
    for _ in 1..B::homes() {
        let second = homes(&bench, machine, &format!("{what}, again"));
        for (first, second) in first.iter().zip(&second) {
            assert!(first.abs_diff(*second) <= 1, "{what}: {first}, then {second}");
        }
    }
}

/// An ordinary test run takes for every two starts one wiring and one kind of stop, in turn; the
/// long run of repeats takes all.
#[test]
fn model_homes_from_every_start_in_each_wiring() {
    let stops = [("ramp", "high"), ("freeze", "low")];
    let starts = STARTS.into_iter().flat_map(|x| STARTS.map(|y| [x, y]));
    for (number, starts) in starts.enumerate() {
        let (wirings, stops) = match repeats::in_full() {
            true => (&WIRINGS[..], &stops[..]),
            false => (&WIRINGS[number % 3..][..1], &stops[number / 3 % 2..][..1]),
        };
        for limits in wirings {
            for (stop, level) in stops {
                homes_to_the_same::<ModelBoard>(&two(limits, stop, level), &starts, 1);
            }
        }
    }
}

#[test]
fn verilog_homes_in_each_wiring() {
    for (limits, stop, starts) in [
        ("pair", "freeze", [Start::Closed, Start::Bouncing]),
        ("each", "freeze", [Start::Closed, Start::Open]),
        ("one", "ramp", [Start::Bouncing, Start::Closed]),
    ] {
        homes_to_the_same::<VerilatedBoard>(&two(limits, stop, "high"), &starts, 2);
    }
}

/// A machine with random figures that the reader accepts.
fn random_machine(random: &mut Random, limits: &str) -> Machine {
    loop {
        let axis = |random: &mut Random, name: &str| {
            let mut between = |least: u64, most: u64| least + random.below(most - least + 1);
            let (unit, speed) = (between(1, 40), between(500, 6000));
            let (accel, stop) = (between(4000, 100_000), between(6000, 200_000));
            let (toward, position) =
                if between(0, 1) == 0 { ("min", 0) } else { ("max", 400 / unit) };
            let [speed_, seek, slow, start] =
                [speed, between(300, speed), between(50, 300), between(0, 200)]
                    .map(|steps| steps as f64 / unit as f64);
            let [accel_, stop_] = [accel, stop].map(|steps| steps as f64 / unit as f64);
            let pull_off = between(3, 40) as f64 / unit as f64;
            format!(
                "[[machine.axis]]\nname = \"{name}\"\nsteps_per_unit = {unit}\nstart_speed = {start:?}\nspeed_limit = {speed_:?}\n\
                 accel_limit = {accel_:?}\nstop_accel = {stop_:?}\ndriver = \"a4988\"\ntravel = [0, {}]\nhome = {{ toward = \
                 \"{toward}\", seek_speed = {seek:?}, slow_speed = {slow:?}, pull_off = {pull_off:?}, position = {position} }}\n",
                400 / unit
            )
        };
        let (watchdog, debounce) = (20 + random.below(100), random.below(1500));
        let stop = if random.below(2) == 0 { "ramp" } else { "freeze" };
        let level = if random.below(2) == 0 { "high" } else { "low" };
        let second = if random.below(2) == 0 { String::new() } else { axis(random, "y") };
        let text = format!(
            "[machine]\nclock_hz = 8_000_000\ntick_ns = 4000\n[machine.guard]\nwatchdog_ms = {watchdog}\ndebounce_us = {debounce}\n\
             limits = \"{limits}\"\nlimit_stop = \"{stop}\"\nlimit_level = \"{level}\"\n[machine.link]\nbaud = 500_000\n{}{second}",
            axis(random, "x")
        );
        if let Ok(machine) = axes::read(&text) {
            return machine;
        }
    }
}

/// Runs the random machines whose number modulo the number of wirings is `rest`, so that the
/// wirings run in parallel.
fn random_machines(limits: &str, rest: u64) {
    let machines =
        std::env::var("CARRYSTEP_HOMING_MACHINES").map_or(30, |text| text.parse().unwrap());
    for seed in (rest..machines).step_by(3) {
        let mut random = Random::new(seed);
        let machine = random_machine(&mut random, limits);
        let starts: Vec<Start> =
            machine.axes.iter().map(|_| STARTS[random.below(3) as usize]).collect();
        homes_to_the_same::<ModelBoard>(&machine, &starts, seed);
    }
}

#[test]
fn random_machines_home_with_a_switch_at_each_end() {
    random_machines("pair", 0);
}

#[test]
fn random_machines_home_with_one_input_per_axis() {
    random_machines("each", 1);
}

#[test]
fn random_machines_home_with_one_input_for_all() {
    random_machines("one", 2);
}

/// The error of homing with the switches changed by `change`, and the final positions. All switches
/// are open at the start.
fn fails(
    limits: &str,
    change: impl FnOnce(&Bench<ModelBoard>),
) -> (HostError<axes::Never>, [i32; 2]) {
    fails_from(limits, Start::Open, change)
}

/// The same with another start of the axis y.
fn fails_from(
    limits: &str,
    start: Start,
    change: impl FnOnce(&Bench<ModelBoard>),
) -> (HostError<axes::Never>, [i32; 2]) {
    let machine = two(limits, "ramp", "high");
    let bench = Bench::<ModelBoard>::new(&machine, &[Start::Open, start], 3);
    change(&bench);
    let mut host = bench.connect(&machine);
    host.enable().unwrap();
    let homing = homing_of(&machine);
    let error = host.home(&homing.as_homing(), |_, _, _| Wish::GoOn).unwrap_err();
    let answer = host.read_status().unwrap().answer;
    assert_eq!(answer.seeking, 0, "no axis waits for a limit behind the error");
    (error, [0, 1].map(|axis| host.status().positions[axis]))
}

#[test]
fn missing_switch_is_named_and_no_axis_exceeds_max_travel() {
    for limits in ["pair", "each", "one"] {
        let (error, [x, y]) = fails(limits, |bench| bench.remove(1));
        assert_eq!(error, HostError::Homing { axes: 2, why: HomingFault::NotFound }, "{limits}");
        // 220 units of 4 steps each toward the switch. With one input for all, both axes have moved
        // off before, y by 15 units.
        let moved_off = two(limits, "ramp", "high").axes[0].home.unwrap().move_off as i32;
        let one = limits == "one";
        let places = (if one { moved_off } else { 0 }, (220 - if one { 15 } else { 0 }) * 4);
        assert_eq!((x, y), places, "{limits}");
    }
}

#[test]
fn switch_that_stays_closed_is_detected_before_the_search() {
    for (limits, axes) in [("pair", 2), ("each", 2), ("one", 3)] {
        let (error, [x, y]) = fails(limits, |bench| bench.stick(1));
        assert_eq!(error, HostError::Homing { axes, why: HomingFault::StillClosed }, "{limits}");
        // With one input for all, x moves off too.
        let moved_off = two(limits, "ramp", "high").axes[0].home.unwrap().move_off as i32;
        assert_eq!((x, y), (if limits == "one" { moved_off } else { 0 }, -15 * 4), "{limits}");
    }
}

#[test]
fn limit_that_closes_while_moving_away_is_an_error_except_at_the_far_end() {
    // The axis stands on its home switch and moves away from it. With one input for all, every
    // moving axis has met the limit.
    for (limits, axes) in [("each", 2), ("one", 3)] {
        let (error, _) = fails_from(limits, Start::Closed, |bench| bench.far(1, -40));
        assert_eq!(error, HostError::Homing { axes, why: HomingFault::Closed }, "{limits}");
    }
    let machine = two("pair", "freeze", "high");
    let bench = Bench::<ModelBoard>::new(&machine, &[Start::Open, Start::Open], 3);
    bench.far(1, -20);
    homes(&bench, &machine, "near the far end");
}

#[test]
fn estop_and_stop_request_end_homing() {
    for stage in [
        HomingStage::MoveOff,
        HomingStage::Seek,
        HomingStage::BackOff,
        HomingStage::Approach,
        HomingStage::PullOff,
    ] {
        let machine = two("each", "ramp", "high");
        let bench = Bench::<ModelBoard>::new(&machine, &[Start::Open, Start::Closed], 4);
        let mut host = bench.connect(&machine);
        host.enable().unwrap();
        let homing = homing_of(&machine);
        let stopped =
            host.home(
                &homing.as_homing(),
                |_, now, _| if now == stage { Wish::Stop } else { Wish::GoOn },
            );
        assert_eq!(stopped, Ok(Homed::Stopped), "{stage}");
        let answer = host.read_status().unwrap().answer;
        assert_eq!((answer.cause_name(), answer.seeking), (Some("stop"), 0), "{stage}");
        host.clear().unwrap();
        let pressed = host.home(&homing.as_homing(), |_, now, _| {
            if now == stage {
                bench.press_estop(true);
            }
            Wish::GoOn
        });
        assert_eq!(
            pressed,
            Err(HostError::Fault { cause: Cause::EStop as u8, culprits: 0 }),
            "{stage}"
        );
        assert_eq!(host.read_status().unwrap().answer.seeking, 0, "{stage}");
        bench.press_estop(false);
        host.clear().unwrap();
        homes(&bench, &machine, "after stops");
    }
}

#[test]
fn homing_that_cannot_succeed_is_refused_before_any_motion() {
    let machine = two("pair", "ramp", "high");
    let bench = Bench::<ModelBoard>::new(&machine, &[Start::Open, Start::Open], 5);
    let mut host = bench.connect(&machine);
    host.enable().unwrap();
    let homing = homing_of(&machine);
    let mut third = homing.as_homing();
    third.axes[5] = third.axes[0];
    third.groups = &[32];
    assert!(matches!(host.home(&third, |_, _, _| Wish::GoOn), Err(HostError::Program(_))));
    let mut slow = homing.as_homing();
    slow.axes[0] = slow.axes[0].map(|axis| AxisHoming { slow: 1, ..axis });
    let error = host.home(&slow, |_, _, _| Wish::GoOn).unwrap_err();
    assert!(
        matches!(error, HostError::Homing { axes: 1, why: HomingFault::TooLong(_) }),
        "{error}"
    );
    assert!(bench.board().loads().is_empty());
}
