//! How far off their common line axes are, from nothing but how many pulses each of them has made.
//!
//! An axis that has made c of its n steps is where the line is at c / n, give or take half a step and what it travels
//! while its edges are late or early. There is a point of the line that near to all axes if there is one for each two
//! of them, and that is asked after every pulse, in whole numbers.

use carrystep_core::StartPhase;
use carrystep_profile::Line;

/// An axis at its worst on one line.
#[derive(Debug, Clone, Copy)]
struct Worst {
    /// Part of the line beyond half a step of either axis: negative if they are nearer.
    beyond: f64,
    /// Its pulse, or that of the other axis.
    pulse: u64,
}

/// Follows all axes along one line.
#[derive(Debug)]
struct LineCheck {
    line: Line,
    worst: Vec<Option<Worst>>,
}

/// How far off the line an axis has been.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Off {
    /// Steps, at its worst.
    pub steps: f64,
    /// Steps that it may be off.
    pub bound: f64,
    /// The number of the pulse, on any axis, after which that was so.
    pub pulse: u64,
}

/// Follows all axes through all moves.
#[derive(Debug)]
pub(crate) struct LinesCheck {
    lines: Vec<LineCheck>,
    phase: StartPhase,
    pulses: Vec<u64>,
}

impl LinesCheck {
    pub(crate) fn new(lines: Vec<Line>, phase: StartPhase, axes: usize) -> Self {
        let lines = lines.into_iter().map(|line| LineCheck { worst: vec![None; axes], line }).collect();
        Self { lines, phase, pulses: vec![0; axes] }
    }

    /// Takes a pulse of an axis.
    pub(crate) fn pulse(&mut self, axis: usize) {
        self.pulses[axis] += 1;
        let pulse = self.pulses[axis];
        let within =
            |line: &Line| (1..=line.steps[axis].unsigned_abs()).contains(&(pulse.saturating_sub(line.before[axis])));
        if let Some(check) = self.lines.iter_mut().find(|check| within(&check.line)) {
            check.measure(axis, &self.pulses, self.phase);
        }
    }

    /// Where an axis has come nearest to its bound, edges being off by up to `seconds`; `None` if it is in no line.
    pub(crate) fn off(&self, axis: usize, seconds: f64) -> Option<Off> {
        let offs = self.lines.iter().filter_map(|LineCheck { line, worst }| {
            let Worst { beyond, pulse } = worst[axis]?;
            let n = line.steps[axis].unsigned_abs() as f64;
            Some(Off { steps: 0.5 + n * beyond, bound: 0.5 + n * line.speed * seconds, pulse })
        });
        offs.max_by(|a, b| (a.steps - a.bound).total_cmp(&(b.steps - b.bound)))
    }
}

impl LineCheck {
    /// Compares the axis that has stepped with every other.
    fn measure(&mut self, axis: usize, pulses: &[u64], phase: StartPhase) {
        let (here, n) = self.place(axis, pulses, phase);
        for other in (0..pulses.len()).filter(|&other| other != axis && self.line.steps[other] != 0) {
            let (there, m) = self.place(other, pulses, phase);
            let apart = (here * m - there * n).abs() - (n + m);
            let worst = Worst { beyond: apart as f64 / (4.0 * n as f64 * m as f64), pulse: pulses[axis] };
            for axis in [axis, other] {
                if self.worst[axis].is_none_or(|old| old.beyond < worst.beyond) {
                    self.worst[axis] = Some(worst);
                }
            }
        }
    }

    /// Half steps to where an axis stands in the middle, and its steps.
    fn place(&self, axis: usize, pulses: &[u64], phase: StartPhase) -> (i128, i128) {
        let steps = self.line.steps[axis];
        let n = i128::from(steps.unsigned_abs());
        let done = i128::from(pulses[axis].saturating_sub(self.line.before[axis])).min(n);
        // A pulse is due in the middle of its step, or at its end, which backward is its start.
        let middle = match phase {
            StartPhase::Half => 0,
            StartPhase::Zero => i128::from(steps.signum()),
        };
        (2 * done + middle, n)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(pulses: &[usize]) -> Off {
        let line = Line { before: vec![0; 2], steps: vec![4, -2], speed: 1.0 };
        let mut check = LinesCheck::new(vec![line], StartPhase::Half, 2);
        pulses.iter().for_each(|&axis| check.pulse(axis));
        check.off(0, 0.01).unwrap()
    }

    #[test]
    fn a_line_in_its_order_is_within_half_a_step() {
        // Pulses are due at 1/8, 3/8, 5/8, 7/8 and at 1/4, 3/4 of the line.
        assert!(check(&[0, 1, 0, 0, 1, 0]).steps <= 0.5);
    }

    #[test]
    fn a_pulse_in_the_wrong_place_is_off() {
        // The second axis a quarter of the line late: due at 1/4, it comes after the pulse at 3/8.
        let late = check(&[0, 0, 1, 0, 1, 0]);
        assert!((late.steps - 0.75).abs() < 1e-12, "{late:?}");
        assert!((late.bound - 0.54).abs() < 1e-12, "{late:?}");
        assert_eq!(late.pulse, 2);
    }
}
