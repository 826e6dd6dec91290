//! The move file: the machine, and a list of moves.
//!
//! Distances are added up as exact decimals. A move is the difference of two absolute targets, each
//! rounded to steps, so that rounding errors do not accumulate.

use crate::decimal;
use crate::did_you_mean;
use crate::error::{InputError, SourceText, quoted};
use crate::machine::{Machine, RawMachine};
use crate::number::{exact, positive};
use bigdecimal::{BigDecimal, Zero};
use carrystep_core::ProfileKind;
use carrystep_core::build::AXES;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use toml::Spanned;

/// How the axes of a move are combined.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, JsonSchema, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum PathKind {
    /// Each axis moves within its own limits; all take the same time.
    #[default]
    Free,
    /// All axes move along one straight line: one profile, scaled for each axis.
    Straight,
}

/// A checked move file.
#[derive(Debug, Clone)]
pub struct MoveFile {
    /// The machine, from the move file itself or from its own file.
    pub machine: Machine,
    /// The moves, in order.
    pub moves: Vec<Move>,
    /// Text of the move file, for errors that are found later.
    pub source: SourceText,
    /// The machine file, if the move file names one.
    pub machine_source: Option<SourceText>,
}

/// One move of all axes.
#[derive(Debug, Clone)]
pub struct Move {
    /// Speed profile of the move.
    pub profile: ProfileKind,
    /// How the axes move together.
    pub path: PathKind,
    /// Duration in s; `None` means as fast as the limits allow.
    pub time: Option<BigDecimal>,
    /// Greatest deviation in ns of an edge from a profile that has to be fitted, at least 1; one
    /// tick if the file gives none.
    pub fit_ns: u64,
    /// Steps of each axis, positive or negative.
    pub steps: Vec<i64>,
    /// Accumulated rounding of each axis in steps: exact target minus rounded target.
    pub rounding: Vec<f64>,
    /// Place of the move in its file.
    pub place: MovePlace,
}

/// Place of a move in its file, for errors that are found later.
#[derive(Debug, Clone)]
pub struct MovePlace {
    /// The text of the file, or the part of a long file that has the move.
    pub text: Arc<str>,
    /// Number of lines of the file before this text.
    pub lines_before: usize,
    /// The bytes of the text that are the move.
    pub span: Range<usize>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a move file")]
pub(crate) struct RawMoveFile {
    machine_file: Option<Spanned<PathBuf>>,
    machine: Option<RawMachine>,
    #[serde(default, rename = "move")]
    pub(crate) moves: Vec<Spanned<RawMove>>,
}

/// A text of moves alone.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "moves")]
pub(crate) struct RawMoves {
    #[serde(default, rename = "move")]
    pub(crate) moves: Vec<Spanned<RawMove>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a [[move]] table")]
pub(crate) struct RawMove {
    profile: Spanned<ProfileKind>,
    #[serde(default)]
    path: PathKind,
    time: Option<Spanned<f64>>,
    fit_ns: Option<Spanned<u64>>,
    to: BTreeMap<Spanned<String>, Spanned<f64>>,
}

impl MoveFile {
    /// Reads a move file, and the machine file that it names by a path relative to itself.
    ///
    /// # Errors
    /// [`InputError`] with file, line and column of the first mistake.
    pub fn load(path: &Path) -> Result<Self, InputError> {
        Self::from_source(SourceText::read(path)?)
    }

    /// Checks the text of a move file. A relative `machine_file` is resolved from the directory of
    /// `source.path`.
    ///
    /// # Errors
    /// [`InputError`] with file, line and column of the first mistake.
    pub fn from_source(source: SourceText) -> Result<Self, InputError> {
        let mut raw: RawMoveFile = source.parse()?;
        let moves = std::mem::take(&mut raw.moves);
        let (machine, machine_source) = raw.machine(&source)?;
        Ok(Self { machine_source, ..Self::on(machine, source, moves)? })
    }

    /// Checks moves for a machine that is already known; the move file has no machine of its own.
    ///
    /// # Errors
    /// [`InputError`] with line and column of the first mistake.
    pub fn of_moves(machine: Machine, source: SourceText) -> Result<Self, InputError> {
        let raw: RawMoves = source.parse()?;
        if let Some(error) = too_many_axes(&machine, &source, 0..0) {
            return Err(error);
        }
        Self::on(machine, source, raw.moves)
    }

    fn on(
        machine: Machine,
        source: SourceText,
        raw: Vec<Spanned<RawMove>>,
    ) -> Result<Self, InputError> {
        if raw.is_empty() {
            return Err(no_moves(&source));
        }
        let mut targets = Targets::new(&machine);
        let moves = raw
            .into_iter()
            .map(|entry| targets.next(&source, &machine, entry))
            .collect::<Result<_, _>>()?;
        Ok(Self { machine, moves, source, machine_source: None })
    }

    /// Makes an error about a move, with the place of the move in the file.
    pub fn move_error(&self, index: usize, message: impl Into<String>) -> InputError {
        match self.moves.get(index) {
            Some(found) => found.place.error(&self.source.path, message),
            None => InputError::new(message),
        }
    }
}

impl MovePlace {
    /// Makes an error about the move, which is in the file of this path.
    pub fn error(&self, path: &Path, message: impl Into<String>) -> InputError {
        let source = SourceText { path: path.to_owned(), text: self.text.clone() };
        let error = InputError::at(&source, self.span.clone(), message);
        InputError { lines_before: self.lines_before, ..error }
    }
}

/// The error for a file without moves.
fn no_moves(source: &SourceText) -> InputError {
    InputError::at(source, 0..0, "no moves").help("add a [[move]] table")
}

/// The error for a machine with more axes than moves are planned for, at this place of the file.
fn too_many_axes(
    machine: &Machine,
    source: &SourceText,
    place: Range<usize>,
) -> Option<InputError> {
    let axes = machine.axes.len();
    let message = format!("{axes} axes: moves are planned for at most {AXES}");
    (axes > AXES).then(|| InputError::at(source, place, message))
}

impl RawMoveFile {
    /// The machine, and the text of its file if it has one.
    pub(crate) fn machine(
        self,
        source: &SourceText,
    ) -> Result<(Machine, Option<SourceText>), InputError> {
        let machine_file = self.machine_file.as_ref().map(Spanned::span);
        let too_many = self.machine.as_ref().and_then(RawMachine::seventh).or(machine_file);
        let mut machine_source = None;
        let machine = match (self.machine_file, self.machine) {
            (Some(file), None) => {
                let path = source.path.parent().unwrap_or(Path::new("")).join(file.as_ref());
                if !path.exists() {
                    let message = format!("there is no machine file {}", path.display());
                    return Err(InputError::at(source, file.span(), message)
                        .help("the path is relative to the move file"));
                }
                // If the machine file cannot be read, the error points at its name in the move
                // file.
                let named = |error: InputError| InputError::at(source, file.span(), error.message);
                let text = machine_source.insert(SourceText::read(&path).map_err(named)?);
                Machine::from_source(text)?
            }
            (None, Some(machine)) => machine.check(source)?,
            (Some(file), Some(_)) => {
                let message = "both machine_file and [machine] are given";
                return Err(InputError::at(source, file.span(), message).help("keep one of them"));
            }
            (None, None) => {
                return Err(InputError::at(source, 0..0, "no machine")
                    .help("name a machine_file, or describe the [machine] here"));
            }
        };
        match too_many_axes(&machine, source, too_many.unwrap_or(0..0)) {
            Some(error) => Err(error),
            None => Ok((machine, machine_source)),
        }
    }
}

/// Where the axes stand after the moves that have been checked.
#[derive(Debug)]
pub(crate) struct Targets {
    /// The letters, exactly, in units of the axis: those of the first motor of each letter.
    letters: Vec<BigDecimal>,
    /// The motors, exactly, in units.
    exact: Vec<BigDecimal>,
    /// The motors, rounded to steps.
    steps: Vec<i64>,
}

impl Targets {
    pub(crate) fn new(machine: &Machine) -> Self {
        let axes = machine.axes.len();
        let zero = vec![BigDecimal::zero(); axes];
        Self { letters: zero.clone(), exact: zero, steps: vec![0; axes] }
    }

    /// Checks the next move.
    pub(crate) fn next(
        &mut self,
        source: &SourceText,
        machine: &Machine,
        entry: Spanned<RawMove>,
    ) -> Result<Move, InputError> {
        let span = entry.span();
        let RawMove { profile, path, time, fit_ns, to } = entry.into_inner();
        let time = time.map(|value| check_time(source, &value)).transpose()?;
        let fit_ns =
            fit_ns.map_or(Ok(machine.timebase.tick_ns()), |value| check_fit(source, &value))?;
        let before = self.steps.clone();
        for (name, distance) in &to {
            let axis = machine
                .letter_index(name.as_ref())
                .ok_or_else(|| no_letter(source, machine, name))?;
            if *profile.as_ref() == ProfileKind::Scurve && machine.axes[axis].jerk_limit.is_none() {
                let message =
                    format!("profile = \"scurve\": axis {:?} has no jerk_limit", name.as_ref());
                return Err(InputError::at(source, profile.span(), message)
                    .help("give the axis a jerk_limit in units/s^3, or take another profile"));
            }
            self.letters[axis] += exact(source, distance, name.as_ref())?;
        }
        let leaders = machine.leaders();
        for (name, distance) in &to {
            let Some(letter) = machine.letter_index(name.as_ref()) else { continue };
            // All motors of a letter, and both motors of crossed belts.
            let moves = |motor: &usize| machine.coefficient(*motor, letter) != 0;
            for motor in (0..self.steps.len()).filter(moves) {
                let part = |&leader: &usize| {
                    &self.letters[leader] * BigDecimal::from(machine.coefficient(motor, leader))
                };
                let turns: BigDecimal = leaders.iter().map(part).sum();
                let axis = &machine.axes[motor];
                let target = &turns * &axis.steps_per_unit;
                self.exact[motor] = turns;
                self.steps[motor] = register(&target).ok_or_else(|| {
                    let at = axis.unit.both(decimal::to_f64(&target), 0);
                    let message =
                        format!("axis '{}' would stand at {at}, beyond its register", axis.name);
                    let most = axis.unit.at_most(i32::MAX.into(), 0);
                    InputError::at(source, distance.span(), message).help(format!(
                        "the sum of all moves must stay within +-{most} of the start"
                    ))
                })?;
            }
        }
        let rounding = self.exact.iter().zip(&machine.axes).zip(&self.steps);
        let rounding = rounding.map(|((target, axis), &steps)| {
            let left = decimal::to_f64(&(target * &axis.steps_per_unit - BigDecimal::from(steps)));
            // A remainder below 2^-64 step comes from the 60th decimal of `steps_per_unit` and is
            // not a rounding of the target.
            if left.abs() < 2_f64.powi(-64) { 0.0 } else { left }
        });
        Ok(Move {
            profile: profile.into_inner(),
            path,
            time,
            fit_ns,
            steps: self.steps.iter().zip(&before).map(|(now, old)| now - old).collect(),
            rounding: rounding.collect(),
            place: MovePlace { text: source.text.clone(), lines_before: 0, span },
        })
    }
}

/// The error for a distance of something that is no letter of the machine.
fn no_letter(source: &SourceText, machine: &Machine, name: &Spanned<String>) -> InputError {
    if machine.axis_index(name.as_ref()).is_some() {
        return InputError::at(source, name.span(), machine.no_letter(name.as_ref()));
    }
    let meant = did_you_mean(name.as_ref(), machine.axes.iter().map(|axis| &*axis.letter));
    let message = format!("the machine has no axis {:?}{meant}", quoted(name.as_ref()));
    InputError::at(source, name.span(), message)
        .help(format!("its axes are {}", machine.letter_names()))
}

/// Checks a duration: greater than zero, and short enough to be counted in clocks.
fn check_time(source: &SourceText, value: &Spanned<f64>) -> Result<BigDecimal, InputError> {
    let time = positive(source, value, "time")?;
    if time <= 1_000_000 {
        return Ok(time);
    }
    let message = format!("time = {} s: a move takes at most 10^6 s", decimal::to_f64(&time));
    Err(InputError::at(source, value.span(), message).help("split it into shorter moves"))
}

fn check_fit(source: &SourceText, value: &Spanned<u64>) -> Result<u64, InputError> {
    let ns = *value.as_ref();
    if ns > 0 {
        return Ok(ns);
    }
    Err(InputError::at(source, value.span(), "fit_ns = 0: no fit is without an error")
        .help("give the greatest error of an edge in ns, from 1 up"))
}

/// The nearest whole step, if the position register can hold it and its negative.
fn register(target: &BigDecimal) -> Option<i64> {
    decimal::round_half_away(target)
        .filter(|steps| steps.unsigned_abs() <= u64::from(i32::MAX.unsigned_abs()))
}
