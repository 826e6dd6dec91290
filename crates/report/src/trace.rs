//! The path as a bounded number of straight lines. When there are too many, neighbours are joined
//! where that changes the drawing least.

/// Most lines.
const MOST: usize = 20_000;
/// A difference of speed of this part of the greatest speed is as bad as a distance of
/// [`SPEED_AS_WAY`] of the size of the path.
const SPEED_AS_WAY: f64 = 0.02;
/// Joining two causes is as bad as this distance, as a part of the size of the path.
const CAUSE_AS_WAY: f64 = 2e-4;
/// The first level of what is joined, as a part of the size of the path.
const FIRST_LEVEL: f64 = 1e-7;

/// A straight line of the drawing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Stroke {
    /// Where it ends; its start is the end of the one before.
    pub end: [f64; 3],
    /// Its length along the motion, units.
    pub way: f64,
    /// Its time, s.
    pub seconds: f64,
    pub cause: usize,
    /// The line of the program, or number of the move, at its end.
    pub line: u64,
    /// How far the motion is from it at most, units.
    pub off: f64,
}

impl Stroke {
    /// The mean speed, units/s.
    pub fn speed(&self) -> f64 {
        self.way / self.seconds
    }
}

/// The path.
#[derive(Debug, Clone)]
pub(crate) struct Trace {
    start: [f64; 3],
    strokes: Vec<Stroke>,
    level: f64,
    /// Number of rows that were added.
    rows: u64,
    low: [f64; 3],
    high: [f64; 3],
    fastest: f64,
}

impl Trace {
    /// A path that begins at a place.
    pub fn new(start: [f64; 3]) -> Self {
        Self {
            start,
            strokes: Vec::new(),
            level: FIRST_LEVEL,
            rows: 0,
            low: start,
            high: start,
            fastest: 0.0,
        }
    }

    pub fn start(&self) -> [f64; 3] {
        self.start
    }

    pub fn strokes(&self) -> &[Stroke] {
        &self.strokes
    }

    /// Number of rows that were added.
    pub fn rows(&self) -> u64 {
        self.rows
    }

    /// The size of the path: the greatest of its three extents.
    pub fn size(&self) -> f64 {
        (0..3).map(|k| self.high[k] - self.low[k]).fold(0.0, f64::max)
    }

    /// Adds a line.
    pub fn add(&mut self, stroke: Stroke) {
        self.rows += 1;
        for k in 0..3 {
            self.low[k] = self.low[k].min(stroke.end[k]);
            self.high[k] = self.high[k].max(stroke.end[k]);
        }
        self.fastest = self.fastest.max(stroke.speed());
        self.put(stroke);
        while self.strokes.len() >= MOST {
            self.level *= 2.0;
            let all = std::mem::take(&mut self.strokes);
            all.into_iter().for_each(|stroke| self.put(stroke));
        }
    }

    /// Adds a line, or joins it with the last one.
    fn put(&mut self, stroke: Stroke) {
        let from = match self.strokes.len() {
            0 | 1 => self.start,
            count => self.strokes[count - 2].end,
        };
        let Some(last) = self.strokes.last_mut() else {
            self.strokes.push(stroke);
            return;
        };
        let size = (0..3).map(|k| self.high[k] - self.low[k]).fold(0.0, f64::max);
        let off = away(from, stroke.end, last.end) + last.off.max(stroke.off);
        let way = if size > 0.0 { off / size } else { 0.0 };
        let speed = (last.speed() - stroke.speed()).abs() / self.fastest.max(f64::MIN_POSITIVE);
        let other = if last.cause == stroke.cause { 0.0 } else { CAUSE_AS_WAY };
        if way.max(speed * SPEED_AS_WAY).max(other) > self.level {
            self.strokes.push(stroke);
            return;
        }
        let longer = if last.seconds >= stroke.seconds { &*last } else { &stroke };
        *last = Stroke {
            end: stroke.end,
            way: last.way + stroke.way,
            seconds: last.seconds + stroke.seconds,
            cause: longer.cause,
            line: stroke.line,
            off,
        };
    }
}

/// The distance of a point from the straight line between two others.
fn away(a: [f64; 3], b: [f64; 3], p: [f64; 3]) -> f64 {
    let to = |q: [f64; 3]| [q[0] - a[0], q[1] - a[1], q[2] - a[2]];
    let dot = |u: [f64; 3], v: [f64; 3]| u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
    let (d, p) = (to(b), to(p));
    let square = dot(d, d);
    let part = if square > 0.0 { (dot(d, p) / square).clamp(0.0, 1.0) } else { 0.0 };
    let off = [p[0] - part * d[0], p[1] - part * d[1], p[2] - part * d[2]];
    dot(off, off).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A circle that is passed many times, slowly growing.
    fn place(k: u32) -> [f64; 3] {
        let (sin, cos) = (f64::from(k) / 50.0).sin_cos();
        let radius = 10.0 + f64::from(k) * 1e-4;
        [radius * cos, radius * sin, 0.0]
    }

    #[test]
    fn joined_lines_are_as_near_to_the_motion_as_they_say() {
        let mut trace = Trace::new(place(0));
        let count = 100_000;
        for k in 1..=count {
            let off = 0.001;
            let stroke =
                Stroke { end: place(k), way: 0.2, seconds: 0.004, cause: 1, line: k.into(), off };
            trace.add(stroke);
        }
        let strokes = trace.strokes();
        assert!(strokes.len() < MOST && strokes.len() > MOST / 20, "{}", strokes.len());
        assert_eq!(trace.rows(), u64::from(count));
        let seconds: f64 = strokes.iter().map(|stroke| stroke.seconds).sum();
        assert!((seconds - 0.004 * f64::from(count)).abs() < 1e-6);
        let (mut from, mut first) = (trace.start(), 1);
        for stroke in strokes {
            assert!((stroke.speed() - 50.0).abs() < 1e-9);
            for k in first..=stroke.line as u32 {
                let off = away(from, stroke.end, place(k)) + 0.001;
                assert!(off <= stroke.off + 1e-12, "{off} of {}", stroke.off);
            }
            (from, first) = (stroke.end, stroke.line as u32 + 1);
        }
        assert_eq!(from, place(count));
    }

    #[test]
    fn a_straight_motion_at_one_speed_is_one_line() {
        let mut trace = Trace::new([0.0; 3]);
        for k in 1..=1000 {
            let end = [f64::from(k) * 0.25, 0.0, 1.0];
            trace.add(Stroke { end, way: 0.25, seconds: 0.004, cause: 2, line: 7, off: 0.0 });
        }
        assert!(trace.strokes().len() <= 2, "{:?}", trace.strokes());
    }
}
