//! What is not a position command: outputs that switch with the motion, a probe and home switches
//! whose place LinuxCNC takes from the feedback.
#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches unit tests only")]

mod support;

use carrystep_core::engine::Outputs;
use carrystep_virtual_board::{SimulatedBoard as _, Switches};
use support::signals::{EDGE, SPEED, at_probe, is_the_edge, with};
use support::world::{JOINTS, MS, SCALE, World, build, fault, long};

/// Bit of INPUTS: the probe.
const PROBE: u32 = 1 << 16;
/// Bit of INPUTS: the general input in-1-0.
const GENERAL: u32 = 1 << 17;
fn probe(closed: bool) -> Switches {
    Switches { inputs: [u8::from(closed), 0], ..Switches::default() }
}

fn general(closed: bool) -> Switches {
    Switches { inputs: [u8::from(closed) << 1, 0], ..Switches::default() }
}

/// From rest at `from`, backward, as `long` runs forward.
fn back(from: f64) -> impl Fn(f64) -> [f64; JOINTS] {
    move |time| [from - long(time)[0], 0.0, 0.0]
}

#[test]
fn probe_is_shown_in_the_period_whose_feedback_is_the_place_of_the_edge() {
    let mut world = World::with(4, 0, &with(vec![at_probe()]), "0 0 0 255").made_ready();
    world.inputs = Some(|_, position| probe(position >= EDGE));
    for _ in 0..2 {
        let found = world.watched(600, long, |world| world.says.inputs & PROBE != 0);
        is_the_edge(found[0], EDGE);
        assert!((found[1].abs() < 1e-6) && (found[2].abs() < 1e-6));
        // The command was far ahead of it: this is what LinuxCNC must not take.
        assert!(world.command[0] * SCALE - found[0] > 40.0 * SPEED);
        world.goes_on(SPEED / SCALE);
        // Back off the probe. It is shown as open with the place of a snapshot.
        let from = world.command[0];
        let found = world.watched(900, back(from), |world| world.says.inputs & PROBE == 0);
        let off = f64::from(EDGE) - found[0];
        assert!((-1.0..20.0 * SPEED).contains(&off), "{found:?}");
        world.goes_on(-SPEED / SCALE);
        let home = world.command[0];
        world.follow(600, |time| [home * (1.0 - smooth(time / 0.6)), 0.0, 0.0]);
        world.rest();
    }
    world.bench.end();
}

fn smooth(u: f64) -> f64 {
    u * u * (3.0 - 2.0 * u)
}

/// A debounce time of 51 ms: five snapshots show the edge of a probe that is not closed yet.
#[test]
fn a_long_debounce_time_does_not_move_the_place_of_the_edge() {
    let mut build = with(vec![at_probe()]);
    build.guard.debounce = 25;
    let mut world = World::with(4, 0, &build, "0 0 0 255").made_ready();
    world.inputs = Some(|_, position| probe(position >= EDGE));
    let found = world.watched(700, long, |world| world.says.inputs & PROBE != 0);
    is_the_edge(found[0], EDGE);
    world.bench.end();
}

#[test]
fn an_edge_without_a_probe_behind_it_is_noise() {
    let mut world = World::with(4, 0, &with(vec![at_probe()]), "0 0 0 255").made_ready();
    // 20 us, far shorter than the debounce time.
    world.inputs = Some(|_, position| {
        probe(position >= EDGE || (100..102).contains(&position) && position % 2 == 0)
    });
    let found = world.watched(600, long, |world| world.says.inputs & PROBE != 0);
    is_the_edge(found[0], EDGE);
    world.goes_on(SPEED / SCALE);
    world.bench.end();
}

#[test]
fn probe_without_a_latch_has_the_place_of_a_snapshot() {
    let mut world = World::with(4, 0, &with(vec![]), "0 0 255 255").made_ready();
    world.inputs = Some(|_, position| probe(position >= EDGE));
    let found = world.watched(600, long, |world| world.says.inputs & PROBE != 0);
    let off = found[0] - f64::from(EDGE);
    // Between two snapshots, 10 ms; INPUTS is read up to some ms behind the place.
    assert!((-5.0 * SPEED..15.0 * SPEED).contains(&off), "{off} steps");
    world.goes_on(SPEED / SCALE);
    world.bench.end();
}

#[test]
fn home_switch_has_the_place_of_a_snapshot_and_only_for_the_joint_that_homes() {
    for homing in [0, 1] {
        let mut world = World::with(4, 0, &with(vec![]), "0 0 255 255").made_ready();
        world.inputs = Some(|_, position| general(position >= EDGE));
        world.asks(homing, 0, 0, 0.0);
        let to = |time: f64| [long(time)[0], long(time)[0] / 2.0, 0.0];
        let found = world.watched(600, to, |world| world.says.inputs & GENERAL != 0);
        let ahead = world.command[0] * SCALE - found[0];
        if homing == 1 {
            let off = found[0] - f64::from(EDGE);
            assert!((-5.0 * SPEED..15.0 * SPEED).contains(&off), "{off} steps");
        } else {
            assert!(ahead.abs() < 1e-6);
        }
        assert!((found[1] - world.command[1] * SCALE).abs() < 1e-6);
        world.bench.end();
    }
}

/// The board's outputs, and how long of 4096 cycles its PWM is on.
fn outputs(world: &mut World) -> (u8, u32) {
    let (levels, mut on) = (world.board.outputs().outputs, 0);
    for _ in 0..4096 {
        on += u32::from(world.board.outputs().pwm);
        let next = world.board.cycle() + 1;
        world.board.run(next, &mut ());
    }
    world.now += 1;
    let end = world.now * MS / 1000;
    while world.board.cycle() < end {
        world.board.run(end, &mut ());
    }
    (levels, on)
}

#[test]
fn outputs_switch_with_the_segment_of_their_period() {
    for periods in [1, 4] {
        let mut build = build();
        build.outputs = Outputs { exist: 0b101, pwm_divider: 1, off_at_ramps: true };
        let mut world = World::with(periods, 0, &build, "5 1 255 255").made_ready();
        world.follow(300, long);
        assert_eq!(world.board.outputs().outputs, 0);
        let asked = world.command[0] * SCALE;
        // Bit 1 does not exist: the engine would take it for a fault.
        world.asks(0, 0, 0b111, 0.25);
        let mut changed = None;
        for period in 1..=100 {
            world.command = long(0.3 + f64::from(period) / 1000.0);
            assert_eq!(world.servo(true).fault, 0);
            world.pass();
            if changed.is_none() && world.board.outputs().outputs != 0 {
                changed = Some(f64::from(world.board.position(0)));
            }
        }
        // Never before the motion with which they were commanded, and at most a segment and this
        // test's own period of 1 ms later.
        let late = changed.unwrap() - asked;
        let most = (f64::from(periods) + 1.0) * SPEED + 1.0;
        assert!((0.0..=most).contains(&late), "{late} steps, {periods} periods");
        let (levels, on) = outputs(&mut world);
        assert_eq!(levels, 0b101);
        assert_eq!(on, 1024);
        // A duty that is not one is the nearest one, or none.
        for (duty, wanted) in [(7.0, 4095), (-1.0, 0), (f64::NAN, 0), (0.5, 2048)] {
            world.asks(0, 0, 0b001, duty);
            let from = world.command;
            world.follow(60, |_| from);
            assert_eq!(outputs(&mut world), (0b001, wanted), "{duty}");
        }
        // Off with the joints.
        world.off(100);
        assert_eq!(outputs(&mut world), (0, 0));
        assert_eq!(world.says.fault, 0);
        world.bench.end();
    }
}

#[test]
fn outputs_that_the_board_does_not_have_are_a_named_fault() {
    let mut build = build();
    build.outputs = Outputs { exist: 0b001, pwm_divider: 0, off_at_ramps: true };
    let mut world = World::with(4, 0, &build, "3 0 255 255").made_ready();
    world.fails(fault::PROTOCOL, 100);
    world.bench.end();
}
