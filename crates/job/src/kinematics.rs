//! How motors follow from letters: a linear map with whole coefficients.
//!
//! Because the map is linear, control points of motors are the maps of control points of letters,
//! and because its coefficients are whole numbers, exact targets stay exact.

use std::fmt;

/// The map from the coordinates of a program to those of the motors.
pub trait Kinematics: fmt::Debug {
    /// How many units motor `motor` moves when letter `letter` moves by one; both count from 0.
    fn coefficient(&self, motor: usize, letter: usize) -> i32;
}

/// Each letter has its motor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Cartesian;

impl Kinematics for Cartesian {
    fn coefficient(&self, motor: usize, letter: usize) -> i32 {
        i32::from(motor == letter)
    }
}

/// The first motor moves by x + y and the second one by x - y, as two crossed belts do (I. Moyer,
/// CoreXY, 2012). The other letters have their motors.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CoreXy;

impl Kinematics for CoreXy {
    fn coefficient(&self, motor: usize, letter: usize) -> i32 {
        match (motor, letter) {
            (0 | 1, 0) | (0, 1) => 1,
            (1, 1) => -1,
            (0 | 1, _) | (_, 0 | 1) => 0,
            _ => i32::from(motor == letter),
        }
    }
}
