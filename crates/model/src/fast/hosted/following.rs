//! A readout that follows a leap from edge to edge. Between two rising edges of STEP the position
//! of an axis is constant, and the counted position approaches it by one step in each tick.

use crate::engine::{Counted, Motion, Readout, Span};
use crate::fast::FastEngine;
use crate::fast::edges::{Change, Edge, Edges};
use carrystep_core::engine::MAX_AXES;

/// A readout that receives the edges of a leap, and passes them on to `to`.
pub(super) struct Following<'a> {
    readout: &'a mut Readout,
    to: &'a mut dyn Edges,
    /// The cycle in which the leap begins, and the clock of the tick in it.
    from: u64,
    clock: u64,
    per_tick: u64,
    /// One for each axis that exists; the others are not used.
    axes: [Followed; MAX_AXES],
}

/// An axis in the cycle up to which its counts have advanced.
#[derive(Debug, Clone, Copy, Default)]
struct Followed {
    cycle: u64,
    counted: Counted,
    /// [`Motion::carried`] at the beginning of the leap.
    carried: i32,
}

impl<'a> Following<'a> {
    /// Follows a leap of this engine from its present cycle on.
    pub(super) fn new(
        readout: &'a mut Readout,
        engine: &FastEngine,
        to: &'a mut dyn Edges,
    ) -> Self {
        let (cycle, motion) = (engine.cycle(), engine.core());
        let mut axes = [Followed::default(); MAX_AXES];
        for (axis, followed) in axes.iter_mut().enumerate().take(motion.build().axes()) {
            let (counted, carried) = (Counted::of(motion, axis), motion.carried(axis));
            *followed = Followed { cycle, counted, carried };
        }
        Self {
            readout,
            to,
            from: cycle,
            clock: motion.clock_of_tick().into(),
            per_tick: motion.clocks_per_tick().into(),
            axes,
        }
    }

    /// Ends with the leap; `engine` is the engine after it.
    pub(super) fn finish(mut self, engine: &FastEngine) {
        let end = engine.cycle();
        let motion: &Motion = engine.core();
        for axis in 0..motion.build().axes() {
            self.reach(axis, end);
            let followed = &self.axes[axis];
            debug_assert_eq!(followed.counted.position, motion.shaper(axis).position);
            let carries = motion.carried(axis).wrapping_sub(followed.carried);
            self.readout.carry(axis, carries);
        }
        self.readout.pass(self.span(self.from, end).strobes());
    }

    /// Advances the counts of an axis to this cycle; what they follow has not changed since.
    fn reach(&mut self, axis: usize, cycle: u64) {
        let followed = self.axes[axis];
        let span = self.span(followed.cycle, cycle);
        self.readout.follow(axis, followed.counted, span);
        self.axes[axis].cycle = cycle;
    }

    const fn span(&self, from: u64, to: u64) -> Span {
        let clock = (self.clock + (from - self.from)) % self.per_tick;
        Span { clock, clocks: to - from, per_tick: self.per_tick }
    }
}

impl Edges for Following<'_> {
    fn edge(&mut self, edge: Edge) {
        if edge.change == Change::Rise {
            let axis = usize::from(edge.axis);
            self.reach(axis, edge.clock);
            let position = &mut self.axes[axis].counted.position;
            *position = position.wrapping_add(if edge.backward { -1 } else { 1 });
        }
        self.to.edge(edge);
    }

    fn levels(&mut self, clock: u64, levels: u8) {
        self.to.levels(clock, levels);
    }

    fn duty(&mut self, clock: u64, duty: u16, level: bool) {
        self.to.duty(clock, duty, level);
    }

    fn pwm(&mut self, clock: u64, level: bool) {
        self.to.pwm(clock, level);
    }
}
