//! A host dies in the middle of a move. The board must stop within its watchdog's time and the
//! ramp, its positions must be exact, and the next host must continue without a restart.
//! `CARRYSTEP_DEATHS` sets the number of deaths.
#![allow(clippy::print_stderr, reason = "figures, for the page of longer runs")]

use crate::support::random::Random;
use crate::support::wire::Faults;
use crate::support::{
    BoardHost, CLOCK_HZ, End, FASTEST, Kind, MS, STOP, TICK, asked, build, waves,
};
use carrystep_core::AXES;
use carrystep_core::engine::Cause;
use carrystep_core::link::Uart;
use carrystep_link::{Ended, HostError, Program, Wish};
use carrystep_virtual_board::{ModelBoard, VerilatedBoard};

#[test]
fn the_board_stops_when_its_host_dies_and_another_host_continues() {
    hosts_die::<ModelBoard>(asked("CARRYSTEP_DEATHS", 4), 700, Faults::BAD);
}

#[test]
fn verilog_stops_when_its_host_dies_and_another_host_continues() {
    hosts_die::<VerilatedBoard>(1, 20, Faults::default());
}

/// Kills `deaths` hosts, each within `within` + 20 ms, on a line with these faults.
fn hosts_die<B: Kind>(deaths: u64, within: u64, faults: Faults) {
    let guard = build().guard;
    let watchdog = u64::from(guard.watchdog + 1) * u64::from(guard.round) * TICK;
    let ramp = (FASTEST as u64 / STOP + 4) * TICK;
    let uart = Uart::new(CLOCK_HZ, 921_600).unwrap();
    let mut random = Random::new(21);
    let end = End::<B>::new(uart, faults, 2);
    let (mut died, mut watchdogs, mut underruns, mut longest) = (0, 0, 0, 0);
    for seed in 0.. {
        if died == deaths {
            break;
        }
        let mut host: BoardHost<B> = end.connect(uart);
        host.clear().unwrap();
        host.enable().unwrap();
        // Long segments continue for long after the host's death; with short ones the queues run
        // empty.
        let ticks = if seed % 2 == 0 { 60_000 } else { 5000 };
        let commands = waves(&mut random, 40, ticks);
        let dies = end.0.borrow().board.cycle() + (20 + random.below(within)) * MS;
        end.0.borrow_mut().dies = dies;
        let (loads, stops) =
            (end.0.borrow().board.loads().len(), end.0.borrow().board.stops().len());
        let ended = host.stream(Program::new(&commands, AXES as u8).unwrap(), |_| Wish::GoOn);
        let moving = end.0.borrow().board.loads().len() > loads && !end.0.borrow().board.rests();
        match ended {
            Err(HostError::Line(_)) => died += u64::from(moving),
            // The move was over before, or the line's faults alone stopped it.
            Err(HostError::Fault { .. }) | Ok(Ended::Done) => {
                end.0.borrow_mut().dies = u64::MAX;
                continue;
            }
            other => panic!("{other:?}"),
        }
        drop(host);
        end.wait((watchdog + ramp) / MS + 60);
        let world = end.0.borrow();
        let last = world.last_edge().map_or(0, |edge| edge.clock);
        // Bytes that were being transmitted when the host died still arrive.
        let since = last.saturating_sub(world.heard.max(dies));
        assert!(since <= watchdog + ramp, "an edge {} ms after the last byte", since / MS);
        assert!(world.board.rests());
        match world.board.stops().get(stops) {
            Some(&(_, Cause::Watchdog)) => watchdogs += u64::from(moving),
            Some(&(_, Cause::Underrun)) => underruns += u64::from(moving),
            Some(&(_, cause)) => panic!("{cause:?}"),
            None => {}
        }
        longest = longest.max(since);
        drop(world);

        // Another host on another line, without a restart of the board.
        end.0.borrow_mut().revive(Faults::default(), seed);
        let mut host = end.connect(uart);
        host.clear().unwrap();
        for axis in 0..AXES as u8 {
            let travelled = end.0.borrow().travelled(axis);
            assert_eq!(host.status().positions[usize::from(axis)], travelled, "axis {axis}");
        }
        let short = waves(&mut random, 5, 2000);
        assert_eq!(
            host.stream(Program::new(&short, AXES as u8).unwrap(), |_| Wish::GoOn),
            Ok(Ended::Done)
        );
        end.0.borrow_mut().revive(faults, seed + 100);
    }
    eprintln!(
        "FIGURES {died} deaths in motion, {watchdogs} stops by watchdog, {underruns} by a dry queue, motion for {:.1} ms at the most after the last byte (watchdog {:.1} ms, ramp {:.1} ms)",
        longest as f64 / MS as f64,
        watchdog as f64 / MS as f64,
        ramp as f64 / MS as f64
    );
    assert!(watchdogs > 0 && longest > watchdog, "no watchdog was needed");
}
