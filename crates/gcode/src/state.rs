//! The state of the machine between two lines: modes, offsets, parameters, and the place.

use crate::canon::{AXES, PathMode, Plane, Point, Turn};
use crate::frame::Frame;
use crate::memory::Memory;
use crate::tools::{Tool, ToolTable};

/// mm in an inch.
pub(crate) const INCH: f64 = 25.4;

/// Numbers of parameters that a program can read, and what they are. Offsets are in mm.
pub(crate) mod numbers {
    /// Place of the last probe, six axes, in units of the program.
    pub(crate) const PROBED: usize = 5061;
    /// 1 if the last probe has tripped.
    pub(crate) const PROBE_TRIPPED: usize = 5070;
    /// Machine place of G28, six axes.
    pub(crate) const HOME_28: usize = 5161;
    /// Machine place of G30, six axes.
    pub(crate) const HOME_30: usize = 5181;
    /// 1 while the offset of G92 is in effect.
    pub(crate) const G92_ON: usize = 5210;
    /// Offset of G92, six axes.
    pub(crate) const G92: usize = 5211;
    /// Number of the coordinate system, 1 for G54.
    pub(crate) const SYSTEM: usize = 5220;
    /// Origin of G54, six axes; the other systems follow at a distance of [`SYSTEM_STEP`].
    pub(crate) const ORIGIN: usize = 5221;
    /// Rotation of G54 in degrees.
    pub(crate) const ROTATION: usize = 5230;
    /// Distance of the parameters of two coordinate systems.
    pub(crate) const SYSTEM_STEP: usize = 20;
    /// Value of the last input that was read, or -1.
    pub(crate) const INPUT: usize = 5399;
    /// Number of the tool in the spindle.
    pub(crate) const TOOL: usize = 5400;
    /// Offset of the tool in the spindle as the tool table gives it, six axes.
    pub(crate) const TOOL_OFFSET: usize = 5401;
    /// Diameter of the tool in the spindle, in mm.
    pub(crate) const TOOL_DIAMETER: usize = 5410;
    /// Present place, six axes, in units of the program.
    pub(crate) const PLACE: usize = 5420;
}

/// A motion mode (modal group 1).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Motion {
    /// G80, and before the first motion code.
    None,
    /// G0.
    Traverse,
    /// G1.
    Feed,
    /// G2 and G3.
    Arc {
        /// G2.
        clockwise: bool,
    },
    /// G38.2 to G38.5: tenths of the code.
    Probe(u16),
    /// G81 to G83: the code.
    Cycle(u16),
}

/// Words of a drilling cycle that the next line need not repeat.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct CycleWords {
    /// R, Z (or its like in other planes) and Q as programmed, in mm; P in s.
    pub(crate) r: f64,
    pub(crate) bottom: f64,
    pub(crate) peck: f64,
    pub(crate) dwell: f64,
    /// Level at which the first cycle since the last other motion began.
    pub(crate) initial_level: Option<f64>,
}

/// Modes, as G and M codes set them.
#[derive(Debug, Clone)]
pub(crate) struct Modal {
    pub(crate) motion: Motion,
    pub(crate) plane: Plane,
    /// G91.
    pub(crate) incremental: bool,
    /// G90.1.
    pub(crate) centre_absolute: bool,
    /// G20.
    pub(crate) inches: bool,
    /// G93.
    pub(crate) inverse_time: bool,
    /// G98: cycles end at their initial level and not at R.
    pub(crate) retract_to_initial: bool,
    /// G54 is 1, G59.3 is 9.
    pub(crate) system: usize,
    pub(crate) path: PathMode,
    /// F: mm per minute, and the number itself for degrees per minute.
    pub(crate) feed: Option<(f64, f64)>,
    pub(crate) spindle: Turn,
    pub(crate) rpm: f64,
    pub(crate) mist: bool,
    pub(crate) flood: bool,
    pub(crate) overrides: bool,
    pub(crate) selected_tool: u32,
    pub(crate) tool: u32,
    pub(crate) cycle: CycleWords,
}

/// Everything that a line can read or change.
#[derive(Debug, Clone)]
pub(crate) struct State {
    pub(crate) memory: Memory,
    pub(crate) modal: Modal,
    pub(crate) frame: Frame,
    /// The tool table, if there is one.
    pub(crate) tools: Option<ToolTable>,
    /// The place in machine coordinates.
    pub(crate) machine: Point,
    /// The same place in program coordinates, in mm and degrees.
    pub(crate) program: Point,
    pub(crate) line: u64,
    pub(crate) call_level: usize,
}

impl State {
    /// The machine is at this place.
    pub(crate) fn set_place(&mut self, at: Point) {
        self.machine = at;
        self.program = self.frame.to_program(&at);
    }

    /// A machine at this place, with the modes in which LinuxCNC starts in millimetres.
    pub(crate) fn new(machine: Point, tools: Option<ToolTable>) -> Self {
        let modal = Modal {
            motion: Motion::None,
            plane: Plane::Xy,
            incremental: false,
            centre_absolute: false,
            inches: false,
            inverse_time: false,
            retract_to_initial: false,
            system: 1,
            path: PathMode::Blend { tolerance_mm: None, joining_mm: None },
            feed: None,
            spindle: Turn::Off,
            rpm: 0.0,
            mist: false,
            flood: false,
            overrides: true,
            selected_tool: 0,
            tool: 0,
            cycle: CycleWords::default(),
        };
        let (memory, frame) = (Memory::new(), Frame::default());
        Self { memory, modal, frame, tools, machine, program: machine, line: 0, call_level: 0 }
    }

    /// mm in a unit of length of the program.
    pub(crate) fn unit(&self) -> f64 {
        if self.modal.inches { INCH } else { 1.0 }
    }

    /// mm or degrees in a unit of an axis of the program.
    pub(crate) fn axis_unit(&self, axis: usize) -> f64 {
        if axis < 3 { self.unit() } else { 1.0 }
    }

    /// The tool in the spindle; of no length if the table does not have it.
    pub(crate) fn tool(&self) -> Tool {
        let tool = self.tools.as_ref().and_then(|tools| tools.get(self.modal.tool));
        tool.copied().unwrap_or_default()
    }

    /// Six parameters from this number on.
    pub(crate) fn point(&self, from: usize) -> Point {
        std::array::from_fn(|axis| self.memory.get(from + axis))
    }

    /// Sets six parameters from this number on.
    pub(crate) fn set_point(&mut self, from: usize, point: &Point) {
        for (axis, &value) in point.iter().enumerate() {
            self.memory.set(from + axis, value);
        }
    }

    /// Takes the offsets in effect from the parameters, and computes the program coordinates anew.
    pub(crate) fn refresh_frame(&mut self) {
        let step = (self.modal.system - 1) * numbers::SYSTEM_STEP;
        self.frame.system = self.point(numbers::ORIGIN + step);
        self.frame.set_rotation(self.memory.get(numbers::ROTATION + step));
        let is_on = self.memory.get(numbers::G92_ON) != 0.0;
        self.frame.g92 = if is_on { self.point(numbers::G92) } else { [0.0; AXES] };
        self.program = self.frame.to_program(&self.machine);
    }
}
