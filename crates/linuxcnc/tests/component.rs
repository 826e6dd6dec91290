//! The component without HAL and thread against the models of engine and link, in simulated time: the
//! pulses follow the commands, position-fb has no part of the queue's delay, and whatever is wrong
//! is a named fault with all joints disabled and a true position.
#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches unit tests only")]

mod support;

use carrystep_virtual_board::{SimulatedBoard as _, Switches};
use support::world::{JOINTS, Line, PERIOD, SCALE, World, fault, long, wave};

/// A test of each line.
fn over_both(test: impl Fn(Line)) {
    [Line::Uart, Line::Spi].into_iter().for_each(test);
}

#[test]
fn pulses_follow_the_commands_and_feedback_is_not_late() {
    over_both(|line| {
        for periods in [1, 4, 8] {
            let mut world = World::ready(line, periods);
            let mut least = i64::MAX;
            for (number, turns) in [(0, 1.0), (1, 3.0)] {
                let from = world.command;
                world.follow(1000, |time| {
                    let angle = std::f64::consts::TAU * turns * (10.0 * wave(time / 10.0) / 25.0);
                    let way = 10.0 * wave(time / 10.0) * 1.234_56;
                    [from[0] + way, from[1] + 3.0 * angle.sin(), from[2] - way / 7.0]
                });
                world.rest();
                assert!(world.says.reserve_ns <= world.says.lead_ns);
                least = least.min(world.says.reserve_ns);
                for joint in 0..JOINTS {
                    let wanted = (world.command[joint] * SCALE + 0.5).floor() as i32;
                    assert_eq!(world.board.position(joint), wanted, "joint {joint}, move {number}");
                }
                // Switched off and on again: nothing moves.
                let before: Vec<i32> =
                    (0..JOINTS).map(|joint| world.board.position(joint)).collect();
                world.off(60);
                let after: Vec<i32> =
                    (0..JOINTS).map(|joint| world.board.position(joint)).collect();
                assert_eq!(before, after);
                assert_eq!((world.says.fault, world.says.disabled), (0, false));
                world.positions_are_those_of_the_board();
            }
            assert!((25_000_000..60_000_000).contains(&least), "{least} ns");
            assert_eq!((world.board.discarded(0), world.board.fault()), (Some(0), None));
            world.bench.end();
        }
    });
}

#[test]
fn switching_off_in_motion_ramps_down_and_position_stays_true() {
    over_both(|line| {
        let mut world = World::ready(line, 4);
        world.follow(300, long);
        world.servo(false);
        // The ramps take their time: until then the joints cannot be enabled.
        world.fails(fault::NOT_READY, 2);
        world.recovers();
        world.bench.end();
    });
}

#[test]
fn bad_commands_are_faults_by_name() {
    over_both(|line| {
        for (command, wanted) in [
            (f64::NAN, fault::NOT_A_NUMBER),
            (f64::INFINITY, fault::NOT_A_NUMBER),
            (1e200, fault::OUT_OF_RANGE),
            (30.0, fault::JUMP),
        ] {
            let mut world = World::ready(line, 4);
            world.follow(300, long);
            world.command[0] = command;
            world.fails(wanted, 1);
            assert_eq!(world.says.culprits, 1, "{:?}", world.says);
            world.recovers();
            world.bench.end();
        }
    });
}

#[test]
fn period_or_scale_that_changes_is_a_fault() {
    over_both(|line| {
        for wanted in [fault::PERIOD, fault::SCALE] {
            let mut world = World::ready(line, 4);
            world.follow(300, long);
            if wanted == fault::PERIOD {
                world.period = 1_100_000;
            } else {
                world.bench.say("scale");
            }
            world.fails(wanted, 1);
            world.period = PERIOD;
            world.until(1500, |world| {
                world.command = world.says.feedback;
                !world.servo(false).disabled
            });
            world.bench.end();
        }
    });
}

#[test]
fn servo_thread_that_is_late_by_less_than_the_horizon_changes_nothing() {
    over_both(|line| {
        let mut world = World::ready(line, 4);
        world.follow(300, long);
        // 25 ms without a period, which the thread then makes up for at once.
        (0..25).for_each(|_| world.pass());
        for late in 1..=25 {
            world.command = long(0.3 + f64::from(late) / 1000.0);
            assert_eq!(world.servo(true).fault, 0);
        }
        let from = world.command;
        world.follow(400, |time| [from[0] + 24.98 * time.min(0.2), 0.0, 0.0]);
        world.rest();
        let wanted = (world.command[0] * SCALE + 0.5).floor() as i32;
        assert_eq!((world.board.position(0), world.board.stops().len()), (wanted, 1));
        world.bench.end();
    });
}

#[test]
fn servo_thread_that_is_later_is_an_underrun() {
    over_both(|line| {
        let mut world = World::ready(line, 4);
        world.follow(300, long);
        (0..80).for_each(|_| world.pass());
        world.command = long(0.301);
        world.fails(fault::UNDERRUN, 1);
        world.recovers();
        world.bench.end();
    });
}

#[test]
fn stops_of_the_board_disable_the_joints_until_they_are_over() {
    over_both(|line| {
        let mut world = World::ready(line, 4);
        world.follow(300, long);
        world.board.press(Switches { estop: true, ..Switches::default() });
        world.fails(fault::ESTOP, 20);
        for _ in 0..100 {
            world.command = world.says.feedback;
            world.servo(false);
            world.pass();
            assert!(world.says.disabled, "the e-stop is still pressed");
        }
        world.board.press(Switches::default());
        world.recovers();
        // Also at rest.
        world.off(10);
        world.board.press(Switches { estop: true, ..Switches::default() });
        world.until(100, |world| world.servo(false).fault == fault::ESTOP);
        world.board.press(Switches::default());
        world.recovers();
        // A stop by another program, which needs no session.
        let from = world.command;
        world.follow(200, |time| from.map(|from| from + time));
        for byte in stop_frame() {
            world.board.say(byte);
        }
        world.fails(fault::STOP, 30);
        world.recovers();
        world.bench.end();
    });
}

/// STOP of a host without a session (docs/protocol.md).
fn stop_frame() -> Vec<u8> {
    frame(&[0, 0xa6, 0, 0, 0, 0, 0, 0])
}

/// OPEN with force by another host.
fn open_frame() -> Vec<u8> {
    frame(&[0, 0xa5, 9, 9, 1, 0, 0, 0])
}

fn frame(content: &[u8]) -> Vec<u8> {
    let mut crc = u32::MAX;
    for &byte in content {
        crc ^= u32::from(byte);
        for _ in 0..8 {
            crc = crc >> 1 ^ if crc & 1 == 1 { 0xedb8_8320 } else { 0 };
        }
    }
    let mut line = vec![0xc0];
    for byte in content.iter().copied().chain((!crc).to_le_bytes()) {
        match byte {
            0xc0 => line.extend([0xdb, 0xdc]),
            0xdb => line.extend([0xdb, 0xdd]),
            byte => line.push(byte),
        }
    }
    line.push(0xc0);
    line
}

#[test]
fn cable_that_is_pulled_disables_the_joints() {
    over_both(|line| {
        let mut world = World::ready(line, 4);
        world.follow(300, long);
        world.cable = false;
        // Nothing comes any more: the board stops by its watchdog or by an empty queue, and the
        // component says so when it has waited for an answer.
        world.fails(fault::NO_ANSWER, 550);
        world.off(100);
        assert!(world.board.rests());
        assert_eq!((world.says.fault, world.says.disabled), (fault::NO_ANSWER, true));
        // The cable is back.
        world.cable = true;
        assert_eq!(world.bench.say("again"), "ok");
        world.recovers();
        world.bench.end();
    });
}

#[test]
fn spidev_that_goes_away_disables_the_joints() {
    let mut world = World::ready(Line::Spi, 4);
    world.follow(300, long);
    world.device = false;
    world.fails(fault::NO_PORT, 5);
    world.off(400);
    assert!(world.board.rests());
    assert_eq!((world.says.fault, world.says.disabled), (fault::NO_PORT, true));
    world.device = true;
    assert_eq!(world.bench.say("again"), "ok");
    world.recovers();
    world.bench.end();
}

#[test]
fn another_program_that_takes_the_board_is_named() {
    over_both(|line| {
        let mut world = World::ready(line, 4);
        world.off(20);
        for byte in open_frame() {
            world.board.say(byte);
        }
        world.until(200, |world| world.servo(false).fault != 0);
        assert_eq!(world.says.fault, fault::SESSION);
        world.bench.end();
    });
}

#[test]
fn another_build_is_refused_before_anything_is_written() {
    over_both(|line| {
        let mut world = World::new(line, 4, 0x1234);
        world.until(1000, |world| world.servo(false).fault == fault::OTHER_BOARD);
        assert_eq!(world.servo(true).fault, fault::OTHER_BOARD);
        assert!(world.says.disabled);
        assert_eq!(world.board.stops().len(), 0);
        world.bench.end();
    });
}
