//! A board that programs which speak Grbl 1.1 drive.
//!
//! ```text
//! pty, http  the pseudo-terminal; HTTP, which is refused
//! clients    the connections: the first one drives, the others watch
//! desk       what is asked for, planned and left to do; it moves nothing
//! taking     the lines: answered, refused, or given to the plan
//! hearing    real-time characters, and the connections
//! shop       the board at rest: alarms, homing (home), when a batch begins
//! motion     a batch: stretches from rest to rest, with the holds and overrides of `run`
//! seeing     what status reports say
//! shown      settings, offsets and modes in the terms of Grbl; refusal: its errors
//! simulated  the board of `--virtual`; link: the symbolic link to the pseudo-terminal
//! ```

mod clients;
mod desk;
mod hearing;
mod home;
mod http;
mod link;
mod motion;
mod places;
mod pty;
mod refusal;
mod seeing;
mod shop;
mod shown;
mod simulated;
mod taking;

pub use clients::Clients;
pub use desk::Desk;
pub use link::Link;
pub use places::{find, lines};
pub use pty::Pty;
pub use shop::Shop;
pub use shown::settings;
pub use simulated::simulate;
