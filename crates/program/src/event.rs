//! What a program does, part by part: moves, rests, and what is switched.

use crate::laser::LaserPower;
use crate::letter::LINEAR;
use crate::switch::Switch;
use carrystep_core::OutputChange;
use carrystep_gcode::{AXES, Arc, Input, Point, Until};
use carrystep_job::Tolerance;

/// A part of what a program does. Places are x, y, z in mm, then a, b, c in degrees.
#[derive(Debug, Clone, PartialEq)]
#[expect(clippy::large_enum_variant, reason = "nearly all events are moves")]
pub enum Event {
    /// The tool moves.
    Move(ProgrammedMove),
    /// The tool rests.
    Rest {
        /// Duration in s, 0 or more.
        seconds: f64,
        /// Line of the program.
        line: u64,
    },
    /// Outputs change.
    Outputs {
        /// What changes.
        change: OutputChange,
        /// True: while the tool moves, where the next move begins. False: at rest.
        with_motion: bool,
        /// Line of the program.
        line: u64,
    },
    /// The power of a laser changes while the tool moves, where the next move begins.
    Laser {
        /// The new power.
        power: LaserPower,
        /// Line of the program.
        line: u64,
    },
    /// Something is switched that the machine cannot switch, or somebody is waited for, at rest.
    Switch {
        /// What it is.
        switch: Switch,
        /// Line of the program.
        line: u64,
    },
    /// What follows can depend on what was read here, at rest.
    Reading {
        /// What is read.
        reading: Reading,
        /// Line of the program.
        line: u64,
    },
    /// The end of the program.
    End {
        /// The last line that was read.
        line: u64,
    },
}

/// What a program reads, and then goes on with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Reading {
    /// G38.2 to G38.5: the place at which the last move was ended by the probe.
    Probe {
        /// True: the probe closes (G38.2, G38.3). False: it opens (G38.4, G38.5).
        contact: bool,
        /// Whether it is an error if the move was not ended (G38.2, G38.4).
        required: bool,
    },
    /// M66.
    Input {
        /// The input.
        input: Input,
        /// What is waited for.
        until: Until,
        /// Longest time of waiting, s.
        seconds: f64,
    },
}

impl Reading {
    /// The value of an input that a plan assumes; 0 for a probe.
    pub const fn assumed(&self) -> f64 {
        match self {
            Self::Input { until: Until::Rise | Until::High, .. } => 1.0,
            Self::Input { .. } | Self::Probe { .. } => 0.0,
        }
    }
}

/// A straight move, an arc or a helix.
#[derive(Debug, Clone, PartialEq)]
pub struct ProgrammedMove {
    /// The place where it begins.
    pub from: Point,
    /// The place where it ends.
    pub to: Point,
    /// How it bends; `None` for a straight move.
    pub arc: Option<Arc>,
    /// Greatest speed along the path, mm/s (degrees/s if only rotary axes move); `None` for G0.
    pub feed: Option<f64>,
    /// How far from the path the tool may be.
    pub tolerance: Tolerance,
    /// Line of the program.
    pub line: u64,
    /// The executed block, from 1; of an entry, the one that follows it.
    pub block: u64,
}

impl ProgrammedMove {
    /// The length of the path in mm if X, Y or Z moves, otherwise in degrees.
    pub fn length(&self) -> f64 {
        let distance = |letters: std::ops::Range<usize>| {
            letters.map(|i| (self.to[i] - self.from[i]).powi(2)).sum::<f64>().sqrt()
        };
        let Some(arc) = &self.arc else {
            let linear = distance(0..LINEAR);
            return if linear > 0.0 { linear } else { distance(LINEAR..AXES) };
        };
        let [_, _, normal] = arc.plane.axes();
        let [from, to] = [&self.from, &self.to].map(|place| {
            let [a, b] = arc.radius_vector(place);
            a.hypot(b)
        });
        let turned = (f64::midpoint(from, to) * arc.sweep).hypot(to - from);
        turned.hypot(self.to[normal] - self.from[normal])
    }
}
