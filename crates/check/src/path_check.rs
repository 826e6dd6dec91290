//! The checker of jobs: rebuilds the tool from the pulses alone and compares it with the programmed
//! path. It knows nothing of the plan.
//!
//! Each rising edge of STEP moves the tool by one step of one motor: along its letter, or, on crossed
//! belts, along a diagonal of x and y. After each of them, the tool must be within the tolerance and
//! one step of each motor of the programmed path, in its order
//! (`path_follow.rs`). At the end, all counts must be exact. The pins must keep the times of their
//! drivers, and no pulse may come before the start or after the end of the job. Outputs must change
//! where the program changes them (`output_places.rs`).

use crate::edge::{PinChange, PinSink};
use crate::error::TraceError;
use crate::output_places::{OutputMarks, OutputPlaces};
use crate::path_follow::{Lost, Off, PathFollow};
use crate::path_leg::{LETTERS, PathLeg, Place};
use crate::path_report::{PathAxisReport, PathReport, minimum};
use crate::pins::PinWatch;
use carrystep_core::build::PinTimes;
use std::fmt;

const PS: f64 = 1e12;
/// Stretches of the distance that is allowed whose pulses are counted.
const STRETCHES: usize = 40;

/// One axis of a job.
#[derive(Debug, Clone)]
pub struct PathAxis<'a> {
    /// Its name.
    pub name: &'a str,
    /// The letter that it moves: 0 to 2 for x, y, z, 3 to 5 for a, b, c.
    pub letter: usize,
    /// How far one step moves the tool: x, y, z in mm, a, b, c in degrees. The motors of one machine
    /// move it at right angles to each other. Of several motors of a letter, the first one counts.
    pub moves: [f64; LETTERS],
    /// Machine place at the beginning, steps.
    pub start_steps: i64,
    /// Steps forward minus steps backward that the program requires.
    pub steps: i64,
    /// Minimum times of the driver.
    pub pins_ns: PinTimes,
}

/// What a capture of a job is compared with.
#[derive(Debug, Clone)]
pub struct PathSetup<'a> {
    /// The axes, in the order of their numbers.
    pub axes: Vec<PathAxis<'a>>,
    /// The place where the program begins: x, y, z in mm, a, b, c in degrees.
    pub start: [f64; LETTERS],
    /// The start of the job plus the latency L, ps of the capture.
    pub origin_ps: u64,
    /// Length of the job, ps; [`u64::MAX`] if it is not known.
    pub total_ps: u64,
    /// Uncertainty of the capture's times, ps. It widens the bounds of the pin times.
    pub slack_ps: u64,
}

/// Checks a capture of a job from a stream of pin changes, in constant memory.
pub struct PathChecker<'a> {
    setup: PathSetup<'a>,
    follow: PathFollow<'a>,
    place: Place,
    /// For each letter, the motors that move it and by how much with a step.
    motors: [Vec<(usize, f64)>; LETTERS],
    positions: Vec<i64>,
    watches: Vec<PinWatch>,
    worst: Option<(Off, u64)>,
    /// Pulses by distance.
    counts: Vec<u64>,
    lost: Option<(Lost, u64)>,
    /// The first time at which two motors of a letter were more than a step apart, and what to say.
    racked: Option<(String, u64)>,
    outputs: Option<OutputPlaces<'a>>,
    /// The end of the capture, or the last change before it, ps.
    end_ps: u64,
    /// Times of the first and the last pulse, ps.
    times: Option<[u64; 2]>,
}

impl fmt::Debug for PathChecker<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("PathChecker").field("place", &self.place).finish_non_exhaustive()
    }
}

impl<'a> PathChecker<'a> {
    /// A checker that has not seen any change. `legs` is the programmed path.
    pub fn new(setup: PathSetup<'a>, legs: Box<dyn Iterator<Item = PathLeg> + Send + 'a>) -> Self {
        let count = setup.axes.len();
        let counts = |axis: &usize| {
            let letter = setup.axes[*axis].letter;
            !setup.axes[..*axis].iter().any(|before| before.letter == letter)
        };
        let motors: [Vec<_>; LETTERS] = std::array::from_fn(|letter| {
            let moves = |axis: usize| (axis, setup.axes[axis].moves[letter]);
            (0..count).filter(counts).map(moves).filter(|(_, moves)| *moves != 0.0).collect()
        });
        // Over motors at right angles, the squares of their steps add up to those of the letters.
        let step: Place = std::array::from_fn(|letter| {
            motors[letter].iter().fold(0.0, |sum: f64, (_, moves)| sum.hypot(*moves))
        });
        let follow = PathFollow::new(legs, setup.start, step);
        let mut this = Self {
            place: setup.start,
            motors,
            positions: vec![0; count],
            watches: vec![PinWatch::default(); count],
            follow,
            worst: None,
            counts: vec![0; STRETCHES + 1],
            lost: None,
            racked: None,
            outputs: None,
            end_ps: 0,
            times: None,
            setup,
        };
        for letter in 0..LETTERS {
            this.stand(letter);
        }
        this.follow(this.setup.origin_ps);
        this
    }

    /// The checker also compares where the outputs of this mask change with the marks of the
    /// program.
    #[must_use]
    pub fn with_outputs(mut self, marks: OutputMarks<'a>, mask: u8) -> Self {
        self.outputs = Some(OutputPlaces::new(marks, mask, self.setup.slack_ps));
        self
    }

    /// Puts a letter of the tool where the positions of its motors say.
    fn stand(&mut self, letter: usize) {
        let [first, others @ ..] = &self.motors[letter][..] else { return };
        let part = |(axis, moves): &(usize, f64)| {
            (self.setup.axes[*axis].start_steps + self.positions[*axis]) as f64 * moves
        };
        self.place[letter] = others.iter().fold(part(first), |sum, other| sum + part(other));
    }

    /// Looks whether the motors of the letter that this motor moves are together. Their edges are at
    /// one time, and one after the other in the capture.
    fn is_square(&mut self, axis: usize, ps: u64) {
        let motor = &self.setup.axes[axis];
        let place = |axis: usize| self.setup.axes[axis].start_steps + self.positions[axis];
        let mut others = (0..axis).chain(axis + 1..self.positions.len());
        let racked = others.find(|&other| {
            self.setup.axes[other].letter == motor.letter && place(other).abs_diff(place(axis)) > 1
        });
        if let (Some(other), None) = (racked, &self.racked) {
            let [first, second] =
                [axis.min(other), axis.max(other)].map(|axis| self.setup.axes[axis].name);
            let apart = place(other).abs_diff(place(axis));
            let motors = format!("{first} and {second} move one letter and are {apart} steps");
            self.racked = Some((motors, ps));
        }
    }

    fn follow(&mut self, ps: u64) {
        if self.lost.is_some() {
            return;
        }
        if let Some(outputs) = &mut self.outputs {
            outputs.before(ps, &self.follow);
        }
        match self.follow.go(&self.place) {
            Ok(Some(off)) => {
                let stretch = (off.part() * STRETCHES as f64) as usize;
                self.counts[stretch.min(STRETCHES)] += 1;
                if self.worst.as_ref().is_none_or(|(worst, _)| off.part() > worst.part()) {
                    self.worst = Some((off, ps));
                }
            }
            Ok(None) => {}
            Err(lost) => {
                self.lost = Some((lost, ps));
                return;
            }
        }
        if let Some(outputs) = &mut self.outputs {
            outputs.moved(ps, &self.follow);
        }
    }

    /// Seconds from the start of the job.
    fn seconds(&self, ps: u64) -> f64 {
        (i128::from(ps) - i128::from(self.setup.origin_ps)) as f64 / PS
    }

    /// Sets the length of the job, ps, and the steps that the program requires of each axis, where
    /// they were not known before.
    pub fn ends(&mut self, total_ps: u64, steps: impl Iterator<Item = i64>) {
        self.setup.total_ps = total_ps;
        for (axis, steps) in self.setup.axes.iter_mut().zip(steps) {
            axis.steps = steps;
        }
    }

    /// Sets the start of the job, where it was not known before.
    pub(crate) fn begin_at(&mut self, origin_ps: u64) {
        self.setup.origin_ps = origin_ps;
    }

    /// Ends the check and returns the report.
    pub fn finish(mut self) -> PathReport {
        let mut failures = Vec::new();
        if let Some((Lost { off }, ps)) = self.lost {
            failures.push(format!(
                "the tool leaves the path at {:.6} s, near line {}: {} from it, {} allowed",
                self.seconds(ps),
                off.line,
                distance(&off, off.linear, off.rotary),
                distance(&off, off.linear_bound, off.rotary_bound)
            ));
        } else if !self.follow.is_at_the_end() {
            let line = self.follow.line().unwrap_or(0);
            failures.push(format!("the pulses end before the path does, near line {line}"));
        }
        if let Some((motors, ps)) = &self.racked {
            failures.push(format!("the motors {motors} apart at {:.6} s", self.seconds(*ps)));
        }
        if let Some(outputs) = self.outputs.as_mut().filter(|_| self.lost.is_none()) {
            outputs.end(self.end_ps, &self.follow);
        }
        let wrong = self.outputs.as_ref().and_then(|outputs| outputs.wrong.as_ref());
        failures.extend(
            wrong.map(|wrong| format!("{}, at {:.6} s", wrong.what, self.seconds(wrong.ps))),
        );
        if let Some([first, last]) = self.times {
            let slack = self.setup.slack_ps;
            let end = self.setup.origin_ps.saturating_add(self.setup.total_ps);
            if first.saturating_add(slack) < self.setup.origin_ps
                || last > end.saturating_add(slack)
            {
                failures.push(format!(
                    "there are pulses from {:.9} s to {:.9} s, and the job lasts {:.9} s",
                    self.seconds(first),
                    self.seconds(last),
                    self.setup.total_ps as f64 / PS
                ));
            }
        }
        let axes = self.setup.axes.iter().zip(&self.watches).zip(&self.positions);
        let axes: Vec<PathAxisReport> = axes
            .map(|((axis, watch), &position)| {
                let shortest = watch.shortest();
                let report = PathAxisReport {
                    axis: axis.name.to_owned(),
                    pulses: watch.pulses(),
                    position_expected: axis.steps,
                    position_found: position,
                    step_high_min_ns: minimum(shortest.step_high),
                    step_high_required_ns: axis.pins_ns.step_high as f64,
                    step_low_min_ns: minimum(shortest.step_low),
                    step_low_required_ns: axis.pins_ns.step_low as f64,
                    dir_setup_min_ns: minimum(shortest.dir_setup),
                    dir_setup_required_ns: axis.pins_ns.dir_setup as f64,
                    dir_hold_min_ns: minimum(shortest.dir_hold),
                    dir_hold_required_ns: axis.pins_ns.dir_hold as f64,
                };
                failures.extend(report.failures(self.setup.slack_ps as f64 / 1e3));
                report
            })
            .collect();
        let (worst, at) = match self.worst {
            Some((off, ps)) => (off, Some(self.seconds(ps.max(self.setup.origin_ps)))),
            None => (
                Off { linear: 0.0, rotary: 0.0, linear_bound: 0.0, rotary_bound: 0.0, line: 0 },
                None,
            ),
        };
        PathReport {
            passed: failures.is_empty(),
            deviation_mm: worst.linear,
            deviation_bound_mm: worst.linear_bound,
            deviation_deg: worst.rotary,
            deviation_bound_deg: worst.rotary_bound,
            deviation_line: at.map(|_| worst.line),
            deviation_at_s: at,
            deviation_counts: self.counts,
            output_changes: self.outputs.map(|outputs| outputs.changes),
            axes,
            failures,
        }
    }
}

/// The distance that is too great: over x, y and z, or of a rotary letter.
fn distance(off: &Off, linear: f64, rotary: f64) -> String {
    if off.linear / off.linear_bound >= off.rotary / off.rotary_bound {
        format!("{linear:.6} mm")
    } else {
        format!("{rotary:.6} degrees")
    }
}

impl PinSink for PathChecker<'_> {
    fn initial(&mut self, level: PinChange) -> Result<(), TraceError> {
        if let Some(watch) = self.watches.get_mut(usize::from(level.axis)) {
            watch.initial(level.pin, level.level);
        }
        Ok(())
    }

    fn change(&mut self, change: PinChange) -> Result<(), TraceError> {
        let axis = usize::from(change.axis);
        let Some(watch) = self.watches.get_mut(axis) else { return Ok(()) };
        if watch.change(change) {
            self.positions[axis] += if watch.backward() { -1 } else { 1 };
            let first = self.times.map_or(change.ps, |[first, _]| first);
            self.times = Some([first, change.ps]);
            for letter in 0..LETTERS {
                if self.setup.axes[axis].moves[letter] != 0.0 {
                    self.stand(letter);
                }
            }
            self.is_square(axis, change.ps);
            self.follow(change.ps);
        }
        self.end_ps = change.ps;
        Ok(())
    }

    fn outputs(&mut self, ps: u64, levels: u8) -> Result<(), TraceError> {
        if let Some(outputs) = self.outputs.as_mut().filter(|_| self.lost.is_none()) {
            outputs.levels(ps, levels, &self.follow);
        }
        self.end_ps = ps;
        Ok(())
    }

    fn end(&mut self, ps: u64) -> Result<(), TraceError> {
        self.end_ps = ps;
        Ok(())
    }
}
