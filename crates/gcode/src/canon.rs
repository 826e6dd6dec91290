//! Canonical moves: what a program does, without modes, units, offsets and expressions.
//!
//! Every place is in machine coordinates: X, Y and Z in mm, A, B and C in degrees, as full doubles.
//! Every move carries its own speed. A planner therefore needs nothing but these moves in order,
//! and the place where the first one begins.

use std::f64::consts::TAU;
use std::sync::Arc as Shared;

/// Number of axes: x, y, z in mm, then a, b, c in degrees.
pub const AXES: usize = 6;

/// The letters of the axes, in the order of a [`Point`].
pub const AXIS_LETTERS: [char; AXES] = ['x', 'y', 'z', 'a', 'b', 'c'];

/// A place in machine coordinates: x, y, z in mm, a, b, c in degrees.
pub type Point = [f64; AXES];

/// A canonical move or action, and the line of the program that asked for it.
#[derive(Debug, Clone, PartialEq)]
pub struct Step {
    /// Name of the file, as the caller gave it, or that of a subroutine.
    pub file: Shared<str>,
    /// Line in the file, from 1.
    pub line: u64,
    /// Number of the executed block, from 1 ([`ExecutedBlock`](crate::ExecutedBlock)).
    pub block: u64,
    /// What is to be done.
    pub canon: Canon,
}

/// One canonical move or action.
#[derive(Debug, Clone, PartialEq)]
pub enum Canon {
    /// G0: all axes together on a straight line, as fast as the axes allow.
    Traverse {
        /// The end of the move.
        to: Point,
    },
    /// G1: all axes together on a straight line.
    Feed {
        /// The end of the move.
        to: Point,
        /// The speed or the duration of the move.
        pace: Pace,
    },
    /// G2, G3: a circular arc or a helix in a plane; the other axes move in proportion to the
    /// angle.
    Arc(Arc),
    /// G38.2 to G38.5: straight towards a place until the probe input changes. The interpreter
    /// assumes that the probe changes exactly at `to`, unless
    /// [`Interpreter::probed`](crate::Interpreter::probed) reports another place.
    Probe {
        /// The place at which the move ends without a change.
        to: Point,
        /// The speed of the move.
        pace: Pace,
        /// True for contact (G38.2, G38.3), false for loss of contact (G38.4, G38.5).
        contact: bool,
        /// Whether a move without a change is an error (G38.2, G38.4).
        required: bool,
    },
    /// G4: the machine rests for this time, in s.
    Dwell {
        /// Duration in s, at least 0.
        seconds: f64,
    },
    /// G61, G61.1, G64: how exactly the path is kept from here on.
    Path(PathMode),
    /// M3, M4, M5, and S while the spindle turns.
    Spindle {
        /// Direction of rotation.
        turn: Turn,
        /// Speed as the program gives it, in turns per minute, at least 0.
        rpm: f64,
    },
    /// M7, M8, M9: what is on from here on.
    Coolant {
        /// Mist (M7) is on.
        mist: bool,
        /// Flood (M8) is on.
        flood: bool,
    },
    /// M48, M49: whether the operator's override of feed and spindle is in effect.
    Overrides {
        /// The override is in effect.
        enabled: bool,
    },
    /// M62 to M65: a digital output changes.
    DigitalOutput {
        /// Number of the output, from 0.
        index: u32,
        /// The new level.
        on: bool,
        /// True (M62, M63): it changes with the beginning of the next move. False (M64, M65): it
        /// changes at once.
        with_motion: bool,
    },
    /// M67, M68: an analog output changes.
    AnalogOutput {
        /// Number of the output, from 0.
        index: u32,
        /// The value, without a unit.
        value: f64,
        /// True (M67): it changes with the beginning of the next move. False (M68): at once.
        with_motion: bool,
    },
    /// M66: the machine rests until an input is as it is wanted, or for this time, and reads it.
    /// The interpreter assumes that the input becomes what is wanted, and is 0 if nothing is
    /// wanted, unless [`Interpreter::input_read`](crate::Interpreter::input_read) reports another
    /// value.
    ReadInput {
        /// The input.
        input: Input,
        /// What it waits for.
        until: Until,
        /// Longest time of waiting in s, greater than 0; 0 for [`Until::Now`].
        seconds: f64,
    },
    /// T: the tool that the next [`Canon::ChangeTool`] takes.
    SelectTool {
        /// Number of the tool, 0 for none.
        tool: u32,
    },
    /// M6: the machine rests until the tool is in the spindle. The spindle has been stopped.
    ChangeTool {
        /// Number of the tool, 0 for none.
        tool: u32,
    },
    /// M0, M1, M60: the machine rests until it is resumed.
    Pause {
        /// True for M1, which only stops if the operator wants it.
        optional: bool,
    },
    /// A comment, which changes nothing.
    Comment(String),
    /// A message for the operator: (MSG,...), and (DEBUG,...) and (PRINT,...) with the values of
    /// their parameters.
    Message(String),
    /// M2, M30 or the end of the file. Spindle and coolant have been switched off, and nothing
    /// follows.
    End,
}

impl Canon {
    /// Whether it is a move.
    pub const fn is_motion(&self) -> bool {
        matches!(
            self,
            Self::Traverse { .. } | Self::Feed { .. } | Self::Arc(_) | Self::Probe { .. }
        )
    }

    /// Whether the machine comes to rest after it, and what follows can depend on what happens
    /// then: a probe, M66, M6, M0, M1 and M60.
    pub fn is_sync_point(&self) -> bool {
        matches!(
            self,
            Self::Probe { .. }
                | Self::ReadInput { .. }
                | Self::ChangeTool { .. }
                | Self::Pause { .. }
        )
    }
}

/// An input that a program can read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Input {
    /// P of M66: number of a digital input, from 0.
    Digital(u32),
    /// E of M66: number of an analog input, from 0.
    Analog(u32),
}

/// What M66 waits for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Until {
    /// L0: nothing; the input is only read.
    Now,
    /// L1: the input goes from low to high.
    Rise,
    /// L2: the input goes from high to low.
    Fall,
    /// L3: the input is high.
    High,
    /// L4: the input is low.
    Low,
}

/// How fast a move is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Pace {
    /// Along the path, in mm/s if X, Y or Z moves, otherwise in degrees/s; greater than 0.
    PerSecond(f64),
    /// G93: the duration of the whole move in s; greater than 0.
    Seconds(f64),
}

/// How exactly the path is kept.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PathMode {
    /// G61: the programmed path, without a stop where none is needed.
    Exact,
    /// G61.1: a stop at the end of every move.
    ExactStop,
    /// G64: corners may be rounded.
    Blend {
        /// P in mm: the greatest distance from the programmed path. Without P the machine's own.
        tolerance_mm: Option<f64>,
        /// Q in mm: lines that deviate less than this from one straight line may be joined.
        joining_mm: Option<f64>,
    },
}

/// Direction in which the spindle turns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Turn {
    /// The spindle stands (M5).
    Off,
    /// Clockwise, seen from the spindle towards the workpiece (M3).
    Clockwise,
    /// The other direction (M4).
    Counterclockwise,
}

/// The plane of an arc or of a drilling cycle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Plane {
    /// X and Y, with Z normal to them (G17).
    #[default]
    Xy,
    /// Z and X, with Y normal to them (G18).
    Zx,
    /// Y and Z, with X normal to them (G19).
    Yz,
}

impl Plane {
    /// Indices of the plane's first and second axis and of the axis normal to it, in a right-handed
    /// order.
    pub const fn axes(self) -> [usize; 3] {
        match self {
            Self::Xy => [0, 1, 2],
            Self::Zx => [2, 0, 1],
            Self::Yz => [1, 2, 0],
        }
    }
}

/// A circular arc, a helix, or, if the radii at its ends differ, a spiral.
///
/// With the angle phi from 0 to [`sweep`](Arc::sweep), the radius goes from that of the start to
/// that of the end in proportion to phi, and so do all axes outside of the plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Arc {
    /// The plane of the circle.
    pub plane: Plane,
    /// The centre in mm: coordinates of the plane's first and second axis.
    pub centre: [f64; 2],
    /// The end, exactly as programmed.
    pub to: Point,
    /// The angle from start to end in radians, whole turns included: positive counterclockwise,
    /// seen from the positive side of the plane's normal. Never 0.
    pub sweep: f64,
    /// P of the program, with the sign of the direction, as LinuxCNC gives it: with 1 or -1 the arc
    /// turns at most once.
    pub turns: i32,
    /// The speed or the duration of the whole arc.
    pub pace: Pace,
}

impl Arc {
    /// The place after this part of the arc, for an arc that begins at `from`: `part` is 0 at the
    /// start and 1 at the end, and both ends are exact.
    pub fn at(&self, from: &Point, part: f64) -> Point {
        if part <= 0.0 {
            return *from;
        }
        if part >= 1.0 {
            return self.to;
        }
        let mut place: Point = std::array::from_fn(|axis| {
            let (start, end) = (from[axis], self.to[axis]);
            start + (end - start) * part
        });
        let [first, second, _] = self.plane.axes();
        let (start, end) = (self.radius_vector(from), self.radius_vector(&self.to));
        let (from_radius, to_radius) = (start[0].hypot(start[1]), end[0].hypot(end[1]));
        let radius = from_radius + (to_radius - from_radius) * part;
        let angle = start[1].atan2(start[0]) + self.sweep * part;
        place[first] = self.centre[0] + radius * angle.cos();
        place[second] = self.centre[1] + radius * angle.sin();
        place
    }

    /// The vector in the plane from the centre to a place, in mm.
    pub fn radius_vector(&self, place: &Point) -> [f64; 2] {
        let [first, second, _] = self.plane.axes();
        [place[first] - self.centre[0], place[second] - self.centre[1]]
    }

    /// Number of turns, as a fraction.
    pub fn revolutions(&self) -> f64 {
        self.sweep.abs() / TAU
    }
}
