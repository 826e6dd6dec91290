//! The arguments of `carrystep table`. The docstrings of the fields are the command's help.

use carrystep_table::{
    AVR_PRESCALERS, Arithmetic, Kind, Motor, Options, Pulses, Speed, TableError, TimerMode,
};
use carrystep_table::{TableRequest, Timer, Width};
use clap::{Args, Subcommand};
use std::path::PathBuf;

/// The arguments of `carrystep table`.
#[derive(Debug, Args)]
#[command(after_help = NOTES)]
pub struct TableArguments {
    #[command(subcommand)]
    pub kind: TableKind,
}

/// The curve of the ramp.
#[derive(Debug, Subcommand)]
pub enum TableKind {
    /// Frequency logistic in the entry: the look-up method.
    #[command(after_help = LOGISTIC)]
    Logistic {
        /// Entries; with one pulse each, the steps of the ramp.
        #[arg(long, value_name = "N")]
        entries: u32,
        /// How steep the middle is: Fle, the source's "curve".
        #[arg(
            long,
            visible_alias = "fle",
            value_name = "FLE",
            default_value_t = 6.0,
            allow_negative_numbers = true
        )]
        steepness: f64,
        /// Entry at which half of the rise is done; default: half of the entries.
        #[arg(long, value_name = "ENTRY", allow_negative_numbers = true)]
        centre: Option<f64>,
        #[command(flatten)]
        common: Common,
    },
    /// Constant acceleration by the recurrence of Austin and Atmel's AVR446.
    #[command(after_help = AVR446)]
    Avr446 {
        /// Steps of the ramp.
        #[arg(long, value_name = "N")]
        ramp_steps: u32,
        /// float: rounded once; integer: as a controller computes it, remainders kept.
        #[arg(long, value_name = "HOW", default_value = "float", value_parser = ["float", "integer"])]
        arithmetic: String,
        #[command(flatten)]
        common: Common,
    },
    /// The S-curve whose acceleration is 1 - cos over time.
    #[command(after_help = SINE)]
    Sine {
        /// Steps of the ramp.
        #[arg(long, value_name = "N")]
        ramp_steps: u32,
        /// Put the small inverse table with this many intervals (256 is good) into the header too,
        /// for ramps that are computed on the controller.
        #[arg(long, value_name = "INTERVALS")]
        inverse: Option<u32>,
        #[command(flatten)]
        common: Common,
    },
}

const NOTES: &str = "\
Which kind for what, and how a controller plays it: docs/tables.md. Without --out the header goes to standard output.
Each kind has an example: carrystep table logistic --help";
const LOGISTIC: &str = "\
Example, the source's motor on a 16 MHz AVR:
  carrystep table logistic --entries 1000 --clock-hz 16000000 --start-frequency 500 --rpm 500 --microsteps 8 --out ramp";
const AVR446: &str = "\
Example, from rest to 10 000 steps/s in 500 steps, arrays in program memory:
  carrystep table avr446 --ramp-steps 500 --clock-hz 16000000 --prescaler 8 --top-speed 10000 --progmem --out ramp";
const SINE: &str = "\
Example, each entry lasting 1 ms or more, for a shorter table:
  carrystep table sine --ramp-steps 2000 --clock-hz 16000000 --prescaler 64 --top-speed 10000 --pulses-by-time 0.001";

/// The options that all kinds share.
#[derive(Debug, Args)]
pub struct Common {
    #[command(flatten)]
    timer: TimerFlags,
    #[command(flatten)]
    speeds: Speeds,
    #[command(flatten)]
    pulses: PulsesFlags,
    #[command(flatten)]
    pub output: OutputArguments,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Timer")]
struct TimerFlags {
    /// Clock in front of the prescaler, Hz.
    #[arg(long, value_name = "HZ")]
    clock_hz: u64,
    /// Clocks in a count.
    #[arg(long, value_name = "N", default_value_t = 1)]
    prescaler: u32,
    /// The prescalers that the timer has.
    #[arg(long, value_name = "N,N,...", value_delimiter = ',', default_values_t = AVR_PRESCALERS)]
    prescalers: Vec<u32>,
    /// Width of its counter.
    #[arg(long, value_name = "BITS", default_value = "16", value_parser = ["8", "16"])]
    bits: String,
    /// ctc: clear timer on compare; free-running: the interrupt adds the value to the compare
    /// register.
    #[arg(long, value_name = "MODE", default_value = "ctc", value_parser = ["ctc", "free-running"])]
    mode: String,
    /// Clocks that the interrupt needs from one pulse to the next; 0: not checked.
    #[arg(long, value_name = "CLOCKS", default_value_t = 0)]
    interrupt_clocks: u32,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Speeds")]
struct Speeds {
    /// Speed that the ramp rises from, steps/s; 0 is rest.
    #[arg(
        long,
        visible_alias = "start-speed",
        value_name = "HZ",
        default_value_t = 0.0,
        allow_negative_numbers = true
    )]
    start_frequency: f64,
    #[command(flatten)]
    top: Top,
    /// Angle of a full step, degrees: for rpm.
    #[arg(long, value_name = "DEG", default_value_t = 1.8, allow_negative_numbers = true)]
    step_angle: f64,
    /// Microsteps in a full step: for rpm. A step of the table is one microstep.
    #[arg(long, value_name = "M", default_value_t = 1)]
    microsteps: u32,
}

#[derive(Debug, Args)]
#[group(required = true, multiple = false)]
struct Top {
    /// Speed of the cruise, steps/s.
    #[arg(long, visible_alias = "speed", value_name = "HZ", allow_negative_numbers = true)]
    top_speed: Option<f64>,
    /// Speed of the cruise, turns of the motor a minute.
    #[arg(long, value_name = "RPM", allow_negative_numbers = true)]
    rpm: Option<f64>,
}

/// The number of pulses per entry; without either option it is one.
#[derive(Debug, Args)]
#[group(multiple = false)]
#[command(next_help_heading = "Pulses per entry: one, unless")]
struct PulsesFlags {
    /// In as many equal groups as there are numbers, so many pulses for each entry of a group.
    #[arg(long, value_name = "N,N,...", value_delimiter = ',')]
    pulses_by_group: Option<Vec<u32>>,
    /// As many pulses as it takes to last at least this long.
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true)]
    pulses_by_time: Option<f64>,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Output")]
pub struct OutputArguments {
    /// Folder for NAME.h and the player.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// What the names in the header begin with.
    #[arg(long, default_value = "ramp")]
    name: String,
    /// Keep the arrays in the program memory of an AVR (PROGMEM).
    #[arg(long)]
    progmem: bool,
    /// The bare array, without what the player needs.
    #[arg(long)]
    pub bare: bool,
    /// One JSON document instead of the header or the figures.
    #[arg(long)]
    pub json: bool,
}

impl OutputArguments {
    /// The settings of the header.
    pub fn options(&self) -> Result<Options, TableError> {
        Ok(Options::new(&self.name)?.program_memory(self.progmem).player(!self.bare))
    }
}

impl TableKind {
    /// The options that all kinds share.
    pub fn common(&self) -> &Common {
        match self {
            Self::Logistic { common, .. }
            | Self::Avr446 { common, .. }
            | Self::Sine { common, .. } => common,
        }
    }

    /// The request that the options describe.
    pub fn request(&self) -> TableRequest {
        let kind = match self {
            &Self::Logistic { entries, steepness, centre, .. } => {
                Kind::Logistic { entries, steepness, centre }
            }
            Self::Avr446 { ramp_steps, arithmetic, .. } => {
                let arithmetic =
                    if arithmetic == "integer" { Arithmetic::Integer } else { Arithmetic::Float };
                Kind::Avr446 { ramp_steps: *ramp_steps, arithmetic }
            }
            &Self::Sine { ramp_steps, inverse, .. } => Kind::Sine { ramp_steps, inverse },
        };
        let Common { timer, speeds, pulses, .. } = self.common();
        let timer = Timer {
            clock_hz: timer.clock_hz,
            prescaler: timer.prescaler,
            prescalers: timer.prescalers.clone(),
            width: if timer.bits == "8" { Width::Bits8 } else { Width::Bits16 },
            mode: if timer.mode == "ctc" { TimerMode::Ctc } else { TimerMode::FreeRunning },
            interrupt_clocks: timer.interrupt_clocks,
        };
        let motor = Motor { step_angle_deg: speeds.step_angle, microsteps: speeds.microsteps };
        let steps = || Speed::StepsPerSecond(speeds.top.top_speed.unwrap_or_default());
        let top_speed = speeds.top.rpm.map_or_else(steps, Speed::Rpm);
        let by_group = || pulses.pulses_by_group.clone().map_or(Pulses::One, Pulses::ByGroup);
        let pulses = pulses.pulses_by_time.map_or_else(by_group, Pulses::ByTime);
        TableRequest {
            timer,
            motor,
            start_frequency: speeds.start_frequency,
            top_speed,
            kind,
            pulses,
        }
    }
}
