//! Index pulses: index-enable falls with the place of the pulse, and the axis follows the command,
//! which LinuxCNC then sets to this place.
#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches unit tests only")]

mod support;

use carrystep_core::engine::Latch;
use carrystep_virtual_board::{SimulatedBoard as _, Switches};
use support::signals::{EDGE, SPEED, at_probe, is_the_edge, with};
use support::world::{SCALE, World, fault, long};

fn index(seen: bool) -> Switches {
    Switches { latch: u8::from(seen), ..Switches::default() }
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

/// LinuxCNC sets its command to the place of the pulse in the period behind that in which
/// index-enable falls; by then the axis is commanded to be some 0.15 s further on.
#[test]
fn axis_returns_smoothly_to_a_command_that_jumps_to_an_index_pulse() {
    for jumps_elsewhere in [false, true] {
        let latches = vec![Latch::of_pin(false, 1)];
        let mut world = World::with(4, 0, &with(latches), "0 0 255 0").made_ready();
        world.inputs = Some(|_, position| index((EDGE..EDGE + 2).contains(&position)));
        world.asks(0, 1, 0, 0.0);
        let found = world.watched(600, long, |world| world.says.index == 0)[0];
        let ahead = world.command[0] * SCALE - found;
        assert!(ahead > 40.0 * SPEED, "{ahead} steps");
        if jumps_elsewhere {
            world.command[0] = (found - 2.0 * ahead) / SCALE;
            world.fails(fault::JUMP, 1);
            world.bench.end();
            continue;
        }
        let (mut last, mut speed) = (found + ahead, SPEED);
        for period in 0..1200 {
            world.command[0] = found / SCALE;
            let says = world.servo(true);
            assert_eq!((says.fault, says.running), (0, true));
            let place = says.feedback[0] * SCALE;
            // It goes on with its speed for a period. LinuxCNC stops within one, and the return begins
            // at rest; from there on the speed changes by the return alone.
            let wanted = match period {
                0 => SPEED,
                1 => 0.0,
                _ => speed,
            };
            let off = place - last - wanted;
            assert!(off.abs() < if period == 0 { 1e-6 } else { 0.01 }, "period {period}: {off}");
            (speed, last) = (place - last, place);
            world.pass();
        }
        assert!((last - found).abs() < 1e-6, "{last}, {found}");
        assert_eq!(world.board.position(0), (found + 0.5).floor() as i32);
        assert_eq!(world.board.fault(), None);
        world.bench.end();
    }
}
