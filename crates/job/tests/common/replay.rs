//! What rows do, computed from their integers alone: where the axes are, how fast, and whether
//! limits hold. Written anew from the arithmetic contract, without the planner's functions.

use carrystep_core::Segment;
use carrystep_files::Machine;
use carrystep_job::Row;

const STEP: f64 = 18_446_744_073_709_551_616.0;

/// The exact state of one axis, in units of 2^-64 step and ticks.
#[derive(Debug, Clone, Default)]
pub struct Axis {
    /// Distance from the start.
    pub distance: i128,
    /// A in the last tick so far.
    pub acceleration: i128,
    /// V that the last row would have in the tick after its last one.
    pub speed: i128,
    /// Greatest magnitudes: V, A, J, a jump of A and a jump of V between two rows.
    pub peaks: [i128; 5],
}

impl Axis {
    /// P minus its start value after `n` ticks of a segment.
    pub fn after(&self, s: &Segment, n: i128) -> i128 {
        let (v, a, j) = (i128::from(s.v), i128::from(s.a), i128::from(s.j));
        self.distance + n * v + n * (n - 1) / 2 * a + n * (n - 1) * (n - 2) / 6 * j
    }

    /// V in tick `k`, from 0.
    fn speed(s: &Segment, k: i128) -> i128 {
        i128::from(s.v) + k * i128::from(s.a) + k * (k - 1) / 2 * i128::from(s.j)
    }

    /// Runs a whole segment.
    pub fn run(&mut self, s: &Segment) {
        let last = i128::from(s.ticks) - 1;
        let (a, j) = (i128::from(s.a), i128::from(s.j));
        // V has its extreme where A changes its sign.
        let turn = if j == 0 { 0 } else { (-a / j).clamp(0, last) };
        for k in [0, last, turn, (turn + 1).min(last), (turn - 1).max(0)] {
            self.peaks[0] = self.peaks[0].max(Self::speed(s, k).abs());
        }
        let end = a + last * j;
        self.peaks[1] = self.peaks[1].max(a.abs()).max(end.abs());
        self.peaks[2] = self.peaks[2].max(j.abs());
        self.peaks[3] = self.peaks[3].max((a - self.acceleration).abs());
        self.peaks[4] = self.peaks[4].max((i128::from(s.v) - self.speed).abs());
        self.acceleration = end;
        self.speed = Self::speed(s, last + 1);
        self.distance = self.after(s, last + 1);
    }
}

/// All axes of a job.
pub struct Replay {
    pub axes: Vec<Axis>,
    pub ticks: u64,
    per_unit: Vec<f64>,
}

impl Replay {
    pub fn new(machine: &Machine) -> Self {
        let per_unit = machine.axes.iter().map(|a| a.steps_per_unit.to_string().parse().unwrap());
        let per_unit: Vec<f64> = per_unit.collect();
        Self { axes: vec![Axis::default(); per_unit.len()], ticks: 0, per_unit }
    }

    /// Where the motors are `n` ticks after the start of a row, in their units.
    pub fn at(&self, row: &Row, n: u32) -> Vec<f64> {
        let unit = |((axis, s), per_unit): ((&Axis, &Segment), &f64)| {
            axis.after(s, n.into()) as f64 / STEP / per_unit
        };
        self.axes.iter().zip(&row.segments).zip(&self.per_unit).map(unit).collect()
    }

    pub fn run(&mut self, row: &Row) {
        assert!(row.segments.iter().all(|s| s.ticks == row.ticks), "common ticks");
        for (axis, s) in self.axes.iter_mut().zip(&row.segments) {
            axis.run(s);
        }
        self.ticks += u64::from(row.ticks);
    }

    /// Panics if an axis was over a limit of the machine, J = A / 4 ms where it has none, or if its
    /// acceleration jumped by over 2 % of its limit, or its speed by more than the acceleration limit
    /// gives in a tick. The tick is 1 us.
    pub fn assert_limits(&self, machine: &Machine) {
        for (state, axis) in self.axes.iter().zip(&machine.axes) {
            let value = |x: &carrystep_files::BigDecimal| x.to_string().parse::<f64>().unwrap();
            let (v, a) = (value(&axis.speed_limit.steps), value(&axis.accel_limit.steps));
            let j = axis.jerk_limit.as_ref().map_or(a / 0.004, |limit| value(&limit.steps));
            let most =
                [v * 1e-6, a * 1e-12, j * 1e-18, a * 1e-12 * 0.02, a * 1e-12].map(|x| x * STEP);
            for (what, (peak, most)) in
                ["V", "A", "J", "jump of A", "jump of V"].iter().zip(state.peaks.iter().zip(most))
            {
                // The limits here are floats, which are exact to 53 bits.
                assert!(
                    *peak as f64 <= most * (1.0 + 1e-15),
                    "{what} of {}: {peak} over {most}",
                    axis.name
                );
            }
        }
    }
}
