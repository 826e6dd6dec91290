//! The dialect of Grbl 1.1, as senders speak it, without any input or output.
//!
//! ```text
//! bytes -> input    real-time characters at once, lines in their order, bytes that wait (Bf:)
//!       -> request  a line as G-code or as one of the `$` commands; what each state allows
//!       -> dialect  answers the commands that ask or set something, and tells what is left to do
//! state -> report   `<Idle|MPos:...>`, with the fields that come only now and then
//! ```
//!
//! Numbers and texts are those of the documentation of Grbl 1.1 (`doc/markdown` and `doc/csv` of
//! its repository). The crate knows no machine: whoever owns one gives its state, its settings and
//! its parameters, and does what [`Action`] says.
//!
//! No sequence of bytes makes the memory grow beyond [`INPUT_BOUND`] and a few words for each line
//! that waits.

mod code;
mod dialect;
mod input;
mod overrides;
mod parameters;
mod realtime;
mod report;
mod request;
mod settings;
mod state;

pub use code::{Alarm, ErrorCode};
pub use dialect::{Action, Dialect, HELP, Outcome, Restored, WELCOME, message};
pub use input::{INPUT_BOUND, Input, LONGEST_LINE, Line, RECEIVE_BUFFER};
pub use overrides::{OverrideStep, Overrides};
pub use parameters::{Parameters, ParserState, Probed};
pub use realtime::{Realtime, Received};
pub use report::{Accessories, Pins, Reporter, Seen};
pub use request::{Request, Restore};
pub use settings::{AxisSettings, HomingSettings, MachineSettings, Settings};
pub use state::{Door, State};
