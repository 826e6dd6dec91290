//! The arguments of `carrystep profile`. The docstrings of the fields are the command's help.

use carrystep_core::ProfileKind;
use carrystep_core::StartPhase;
use carrystep_profile::reference::{
    Drive, Length, Listing, Quantity, ReferenceDistance, ReferenceRequest,
};
use clap::Args;
use std::path::PathBuf;

/// The arguments of `carrystep profile`.
#[derive(Debug, Args)]
#[command(after_help = NOTES, next_help_heading = "Curve")]
pub struct ProfileArguments {
    /// The curves, one or several.
    #[arg(value_name = "KIND", required = true, value_parser = kind(), help_heading = None)]
    pub kinds: Vec<ProfileKind>,

    #[command(flatten)]
    distance: Distance,
    /// In exactly this time, seconds; default: as fast as the limits allow.
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true)]
    time: Option<f64>,
    /// Centre of a logistic ramp: half of its speed is reached after this time; default: the ramp
    /// is symmetric.
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true)]
    ti: Option<f64>,

    #[command(flatten)]
    speed: Speed,
    #[command(flatten)]
    start: StartSpeed,
    #[command(flatten)]
    acceleration: Acceleration,
    #[command(flatten)]
    jerk: Jerk,
    #[command(flatten)]
    motor: Motor,

    /// Write each step: n, t_n, speed, delay c_n. `-`: to standard output.
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    pub csv: Option<PathBuf>,
    /// Draw speed, acceleration, jerk and delay against time as SVG, all curves in one picture.
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    pub plot: Option<PathBuf>,
    /// One JSON document, with each step, instead of the table.
    #[arg(long, help_heading = "Output")]
    pub json: bool,
    /// Where in a step its pulse is: `zero` lists t_0, t_1 ... as the sources do, `half` the middle
    /// of each step, as the gateware emits by default.
    #[arg(long, value_name = "PHASE", default_value = "zero", value_parser = phase(), help_heading = "Output")]
    phase: StartPhase,
    /// Delays in counts of a timer with this clock, Hz, besides.
    #[arg(long, value_name = "HZ", allow_negative_numbers = true, help_heading = "Output")]
    timer_hz: Option<f64>,
}

const NOTES: &str = "\
A ramp goes from rest, or from the start speed, up to a speed; with a distance it is a whole move. The table tells what
one has to know before trusting a curve: start jump, end speed, peak acceleration and jerk, steps and time. Where
something moves (--travel-per-rev) it tells so in mm too. A step is one microstep. Which curve for what: docs/profiles.md.

Examples:
  The example of the logistic source:
    carrystep profile logistic --microsteps 2 --travel-per-rev 5 --speed-mm-min 1000 --accel-mm-s2 80 --ti 0.4
  Four ramps to one speed, in one picture:
    carrystep profile trapezoid scurve sine logistic --speed 50000 --accel 500000 --jerk 1.6e7 --plot four.svg
  One turn in one second, every step as CSV, delays in counts of a 1 MHz timer too:
    carrystep profile trapezoid --deg 360 --time 1 --accel-deg-s2 1800 --timer-hz 1e6 --csv -";

/// The distance of a move; without it the curve is a ramp.
#[derive(Debug, Args)]
#[group(multiple = false)]
struct Distance {
    /// A whole move of so many steps.
    #[arg(long, value_name = "N", allow_negative_numbers = true, help_heading = "Curve")]
    steps: Option<f64>,
    /// A whole move, millimetres.
    #[arg(long, value_name = "MM", allow_negative_numbers = true, help_heading = "Curve")]
    mm: Option<f64>,
    /// A whole move, degrees of the motor.
    #[arg(long, value_name = "DEG", allow_negative_numbers = true, help_heading = "Curve")]
    deg: Option<f64>,
}

/// The final speed of a ramp, or the speed limit of a move.
#[derive(Debug, Args)]
#[group(multiple = false)]
#[command(next_help_heading = "Speed: of a ramp the speed that it goes to, of a move the limit")]
struct Speed {
    /// Steps/s.
    #[arg(long, value_name = "V", allow_negative_numbers = true)]
    speed: Option<f64>,
    /// Turns of the motor a minute.
    #[arg(long, value_name = "V", allow_negative_numbers = true)]
    rpm: Option<f64>,
    /// mm/s.
    #[arg(long, value_name = "V", allow_negative_numbers = true)]
    speed_mm_s: Option<f64>,
    /// mm/min.
    #[arg(long, value_name = "V", allow_negative_numbers = true)]
    speed_mm_min: Option<f64>,
    /// Degrees/s.
    #[arg(long, value_name = "V", allow_negative_numbers = true)]
    speed_deg_s: Option<f64>,
}

/// The speed to which the motor can jump from rest.
#[derive(Debug, Args)]
#[group(multiple = false)]
#[command(next_help_heading = "Start speed: the jump from rest that the motor takes; default 0")]
struct StartSpeed {
    /// Steps/s.
    #[arg(long, value_name = "V", allow_negative_numbers = true)]
    start_speed: Option<f64>,
    /// Turns of the motor a minute.
    #[arg(long, value_name = "V", allow_negative_numbers = true)]
    start_rpm: Option<f64>,
    /// mm/s.
    #[arg(long, value_name = "V", allow_negative_numbers = true)]
    start_mm_s: Option<f64>,
}

/// The acceleration limit.
#[derive(Debug, Args)]
#[group(multiple = false)]
#[command(next_help_heading = "Acceleration: the limit")]
struct Acceleration {
    /// Steps/s^2.
    #[arg(long, value_name = "A", allow_negative_numbers = true)]
    accel: Option<f64>,
    /// mm/s^2.
    #[arg(long, value_name = "A", allow_negative_numbers = true)]
    accel_mm_s2: Option<f64>,
    /// Degrees/s^2.
    #[arg(long, value_name = "A", allow_negative_numbers = true)]
    accel_deg_s2: Option<f64>,
}

/// The jerk limit.
#[derive(Debug, Args)]
#[group(multiple = false)]
#[command(
    next_help_heading = "Jerk: the limit, of all curves but trapezoid and ranade; needed by scurve"
)]
struct Jerk {
    /// Steps/s^3.
    #[arg(long, value_name = "J", allow_negative_numbers = true)]
    jerk: Option<f64>,
    /// mm/s^3.
    #[arg(long, value_name = "J", allow_negative_numbers = true)]
    jerk_mm_s3: Option<f64>,
    /// Degrees/s^3.
    #[arg(long, value_name = "J", allow_negative_numbers = true)]
    jerk_deg_s3: Option<f64>,
}

/// The size of one step.
#[derive(Debug, Args)]
#[command(next_help_heading = "Motor: for all that is not in steps")]
struct Motor {
    /// Angle of a full step, degrees.
    #[arg(long, value_name = "DEG", default_value_t = 1.8, allow_negative_numbers = true)]
    step_angle: f64,
    /// Microsteps in a full step.
    #[arg(long, value_name = "M", default_value_t = 1)]
    microsteps: u32,
    /// Travel in one turn of the motor, mm.
    #[arg(long, value_name = "MM", allow_negative_numbers = true)]
    travel_per_rev: Option<f64>,
}

fn kind() -> impl clap::builder::TypedValueParser<Value = ProfileKind> {
    super::named()
}

fn phase() -> impl clap::builder::TypedValueParser<Value = StartPhase> {
    use clap::builder::{PossibleValuesParser, TypedValueParser};
    PossibleValuesParser::new(["zero", "half"])
        .map(|name| if name == "half" { StartPhase::Half } else { StartPhase::Zero })
}

/// The option that was given, with its unit; `None` if there is none.
fn given<const N: usize>(flags: [(Option<f64>, Length); N]) -> Option<Quantity> {
    flags.into_iter().find_map(|(value, length)| Some(Quantity::new(value?, length)))
}

impl ProfileArguments {
    /// The settings of the listing of each step.
    pub fn listing(&self) -> Listing {
        Listing { phase: self.phase, clock_hz: self.timer_hz }
    }

    /// The request that the options describe.
    pub fn request(&self) -> ReferenceRequest {
        use Length::{Degree, Millimetre, Step, Turn};
        let Self { distance, speed, start, acceleration, jerk, motor, .. } = self;
        let per_minute =
            |value: Option<f64>, length| Some(Quantity::new(value?, length).per_minute());
        let distance =
            given([(distance.steps, Step), (distance.mm, Millimetre), (distance.deg, Degree)]);
        let drive = Drive {
            step_angle_deg: motor.step_angle,
            microsteps: motor.microsteps,
            travel_per_rev_mm: motor.travel_per_rev,
        };
        let minutes = per_minute(speed.rpm, Turn).or(per_minute(speed.speed_mm_min, Millimetre));
        let seconds =
            [(speed.speed, Step), (speed.speed_mm_s, Millimetre), (speed.speed_deg_s, Degree)];
        let acceleration = [
            (acceleration.accel, Step),
            (acceleration.accel_mm_s2, Millimetre),
            (acceleration.accel_deg_s2, Degree),
        ];
        ReferenceRequest {
            time: self.time,
            centre: self.ti,
            speed: minutes.or(given(seconds)),
            start_speed: per_minute(start.start_rpm, Turn)
                .or(given([(start.start_speed, Step), (start.start_mm_s, Millimetre)])),
            acceleration: given(acceleration),
            jerk: given([
                (jerk.jerk, Step),
                (jerk.jerk_mm_s3, Millimetre),
                (jerk.jerk_deg_s3, Degree),
            ]),
            ..ReferenceRequest::new(
                drive,
                distance.map_or(ReferenceDistance::Ramp, ReferenceDistance::Move),
            )
        }
    }
}
