//! The letters of G-code and their units.

use carrystep_gcode::AXIS_LETTERS;

/// The first letters, x, y and z, are in mm; the others are in degrees.
pub(crate) const LINEAR: usize = 3;

/// The unit of a letter: mm or degrees.
pub const fn unit(letter: usize) -> &'static str {
    if letter < LINEAR { "mm" } else { "deg" }
}

/// The number of the letter that an axis of this name moves.
pub(crate) fn letter_of(name: &str) -> Option<usize> {
    AXIS_LETTERS.iter().position(|letter| name == letter.to_string())
}
