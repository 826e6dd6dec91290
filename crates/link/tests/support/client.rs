//! A test client that reads commands line by line and prints their results. The client in C
//! (`tests/bench/link_bench.c`) understands the same commands.
//!
//! ```text
//! begin RESEND PAUSE          a new dialogue
//! open NUMBER AXES            asks for a session; its number is hexadecimal
//! owns                        replies yes or no
//! stop
//! read ADDRESS                replies yes or no; addresses, words and masks are hexadecimal
//! write ADDRESS WORD          replies yes or no
//! segment AXIS TICKS V A J LAST     adds a segment to the program
//! start MASK                  adds a start to the program
//! load                        ends the program
//! feed                        replies feeding, fed, bad or unpowered
//! withdraw
//! send NOW                    replies the bytes of one request, or -
//! take NOW BYTES              replies a word per frame: the answer's fields, `damaged` or `lost`
//! step NOW BYTES              take, feed, and send until nothing is left; answers | feed | bytes
//! check IDENTITY PROTOCOL BUILD WANTED      replies fine, device, protocol or build
//! busy                        replies which of `waiting` and `writing` hold
//! ```

use super::{hex, unhex};
use carrystep_link::{
    Answer, Body, BuildFacts, Command, CutSlots, Feeder, GatewareMismatch, OutputChange,
    ProgramError, Refusal, Segment, Session, Timing, slip,
};
use std::num::NonZeroU16;

pub trait Client {
    fn say(&mut self, words: &str) -> String;
}

/// Size of the window of unacknowledged writes, as in the C bench.
pub const SLOTS: usize = 64;

pub struct RustClient {
    session: Session<SLOTS>,
    commands: Vec<Command>,
    feeder: Option<Feeder<Owned>>,
}

/// A program that owns its commands.
struct Owned {
    segments: Vec<std::collections::VecDeque<Segment>>,
    /// What changes with each segment of axis 0 that has not been asked for.
    outputs: std::collections::VecDeque<OutputChange>,
    starts: std::collections::VecDeque<u8>,
}

impl carrystep_link::SegmentSource for Owned {
    fn segment(&mut self, axis: u8) -> Option<Segment> {
        self.segments.get_mut(usize::from(axis))?.pop_front()
    }

    fn outputs(&mut self) -> OutputChange {
        self.outputs.pop_front().unwrap_or_default()
    }

    fn start(&mut self) -> Option<u8> {
        self.starts.pop_front()
    }
}

impl Owned {
    /// Does not use `Program`, because that would refuse the mistakes that these tests make.
    fn new(commands: &[Command]) -> Self {
        let own = |axis: u8| {
            commands.iter().filter_map(move |command| match *command {
                Command::Segment { axis: other, segment } if other == axis => Some(segment),
                _ => None,
            })
        };
        let segments = (0..8).map(|axis| own(axis).collect()).collect();
        let start = |command: &Command| {
            if let Command::Start { mask } = *command { Some(mask) } else { None }
        };
        let mut next = OutputChange::NONE;
        let change = |command: &Command| match *command {
            Command::Outputs(change) => {
                next = change;
                None
            }
            Command::Segment { axis: 0, .. } => Some(std::mem::take(&mut next)),
            _ => None,
        };
        let outputs = commands.iter().filter_map(change).collect();
        Self { segments, outputs, starts: commands.iter().filter_map(start).collect() }
    }
}

impl Default for RustClient {
    fn default() -> Self {
        Self { session: Session::new(Timing::default()), commands: Vec::new(), feeder: None }
    }
}

fn number(word: &str) -> u32 {
    word.parse().unwrap_or_else(|_| panic!("{word:?} is no number"))
}

fn long(word: &str) -> i64 {
    word.parse().unwrap_or_else(|_| panic!("{word:?} is no number"))
}

fn hexadecimal(word: &str) -> u64 {
    u64::from_str_radix(word, 16).unwrap_or_else(|_| panic!("{word:?} is no number"))
}

fn fields(answer: &Answer) -> String {
    let Answer { sequence, address, next, cause, free, culprits, seeking, data, .. } = *answer;
    let flags = [
        (answer.fault, 'f'),
        (answer.halted, 'h'),
        (answer.idle, 'i'),
        (answer.ready, 'r'),
        (answer.armed, 'a'),
        (answer.written, 'w'),
    ];
    let flags: String = flags.iter().map(|&(on, letter)| if on { letter } else { '.' }).collect();
    let reason = answer.refusal.map_or(0, Refusal::number);
    format!(
        "{sequence:02x}:{address:02x}:{next:02x}:{flags}:{reason}:{cause}:{free}:{culprits:02x}:{seeking:02x}:{data:08x}"
    )
}

impl RustClient {
    fn send(&mut self, now: u32) -> Vec<u8> {
        self.session
            .transmit(now)
            .map_or(Vec::new(), |request| slip::encode(request.to_bytes().as_slice()).collect())
    }

    fn take(&mut self, now: u32, bytes: &[u8]) -> String {
        let mut said = Vec::new();
        for &byte in bytes {
            let before = self.session.broken();
            match self.session.receive(byte, now) {
                Ok(Some(answer)) => said.push(fields(&answer)),
                Ok(None) if self.session.broken() > before => said.push("damaged".to_owned()),
                Ok(None) => {}
                Err(_) => said.push("lost".to_owned()),
            }
        }
        if said.is_empty() { "-".to_owned() } else { said.join(" ") }
    }

    fn feed(&mut self) -> &'static str {
        let Some(feeder) = &mut self.feeder else { return "fed" };
        match self.session.feed(feeder) {
            Ok(true) => "fed",
            Ok(false) => "feeding",
            Err(ProgramError::NoPower) => "unpowered",
            Err(_) => "bad",
        }
    }
}

impl Client for RustClient {
    fn say(&mut self, words: &str) -> String {
        let yes = |done: bool| if done { "yes" } else { "no" }.to_owned();
        let (verb, rest) = words.split_once(' ').unwrap_or((words, ""));
        let parts: Vec<&str> = rest.split_whitespace().collect();
        let nothing = String::new();
        match (verb, parts.as_slice()) {
            ("begin", [resend, pause]) => {
                *self = Self::default();
                self.session =
                    Session::new(Timing { resend: number(resend), pause: number(pause) });
                nothing
            }
            ("open", [own, axes]) => {
                let own = NonZeroU16::new(hexadecimal(own) as u16).expect("a number");
                self.session.open(own, number(axes) as u8);
                nothing
            }
            ("owns", []) => yes(self.session.number().is_some()),
            ("seek-ended", []) => yes(self.session.seek_ended()),
            ("cut-refused", []) => yes(self.session.cut_refused()),
            ("cut", [mask, slots @ ..]) => {
                let mask = hexadecimal(mask);
                let mut named = CutSlots::default();
                for (axis, slot) in slots.iter().enumerate() {
                    named.0[axis] = (mask >> axis & 1 == 1).then(|| number(slot) as u8);
                }
                yes(self.session.cut(named).is_ok())
            }
            ("stop", []) => {
                self.session.stop();
                nothing
            }
            ("read", [address]) => yes(self.session.read(hexadecimal(address) as u8).is_ok()),
            ("write", [address, word]) => {
                let body = Body::Write {
                    address: hexadecimal(address) as u8,
                    word: hexadecimal(word) as u32,
                };
                yes(self.session.write(body).is_ok())
            }
            ("segment", [axis, ticks, v, a, j, commit]) => {
                let segment = Segment {
                    ticks: number(ticks),
                    v: long(v),
                    a: long(a),
                    j: long(j),
                    last: number(commit) & 1 == 1,
                };
                let change = OutputChange::of_word(number(commit));
                if !change.is_none() {
                    self.commands.push(Command::Outputs(change));
                }
                self.commands.push(Command::Segment { axis: number(axis) as u8, segment });
                nothing
            }
            ("start", [mask]) => {
                self.commands.push(Command::Start { mask: hexadecimal(mask) as u8 });
                nothing
            }
            ("load", []) => {
                self.feeder = Some(Feeder::new(Owned::new(&std::mem::take(&mut self.commands))));
                nothing
            }
            ("feed", []) => self.feed().to_owned(),
            ("withdraw", []) => {
                self.session.withdraw();
                nothing
            }
            ("send", [now]) => hex(&self.send(number(now))),
            ("take", [now, ..]) => self.take(number(now), &unhex(&parts[1..].join(" "))),
            ("step", [now, ..]) => {
                let now = number(now);
                let said = self.take(now, &unhex(&parts[1..].join(" ")));
                let fed = self.feed();
                let mut bytes = Vec::new();
                loop {
                    match self.send(now) {
                        piece if piece.is_empty() => break,
                        piece => bytes.extend(piece),
                    }
                }
                format!("{said} | {fed} | {}", hex(&bytes))
            }
            ("check", [identity, protocol, build, wanted]) => {
                let word = |word| hexadecimal(word) as u32;
                let (identity, protocol) = (word(identity), word(protocol));
                let facts = BuildFacts {
                    identity,
                    protocol,
                    build: hexadecimal(build),
                    ..BuildFacts::default()
                };
                match facts.check(Some(hexadecimal(wanted))) {
                    Ok(()) => "fine",
                    Err(GatewareMismatch::Identity(_)) => "device",
                    Err(GatewareMismatch::Protocol { .. }) => "protocol",
                    Err(GatewareMismatch::Build { .. }) => "build",
                }
                .to_owned()
            }
            ("busy", []) => {
                format!("{} {}", yes(self.session.waiting()), yes(self.session.writing()))
            }
            _ => panic!("no such words: {words}"),
        }
    }
}
