//! `PerAxis<T, N>`: an array with one element for each of N axes. Kernels and Verilog see an array.
//!
//! Rust-HDL requires a `Default` of every block, and the standard library implements `Default` only
//! for arrays of a fixed length ([`crate::primitives::constant`]). This type implements it for any
//! N.

use rust_hdl_core::prelude::{Block, Logic, Probe};
use std::ops::{Deref, DerefMut};

/// Makes a block of a type that wraps an array or a list of blocks: the elements, and nothing else.
macro_rules! elements {
    ([$($size:tt)*] $type:ty = $inner:ty) => {
        impl<T, $($size)*> Deref for $type {
            type Target = $inner;
            #[inline]
            fn deref(&self) -> &$inner {
                &self.0
            }
        }

        impl<T, $($size)*> DerefMut for $type {
            #[inline]
            fn deref_mut(&mut self) -> &mut $inner {
                &mut self.0
            }
        }

        impl<T: Logic, $($size)*> Logic for $type {
            fn update(&mut self) {}
        }

        impl<T: Block, $($size)*> Block for $type {
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
    };
}
pub(super) use elements;

/// An array of N elements of one type; element i belongs to axis i.
#[derive(Debug)]
pub struct PerAxis<T, const N: usize>([T; N]);

impl<T, const N: usize> PerAxis<T, N> {
    /// Makes each element by calling `make` with the number of its axis, 0 to N - 1.
    pub fn from_fn(make: impl FnMut(usize) -> T) -> Self {
        Self(std::array::from_fn(make))
    }
}

impl<T: Default, const N: usize> Default for PerAxis<T, N> {
    fn default() -> Self {
        Self::from_fn(|_| T::default())
    }
}

elements!([const N: usize] PerAxis<T, N> = [T; N]);

/// N elements, one for each adder, on the heap: a part of a large engine exists several times, and the
/// stack of a thread is small. Kernels and Verilog see an array. Its code is the same for every N.
#[derive(Debug)]
pub struct PerLane<T, const N: usize>(Vec<T>);

impl<T, const N: usize> PerLane<T, N> {
    /// Makes each element by calling `make` with its number, 0 to N - 1.
    pub fn from_fn(make: impl FnMut(usize) -> T) -> Self {
        Self((0..N).map(make).collect())
    }
}

impl<T: Default, const N: usize> Default for PerLane<T, N> {
    fn default() -> Self {
        Self(defaults(N))
    }
}

/// So many default elements. It is compiled once and not for each N.
#[inline(never)]
fn defaults<T: Default>(count: usize) -> Vec<T> {
    std::iter::repeat_with(T::default).take(count).collect()
}

elements!([const N: usize] PerLane<T, N> = Vec<T>);
