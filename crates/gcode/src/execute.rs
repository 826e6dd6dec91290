//! Executes a line, in the order of LinuxCNC whatever the order of its words: feed mode, feed,
//! spindle speed, tool, outputs, tool change, spindle, coolant, overrides, dwell, plane, units,
//! distance modes, retract mode, tool length, coordinate system, path mode, stored places and
//! offsets, motion, stop or call.

use crate::canon::{Canon, PathMode, Plane};
use crate::codes::{Code, Group};
use crate::error::{ErrorKind, Fault};
use crate::frame::FURTHEST;
use crate::inputs_outputs;
use crate::motion::{MOST, MOST_SECONDS, Moved, Mover};
use crate::outcome::{Jump, Outcome};
use crate::request::Request;
use crate::state::{Motion, State, numbers};
use crate::switches;
use std::ops::RangeInclusive;

/// Executes a line.
///
/// # Errors
/// The first word or code that cannot be done.
pub(crate) fn execute(
    state: &mut State,
    request: &mut Request,
    out: &mut Outcome,
) -> Result<(), Fault> {
    let inverse_feed = feed(state, request)?;
    switches::spindle_speed(state, request, out)?;
    switches::tool(state, request, out)?;
    inputs_outputs::execute(state, request, out)?;
    switches::change_tool(state, request, out);
    switches::spindle(state, request, out);
    switches::coolant(state, request, out);
    switches::overrides(state, request, out);
    dwell(request, out)?;
    modes(state, request);
    let standing = standing_code(state, request);
    let code = request.code(Group::Motion).unwrap_or(standing);
    let mut mover = Mover { state, request, code, inverse_feed };
    path(&mut mover, out)?;
    offsets_and_motion(&mut mover, out)?;
    stop(state, request, out)?;
    request.finish()
}

/// Values of F besides 0. Smaller or greater ones are mistakes, and their times could overflow.
const FEEDS: RangeInclusive<f64> = 1e-6..=1e9;

/// G93, G94 and F. The result is F if it is in inverse time.
fn feed(state: &mut State, request: &mut Request) -> Result<Option<f64>, Fault> {
    if let Some(code) = request.code(Group::FeedMode) {
        let inverse = code.tenths == 930;
        if inverse != state.modal.inverse_time {
            state.modal.inverse_time = inverse;
            state.modal.feed = None;
        }
    }
    let Some(feed) = request.take(b'f') else { return Ok(None) };
    if feed != 0.0 && !FEEDS.contains(&feed) {
        return Err(request.out_of_range(b'f', feed, "0, or 10^-6 to 10^9"));
    }
    if state.modal.inverse_time {
        return Ok(Some(feed));
    }
    let changes = |code: Code| (code.tenths == 200) != state.modal.inches;
    if request.code(Group::Units).is_some_and(changes) {
        return Err(request.fault(b'f', ErrorKind::FeedWithUnits));
    }
    state.modal.feed = Some((feed * state.unit(), feed));
    Ok(None)
}

/// G4.
fn dwell(request: &mut Request, out: &mut Outcome) -> Result<(), Fault> {
    if let Some(code) = request.code(Group::Once).filter(|code| code.tenths == 40) {
        let seconds = request.need(b'p', code, "P, the time in s")?;
        if !(0.0..=MOST_SECONDS).contains(&seconds) {
            return Err(request.out_of_range(b'p', seconds, "0 to 10^9 s"));
        }
        out.before.push_back(Canon::Dwell { seconds });
    }
    Ok(())
}

/// Codes that only change a mode.
fn modes(state: &mut State, request: &Request) {
    let tenths = |group| request.code(group).map(|code| code.tenths);
    let modal = &mut state.modal;
    match tenths(Group::Plane) {
        Some(170) => modal.plane = Plane::Xy,
        Some(180) => modal.plane = Plane::Zx,
        Some(_) => modal.plane = Plane::Yz,
        None => {}
    }
    let switches: [(Group, u16, &mut bool); 4] = [
        (Group::Units, 200, &mut modal.inches),
        (Group::Distance, 910, &mut modal.incremental),
        (Group::CentreDistance, 901, &mut modal.centre_absolute),
        (Group::Retract, 980, &mut modal.retract_to_initial),
    ];
    for (group, on, mode) in switches {
        if let Some(code) = tenths(group) {
            *mode = code == on;
        }
    }
}

/// G43, G43.1, G43.2, G49, G54 to G59.3, G61, G61.1 and G64.
fn path(mover: &mut Mover<'_>, out: &mut Outcome) -> Result<(), Fault> {
    if let Some(code) = mover.request.code(Group::ToolLength) {
        if let Some(other) = uses_axis_words(mover).filter(|_| matches!(code.tenths, 431 | 432)) {
            return Err(axes_twice(code, other));
        }
        mover.tool_length(code)?;
    }
    if let Some(code) = mover.request.code(Group::System) {
        mover.select_system(code);
    }
    if let Some(code) = mover.request.code(Group::Path) {
        let unit = mover.state.unit();
        let mode = match code.tenths {
            610 => PathMode::Exact,
            611 => PathMode::ExactStop,
            _ => {
                let mut length = |letter| match mover.request.take(letter) {
                    Some(value) if !(0.0..=FURTHEST).contains(&value) => {
                        Err(mover.request.out_of_range(letter, value, "0 to 10^9"))
                    }
                    value => Ok(value.map(|value| value * unit)),
                };
                PathMode::Blend { tolerance_mm: length(b'p')?, joining_mm: length(b'q')? }
            }
        };
        mover.state.modal.path = mode;
        out.before.push_back(Canon::Path(mode));
    }
    Ok(())
}

/// The code of the line, besides a motion that stands from lines before, that uses axis words.
fn uses_axis_words(mover: &Mover<'_>) -> Option<Code> {
    let motion = mover.request.code(Group::Motion).filter(|code| code.tenths != 800);
    motion.or_else(|| once_with_axes(mover.request))
}

/// G10, G28, G30 or G92: codes that use axis words once.
fn once_with_axes(request: &Request) -> Option<Code> {
    request.code(Group::Once).filter(|code| matches!(code.tenths, 100 | 280 | 300 | 920))
}

fn axes_twice(first: Code, second: Code) -> Fault {
    let (first, second_text) = (first.to_string(), second.to_string());
    Fault::new(second.column, ErrorKind::AxesTwice { first, second: second_text })
}

fn offsets_and_motion(mover: &mut Mover<'_>, out: &mut Outcome) -> Result<(), Fault> {
    let motion_code = mover.request.code(Group::Motion);
    if let Some(code) = mover.request.code(Group::Once) {
        let with_axes = once_with_axes(mover.request).is_some() && mover.has_axis_words();
        if let Some(motion) = motion_code.filter(|motion| with_axes && motion.tenths != 800) {
            return Err(axes_twice(code, motion));
        }
        match code.tenths {
            100 => mover.set_data(code)?,
            280 => out.before.extend(mover.go_home(numbers::HOME_28)?),
            300 => out.before.extend(mover.go_home(numbers::HOME_30)?),
            281 => mover.store_home(numbers::HOME_28),
            301 => mover.store_home(numbers::HOME_30),
            920 => mover.set_g92(code)?,
            921 => mover.clear_g92(),
            922 | 923 => mover.switch_g92(code.tenths == 923),
            _ => {}
        }
    }
    let motion = motion_code.map_or(mover.state.modal.motion, motion_of);
    let has_target = mover.has_axis_words() || mover.has_polar_words();
    let moves = match motion {
        Motion::None | Motion::Traverse | Motion::Feed => has_target,
        Motion::Arc { .. } | Motion::Probe(_) | Motion::Cycle(_) => {
            motion_code.is_some() || has_target
        }
    };
    if moves {
        let moved = match motion {
            Motion::Cycle(code) => mover.drill(code)?,
            _ => mover.run(motion)?,
        };
        match moved {
            Moved::Nothing => {}
            Moved::One(canon) => out.before.push_back(canon),
            Moved::Cycle(cycle) => out.cycle = Some(cycle),
        }
    }
    if motion_code.is_some() {
        mover.state.modal.motion = motion;
    }
    if !matches!(motion, Motion::Cycle(_)) {
        mover.state.modal.cycle.initial_level = None;
    }
    Ok(())
}

fn motion_of(code: Code) -> Motion {
    match code.tenths {
        0 => Motion::Traverse,
        10 => Motion::Feed,
        20 | 30 => Motion::Arc { clockwise: code.tenths == 20 },
        tenths @ 382..=385 => Motion::Probe(tenths),
        810 | 820 | 830 => Motion::Cycle(code.tenths / 10),
        _ => Motion::None,
    }
}

/// The code of a motion that stands from lines before.
fn standing_code(state: &State, request: &Request) -> Code {
    let tenths = match state.modal.motion {
        Motion::None => 800,
        Motion::Traverse => 0,
        Motion::Feed => 10,
        Motion::Arc { clockwise: true } => 20,
        Motion::Arc { clockwise: false } => 30,
        Motion::Probe(tenths) => tenths,
        Motion::Cycle(code) => code * 10,
    };
    Code { letter: b'g', tenths, column: request.column }
}

/// M0, M1, M2, M30, M60, M98 and M99.
fn stop(state: &mut State, request: &mut Request, out: &mut Outcome) -> Result<(), Fault> {
    let Some(code) = request.code(Group::Stop) else { return Ok(()) };
    match code.tenths {
        0 | 600 => out.after.push_back(Canon::Pause { optional: false }),
        10 => out.after.push_back(Canon::Pause { optional: true }),
        980 => {
            let number = request.take_whole(b'p', MOST, "0 to 10^9")?;
            let word = "P, the number of the subroutine";
            let missing = ErrorKind::Missing { code: code.to_string(), word };
            let number = number.ok_or(Fault::new(code.column, missing))?;
            let times = request.take_whole(b'l', MOST, "0 to 10^9")?.unwrap_or(1);
            out.jump = Some(Jump::Call { number, times, column: code.column });
        }
        990 => out.jump = Some(Jump::Return { column: code.column }),
        _ => {
            switches::end(state, &mut out.after);
            out.ends = true;
        }
    }
    Ok(())
}
