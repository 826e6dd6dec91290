//! Computes the rest before a move, where DIR set-up and hold would otherwise delay its first edge.
//!
//! DIR follows the sign of V. A rest of 1 + r ticks changes DIR early and leaves P unchanged: one
//! tick with V = -r, in the old direction, and then r ticks with V = 1 unit in the new direction.
//! At phase zero a forward move cannot do so and borrows one unit from its own distance (see
//! [`borrows`]).
//!
//! The rule for DIR is that of the gateware (docs/clock-by-clock.md, "shaper"); both may change
//! only together.

use carrystep_core::{PinTiming, Segment, StartPhase, Timebase};

/// The state of the pins of one axis after the moves planned so far: the direction, the clock at
/// which DIR last changed, and that of the last rising edge of STEP. Clocks count from the origin,
/// without the latency of the build.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pins {
    backward: bool,
    turned: i128,
    last_edge: Option<i128>,
}

/// The times at which a move uses the pins, in clocks from the start of its motion.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Strokes {
    pub backward: bool,
    /// The first tick in which V is not 0, as a clock.
    pub motion: i128,
    pub first_edge: i128,
    pub last_edge: i128,
}

impl Pins {
    /// The state after configuration: DIR is forward. No axis can start before the first strobe, so
    /// DIR has been stable since one latency and one tick before the origin.
    pub fn new(timebase: &Timebase) -> Self {
        let configured =
            -i128::from(timebase.latency_clocks()) - i128::from(timebase.clocks_per_tick());
        Self { backward: false, turned: configured, last_edge: None }
    }

    /// Ticks of rest that this axis needs before a move that would start at clock `begin`.
    pub fn rest(
        &self,
        begin: i128,
        strokes: &Strokes,
        pins: &PinTiming,
        build: (&Timebase, StartPhase),
    ) -> u64 {
        let clocks = u64::from(build.0.clocks_per_tick());
        let edge = begin + strokes.first_edge;
        let missing = |since: i128| {
            let earliest = (since + i128::from(pins.dir_setup)).max(self.ready(pins));
            // Most moves need no rest, and no division.
            match u64::try_from(earliest - edge) {
                Ok(late) if late > 0 => late.div_ceil(clocks),
                _ => 0,
            }
        };
        if !self.changes_dir(strokes) {
            return missing(self.turned);
        }
        if missing(self.dir_change(begin + strokes.motion, pins)) == 0 {
            return 0;
        }
        let (least, early) =
            if borrows(build.1, strokes.backward) { (1, 0) } else { (2, clocks.into()) };
        missing(self.dir_change(begin + early, pins)).max(least)
    }

    /// Updates the state of the pins by a move whose rest starts at clock `begin`. `turned_in_rest`
    /// is the clock within the rest at which DIR changes, or `None` if it changes with the motion.
    pub fn after(
        &mut self,
        begin: i128,
        rest: u64,
        turned_in_rest: Option<i128>,
        strokes: &Strokes,
        pins: &PinTiming,
        timebase: &Timebase,
    ) {
        let motion = begin + i128::from(rest) * i128::from(timebase.clocks_per_tick());
        if self.changes_dir(strokes) {
            self.turned = self.dir_change(
                turned_in_rest.map_or(motion + strokes.motion, |early| begin + early),
                pins,
            );
            self.backward = strokes.backward;
        }
        self.last_edge = Some(motion + strokes.last_edge);
    }

    /// Whether DIR has to change for this move.
    pub fn changes_dir(&self, strokes: &Strokes) -> bool {
        self.backward != strokes.backward
    }

    fn dir_change(&self, wanted: i128, pins: &PinTiming) -> i128 {
        self.last_edge.map_or(wanted, |last| wanted.max(last + i128::from(pins.dir_hold)))
    }

    /// The clock at which the last pulse and the gap after it are over.
    fn ready(&self, pins: &PinTiming) -> i128 {
        self.last_edge
            .map_or(i128::MIN, |last| last + i128::from(pins.step_high) + i128::from(pins.step_low))
    }
}

/// Whether a rest that changes DIR takes one unit of distance from the move. A forward move that
/// starts at P = 0 has to: a tick with negative V would step back at once, so the rest could not
/// leave P unchanged.
pub(crate) fn borrows(phase: StartPhase, backward: bool) -> bool {
    phase == StartPhase::Zero && !backward
}

/// The segments of a rest of `ticks` ticks (at least 1) that changes DIR.
pub(crate) fn turning_rest(ticks: u32, backward: bool, phase: StartPhase) -> Vec<Segment> {
    let segment = |ticks, v| Segment { ticks, v, a: 0, j: 0, last: false };
    let sign = if backward { -1 } else { 1 };
    let rest = ticks - 1;
    let pair = if borrows(phase, backward) {
        [segment(1, 1), segment(rest, 0)]
    } else {
        [segment(1, -sign * i64::from(rest)), segment(rest, sign)]
    };
    pair.into_iter().filter(|segment| segment.ticks > 0).collect()
}
