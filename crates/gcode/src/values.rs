//! The parameters that a program can read: those of its memory, and those that the machine sets,
//! such as `#5420` and `#<_x>`.

use crate::canon::{AXES, AXIS_LETTERS, Plane, Point, Turn};
use crate::evaluate::Values;
use crate::state::{Motion, State, numbers};

impl Values for State {
    fn numbered(&self, number: usize) -> f64 {
        let axis_of = |first: usize| number.checked_sub(first).filter(|&axis| axis < AXES);
        let in_units = |point: &Point, axis| point[axis] / self.axis_unit(axis);
        if let Some(axis) = axis_of(numbers::PLACE) {
            return in_units(&self.program, axis);
        }
        if let Some(axis) = axis_of(numbers::TOOL_OFFSET) {
            return self.tool().offset[axis];
        }
        match number {
            numbers::TOOL => self.modal.tool.into(),
            numbers::TOOL_DIAMETER => self.tool().diameter,
            numbers::SYSTEM => self.modal.system as f64,
            _ => self.memory.get(number),
        }
    }

    fn named(&self, name: &str) -> Option<f64> {
        machine_name(self, name).or_else(|| self.memory.get_name(name))
    }
}

/// Whether only the machine sets `#number`.
pub(crate) fn is_read_only(number: usize) -> bool {
    number == numbers::SYSTEM || (numbers::TOOL..numbers::PLACE + 9).contains(&number)
}

/// The value of a name that the machine sets, if it is one. Flags are 1 or 0, codes are ten times
/// the code.
pub(crate) fn machine_name(state: &State, name: &str) -> Option<f64> {
    let name = name.strip_prefix('_')?;
    let modal = &state.modal;
    let flag = |is: bool| f64::from(u8::from(is));
    if let Some(axis) = axis(name) {
        return Some(state.program[axis] / state.axis_unit(axis));
    }
    if let Some(axis) = name.strip_prefix("abs_").and_then(axis) {
        return Some(state.machine[axis] / state.axis_unit(axis));
    }
    Some(match name {
        "line" => state.line as f64,
        "motion_mode" => match modal.motion {
            Motion::None => 800.0,
            Motion::Traverse => 0.0,
            Motion::Feed => 10.0,
            Motion::Arc { clockwise } => 30.0 - 10.0 * flag(clockwise),
            Motion::Probe(tenths) => tenths.into(),
            Motion::Cycle(code) => f64::from(code) * 10.0,
        },
        "plane" => match modal.plane {
            Plane::Xy => 170.0,
            Plane::Zx => 180.0,
            Plane::Yz => 190.0,
        },
        "ccomp" => 400.0,
        "metric" => flag(!modal.inches),
        "imperial" => flag(modal.inches),
        "absolute" => flag(!modal.incremental),
        "incremental" => flag(modal.incremental),
        "inverse_time" => flag(modal.inverse_time),
        "units_per_minute" => flag(!modal.inverse_time),
        "units_per_rev" | "spindle_css_mode" | "lathe_diameter_mode" => 0.0,
        "spindle_rpm_mode" | "lathe_radius_mode" => 1.0,
        "coord_system" => match modal.system {
            system @ 1..=6 => 530.0 + 10.0 * system as f64,
            system => 584.0 + system as f64,
        },
        "tool_offset" => flag(state.frame.tool.iter().any(|&offset| offset != 0.0)),
        "retract_r_plane" => flag(!modal.retract_to_initial),
        "retract_old_z" => flag(modal.retract_to_initial),
        "ijk_absolute_mode" => flag(modal.centre_absolute),
        "spindle_on" => flag(modal.spindle != Turn::Off),
        "spindle_cw" => flag(modal.spindle == Turn::Clockwise),
        "mist" => flag(modal.mist),
        "flood" => flag(modal.flood),
        "speed_override" | "feed_override" => flag(modal.overrides),
        "adaptive_feed" | "feed_hold" => 0.0,
        "feed" => modal.feed.map_or(0.0, |(_, number)| number),
        "rpm" => modal.rpm,
        "current_tool" => modal.tool.into(),
        "selected_tool" => modal.selected_tool.into(),
        "call_level" => state.call_level as f64,
        _ => return None,
    })
}

fn axis(name: &str) -> Option<usize> {
    let mut letters = name.chars();
    let letter = letters.next().filter(|_| letters.next().is_none())?;
    AXIS_LETTERS.iter().position(|&axis| axis == letter)
}
