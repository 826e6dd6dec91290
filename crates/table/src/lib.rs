//! Timer compare tables for microcontrollers, and the portable C player that plays them.
//!
//! A table holds one compare value for each entry of a speed ramp. Entry `i` gives the time that
//! the timer waits before the next pulse; the curves are functions of the step index. (The curves
//! over time are in `carrystep-profile`.) [`Table::new`] computes the compare values of a
//! [`TableRequest`], or returns a [`TableError`] that names a value that works. [`Table::header`]
//! writes the table as C, and [`PLAYER`] holds the C files that play it.
//!
//! ```
//! use carrystep_table::{Kind, Motor, Options, Pulses, Speed, Table, TableRequest};
//! use carrystep_table::{Timer, TimerMode};
//!
//! let request = TableRequest {
//!     timer: Timer::avr16(16_000_000, 64, TimerMode::Ctc),
//!     motor: Motor { step_angle_deg: 1.8, microsteps: 8 },
//!     start_frequency: 500.0,
//!     top_speed: Speed::Rpm(500.0),
//!     kind: Kind::Logistic { entries: 1000, steepness: 6.0, centre: None },
//!     pulses: Pulses::One,
//! };
//! let table = Table::new(request)?;
//! assert_eq!(table.compare()[0], 469); // 470 counts: in CTC mode a period is OCR + 1
//! assert!(table.header(&Options::new("ramp")?).contains("ramp_compare[1000]"));
//! # Ok::<(), carrystep_table::TableError>(())
//! ```

pub mod austin;
mod error;
mod figures;
mod groups;
mod header;
mod inverse_table;
pub mod logistic;
mod player;
mod request;
pub mod sine;
mod table;
mod timer;

pub use error::TableError;
pub use figures::TableFigures;
pub use groups::Group;
pub use header::Options;
pub use inverse_table::InverseTable;
pub use player::PLAYER;
pub use request::{Arithmetic, Kind, Motor, Pulses, Speed, TableRequest};
pub use table::Table;
pub use timer::{AVR_PRESCALERS, Timer, TimerMode, Width};
