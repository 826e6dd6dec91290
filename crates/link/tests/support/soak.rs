//! Runs a whole program with a client, a faulty line in each direction, and a gateware.

use super::client::Client;
use super::device::{Bugs, Device, Done};
use super::wire::{Faults, Wire};
use super::{hex, unhex};
use carrystep_link::{Command, OutputChange};
use std::collections::VecDeque;

/// Number of the device's ticks per millisecond.
pub const TICKS: u32 = 500;

/// Time without progress, ms, after which a run is considered stalled.
const STALLED: u32 = 4000;

/// Parameters of a run.
#[derive(Debug, Clone, Copy)]
pub struct Soak {
    pub faults: Faults,
    pub seed: u64,
    pub axes: u8,
    pub bugs: Bugs,
}

/// Result of a run.
#[derive(Debug)]
pub struct Outcome {
    pub milliseconds: u32,
    /// Number of requests that the device accepted, of damaged ones, and of those that it had
    /// executed before.
    pub frames: u64,
    pub damaged: u64,
    pub repeated: u64,
    pub out_of_turn: u64,
    /// Number of pieces and bytes that the line damaged, in both directions.
    pub harmed: u64,
    /// The stop cause, if the motion stopped.
    pub fault: Option<u8>,
}

/// Runs a program. The error says which property was violated.
pub fn soak(client: &mut dyn Client, commands: &[Command], soak: Soak) -> Result<Outcome, String> {
    let Soak { faults, seed, axes, bugs } = soak;
    let mut device = Device::new(axes, seed as u8);
    device.bugs = bugs;
    device.powered = true;
    let (mut there, mut back) = (Wire::new(faults, seed), Wire::new(faults, !seed));
    client.say("begin 12 2");
    open(client, &mut device, seed as u16 | 1);
    let mut outputs = OutputChange::NONE;
    for command in commands {
        match command {
            Command::Outputs(change) => outputs = *change,
            Command::Segment { axis, segment: s } => {
                let change = if *axis == 0 { std::mem::take(&mut outputs).word() } else { 0 };
                client.say(&format!(
                    "segment {axis} {} {} {} {} {}",
                    s.ticks,
                    s.v,
                    s.a,
                    s.j,
                    u32::from(s.last) | change
                ));
            }
            Command::Start { mask } => {
                client.say(&format!("start {mask:02x}"));
            }
        }
    }
    client.say("load");
    let mut sent: VecDeque<Vec<u8>> = VecDeque::new();
    let (mut done, mut since) = (0, 0);
    for now in 0.. {
        if device.log.len() > done {
            (done, since) = (device.log.len(), now);
        } else if now - since > STALLED {
            break;
        }
        let said = client.say(&format!("step {now} {}", hex(&back.receive(now))));
        let parts: Vec<&str> = said.split(" | ").collect();
        let [answers, fed, bytes] = parts.as_slice() else { return Err(format!("{said:?}")) };
        for answer in answers.split(' ').filter(|&word| word != "-" && word != "damaged") {
            if answer == "lost" {
                return Err(format!("the session is lost after {now} ms"));
            }
            check_answer(answer, &mut sent)?;
        }
        for piece in unhex(bytes).split_inclusive(|&byte| byte == 0xc0) {
            there.send(now, piece);
        }
        for byte in there.receive(now) {
            let answer = device.byte(byte);
            if !answer.is_empty() {
                back.send(now, &answer);
                sent.push_back(answer);
            }
        }
        device.elapse(TICKS);
        if *fed == "bad" {
            return Err("the source was called bad".to_owned());
        }
        let over = *fed == "fed" && device.idle() && client.say("busy") == "no no";
        if over || device.fault.is_some() {
            compare(&device, commands)?;
            let Device { frames, damaged, repeated, out_of_turn, fault, .. } = device;
            let harmed = there.harmed + back.harmed;
            return Ok(Outcome {
                milliseconds: now,
                frames,
                damaged,
                repeated,
                out_of_turn,
                harmed,
                fault,
            });
        }
    }
    Err(format!("nothing more is done after {since} ms, {done} of {}", commands.len()))
}

/// Opens a session over a perfect line.
fn open(client: &mut dyn Client, device: &mut Device, number: u16) {
    client.say(&format!("open {number:x} {}", device.axes));
    let asked = unhex(&client.say("send 0"));
    let answer: Vec<u8> = asked.into_iter().flat_map(|byte| device.byte(byte)).collect();
    client.say(&format!("take 0 {}", hex(&answer)));
    assert_eq!(client.say("owns"), "yes");
    device.frames = 0;
}

/// Checks that an answer that the client accepted is one that the device sent, and not older than
/// one accepted before.
fn check_answer(answer: &str, sent: &mut VecDeque<Vec<u8>>) -> Result<(), String> {
    let bytes = |text: &str| {
        let parts: Vec<&str> = text.split(':').collect();
        [parts[0], parts[1], parts[2], parts[9]].map(str::to_owned)
    };
    let wanted = bytes(answer);
    let same = |line: &Vec<u8>| {
        let mut frame = Vec::new();
        let mut escaped = false;
        for &byte in &line[1..line.len() - 1] {
            match (escaped, byte) {
                (false, 0xdb) => escaped = true,
                (true, _) => {
                    frame.push(if byte == 0xdc { 0xc0 } else { 0xdb });
                    escaped = false;
                }
                _ => frame.push(byte),
            }
        }
        let data = u32::from_le_bytes([frame[8], frame[9], frame[10], frame[11]]);
        [
            format!("{:02x}", frame[0]),
            format!("{:02x}", frame[1]),
            format!("{:02x}", frame[2]),
            format!("{data:08x}"),
        ] == wanted
    };
    match sent.iter().position(same) {
        // The answer remains in the list, because the line may repeat it.
        Some(place) => {
            sent.drain(..place);
            Ok(())
        }
        None => Err(format!("the client took an answer that was never given: {answer}")),
    }
}

/// Checks that every segment and start was executed once, and those of an axis in their order.
/// After a fault a prefix is sufficient.
fn compare(device: &Device, commands: &[Command]) -> Result<(), String> {
    let wanted = |axis: u8| {
        let mut outputs = OutputChange::NONE;
        commands.iter().filter_map(move |command| match *command {
            Command::Outputs(change) if axis == 0 => {
                outputs = change;
                None
            }
            Command::Segment { axis: own, segment: s } if own == axis => {
                let commit = u32::from(s.last) | std::mem::take(&mut outputs).word();
                let halves = [s.v, s.a, s.j].map(|long| [long as u32, (long >> 32) as u32]);
                let [[v0, v1], [a0, a1], [j0, j1]] = halves;
                Some(Done::Segment(axis, [s.ticks - 1, v0, v1, a0, a1, j0, j1, commit]))
            }
            _ => None,
        })
    };
    let starts = |command: &Command| match *command {
        Command::Start { mask } => Some(Done::Write(0x21, mask.into())),
        Command::Segment { .. } | Command::Outputs(_) => None,
    };
    let whole = device.fault.is_none();
    let same = |what: &str, found: Vec<Done>, wanted: Vec<Done>| {
        let enough = if whole { found.len() == wanted.len() } else { found.len() <= wanted.len() };
        match found.iter().zip(&wanted).position(|(one, other)| one != other) {
            Some(place) => {
                Err(format!("{what} {place} is {:x?}, not {:x?}", found[place], wanted[place]))
            }
            None if enough => Ok(()),
            None => Err(format!("{} of {what}, {} were sent", found.len(), wanted.len())),
        }
    };
    for axis in 0..8 {
        let found = device
            .log
            .iter()
            .copied()
            .filter(|done| matches!(done, Done::Segment(own, _) if *own == axis));
        same(&format!("segment of axis {axis}"), found.collect(), wanted(axis).collect())?;
    }
    let found = device.log.iter().copied().filter(|done| matches!(done, Done::Write(..))).collect();
    same("start", found, commands.iter().filter_map(starts).collect())
}
