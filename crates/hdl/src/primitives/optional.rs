//! `Optional<T>`: a part or a port that only some builds have. Kernels and Verilog see an array, of one
//! element or of none.
//!
//! A kernel loops over it: `for i in 0..self.latch_bank.len()`. Whether the element exists is no part of
//! the module's type, so the module is compiled once for both.

use super::per_axis::elements;
use rust_hdl_core::prelude::{Block, Logic, Probe};
use std::ops::{Deref, DerefMut};

/// One element, or none. By default it exists, so that a module's `hdl`, which is compiled for one
/// size (`primitives/compiled_once.rs`), contains the statements about it.
#[derive(Debug)]
pub struct Optional<T>(Vec<T>);

impl<T> Optional<T> {
    /// The element, if there is one.
    pub fn of(element: Option<T>) -> Self {
        Self(element.into_iter().collect())
    }
}

impl<T: Default> Optional<T> {
    /// A default element if `exists`, otherwise none.
    pub fn when(exists: bool) -> Self {
        Self::of(exists.then(T::default))
    }
}

impl<T: Default> Default for Optional<T> {
    fn default() -> Self {
        Self::when(true)
    }
}

elements!([] Optional<T> = Vec<T>);
