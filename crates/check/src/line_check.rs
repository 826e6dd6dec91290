//! Checks how far the axes are off their common line, only from the number of pulses of each axis.
//!
//! An axis that has made c of its n steps is where the line is at c / n, within half a step and the
//! distance that it travels while its edges are late or early. A point of the line is that near to
//! all axes if there is such a point for each pair of axes. The pairs are compared after every
//! pulse, in whole numbers. Of a line that all axes have travelled, only what may be the worst of
//! all lines is kept (`worst_lines.rs`).

use crate::edge::{Pin, PinChange};
use crate::ideal::nearest;
use crate::worst_lines::{OnLine, WorstLines};
use carrystep_core::StartPhase;
use carrystep_profile::{Course, Reader};
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;

mod part;

pub(crate) use part::LinesPart;

/// The greatest deviation of two axes from each other on one line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
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
    /// Steps of each axis; negative is backward.
    steps: Vec<i64>,
    /// Greatest speed along the line, as the fraction of the line that is travelled in a second.
    speed: f64,
    /// Pulses that each axis has to make before the line.
    before: Vec<u64>,
    pairs: Pairs,
}

/// For each pair of axes, at the place that [`pair`] gives.
type Pairs = Vec<Option<Worst>>;

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
    courses: Reader<Course>,
    phase: StartPhase,
    /// Whether the STEP of each axis is high.
    high: Vec<bool>,
    pulses: Vec<u64>,
    /// Pulses that each axis has to make in the moves that were read.
    required: Vec<u64>,
    /// The lines that were read and that not all axes have travelled yet.
    lines: VecDeque<LineCheck>,
    /// Number of lines that all axes have travelled.
    travelled: usize,
    /// Number of lines, the first ones, that had begun before the part of the capture that is
    /// checked; 0 if the check began where the capture begins.
    earlier: usize,
    /// Of the earlier lines, those that all axes have travelled.
    ended: Vec<Pairs>,
    /// The pulses of each axis before that part.
    before: Vec<u64>,
    /// Of each axis, the number of the first line that its pulses have not passed.
    reached: Vec<usize>,
    /// For each axis, the lines that all axes have travelled.
    worst: Vec<WorstLines>,
}

impl LinesCheck {
    /// `courses` are those of all moves.
    pub(crate) fn new(courses: Reader<Course>, phase: StartPhase, axes: usize) -> Self {
        Self {
            courses,
            phase,
            high: vec![false; axes],
            pulses: vec![0; axes],
            required: vec![0; axes],
            lines: VecDeque::new(),
            travelled: 0,
            earlier: 0,
            ended: Vec::new(),
            before: vec![0; axes],
            reached: vec![0; axes],
            worst: vec![WorstLines::default(); axes],
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
        while self.required[axis] < pulse && self.begin_next() {}
        let place = self.reached[axis].max(self.travelled);
        for (number, check) in (self.travelled..).zip(&mut self.lines).skip(place - self.travelled)
        {
            self.reached[axis] = number;
            match pulse.saturating_sub(check.before[axis]) {
                0 => return,
                done if done <= check.steps[axis].unsigned_abs() => {
                    check.measure(axis, &self.pulses, self.phase);
                    return self.end_travelled();
                }
                _ => {}
            }
        }
        self.reached[axis] = self.travelled + self.lines.len();
    }

    /// Adds the next move, if its axes travel along a line. False if there is no further move.
    fn begin_next(&mut self) -> bool {
        let Some(Course { steps, line_speed }) = self.courses.next() else { return false };
        let before = self.required.clone();
        for (sum, steps) in self.required.iter_mut().zip(&steps) {
            *sum += steps.unsigned_abs();
        }
        if let Some(speed) = line_speed.filter(|_| steps.iter().any(|&steps| steps != 0)) {
            let pairs = vec![None; steps.len() * steps.len()];
            self.lines.push_back(LineCheck { steps, speed, before, pairs });
        }
        true
    }

    /// Ends the check of the first lines, as far as all axes have travelled them.
    fn end_travelled(&mut self) {
        while self.lines.front().is_some_and(|check| check.is_over(&self.pulses)) {
            let Some(check) = self.lines.pop_front() else { return };
            self.travelled += 1;
            if self.travelled <= self.earlier {
                self.ended.push(check.pairs);
            } else {
                self.keep_worst(&check);
            }
        }
    }

    fn keep_worst(&mut self, check: &LineCheck) {
        for (axis, worst) in self.worst.iter_mut().enumerate() {
            check.deviation(axis).into_iter().for_each(|deviation| worst.add(deviation));
        }
    }

    /// The deviation of an axis that came nearest to its bound, if edges may be off by up to
    /// `seconds`; `None` if the axis is not part of any line.
    pub(crate) fn off(&self, axis: usize, seconds: f64) -> Option<Off> {
        let last = self.lines.iter().filter_map(|check| check.deviation(axis));
        let all = self.worst[axis].iter().chain(last);
        let offs = all.map(|OnLine { steps, speed, pulse }| Off {
            steps,
            bound: 0.5 + speed * seconds,
            pulse,
        });
        offs.max_by(|a, b| (a.steps - a.bound).total_cmp(&(b.steps - b.bound)))
    }
}

impl LineCheck {
    /// Compares the axis that has stepped with every other axis.
    fn measure(&mut self, axis: usize, pulses: &[u64], phase: StartPhase) {
        let (here, n) = self.place(axis, pulses, phase);
        for other in (0..pulses.len()).filter(|&other| other != axis && self.steps[other] != 0) {
            let (there, m) = self.place(other, pulses, phase);
            let apart = (here * m - there * n).abs() - (n + m);
            let worst = &mut self.pairs[pair(axis, other, pulses.len())];
            if worst.is_none_or(|old| old.apart < apart) {
                let all_pulses = pulses.iter().sum();
                *worst = Some(Worst { apart, pulse: pulses[axis], all_pulses });
            }
        }
    }

    /// Whether all axes have made their pulses on this line.
    fn is_over(&self, pulses: &[u64]) -> bool {
        let left = |axis: usize| pulses[axis].saturating_sub(self.before[axis]);
        (0..pulses.len()).all(|axis| left(axis) >= self.steps[axis].unsigned_abs())
    }

    /// The greatest deviation of an axis from any other one; the first one of equal ones.
    fn deviation(&self, axis: usize) -> Option<OnLine> {
        let of = |axis: usize| self.steps[axis].unsigned_abs() as f64;
        let each = (0..self.steps.len()).filter(|&other| other != axis).filter_map(|other| {
            let worst = (*self.pairs.get(pair(axis, other, self.steps.len()))?)?;
            Some((nearest(worst.apart) / (4.0 * of(axis) * of(other)), worst))
        });
        let first_of_greatest = each.max_by(|(a, before), (b, after)| {
            a.total_cmp(b).then(after.all_pulses.cmp(&before.all_pulses))
        });
        first_of_greatest.map(|(beyond, worst)| OnLine {
            steps: 0.5 + of(axis) * beyond,
            speed: of(axis) * self.speed,
            pulse: worst.pulse,
        })
    }

    /// The middle of an axis' current place on the line, in half steps, and the number of its
    /// steps.
    fn place(&self, axis: usize, pulses: &[u64], phase: StartPhase) -> (i128, i128) {
        let steps = self.steps[axis];
        let n = steps.unsigned_abs();
        let done = i128::from(pulses[axis].saturating_sub(self.before[axis]).min(n));
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
        let line = Course { steps: vec![4, -2], line_speed: Some(1.0) };
        let mut check = LinesCheck::new(vec![line].into(), StartPhase::Half, 2);
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
