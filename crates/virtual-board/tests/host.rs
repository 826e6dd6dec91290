//! The driver from connecting to a clean stop, with a board of models and with the exported
//! Verilog, on clean and on bad lines. Every error must name its cause.

use crate::support::random::Random;
use crate::support::wire::Faults;
use crate::support::{BoardHost, CLOCK_HZ, End, Kind, MS, QUICK, SESSION, TICK, build, waves};
use carrystep_core::engine::Cause;
use carrystep_core::link::{LineKind, Uart};
use carrystep_link::registers::START;
use carrystep_link::{
    Command, Ended, HostError, Program, ProgramError, Progress, Segment, Snapshot, Wish,
};
use carrystep_virtual_board::{ModelBoard, Switches, VerilatedBoard};
use std::num::NonZeroU16;

/// Runs a function with both kinds of board.
macro_rules! on_both {
    ($($name:ident)*) => {
        $(mod $name {
            #[test]
            fn of_models() {
                super::$name::<super::ModelBoard>();
            }

            #[test]
            fn of_the_verilog() {
                super::$name::<super::VerilatedBoard>();
            }
        })*
    };
}

on_both! {
    other_build_is_refused_and_both_ids_are_named
    stop_request_stops_the_axes_and_clear_resumes
    stop_of_the_machine_is_reported_with_its_cause
    restarted_gateware_is_reported
    segments_of_a_dead_host_are_not_started
    another_host_stops_the_axes_and_takes_the_gateware
    snapshots_of_a_program_that_runs_are_exact
    jog_moves_one_axis
}

fn uart() -> Uart {
    Uart::new(CLOCK_HZ, 3_000_000).unwrap()
}

/// A host that is connected and has powered the drivers.
fn ready<B: Kind>(faults: Faults, seed: u64) -> (End<B>, BoardHost<B>) {
    let end = End::new(uart(), faults, seed);
    let mut host = end.connect_to(uart().build_id(&build()), QUICK).unwrap();
    host.open(SESSION).unwrap();
    host.enable().unwrap();
    (end, host)
}

fn go_on(_: &Progress<'_>) -> Wish {
    Wish::GoOn
}

/// A program of a tenth of a second on all axes; the queues hold most of it.
fn moves(seed: u64) -> Vec<Command> {
    waves(&mut Random::new(seed), 9, 6000)
}

/// A program of three steps forward in 3 ms on this axis.
fn hop(axis: u8) -> [Command; 2] {
    let segment = Segment { ticks: 1536, v: 1 << 55, a: 0, j: 0, last: true };
    [Command::Segment { axis, segment }, Command::Start { mask: 1 << axis }]
}

fn program(commands: &[Command]) -> Program<'_> {
    Program::new(commands, 6).unwrap()
}

/// Whether the board is `milliseconds` or more into its first move.
fn into_the_move<B: Kind>(end: &End<B>, milliseconds: u64) -> bool {
    let board = &end.0.borrow().board;
    board.loads().first().is_some_and(|load| board.cycle() > load + milliseconds * MS)
}

#[track_caller]
fn positions_are_true<B: Kind>(end: &End<B>, host: &BoardHost<B>) {
    let travelled = [0, 1, 2, 3, 4, 5].map(|axis| end.0.borrow().travelled(axis));
    assert_eq!(host.status().positions[..6], travelled);
}

/// The same engine with an SPI is another build.
fn other_build_is_refused_and_both_ids_are_named<B: Kind>() {
    let end = End::<B>::new(uart(), Faults::default(), 1);
    let (own, other) = (uart().build_id(&build()), LineKind::Spi.build_id(&build()));
    let refused = end.connect_to(other, QUICK).err().unwrap().to_string();
    let expected = format!("the gateware is build {own}, this machine needs build {other}: ");
    assert!(refused.starts_with(&expected), "{refused}");
    assert_eq!(
        end.connect_to(own, QUICK).unwrap().status().answer.next,
        0,
        "something was written"
    );
}

fn stop_request_stops_the_axes_and_clear_resumes<B: Kind>() {
    let (end, mut host) = ready::<B>(Faults::BAD, 7);
    let stop_soon =
        |_: &Progress<'_>| if into_the_move(&end, 20) { Wish::Stop } else { Wish::GoOn };
    assert_eq!(host.stream(program(&moves(7)), stop_soon), Ok(Ended::Stopped));
    let status = *host.status();
    assert_eq!(status.answer.cause_name(), Some("stop"));
    positions_are_true(&end, &host);
    // No program is accepted before a clear.
    let hop = hop(0);
    assert_eq!(
        host.stream(program(&hop), go_on),
        Err(HostError::Fault { cause: Cause::Stop as u8, culprits: 0 })
    );
    host.clear().unwrap();
    assert_eq!(host.stream(program(&hop), go_on), Ok(Ended::Done));
    assert_eq!(host.status().positions[0], status.positions[0] + 3);
    positions_are_true(&end, &host);
    // A clear without a stop in force writes nothing.
    let next = host.status().answer.next;
    host.clear().unwrap();
    assert_eq!(host.read_status().unwrap().answer.next, next);
}

fn stop_of_the_machine_is_reported_with_its_cause<B: Kind>() {
    let (end, mut host) = ready::<B>(Faults::BAD, 8);
    end.0.borrow_mut().meanwhile = Box::new(|board| {
        let reached = u8::from(board.position(2).abs() > 30) << 2;
        board.press(Switches { limit_min: reached, limit_max: reached, ..Switches::default() });
    });
    let error = host.stream(program(&moves(8)), go_on).unwrap_err();
    assert_eq!(error, HostError::Fault { cause: Cause::Limit as u8, culprits: 1 << 2 });
    assert!(error.to_string().starts_with("the machine has stopped: limit"), "{error}");
    positions_are_true(&end, &host);
    let press = |estop| {
        end.0.borrow_mut().meanwhile =
            Box::new(move |board| board.press(Switches { estop, ..Switches::default() }));
    };
    press(false);
    host.clear().unwrap();
    press(true);
    end.wait(10);
    let said = host.clear().unwrap_err().to_string();
    assert_eq!(said, "the e-stop is still pressed, so nothing can be cleared: release it");
    press(false);
    host.clear().unwrap();
}

fn restarted_gateware_is_reported<B: Kind>() {
    let (end, mut host) = ready::<B>(Faults::default(), 9);
    let mut fresh = Some(B::new(uart()));
    let restart = |_: &Progress<'_>| {
        if into_the_move(&end, 5)
            && let Some(board) = fresh.take()
        {
            end.0.borrow_mut().board = board;
        }
        Wish::GoOn
    };
    let error = host.stream(program(&moves(9)), restart).unwrap_err();
    assert_eq!(error, HostError::Restarted);
}

/// The first host died before the start; its segments are still in the queues.
fn segments_of_a_dead_host_are_not_started<B: Kind>() {
    let (end, mut host) = ready::<B>(Faults::default(), 15);
    let mut looks = 0;
    let error = host.stream(program(&moves(15)), |_| {
        looks += 1;
        end.0.borrow_mut().dies = if looks == 2 { 0 } else { u64::MAX };
        Wish::GoOn
    });
    assert!(matches!(error, Err(HostError::Line(_))), "{error:?}");
    assert!(end.0.borrow().board.loads().is_empty(), "it has died too late");
    drop(host);
    end.0.borrow_mut().revive(Faults::default(), 15);
    let mut host = end.connect_to(uart().build_id(&build()), QUICK).unwrap();
    assert!(!host.status().answer.idle && !host.status().answer.fault);
    let hop = hop(0);
    assert_eq!(host.stream(program(&hop), go_on), Err(HostError::NoSession));
    // The watchdog stops the dead host; until then the gateware is busy.
    let mut waited = 0;
    let opened = host.open_while(SESSION, |_| {
        waited += 1;
        Wish::GoOn
    });
    assert_eq!((opened, host.status().answer.cause_name()), (Ok(Ended::Done), Some("watchdog")));
    assert!(waited > 0, "it was not busy");
    host.clear().unwrap();
    assert_eq!(host.stream(program(&hop), go_on), Ok(Ended::Done));
    assert_eq!(host.status().positions[..6], [3, 0, 0, 0, 0, 0]);
    assert!(host.status().answer.ready, "the drivers kept their power");
}

/// A second program on the same line stops the axes without a session, and then opens one. The
/// first one's program ends with the stop, and its next request with the lost session.
fn another_host_stops_the_axes_and_takes_the_gateware<B: Kind>() {
    let (end, mut host) = ready::<B>(Faults::default(), 16);
    let other = NonZeroU16::new(0x77).unwrap();
    let mut second = None;
    let error = host.stream(program(&moves(16)), |_| {
        if second.is_none() && into_the_move(&end, 20) {
            let mut new = end.connect_to(uart().build_id(&build()), QUICK).unwrap();
            assert_eq!(new.write(START, 1), Err(HostError::NoSession));
            let wait = new.open_while(other, |_| Wish::Stop);
            assert_eq!((wait, new.session()), (Ok(Ended::Stopped), None));
            new.stop().unwrap();
            second = Some(new);
        }
        Wish::GoOn
    });
    assert_eq!(error, Err(HostError::Fault { cause: Cause::Stop as u8, culprits: 0 }));
    let mut second = second.expect("a second host");
    second.open(other).unwrap();
    let error = host.clear().unwrap_err();
    assert!(matches!(error, HostError::SessionLost(_)), "{error}");
    assert!(second.status().answer.fault, "it was cleared");
    second.clear().unwrap();
    assert_eq!(second.stream(program(&hop(3)), go_on), Ok(Ended::Done));
    positions_are_true(&end, &second);
}

/// The commanded position of an axis after so many ticks of a program, in 2^-64 step.
fn commanded(commands: &[Command], axis: u8, mut ticks: i64) -> i128 {
    let mut sum = 0;
    for command in commands {
        if let Command::Segment { axis: own, segment: Segment { ticks: all, v, a, .. } } = *command
            && own == axis
        {
            let n = i128::from(ticks.clamp(0, all.into()));
            sum += n * i128::from(v) + n * (n - 1) / 2 * i128::from(a);
            ticks -= i64::from(all);
        }
    }
    sum
}

/// Snapshots are taken all the time, on a bad line; they change no edge.
fn snapshots_of_a_program_that_runs_are_exact<B: Kind>() {
    // Long enough for several snapshots over a line that loses answers.
    let commands = waves(&mut Random::new(17), 10, 6000);
    let (end, mut host) = ready::<B>(Faults::BAD, 17);
    let mut seen: Vec<Snapshot> = Vec::new();
    let ended = host.stream(program(&commands), |progress| {
        let new = progress.snapshot.filter(|&new| seen.last() != Some(new));
        seen.extend(new);
        Wish::Snapshot
    });
    assert_eq!(ended, Ok(Ended::Done));
    let start = (end.0.borrow().board.loads()[0] / TICK) as i64;
    let moving = seen.iter().filter(|snapshot| snapshot.axes[0].runs()).count();
    assert!(moving > 1, "{moving} of {} in motion", seen.len());
    for Snapshot { tick, axes } in seen {
        for (axis, state) in (0..6).zip(axes) {
            let found = (i128::from(state.commanded()) << 64) + i128::from(state.p) - (1 << 63);
            assert_eq!(found, commanded(&commands, axis, tick - start), "axis {axis}, tick {tick}");
        }
    }
    let edges = |end: &End<B>| end.0.borrow().edges_since(end.0.borrow().board.loads()[0]);
    let (other, mut host) = ready::<B>(Faults::default(), 17);
    assert_eq!(host.stream(program(&commands), go_on), Ok(Ended::Done));
    assert!(edges(&end) == edges(&other), "a snapshot changes an edge");
}

fn jog_moves_one_axis<B: Kind>() {
    let (end, mut host) = ready::<B>(Faults::BAD, 14);
    let segment = Segment { ticks: 3072, v: 1 << 56, a: 0, j: 0, last: false };
    let segments = [segment, segment, Segment { last: true, ..segment }];
    assert_eq!(host.jog(5, &segments, go_on), Ok(Ended::Done));
    assert_eq!(host.status().positions[..6], [0, 0, 0, 0, 0, 36]);
    positions_are_true(&end, &host);
    assert_eq!(host.jog(6, &segments, go_on), Err(ProgramError::Axis { axis: 6, axes: 6 }.into()));
    assert_eq!(host.jog(5, &segments[..2], go_on), Err(ProgramError::NoEnd { axis: 5 }.into()));
}
