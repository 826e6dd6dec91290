//! Measures the pin timing of one axis: the shortest high time, low time, set-up and hold in a
//! capture.

use crate::edge::{Pin, PinChange};
use serde::{Deserialize, Serialize};

/// The shortest times that a capture shows, in ps; `None` if a time has not occurred.
///
/// ```text
/// DIR  ____/^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^\_______
///          :<-setup->:<-- hold ->:
/// STEP ______________/^^^^^^^\________/^^^^^^\__________
///                    :< high >:< low >:
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Shortest {
    /// STEP high.
    pub step_high: Option<Stretch>,
    /// STEP low between two pulses.
    pub step_low: Option<Stretch>,
    /// DIR stable before a rising edge of STEP.
    pub dir_setup: Option<Stretch>,
    /// DIR stable after a rising edge of STEP.
    pub dir_hold: Option<Stretch>,
}

impl Shortest {
    fn each(&self) -> [Option<Stretch>; 4] {
        [self.step_high, self.step_low, self.dir_setup, self.dir_hold]
    }

    fn each_mut(&mut self) -> [&mut Option<Stretch>; 4] {
        let Self { step_high, step_low, dir_setup, dir_hold } = self;
        [step_high, step_low, dir_setup, dir_hold]
    }
}

/// A measured time, and the place at which it ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Stretch {
    /// Its length, ps.
    pub ps: u64,
    /// The pulse to which it belongs, counted from 1.
    pub pulse: u64,
    /// The time at which it ends, ps of the capture.
    pub end: u64,
}

/// Watches the two pins of one axis, from the start of a capture or from any time on.
///
/// A time whose beginning was not seen is not measured; the first end of each kind is kept, so that
/// [`append`](Self::append) measures it when the beginning is known.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct PinWatch {
    step: bool,
    /// The level of DIR, true for backward; `None` if it is not known yet.
    dir: Option<bool>,
    /// The levels before the first change.
    before: (bool, Option<bool>),
    pulses: u64,
    rise: Option<u64>,
    fall: Option<u64>,
    dir_change: Option<u64>,
    shortest: Shortest,
    /// Of each kind, the first end of a time whose beginning was not seen; its length is 0.
    ends: Shortest,
}

impl Default for PinWatch {
    /// Both pins are low.
    fn default() -> Self {
        Self::from_levels(false, Some(false))
    }
}

/// Measures a time that began at `from`. If that is not known, its end is kept with no length.
fn shorten(
    slot: &mut Option<Stretch>,
    ends: &mut Option<Stretch>,
    from: Option<u64>,
    (end, pulse): (u64, u64),
) {
    let Some(from) = from else {
        ends.get_or_insert(Stretch { ps: 0, pulse, end });
        return;
    };
    keep_shorter(slot, Stretch { ps: end.saturating_sub(from), pulse, end });
}

fn keep_shorter(slot: &mut Option<Stretch>, new: Stretch) {
    if slot.is_none_or(|old| new.ps < old.ps) {
        *slot = Some(new);
    }
}

impl PinWatch {
    /// Begins with these levels; that of DIR is `None` if it is not known.
    pub fn from_levels(step: bool, dir: Option<bool>) -> Self {
        let (shortest, ends) = (Shortest::default(), Shortest::default());
        let (before, pulses, rise, fall, dir_change) = ((step, dir), 0, None, None, None);
        Self { step, dir, before, pulses, rise, fall, dir_change, shortest, ends }
    }

    /// Sets the level of a pin at the start of the capture.
    pub fn initial(&mut self, pin: Pin, level: bool) {
        match pin {
            Pin::Step => (self.step, self.before.0) = (level, level),
            Pin::Dir => (self.dir, self.before.1) = (Some(level), Some(level)),
        }
    }

    /// Sets the level of DIR, if it is not known yet.
    pub fn assume_dir(&mut self, backward: impl FnOnce() -> bool) {
        if self.dir.is_none() {
            let level = backward();
            self.initial(Pin::Dir, level);
        }
    }

    /// Takes a change of either pin. Returns true for a rising edge of STEP.
    pub fn change(&mut self, change: PinChange) -> bool {
        let PinChange { ps, level, .. } = change;
        let Self { shortest, ends, rise, fall, dir_change, .. } = self;
        match (change.pin, level) {
            (Pin::Dir, _) if self.dir != Some(level) => {
                if self.dir.replace(level).is_none() {
                    self.before.1 = Some(!level);
                }
                let end = (ps, self.pulses);
                shorten(&mut shortest.dir_hold, &mut ends.dir_hold, *rise, end);
                *dir_change = Some(ps);
            }
            (Pin::Step, true) if !self.step => {
                self.step = true;
                self.pulses += 1;
                let end = (ps, self.pulses);
                shorten(&mut shortest.step_low, &mut ends.step_low, *fall, end);
                shorten(&mut shortest.dir_setup, &mut ends.dir_setup, *dir_change, end);
                *rise = Some(ps);
                return true;
            }
            (Pin::Step, false) if self.step => {
                self.step = false;
                // The width of a pulse that was high when the capture began is unknown.
                let end = (ps, self.pulses);
                shorten(&mut shortest.step_high, &mut ends.step_high, *rise, end);
                *fall = Some(ps);
            }
            _ => {}
        }
        false
    }

    /// A watch that begins as this one began.
    pub fn at_its_beginning(&self) -> Self {
        Self::from_levels(self.before.0, self.before.1)
    }

    /// Whether a watch that goes on where this one ends began with the right levels.
    pub fn leads_to(&self, later: &Self) -> bool {
        let (step, dir) = later.before;
        step == self.step && dir.is_none_or(|dir| self.dir == Some(dir))
    }

    /// Appends what a watch has seen that went on where this one ends.
    pub fn append(&mut self, later: &Self) {
        let before = self.pulses;
        let told = |stretch: Stretch| Stretch { pulse: stretch.pulse + before, ..stretch };
        let from = [self.rise, self.fall, self.dir_change, self.rise];
        let own = self.shortest.each_mut().into_iter().zip(self.ends.each_mut()).zip(from);
        let new = later.ends.each().into_iter().zip(later.shortest.each());
        for (((slot, ends), from), (end, new)) in own.zip(new) {
            if let Some(Stretch { pulse, end, .. }) = end.map(told) {
                shorten(slot, ends, from, (end, pulse));
            }
            if let Some(new) = new.map(told) {
                keep_shorter(slot, new);
            }
        }
        self.step = later.step;
        self.dir = later.dir.or(self.dir);
        self.pulses += later.pulses;
        self.rise = later.rise.or(self.rise);
        self.fall = later.fall.or(self.fall);
        self.dir_change = later.dir_change.or(self.dir_change);
    }

    /// The level of STEP.
    pub fn step(&self) -> bool {
        self.step
    }

    /// The level of DIR; true is backward.
    pub fn backward(&self) -> bool {
        self.dir.unwrap_or_default()
    }

    /// Number of rising edges of STEP so far.
    pub fn pulses(&self) -> u64 {
        self.pulses
    }

    /// The shortest times so far.
    pub fn shortest(&self) -> Shortest {
        self.shortest
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shortest_time_of_each_kind_is_kept() {
        let mut watch = PinWatch::default();
        let mut at = |ps, pin, level| watch.change(PinChange { ps, axis: 0, pin, level });
        assert!(!at(100, Pin::Dir, true));
        assert!(at(350, Pin::Step, true));
        at(400, Pin::Step, false);
        assert!(at(600, Pin::Step, true));
        at(640, Pin::Step, false);
        at(660, Pin::Dir, false);
        let Shortest { step_high, step_low, dir_setup, dir_hold } = watch.shortest();
        let lengths = [step_high, step_low, dir_setup, dir_hold]
            .map(|stretch| stretch.map(|s| (s.ps, s.pulse)));
        assert_eq!(lengths, [Some((40, 2)), Some((200, 2)), Some((250, 1)), Some((60, 2))]);
    }

    #[test]
    fn pulse_that_is_high_at_the_start_has_no_width() {
        let mut watch = PinWatch::default();
        watch.initial(Pin::Step, true);
        watch.change(PinChange { ps: 5, axis: 0, pin: Pin::Step, level: false });
        assert_eq!(watch.shortest().step_high, None);
        assert_eq!(watch.pulses(), 0);
    }
}
