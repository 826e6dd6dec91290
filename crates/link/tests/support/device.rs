//! The gateware's end of the link in miniature, written from docs/protocol.md without use of this
//! crate.

use std::collections::VecDeque;

/// CRC-32, computed bit by bit.
pub fn crc(bytes: &[u8]) -> u32 {
    let mut crc = u32::MAX;
    for byte in bytes {
        for bit in 0..8 {
            let feedback = (crc ^ u32::from(byte >> bit)) & 1;
            crc = (crc >> 1) ^ (feedback * 0xedb8_8320);
        }
    }
    !crc
}

/// Appends the CRC to a frame and escapes it for the line.
pub fn on_the_line(frame: &[u8]) -> Vec<u8> {
    let mut line = vec![0xc0];
    for byte in frame.iter().copied().chain(crc(frame).to_le_bytes()) {
        match byte {
            0xc0 => line.extend([0xdb, 0xdc]),
            0xdb => line.extend([0xdb, 0xdd]),
            _ => line.push(byte),
        }
    }
    line.push(0xc0);
    line
}

/// Effects of the writes, in the order of their execution.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Done {
    Write(u8, u32),
    Segment(u8, [u32; 8]),
}

/// Bugs for the mutation tests.
#[derive(Debug, Clone, Copy, Default)]
pub struct Bugs {
    pub no_crc: bool,
    pub executes_again: bool,
    pub skips_the_missing: bool,
    pub no_escape: bool,
}

#[derive(Debug, Default)]
pub struct Device {
    pub axes: u8,
    pub bugs: Bugs,
    pub facts: [u32; 9],
    pub log: Vec<Done>,
    pub fault: Option<u8>,
    pub position: [i32; 8],
    pub frames: u64,
    pub damaged: u64,
    pub repeated: u64,
    pub out_of_turn: u64,
    /// The number of the owner's session; 0: nobody owns it.
    pub session: u16,
    bytes: Vec<u8>,
    escaped: bool,
    broken: bool,
    pub next: u8,
    pub powered: bool,
    pressed: bool,
    armed: Option<u8>,
    queues: [VecDeque<(u32, bool)>; 8],
    running: [Option<(u32, bool)>; 8],
}

impl Device {
    pub fn new(axes: u8, next: u8) -> Self {
        let facts =
            [0x5054_5343, 2, 0x89ab_cdef, 0x0123_4567, axes.into(), 48_000_000, 2000, 16, 50_000];
        Self { axes, next, facts, ..Self::default() }
    }

    /// Processes a byte from the host; returns the bytes of the answer that it causes.
    pub fn byte(&mut self, byte: u8) -> Vec<u8> {
        if byte != 0xc0 {
            match (self.escaped, byte) {
                (false, 0xdb) if !self.bugs.no_escape => self.escaped = true,
                (true, 0xdc | 0xdd) => {
                    self.bytes.push(if byte == 0xdc { 0xc0 } else { 0xdb });
                    self.escaped = false;
                }
                (true, _) => self.broken = true,
                (false, _) => self.bytes.push(byte),
            }
            return Vec::new();
        }
        let frame = std::mem::take(&mut self.bytes);
        let broken = std::mem::take(&mut self.broken) | std::mem::take(&mut self.escaped);
        if frame.is_empty() && !broken {
            return Vec::new();
        }
        match frame.split_last_chunk::<4>() {
            Some((content, sum))
                if !broken && (self.bugs.no_crc || crc(content).to_le_bytes() == *sum) =>
            {
                self.request(content)
            }
            _ => {
                self.damaged += 1;
                Vec::new()
            }
        }
    }

    fn request(&mut self, content: &[u8]) -> Vec<u8> {
        let [sequence, address, rest @ ..] = content else { return Vec::new() };
        let (sequence, address) = (*sequence, *address);
        let (session, words) = match rest {
            [] => (None, &[][..]),
            [low, high, words @ ..] => (Some(u16::from_le_bytes([*low, *high])), words),
            [_] => (Some(0), &[0][..]),
        };
        let written = !words.is_empty();
        let words: Vec<u32> = words
            .chunks(4)
            .map(|w| if let [a, b, c, d] = *w { u32::from_le_bytes([a, b, c, d]) } else { 0 })
            .collect();
        let expected = match address {
            _ if !written => 2 + session.map_or(0, |_| 2),
            0..0x80 => 0,
            0xc8 => 4 + 4 * (3 + 6 * (words[0] & 0xff).count_ones() as usize),
            0xc0.. => 36,
            _ => 8,
        };
        if content.len() != expected {
            self.damaged += 1;
            return Vec::new();
        }
        self.frames += 1;
        let owns = session.is_some_and(|number| number != 0 && number == self.session);
        let reason = match address {
            _ if !written => {
                if session.is_none() || owns {
                    0
                } else {
                    3
                }
            }
            0xa5 => self.open(session.unwrap_or(0)),
            0xa6 => {
                self.log.push(Done::Write(0x26, words[0]));
                self.stop(7);
                0
            }
            _ if !owns => 3,
            _ => match self.next.wrapping_sub(sequence) {
                0 => {
                    if self.execute(address & 0x7f, &words) {
                        0
                    } else {
                        2
                    }
                }
                1..=127 if self.bugs.executes_again => {
                    self.execute(address & 0x7f, &words);
                    0
                }
                1..=127 => {
                    self.repeated += 1;
                    0
                }
                _ if self.bugs.skips_the_missing => {
                    self.next = sequence;
                    self.execute(address & 0x7f, &words);
                    0
                }
                _ => 1,
            },
        };
        self.out_of_turn += u64::from(reason != 0);
        self.answer(sequence, address, written, reason, &words)
    }

    /// Opens a session; returns the reason of a refusal.
    fn open(&mut self, number: u16) -> u8 {
        match number {
            0 => 3,
            _ if !self.idle() && self.fault.is_none() => 2,
            _ => {
                self.session = number;
                self.next = 0;
                0
            }
        }
    }

    /// Executes a write; returns false if the device is busy.
    fn execute(&mut self, address: u8, words: &[u32]) -> bool {
        let axis = usize::from(address & 7);
        if address == 0x21 && self.armed.is_some() {
            return false;
        }
        self.next = self.next.wrapping_add(1);
        if address >= 0x40 {
            let (mask, ticks, cubics) = match address {
                0x48 => (words[0] as u8, words[1], &words[2..words.len() - 1]),
                _ => (1 << axis, words[0], &words[1..7]),
            };
            let last = words[words.len() - 1];
            let axes = (0..8).filter(|axis| mask >> axis & 1 == 1);
            let full = |axis: &usize| *axis >= self.axes.into() || self.queues[*axis].len() == 7;
            if self.fault.is_none() && (mask == 0 || axes.clone().any(|axis| full(&axis))) {
                self.fault = Some(2);
            }
            for (axis, cubic) in axes.zip(cubics.chunks(6)) {
                let words = [&[ticks], cubic, &[last]].concat();
                self.log.push(Done::Segment(axis as u8, words.try_into().expect("8 words")));
                if self.fault.is_none() {
                    self.queues[axis].push_back((ticks.wrapping_add(1), last & 1 == 1));
                }
            }
            return true;
        }
        self.log.push(Done::Write(address, words[0]));
        let mask = words[0] as u8;
        match address {
            0x20 => self.powered = words[0] & 1 == 1,
            0x21 if self.fault.is_none() => {
                if (0..8).any(|axis| mask >> axis & 1 == 1 && self.queues[axis].is_empty()) {
                    self.stop(2);
                } else {
                    self.armed = Some(mask);
                }
            }
            0x22 if self.fault.is_some() => {
                self.fault = self.pressed.then_some(0);
                self.queues.iter_mut().for_each(VecDeque::clear);
            }
            _ => {}
        }
        true
    }

    /// An axis runs a segment of so many ticks, which another host has sent.
    pub fn load(&mut self, axis: usize, ticks: u32) {
        self.running[axis] = Some((ticks, true));
    }

    /// Asserts or releases the e-stop.
    pub fn press(&mut self, pressed: bool) {
        self.pressed = pressed;
        if pressed {
            self.stop(0);
        }
    }

    /// Stops the motion. A ramp takes no time here.
    pub fn stop(&mut self, cause: u8) {
        self.fault.get_or_insert(cause);
        self.armed = None;
        self.running = [None; 8];
    }

    fn answer(
        &self,
        sequence: u8,
        address: u8,
        written: bool,
        reason: u8,
        words: &[u32],
    ) -> Vec<u8> {
        let axis = match address {
            0xc8 if written => 0,
            _ if written && address < 0xc0 => 0,
            _ => usize::from(address & 7),
        };
        let data = match address {
            0..0x18 if !written => self.facts.get(usize::from(address)).copied().unwrap_or(0),
            _ => self.position[axis] as u32,
        };
        let mask = if written && address == 0xc8 { words[0] } else { 1 << axis };
        let room = (0..8).filter(|axis| mask >> axis & 1 == 1).map(|axis| self.queues[axis].len());
        let free = 7 - room.max().unwrap_or(0) as u8;
        let halted = self.fault.is_some();
        let flags = [
            halted,
            self.powered,
            self.armed.is_some(),
            written,
            false,
            false,
            self.idle(),
            halted,
        ];
        let flags = flags.iter().rev().fold(0, |bits, &on| bits << 1 | u8::from(on));
        let cause = self.fault.unwrap_or(0) | reason << 4;
        let mut frame = vec![sequence, address, self.next, flags, free, 0, 0, cause];
        frame.extend(data.to_le_bytes());
        on_the_line(&frame)
    }

    pub fn idle(&self) -> bool {
        self.armed.is_none()
            && self.running.iter().all(Option::is_none)
            && self.queues.iter().all(VecDeque::is_empty)
    }

    /// Advances time by `ticks`: starts moves, runs segments, and stops on empty queues. V moves
    /// the position by its whole steps per tick.
    pub fn elapse(&mut self, mut ticks: u32) {
        while ticks > 0 && self.fault.is_none() {
            if let Some(mask) = self.armed {
                let masked = |axis: &usize| mask >> axis & 1 == 1;
                if (0..8)
                    .filter(masked)
                    .all(|axis| self.running[axis].is_none() && !self.queues[axis].is_empty())
                {
                    self.armed = None;
                    (0..8)
                        .filter(masked)
                        .for_each(|axis| self.running[axis] = self.queues[axis].pop_front());
                }
            }
            let Some(step) = self
                .running
                .iter()
                .flatten()
                .map(|(left, _)| *left)
                .min()
                .map(|least| least.min(ticks))
            else {
                return;
            };
            ticks -= step;
            for axis in 0..8 {
                let Some((left, last)) = self.running[axis] else { continue };
                self.position[axis] = self.position[axis].wrapping_add(step as i32);
                self.running[axis] = match (left - step, last) {
                    (0, true) => None,
                    (0, false) => match self.queues[axis].pop_front() {
                        None => return self.stop(6),
                        follower => follower,
                    },
                    (left, last) => Some((left, last)),
                };
            }
        }
    }
}
