//! Checks how far the axes are off their common line, only from the number of pulses of each axis.
//!
//! An axis that has made c of its n steps is where the line is at c / n, within half a step and the
//! distance that it travels while its edges are late or early. A point of the line is that near to
//! all axes if there is such a point for each pair of axes. The pairs are compared after every
//! pulse, in whole numbers.

use crate::edge::{Pin, PinChange};
use crate::ideal::nearest;
use carrystep_core::StartPhase;
use carrystep_profile::StraightLine;

/// The greatest deviation of two axes from each other on one line.
#[derive(Debug, Clone, Copy)]
struct Worst {
    /// Deviation beyond half a step of both axes, in 1 / (4 n m) of the line for axes of n and m
    /// steps; negative if they are nearer.
    apart: i128,
    /// Number of the pulse of one of the two axes after which it occurred.
    pulse: u64,
    /// Number of pulses that all axes had made together.
    all_pulses: u64,
}

/// Follows all axes along one line.
#[derive(Debug)]
struct LineCheck {
    line: StraightLine,
    /// For each pair of axes, at the place that [`pair`] gives, while the axes are on the line.
    pairs: Vec<Option<Worst>>,
    /// For each axis, when all axes have travelled the line: its greatest deviation as
    /// [`Self::worst`] gives it.
    done: Vec<Option<(f64, u64)>>,
}

/// How far an axis was off its line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Off {
    /// The greatest deviation, steps.
    pub steps: f64,
    /// The allowed deviation, steps.
    pub bound: f64,
    /// Number of the pulse, on any axis, after which the greatest deviation occurred.
    pub pulse: u64,
}

/// Follows all axes through all moves.
#[derive(Debug)]
pub(crate) struct LinesCheck {
    lines: Vec<LineCheck>,
    phase: StartPhase,
    /// Whether the STEP of each axis is high.
    high: Vec<bool>,
    pulses: Vec<u64>,
    /// Of each axis, the number of the first line that its pulses have not passed.
    reached: Vec<usize>,
}

impl LinesCheck {
    /// The lines are in the order of the moves.
    pub(crate) fn new(lines: Vec<StraightLine>, phase: StartPhase, axes: usize) -> Self {
        let lines = lines
            .into_iter()
            .map(|line| LineCheck { line, pairs: Vec::new(), done: Vec::new() })
            .collect();
        Self {
            lines,
            phase,
            high: vec![false; axes],
            pulses: vec![0; axes],
            reached: vec![0; axes],
        }
    }

    /// Takes the level of a pin at the start of the capture.
    pub(crate) fn initial(&mut self, level: PinChange) {
        if let (Pin::Step, Some(high)) = (level.pin, self.high.get_mut(usize::from(level.axis))) {
            *high = level.level;
        }
    }

    /// Takes the change of a pin.
    pub(crate) fn change(&mut self, change: PinChange) {
        let axis = usize::from(change.axis);
        let (Pin::Step, Some(high)) = (change.pin, self.high.get_mut(axis)) else { return };
        if change.level && !*high {
            self.pulse(axis);
        }
        self.high[axis] = change.level;
    }

    /// Takes a pulse of an axis.
    fn pulse(&mut self, axis: usize) {
        self.pulses[axis] += 1;
        let pulse = self.pulses[axis];
        let place = &mut self.reached[axis];
        while let Some(check) = self.lines.get_mut(*place) {
            let (before, steps) = (check.line.before[axis], check.line.steps[axis].unsigned_abs());
            match pulse.saturating_sub(before) {
                0 => return,
                done if done <= steps => return check.measure(axis, &self.pulses, self.phase),
                _ => *place += 1,
            }
        }
    }

    /// The deviation of an axis that came nearest to its bound, if edges may be off by up to
    /// `seconds`; `None` if the axis is not part of any line.
    pub(crate) fn off(&self, axis: usize, seconds: f64) -> Option<Off> {
        let offs = self.lines.iter().filter_map(|check| {
            let (beyond, pulse) = check.worst(axis)?;
            let (n, speed) = (check.line.steps[axis].unsigned_abs() as f64, check.line.speed);
            Some(Off { steps: 0.5 + n * beyond, bound: 0.5 + n * speed * seconds, pulse })
        });
        offs.max_by(|a, b| (a.steps - a.bound).total_cmp(&(b.steps - b.bound)))
    }
}

impl LineCheck {
    /// Compares the axis that has stepped with every other axis.
    fn measure(&mut self, axis: usize, pulses: &[u64], phase: StartPhase) {
        if self.pairs.is_empty() {
            self.pairs = vec![None; pulses.len() * pulses.len()];
        }
        let (here, n) = self.place(axis, pulses, phase);
        for other in (0..pulses.len()).filter(|&other| other != axis && self.line.steps[other] != 0)
        {
            let (there, m) = self.place(other, pulses, phase);
            let apart = (here * m - there * n).abs() - (n + m);
            let worst = &mut self.pairs[pair(axis, other, pulses.len())];
            if worst.is_none_or(|old| old.apart < apart) {
                let all_pulses = pulses.iter().sum();
                *worst = Some(Worst { apart, pulse: pulses[axis], all_pulses });
            }
        }
        if self.is_over(axis, pulses) && (0..pulses.len()).all(|axis| self.is_over(axis, pulses)) {
            self.done = (0..pulses.len()).map(|axis| self.worst(axis)).collect();
            self.pairs = Vec::new();
        }
    }

    /// Whether the axis has made all its pulses on this line.
    fn is_over(&self, axis: usize, pulses: &[u64]) -> bool {
        pulses[axis].saturating_sub(self.line.before[axis]) >= self.line.steps[axis].unsigned_abs()
    }

    /// The greatest deviation of an axis from any other one, as a fraction of the line, and the
    /// pulse after which it occurred; the first one of equal ones.
    fn worst(&self, axis: usize) -> Option<(f64, u64)> {
        if let Some(worst) = self.done.get(axis) {
            return *worst;
        }
        let steps = &self.line.steps;
        let of = |axis: usize| steps[axis].unsigned_abs() as f64;
        let each = (0..steps.len()).filter(|&other| other != axis).filter_map(|other| {
            let worst = (*self.pairs.get(pair(axis, other, steps.len()))?)?;
            Some((nearest(worst.apart) / (4.0 * of(axis) * of(other)), worst))
        });
        let first_of_greatest = each.max_by(|(a, before), (b, after)| {
            a.total_cmp(b).then(after.all_pulses.cmp(&before.all_pulses))
        });
        first_of_greatest.map(|(beyond, worst)| (beyond, worst.pulse))
    }

    /// The middle of an axis' current place on the line, in half steps, and the number of its
    /// steps.
    fn place(&self, axis: usize, pulses: &[u64], phase: StartPhase) -> (i128, i128) {
        let steps = self.line.steps[axis];
        let n = steps.unsigned_abs();
        let done = i128::from(pulses[axis].saturating_sub(self.line.before[axis]).min(n));
        // A pulse is due in the middle of its step, or at phase zero at its end, which is the start
        // of the step for a backward move.
        let middle = match phase {
            StartPhase::Half => 0,
            StartPhase::Zero => i128::from(steps.signum()),
        };
        (2 * done + middle, n.into())
    }
}

/// The place of a pair of axes, in either order, in a list of all pairs.
fn pair(axis: usize, other: usize, axes: usize) -> usize {
    axis.min(other) * axes + axis.max(other)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(pulses: &[usize]) -> Off {
        let line = StraightLine { before: vec![0; 2], steps: vec![4, -2], speed: 1.0 };
        let mut check = LinesCheck::new(vec![line], StartPhase::Half, 2);
        pulses.iter().for_each(|&axis| check.pulse(axis));
        check.off(0, 0.01).unwrap()
    }

    #[test]
    fn axes_in_the_order_of_the_line_stay_within_half_a_step() {
        // Pulses are due at 1/8, 3/8, 5/8 and 7/8 of the line for the first axis, and at 1/4 and
        // 3/4 for the second.
        assert!(check(&[0, 1, 0, 0, 1, 0]).steps <= 0.5);
    }

    #[test]
    fn late_pulse_of_one_axis_is_off_the_line() {
        // The second axis is a quarter of the line late: its pulse is due at 1/4, and comes after
        // the pulse at 3/8 of the first axis.
        let late = check(&[0, 0, 1, 0, 1, 0]);
        assert!((late.steps - 0.75).abs() < 1e-12, "{late:?}");
        assert!((late.bound - 0.54).abs() < 1e-12, "{late:?}");
        assert_eq!(late.pulse, 2);
    }
}
