//! A host made from a test client (crates/link/tests/support/client.rs), in Rust or in C, on any
//! line.

use super::link::client::Client;
use super::link::{hex, unhex};
use carrystep_link::registers::{
    AXIS_COUNT, BUILD_HIGH, BUILD_LOW, CLEAR, CONTROL, CONTROL_ENABLE, IDENTITY, POSITION, PROTOCOL,
};
use carrystep_link::{Clock, Command, Line, OutputChange, frame};
use std::fmt::Debug;

/// Time limit for anything that is waited for, ms.
const PATIENCE: u32 = 20_000;

/// An answer, as the client prints it.
#[derive(Debug, Clone, Default)]
pub struct Heard {
    pub address: u8,
    pub next: u8,
    /// A letter for each flag that is set.
    pub flags: String,
    pub cause: u8,
    pub data: u32,
}

impl Heard {
    fn of(words: &str) -> Self {
        let parts: Vec<&str> = words.split(':').collect();
        let [_, address, next, flags, _, cause, .., data] = parts.as_slice() else {
            panic!("the client said {words:?}")
        };
        let number = |text, radix| u32::from_str_radix(text, radix).expect("a number");
        let (address, next) = (number(address, 16) as u8, number(next, 16) as u8);
        let flags = flags.replace('.', "");
        Self { address, next, flags, cause: number(cause, 10) as u8, data: number(data, 16) }
    }

    fn is(&self, flag: char) -> bool {
        self.flags.contains(flag)
    }
}

/// The client, and the state of its requests.
pub struct WordHost<'a, L, C> {
    client: &'a mut dyn Client,
    line: L,
    clock: C,
    out: Vec<u8>,
    came: Vec<u8>,
    /// Whether a program is being sent.
    feeds: bool,
    /// The last answer.
    pub last: Heard,
}

/// Why a connection was refused.
#[derive(Debug, PartialEq, Eq)]
pub struct Refused {
    /// The client's verdict.
    pub verdict: String,
    /// Build id of the board.
    pub build: u64,
}

impl<'a, L: Line<Error: Debug>, C: Clock> WordHost<'a, L, C> {
    /// Reads the facts of the board, and refuses any build but `wanted`.
    pub fn connect(
        client: &'a mut dyn Client,
        line: L,
        clock: C,
        resend: u32,
        wanted: u64,
    ) -> Result<Self, Refused> {
        client.say(&format!("begin {resend} 2"));
        let mut host = Self {
            client,
            line,
            clock,
            out: Vec::new(),
            came: Vec::new(),
            feeds: false,
            last: Heard::default(),
        };
        let [identity, protocol, low, high, axes] =
            [IDENTITY, PROTOCOL, BUILD_LOW, BUILD_HIGH, AXIS_COUNT]
                .map(|address| host.register(address));
        let build = u64::from(high) << 32 | u64::from(low);
        let verdict =
            host.client.say(&format!("check {identity:x} {protocol:x} {build:x} {wanted:x}"));
        if verdict != "fine" {
            return Err(Refused { verdict, build });
        }
        host.until("the session", |host| {
            host.client.say(&format!("open 1a2b {axes}"));
            host.until("the answer", |host| {
                host.pump();
                !host.waits()
            });
            host.client.say("owns") == "yes"
        });
        Ok(host)
    }

    /// Exchanges all bytes that can be sent and received. Returns whether the whole program was
    /// sent.
    fn pump(&mut self) -> bool {
        let now = self.clock.milliseconds();
        let came = hex(&self.came);
        let mut fed = false;
        let answers = if self.feeds {
            let said = self.client.say(&format!("step {now} {came}"));
            let parts: Vec<&str> = said.split(" | ").collect();
            let [answers, feeding, bytes] = parts.as_slice() else {
                panic!("the client said {said:?}")
            };
            assert_ne!(*feeding, "bad");
            fed = *feeding == "fed";
            self.out.extend(unhex(bytes));
            (*answers).to_owned()
        } else {
            let answers = self.client.say(&format!("take {now} {came}"));
            let mut bytes = self.client.say(&format!("send {now}"));
            while bytes != "-" {
                self.out.extend(unhex(&bytes));
                bytes = self.client.say(&format!("send {now}"));
            }
            answers
        };
        assert!(!answers.contains("lost"), "the session is lost: {answers}");
        for words in answers.split(' ').filter(|&words| words != "-" && words != "damaged") {
            self.last = Heard::of(words);
        }
        let mut into = [0; 256];
        let done = self.line.exchange(&self.out, &mut into).expect("the line is there");
        self.out.drain(..done.sent);
        self.came = into[..done.received].to_vec();
        fed
    }

    /// Whether an answer is outstanding.
    fn waits(&mut self) -> bool {
        self.client.say("busy") != "no no"
    }

    fn until(&mut self, what: &str, mut is: impl FnMut(&mut Self) -> bool) {
        let begin = self.clock.milliseconds();
        while !is(self) {
            let waited = self.clock.milliseconds().wrapping_sub(begin);
            assert!(waited < PATIENCE, "{what} has not come: {:?}", self.last);
        }
    }

    /// Reads a register.
    pub fn register(&mut self, address: u8) -> u32 {
        assert_eq!(self.client.say(&format!("read {address:02x}")), "yes");
        self.last.address = 0xff;
        self.until("the register", |host| {
            host.pump();
            host.last.address == address
        });
        self.last.data
    }

    /// Writes a register, and waits until the write was executed.
    pub fn write(&mut self, address: u8, word: u32) {
        self.until("room", |host| {
            host.client.say(&format!("write {address:02x} {word:x}")) == "yes"
        });
        self.until("the write", |host| {
            host.pump();
            !host.waits()
        });
    }

    fn wait(&mut self, what: &str, is: impl Fn(&Heard) -> bool) {
        self.until(what, |host| {
            host.register(POSITION);
            is(&host.last)
        });
    }

    /// Powers the drivers.
    pub fn enable(&mut self) {
        self.write(CONTROL, CONTROL_ENABLE);
        self.wait("power", |last| last.is('r'));
    }

    /// Executes moves; stops when `watch` returns true. Returns the cause if the machine has
    /// stopped.
    pub fn stream(&mut self, commands: &[Command], mut watch: impl FnMut() -> bool) -> Option<u8> {
        let mut outputs = OutputChange::NONE;
        for command in commands {
            self.client.say(&match command {
                Command::Outputs(change) => {
                    outputs = *change;
                    continue;
                }
                Command::Segment { axis, segment: s } => {
                    let change = if *axis == 0 { std::mem::take(&mut outputs).word() } else { 0 };
                    format!(
                        "segment {axis} {} {} {} {} {}",
                        s.ticks,
                        s.v,
                        s.a,
                        s.j,
                        u32::from(s.last) | change
                    )
                }
                Command::Start { mask } => format!("start {mask:02x}"),
            });
        }
        self.client.say("load");
        self.feeds = true;
        self.until("the end", |host| {
            let fed = host.pump() && !host.waits();
            if fed {
                host.register(POSITION);
            }
            if watch() && !host.last.is('f') {
                host.rest(true);
            }
            host.last.is('f') || fed && host.last.is('i')
        });
        if self.last.is('f') {
            self.rest(false);
            return Some(self.last.cause);
        }
        self.feeds = false;
        None
    }

    /// Withdraws the program, stops the axes if they are to be stopped, and waits until they rest.
    fn rest(&mut self, stop: bool) {
        self.feeds = false;
        self.client.say(if stop { "stop" } else { "withdraw" });
        self.until("the stop", |host| {
            host.pump();
            !host.waits()
        });
        self.wait("rest", |last| last.is('h'));
    }

    /// Ends a stop.
    pub fn clear(&mut self) {
        self.write(CLEAR, 0);
        self.wait("the clear", |last| !last.is('f'));
    }

    /// Position of an axis, steps.
    pub fn position(&mut self, axis: u8) -> i32 {
        self.register(frame::of_axis(POSITION, axis)).cast_signed()
    }
}
