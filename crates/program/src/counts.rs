//! What a program asks for, counted while it is read.

use crate::event::{Event, ProgrammedMove, Reading};
use crate::letter::LINEAR;
use crate::switch::SwitchCount;
use carrystep_gcode::Input;

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
    /// What is switched, in the order of [`Switch::ALL`](crate::Switch::ALL).
    pub switches: Vec<SwitchCount>,
    /// The inputs that M66 reads, each with the first line that reads it.
    pub inputs: Vec<(Input, u64)>,
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
            Event::Outputs { with_motion, line, .. } => {
                self.lines = self.lines.max(*line);
                self.moves_now &= with_motion;
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
            Event::Reading { reading, line } => {
                self.lines = self.lines.max(*line);
                if let Reading::Input { input, .. } = reading
                    && self.inputs.iter().all(|(known, _)| known != input)
                {
                    self.inputs.push((*input, *line));
                }
            }
            Event::Laser { line, .. } | Event::End { line } => self.lines = self.lines.max(*line),
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
