//! The units of a distance.

use strum::Display;

/// The unit of a distance. It is displayed as it is written after a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Display)]
pub enum Length {
    /// A step of the motor, which is one microstep.
    #[strum(to_string = "steps")]
    Step,
    /// A degree of the motor's shaft.
    #[strum(to_string = "degrees")]
    Degree,
    /// A turn of the motor's shaft.
    #[strum(to_string = "turns")]
    Turn,
    /// A millimetre of the part that the motor moves.
    #[strum(to_string = "mm")]
    Millimetre,
}
