//! A source of segments that others change while the link reads it, in the same thread.

use carrystep_core::{OutputChange, Segment};
use carrystep_link::SegmentSource;
use std::cell::RefCell;

/// The source in a cell. It is borrowed only during a call.
pub(super) struct Shared<'a, S>(pub &'a RefCell<S>);

impl<S: SegmentSource> SegmentSource for Shared<'_, S> {
    fn segment(&mut self, axis: u8) -> Option<Segment> {
        self.0.borrow_mut().segment(axis)
    }

    fn outputs(&mut self) -> OutputChange {
        self.0.borrow_mut().outputs()
    }

    fn start(&mut self) -> Option<u8> {
        self.0.borrow_mut().start()
    }

    fn may_cut(&self) -> bool {
        self.0.borrow().may_cut()
    }

    fn cut_refused(&mut self) {
        self.0.borrow_mut().cut_refused();
    }
}
