//! Measures the pin timing of one axis: the shortest high time, low time, set-up and hold in a
//! capture.

use crate::edge::{Pin, PinChange};

/// The shortest times that a capture shows, in ps; `None` if a time has not occurred.
///
/// ```text
/// DIR  ____/^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^\_______
///          :<-setup->:<-- hold ->:
/// STEP ______________/^^^^^^^\________/^^^^^^\__________
///                    :< high >:< low >:
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
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

/// A measured time, and the place at which it ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Stretch {
    /// Its length, ps.
    pub ps: u64,
    /// The pulse to which it belongs, counted from 1.
    pub pulse: u64,
    /// The time at which it ends, ps of the capture.
    pub end: u64,
}

/// Watches the two pins of one axis.
#[derive(Debug, Clone, Default)]
pub struct PinWatch {
    step: bool,
    dir: bool,
    pulses: u64,
    rise: Option<u64>,
    fall: Option<u64>,
    dir_change: Option<u64>,
    shortest: Shortest,
}

fn shorten(slot: &mut Option<Stretch>, from: Option<u64>, end: u64, pulse: u64) {
    let Some(from) = from else { return };
    let ps = end.saturating_sub(from);
    if slot.is_none_or(|old| ps < old.ps) {
        *slot = Some(Stretch { ps, pulse, end });
    }
}

impl PinWatch {
    /// Sets the level of a pin at the start of the capture.
    pub fn initial(&mut self, pin: Pin, level: bool) {
        match pin {
            Pin::Step => self.step = level,
            Pin::Dir => self.dir = level,
        }
    }

    /// Takes a change of either pin. Returns true for a rising edge of STEP.
    pub fn change(&mut self, change: PinChange) -> bool {
        let PinChange { ps, level, .. } = change;
        match (change.pin, level) {
            (Pin::Dir, _) if level != self.dir => {
                self.dir = level;
                shorten(&mut self.shortest.dir_hold, self.rise, ps, self.pulses);
                self.dir_change = Some(ps);
            }
            (Pin::Step, true) if !self.step => {
                self.step = true;
                self.pulses += 1;
                shorten(&mut self.shortest.step_low, self.fall, ps, self.pulses);
                shorten(&mut self.shortest.dir_setup, self.dir_change, ps, self.pulses);
                self.rise = Some(ps);
                return true;
            }
            (Pin::Step, false) if self.step => {
                self.step = false;
                // The width of a pulse that was high when the capture began is unknown.
                shorten(&mut self.shortest.step_high, self.rise, ps, self.pulses);
                self.fall = Some(ps);
            }
            _ => {}
        }
        false
    }

    /// The level of STEP.
    pub fn step(&self) -> bool {
        self.step
    }

    /// The level of DIR; true is backward.
    pub fn backward(&self) -> bool {
        self.dir
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
