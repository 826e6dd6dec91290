//! The latches of a build together: their number, their polarities, and the checks of their pins and
//! looks.

use super::{
    EngineBuild, EngineError, Guard, Latch, LatchSource, LimitWiring, MAX_LATCHES, MAX_LOOKS,
};

impl Guard {
    /// Mask of the latches whose pins are active while they are low.
    pub const fn latches_low(&self) -> u8 {
        let (mut low, mut number) = (0, 0);
        while number < self.latches.len() {
            low |= (self.latches.as_slice()[number].low as u8) << number;
            number += 1;
        }
        low
    }
}

impl EngineBuild {
    /// True if the build has more latches than one, and therefore the ports of several latches.
    pub const fn has_several_latches(&self) -> bool {
        self.guard.latches.len() > 1
    }

    /// Checks the latches.
    pub(super) fn check_latches(&self) -> Result<(), EngineError> {
        let latches = &self.guard.latches;
        if latches.len() > MAX_LATCHES {
            return Err(EngineError::Latches(latches.len()));
        }
        for (number, &Latch { source, looks, .. }) in latches.iter().enumerate() {
            if !(1..=MAX_LOOKS).contains(&looks) {
                return Err(EngineError::Looks(looks));
            }
            if let LatchSource::Switch { row, axis } = source
                && !self.has_switch(row, axis)
            {
                return Err(EngineError::LatchSource { number, row, axis });
            }
        }
        Ok(())
    }

    /// True if the build has this switch, with a pin of its own.
    fn has_switch(&self, row: u8, axis: u8) -> bool {
        let exists = usize::from(axis) < self.axes();
        exists
            && match (row, self.guard.limits) {
                (0, LimitWiring::Pair | LimitWiring::Each) | (1, LimitWiring::Pair) => true,
                (0, LimitWiring::One) => axis == 0,
                (2 | 3, _) => self.guard.inputs[usize::from(row) - 2].exist >> axis & 1 == 1,
                _ => false,
            }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{AXES, Build, PinTiming, StartPhase, Timebase};
    use alloc::string::{String, ToString as _};
    use alloc::vec;

    fn refusal(latch: Latch, count: usize) -> String {
        let timebase = Timebase::new(48_000_000, 2000, 16).unwrap();
        let build = Build { timebase, phase: StartPhase::Half, pins: [PinTiming::SHORTEST; AXES] };
        let mut build = EngineBuild::minimal(&build, 1);
        build.guard.latches = vec![latch; count];
        build.check().unwrap_err().to_string()
    }

    #[test]
    fn error_names_the_latch() {
        let said = refusal(Latch::of_pin(false, 17), 1);
        assert!(said.starts_with("a latch of 17 looks"), "{said}");
        let said = refusal(Latch::of_pin(false, 1), 5);
        assert_eq!(said, "5 latches: an engine has at most 4");
        let source = LatchSource::Switch { row: 2, axis: 0 };
        let said = refusal(Latch { source, low: false, looks: 1 }, 2);
        assert_eq!(said, "latch 0 is connected to axis 0 of row 2, where the build has no switch");
    }
}
