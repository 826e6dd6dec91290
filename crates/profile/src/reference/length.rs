//! The units of a distance.

/// The unit of a distance.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Length {
    /// A step of the motor, which is one microstep.
    Step,
    /// A degree of the motor's shaft.
    Degree,
    /// A turn of the motor's shaft.
    Turn,
    /// A millimetre of the part that the motor moves.
    Millimetre,
}

impl Length {
    /// The name of the unit as it is written after a number.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Step => "steps",
            Self::Degree => "degrees",
            Self::Turn => "turns",
            Self::Millimetre => "mm",
        }
    }
}
