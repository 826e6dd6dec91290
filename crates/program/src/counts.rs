//! What a program asks for, counted while it is read.

use crate::events::{Event, ProgrammedMove};
use crate::letters::LINEAR;
use std::fmt;

/// Something that a program switches, and that no gateware does yet.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Switch {
    /// M0, M1: the machine rests until it is resumed.
    Pause,
    /// M6: the machine rests until the tool is changed.
    ToolChange,
    /// M3, M4, M5 and S.
    Spindle,
    /// M7, M8, M9.
    Coolant,
    /// M62 to M68.
    Output,
    /// G38.2 to G38.5: the probe is assumed to trip at the target.
    Probe,
}

impl Switch {
    /// All of them, in the order of reports.
    pub const ALL: [Self; 6] =
        [Self::Pause, Self::ToolChange, Self::Spindle, Self::Coolant, Self::Output, Self::Probe];

    /// Its name in documents.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Pause => "pause",
            Self::ToolChange => "tool change",
            Self::Spindle => "spindle",
            Self::Coolant => "coolant",
            Self::Output => "output",
            Self::Probe => "probe",
        }
    }

    /// What the plan does instead.
    pub const fn instead(self) -> &'static str {
        match self {
            Self::Pause | Self::ToolChange => "the job rests; its time has no waiting",
            Self::Spindle | Self::Coolant | Self::Output => "the job rests; nothing is switched",
            Self::Probe => "assumed to trip at its target",
        }
    }
}

impl fmt::Display for Switch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// How often a program does something.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SwitchCount {
    /// What it does.
    pub switch: Switch,
    /// How often.
    pub count: u64,
    /// The first line that does it.
    pub line: u64,
}

/// Figures of a program.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Counts {
    /// The last line that was read.
    pub lines: u64,
    /// Moves with a length, arcs included.
    pub moves: u64,
    /// Arcs.
    pub arcs: u64,
    /// Runs from rest to rest.
    pub runs: u64,
    /// Length of the programmed path in mm.
    pub distance_mm: f64,
    /// The part of it that is rapid (G0).
    pub rapid_mm: f64,
    /// Length of moves of rotary axes alone, degrees.
    pub rotary_deg: f64,
    /// Time of all G4 in s.
    pub dwell_s: f64,
    /// The least and the greatest tolerance in force at a move, mm.
    pub tolerance_mm: Option<[f64; 2]>,
    /// What is switched, in the order of [`Switch::ALL`].
    pub switches: Vec<SwitchCount>,
    moves_now: bool,
}

impl Counts {
    pub(crate) fn add(&mut self, event: &Event) {
        match event {
            Event::Move(one) => self.moved(one),
            Event::Rest { seconds, line } => {
                self.dwell_s += seconds;
                self.lines = self.lines.max(*line);
                self.moves_now = false;
            }
            Event::Switch { switch, line } => {
                self.lines = self.lines.max(*line);
                self.moves_now = false;
                match self.switches.iter_mut().find(|known| known.switch == *switch) {
                    Some(known) => known.count += 1,
                    None => {
                        self.switches.push(SwitchCount { switch: *switch, count: 1, line: *line });
                        self.switches.sort_by_key(|known| known.switch);
                    }
                }
            }
            Event::End { line } => self.lines = self.lines.max(*line),
        }
    }

    fn moved(&mut self, one: &ProgrammedMove) {
        self.lines = self.lines.max(one.line);
        let length = one.length();
        if length == 0.0 {
            return;
        }
        self.moves += 1;
        self.arcs += u64::from(one.arc.is_some());
        self.runs += u64::from(!self.moves_now);
        self.moves_now = true;
        if (0..LINEAR).any(|letter| one.from[letter] != one.to[letter]) || one.arc.is_some() {
            self.distance_mm += length;
            self.rapid_mm += if one.feed.is_none() { length } else { 0.0 };
        } else {
            self.rotary_deg += length;
        }
        let tolerance = one.tolerance.linear;
        let [least, most] = self.tolerance_mm.unwrap_or([tolerance; 2]);
        self.tolerance_mm = Some([least.min(tolerance), most.max(tolerance)]);
    }
}
