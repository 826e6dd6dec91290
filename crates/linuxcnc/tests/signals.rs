//! What is not a position command: outputs that switch with the motion, a probe, index pulses and
//! home switches whose place LinuxCNC takes from the feedback.
#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches unit tests only")]

mod support;

use carrystep_core::EngineBuild;
use carrystep_core::engine::{InputRow, Latch, LatchSource, LimitWiring, Outputs};
use carrystep_virtual_board::{SimulatedBoard as _, Switches};
use support::world::{JOINTS, MS, SCALE, World, build, fault, long};

/// Bit of INPUTS: the probe.
const PROBE: u32 = 1 << 16;
/// Bit of INPUTS: the general input in-1-0.
const GENERAL: u32 = 1 << 17;
/// Speed of `long`, steps per ms.
const SPEED: f64 = 2.5;
/// Where inputs become active, steps.
const EDGE: i32 = 400;

/// A board with a probe and a general input, and with these latches.
fn with(latches: Vec<Latch>) -> EngineBuild {
    let mut build = build();
    build.guard.limits = LimitWiring::None;
    build.guard.inputs = [InputRow { exist: 0b011, low: 0 }, InputRow::default()];
    build.guard.latches = latches;
    build.check().unwrap();
    build
}

fn at_probe() -> Latch {
    Latch { source: LatchSource::Switch { row: 2, axis: 0 }, low: false, looks: 1 }
}

fn probe(closed: bool) -> Switches {
    Switches { inputs: [u8::from(closed), 0], ..Switches::default() }
}

fn general(closed: bool) -> Switches {
    Switches { inputs: [u8::from(closed) << 1, 0], ..Switches::default() }
}

fn index(seen: bool) -> Switches {
    Switches { latch: u8::from(seen), ..Switches::default() }
}

impl World {
    fn asks(&mut self, homing: u32, index: u32, levels: u32, duty: f64) {
        let words = format!("asks {homing} {index} {levels} {duty:?}");
        assert_eq!(self.bench.say(&words), "ok");
    }

    /// Follows `place` until `done`. In that period the feedback is returned, in steps; in all
    /// others it must be the command.
    fn watched(
        &mut self,
        most_ms: u32,
        place: impl Fn(f64) -> [f64; JOINTS],
        done: impl Fn(&World) -> bool,
    ) -> [f64; JOINTS] {
        for period in 1..=most_ms {
            self.command = place(f64::from(period) / 1000.0);
            let says = self.servo(true);
            assert_eq!((says.fault, says.running), (0, true), "in period {period}");
            self.pass();
            if done(self) {
                return says.feedback.map(|units| units * SCALE);
            }
            for joint in 0..JOINTS {
                assert!(
                    (says.feedback[joint] - self.command[joint]).abs() < 1e-6,
                    "in period {period}"
                );
            }
        }
        panic!("not within {most_ms} ms: {:?}", self.says);
    }

    /// Goes on from the place of the command for 20 ms, in which the feedback is the command, and
    /// rests.
    fn goes_on(&mut self, per_ms: f64) {
        let from = self.command;
        self.follow(20, |time| [from[0] + time * 1000.0 * per_ms, from[1], from[2]]);
        let from = self.command;
        // The ramp of a tenth of a second.
        self.follow(100, |time| {
            [from[0] + 1000.0 * per_ms * (time - time * time / 0.2), from[1], from[2]]
        });
        self.rest();
    }
}

/// From rest at `from`, backward, as `long` runs forward.
fn back(from: f64) -> impl Fn(f64) -> [f64; JOINTS] {
    move |time| [from - long(time)[0], 0.0, 0.0]
}

/// The edge lies half a step before the pulse that shows it, and is seen up to 10 us later.
fn is_the_edge(found: f64, edge: i32) {
    let off = found - (f64::from(edge) - 0.5);
    assert!((-0.02..0.1).contains(&off), "{found}: {off} steps off");
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
fn index_enable_falls_with_the_place_of_the_pulse() {
    for latches in [vec![Latch::of_pin(false, 1)], vec![Latch::of_pin(false, 1), at_probe()]] {
        let probes = latches.len() - 1;
        let has = if probes == 0 { "0 0 255 0" } else { "0 0 1 0" };
        let mut world = World::with(4, 0, &with(latches), has).made_ready();
        // A pulse of 2 steps every 200 steps.
        world.inputs = Some(|_, position| index(position.rem_euclid(200) < 2 && position > 10));
        // Pulses that nobody waits for change nothing.
        let command = std::cell::Cell::new(0);
        let found = world.watched(400, long, |_| {
            command.set(command.get() + 1);
            command.get() == 250
        });
        assert!((found[0] - world.command[0] * SCALE).abs() < 1e-6);
        let from = world.command[0];
        world.asks(0, 1, 0, 0.0);
        let on = |time: f64| [from + 25.0 * time, 0.0, 0.0];
        let found = world.watched(400, on, |world| world.says.index == 0);
        let edge = (found[0] / 200.0).round() as i32 * 200;
        is_the_edge(found[0], edge);
        world.goes_on(SPEED / SCALE);
        world.bench.end();
    }
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
