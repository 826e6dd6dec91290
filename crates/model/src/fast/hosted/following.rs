//! A readout that follows a leap from edge to edge. Between two rising edges of STEP the position
//! of an axis is constant, and the counted position approaches it by one step in each tick.

use crate::engine::{Motion, Readout, Span};
use crate::fast::FastEngine;
use crate::fast::edges::{Change, Edge, Edges};
use crate::parts::shaper::ShaperState;
use carrystep_core::engine::MAX_AXES;

/// A readout that receives the edges of a leap, and passes them on to `to`.
pub(super) struct Following<'a> {
    readout: &'a mut Readout,
    to: &'a mut dyn Edges,
    /// The cycle in which the leap begins, and the clock of the tick in it.
    from: u64,
    clock: u64,
    per_tick: u64,
    /// The axes that exist.
    axes: [Option<Followed>; MAX_AXES],
}

/// An axis in the cycle up to which its counts have advanced.
#[derive(Debug, Clone, Copy)]
struct Followed {
    cycle: u64,
    shaper: ShaperState,
    runs: bool,
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
        let followed = |axis| Followed {
            cycle,
            shaper: *motion.shaper(axis),
            runs: motion.axis_state(axis).left.is_some(),
            carried: motion.carried(axis),
        };
        let axes = motion.build().axes();
        Self {
            readout,
            to,
            from: cycle,
            clock: motion.clock_of_tick().into(),
            per_tick: motion.clocks_per_tick().into(),
            axes: std::array::from_fn(|axis| (axis < axes).then(|| followed(axis))),
        }
    }

    /// Ends with the leap; `engine` is the engine after it.
    pub(super) fn finish(mut self, engine: &FastEngine) {
        let end = engine.cycle();
        let motion: &Motion = engine.core();
        for axis in 0..motion.build().axes() {
            self.reach(axis, end);
            if let Some(followed) = self.axes[axis] {
                debug_assert_eq!(followed.shaper.position, motion.shaper(axis).position);
                let carries = motion.carried(axis).wrapping_sub(followed.carried);
                self.readout.carry(axis, carries);
            }
        }
        self.readout.pass(self.span(self.from, end).strobes());
    }

    /// Advances the counts of an axis to this cycle; its shaper has not changed since.
    fn reach(&mut self, axis: usize, cycle: u64) {
        let Some(followed) = self.axes[axis] else { return };
        let span = self.span(followed.cycle, cycle);
        self.readout.follow(axis, &followed.shaper, followed.runs, span);
        self.axes[axis] = Some(Followed { cycle, ..followed });
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
            if let Some(Followed { shaper, .. }) = &mut self.axes[axis] {
                let step = if edge.backward { -1 } else { 1 };
                shaper.position = shaper.position.wrapping_add(step);
            }
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
