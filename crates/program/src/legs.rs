//! The programmed path as straight legs for the checker, which needs no other geometry.

use crate::error::ProgramError;
use crate::event::{Event, ProgrammedMove};
use crate::events::Events;
use crate::file::ProgramFile;
use carrystep_check::PathLeg;

/// The part of the tolerance by which a chord of an arc may be off the arc.
const CHORD: f64 = 1.0 / 64.0;
/// Most chords of one turn.
const MOST_CHORDS: f64 = 65_536.0;

/// The legs of a program. Moves without a length have none.
#[derive(Debug)]
pub struct Legs {
    events: Events,
    /// The move whose legs are given: how many there are, how many were given, and how far a chord
    /// is off, mm.
    now: Option<(ProgrammedMove, u64, u64, f64)>,
}

impl Legs {
    /// Reads a program from its beginning.
    ///
    /// # Errors
    /// As [`Events::new`].
    pub fn new(file: &ProgramFile) -> Result<Self, ProgramError> {
        Ok(Self { events: Events::new(file)?, now: None })
    }
}

/// Number of chords of a move, and their greatest distance from it in mm.
pub(crate) fn chords(one: &ProgrammedMove) -> (u64, f64) {
    let Some(arc) = &one.arc else { return (1, 0.0) };
    let radius = [&one.from, &one.to].map(|place| {
        let [a, b] = arc.radius_vector(place);
        a.hypot(b)
    });
    let radius = radius[0].max(radius[1]);
    // A chord over the angle 2 p is off by r (1 - cos p), which is at most r p^2 / 2. A spiral
    // whose radius changes by d over the angle s is off by less than that and d p / s more.
    let grows = (arc.radius_vector(&one.from)[0].hypot(arc.radius_vector(&one.from)[1])
        - arc.radius_vector(&one.to)[0].hypot(arc.radius_vector(&one.to)[1]))
    .abs();
    let off = |count: f64| {
        let half = arc.sweep.abs() / count / 2.0;
        radius * half * half / 2.0 + grows / count
    };
    let most = MOST_CHORDS * arc.revolutions().ceil().max(1.0);
    let wanted = one.tolerance.linear * CHORD;
    let mut count = 1.0;
    while off(count) > wanted && count < most {
        count *= 2.0;
    }
    (count as u64, off(count))
}

impl Iterator for Legs {
    type Item = Result<PathLeg, ProgramError>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            if let Some((one, count, given, off_mm)) = &mut self.now {
                if given < count {
                    *given += 1;
                    let part = *given as f64 / *count as f64;
                    return Some(Ok(PathLeg {
                        to: one.arc.map_or(one.to, |arc| arc.at(&one.from, part)),
                        tolerance_mm: one.tolerance.linear,
                        tolerance_deg: one.tolerance.rotary,
                        off_mm: *off_mm,
                        line: one.line,
                    }));
                }
                self.now = None;
            }
            match self.events.next()? {
                Ok(Event::Move(one)) if one.length() > 0.0 => {
                    let (count, off_mm) = chords(&one);
                    self.now = Some((one, count, 0, off_mm));
                }
                Ok(_) => {}
                Err(error) => return Some(Err(error)),
            }
        }
    }
}
