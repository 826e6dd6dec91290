//! Ramps in their own units: the time from 0 to 1 and the distance from 0 to 1.
//!
//! Two ramps of one shape are the same curve in these units, whatever their speed and acceleration.
//! A planner that has fitted one of them has fitted them all. A curve whose ramps differ only in
//! their units gives them in [`crate::Curve::own_ramp`]; `shaped.rs` makes the ramp of a shape.

/// A curve in its own units. Equal values are equal curves; floats are compared by their bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Shape {
    /// The sinusoidal ramp from rest.
    Sine,
    /// The logistic ramp from a jump to a fraction of its asymptote to 99.5 % of it.
    Logistic {
        /// The bits of -ln(fraction).
        start: u64,
    },
}

/// A ramp as its shape, its duration in seconds and its distance in steps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OwnRamp {
    /// The curve in its own units.
    pub shape: Shape,
    /// Duration, seconds, over 0.
    pub duration: f64,
    /// Distance, steps, over 0.
    pub distance: f64,
}
