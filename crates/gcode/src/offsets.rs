//! Executes the codes that change coordinate systems or go to stored places: G10, G28, G30, G54 to
//! G59.3, and G92.

use crate::canon::{AXES, Canon};
use crate::codes::Code;
use crate::error::{ErrorKind, Fault};
use crate::motion::{AXIS_WORDS, Moved, Mover};
use crate::state::{Motion, numbers};

/// Numbers of the coordinate systems.
const SYSTEMS: u32 = 9;

impl Mover<'_> {
    /// G54 to G59.3.
    pub(crate) fn select_system(&mut self, code: Code) {
        self.state.modal.system = match code.tenths {
            tenths @ 540..=590 => usize::from((tenths - 530) / 10),
            tenths => usize::from(tenths - 584),
        };
        self.state.refresh_frame();
    }

    pub(crate) fn has_axis_words(&self) -> bool {
        AXIS_WORDS.iter().any(|&letter| self.request.has(letter))
    }

    /// G10.
    pub(crate) fn set_data(&mut self, code: Code) -> Result<(), Fault> {
        let kinds = "1, 2, 10 or 20";
        match self.request.take_whole(b'l', 20, kinds)? {
            None => Err(missing(code, "L1, L2, L10 or L20")),
            Some(kind @ (1 | 10)) => self.set_tool(code, kind),
            Some(kind @ (2 | 20)) => self.set_system(code, kind),
            Some(kind) => Err(self.request.out_of_range(b'l', kind.into(), kinds)),
        }
    }

    /// G10 L2 and L20: the origin of a coordinate system.
    fn set_system(&mut self, code: Code, kind: u32) -> Result<(), Fault> {
        let system = self.request.take_whole(b'p', SYSTEMS, "0 to 9")?;
        let system = match system.ok_or_else(|| missing(code, "P, the coordinate system"))? {
            0 => self.state.modal.system,
            number => number as usize,
        };
        let step = (system - 1) * numbers::SYSTEM_STEP;
        if kind == 2
            && let Some(degrees) = self.request.take(b'r')
        {
            self.state.memory.set(numbers::ROTATION + step, degrees);
        }
        let mut origin = self.state.point(numbers::ORIGIN + step);
        let words = self.axis_values();
        if kind == 2 {
            for (axis, word) in words.into_iter().enumerate() {
                origin[axis] = word.unwrap_or(origin[axis]);
            }
        } else {
            // The program place that the words leave out is the present one of this system.
            let mut frame = self.state.frame.clone();
            frame.system = origin;
            frame.set_rotation(self.state.memory.get(numbers::ROTATION + step));
            let mut program = frame.to_program(&self.state.machine);
            for (axis, word) in words.into_iter().enumerate() {
                program[axis] = word.unwrap_or(program[axis]);
            }
            let moved = frame.origin_for(&self.state.machine, &program);
            let is_turned = frame.is_rotated() && (words[0].is_some() || words[1].is_some());
            for (axis, word) in words.into_iter().enumerate() {
                if word.is_some() || axis < 2 && is_turned {
                    origin[axis] = moved[axis];
                }
            }
        }
        self.near(&origin)?;
        self.state.set_point(numbers::ORIGIN + step, &origin);
        self.state.refresh_frame();
        Ok(())
    }

    /// G28.1 and G30.1: stores the present place.
    pub(crate) fn store_home(&mut self, home: usize) {
        let machine = self.state.machine;
        self.state.set_point(home, &machine);
    }

    /// G28 and G30: to the stored place, by way of the place that the axis words give. With axis
    /// words, only their axes go on to the stored place; in a rotated coordinate system these are
    /// its axes, not those of the machine.
    pub(crate) fn go_home(&mut self, home: usize) -> Result<Vec<Canon>, Fault> {
        let stored = self.state.point(home);
        let named = AXIS_WORDS.map(|letter| self.request.has(letter));
        let all = !named.contains(&true);
        let mut moves = Vec::new();
        let by_way_of = self.axis_words();
        if let Moved::One(canon) = self.straight(Motion::Traverse, by_way_of)? {
            moves.push(canon);
        }
        let home = self.state.frame.to_program(&stored);
        let (mut program, mut machine) = (self.state.program, self.state.machine);
        for axis in (0..AXES).filter(|&axis| all || named[axis]) {
            (program[axis], machine[axis]) = (home[axis], stored[axis]);
        }
        if self.state.frame.is_rotated() && !all {
            machine = self.state.frame.to_machine(&program);
        }
        if let Moved::One(canon) = self.straight_to(Motion::Traverse, program, machine)? {
            moves.push(canon);
        }
        Ok(moves)
    }

    /// G92: the present place gets these program coordinates.
    pub(crate) fn set_g92(&mut self, code: Code) -> Result<(), Fault> {
        if !self.has_axis_words() {
            return Err(missing(code, "the coordinate of an axis"));
        }
        let mut offset = self.state.frame.g92;
        for (axis, word) in self.axis_values().into_iter().enumerate() {
            if let Some(value) = word {
                offset[axis] += self.state.program[axis] - value;
            }
        }
        self.near(&offset)?;
        self.state.set_point(numbers::G92, &offset);
        self.switch_g92(true);
        Ok(())
    }

    /// G92.2 and G92.3: suspends and restores the offset.
    pub(crate) fn switch_g92(&mut self, is_on: bool) {
        self.state.memory.set(numbers::G92_ON, f64::from(u8::from(is_on)));
        self.state.refresh_frame();
    }

    /// G92.1: forgets the offset.
    pub(crate) fn clear_g92(&mut self) {
        self.state.set_point(numbers::G92, &[0.0; AXES]);
        self.switch_g92(false);
    }
}

fn missing(code: Code, word: &'static str) -> Fault {
    Fault::new(code.column, ErrorKind::Missing { code: code.to_string(), word })
}
