//! A placed and routed iCE40 design, simulated with the delays that nextpnr computed: at the board's
//! clock no input of a register changes within its set-up or hold time, and every pin has the level
//! of the model in every clock; at a clock above the design's greatest, violations are seen.
//!
//! A test run covers a small design with every kind of cell. `cargo xtask long timing` covers the
//! iCEstick, from bytes on the line to pulses on the pins, and every single check of the small
//! design.

mod board;
mod delays;
mod small;
