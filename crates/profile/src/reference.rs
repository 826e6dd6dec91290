//! Profiles in the units of their sources, with their step times, delays, figures and pictures.
//!
//! The curves are those of `carrystep-profile`. A [`ReferenceRequest`] gives the limits and the
//! distance in millimetres, degrees or turns of a [`Drive`], or in steps. It returns a
//! [`Reference`] for each [`ProfileKind`]. The modules are private; the public items are listed
//! below.
//!
//! ```
//! use carrystep_core::ProfileKind;
//! use carrystep_profile::reference::{Drive, Length, Listing, Quantity};
//! use carrystep_profile::reference::{ReferenceDistance, ReferenceRequest};
//!
//! // The example of the logistic source.
//! let drive = Drive { step_angle_deg: 1.8, microsteps: 2, travel_per_rev_mm: Some(5.0) };
//! let request = ReferenceRequest {
//!     speed: Some(Quantity::new(1000.0, Length::Millimetre).per_minute()),
//!     acceleration: Some(Quantity::new(80.0, Length::Millimetre)),
//!     centre: Some(0.4),
//!     ..ReferenceRequest::new(drive, ReferenceDistance::Ramp)
//! };
//! let logistic = request.reference(ProfileKind::Logistic)?;
//! assert_eq!(logistic.whole_steps(), 368.0);
//! let first = logistic.rows(&Listing::SOURCES)?.next().and_then(|row| row.delay_s);
//! assert!(first.is_some_and(|c0| (c0 - 0.181_171_021).abs() < 1e-9));
//! # Ok::<(), carrystep_profile::reference::ReferenceError>(())
//! ```

mod csv_out;
mod curve;
mod drive;
mod error;
mod length;
mod picture;
mod quantity;
mod request;
mod row;

pub use csv_out::{CsvError, write_csv};
pub use curve::Reference;
pub use drive::Drive;
pub use error::ReferenceError;
pub use length::Length;
pub use picture::{PictureError, Scale, picture};
pub use quantity::Quantity;
pub use request::{ReferenceDistance, ReferenceRequest};
pub use row::{Listing, MOST_ROWS, Row};
