//! Passes all axes through a window of clocks, one after the other, and reports their edges in
//! order of time. It chooses the length of windows.

use super::edges::{Edges, Window as EdgeWindow};
use super::one_axis::{self, FaultIn, Window};
use crate::parts::cubic::MOST_TICKS;
use crate::parts::moving::Moving;
use carrystep_core::engine::MAX_AXES;
use carrystep_core::{PinTiming, Timebase};

/// The greatest number of ticks of a window with dense edges, so that its edges fit the cache.
const DENSE_TICKS: u32 = 1 << 13;

/// The speed, in 2^-64 step per tick, above which edges are dense.
const DENSE_SPEED: u64 = 1 << 58;

/// The greatest number of ticks of a window in which every axis keeps its speed. The closed forms
/// are exact for any number of ticks if A and J are 0.
const CALM_TICKS: u32 = 1 << 28;

/// Number of edges per axis for which such a window is sized, as a power of two.
const CALM_EDGES: u32 = 8;

/// The position in time at which a window begins, in clocks.
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
    /// Passes axes through cycles whose strobes only add, and stops before a cycle that latches a
    /// fault. Of the number of cycles that could be passed, `fit` of it are passed. Returns the
    /// number of cycles and of strobes passed.
    pub fn pass(
        &mut self,
        axes: &mut [Moving],
        from: From,
        fit: impl Fn(u64) -> u64,
        time: &Timebase,
        pins: &[PinTiming],
        to: &mut impl Edges,
    ) -> (u64, u32) {
        let dense = axes.iter().any(|axis| axis.cubic.v.unsigned_abs() > DENSE_SPEED);
        let ticks = if dense { DENSE_TICKS } else { calm(axes).unwrap_or(MOST_TICKS) };
        let longest = u64::from(ticks) * u64::from(time.clocks_per_tick()) - 1 - from.clock_of_tick;
        let mut clocks = fit(longest);
        let mut before = [None; MAX_AXES];
        before.iter_mut().zip(&*axes).for_each(|(before, axis)| *before = Some(*axis));
        while let Err(FaultIn(cycle)) = self.pass_axes(axes, from, clocks, time, pins) {
            axes.iter_mut().zip(before.iter().flatten()).for_each(|(axis, before)| *axis = *before);
            clocks = fit(cycle - from.cycle);
        }
        self.edges.merge(to);
        // A window is short enough for the number of strobes to fit 32 bits.
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
        let window = Window {
            tick: from.cycle - from.clock_of_tick,
            from: from.cycle,
            to: from.cycle + clocks,
        };
        for (((number, axis), pins), edges) in (0..).zip(axes).zip(pins).zip(lists) {
            one_axis::pass(axis, number, window, time, *pins, edges)?;
        }
        Ok(())
    }
}

/// The number of ticks of a window if every axis keeps its speed, chosen so that the window has few
/// edges; `None` if an axis accelerates.
fn calm(axes: &[Moving]) -> Option<u32> {
    let level = axes.iter().all(|axis| axis.cubic.a == 0 && axis.cubic.j == 0);
    let fastest = axes.iter().map(|axis| axis.cubic.v.unsigned_abs()).max().filter(|_| level)?;
    let ticks = (1_u128 << (64 + CALM_EDGES)) / u128::from(fastest.max(1));
    Some(u32::try_from(ticks).unwrap_or(CALM_TICKS).clamp(MOST_TICKS, CALM_TICKS))
}
