//! What a part of a capture shows of the lines, and how the parts are appended to each other.
//!
//! A line that had begun before the part is judged when the greatest deviations before and in the
//! part are known. The lines that begin and end in the part are judged in it.

use super::{LineCheck, LinesCheck, Pairs, Worst};
use crate::worst_lines::WorstLines;
use serde::{Deserialize, Serialize};

/// What a part of a capture shows of the lines.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct LinesPart {
    /// The pulses of each axis before the part, and those up to its end.
    before: Vec<u64>,
    pulses: Vec<u64>,
    /// The lines that had begun before, and not ended, in order.
    earlier: Vec<Pairs>,
    /// The lines that have begun in the part, and not ended, in order.
    open: Vec<Pairs>,
    /// For each axis, the lines that have begun and ended in the part.
    worst: Vec<WorstLines>,
}

impl LinesCheck {
    /// Begins where each axis has made so many pulses, with the levels of STEP.
    pub(crate) fn begin_at(&mut self, pulses: Vec<u64>, high: Vec<bool>) {
        (self.pulses, self.high) = (pulses, high);
        self.read_to_the_pulses(|_, _| {});
        self.earlier = self.travelled + self.lines.len();
        self.before = self.pulses.clone();
        self.ended.clear();
    }

    /// Reads the moves in which the pulses are. `ended` is told the number of each line that all
    /// axes have travelled, and the line.
    fn read_to_the_pulses(&mut self, mut ended: impl FnMut(&mut Self, LineCheck)) {
        loop {
            while self.lines.front().is_some_and(|check| check.is_over(&self.pulses)) {
                let Some(check) = self.lines.pop_front() else { return };
                self.travelled += 1;
                ended(self, check);
            }
            let is_behind = |(required, pulses): (&u64, &u64)| required < pulses;
            let behind = self.required.iter().zip(&self.pulses).any(is_behind);
            if !behind || !self.begin_next() {
                return;
            }
        }
    }

    /// Ends the check of a part.
    pub(crate) fn into_part(self) -> LinesPart {
        let Self { before, pulses, mut ended, lines, worst, earlier, travelled, .. } = self;
        let mut open: Vec<Pairs> = lines.into_iter().map(|line| line.pairs).collect();
        let begun = open.split_off(earlier.saturating_sub(travelled).min(open.len()));
        ended.append(&mut open);
        LinesPart { before, pulses, earlier: ended, open: begun, worst }
    }

    /// Whether a part begins where this check ends.
    pub(crate) fn leads_to(&self, part: &LinesPart) -> bool {
        let axes = self.pulses.len();
        let fits = |pairs: &Pairs| pairs.len() == axes * axes;
        part.before == self.pulses
            && part.earlier.len() == self.lines.len()
            && part.pulses.len() == axes
            && part.worst.len() == axes
            && part.earlier.iter().chain(&part.open).all(fits)
    }

    /// Appends a part to which this check leads. `high` are the levels of STEP at its end.
    pub(crate) fn append(&mut self, part: &LinesPart, high: Vec<bool>) {
        for (line, later) in self.lines.iter_mut().zip(&part.earlier) {
            for (old, later) in line.pairs.iter_mut().zip(later) {
                *old = worse(*old, *later);
            }
        }
        let earlier = self.travelled + self.lines.len();
        (self.pulses, self.high) = (part.pulses.clone(), high);
        self.read_to_the_pulses(|check, line| {
            if check.travelled <= earlier {
                check.keep_worst(&line);
            }
        });
        for (own, later) in self.worst.iter_mut().zip(&part.worst) {
            later.iter().for_each(|line| own.add(line));
        }
        let begun = earlier.saturating_sub(self.travelled);
        for (line, pairs) in self.lines.iter_mut().skip(begun).zip(&part.open) {
            line.pairs.clone_from(pairs);
        }
    }
}

/// The greater of two deviations; the earlier one of equal ones.
fn worse(earlier: Option<Worst>, later: Option<Worst>) -> Option<Worst> {
    later.filter(|later| earlier.is_none_or(|earlier| earlier.apart < later.apart)).or(earlier)
}
