//! Access for the fast model: the words of segments that the engine takes while every axis only
//! repeats its additions.
//!
//! A word only fills a register that nothing reads before the commit of its segment. The strobe
//! after a commit moves the segment into the queue, and [`Motion::clock`] executes it:
//!
//! ```text
//! tick    |       n       |      n + 1    |      n + 2    |
//! word    | x 5 . y 5     | x 6 . y 6     | commits       |   the clocks before the last strobe
//! strobe  _______________/^______________/^______________/^   may be skipped
//! ```

use super::Motion;
use super::switches::LAST_BEAT;
use carrystep_core::engine::{COMMIT, CUT_WORD, MAX_AXES, PUT_BEAT, Put};

impl Motion {
    /// Returns how many clocks, at most `most`, may be skipped before a word causes an event, and
    /// how many of the words are taken in these clocks. In all these clocks nothing else may happen
    /// ([`Motion::plain_clocks`]).
    ///
    /// The host offers `words` one after the other: each from the clock after the one in which the
    /// word before it was taken. If `takes` is false, the taking of a word is an event itself.
    pub(crate) fn taking(&self, words: &[Put], takes: bool, most: u64) -> (u64, usize) {
        if self.stop.fault.is_some() {
            return (most, 0);
        }
        let per_tick = u64::from(self.clocks_per_tick());
        // The clock of the tick in which these clocks begin.
        let begin = u64::from(self.clock);
        let mut next_words = [0; MAX_AXES];
        for (next, axis_model) in next_words.iter_mut().zip(&self.axis_models) {
            *next = axis_model.next_word;
        }
        let (mut end, mut from) = (most, 0);
        for (taken, put) in words.iter().enumerate() {
            let axis = usize::from(put.axis);
            let Some(axis_model) = self.axis_models.get(axis) else {
                return (end.min(from), taken);
            };
            let names = put.word & CUT_WORD != 0;
            if !names && axis_model.room() == 0 {
                return (end, taken);
            }
            let beat = if names { LAST_BEAT } else { PUT_BEAT };
            let beat = u64::from(self.build.first_clock_of(axis) + beat);
            let at = from + (beat + per_tick - (begin + from) % per_tick) % per_tick;
            if at >= end {
                return (end, taken);
            }
            // A word that comes at rest makes the engine active, a misplaced word or a bit without a
            // use is a fault, and the name of a slot is needed by the next cut.
            let follows = put.word == next_words[axis] && !self.has_stray_bits(*put);
            if !takes || self.rest > 0 || !follows {
                return (at, taken);
            }
            next_words[axis] += 1;
            if put.word == COMMIT {
                next_words[axis] = 0;
                end = end.min(at + per_tick - 1 - (begin + at) % per_tick);
            }
            from = at + 1;
        }
        // What the host does after the last of these words is not known here.
        (if words.is_empty() { end } else { end.min(from) }, words.len())
    }

    /// Takes words that [`Motion::taking`] counts.
    pub(crate) fn take(&mut self, words: &[Put]) {
        for put in words {
            let follows = self.put(*put);
            debug_assert!(follows, "{put:?} is not the next word of its axis");
        }
    }
}
