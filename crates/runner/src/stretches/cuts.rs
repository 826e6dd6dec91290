//! Changes of a stretch that runs, as soon as the queues of the board allow them: the board cuts its
//! queues, and the rows behind the cut are given anew.
//!
//! ```text
//! queues     r5 r6 r7 r8 r9      r5 runs
//! cut        r5 r6 |             r6 lasts as long as planning and the line take
//! given anew       h0 h1 h2      the hold, the other speed, or the rows with the outputs
//! ```
//!
//! At most one cut is undecided. Until the board has granted or refused it, the rows of before are
//! kept.

use super::Stretches;
use crate::override_setting::OverrideSetting;
use carrystep_core::OutputChange;
use carrystep_link::Queues;
use carrystep_program::Row;

impl<I: Iterator<Item = Row>> Stretches<I> {
    /// [`Self::hold`] as soon as the queues of the board allow it. Returns the number of rows of the
    /// stretch behind which the board has to cut its queues: the hold follows these. `None` if
    /// nothing has to be cut; whether there is a hold now, [`Self::is_held`] says.
    pub fn hold_in(&mut self, queues: Queues) -> Option<u32> {
        self.decide(queues);
        if self.uncut.is_some() {
            return None;
        }
        let Some(keep) = self.cut(queues) else {
            self.hold();
            return None;
        };
        let before = self.now.clone();
        if self.now.rewind(keep) {
            self.hold();
        }
        if self.is_held() {
            (self.uncut, self.granted) = (Some((before, self.overrides)), queues.cuts);
            return Some(keep);
        }
        self.now = before;
        None
    }

    /// [`Self::set_overrides`] as soon as the queues of the board allow it. Returns the number of rows
    /// of the stretch behind which the board has to cut its queues. `None` if nothing has to be cut.
    /// If the board refuses the cut, the overrides are those of before.
    pub fn set_overrides_in(&mut self, overrides: OverrideSetting, queues: Queues) -> Option<u32> {
        self.decide(queues);
        if self.uncut.is_some() {
            return None;
        }
        let before = (self.now.clone(), self.overrides);
        let keep = self.cut(queues).filter(|&keep| self.now.rewind(keep));
        self.set_overrides(overrides);
        if keep.is_some() {
            (self.uncut, self.granted) = (Some(before), queues.cuts);
        }
        keep
    }

    /// [`Self::switch`] as soon as the queues of the board allow it. Returns the number of rows of the
    /// stretch behind which the board has to cut its queues. `None` if nothing has to be cut. If the
    /// board refuses the cut, the outputs change later.
    pub fn switch_in(&mut self, change: OutputChange, queues: Queues) -> Option<u32> {
        self.decide(queues);
        self.switch(change);
        let keep = self.cut(queues)?;
        let before = (self.now.clone(), self.overrides);
        if !self.now.rewind(keep) {
            return None;
        }
        (self.uncut, self.granted) = (Some(before), queues.cuts);
        Some(keep)
    }

    /// The number of rows of the stretch that a cut keeps; `None` if it would drop none. A host that
    /// was late for a cut keeps more with the next one.
    fn cut(&self, queues: Queues) -> Option<u32> {
        let kept = self.kept?.checked_shl(self.refused)?;
        let may = !self.is_held() && self.uncut.is_none() && queues.begun > 0;
        self.now.behind(queues.begun, kept).filter(|&keep| may && keep < queues.sent)
    }

    /// Notes that a cut was granted.
    fn decide(&mut self, queues: Queues) {
        if queues.cuts > self.granted && self.uncut.is_some() {
            (self.uncut, self.refused) = (None, 0);
        }
    }
}
