//! A step on its way from an accumulator to the pins.

/// A step: its direction, and the phase of the tick in which it falls.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Step {
    /// True if the step is in the negative direction.
    pub backward: bool,
    /// Phase of the tick, 0 to Q - 1.
    pub phase: u32,
}

/// A step between the accumulator and the pins. It advances by one stage per tick.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Stage {
    pub step: Option<Step>,
    pub sign: i8,
}

impl Stage {
    /// True if the stage holds neither a step nor a direction.
    pub(crate) const fn is_empty(&self) -> bool {
        self.step.is_none() && self.sign == 0
    }
}
