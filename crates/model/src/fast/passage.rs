//! All axes through a window of clocks, one after the other, and their edges in order of time.

use super::cubic::MOST_TICKS;
use super::edges::{Edges, Window as EdgeWindow};
use super::lane::{self, FaultIn, Moving, Window};
use carrystep_core::engine::MAX_AXES;
use carrystep_core::{PinTiming, Timebase};

/// Most ticks of a window where edges are dense: its edges are to stay in the cache.
const DENSE_TICKS: u32 = 1 << 13;

/// A speed, in 2^-64 step per tick, from which on edges are dense.
const DENSE_SPEED: u64 = 1 << 58;

/// Most ticks of a window in which every axis keeps its speed: closed forms without A and J hold in any number of ticks.
const CALM_TICKS: u32 = 1 << 28;

/// Edges an axis in such a window, as a power of two.
const CALM_EDGES: u32 = 8;

/// Where windows begin.
#[derive(Debug, Clone, Copy)]
pub(super) struct From {
    pub cycle: u64,
    pub clock_of_tick: u64,
}

/// The edges of a window, axis by axis.
#[derive(Debug, Clone, Default)]
pub(super) struct Passages {
    edges: EdgeWindow,
}

impl Passages {
    /// Brings axes through cycles whose strobes only add, `most` at the most, and not into one in which that
    /// ends in a fault; how many cycles and strobes they were.
    pub fn pass(
        &mut self,
        axes: &mut [Moving],
        from: From,
        most: u64,
        time: &Timebase,
        pins: &[PinTiming],
        to: &mut impl Edges,
    ) -> (u64, u32) {
        let dense = axes.iter().any(|axis| axis.cubic.v.unsigned_abs() > DENSE_SPEED);
        let ticks = if dense { DENSE_TICKS } else { calm(axes).unwrap_or(MOST_TICKS) };
        let longest = u64::from(ticks) * u64::from(time.clocks_per_tick()) - 1 - from.clock_of_tick;
        let mut clocks = most.min(longest);
        let mut before = [None; MAX_AXES];
        before.iter_mut().zip(&*axes).for_each(|(before, axis)| *before = Some(*axis));
        while let Err(FaultIn(cycle)) = self.pass_axes(axes, from, clocks, time, pins) {
            axes.iter_mut().zip(before.iter().flatten()).for_each(|(axis, before)| *axis = *before);
            clocks = cycle - from.cycle;
        }
        self.edges.merge(to);
        // A window is at most so long that strobes fit.
        (clocks, ((from.clock_of_tick + clocks) / u64::from(time.clocks_per_tick())) as u32)
    }

    fn pass_axes(
        &mut self,
        axes: &mut [Moving],
        from: From,
        clocks: u64,
        time: &Timebase,
        pins: &[PinTiming],
    ) -> Result<(), FaultIn> {
        let lists = self.edges.clear();
        if clocks == 0 {
            return Ok(());
        }
        let window = Window { tick: from.cycle - from.clock_of_tick, from: from.cycle, to: from.cycle + clocks };
        for (((number, axis), pins), edges) in (0..).zip(axes).zip(pins).zip(lists) {
            lane::pass(axis, number, window, time, *pins, edges)?;
        }
        Ok(())
    }
}

/// How many ticks a window may have in which every axis keeps its speed, if each does: so many that edges are few.
fn calm(axes: &[Moving]) -> Option<u32> {
    let level = axes.iter().all(|axis| axis.cubic.a == 0 && axis.cubic.j == 0);
    let fastest = axes.iter().map(|axis| axis.cubic.v.unsigned_abs()).max().filter(|_| level)?;
    let ticks = (1_u128 << (64 + CALM_EDGES)) / u128::from(fastest.max(1));
    Some(u32::try_from(ticks).unwrap_or(CALM_TICKS).clamp(MOST_TICKS, CALM_TICKS))
}
