//! Reads and writes waveforms, checks pulse trains, and draws the result.
//!
//! A simulator or a [`VcdReader`] sends pin changes, in order of time, to any number of
//! [`PinSink`]s: the [`Checker`], those of [`vcd_writer`], [`fst_writer`] and [`csv_writer`], the
//! [`Plot`] and the [`ErrorCounter`]. [`check_beside`] is a checker that uses other cores.
//! [`PathChecker`] checks jobs, whose pulses follow a programmed path, and [`JobChecker`] checks a
//! capture of a job. The modules are private; the public items are listed below.

mod ahead;
mod axis_check;
mod beside;
mod checker;
mod csv_out;
mod due_pulses;
mod due_times;
mod edge;
mod error;
mod error_counts;
mod exact;
mod follow;
mod fst_body;
mod fst_out;
mod gtkw;
mod ideal;
mod job_check;
mod line_check;
mod origin;
mod output_check;
mod output_places;
mod output_times;
mod path_check;
mod path_follow;
mod path_leg;
mod path_report;
mod pins;
mod plot;
mod pulse_times;
mod pwm_check;
mod pwm_sink;
mod report;
mod signal_map;
mod sink_beside;
mod slices;
mod speed_register;
mod spread;
mod thin;
mod vcd_cut;
mod vcd_header;
mod vcd_in;
mod vcd_out;
mod vcd_own;
mod vcd_pins;
mod vcd_play;
mod view;
mod wave_format;
mod waves;
mod worst_lines;

pub use axis_check::AxisSetup;
pub use beside::check_beside;
pub use checker::{Checker, Part, Setup};
pub use csv_out::csv_writer;
pub use edge::{OutputPins, Pin, PinChange, PinSink, Tee};
pub use error::{ReadError, TraceError};
pub use error_counts::{ErrorCounter, ErrorCounts};
pub use follow::{Follower, Pulse};
pub use fst_out::fst_writer;
pub use gtkw::save_file;
pub use job_check::{JobChecker, JobOutputs, JobReport};
pub use origin::Origin;
pub use output_check::{DueChange, OutputCheck, OutputReport};
pub use output_places::{OutputMark, OutputMarks};
pub use output_times::OutputTimesReport;
pub use path_check::{PathAxis, PathChecker, PathSetup};
pub use path_leg::PathLeg;
pub use path_report::{PathAxisReport, PathReport};
pub use pins::{PinWatch, Shortest, Stretch};
pub use plot::{Plot, PlotAxis, PlotSetup};
pub use pulse_times::{PlannedRow, PlannedRows, PulseTimesReport};
pub use pwm_check::{PwmReport, PwmTiming};
pub use pwm_sink::PwmSink;
pub use report::{AxisReport, CheckReport, OriginKind};
pub use signal_map::SignalMap;
pub use sink_beside::sink_beside;
pub use slices::{Capture, Merged, Slice};
pub use vcd_in::VcdReader;
pub use vcd_out::vcd_writer;
pub use vcd_own::OwnCapture;
pub use vcd_pins::PinsVcd;
pub use vcd_play::Played;
pub use view::View;
pub use waves::{AxisWaves, Waves};
