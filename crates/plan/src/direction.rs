//! Rest before a move, where DIR set-up and hold would otherwise delay its first edge.
//!
//! DIR follows the sign of V. A rest of 1 + r ticks turns it early and leaves P as it was: one tick with
//! V = -r, which DIR already points to, then r ticks with V = 1 unit in the new direction.

use carrystep_core::{PinTiming, Segment, StartPhase, Timebase};

/// The pins of one axis after the moves planned so far; times in clocks from the origin, latency left out.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pins {
    backward: bool,
    turned: i128,
    last_edge: Option<i128>,
}

/// What a move does to the pins, in clocks from where its motion starts.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Strokes {
    pub backward: bool,
    /// The first tick whose V has a sign.
    pub motion: i128,
    pub first_edge: i128,
    pub last_edge: i128,
}

impl Pins {
    /// After configuration DIR is forward; no axis can start before the first strobe.
    pub fn new(timebase: &Timebase) -> Self {
        let configured = -i128::from(timebase.latency_clocks()) - i128::from(timebase.clocks_per_tick());
        Self { backward: false, turned: configured, last_edge: None }
    }

    /// Ticks of rest that this axis needs before a move that would start at clock `begin`.
    pub fn rest(&self, begin: i128, strokes: &Strokes, pins: &PinTiming, build: (&Timebase, StartPhase)) -> u64 {
        let clocks = i128::from(build.0.clocks_per_tick());
        let edge = begin + strokes.first_edge;
        let missing = |since: i128| {
            let earliest = (since + i128::from(pins.setup)).max(self.ready(pins));
            u64::try_from((earliest - edge + clocks - 1).div_euclid(clocks)).unwrap_or(0)
        };
        if !self.turns(strokes) {
            return missing(self.turned);
        }
        if missing(self.turn(begin + strokes.motion, pins)) == 0 {
            return 0;
        }
        let (least, early) = if borrows(build.1, strokes.backward) { (1, 0) } else { (2, clocks) };
        missing(self.turn(begin + early, pins)).max(least)
    }

    /// The pins after a move whose rest starts at clock `begin`.
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
        if self.turns(strokes) {
            self.turned = self.turn(turned_in_rest.map_or(motion + strokes.motion, |early| begin + early), pins);
            self.backward = strokes.backward;
        }
        self.last_edge = Some(motion + strokes.last_edge);
    }

    /// Whether DIR has to change for this move.
    pub fn turns(&self, strokes: &Strokes) -> bool {
        self.backward != strokes.backward
    }

    fn turn(&self, wanted: i128, pins: &PinTiming) -> i128 {
        self.last_edge.map_or(wanted, |last| wanted.max(last + i128::from(pins.hold)))
    }

    /// When the last pulse and its gap are over.
    fn ready(&self, pins: &PinTiming) -> i128 {
        self.last_edge.map_or(i128::MIN, |last| last + i128::from(pins.width) + i128::from(pins.gap))
    }
}

/// Whether a rest that turns DIR takes its unit from the move: from P = 0 forward, a tick with negative V
/// would step back, so that P cannot come back to where it was.
pub(crate) fn borrows(phase: StartPhase, backward: bool) -> bool {
    phase == StartPhase::Zero && !backward
}

/// The segments of a rest that turns DIR.
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
