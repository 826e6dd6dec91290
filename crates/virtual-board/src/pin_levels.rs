//! The levels of all pins that a board drives.

/// Levels of pins in a cycle. Right after configuration nothing is active and the line is high.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PinLevels {
    /// The STEP pins, a bit for each axis.
    pub step: u8,
    /// The DIR pins; 1 is backward.
    pub dir: u8,
    /// The outputs that programs switch, one bit each; 1 is active.
    pub outputs: u8,
    /// The pin of the PWM; true is active.
    pub pwm: bool,
    /// Whether the drivers are to have power.
    pub enabled: bool,
    /// The line to the host: TX, or MISO.
    pub line: bool,
}

impl Default for PinLevels {
    fn default() -> Self {
        Self { step: 0, dir: 0, outputs: 0, pwm: false, enabled: false, line: true }
    }
}

/// Calls a watcher once for each cycle in which levels have changed.
pub(crate) struct Changes<'a> {
    watch: &'a mut dyn FnMut(u64, PinLevels),
    told: PinLevels,
    /// The levels, as far as they are known, from this cycle on.
    now: (u64, PinLevels),
}

impl<'a> Changes<'a> {
    /// The levels before the first change.
    pub(crate) fn new(before: PinLevels, watch: &'a mut dyn FnMut(u64, PinLevels)) -> Self {
        Self { watch, told: before, now: (0, before) }
    }

    /// Levels change in this cycle. Calls must not go back in time.
    pub(crate) fn change(&mut self, cycle: u64, change: impl FnOnce(&mut PinLevels)) {
        if self.now.0 != cycle {
            self.tell();
        }
        self.now.0 = cycle;
        change(&mut self.now.1);
    }

    /// Returns the levels behind the last change.
    pub(crate) fn finish(mut self) -> PinLevels {
        self.tell();
        self.told
    }

    fn tell(&mut self) {
        let (cycle, levels) = self.now;
        if levels != self.told {
            (self.watch)(cycle, levels);
            self.told = levels;
        }
    }
}
