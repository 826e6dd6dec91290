//! The board equals one that executes every clock of link and engine together: in the bytes that
//! its host receives, in all registers, on the pins, wherever a run ends.

use super::*;
use carrystep_core::engine::{Latch, LimitWiring, StatePage};
use carrystep_core::link::registers::{
    CLEAR, CONTROL, CONTROL_ENABLE, OPEN, P_LOW, PHASES, SEEK, SEGMENT, SEGMENTS, SNAPSHOT, START,
    STOP,
};
use carrystep_core::link::{END, ESC, ESC_END, ESC_ESC, Refusal, WRITE};
use carrystep_core::{AXES, Build, PinTiming, StartPhase, Timebase};
use carrystep_model::Engine;
use carrystep_model::fast::{Change, Edge};
use rand_xoshiro::SplitMix64;
use rand_xoshiro::rand_core::{Rng, SeedableRng};

const CLOCK_HZ: u64 = 80_000_000;

/// The clocks for which the host waits for an answer.
const PATIENCE: u64 = 30_000;

/// A board that skips nothing.
struct EveryClock {
    engine: Engine,
    link: Link,
    wire: Wire,
    pins: EngineInputs,
    cycle: u64,
    /// Words of the pages that are not live.
    kept: u64,
    faults: u64,
}

impl EveryClock {
    fn run(&mut self, end: u64, to: &mut dyn Edges) {
        while self.cycle < end {
            let inputs = self.link.outputs().engine.with_pins(&self.pins);
            let engine = self.engine.outputs(&inputs);
            self.kept +=
                engine.state.iter().filter(|word| word.page != StatePage::Live).count() as u64;
            let Driven { rx, spi, .. } = self.wire.drive(self.cycle);
            let axes = self.engine.motion().build().axes();
            let before: Vec<_> = (0..axes).map(|axis| *self.engine.shaper(axis)).collect();
            self.link.clock(&LinkInputs { rx, spi, engine });
            self.engine.clock(&inputs);
            self.cycle += 1;
            let is_fault = engine.fault.is_none() && self.engine.motion().fault().is_some();
            self.faults += u64::from(is_fault);
            for (axis, before) in (0..).zip(&before) {
                let (clock, now) = (self.cycle, self.engine.shaper(axis));
                let mut edge = |change| {
                    to.edge(Edge { clock, axis: axis as u8, change, backward: now.dir });
                };
                if now.step && !before.step {
                    edge(Change::Rise);
                }
                if now.dir != before.dir {
                    edge(Change::DirChange);
                }
            }
            self.wire.hear(self.cycle, self.link.tx());
        }
    }
}

/// A frame with its CRC-32 (ISO-HDLC), escaped, between two ENDs.
fn frame(content: &[u8]) -> Vec<u8> {
    let crc = !content.iter().fold(u32::MAX, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |crc, _| {
            crc >> 1 ^ if crc & 1 == 1 { 0xedb8_8320 } else { 0 }
        })
    });
    let bytes = content.iter().copied().chain(crc.to_le_bytes());
    let escaped = bytes.flat_map(|byte| match byte {
        END => vec![ESC, ESC_END],
        ESC => vec![ESC, ESC_ESC],
        byte => vec![byte],
    });
    [END].into_iter().chain(escaped).chain([END]).collect()
}

/// A random request as an escaped frame. `next` is the number of the next write.
fn request(random: &mut SplitMix64, axes: u8, answers: &Answers, filled: &mut u32) -> Vec<u8> {
    let Answers { next, state, reason, .. } = *answers;
    let mut below = |end: u64| random.next_u64() % end;
    let mask = (1 << axes) - 1;
    let (is_fault, is_ready) = (state & 1 == 1, state & 2 != 0);
    let (address, words) = match below(20) {
        0..15 if reason == Refusal::Session.number() => (OPEN, vec![below(2) as u32]),
        0..10 if is_fault => (CLEAR, vec![0]),
        0..10 if !is_ready => (CONTROL, vec![CONTROL_ENABLE]),
        0..2 => return frame(&[below(256) as u8, below(256) as u8]),
        // The link reads these words in the clocks in which the engine outputs them.
        2..4 => return frame(&[0, P_LOW + below(2) as u8]),
        4 => return frame(&[0, PHASES]),
        5 if below(4) == 0 => (STOP, vec![0]),
        5 if below(4) == 0 => (OPEN, vec![below(2) as u32]),
        5 => (CONTROL, vec![CONTROL_ENABLE]),
        6..10 if *filled != 0 => (START, vec![std::mem::take(filled)]),
        6 => (START, vec![below(256) as u32]),
        12 => (SEEK, vec![mask]),
        10..12 => (SNAPSHOT, vec![0]),
        9 => (CLEAR, vec![0]),
        13 | 14 => {
            // Now and then with an axis that does not exist.
            let axes = if below(20) == 0 { 8 } else { axes };
            let chosen = below(1 << axes) as u32;
            *filled |= chosen & mask;
            let mut words = vec![chosen, below(1000) as u32];
            // Any V, small A, no J.
            let most = [1 << 32, 1 << 32, 1 << 32, 1 << 12, 1, 1].repeat(8);
            let count = 6 * chosen.count_ones() as usize;
            words.extend(most[..count].iter().map(|&most| below(most) as u32));
            words.push(below(2) as u32);
            (SEGMENTS, words)
        }
        _ => {
            // Now and then an axis that does not exist.
            let axes = if below(20) == 0 { 8 } else { axes };
            let axis = below(axes.into()) as u8;
            *filled |= mask & 1 << axis;
            let v = (below(u64::MAX).cast_signed() >> (1 + below(4))).to_le_bytes();
            let a = (below(u64::MAX).cast_signed() >> 12).to_le_bytes();
            let halves = [&v[..4], &v[4..], &a[..4], &a[4..]];
            let [v, v_high, a, a_high] =
                halves.map(|half| u32::from_le_bytes(half.try_into().unwrap()));
            let last = u32::from(below(2) == 0);
            (SEGMENT + axis, vec![below(1000) as u32, v, v_high, a, a_high, 0, 0, last])
        }
    };
    // Now and then another host's request.
    let session = if below(30) == 0 { 2 } else { 1 };
    let mut content = vec![next, WRITE | address, session, 0];
    words.iter().for_each(|word| content.extend(word.to_le_bytes()));
    if below(10) == 0 {
        // A damaged frame, which nothing executes.
        content.pop();
    }
    frame(&content)
}

/// The answers that the host has received.
#[derive(Default)]
struct Answers {
    frame: Vec<u8>,
    count: u64,
    /// The number that the next write must have.
    next: u8,
    /// Bit 0: a fault; bit 1: the drivers are ready.
    state: u8,
    /// The reason of the last refusal.
    reason: u8,
}

impl Answers {
    fn hear(&mut self, byte: u8) {
        match (byte, self.frame.last()) {
            (END, None) => {}
            (END, _) => {
                self.count += 1;
                if let [_, _, next, state, _, _, _, why, ..] = self.frame[..] {
                    (self.next, self.state, self.reason) = (next, state, why >> 4);
                }
                self.frame.clear();
            }
            (ESC_END, Some(&ESC)) => *self.frame.last_mut().unwrap() = END,
            (ESC_ESC, Some(&ESC)) => {}
            (byte, _) => self.frame.push(byte),
        }
    }
}

fn build(axes: usize) -> EngineBuild {
    let timebase = Timebase::new(CLOCK_HZ, 1000, 16).unwrap();
    let build = Build { timebase, phase: StartPhase::Half, pins: [PinTiming::SHORTEST; AXES] };
    let mut build = EngineBuild::minimal(&build, 1 << 58);
    build.guard.limits = LimitWiring::Pair;
    build.guard.round = 16;
    build.pins.truncate(axes);
    build.guard.stop.truncate(axes);
    if axes.is_multiple_of(3) {
        build.guard.latches = vec![Latch::of_pin(false, 1); 3];
    }
    build
}

/// Runs both boards under the same host. Returns the numbers of bytes received, of edges, of words
/// of the pages that are not live, and of stops.
fn compare(axes: usize, on_spi: bool, milliseconds: u64) -> [u64; 4] {
    let mut random = SplitMix64::seed_from_u64(axes as u64);
    let build = build(axes);
    // Bits of 40 clocks, and of eight, the least.
    let baud = if axes.is_multiple_of(2) { 10_000_000 } else { 2_000_000 };
    let uart = Uart::new(CLOCK_HZ, baud).unwrap();
    let mut board =
        if on_spi { ModelBoard::on_spi(&build, 2_000_000) } else { ModelBoard::new(&build, uart) };
    let mut every = EveryClock {
        engine: Engine::new(&build),
        link: board.link.clone(),
        wire: board.wire.clone(),
        pins: board.pins,
        cycle: 0,
        kept: 0,
        faults: 0,
    };
    let (mut edges, mut every_edges) = (Vec::new(), Vec::new());
    let (mut bytes, mut edge_count) = (0, 0);
    let (mut answers, mut asked, mut filled) = (Answers::default(), None, 0);
    while every.cycle < milliseconds * CLOCK_HZ / 1000 {
        // The number of the next write is known once the last request was answered. A damaged
        // request has no answer.
        if asked
            .is_none_or(|(count, cycle)| answers.count > count || every.cycle > cycle + PATIENCE)
        {
            asked = Some((answers.count, every.cycle));
            for byte in request(&mut random, build.axes() as u8, &answers, &mut filled) {
                board.say(byte);
                every.wire.say(byte);
            }
        }
        if random.next_u64().is_multiple_of(10) {
            let mut switches = Switches {
                estop: random.next_u64().is_multiple_of(8),
                limit_min: (1 << (random.next_u64() % 16)) as u8,
                limit_max: (1 << (random.next_u64() % 16)) as u8,
                inputs: [0; 2].map(|_: u8| random.next_u64() as u8),
                ..Switches::default()
            };
            switches.latch = switches.limit_max;
            board.press(switches);
            every.pins = board.pins;
        }
        let longest = if random.next_u64().is_multiple_of(4) { 30_000 } else { 3000 };
        let end = every.cycle + 1 + random.next_u64() % longest;
        every.run(end, &mut every_edges);
        while board.cycle() < end {
            board.run(end, &mut edges);
        }
        assert_eq!(edges, every_edges, "edges up to cycle {end}");
        edge_count += edges.len() as u64;
        edges.clear();
        every_edges.clear();
        assert_eq!(
            board.link.outputs(),
            every.link.outputs(),
            "outputs of the link in cycle {end}"
        );
        for address in 0..=u8::MAX {
            let registers = [&board.link, &every.link].map(|link| link.register(address));
            assert_eq!(registers[0], registers[1], "register {address:#04x} in cycle {end}");
        }
        assert_eq!(board.engine.core(), every.engine.motion(), "engine in cycle {end}");
        assert_eq!(board.engine.readout(), every.engine.readout(), "readout in cycle {end}");
        loop {
            let received = [board.next_byte(), every.wire.next_byte()];
            assert_eq!(received[0], received[1], "bytes up to cycle {end}");
            let Some(byte) = received[0] else { break };
            answers.hear(byte);
            bytes += 1;
        }
    }
    [bytes, edge_count, every.kept, every.faults]
}

#[test]
fn board_that_skips_clocks_equals_one_that_executes_all() {
    for on_spi in [false, true] {
        let mut met = [0; 4];
        for axes in 1..=AXES {
            let one = compare(axes, on_spi, 80);
            met.iter_mut().zip(one).for_each(|(all, one)| *all += one);
        }
        let least = [10_000, 100, 300, 20];
        let enough = met.iter().zip(least).all(|(count, least)| *count > least);
        assert!(enough, "bytes, edges, words, faults: {met:?}");
    }
}

/// Sends a write, and hears its answer.
fn write(board: &mut ModelBoard, answers: &mut Answers, address: u8, words: &[u32]) {
    say_write(board, answers.next, address, words);
    board.run(board.cycle() + PATIENCE, &mut ());
    std::iter::from_fn(|| board.next_byte()).for_each(|byte| answers.hear(byte));
}

fn say_write(board: &mut ModelBoard, next: u8, address: u8, words: &[u32]) {
    let mut content = vec![next, WRITE | address, 1, 0];
    words.iter().for_each(|word| content.extend(word.to_le_bytes()));
    frame(&content).into_iter().for_each(|byte| board.say(byte));
}

/// The link does not look for a fault between two words of a segment: the engine ends each offer at
/// once.
#[test]
fn stop_amid_the_words_of_a_segment_ends_their_offers() {
    let mut board = ModelBoard::new(&build(2), Uart::new(CLOCK_HZ, 10_000_000).unwrap());
    let mut answers = Answers::default();
    write(&mut board, &mut answers, OPEN, &[0]);
    write(&mut board, &mut answers, CONTROL, &[CONTROL_ENABLE]);
    say_write(&mut board, answers.next, SEGMENT, &[1000, 1 << 20, 0, 0, 0, 0, 0, 1]);
    while board.link.awaits() != Some(Awaited::Acceptance) {
        board.run(board.cycle() + 1, &mut ());
    }
    let mut met = 0;
    for after in (1..800).step_by(7) {
        let mut every = board.clone();
        let (pressed, end) = (board.cycle() + after, board.cycle() + 2000);
        let mut skips = board.clone();
        skips.run(pressed, &mut ());
        skips.press(Switches { estop: true, ..Switches::default() });
        skips.run(end, &mut ());
        while every.cycle() < end {
            if every.cycle() == pressed {
                every.press(Switches { estop: true, ..Switches::default() });
            }
            let offers = every.link.awaits() == Some(Awaited::Acceptance);
            met += u64::from(offers && every.engine.core().fault().is_some());
            every.watch(every.cycle() + 1, &mut |_, _| ());
        }
        assert_eq!(skips.link.outputs(), every.link.outputs(), "link, pressed after {after}");
        assert_eq!(skips.engine.core(), every.engine.core(), "engine, pressed after {after}");
    }
    assert!(met > 20, "{met} words were offered to a stopped engine");
}
