//! Checks whether a part's block RAMs hold the memories of engine and link.
//!
//! A memory that is wider than a block RAM, or of whose words more parts are written separately than
//! a block RAM has write enables, takes several of them. No two memories share one.

use super::{BlockRam, Board, BoardError, Family, Part};
use carrystep_core::engine::{InputRow, LimitWiring, MAX_AXES, QUEUE_DEPTHS, adder_counts};
use carrystep_core::{ChosenTick, EngineBuild};

/// A memory of the gateware.
#[derive(Debug, Clone, Copy)]
struct Memory {
    words: u32,
    /// Bits of a word.
    bits: u32,
    /// Parts of a word that are written separately.
    parts: u32,
}

/// The block RAMs that a gateware takes.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Blocks {
    halves: u32,
    /// Block RAMs of all kinds, as yosys counts them.
    pub of_all_kinds: u32,
}

impl Blocks {
    /// Block RAMs as the data of a part count them: two halves are one.
    pub fn whole(self) -> u32 {
        self.halves.div_ceil(2)
    }
}

/// The memories of engine and link of a build. What has no use in a build is not there: the switches
/// of a machine without limits and inputs, and the words of outputs and PWM.
fn memories(build: &EngineBuild, family: Family) -> Vec<Memory> {
    let whole = |words, bits| Memory { words, bits, parts: 1 };
    let slots = build.slots() as u32;
    let segments = if build.axes() < MAX_AXES { 64 * slots } else { (64 * slots).max(1024) };
    let has_switches = build.guard.limits != LimitWiring::None
        || build.guard.inputs.iter().any(|row| row.exist != 0);
    // Of each adder: segments, control words, marks of last segments, event wheel, switches and
    // register mirror.
    let mut of_adder = vec![whole(segments, 32), whole(8, 31), whole(8 * slots, 1)];
    if family.facts().writes_parts_of_words() {
        of_adder.push(Memory { words: 128, bits: 16, parts: 16 });
    }
    if has_switches {
        of_adder.push(whole(32, 8));
    }
    of_adder.push(Memory { words: 256, bits: 32, parts: 2 });
    // Program, data and received bytes of the link's processor.
    let mut all = vec![whole(512, 16), whole(512, 8), whole(512, 8)];
    if build.has_several_latches() {
        all.push(Memory { words: 256, bits: 32, parts: 2 });
    }
    if build.outputs.exist != 0 {
        all.push(whole(slots, 16));
    }
    if build.outputs.pwm_divider != 0 {
        all.push(whole(slots, 13));
    }
    all.extend((0..build.adders).flat_map(|_| of_adder.iter().copied()));
    all
}

/// The fewest blocks of a family that hold a memory.
fn blocks(memory: Memory, family: Family) -> Blocks {
    let of_kind = |kind: &BlockRam| {
        let width = kind.widths.iter().find(|(words, _)| memory.words <= *words)?.1;
        let count = memory.bits.div_ceil(width).max(memory.parts.div_ceil(kind.enables));
        Some(Blocks { halves: count * kind.halves, of_all_kinds: count })
    };
    family.facts().block_rams().iter().filter_map(of_kind).min().unwrap_or_default()
}

/// The block RAMs that engine and link of a build take in a part of a family.
pub fn block_rams(build: &EngineBuild, family: Family) -> Blocks {
    memories(build, family).into_iter().fold(Blocks::default(), |sum, memory| {
        let Blocks { halves, of_all_kinds } = blocks(memory, family);
        Blocks { halves: sum.halves + halves, of_all_kinds: sum.of_all_kinds + of_all_kinds }
    })
}

/// A build of the same machine that takes fewer block RAMs, and what it differs in, in words.
type Smaller = (String, EngineBuild);

/// The builds with fewer adders, the most first; those of one number have the same queues or shorter
/// ones.
fn with_fewer_adders(build: &EngineBuild) -> Vec<Smaller> {
    let (time, axes) = (&build.timebase, build.axes());
    let smaller = |adders| {
        let tick = ChosenTick::with_adders(time.clock_hz(), time.phases(), axes, adders);
        let longer = tick.map(|tick| tick.tick_ns).filter(|&tick_ns| tick_ns > time.tick_ns());
        let ticks = longer.map_or_else(String::new, |tick_ns| format!(" in ticks of {tick_ns} ns"));
        let what = format!("adders = {adders}{ticks}");
        let fewer = EngineBuild { adders, ..build.clone() };
        let shorter = with_shorter_queues(&fewer).into_iter();
        let shorter: Vec<Smaller> =
            shorter.map(|(depth, other)| (format!("{what} with {depth}"), other)).collect();
        [vec![(what, fewer)], shorter].concat()
    };
    let mut counts: Vec<usize> = adder_counts(axes).filter(|&it| it < build.adders).collect();
    counts.reverse();
    counts.into_iter().flat_map(smaller).collect()
}

/// The builds with shorter queues, the longest first.
fn with_shorter_queues(build: &EngineBuild) -> Vec<Smaller> {
    let shorter = QUEUE_DEPTHS.into_iter().rev().filter(|&depth| depth < build.queue);
    let smaller =
        |queue| (format!("queue_depth = {queue}"), EngineBuild { queue, ..build.clone() });
    shorter.map(smaller).collect()
}

/// The build without limits and inputs.
fn without_switches(build: &EngineBuild) -> Vec<Smaller> {
    let mut other = build.clone();
    other.guard.limits = LimitWiring::None;
    other.guard.inputs = [InputRow::default(); 2];
    vec![("a machine without limits and inputs".to_owned(), other)]
}

impl Board {
    /// Checks that the block RAMs of a part hold the memories of a build's engine and link.
    ///
    /// # Errors
    /// [`BoardError::BlockRams`] names what fits: a number of adders, a depth of the queues, a
    /// machine without switches, and other parts of the board.
    pub fn holds(&self, part: &Part, build: &EngineBuild) -> Result<(), BoardError> {
        let needs = block_rams(build, self.family).whole();
        if needs <= part.block_rams {
            return Ok(());
        }
        let first_that_fits = |smaller: Vec<Smaller>| {
            let needs = |build| block_rams(build, self.family).whole();
            let mut needed = smaller.iter().map(|(what, build)| (what, needs(build)));
            let (what, needs) = needed.find(|(_, needs)| *needs <= part.block_rams)?;
            Some(format!("{what} takes {needs}"))
        };
        let single =
            [with_fewer_adders(build), with_shorter_queues(build), without_switches(build)];
        let mut ways: Vec<String> = single.into_iter().filter_map(first_that_fits).collect();
        let larger = self.parts.iter().filter(|other| other.block_rams >= needs);
        ways.extend(larger.map(|it| format!("its part {} has {}", it.name, it.block_rams)));
        if ways.is_empty() {
            ways.push("take a board with a larger part".to_owned());
        }
        Err(BoardError::BlockRams {
            board: self.name.clone(),
            part: part.name.clone(),
            has: part.block_rams,
            needs,
            adders: build.adders,
            depth: build.queue,
            instead: ways.join(", "),
        })
    }
}
