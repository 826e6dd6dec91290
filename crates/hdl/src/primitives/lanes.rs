//! `Lanes<T, N>`: one of something for each of N axes; to kernels and Verilog an array.
//!
//! Only arrays of a fixed length have a `Default`, and every block needs one ([`crate::primitives::constant`]).

use rust_hdl::prelude::{Block, Logic, Probe};
use std::ops::{Deref, DerefMut};

/// N of a kind.
#[derive(Debug)]
pub struct Lanes<T, const N: usize>([T; N]);

impl<T, const N: usize> Lanes<T, N> {
    /// Each made for its axis.
    pub fn from_fn(make: impl FnMut(usize) -> T) -> Self {
        Self(std::array::from_fn(make))
    }
}

impl<T: Default, const N: usize> Default for Lanes<T, N> {
    fn default() -> Self {
        Self::from_fn(|_| T::default())
    }
}

impl<T, const N: usize> Deref for Lanes<T, N> {
    type Target = [T; N];
    #[inline]
    fn deref(&self) -> &[T; N] {
        &self.0
    }
}

impl<T, const N: usize> DerefMut for Lanes<T, N> {
    #[inline]
    fn deref_mut(&mut self) -> &mut [T; N] {
        &mut self.0
    }
}

impl<T: Logic, const N: usize> Logic for Lanes<T, N> {
    fn update(&mut self) {}
}

impl<T: Block, const N: usize> Block for Lanes<T, N> {
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
