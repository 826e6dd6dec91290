//! Tests of the driver's errors: other gateware, other devices, a dead line, and programs that no
//! gateware accepts. Its behaviour with a board is tested in crates/virtual-board/tests.

use crate::support;
use crate::support::bench_line::{End, Peer};
use crate::support::device::Device;
use crate::support::random::{Random, program};
use crate::support::soak::TICKS;
use carrystep_link::{
    Body, Command, Ended, Feeder, GatewareMismatch, Host, HostError, OutputChange, Patience,
    Program, ProgramError, Segment, Timing, Wish,
};
use std::convert::Infallible;
use std::num::NonZeroU16;

const BUILD: u64 = 0x0123_4567_89ab_cdef;
const OWN: NonZeroU16 = NonZeroU16::new(0xc0db).unwrap();
const QUICK: Patience = Patience {
    timing: Timing { resend: 12, pause: 2 },
    silence: 500,
    lost: 500,
    change: 2000,
    status_period: 20,
};

type Error = HostError<Infallible>;

fn connect(end: &End, wanted: Option<u64>) -> Result<Host<End, End>, Error> {
    Host::connect(end.clone(), end.clone(), wanted, QUICK)
}

fn refusal(change: impl FnOnce(&mut Device)) -> String {
    let end = End::new();
    change(&mut end.0.borrow_mut().device);
    let error = connect(&end, Some(BUILD)).err().unwrap();
    assert!(end.0.borrow().device.log.is_empty(), "something was written");
    error.to_string()
}

fn nobody(peer: Peer) -> Error {
    let end = End::new();
    end.0.borrow_mut().peer = peer;
    connect(&end, None).err().unwrap()
}

#[test]
fn other_gateware_is_refused_and_both_builds_are_named() {
    assert_eq!(
        refusal(|device| device.facts[0] = 0x4242_4242),
        "what answers is not carrystep: identity 0x42424242"
    );
    let said = refusal(|device| device.facts[1] = 9);
    assert!(said.starts_with("the gateware speaks protocol 9, this driver 2:"), "{said}");
    let said = refusal(|device| device.facts[3] = 0xffff_ffff);
    let expected =
        "the gateware is build ffffffff89abcdef, this machine needs build 0123456789abcdef: ";
    assert!(said.starts_with(expected), "{said}");
}

#[test]
fn silence_and_noise_are_different_errors() {
    assert!(matches!(nobody(Peer::Nobody), HostError::Silence { ms: 501.. }));
    assert!(matches!(nobody(Peer::Chatter(b"ok\r\n".to_vec())), HostError::Noise { bytes: 100.. }));
    assert!(matches!(nobody(Peer::Chatter(vec![0xff; 20])), HostError::Noise { .. }));
    assert!(matches!(nobody(Peer::Echo), HostError::Noise { .. }));
    // A bus without a device that idles at END.
    assert!(matches!(nobody(Peer::Chatter(vec![0xc0; 20])), HostError::Silence { .. }));
}

#[test]
fn gateware_that_stops_answering_is_reported_as_lost() {
    let end = End::new();
    let mut host = connect(&end, Some(BUILD)).unwrap();
    host.open(OWN).unwrap();
    host.enable().unwrap();
    end.0.borrow_mut().peer = Peer::Nobody;
    let commands = program(&mut Random::new(11), 6, 100, 20 * TICKS);
    let error = host.stream(Program::new(&commands, 6).unwrap(), |_| Wish::GoOn).unwrap_err();
    assert!(matches!(error, HostError::Lost { bytes: 0, .. }), "{error}");
    // An idle hour between two calls does not count as silence.
    end.0.borrow_mut().peer = Peer::Gateware;
    end.0.borrow_mut().now += 3_600_000;
    host.read_status().unwrap();
}

#[test]
fn program_that_no_gateware_accepts_is_refused_before_it_is_sent() {
    let segment = Segment { ticks: 9, v: 0, a: 0, j: 0, last: true };
    let of = |axis, segment| Command::Segment { axis, segment };
    let start = |mask| Command::Start { mask };
    let said = |commands: &[Command]| Program::new(commands, 6).map(|_| ()).unwrap_err();
    assert_eq!(said(&[of(6, segment), start(64)]), ProgramError::Axis { axis: 6, axes: 6 });
    assert_eq!(said(&[start(64)]), ProgramError::Axis { axis: 6, axes: 6 });
    assert_eq!(
        said(&[of(1, Segment { ticks: 0, ..segment }), start(2)]),
        ProgramError::NoTicks { axis: 1 }
    );
    assert_eq!(
        said(&[of(1, segment), start(2), start(2)]),
        ProgramError::NoMove { axis: 1, mask: 2 }
    );
    assert_eq!(
        said(&[of(1, Segment { last: false, ..segment }), start(2)]),
        ProgramError::NoEnd { axis: 1 }
    );
    assert_eq!(said(&[of(1, segment)]), ProgramError::NoStart { axis: 1 });
    let on = Command::Outputs(OutputChange { mask: 1, levels: 1, duty: None });
    let behind = [of(0, segment), start(1), on, of(1, segment), start(2)];
    assert_eq!(said(&behind), ProgramError::NoSegment);
    Program::new(&[], 6).unwrap();
}

#[test]
fn outputs_change_with_the_next_segment_of_the_first_axis() {
    let segment = |last| Segment { ticks: 9, v: 0, a: 0, j: 0, last };
    let change = |mask, levels, duty| OutputChange { mask, levels, duty };
    let of = |axis, last| Command::Segment { axis, segment: segment(last) };
    let commands = [
        Command::Outputs(change(1, 1, None)),
        of(1, true),
        Command::Outputs(change(3, 2, Some(9))),
        of(0, false),
        of(0, true),
        Command::Start { mask: 3 },
    ];
    for is_wide in [false, true] {
        let program = Program::new(&commands, 2).unwrap();
        let mut feeder = if is_wide { Feeder::wide(program) } else { Feeder::new(program) };
        let mut changes = Vec::new();
        while let Some(body) = feeder.next(2, &[7, 7], true).unwrap() {
            match body {
                Body::Segment { axis, outputs, .. } => changes.push((1 << axis, outputs)),
                Body::Segments(wide) => changes.push((wide.mask, wide.outputs)),
                _ => {}
            }
        }
        let first = change(3, 2, Some(9));
        assert_eq!(changes.iter().filter(|(_, outputs)| !outputs.is_none()).count(), 1);
        assert!(matches!(changes[0], (mask, outputs) if mask & 1 == 1 && outputs == first));
    }
}

#[test]
fn refusals_are_separate_errors() {
    assert_eq!(
        HostError::<Infallible>::from(GatewareMismatch::Identity(1)),
        HostError::Refused(GatewareMismatch::Identity(1))
    );
}

/// Runs a program, stops it, and measures the exchanges until STOP is executed.
#[test]
fn stop_is_executed_within_three_exchanges() {
    let end = End::new();
    let mut host = connect(&end, Some(BUILD)).unwrap();
    host.open(OWN).unwrap();
    host.enable().unwrap();
    let commands = program(&mut Random::new(5), 6, 400, 20 * TICKS);
    for wished in [1, 2, 3, 5, 8, 13, 21, 34, 55] {
        let (mut exchanges, mut asked) = (0, 0);
        let program = Program::new(&commands, 6).unwrap();
        let ended = host.stream(program, |_| {
            exchanges += 1;
            if exchanges < wished {
                return Wish::GoOn;
            }
            if exchanges == wished {
                asked = end.0.borrow().now;
            }
            Wish::Stop
        });
        assert_eq!(ended, Ok(Ended::Stopped));
        let stopped = end.0.borrow().stopped.expect("a stop");
        // An exchange takes one millisecond on this line.
        assert!(stopped - asked <= 3, "wished at {asked} ms, executed at {stopped} ms");
        host.clear().unwrap();
        end.0.borrow_mut().stopped = None;
    }
}

#[test]
fn start_without_power_is_refused_before_anything_is_sent() {
    let end = End::new();
    let mut host = connect(&end, Some(BUILD)).unwrap();
    host.open(OWN).unwrap();
    let segment = Segment { ticks: 9, v: 0, a: 0, j: 0, last: true };
    let commands = [Command::Segment { axis: 0, segment }, Command::Start { mask: 1 }];
    let error = host.stream(Program::new(&commands, 6).unwrap(), |_| Wish::GoOn).unwrap_err();
    assert_eq!(error, HostError::Program(ProgramError::NoPower));
    assert!(
        error
            .to_string()
            .starts_with("the drivers have no power: write CONTROL = 1 and wait for `ready`")
    );
    assert_eq!(
        host.write(carrystep_link::registers::START, 1),
        Err(HostError::Program(ProgramError::NoPower))
    );
    assert!(end.0.borrow().device.log.is_empty(), "something was written");
    host.enable().unwrap();
    assert_eq!(host.stream(Program::new(&commands, 6).unwrap(), |_| Wish::GoOn), Ok(Ended::Done));
}

#[test]
fn clear_while_the_estop_is_pressed_is_an_error() {
    let end = End::new();
    let mut host = connect(&end, Some(BUILD)).unwrap();
    host.open(OWN).unwrap();
    host.enable().unwrap();
    end.0.borrow_mut().device.press(true);
    host.read_status().unwrap();
    let begun = end.0.borrow().now;
    assert_eq!(host.clear(), Err(HostError::StillPressed));
    let took = end.0.borrow().now - begun;
    assert!(took < 200, "{took} ms");
    end.0.borrow_mut().device.press(false);
    host.clear().unwrap();
}

/// What another host does with the gateware in miniature, byte by byte on a line of its own.
fn other(end: &End, content: &[u8]) {
    let mut world = end.0.borrow_mut();
    support::device::on_the_line(content).into_iter().for_each(|byte| {
        world.device.byte(byte);
    });
}

const OPEN_OF_ANOTHER: [u8; 8] = [0, 0xa5, 7, 0, 0, 0, 0, 0];

#[test]
fn write_without_a_session_is_an_error_and_a_stop_is_not() {
    let end = End::new();
    let mut host = connect(&end, Some(BUILD)).unwrap();
    assert_eq!(host.enable(), Err(HostError::NoSession));
    assert_eq!(host.snapshot(), Err(HostError::NoSession));
    assert_eq!(
        host.stream(Program::new(&[], 6).unwrap(), |_| Wish::GoOn),
        Err(HostError::NoSession)
    );
    assert!(end.0.borrow().device.log.is_empty(), "something was written");
    assert_eq!(host.stop().unwrap().answer.cause_name(), Some("stop"));
    assert_eq!(end.0.borrow().device.session, 0);
    assert_eq!(host.clear(), Err(HostError::NoSession));
    host.open(OWN).unwrap();
    host.clear().unwrap();
    assert!(!host.status().answer.fault);
}

/// The session is lost in the middle of a program. The host reports it, sends no more writes, and
/// can stop the axes and take the gateware back.
#[test]
fn gateware_that_another_host_has_taken_is_reported() {
    let end = End::new();
    let mut host = connect(&end, Some(BUILD)).unwrap();
    host.open(OWN).unwrap();
    assert_eq!(host.session(), Some(OWN));
    host.enable().unwrap();
    let commands = program(&mut Random::new(3), 6, 400, 20 * TICKS);
    let mut exchanges = 0;
    let error = host.stream(Program::new(&commands, 6).unwrap(), |_| {
        exchanges += 1;
        if exchanges == 100 {
            other(&end, &[0, 0xa6, 0, 0, 0, 0, 0, 0]);
            other(&end, &OPEN_OF_ANOTHER);
            other(&end, &[0, 0xa2, 7, 0, 0, 0, 0, 0]);
        }
        Wish::GoOn
    });
    let error = error.unwrap_err();
    assert!(matches!(error, HostError::SessionLost(_)), "{error}");
    assert!(error.to_string().starts_with("another host has taken the gateware"), "{error}");
    let next = end.0.borrow().device.next;
    assert_eq!((host.session(), next), (None, 1));
    assert_eq!(host.disable(), Err(HostError::NoSession));
    assert!(!host.keeps(OWN).unwrap());
    assert!(host.keeps(NonZeroU16::new(7).unwrap()).unwrap());
    host.stop().unwrap();
    host.open(OWN).unwrap();
    host.clear().unwrap();
    assert_eq!(host.stream(Program::new(&[], 6).unwrap(), |_| Wish::GoOn), Ok(Ended::Done));
}

#[test]
fn restart_is_told_apart_from_another_host() {
    let end = End::new();
    let mut host = connect(&end, Some(BUILD)).unwrap();
    host.open(OWN).unwrap();
    host.enable().unwrap();
    end.0.borrow_mut().device = Device::new(6, 0);
    assert_eq!(host.read_status(), Err(HostError::Restarted));
}

/// A host waits for the end of another one's motion, or for its caller's patience, and stops
/// nothing.
#[test]
fn open_waits_while_axes_move() {
    let end = End::new();
    let mut host = connect(&end, Some(BUILD)).unwrap();
    end.0.borrow_mut().device.load(2, 100 * TICKS);
    let mut looks = 0;
    let gave_up = host.open_while(OWN, |progress| {
        assert!(!progress.status.answer.idle);
        looks += 1;
        if looks == 3 { Wish::Stop } else { Wish::GoOn }
    });
    assert_eq!((gave_up, host.session()), (Ok(Ended::Stopped), None));
    host.open(OWN).unwrap();
    assert_eq!(end.0.borrow().device.fault, None);
    host.open(OWN).unwrap();
    let end = End::new();
    let mut host = connect(&end, Some(BUILD)).unwrap();
    end.0.borrow_mut().device.load(2, u32::MAX);
    let error = host.open(OWN).unwrap_err();
    // The watchdog's time and that for a change.
    assert!(matches!(error, HostError::Occupied { ms: 2101.. }), "{error}");
    assert!(error.to_string().contains("`carrystep stop`"), "{error}");
}
