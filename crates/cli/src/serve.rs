//! A board that programs which speak Grbl 1.1 drive.
//!
//! ```text
//! pty, http  the pseudo-terminal; HTTP, which is refused
//! client     one connection
//! clients    the connections: the first one drives, the others watch
//! real_time  real-time characters, and the connections
//! new_lines  the lines: answered, refused, or given to the plan
//! requests   what is asked for, planned and left to do; it moves nothing
//! server     the board at rest: alarms, homing (home), when a batch begins
//! accessories what is wanted of spindle and coolant beside the lines; switching: at rest
//! closed_limits lines toward a limit switch that is closed already
//! motion     a batch: stretches from rest to rest, with the holds and overrides of `run`
//! reports    what status reports say
//! web        the page, and the WebSockets of pages; pages: what they show and want
//! terms      settings, offsets and modes in the terms of Grbl; refusal: its errors
//! simulated  the board of `--virtual`; link: the symbolic link to the pseudo-terminal
//! ```

mod accessories;
mod client;
mod clients;
mod closed_limits;
mod home;
mod http;
mod link;
mod motion;
mod new_lines;
mod pages;
mod places;
mod probe;
mod pty;
mod real_time;
mod refusal;
mod reports;
mod requests;
mod server;
mod simulated;
mod switching;
mod terms;
mod web;

pub use accessories::Accessories;
pub use clients::Clients;
pub use link::Link;
pub use places::{find, lines};
pub use pty::Pty;
pub use requests::Requests;
pub use server::Server;
pub use simulated::simulate;
pub use terms::settings;
pub use web::Web;
