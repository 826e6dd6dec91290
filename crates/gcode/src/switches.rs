//! Executes the words that switch something: spindle, coolant, tool, overrides.

use crate::canon::{Canon, Turn};
use crate::codes::Group;
use crate::error::{ErrorKind, Fault};
use crate::outcome::Outcome;
use crate::request::Request;
use crate::state::State;
use crate::tools::{LAST_TOOL, TOOL_RANGE};
use std::collections::VecDeque;

/// Greatest value of S.
const FASTEST: f64 = 1e9;

/// S.
pub(crate) fn spindle_speed(
    state: &mut State,
    request: &mut Request,
    out: &mut Outcome,
) -> Result<(), Fault> {
    let Some(rpm) = request.take(b's') else { return Ok(()) };
    if !(0.0..=FASTEST).contains(&rpm) {
        return Err(request.out_of_range(b's', rpm, "0 to 10^9"));
    }
    let changes = rpm != state.modal.rpm;
    state.modal.rpm = rpm;
    if changes && state.modal.spindle != Turn::Off && request.code(Group::Spindle).is_none() {
        out.before.push_back(Canon::Spindle { turn: state.modal.spindle, rpm });
    }
    Ok(())
}

/// T.
pub(crate) fn tool(
    state: &mut State,
    request: &mut Request,
    out: &mut Outcome,
) -> Result<(), Fault> {
    if let Some(tool) = request.take_whole(b't', LAST_TOOL, TOOL_RANGE)? {
        if let Some(table) = state.tools.as_ref().filter(|_| tool != 0)
            && table.get(tool).is_none()
        {
            return Err(request.fault(b't', ErrorKind::UnknownTool(tool)));
        }
        state.modal.selected_tool = tool;
        out.before.push_back(Canon::SelectTool { tool });
    }
    Ok(())
}

/// M6.
pub(crate) fn change_tool(state: &mut State, request: &Request, out: &mut Outcome) {
    if request.code(Group::Tool).is_some() {
        spindle_off(state, &mut out.before);
        state.modal.tool = state.modal.selected_tool;
        out.before.push_back(Canon::ChangeTool { tool: state.modal.tool });
    }
}

fn spindle_off(state: &mut State, to: &mut VecDeque<Canon>) {
    if state.modal.spindle != Turn::Off {
        state.modal.spindle = Turn::Off;
        to.push_back(Canon::Spindle { turn: Turn::Off, rpm: state.modal.rpm });
    }
}

/// M3, M4 and M5.
pub(crate) fn spindle(state: &mut State, request: &Request, out: &mut Outcome) {
    if let Some(code) = request.code(Group::Spindle) {
        let turn = match code.tenths {
            30 => Turn::Clockwise,
            40 => Turn::Counterclockwise,
            _ => Turn::Off,
        };
        state.modal.spindle = turn;
        out.before.push_back(Canon::Spindle { turn, rpm: state.modal.rpm });
    }
}

/// M7, M8 and M9.
pub(crate) fn coolant(state: &mut State, request: &Request, out: &mut Outcome) {
    let Some(code) = request.code(Group::Coolant) else { return };
    let modal = &mut state.modal;
    match code.tenths {
        70 => modal.mist = true,
        80 => modal.flood = true,
        _ => (modal.mist, modal.flood) = (false, false),
    }
    out.before.push_back(Canon::Coolant { mist: modal.mist, flood: modal.flood });
}

/// M48 and M49.
pub(crate) fn overrides(state: &mut State, request: &Request, out: &mut Outcome) {
    if let Some(code) = request.code(Group::Overrides) {
        state.modal.overrides = code.tenths == 480;
        out.before.push_back(Canon::Overrides { enabled: state.modal.overrides });
    }
}

/// The end of the program: spindle and coolant are switched off.
pub(crate) fn end(state: &mut State, to: &mut VecDeque<Canon>) {
    spindle_off(state, to);
    if state.modal.mist || state.modal.flood {
        (state.modal.mist, state.modal.flood) = (false, false);
        to.push_back(Canon::Coolant { mist: false, flood: false });
    }
    to.push_back(Canon::End);
}
