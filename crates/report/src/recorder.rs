//! Takes the rows of a plan and adds up what they do.

use crate::axis::AxisSetup;
use crate::bound::Bound;
use crate::charts::Charts;
use crate::drawing::{Drawing, Kept};
use crate::frame::{Frame, Frames};
use crate::lines::LineTicks;
use crate::motion::Motion;
use crate::split::part;
use crate::stops::Stops;
use crate::time_use::TimeUse;
use crate::trace::{Stroke, Trace};
use carrystep_core::Segment;

/// Stretches of the tolerance whose seconds are counted.
const DISTANCES: usize = 40;
/// Longest row in seconds that is drawn as a straight line.
const LONGEST_S: f64 = 0.008;
/// Most parts of a longer one.
const MOST_PARTS: u32 = 16;

/// What a recorder keeps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Detail {
    /// Only the figures of `--json`.
    Figures,
    /// Also what a page draws.
    Drawing,
}

/// Adds up what the rows of a plan do, in bounded memory.
#[derive(Debug, Clone)]
pub struct Recorder {
    frames: Frames,
    /// Ramps to and from rests; none for move files, in which every move has both.
    stops: Option<Stops>,
    sums: Sums,
}

/// What the rows add up to.
#[derive(Debug, Clone)]
struct Sums {
    axes: usize,
    tick_seconds: f64,
    lines: LineTicks,
    distances: Vec<u64>,
    drawn: Option<(Charts, Trace)>,
    /// The axes whose letters the path is drawn over, in this order, and these letters.
    over: Vec<(usize, Vec<(usize, f64)>)>,
}

impl Recorder {
    /// A recorder of a plan that begins at rest. Time is counted in ticks of this length. With
    /// `program`, the rows are those of a program and not of moves.
    pub fn new(axes: Vec<AxisSetup>, tick_seconds: f64, program: bool, detail: Detail) -> Self {
        let count = axes.len();
        let causes = Bound::all(count).count();
        // The path is drawn over axes of one unit, because others cannot be compared with it.
        let drawn = |&axis: &usize| axes[axis].counts > 0.0 && axes[axis].unit == axes[0].unit;
        let over: Vec<usize> = (0..count).filter(drawn).take(3).collect();
        let mut start = [0.0; 3];
        let over: Vec<(usize, Vec<(usize, f64)>)> =
            over.into_iter().map(|axis| (axis, axes[axis].letter.clone())).collect();
        for (place, (_, letter)) in start.iter_mut().zip(&over) {
            *place = letter.iter().map(|&(axis, factor)| factor * axes[axis].start).sum();
        }
        let frames = Frames::new(axes, tick_seconds);
        let drawn = (detail == Detail::Drawing)
            .then(|| (Charts::new(frames.scale(), causes), Trace::new(start)));
        let distances = if program { vec![0; DISTANCES] } else { Vec::new() };
        Self {
            stops: program.then(Stops::new),
            sums: Sums {
                axes: count,
                tick_seconds,
                lines: LineTicks::new(causes),
                distances,
                drawn,
                over,
            },
            frames,
        }
    }

    /// Adds the next row.
    pub fn row(&mut self, motion: &Motion<'_>) {
        let seconds = f64::from(motion.ticks) * self.sums.tick_seconds;
        let parts = match self.sums.drawn {
            Some(_) => (seconds / LONGEST_S).ceil().clamp(1.0, MOST_PARTS.into()) as u32,
            None => 1,
        };
        let parts = parts.min(motion.ticks.max(1));
        let mut done = 0;
        for number in 1..=parts {
            let to = (u64::from(motion.ticks) * u64::from(number) / u64::from(parts)) as u32;
            let cut = |segment: &Segment| part(segment, done, to - done);
            let cuts: Vec<Segment>;
            let segments = if parts == 1 {
                motion.segments
            } else {
                cuts = motion.segments.iter().map(cut).collect();
                &cuts
            };
            let frame = self.frames.frame(&Motion { ticks: to - done, segments, ..*motion });
            let sums = &mut self.sums;
            match &mut self.stops {
                Some(stops) => stops.push(frame, &mut |frame| sums.add(&frame)),
                None => sums.add(&frame),
            }
            done = to;
        }
    }

    /// The plan has ended.
    pub fn finish(mut self) -> (TimeUse, Option<Drawing>) {
        if let Some(stops) = &mut self.stops {
            stops.flush(&mut |frame| self.sums.add(&frame));
        }
        let Self { frames, sums, .. } = self;
        let tick_seconds = frames.tick_seconds();
        let seconds = sums.distances.iter().map(|&ticks| ticks as f64 * tick_seconds);
        let time_use = TimeUse::new(frames.axes(), &sums.lines, tick_seconds, seconds.collect());
        let drawing = sums.drawn.map(|(charts, trace)| {
            let over: Vec<usize> = sums.over.iter().map(|(axis, _)| *axis).collect();
            let (lines, over) = (&sums.lines, &over[..]);
            Drawing::new(frames.axes(), tick_seconds, &Kept { charts, trace, lines, over })
        });
        (time_use, drawing)
    }
}

impl Sums {
    fn add(&mut self, frame: &Frame) {
        let cause = frame.bound.index(self.axes);
        self.lines.add(frame.line, cause, frame.ticks.into());
        let moves = frame.speed != [0.0; 3];
        if let Some(last) = self.distances.len().checked_sub(1).filter(|_| moves) {
            let place = ((frame.off * DISTANCES as f64) as usize).min(last);
            self.distances[place] += u64::from(frame.ticks);
        }
        let Some((charts, trace)) = &mut self.drawn else { return };
        charts.add(&frame.segments, frame.ticks, cause, frame.speed);
        let mut end = [0.0; 3];
        for (place, (_, letter)) in end.iter_mut().zip(&self.over) {
            *place = letter.iter().map(|&(axis, factor)| factor * frame.place[axis]).sum();
        }
        let seconds = f64::from(frame.ticks) * self.tick_seconds;
        let [a, b, c] = frame.speed;
        // Simpson's rule.
        let way = (a + 4.0 * b + c) / 6.0 * seconds;
        trace.add(Stroke { end, way, seconds, cause, line: frame.line, off: frame.bow });
    }
}
