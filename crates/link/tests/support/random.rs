//! Random numbers that are the same on every machine, and random programs.

use carrystep_link::{Command, OutputChange, Segment};
use rand_xoshiro::SplitMix64;
use rand_xoshiro::rand_core::{Rng, SeedableRng};

/// The generator SplitMix64.
#[derive(Debug, Clone)]
pub struct Random(SplitMix64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(SplitMix64::seed_from_u64(seed))
    }

    pub fn next(&mut self) -> u64 {
        self.0.next_u64()
    }

    pub fn below(&mut self, end: u64) -> u64 {
        self.next() % end
    }

    /// True with a probability of `per_million` in a million.
    pub fn happens(&mut self, per_million: u32) -> bool {
        self.below(1_000_000) < u64::from(per_million)
    }

    /// A random word in which END, ESC and the escaped codes are frequent.
    fn word(&mut self) -> i64 {
        let bytes = [0; 8].map(|_| {
            let any = self.next() as u8;
            if self.below(4) == 0 { [0xc0, 0xdb, 0xdc, 0xdd][usize::from(any & 3)] } else { any }
        });
        i64::from_le_bytes(bytes)
    }
}

/// A program of at least `segments` segments, in moves of all axes together, in the order in which
/// a planner emits them. A segment lasts about `ticks` ticks.
pub fn program(random: &mut Random, axes: u8, segments: usize, ticks: u32) -> Vec<Command> {
    let mut commands = Vec::new();
    let mut so_far = 0;
    while so_far < segments {
        let counts: Vec<u32> = (0..axes).map(|_| 1 + random.below(40) as u32).collect();
        let most = counts.iter().copied().max().unwrap_or(1);
        let total = most * ticks;
        let mut due: Vec<(u32, u8, Segment)> = Vec::new();
        for (axis, &count) in (0..axes).zip(&counts) {
            for k in 0..count {
                let (from, to) = (
                    total / count * k,
                    if k + 1 == count { total } else { total / count * (k + 1) },
                );
                let (v, a, j) = (random.word(), random.word(), random.word());
                due.push((from, axis, Segment { ticks: to - from, v, a, j, last: k + 1 == count }));
            }
        }
        due.sort_by_key(|&(from, axis, _)| (from, axis));
        so_far += due.len();
        for (index, (_, axis, segment)) in due.into_iter().enumerate() {
            if index == usize::from(axes) {
                commands.push(Command::Start { mask: ((1_u16 << axes) - 1) as u8 });
            }
            if axis == 0 && random.below(3) == 0 {
                let change = OutputChange::of_word(random.word() as u32);
                if !change.is_none() {
                    commands.push(Command::Outputs(change));
                }
            }
            commands.push(Command::Segment { axis, segment });
        }
        if !matches!(commands.last(), Some(Command::Start { .. }))
            && counts.iter().all(|&count| count == 1)
        {
            commands.push(Command::Start { mask: ((1_u16 << axes) - 1) as u8 });
        }
    }
    commands
}
