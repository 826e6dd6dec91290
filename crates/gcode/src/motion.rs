//! Executes the motion of a line: straight moves, arcs, probes, and the beginning of cycles.

use crate::canon::{AXES, AXIS_LETTERS, Arc, Canon, Pace, Plane, Point};
use crate::circle::{self, Vector};
use crate::codes::{Code, Group};
use crate::cycle::Cycle;
use crate::error::{ErrorKind, Fault};
use crate::frame::FURTHEST;
use crate::request::Request;
use crate::state::{Motion, State, numbers};

/// Places that differ by less than this, in mm or degrees, are the same but for rounding.
const SAME: f64 = 1e-9;

/// Greatest number of turns of an arc, of holes of a line, and of calls of M98.
pub(crate) const MOST: u32 = 1_000_000_000;

/// Longest rest in s.
pub(crate) const MOST_SECONDS: f64 = 1e9;

/// Letters of the axes as words.
pub(crate) const AXIS_WORDS: [u8; AXES] = [b'x', b'y', b'z', b'a', b'b', b'c'];

/// A line's motion.
pub(crate) struct Mover<'s> {
    pub(crate) state: &'s mut State,
    pub(crate) request: &'s mut Request,
    /// The code of the motion in messages: that of the line, or the one that is still in effect.
    pub(crate) code: Code,
    /// F of this line, if the feed mode is inverse time: 1 / min.
    pub(crate) inverse_feed: Option<f64>,
}

/// What a line's motion gives.
pub(crate) enum Moved {
    /// The place stays.
    Nothing,
    /// One move.
    One(Canon),
    /// Several moves.
    Cycle(Box<Cycle>),
}

impl Mover<'_> {
    pub(crate) fn run(&mut self, motion: Motion) -> Result<Moved, Fault> {
        if let Some(g53) = self.request.code(Group::Once).filter(|code| code.tenths == 530) {
            return self.in_machine_coordinates(motion, g53);
        }
        match motion {
            Motion::None => Err(Fault::new(self.code.column, ErrorKind::NoMotion)),
            Motion::Traverse | Motion::Feed => {
                let to = self.target()?;
                self.straight(motion, to)
            }
            Motion::Arc { clockwise } => self.arc(clockwise),
            Motion::Probe(tenths) => self.probe(tenths),
            // `drill` begins them.
            Motion::Cycle(_) => Ok(Moved::Nothing),
        }
    }

    /// G53: the words are machine coordinates.
    fn in_machine_coordinates(&mut self, motion: Motion, g53: Code) -> Result<Moved, Fault> {
        if !matches!(motion, Motion::Traverse | Motion::Feed) {
            let kind = match motion {
                Motion::None => ErrorKind::NoMotion,
                _ => ErrorKind::MachineMotion(self.code.to_string()),
            };
            return Err(Fault::new(g53.column, kind));
        }
        if self.state.modal.incremental {
            return Err(Fault::new(g53.column, ErrorKind::MachineIncremental));
        }
        let mut machine = self.state.machine;
        for (axis, word) in self.axis_values().into_iter().enumerate() {
            machine[axis] = word.unwrap_or(machine[axis]);
        }
        self.near(&machine)?;
        let program = self.state.frame.to_program(&machine);
        self.straight_to(motion, program, machine)
    }

    /// The program place that the polar words and the axis words of the line give.
    fn target(&mut self) -> Result<Point, Fault> {
        let polar = self.polar_words()?;
        let mut to = self.axis_words();
        if let Some((polar, _)) = polar {
            [to[0], to[1]] = polar.place();
        }
        Ok(to)
    }

    /// The values of the axis words, in mm and degrees.
    pub(crate) fn axis_values(&mut self) -> [Option<f64>; AXES] {
        std::array::from_fn(|axis| {
            let value = self.request.take(AXIS_WORDS[axis]);
            value.map(|value| value * self.state.axis_unit(axis))
        })
    }

    /// The program place that the axis words of the line give.
    pub(crate) fn axis_words(&mut self) -> Point {
        let mut to = self.state.program;
        for (axis, word) in self.axis_values().into_iter().enumerate() {
            if let Some(value) = word {
                to[axis] = if self.state.modal.incremental { to[axis] + value } else { value };
            }
        }
        to
    }

    /// Checks that a place is not absurd, so that no later sum overflows.
    pub(crate) fn near(&self, machine: &Point) -> Result<(), Fault> {
        for (axis, &place) in machine.iter().enumerate() {
            if !place.is_finite() || place.abs() > FURTHEST {
                let kind = ErrorKind::TooFar { axis: AXIS_LETTERS[axis], place, limit: FURTHEST };
                return Err(self.request.fault(AXIS_WORDS[axis], kind));
            }
        }
        Ok(())
    }

    pub(crate) fn straight(&mut self, motion: Motion, to: Point) -> Result<Moved, Fault> {
        let machine = self.state.frame.to_machine(&to);
        self.straight_to(motion, to, machine)
    }

    pub(crate) fn straight_to(
        &mut self,
        motion: Motion,
        program: Point,
        machine: Point,
    ) -> Result<Moved, Fault> {
        self.near(&machine)?;
        let canon = match motion {
            Motion::Feed => Canon::Feed { to: machine, pace: self.pace(&machine)? },
            _ => Canon::Traverse { to: machine },
        };
        if is_same(&machine, &self.state.machine) {
            // The machine place stays that of the last move, so that short moves add up.
            self.state.program = program;
            return Ok(Moved::Nothing);
        }
        self.arrive(program, machine);
        Ok(Moved::One(canon))
    }

    pub(crate) fn arrive(&mut self, program: Point, machine: Point) {
        self.state.program = program;
        self.state.machine = machine;
    }

    /// Speed or duration of a feed move that ends here.
    pub(crate) fn pace(&self, to: &Point) -> Result<Pace, Fault> {
        let code = || self.code.to_string();
        let fault = |kind| Err(Fault::new(self.code.column, kind));
        if self.state.modal.inverse_time {
            return match self.inverse_feed {
                Some(feed) if feed > 0.0 => Ok(Pace::Seconds(60.0 / feed)),
                Some(_) => fault(ErrorKind::ZeroFeed(code())),
                None => fault(ErrorKind::MissingInverseFeed(code())),
            };
        }
        let is_linear = !is_same(&to[..3], &self.state.machine[..3]);
        match self.state.modal.feed {
            None => fault(ErrorKind::MissingFeed(code())),
            Some((millimetres, degrees)) => {
                let feed = if is_linear { millimetres } else { degrees };
                if feed > 0.0 {
                    Ok(Pace::PerSecond(feed / 60.0))
                } else {
                    fault(ErrorKind::ZeroFeed(code()))
                }
            }
        }
    }

    fn arc(&mut self, clockwise: bool) -> Result<Moved, Fault> {
        let plane = self.state.modal.plane;
        let axes = plane.axes();
        let code = self.code;
        let fault = |kind| Fault::new(code.column, kind);
        if plane != Plane::Xy && self.state.frame.is_rotated() {
            return Err(fault(ErrorKind::ArcRotated));
        }
        let start = self.state.program;
        let to = self.target()?;
        let machine = self.state.frame.to_machine(&to);
        self.near(&machine)?;
        let in_plane = |place: &Point| [place[axes[0]], place[axes[1]]];
        let (from, end) = (in_plane(&start), in_plane(&to));
        let centre = if let Some(radius) = self.request.take(b'r') {
            let radius = radius * self.state.unit();
            circle::centre_by_radius(from, end, radius, clockwise).map_err(fault)?
        } else {
            self.centre_words(from, [axes[0], axes[1]])?
        };
        let mut middle = start;
        (middle[axes[0]], middle[axes[1]]) = (centre[0], centre[1]);
        let middle = self.state.frame.to_machine(&middle);
        self.near(&middle)?;
        circle::check(centre, from, end).map_err(fault)?;
        let turns = self.request.take_whole(b'p', MOST, "1 to 10^9 turns")?.unwrap_or(1);
        if turns == 0 {
            return Err(self.request.out_of_range(b'p', 0.0, "1 to 10^9 turns"));
        }
        let turns_signed = turns as i32 * if clockwise { -1 } else { 1 };
        // The pace of an arc is in mm, also if it ends where it starts.
        let mut away = machine;
        away[0] = f64::INFINITY;
        let arc = Arc {
            plane,
            centre: in_plane(&middle),
            to: machine,
            sweep: circle::sweep(centre, from, end, clockwise, turns),
            turns: turns_signed,
            pace: self.pace(&away)?,
        };
        self.arrive(to, machine);
        Ok(Moved::One(Canon::Arc(arc)))
    }

    /// The centre from I, J and K.
    fn centre_words(&mut self, start: Vector, axes: [usize; 2]) -> Result<Vector, Fault> {
        const LETTERS: [u8; 3] = [b'i', b'j', b'k'];
        let missing = |code: Code, word| {
            Fault::new(code.column, ErrorKind::Missing { code: code.to_string(), word })
        };
        let unit = self.state.unit();
        let words = axes.map(|axis| self.request.take(LETTERS[axis]).map(|value| value * unit));
        match words {
            [None, None] => Err(missing(self.code, "the centre (I, J, K) or the radius (R)")),
            [Some(first), Some(second)] if self.state.modal.centre_absolute => Ok([first, second]),
            _ if self.state.modal.centre_absolute => {
                Err(missing(self.code, "both coordinates of the centre (G90.1)"))
            }
            [first, second] => {
                Ok([start[0] + first.unwrap_or(0.0), start[1] + second.unwrap_or(0.0)])
            }
        }
    }

    fn probe(&mut self, tenths: u16) -> Result<Moved, Fault> {
        if self.state.modal.inverse_time {
            let kind = ErrorKind::NotInInverseTime(self.code.to_string());
            return Err(Fault::new(self.code.column, kind));
        }
        let program = self.axis_words();
        let to = self.state.frame.to_machine(&program);
        self.near(&to)?;
        if is_same(&to, &self.state.machine) {
            return Err(Fault::new(self.code.column, ErrorKind::ProbeNoLength));
        }
        let pace = self.pace(&to)?;
        self.arrive(program, to);
        record_probe(self.state, true);
        let (contact, required) = (tenths < 384, tenths.is_multiple_of(2));
        Ok(Moved::One(Canon::Probe { to, pace, contact, required }))
    }
}

/// Whether two places differ by no more than rounding errors. Without this, a turn of A alone in a
/// rotated coordinate system would be a move of X by 1e-15 mm, and its feed would be in mm.
fn is_same(one: &[f64], other: &[f64]) -> bool {
    one.iter().zip(other).all(|(one, other)| (one - other).abs() < SAME)
}

/// Sets the parameters that report a probe at the present place.
pub(crate) fn record_probe(state: &mut State, tripped: bool) {
    let place = std::array::from_fn(|axis| state.program[axis] / state.axis_unit(axis));
    state.set_point(numbers::PROBED, &place);
    state.memory.set(numbers::PROBE_TRIPPED, f64::from(u8::from(tripped)));
}
