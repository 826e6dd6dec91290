//! What a run of the fast model tells while it goes on.

use carrystep_model::fast::{Edge, Edges};

/// Receives edges, and the outputs of every cycle in which anything other than the pins may have
/// changed.
pub trait Listener<O>: Edges {
    /// The outputs in this cycle. All edges up to this cycle have been reported.
    fn outputs(&mut self, cycle: u64, outputs: &O);
}

/// A listener for edges alone, which ignores the outputs.
pub struct EdgesOnly<E>(pub E);

impl<E: Edges> Edges for EdgesOnly<E> {
    fn edge(&mut self, edge: Edge) {
        self.0.edge(edge);
    }

    fn levels(&mut self, clock: u64, levels: u8) {
        self.0.levels(clock, levels);
    }

    fn duty(&mut self, clock: u64, duty: u16, level: bool) {
        self.0.duty(clock, duty, level);
    }

    fn pwm(&mut self, clock: u64, level: bool) {
        self.0.pwm(clock, level);
    }
}

impl<E: Edges, O> Listener<O> for EdgesOnly<E> {
    fn outputs(&mut self, _: u64, _: &O) {}
}
