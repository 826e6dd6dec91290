//! The host's side of the link (docs/protocol.md). It is `no_std` and allocates no memory.
//!
//! ```text
//! Host      connect, open, enable, stream, stop, clear, home  blocking; uses a Line and a Clock
//!   Session   what to send next, what an answer means         without a line or a clock
//!     Window    unacknowledged writes, sent again from the first that is missing
//!     Singles   reads, OPEN and STOP, which belong to no sequence
//!     Feeder    the segments of a program, in the order in which the queues need them
//!   frame, slip   requests and answers as bytes
//! Line      a serial port (feature `serial`) or SPI (feature `spi`)
//! ```
//!
//! The directory `c/` holds the same library in C99; both pass the same tests.
#![no_std]

#[cfg(feature = "std")]
extern crate std;

pub mod command;
pub mod facts;
pub mod feeder;
pub mod frame;
pub mod host;
pub mod line;
pub mod pace;
#[rustfmt::skip]
pub mod registers;
pub mod session;
pub mod singles;
pub mod slip;
#[cfg(feature = "std")]
pub mod supply;
pub mod ticks;
pub mod travel;
pub mod window;

pub use command::{Command, CutSlots, OutputChange, Program, ProgramError, Segment, WideSegment};
pub use facts::{BuildFacts, GatewareMismatch};
pub use feeder::{Feeder, SegmentSource};
pub use frame::{Answer, Body, FrameError, Refusal, Request};
#[cfg(feature = "std")]
pub use host::random_session;
pub use host::{AxisHoming, Homed, Homing, HomingFault, HomingStage, Wiring};
pub use host::{AxisState, SeekSource, Snapshot};
pub use host::{Clock, Ended, Host, HostError, Moment, Patience, Progress, Queues, Status, Wish};
pub use line::{Exchanged, Line};
pub use pace::LinkPace;
pub use session::{Session, SessionLost, Timing, WriteError};
pub use ticks::{ClockComparison, ClockDifference, TickCount};

/// Name and text of each file of the C library. A project needs all of them; those of the time only
/// if it compares clocks.
pub const C_LIBRARY: [(&str, &str); 9] = [
    ("carrystep_registers.h", include_str!("../c/carrystep_registers.h")),
    ("carrystep_frame.h", include_str!("../c/carrystep_frame.h")),
    ("carrystep_frame.c", include_str!("../c/carrystep_frame.c")),
    ("carrystep_session.h", include_str!("../c/carrystep_session.h")),
    ("carrystep_session.c", include_str!("../c/carrystep_session.c")),
    ("carrystep_feeder.h", include_str!("../c/carrystep_feeder.h")),
    ("carrystep_feeder.c", include_str!("../c/carrystep_feeder.c")),
    ("carrystep_time.h", include_str!("../c/carrystep_time.h")),
    ("carrystep_time.c", include_str!("../c/carrystep_time.c")),
];
