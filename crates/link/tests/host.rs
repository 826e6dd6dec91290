//! The driver from connecting to a clean stop, on a clean line and on a bad one; every error names its cause.
#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches unit tests only")]

mod support;

use carrystep_link::registers::CAUSES;
use carrystep_link::{
    Command, Ended, Host, HostError, OutOfStep, Patience, Program, ProgramError, Refusal, Segment, Timing, Wish,
};
use std::convert::Infallible;
use support::bench_line::{End, Peer};
use support::device::{Device, Done};
use support::random::{Random, program};
use support::soak::TICKS;
use support::wire::Faults;

const BUILD: u64 = 0x0123_4567_89ab_cdef;
const QUICK: Patience = Patience { timing: Timing { resend: 12, pause: 2 }, silence: 500, change: 2000, look: 20 };

type TestHost = Host<End, End>;
type Error = HostError<Infallible>;

fn connect(end: &End, wanted: Option<u64>) -> Result<TestHost, Error> {
    Host::connect(end.clone(), end.clone(), wanted, QUICK)
}

/// Connected and powered.
fn ready(faults: Faults, seed: u64) -> (End, TestHost) {
    let end = End::new(faults, seed);
    let mut host = connect(&end, Some(BUILD)).unwrap();
    host.enable().unwrap();
    (end, host)
}

fn refusal(change: impl FnOnce(&mut Device)) -> String {
    let end = End::new(Faults::default(), 1);
    change(&mut end.0.borrow_mut().device);
    let error = connect(&end, Some(BUILD)).err().unwrap();
    assert!(end.0.borrow().device.log.is_empty(), "something was written");
    error.to_string()
}

fn nobody(peer: Peer) -> Error {
    let end = End::new(Faults::default(), 1);
    end.0.borrow_mut().peer = peer;
    connect(&end, None).err().unwrap()
}

fn go_on(_: &carrystep_link::Progress<'_>) -> Wish {
    Wish::GoOn
}

fn moves(seed: u64, segments: usize) -> Vec<Command> {
    program(&mut Random(seed), 6, segments, 20 * TICKS)
}

fn one_move(axis: u8, ticks: u32) -> [Command; 2] {
    let segment = Segment { ticks, v: 1 << 40, a: 0, j: 0, last: true };
    [Command::Segment { axis, segment }, Command::Start { mask: 1 << axis }]
}

#[test]
fn it_knows_what_it_is_connected_to() {
    for faults in [Faults::default(), Faults::BAD] {
        let host = connect(&End::new(faults, 3), Some(BUILD)).unwrap();
        let facts = *host.facts();
        assert_eq!((facts.build, facts.axes, facts.clock_hz), (BUILD, 6, 48_000_000));
        assert_eq!((facts.tick_ns, facts.phases, facts.watchdog_ticks), (2000, 16, 50_000));
    }
    assert!(connect(&End::new(Faults::default(), 3), None).is_ok());
}

#[test]
fn another_gateware_is_refused_and_both_are_named() {
    assert_eq!(refusal(|device| device.facts[0] = 0x4242_4242), "what answers is not carrystep: identity 0x42424242");
    let said = refusal(|device| device.facts[1] = 9);
    assert!(said.starts_with("the gateware speaks protocol 9, this driver 1:"), "{said}");
    let said = refusal(|device| device.facts[3] = 0xffff_ffff);
    let expected = "the gateware is build ffffffff89abcdef, this machine needs build 0123456789abcdef: ";
    assert!(said.starts_with(expected), "{said}");
}

#[test]
fn silence_and_noise_are_told_apart() {
    assert!(matches!(nobody(Peer::Nobody), HostError::Silence { ms: 501.. }));
    assert!(matches!(nobody(Peer::Chatter(b"ok\r\n".to_vec())), HostError::Noise { bytes: 100.. }));
    assert!(matches!(nobody(Peer::Chatter(vec![0xff; 20])), HostError::Noise { .. }));
    assert!(matches!(nobody(Peer::Echo), HostError::Noise { .. }));
    // A bus with nobody on it that idles at END.
    assert!(matches!(nobody(Peer::Chatter(vec![0xc0; 20])), HostError::Silence { .. }));
}

#[test]
fn a_program_is_done_on_a_clean_line_and_on_a_bad_one() {
    for (faults, seed) in [(Faults::default(), 4), (Faults::BAD, 5), (Faults::BAD, 6)] {
        let (end, mut host) = ready(faults, seed);
        let commands = moves(seed, 600);
        let ended = host.stream(Program::new(&commands, 6).unwrap(), go_on).unwrap();
        assert_eq!(ended, Ended::Done);
        let world = end.0.borrow();
        assert_eq!(host.status().positions, world.device.position);
        assert_eq!(world.device.log.len(), commands.len() + 1, "and the power");
        assert!(world.device.idle());
    }
}

#[test]
fn a_wish_to_stop_is_obeyed_and_a_clear_resumes() {
    let (end, mut host) = ready(Faults::BAD, 7);
    let commands = moves(7, 600);
    let mut looks = 0;
    let stop_soon = |progress: &carrystep_link::Progress<'_>| {
        looks += 1;
        if progress.status.positions[0] > 1000 { Wish::Stop } else { Wish::GoOn }
    };
    assert_eq!(host.stream(Program::new(&commands, 6).unwrap(), stop_soon), Ok(Ended::Stopped));
    assert!(looks > 10);
    let status = *host.status();
    assert_eq!(status.answer.cause_name(), Some("stop"));
    assert_eq!(status.positions, end.0.borrow().device.position);
    // Not before a clear.
    let one = one_move(0, 5000);
    let program = || Program::new(&one, 6).unwrap();
    assert_eq!(host.stream(program(), go_on), Err(HostError::Fault { cause: 7, culprits: 0 }));
    host.clear().unwrap();
    assert_eq!(host.stream(program(), go_on), Ok(Ended::Done));
    assert_eq!(host.status().positions[0], status.positions[0] + 5000);
    // A clear without a stop is nothing.
    let before = end.0.borrow().device.log.len();
    host.clear().unwrap();
    assert_eq!(end.0.borrow().device.log.len(), before);
}

#[test]
fn a_stop_of_the_machine_is_named() {
    let (end, mut host) = ready(Faults::BAD, 8);
    end.0.borrow_mut().meanwhile = Box::new(|device| {
        if device.position[2] > 3000 && device.fault.is_none() && device.homing == 0 {
            device.limit(2);
        }
    });
    let commands = moves(8, 600);
    let error = host.stream(Program::new(&commands, 6).unwrap(), go_on).unwrap_err();
    assert_eq!(error, HostError::Fault { cause: 5, culprits: 0 });
    assert!(error.to_string().starts_with("the machine has stopped: limit"), "{error}");
    end.0.borrow_mut().meanwhile = Box::new(|_| ());
    end.0.borrow_mut().device.pressed = true;
    let said = host.clear().unwrap_err().to_string();
    assert_eq!(said, "the clear has not come in 2000 ms; the machine stands because of: limit");
    end.0.borrow_mut().device.pressed = false;
    host.clear().unwrap();
    assert_eq!(CAUSES.len(), 8);
}

#[test]
fn a_restarted_gateware_is_noticed() {
    for (seed, powered) in [(9, true), (10, false)] {
        let (end, mut host) = ready(Faults::default(), seed);
        if !powered {
            host.disable().unwrap();
        }
        let commands = moves(seed, 300);
        let restart = end.clone();
        let mut done = false;
        let watch = |_: &carrystep_link::Progress<'_>| {
            if !std::mem::replace(&mut done, true) {
                restart.0.borrow_mut().device = Device::new(6, 200);
            }
            Wish::GoOn
        };
        let error = host.stream(Program::new(&commands, 6).unwrap(), watch).unwrap_err();
        let out_of_step = matches!(error, HostError::OutOfStep(OutOfStep { next: 200, .. }));
        assert!(if powered { out_of_step || error == HostError::Restarted } else { out_of_step }, "{error}");
    }
}

#[test]
fn what_a_dead_host_has_left_is_not_started() {
    for faults in [Faults::default(), Faults::BAD] {
        let (end, mut host) = ready(faults, 15);
        let commands = moves(15, 300);
        let mut looks = 0;
        let die = end.clone();
        let error = host.stream(Program::new(&commands, 6).unwrap(), |_| {
            looks += 1;
            if looks == 12 {
                die.0.borrow_mut().peer = Peer::Nobody;
                die.0.borrow_mut().device.freeze_time = true;
            }
            Wish::GoOn
        });
        assert!(matches!(error, Err(HostError::Silence { .. })), "{error:?}");
        drop(host);
        end.0.borrow_mut().peer = Peer::Gateware;
        let mut host = connect(&end, Some(BUILD)).unwrap();
        assert!(!host.status().answer.idle && !host.status().answer.fault);
        let one = one_move(0, 700);
        let program = || Program::new(&one, 6).unwrap();
        assert_eq!(host.stream(program(), go_on), Err(HostError::NotIdle));
        host.settle().unwrap();
        end.0.borrow_mut().device.freeze_time = false;
        let before = host.status().positions;
        assert_eq!(host.stream(program(), go_on), Ok(Ended::Done));
        let mut after = before;
        after[0] += 700;
        assert_eq!(host.status().positions, after);
        assert!(host.status().answer.ready, "the drivers kept their power");
    }
}

#[test]
fn nobody_answers_any_more() {
    let (end, mut host) = ready(Faults::default(), 11);
    end.0.borrow_mut().peer = Peer::Nobody;
    let commands = moves(11, 100);
    let error = host.stream(Program::new(&commands, 6).unwrap(), go_on).unwrap_err();
    assert!(matches!(error, HostError::Silence { .. }), "{error}");
    // An idle hour in between is no silence.
    end.0.borrow_mut().peer = Peer::Gateware;
    end.0.borrow_mut().now += 3_600_000;
    host.look().unwrap();
}

#[test]
fn homing_finds_the_limit_or_says_that_there_was_none() {
    for faults in [Faults::default(), Faults::BAD] {
        let (end, mut host) = ready(faults, 12);
        end.0.borrow_mut().meanwhile = Box::new(|device| {
            if device.homing & 4 != 0 && device.position[2] >= 40_000 {
                device.limit(2);
            }
        });
        let slow = one_move(2, 200_000);
        let program = || Program::new(&slow, 6).unwrap();
        let latched = host.home(4, program(), go_on).unwrap();
        assert_eq!(latched[2], end.0.borrow().device.latched[2]);
        assert!((40_000..41_000).contains(&latched[2]), "{latched:?}");
        assert!(!host.status().answer.fault && host.status().answer.homing == 0);

        end.0.borrow_mut().meanwhile = Box::new(|_| ());
        assert_eq!(host.home(4, program(), go_on), Err(HostError::NoLimit { axes: 4 }));
        assert!(!host.status().answer.fault && end.0.borrow().device.homing == 0);
    }
    let (_, mut host) = ready(Faults::default(), 13);
    let segment = Segment { ticks: 9, v: 1, a: 0, j: 0, last: false };
    let mut long = vec![Command::Segment { axis: 1, segment }; 8];
    long.extend(one_move(1, 9));
    let error = host.home(2, Program::new(&long, 6).unwrap(), go_on).unwrap_err();
    assert_eq!(error, HostError::Program(ProgramError::TooMany { axis: 1, segments: 9, most: 7 }));
}

#[test]
fn a_jog_is_a_move_of_one_axis() {
    let (end, mut host) = ready(Faults::BAD, 14);
    let segment = Segment { ticks: 3000, v: 1 << 50, a: 0, j: 0, last: false };
    let segments = [segment, segment, Segment { last: true, ..segment }];
    assert_eq!(host.jog(5, &segments, go_on), Ok(Ended::Done));
    assert_eq!(host.status().positions, [0, 0, 0, 0, 0, 9000, 0, 0]);
    assert_eq!(end.0.borrow().device.log.last(), Some(&Done::Write(0x21, 32)));
    assert_eq!(host.jog(6, &segments, go_on), Err(ProgramError::Axis { axis: 6, axes: 6 }.into()));
    assert_eq!(host.jog(5, &segments[..2], go_on), Err(ProgramError::NoEnd { axis: 5 }.into()));
}

#[test]
fn a_program_that_no_gateware_takes_is_refused_before_it_is_sent() {
    let segment = Segment { ticks: 9, v: 0, a: 0, j: 0, last: true };
    let of = |axis, segment| Command::Segment { axis, segment };
    let start = |mask| Command::Start { mask };
    let said = |commands: &[Command]| Program::new(commands, 6).map(|_| ()).unwrap_err();
    assert_eq!(said(&[of(6, segment), start(64)]), ProgramError::Axis { axis: 6, axes: 6 });
    assert_eq!(said(&[start(64)]), ProgramError::Axis { axis: 6, axes: 6 });
    assert_eq!(said(&[of(1, Segment { ticks: 0, ..segment }), start(2)]), ProgramError::NoTicks { axis: 1 });
    assert_eq!(said(&[of(1, segment), start(2), start(2)]), ProgramError::NoMove { axis: 1, mask: 2 });
    assert_eq!(said(&[of(1, Segment { last: false, ..segment }), start(2)]), ProgramError::NoEnd { axis: 1 });
    assert_eq!(said(&[of(1, segment)]), ProgramError::NoStart { axis: 1 });
    Program::new(&[], 6).unwrap();
}

#[test]
fn refusals_are_errors_of_their_own() {
    assert_eq!(HostError::<Infallible>::from(Refusal::Identity(1)), HostError::Refused(Refusal::Identity(1)));
}
