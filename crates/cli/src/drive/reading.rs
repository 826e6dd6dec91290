//! What a program reads while it runs: the probe that ends a move, and inputs. Behind each, the rest
//! of the program is planned from what was found.
//!
//! ```text
//! G38     closed already? -> seek with all axes -> stream the move -> hit? ramp, latched place
//!                                                  \-> no hit: at the target
//! M66     look at the input until it is as wanted, or the time is over
//! ```

use super::Line;
use super::settle::{exact_position, settle};
use super::touch::{all_axes, is_closed};
use crate::connection::{ConnectedBoard, ConnectedBoardError};
use crate::control::{Control, ProgramControl};
use crate::failure::Failure;
use carrystep_files::Machine;
use carrystep_link::registers::INPUTS;
use carrystep_link::{AxisState, HostError, SeekSource, Wish};
use carrystep_program::{
    AXIS_LETTERS, Found, Input, Point, ProgramFile, Reading, Stop, Survey, Switch, Until,
};
use std::io::{self, Write as _};
use std::time::{Duration, Instant};

/// Time between two looks at an input.
const LOOK: Duration = Duration::from_millis(1);

/// The bit of a general input in the register INPUTS: even ones are in row 2 behind the probe, odd
/// ones in row 3 behind the interlock.
const fn bit(input: u32) -> u32 {
    16 + 8 * (input % 2) + 1 + input / 2
}

/// Refuses a program that reads what the machine does not have.
pub(super) fn refuse_missing(file: &ProgramFile, survey: &Survey) -> Result<(), Failure> {
    let (path, machine) = (file.path().display(), file.machine());
    let probe = survey.counts.switches.iter().find(|one| one.switch == Switch::Probe);
    if let Some(one) = probe.filter(|_| !machine.has_probe()) {
        return Err(Failure::input(format!(
            "{path}: line {}: G38 needs a probe, and the machine has none: give its level with \
             probe = \"high\" or \"low\" in [machine.inputs]",
            one.line
        )));
    }
    for (input, line) in &survey.counts.inputs {
        match *input {
            Input::Analog(number) => {
                return Err(Failure::input(format!(
                    "{path}: line {line}: M66 E{number} reads an analog input, and a board has none"
                )));
            }
            Input::Digital(number) if !exists(machine, number) => {
                return Err(Failure::input(format!(
                    "{path}: line {line}: M66 P{number} reads general input {number}, and the \
                     machine does not have it: `general` in [machine.inputs] lists those that exist, \
                     from 0"
                )));
            }
            Input::Digital(_) => {}
        }
    }
    Ok(())
}

/// Whether the machine has this general input.
fn exists(machine: &Machine, input: u32) -> bool {
    let [even, odd] = machine.guard.inputs;
    input < 8 && (u32::from(even.exist) << 16 | u32::from(odd.exist) << 24) >> bit(input) & 1 == 1
}

/// A probe move that has begun.
#[derive(Debug, Clone, Copy)]
pub(super) struct Probing {
    contact: bool,
    required: bool,
    line: u64,
    target: Point,
}

/// What a probe move has come to: the place from which the program goes on, and what is found.
pub(super) type Probed = (Point, Found);

impl Probing {
    /// The probe move that begins at this stop; `None` if none does.
    pub fn of(stop: &Stop) -> Option<Self> {
        match stop.reading? {
            (Reading::Probe { contact, required }, line) => {
                Some(Self { contact, required, line, target: stop.at })
            }
            _ => None,
        }
    }

    /// Checks that the probe does not have the wanted state already.
    ///
    /// # Errors
    /// What to tell the user.
    pub fn check(
        &self,
        board: &mut ConnectedBoard,
    ) -> Result<Result<(), String>, ConnectedBoardError> {
        let closed = is_closed(board)?;
        if closed != self.contact {
            return Ok(Ok(()));
        }
        let line = self.line;
        Ok(Err(if closed {
            format!(
                "line {line}: the probe is closed before the move begins: move away from what it \
                 touches, or look at its wiring and at `probe` in [machine.inputs]"
            )
        } else {
            format!(
                "line {line}: the probe is open before the move begins, which waits for that: begin \
                 where it touches, or look at its wiring and at `probe` in [machine.inputs]"
            )
        }))
    }

    /// From now on the probe ends the motion of all axes.
    pub fn arm(&self, board: &mut ConnectedBoard) -> Result<(), ConnectedBoardError> {
        board.seek(all_axes(board), SeekSource::probe(self.contact))
    }

    /// What the move has come to, if it has not tripped.
    ///
    /// # Errors
    /// It had to trip; what to tell the user.
    pub fn untripped(&self) -> Result<Probed, String> {
        let Self { line, target, required, contact, .. } = *self;
        if !required {
            return Ok((target, Found::Probe { at: target, tripped: false }));
        }
        let (what, code, other) =
            if contact { ("closed", "G38.2", "G38.3") } else { ("opened", "G38.4", "G38.5") };
        Err(format!(
            "line {line}: the probe has not {what} up to the end of the move, where the machine rests: \
             {code} needs it, {other} does not"
        ))
    }

    /// What the move has come to, if the axes were in these states at the hit. P of the axes, which
    /// rest, goes to its start value. `zero` is the machine place of the registers' zero in steps.
    pub fn tripped(
        &self,
        board: &mut ConnectedBoard,
        line: &Line<'_>,
        (file, zero): (&ProgramFile, &[i64]),
        states: &[AxisState],
    ) -> Result<Probed, ConnectedBoardError> {
        settle(board, file.machine())?;
        let positions = board.read_status()?.positions;
        let letters = file.letters();
        let steps = |of: &dyn Fn(usize) -> f64| {
            let steps = zero.iter().enumerate().map(|(motor, &zero)| zero as f64 + of(motor));
            letters.place(&steps.collect::<Vec<_>>())
        };
        let rests = steps(&|motor| f64::from(positions[motor]));
        let at = steps(&|motor| exact_position(&states[motor]));
        let place = letters.all().iter();
        let place = place.map(|&letter| format!("{} {:.4}", AXIS_LETTERS[letter], at[letter]));
        let place = place.collect::<Vec<_>>().join(", ");
        let number = self.line;
        line.above(|| {
            // If this write fails, there is no channel left to report it.
            let _ =
                writeln!(io::stderr(), "line {number}: the probe has tripped at machine {place}");
        });
        Ok((rests, Found::Probe { at, tripped: true }))
    }
}

/// How the wait for an input ended.
pub(super) enum InputRead {
    /// Its value; `None` if it did not become what was wanted in time.
    Value(Option<f64>),
    /// The program is to end here, at rest.
    Ends,
}

/// Waits until an input is as M66 wants it, and reads it.
pub(super) fn read_input(
    board: &mut ConnectedBoard,
    control: &mut Control,
    place: &str,
    (input, until, seconds): (u32, Until, f64),
) -> Result<InputRead, ConnectedBoardError> {
    let begun = Instant::now();
    let patience = Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX);
    control.program().into_iter().for_each(|program| program.reads(place.to_owned()));
    let mut before = None;
    let read = loop {
        let active = board.register(INPUTS)? >> bit(input) & 1 == 1;
        let was = before.replace(active);
        let reached = match until {
            Until::Now => true,
            Until::High => active,
            Until::Low => !active,
            Until::Rise => active && was == Some(false),
            Until::Fall => !active && was == Some(true),
        };
        if reached {
            break InputRead::Value(Some(f64::from(u8::from(active))));
        }
        let status = board.read_status()?;
        let answer = status.answer;
        if answer.fault {
            return Err(HostError::Fault { cause: answer.cause, culprits: answer.culprits });
        }
        if control.wish(&status) == Wish::Stop {
            return Ok(InputRead::Ends);
        }
        if control.program().is_some_and(|program| program.ends()) {
            control.ends_program();
            return Ok(InputRead::Ends);
        }
        if begun.elapsed() >= patience {
            break InputRead::Value(None);
        }
        std::thread::sleep(LOOK);
    };
    control.program().into_iter().for_each(ProgramControl::moves);
    Ok(read)
}
