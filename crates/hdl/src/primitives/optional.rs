//! `Optional<T>`: a part or a port that only some builds have. Kernels and Verilog see an array, of one
//! element or of none.
//!
//! A kernel loops over it: `for i in 0..self.latch_bank.len()`. Whether the element exists is no part of
//! the module's type, so the module is compiled once for both.

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

impl<T> Deref for Optional<T> {
    type Target = Vec<T>;
    #[inline]
    fn deref(&self) -> &Vec<T> {
        &self.0
    }
}

impl<T> DerefMut for Optional<T> {
    #[inline]
    fn deref_mut(&mut self) -> &mut Vec<T> {
        &mut self.0
    }
}

impl<T: Logic> Logic for Optional<T> {
    fn update(&mut self) {}
}

impl<T: Block> Block for Optional<T> {
    fn connect_all(&mut self) {
        self.0.connect_all();
    }
    #[inline]
    fn update_all(&mut self) {
        self.0.update_all();
    }
    #[inline]
    fn has_changed(&self) -> bool {
        self.0.has_changed()
    }
    fn accept(&self, name: &str, probe: &mut dyn Probe) {
        self.0.accept(name, probe);
    }
}
