//! Runs the fast engine and the clock-by-clock engine side by side, each with a host of its own.
//! The edges must be equal, and registers and inputs must be equal whenever the fast engine stops.

use carrystep_core::engine::{CAUSES, EngineInputs, EngineOutputs};
use carrystep_core::{EngineBuild, Program};
use carrystep_model::fast::{Change, Edge};
use carrystep_model::{Engine, FastEngine};
use carrystep_simulators::engine::{EngineHost, Events};

/// Counts from a comparison without a difference.
#[derive(Debug, Default, Clone, Copy)]
pub struct Came {
    /// Edges on the pins.
    pub edges: u64,
    /// Clock cycles.
    pub clocks: u64,
    /// Clock cycles that the fast engine skipped.
    pub leapt: u64,
    /// Words that the fast engine took in cycles that it skipped.
    pub taken: u64,
    /// Number of stops by each cause.
    pub faults: [u64; CAUSES.len()],
}

impl Came {
    /// The sum of two counts.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        let faults = std::array::from_fn(|cause| self.faults[cause] + other.faults[cause]);
        let Self { edges, clocks, leapt, taken, .. } = self;
        Self {
            edges: edges + other.edges,
            clocks: clocks + other.clocks,
            leapt: leapt + other.leapt,
            taken: taken + other.taken,
            faults,
        }
    }
}

/// Runs a program and its events until everything is at rest, at most for `most` cycles. `leaps`
/// are the greatest lengths of the leaps, used in turn, so that a leap can end in any clock.
///
/// # Errors
/// The first difference.
pub fn run(
    build: &EngineBuild,
    program: &Program,
    events: &Events,
    leaps: &[u64],
    most: u64,
) -> Result<Came, String> {
    let (mut fast, mut slow) = (FastEngine::new(build), Engine::new(build));
    let (mut fast_host, mut slow_host) =
        (EngineHost::new(build, program, events), EngineHost::new(build, program, events));
    let (mut fast_edges, mut slow_edges) = (Vec::new(), Vec::new());
    let mut came = Came::default();
    let mut leaps = leaps.iter().cycle();
    let (mut quiet, mut fault, mut turn) = (false, None, 0_u64);
    while came.clocks < most && !quiet {
        let (inputs, outputs) = fast_host.meet(|inputs| fast.outputs(inputs));
        let longest = *leaps.next().unwrap_or(&u64::MAX);
        let patience = fast_host.patience(&outputs).min(most - came.clocks).min(longest);
        // Takes turns: a run up to the next event for the host, a single leap or clock, and a leap
        // that takes words.
        turn += 1;
        let (mut heard, mut words) = (None, 0);
        if turn % 3 == 0 {
            heard = fast.run(&inputs, came.clocks + patience.max(1), &mut fast_edges);
            // A host without patience continues in this cycle, whether or not there is an event.
            let goes_on = heard.or((patience == 0).then_some(outputs));
            fast_host.wait(fast.cycle() - came.clocks - u64::from(goes_on.is_some()));
            goes_on.iter().for_each(|outputs| fast_host.advance(outputs));
        } else {
            let mut leapt = 0;
            if turn % 3 == 1 && patience > 0 {
                leapt = fast.leap(&inputs, patience, &mut fast_edges);
            } else if turn % 3 == 2 {
                let patience = fast_host.patience_but_for_words(&outputs);
                let patience = patience.min(most - came.clocks).min(longest);
                if patience > 0 {
                    let offered = fast_host.offered();
                    (leapt, words) = fast.leap_taking(&inputs, offered, patience, &mut fast_edges);
                }
            }
            if leapt > 0 {
                came.leapt += leapt;
                came.taken += words as u64;
                fast_host.wait(leapt);
                fast_host.accepted(words);
            } else {
                fast_host.advance(&outputs);
                fast.clock(&inputs, &mut fast_edges);
                heard = Some(outputs);
            }
        }
        for clock in came.clocks + 1..=fast.cycle() {
            let before: Vec<_> = (0..build.axes()).map(|axis| *slow.shaper(axis)).collect();
            let (slow_inputs, slow_outputs) =
                slow_host.meet(|inputs| slow.outputs(inputs).recorded());
            slow_host.advance(&slow_outputs);
            if let (None, Some((cause, _))) = (fault, slow_outputs.fault) {
                came.faults[cause as usize] += 1;
            }
            fault = slow_outputs.fault;
            slow.clock(&slow_inputs);
            // Where words were taken, the registers tell whether they were the right ones.
            let word = if words > 0 { slow_inputs.put } else { inputs.put };
            if slow_inputs != (EngineInputs { put: word, ..inputs }) {
                return Err(format!(
                    "cycle {}: inputs\n fast {inputs:?}\n slow {slow_inputs:?}",
                    clock - 1
                ));
            }
            let last = clock == fast.cycle();
            let silent = is_silent(&slow_inputs, &slow_outputs, &slow.outputs(&slow_inputs));
            let heard_now = heard.filter(|_| last);
            let takes = words > 0 && slow_inputs.put.is_some() && slow_outputs.put_ready;
            let silent = silent || takes;
            if heard_now.map_or(!silent, |heard| heard != slow_outputs) {
                return Err(format!("cycle {}: heard {heard:?}, not {slow_outputs:?}", clock - 1));
            }
            for (axis, before) in (0..).zip(before) {
                let now = slow.shaper(axis);
                let edge = |change| Edge { clock, axis: axis as u8, change, backward: now.dir };
                slow_edges.extend((now.step && !before.step).then(|| edge(Change::Rise)));
                slow_edges.extend((now.dir != before.dir).then(|| edge(Change::DirChange)));
            }
        }
        came.clocks = fast.cycle();
        if fast_edges != slow_edges {
            let pair = fast_edges.iter().zip(&slow_edges).find(|(fast, slow)| fast != slow);
            let counts = (fast_edges.len(), slow_edges.len());
            return Err(format!(
                "up to cycle {}: edges {counts:?} (fast, slow), first difference {pair:?}",
                came.clocks
            ));
        }
        if fast.core() != slow.motion() {
            return Err(format!(
                "cycle {}: registers\n fast {:?}\n slow {:?}",
                came.clocks,
                fast.core(),
                slow.motion()
            ));
        }
        came.edges += fast_edges.len() as u64;
        fast_edges.clear();
        slow_edges.clear();
        // The end may come in any cycle of the rest.
        quiet = slow_host.is_done() && (outputs.idle || outputs.halted);
    }
    Ok(came)
}

/// True if a cycle with these inputs and outputs, and these outputs after it, contains no event for
/// the host.
fn is_silent(inputs: &EngineInputs, now: &EngineOutputs, next: &EngineOutputs) -> bool {
    let taken =
        (now.put_ready && inputs.put.is_some()) || (now.start_ready && inputs.start.is_some());
    let state = |outputs: &EngineOutputs| {
        let EngineOutputs { fault, halted, idle, enabled, seeking, hits, .. } = *outputs;
        let EngineOutputs { latch_armed, latch_edges, latch_records, .. } = *outputs;
        let latches = (latch_armed, latch_edges, latch_records);
        (fault, halted, idle, enabled, seeking, hits, latches)
    };
    !taken && !now.started && state(now) == state(next)
}
