//! Moves to integer segments that land exactly.
