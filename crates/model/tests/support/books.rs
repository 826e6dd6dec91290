//! Books of switches, of the latch and of seeks, kept from the history of the inputs and not from
//! registers: a debounced level is the last one that so many samples in a row have shown.

use super::host::Cycle;
use carrystep_core::EngineBuild;
use carrystep_core::engine::{
    EngineInputs, LimitWiring, SWITCH_LEVEL, SWITCH_ROWS, SWITCH_STATE, SeekSource, StatePage,
};

/// A level that counts once this many samples in a row have shown it.
#[derive(Debug, Clone)]
pub struct Debounced {
    enough: usize,
    samples: Vec<bool>,
    pub state: bool,
}

impl Debounced {
    pub fn new(enough: usize) -> Self {
        Self { enough, samples: Vec::new(), state: false }
    }

    /// Takes a sample; returns true if the state changes with it.
    pub fn sample(&mut self, level: bool) -> bool {
        self.samples.push(level);
        let last = self.samples.iter().rev().take(self.enough);
        let changes = last.filter(|sample| **sample != self.state).count() == self.enough;
        self.state ^= changes;
        changes
    }
}

/// The level at the pin of a switch; true is active.
pub fn level(build: &EngineBuild, inputs: &EngineInputs, row: usize, axis: usize) -> bool {
    let guard = &build.guard;
    // Applying the polarity twice gives what is active at the pins.
    let active = inputs.levels(guard);
    let bit = |mask: u8, bit: usize| mask >> bit & 1 == 1;
    match row {
        0 if guard.limits == LimitWiring::One => bit(active.limit_min, 0),
        0 => bit(active.limit_min, axis),
        1 => bit(active.limit_max, axis),
        _ => bit(active.inputs[row - 2] & guard.inputs[row - 2].exist, axis),
    }
}

/// The rows that a build samples.
fn is_sampled(build: &EngineBuild, row: usize) -> bool {
    match row {
        0 => build.guard.limits != LimitWiring::None,
        1 => build.guard.limits == LimitWiring::Pair,
        _ => build.guard.inputs[row - 2].exist != 0,
    }
}

/// The books of everything but the axes.
#[derive(Debug)]
pub struct Around<'a> {
    build: &'a EngineBuild,
    /// The switches, row by row.
    switches: Vec<Vec<Debounced>>,
    tick_of_round: u32,
    /// A reset was requested, and not completed.
    ending: bool,
    /// Ticks in which the engine was resetting.
    resetting: u32,
    source: SeekSource,
    latch: Debounced,
    armed: bool,
    edges: u8,
    /// The axes whose state at a hit is still to be output.
    captures: Vec<bool>,
    /// The requests for a snapshot that are not due yet.
    asked: bool,
    pub page_of: Vec<StatePage>,
    pub counts: Counts,
}

/// How often things have happened.
#[derive(Debug, Default, Clone, Copy)]
pub struct Counts {
    pub own_hits: u64,
    pub common_hits: u64,
    pub hits_of_level_0: u64,
    pub latched: u64,
    pub edges: u64,
    /// Hits that were output after the latch.
    pub hits_after_the_latch: u64,
    pub snapshots: u64,
    /// Snapshots that waited for a hit, and for the latch.
    pub deferred: [u64; 2],
    pub words_of_switches: u64,
}

impl Counts {
    /// All counts, in the order of their declaration.
    pub fn all(self) -> [u64; 10] {
        let Self { own_hits, common_hits, hits_of_level_0, latched, edges, .. } = self;
        let Self { hits_after_the_latch, snapshots, deferred: [by_hit, by_latch], .. } = self;
        [
            own_hits,
            common_hits,
            hits_of_level_0,
            latched,
            edges,
            hits_after_the_latch,
            snapshots,
            by_hit,
            by_latch,
            self.words_of_switches,
        ]
    }
}

impl<'a> Around<'a> {
    pub fn new(build: &'a EngineBuild) -> Self {
        let (axes, guard) = (build.axes(), &build.guard);
        let row = || vec![Debounced::new(guard.debounce as usize); axes];
        Self {
            build,
            switches: (0..SWITCH_ROWS).map(|_| row()).collect(),
            tick_of_round: 0,
            ending: false,
            resetting: 0,
            source: SeekSource::default(),
            latch: Debounced::new(guard.latches.first().map_or(1, |latch| latch.looks.into())),
            armed: false,
            edges: 0,
            captures: vec![false; axes],
            asked: false,
            page_of: vec![StatePage::Live; axes],
            counts: Counts::default(),
        }
    }

    /// The word of a switch that an axis outputs in this tick: its row, and its content.
    fn word(&self, cycles: &[Cycle], axis: usize) -> Option<(StatePage, u32)> {
        let row = self.row()?;
        let pin = level(self.build, &cycles[13 * axis + 5].0, row, axis);
        let state = self.switches[row][axis].state;
        let bits = [(state, SWITCH_STATE), (pin, SWITCH_LEVEL)];
        let word = bits.iter().map(|(is_set, bit)| if *is_set { *bit } else { 0 }).sum();
        (!cycles[13 * axis + 7].1.resetting).then_some((StatePage::of_number(row as u8), word))
    }

    fn row(&self) -> Option<usize> {
        let row = self.tick_of_round as usize;
        (row < SWITCH_ROWS.into() && is_sampled(self.build, row)).then_some(row)
    }

    /// Follows a whole tick. `all` are all cycles of the run, this tick begins at `from` and ends
    /// before `to`; `switches` are the words of switches that were output in it.
    pub fn tick(
        &mut self,
        all: &[Cycle],
        (from, to): (usize, usize),
        switches: &[Option<(StatePage, u32)>],
    ) {
        let cycles = &all[from..to];
        let axes = self.build.axes();
        let mut hits = vec![false; axes];
        // The source in each cycle.
        let mut sources = Vec::new();
        for (inputs, _) in cycles {
            sources.push(self.source);
            self.source = inputs.seek_source.unwrap_or(self.source);
        }
        if from > 0 {
            for (axis, found) in switches.iter().enumerate() {
                assert_eq!(*found, self.word(cycles, axis), "axis {axis} in cycle {from}");
                self.counts.words_of_switches += u64::from(found.is_some());
            }
            let mut sweeps = false;
            for axis in 0..axes {
                let Some(row) = self.row() else { break };
                let pin = level(self.build, &cycles[13 * axis + 10].0, row, axis);
                let switch = &mut self.switches[row][axis];
                switch.sample(pin);
                let at = 13 * axis + 12;
                let (source, seeking) = (sources[at], cycles[at].1.seeking);
                let waits = seeking & (if source.own { 1 << axis } else { u8::MAX }) != 0;
                let is_source = usize::from(source.row) == row
                    && (source.own || usize::from(source.axis) == axis);
                if is_source && waits && switch.state == source.level {
                    hits[axis] = source.own;
                    sweeps |= !source.own;
                    self.counts.own_hits += u64::from(source.own);
                    self.counts.common_hits += u64::from(!source.own);
                    self.counts.hits_of_level_0 += u64::from(!source.level);
                }
            }
            hits.iter_mut().for_each(|hit| *hit |= sweeps);
        }
        let latches = self.look(all, to, cycles);
        let was_latched = self.page_of[0] == StatePage::Latch;
        for (captures, hit) in self.captures.iter_mut().zip(&hits) {
            *captures = hit | (*captures & was_latched);
        }
        self.counts.hits_after_the_latch += u64::from(latches && self.captures.contains(&true));
        self.turn_pages(cycles, latches, all[to].1.resetting);
        self.end_round(cycles);
    }

    /// The latch at the strobe before cycle `to`; returns true if it accepts an edge for which it
    /// was armed.
    fn look(&mut self, all: &[Cycle], to: usize, cycles: &[Cycle]) -> bool {
        let guard = &self.build.guard;
        let Some(&latch) = guard.latches.first() else {
            assert!(cycles.iter().all(|(_, o)| o.latch_armed == 0 && o.latch_edges[0] == 0));
            return false;
        };
        let mut latched = false;
        for (k, (inputs, outputs)) in cycles.iter().enumerate() {
            let found = (outputs.latch_armed == 1, outputs.latch_edges[0]);
            assert_eq!(found, (self.armed, self.edges));
            if k + 1 == cycles.len() {
                // Two flip-flops are before the look.
                let (seen, _) = all[to - 3];
                let edge = self.latch.sample((seen.latch == 1) != latch.low) && self.latch.state;
                latched = edge && self.armed;
                let further = edge && !self.armed;
                self.edges = (self.edges + u8::from(further)).min(15);
                self.armed &= !edge;
                self.counts.edges += u64::from(further);
            }
            if inputs.latch_arm == 1 {
                (self.armed, self.edges) = (true, 0);
            }
            if outputs.resetting {
                (self.armed, self.edges, latched) = (false, 0, false);
                self.latch = Debounced::new(latch.looks.into());
            }
        }
        latched
    }

    /// Finds the pages of the next tick.
    fn turn_pages(&mut self, cycles: &[Cycle], latches: bool, resetting: bool) {
        let captures = self.captures.contains(&true);
        let taken = latches || captures;
        let is_due = self.asked || cycles[..cycles.len() - 1].iter().any(|(i, _)| i.snapshot);
        let at_strobe = cycles.last().is_some_and(|(inputs, _)| inputs.snapshot);
        let takes = is_due && !taken;
        self.asked = at_strobe || (is_due && taken);
        self.counts.snapshots += u64::from(takes);
        self.counts.deferred[0] += u64::from(is_due && captures);
        self.counts.deferred[1] += u64::from(is_due && latches);
        self.counts.latched += u64::from(latches);
        for (page, captured) in self.page_of.iter_mut().zip(&self.captures) {
            *page = match (latches && !resetting, captured, takes) {
                (true, ..) => StatePage::Latch,
                (_, true, _) => StatePage::Seek,
                (.., true) => StatePage::Snapshot,
                _ => StatePage::Live,
            };
        }
    }

    /// The tick of the round after this tick, and what a reset does to the switches.
    fn end_round(&mut self, cycles: &[Cycle]) {
        let strobe = cycles.len() - 1;
        let ending = self.ending || cycles[..strobe].iter().any(|(inputs, _)| inputs.reset);
        let asks = cycles[strobe].0.reset;
        self.resetting = if cycles[0].1.resetting { self.resetting + 1 } else { 0 };
        let is_last = self.resetting > 1;
        self.tick_of_round = (self.tick_of_round + 1) % self.build.guard.round;
        if ending && self.resetting != 1 {
            self.tick_of_round = 0;
        }
        if is_last {
            let forgotten = Debounced::new(self.build.guard.debounce as usize);
            self.switches.iter_mut().flatten().for_each(|switch| *switch = forgotten.clone());
        }
        self.ending = asks || (ending && !is_last);
    }
}
