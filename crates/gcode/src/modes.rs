//! The modes between two blocks, for whoever goes on with a program in its middle.

use crate::canon::{AXES, PathMode, Plane, Point, Turn};
use crate::interpreter::Interpreter;
use crate::state::{State, numbers};
use std::io::{Read, Seek};

/// Values that differ by less than this, in mm or degrees, do not depend on where a program began.
const SAME: f64 = 1e-6;

/// The modes in effect, after the last block that was executed.
#[derive(Debug, Clone, PartialEq)]
pub struct Modes {
    /// G20: inches.
    pub inches: bool,
    /// G91: incremental distances.
    pub incremental: bool,
    /// The plane of arcs and cycles.
    pub plane: Plane,
    /// Number of the coordinate system: 1 is G54, 9 is G59.3.
    pub system: u8,
    /// What is added to program coordinates without rotation, G92 and the tool offset included, mm
    /// and degrees.
    pub offset: Point,
    /// Rotation of the coordinate system, degrees.
    pub rotation: f64,
    /// F in mm per minute; `None` before the first F, and in G93.
    pub feed: Option<f64>,
    /// G93: inverse time.
    pub inverse_time: bool,
    /// How exactly the path is kept.
    pub path: PathMode,
    /// Direction of the spindle.
    pub spindle: Turn,
    /// S, turns per minute.
    pub rpm: f64,
    /// M7.
    pub mist: bool,
    /// M8.
    pub flood: bool,
    /// The tool in the spindle, 0 for none.
    pub tool: u32,
}

impl Modes {
    pub(crate) fn of(state: &State) -> Self {
        let State { modal, frame, memory, .. } = state;
        let step = (modal.system - 1) * numbers::SYSTEM_STEP;
        Self {
            inches: modal.inches,
            incremental: modal.incremental,
            plane: modal.plane,
            system: modal.system as u8,
            offset: frame.to_machine(&[0.0; AXES]),
            rotation: memory.get(numbers::ROTATION + step),
            feed: modal.feed.map(|(millimetres, _)| millimetres).filter(|&feed| feed > 0.0),
            inverse_time: modal.inverse_time,
            path: modal.path,
            spindle: modal.spindle,
            rpm: modal.rpm,
            mist: modal.mist,
            flood: modal.flood,
            tool: modal.tool,
        }
    }
}

impl<R: Read + Seek> Interpreter<R> {
    /// The modes after the last block that was executed.
    pub fn modes(&self) -> Modes {
        Modes::of(&self.state)
    }

    /// The axes whose place or offsets are not those of `other`: the same program, as far as it
    /// has been executed, from another place. If another line is next, or a parameter of the program
    /// differs, all axes are.
    pub fn differs<S: Read + Seek>(&self, other: &Interpreter<S>) -> [bool; AXES] {
        let (here, there) = (&self.state, &other.state);
        let differ = |a: f64, b: f64| (a - b).abs() > SAME;
        if self.next_line_place() != other.next_line_place()
            || here.memory.names_differ(&there.memory, SAME)
        {
            return [true; AXES];
        }
        let offsets = [&here.frame, &there.frame].map(|frame| frame.to_machine(&[0.0; AXES]));
        let mut differs: [bool; AXES] = std::array::from_fn(|axis| {
            differ(here.machine[axis], there.machine[axis])
                || differ(offsets[0][axis], offsets[1][axis])
        });
        for number in here.memory.differing(&there.memory, SAME) {
            match axis_of(number) {
                Some(axis) => differs[axis] = true,
                None => return [true; AXES],
            }
        }
        // A rotation mixes X and Y.
        if here.frame.is_rotated() && (differs[0] || differs[1]) {
            (differs[0], differs[1]) = (true, true);
        }
        differs
    }
}

/// The axis of a parameter that is a stored place or an offset.
fn axis_of(number: usize) -> Option<usize> {
    let first_of_systems = (0..9).map(|system| numbers::ORIGIN + system * numbers::SYSTEM_STEP);
    let firsts = [numbers::PROBED, numbers::HOME_28, numbers::HOME_30, numbers::G92].into_iter();
    firsts
        .chain(first_of_systems)
        .find_map(|first| number.checked_sub(first).filter(|&axis| axis < AXES))
}
