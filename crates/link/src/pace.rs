//! How long the gateware takes for a frame from a UART.

use crate::frame::Body;

/// ENDs around a frame.
const ENDS: u64 = 2;

/// The pace of a gateware with a UART.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LinkPace {
    /// Clocks of a bit.
    bit: u64,
    /// Clocks of a tick.
    tick: u64,
}

impl LinkPace {
    /// The pace of a build with this clock (Hz) and tick (ns), at this baud rate (bits/s).
    ///
    /// ```
    /// use carrystep_link::{Body, LinkPace, OutputChange, Segment};
    /// let segment = Segment { ticks: 2000, v: 1, a: 0, j: 0, last: false };
    /// let frame = Body::Segment { axis: 0, segment, outputs: OutputChange::NONE };
    /// let clocks = |tick_ns| LinkPace::new(48_000_000, tick_ns, 3_000_000).clocks(&frame);
    /// assert_eq!([clocks(2000), clocks(20_000)], [7928, 19_160]);
    /// ```
    pub const fn new(clock_hz: u64, tick_ns: u64, baud: u32) -> Self {
        let baud = if baud == 0 { 1 } else { baud as u64 };
        let tick = clock_hz.saturating_mul(tick_ns) / 1_000_000_000;
        Self { bit: (clock_hz + baud / 2) / baud, tick }
    }

    /// Clocks for which the gateware is busy with a frame, at most (docs/protocol.md, "The time of
    /// a frame"): it processes the bytes, hands one word of a segment in a tick to the engine,
    /// waits for the engine's state of a whole tick, and sends the answer.
    pub const fn clocks(self, frame: &Body) -> u64 {
        let axes = match frame {
            Body::Cut(_) => 1,
            other => other.axes().count_ones() as u64,
        };
        let bytes = frame.bytes() as u64 + ENDS;
        1800 + 200 * self.bit + 40 * bytes + (10 * axes + 3) * self.tick
    }
}
