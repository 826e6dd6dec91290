//! What changes at the outputs where each row of a program begins.
//!
//! Most changes are marks of the program. The duty of a laser follows from the row itself, so that
//! it is right at the speed at which the row runs, under overrides and in holds as well:
//!
//! ```text
//! rows     r0     r1     r2     r3     r4     r5
//! mark            power: M4, S at the feed
//! speed    ____.--^^^^^^^^^^^^^^^^^^^^--.____         mean of each row
//! duty     0      #      #      #      +      0       of its rows, and 0 before a rest
//! ```

use crate::laser::LaserPower;
use crate::letter::LINEAR;
use crate::letters::Letters;
use crate::sync::is_wait;
use carrystep_core::{OutputChange, Segment};
use carrystep_files::Machine;
use carrystep_job::Row;
use std::sync::Arc;

/// 2^64, the units of a step.
const STEP: f64 = 18_446_744_073_709_551_616.0;
/// Weights of the speeds at the ends of a row and at its quarters: Boole's rule.
const WEIGHTS: [f64; 5] = [7.0 / 90.0, 32.0 / 90.0, 12.0 / 90.0, 32.0 / 90.0, 7.0 / 90.0];

/// An axis, as far as the speed along the path needs it.
#[derive(Debug, Clone, Copy)]
struct Axis {
    is_linear: bool,
    /// mm/s or degrees/s for a speed of one unit per tick; 0 for all but the first motor of a
    /// letter.
    speed: f64,
}

/// The changes of outputs of successive rows. Where rows are read again, a copy of the value that
/// was there goes on as before.
#[derive(Debug, Clone, Default)]
pub struct RowOutputs {
    /// The axes of a machine with a laser.
    axes: Option<Arc<[Axis]>>,
    power: LaserPower,
    /// The duty that was set last.
    duty: u16,
}

impl RowOutputs {
    /// The outputs of a machine's programs, all off.
    pub fn new(machine: &Machine, letters: &Letters) -> Self {
        let tick_seconds = machine.timebase.tick_seconds();
        let axis = |(motor, &letter): (usize, &usize)| Axis {
            is_linear: letter < LINEAR,
            speed: match letters.axis(letter) {
                Some(first) if first == motor => letters.step()[letter] / STEP / tick_seconds,
                _ => 0.0,
            },
        };
        let motors = letters.of_axes().iter().enumerate();
        let axes = machine.output_uses.laser.then(|| motors.map(axis).collect());
        Self { axes, ..Self::default() }
    }

    /// The same with all outputs off, where the tool rests: the power of a laser stays in force for
    /// the next move.
    #[must_use]
    pub fn at_rest(&self) -> Self {
        Self { duty: 0, ..self.clone() }
    }

    /// What changes where the next row begins.
    pub fn change(&mut self, row: &Row) -> OutputChange {
        let mut change = OutputChange::NONE;
        for &mark in row.marks.iter().filter(|&&mark| !is_wait(mark)) {
            match LaserPower::of_mark(mark) {
                Some(power) => self.power = power,
                None => change = change.then(OutputChange::of_word(mark as u32)),
            }
        }
        if let Some(axes) = &self.axes {
            self.duty = change.duty.unwrap_or(self.duty);
            let duty = if row.rests { 0 } else { self.power.duty(speed(axes, &row.segments)) };
            if std::mem::replace(&mut self.duty, duty) != duty {
                change.duty = Some(duty);
            }
        }
        change
    }
}

/// The mean speed along the path: in mm/s if a linear axis moves, otherwise in degrees/s.
fn speed(axes: &[Axis], segments: &[Segment]) -> f64 {
    let [mut linear, mut rotary] = [0.0; 2];
    for (number, weight) in WEIGHTS.iter().enumerate() {
        let part = number as f64 / (WEIGHTS.len() - 1) as f64;
        let mut squares = [0.0; 2];
        for (axis, segment) in axes.iter().zip(segments) {
            let tick = part * f64::from(segment.ticks);
            let [v, a, j] = [segment.v, segment.a, segment.j].map(|value| value as f64);
            let speed = (v + tick * (a + tick * j / 2.0)) * axis.speed;
            squares[usize::from(!axis.is_linear)] += speed * speed;
        }
        linear += weight * squares[0].sqrt();
        rotary += weight * squares[1].sqrt();
    }
    if linear > 0.0 { linear } else { rotary }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A row along a line at these speeds of x and y, mm/s, with 80 and 160 steps/mm and ticks of
    /// 1 us.
    fn row(x: f64, y: f64, power: Option<LaserPower>, rests: bool) -> Row {
        let segment = |v: f64, steps: f64| {
            let v = (v * steps * 1e-6 * STEP) as i64;
            Segment { ticks: 4000, v, a: 0, j: 0, last: false }
        };
        let marks = power.map(LaserPower::mark).into_iter().collect();
        let (feed, off, corner) = (1.0, 0.0, 0.0);
        let segments = vec![segment(x, 80.0), segment(y, 160.0)];
        Row { ticks: 4000, segments, line: 1, block: 1, feed, off, corner, marks, rests }
    }

    fn laser() -> RowOutputs {
        let axis = |steps: f64| Axis { is_linear: true, speed: 1.0 / steps / STEP / 1e-6 };
        RowOutputs { axes: Some([axis(80.0), axis(160.0)].into()), ..RowOutputs::default() }
    }

    #[test]
    fn duty_follows_the_speed_and_is_told_where_it_changes() {
        let mut laser = laser();
        let power = LaserPower::Following { duty: 1000, feed: 50.0 };
        let mut duty = |row| laser.change(&row).duty;
        assert_eq!(duty(row(30.0, 40.0, None, false)), None);
        assert_eq!(duty(row(30.0, -40.0, Some(power), false)), Some(1000));
        assert_eq!(duty(row(-40.0, 30.0, None, false)), None);
        assert_eq!(duty(row(15.0, 20.0, None, false)), Some(500));
        assert_eq!(duty(row(60.0, 80.0, None, false)), Some(2000));
        assert_eq!(duty(row(600.0, 800.0, None, false)), Some(4095));
        assert_eq!(duty(row(0.0, 0.0, None, false)), Some(0));
        assert_eq!(duty(row(0.0, 5.0, None, false)), Some(100));
        assert_eq!(duty(row(0.0, 5.0, None, true)), Some(0));
        assert_eq!(duty(row(0.0, 5.0, Some(LaserPower::Off), false)), None);
    }

    #[test]
    fn constant_power_is_off_at_rest() {
        let mut laser = laser();
        let power = LaserPower::Constant { duty: 7 };
        let mut duty = |row| laser.change(&row).duty;
        assert_eq!(duty(row(1.0, 0.0, Some(power), false)), Some(7));
        assert_eq!(duty(row(9.0, 0.0, None, true)), Some(0));
        assert_eq!(duty(row(0.0, 0.0, None, false)), None);
        assert_eq!(duty(row(0.0, 0.1, None, false)), Some(7));
    }

    #[test]
    fn accelerated_row_has_its_mean_speed() {
        let mut one = row(0.0, 0.0, None, false);
        // From 0 to 100 mm/s: 50 mm/s.
        one.segments[0].a = (100.0 * 80.0 * 1e-6 * STEP / 4000.0) as i64;
        let mut laser = laser();
        laser.power = LaserPower::Following { duty: 4000, feed: 100.0 };
        assert_eq!(laser.change(&one).duty, Some(2000));
    }

    #[test]
    fn machine_without_a_laser_has_the_marks_alone() {
        let mut plain = RowOutputs::default();
        let mut one = row(1.0, 0.0, None, false);
        let change = OutputChange { mask: 3, levels: 1, duty: Some(9) };
        one.marks = vec![change.word().into()];
        assert_eq!(plain.change(&one), change);
        assert!(plain.change(&row(1.0, 0.0, None, true)).is_none());
    }
}
