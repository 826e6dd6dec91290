//! Waveforms in and out, the pulse-train checker and its pictures.
//!
//! Pin changes stream, in time order, from a simulator or a [`VcdReader`] into any number of
//! [`PinSink`]s: the [`Checker`], the [`VcdWriter`] or [`FstWriter`], the CSV, the plot.

mod axis_check;
mod checker;
mod csv_out;
mod edge;
mod error;
mod follow;
mod fst_out;
mod gtkw;
mod ideal;
mod line_check;
mod pins;
mod plot;
mod report;
mod signal_map;
mod speed_register;
mod spread;
mod thin;
mod vcd_in;
mod vcd_out;
mod vcd_own;
mod vcd_pins;
mod waves;

pub use axis_check::AxisSetup;
pub use checker::{Checker, Origin, Setup};
pub use csv_out::CsvWriter;
pub use edge::{Pin, PinChange, PinSink, Tee};
pub use error::{ReadError, TraceError};
pub use follow::{Follower, Pulse};
pub use fst_out::{FstFormat, FstWriter};
pub use gtkw::save_file;
pub use pins::{PinWatch, Shortest, Stretch};
pub use plot::{Plot, PlotAxis, PlotSetup};
pub use report::{AxisReport, OriginKind, Report};
pub use signal_map::SignalMap;
pub use vcd_in::{Played, VcdReader};
pub use vcd_out::{VcdFormat, VcdWriter};
pub use vcd_own::OwnCapture;
pub use vcd_pins::PinsVcd;
pub use waves::{AxisWaves, Format, WaveWriter, Waves};
