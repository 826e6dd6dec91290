//! `letter`: several motors that move one letter, as on a gantry.
//!
//! The motors of a letter get the same steps, tick by tick. They can only stay together if nothing
//! depends on which of them it is: all get the least of their limits, the longest of their driver's
//! times and the same travel. In homing each finds a switch of its own, and all rest at one place.

use super::{Axis, AxisLimit};
use crate::error::{InputError, SourceText, quoted};
use carrystep_core::build::{PinTimes, PinTiming, Timebase};
use carrystep_core::engine::LimitWiring;
use std::ops::Range;
use toml::Spanned;

/// The letters of G-code, each of which may have several motors.
const LETTERS: [&str; 6] = ["x", "y", "z", "a", "b", "c"];

/// What an axis' table says of its letter, and where.
pub(super) struct RawMotor {
    pub(super) letter: Option<Spanned<String>>,
    /// The place of its name.
    pub(super) name: Range<usize>,
    /// The place of its table.
    pub(super) table: Range<usize>,
}

/// Sets the letter of each motor, and makes the motors of a letter equal.
pub(super) fn unite(
    source: &SourceText,
    timebase: &Timebase,
    axes: &mut [Axis],
    motors: &[RawMotor],
) -> Result<(), InputError> {
    for (axis, motor) in axes.iter_mut().zip(motors) {
        if let Some(letter) = &motor.letter {
            axis.letter = of(source, axis, letter)?;
        }
    }
    for later in 1..axes.len() {
        let Some(first) = axes[..later].iter().position(|axis| axis.letter == axes[later].letter)
        else {
            continue;
        };
        let (before, after) = axes.split_at_mut(later);
        let (leader, axis) = (&mut before[first], &mut after[0]);
        fits(source, leader, axis, &motors[later])?;
        leader.take_least(axis);
        leader.check_speed(source, motors[later].table.clone(), timebase)?;
    }
    for motor in 0..axes.len() {
        let leader = axes.iter().position(|axis| axis.letter == axes[motor].letter);
        if let Some(leader) = leader.filter(|&leader| leader != motor) {
            let leader = axes[leader].clone();
            axes[motor].take_least(&leader);
        }
    }
    Ok(())
}

/// Gives two motors the least of their limits and the longest of their driver's times.
pub(super) fn make_equal(axes: &mut [Axis], first: usize, second: usize) {
    let other = axes[second].clone();
    axes[first].take_least(&other);
    let other = axes[first].clone();
    axes[second].take_least(&other);
}

/// The letter of a motor.
fn of(source: &SourceText, axis: &Axis, letter: &Spanned<String>) -> Result<String, InputError> {
    let name = letter.as_ref();
    if !LETTERS.contains(&name.as_str()) {
        let message = format!("letter = {:?}: there is no such letter", quoted(name));
        return Err(InputError::at(source, letter.span(), message)
            .help("a motor moves x, y, z, a, b or c; without the key, the letter is its name"));
    }
    if LETTERS.contains(&axis.name.as_str()) && axis.name != *name {
        let message = format!("the axis '{}' has the letter {name}", axis.name);
        return Err(InputError::at(source, letter.span(), message)
            .help(format!("give the axis another name, '{name}2' for example")));
    }
    Ok(name.clone())
}

/// Refuses a motor that cannot make the same steps as the first motor of its letter.
fn fits(
    source: &SourceText,
    leader: &Axis,
    axis: &Axis,
    motor: &RawMotor,
) -> Result<(), InputError> {
    let at = |message: String| InputError::at(source, motor.name.clone(), message);
    let Axis { name, letter, .. } = axis;
    if leader.steps_per_unit != axis.steps_per_unit {
        let [first, second] = [leader, axis].map(|axis| axis.unit.steps);
        return Err(at(format!(
            "the motors '{}' and '{name}' of the letter {letter} have {first} and {second} steps per unit",
            leader.name
        ))
        .help("they make the same steps: give both the same steps_per_unit, by their microsteps"));
    }
    if leader.unit.name != axis.unit.name {
        let [first, second] = [leader, axis].map(|axis| &axis.unit.name);
        return Err(at(format!(
            "the motors '{}' and '{name}' of the letter {letter} are in {first} and {second}",
            leader.name
        ))
        .help("give both the same unit"));
    }
    Ok(())
}

impl Axis {
    /// Takes the other motor's limits where they are less, and its driver's times where they are
    /// longer.
    fn take_least(&mut self, other: &Self) {
        let least = |own: &mut AxisLimit, other: &AxisLimit| {
            if *other < *own {
                own.clone_from(other);
            }
        };
        least(&mut self.start_speed, &other.start_speed);
        least(&mut self.speed_limit, &other.speed_limit);
        least(&mut self.accel_limit, &other.accel_limit);
        match (&mut self.jerk_limit, &other.jerk_limit) {
            (Some(own), Some(other)) => least(own, other),
            (own @ None, other) => own.clone_from(other),
            (Some(_), None) => {}
        }
        self.stop = self.stop.min(other.stop);
        let (ns, others) = (self.pins_ns, other.pins_ns);
        self.pins_ns = PinTimes {
            step_high: ns.step_high.max(others.step_high),
            step_low: ns.step_low.max(others.step_low),
            dir_setup: ns.dir_setup.max(others.dir_setup),
            dir_hold: ns.dir_hold.max(others.dir_hold),
        };
        let (clocks, others) = (self.pins, other.pins);
        self.pins = PinTiming {
            step_high: clocks.step_high.max(others.step_high),
            step_low: clocks.step_low.max(others.step_low),
            dir_setup: clocks.dir_setup.max(others.dir_setup),
            dir_hold: clocks.dir_hold.max(others.dir_hold),
        };
    }
}

/// Gives the motors of a letter the travel of one of them.
pub(super) fn share_travel(
    source: &SourceText,
    axes: &mut [Axis],
    spans: &[Option<Range<usize>>],
) -> Result<(), InputError> {
    for motor in 0..axes.len() {
        let Some(travel) = axes[motor].travel else { continue };
        for other in 0..axes.len() {
            if axes[other].letter != axes[motor].letter {
                continue;
            }
            if let Some(known) = axes[other].travel.replace(travel)
                && known != travel
            {
                let place = spans[motor.max(other)].clone().unwrap_or_default();
                let message = format!(
                    "the motors of the letter {} have different travels",
                    axes[motor].letter
                );
                return Err(InputError::at(source, place, message)
                    .help("give it once, or the same for all of them"));
            }
        }
    }
    Ok(())
}

/// The place of a `home` table, and of its `most_apart`.
type HomeSpans = Option<(Range<usize>, Option<Range<usize>>)>;

/// Checks that the motors of a letter home in the same way, and end at one place.
pub(super) fn home(
    source: &SourceText,
    axes: &mut [Axis],
    spans: &[HomeSpans],
    limits: LimitWiring,
) -> Result<(), InputError> {
    for motor in 0..axes.len() {
        let letter = axes[motor].letter.clone();
        let alone = axes.iter().filter(|axis| axis.letter == letter).count() == 1;
        if let (true, Some((_, Some(most_apart)))) = (alone, &spans[motor]) {
            let message = format!("most_apart: the letter {letter} has one motor");
            return Err(InputError::at(source, most_apart.clone(), message)
                .help("it is for motors that move a letter together"));
        }
        let first = axes.iter().position(|axis| axis.letter == letter).unwrap_or(motor);
        if first == motor {
            continue;
        }
        let names = format!("the motors '{}' and '{}'", axes[first].name, axes[motor].name);
        let (before, after) = axes.split_at_mut(motor);
        let (leader, axis) = (&mut before[first].home, &mut after[0].home);
        let at = |number: usize, message: String| {
            let span = spans[number].as_ref().map_or(0..0, |(span, _)| span.clone());
            InputError::at(source, span, message)
        };
        let (Some(leader), Some(own)) = (leader.as_mut(), axis.as_mut()) else {
            if leader.is_none() && axis.is_none() {
                continue;
            }
            let number = if leader.is_some() { first } else { motor };
            let message = format!("of {names} of the letter {letter}, one has a home table");
            return Err(at(number, message).help(
                "give each motor a home table and a switch of its own, so that homing squares them",
            ));
        };
        if limits == LimitWiring::One {
            let message =
                format!("{names} of the letter {letter} share one wire for their switches");
            return Err(at(motor, message).help(
                "each motor stops at its own switch: wire them so that limits is \"pair\" or \"each\"",
            ));
        }
        if (leader.toward, leader.seek, leader.slow, leader.move_off)
            != (own.toward, own.seek, own.slow, own.move_off)
        {
            let message = format!("{names} of the letter {letter} home in different ways");
            return Err(at(motor, message)
                .help("give both the same toward, seek_speed, slow_speed and move_off"));
        }
        // Each number of the file is rounded to steps.
        let rests = own.rests() - leader.rests();
        match u32::try_from(
            i64::from(own.pull_off) - if own.rests() > own.position { rests } else { -rests },
        ) {
            Ok(pull_off) if rests.abs() <= 1 && pull_off > 0 => own.pull_off = pull_off,
            _ => {
                let unit = &axes[motor].unit;
                let off = unit.both(rests as f64, 0);
                let message = format!("{names} of the letter {letter} would rest {off} apart");
                return Err(at(motor, message).help(
                    "position says where its switch closes, and pull_off how far from it the motor \
                     rests: both motors have to rest at the same place",
                ));
            }
        }
        own.most_apart = own.most_apart.min(leader.most_apart);
        leader.most_apart = own.most_apart;
    }
    Ok(())
}
