//! Writes a table as a C header, from `templates/table.h`.
//!
//! Transcripts in tests/ quote the generated text.

use crate::error::TableError;
use crate::request::{Arithmetic, Kind, Pulses, Speed, TableRequest};
use crate::table::Table;
use crate::timer::TimerMode;
use minijinja::{Environment, context};
use std::fmt::Write;

const TEMPLATE: &str = include_str!("../templates/table.h");

/// The options of a header.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Options {
    name: String,
    program_memory: bool,
    player: bool,
}

impl Options {
    /// A header whose identifiers begin with `name`: a letter, then up to 47 letters, digits or
    /// underscores.
    ///
    /// # Errors
    /// [`TableError::Name`] if the name has another form.
    pub fn new(name: impl Into<String>) -> Result<Self, TableError> {
        let name = name.into();
        let body = name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
        if body && name.len() <= 48 && name.starts_with(|c: char| c.is_ascii_alphabetic()) {
            Ok(Self { name, program_memory: false, player: true })
        } else {
            Err(TableError::Name { name })
        }
    }

    /// Whether the arrays are placed in the program memory of an AVR (`PROGMEM`); off by default.
    #[must_use]
    pub fn program_memory(mut self, yes: bool) -> Self {
        self.program_memory = yes;
        self
    }

    /// Whether the header defines a `carrystep_table` for the player (the default), or only the
    /// array of compare values.
    #[must_use]
    pub fn player(mut self, yes: bool) -> Self {
        self.player = yes;
        self
    }

    /// The name with which the identifiers begin.
    pub fn name(&self) -> &str {
        &self.name
    }
}

impl Table {
    /// The text of the table as a C99 header. It needs no other file than the player's header.
    pub fn header(&self, options: &Options) -> String {
        let request = self.request();
        let figures = self.figures();
        let groups: Vec<(u16, u16)> =
            self.groups().iter().map(|group| (group.end, group.pulses)).collect();
        let text = context! {
            name => options.name(),
            upper => options.name.to_ascii_uppercase(),
            program_memory => options.program_memory,
            player => options.player,
            kind => request.kind.name(),
            curve => curve(request),
            speeds => speeds(request),
            timer => timer(request),
            pulses => pulses(request),
            ctc => request.timer.mode == TimerMode::Ctc,
            clock_hz => request.timer.clock_hz,
            prescaler => request.timer.prescaler,
            bits => request.timer.width.bits(),
            entries => self.compare().len(),
            ramp_pulses => figures.ramp_pulses,
            cruise => self.cruise(),
            groups => groups,
            compare => rows(self.compare()),
            inverse => self.inverse().map(rows),
            inverse_length => self.inverse().map_or(0, <[u16]>::len),
            real => format!(
                "ramp {:.6} s (formula {:.6} s), first {:.3} steps/s, top {:.3} steps/s ({:.3} rpm)",
                figures.ramp_seconds, figures.ramp_seconds_ideal, figures.first_speed, figures.top_speed, figures.top_rpm
            ),
            rounding => format!("{:.3}", 100.0 * figures.worst_speed_error),
            acceleration => format!("{:.0}", figures.peak_acceleration),
            bytes => figures.bytes,
        };
        let text = Environment::new().render_str(TEMPLATE, text);
        text.unwrap_or_else(|error| unreachable!("templates/table.h: {error}")) + "\n"
    }
}

fn curve(request: &TableRequest) -> String {
    match request.kind {
        Kind::Logistic { entries, steepness, centre } => {
            let centre = centre.unwrap_or(f64::from(entries) / 2.0);
            format!(
                "frequency logistic in the entry: {entries} entries, steepness (Fle) {steepness}, centre {centre}"
            )
        }
        Kind::Avr446 { ramp_steps, arithmetic } => {
            let arithmetic = match arithmetic {
                Arithmetic::Float => "float",
                Arithmetic::Integer => "integer, remainder kept",
            };
            format!(
                "constant acceleration by the recurrence of Austin and AVR446 ({arithmetic}): {ramp_steps} steps"
            )
        }
        Kind::Sine { ramp_steps, .. } => {
            format!("acceleration 1 - cos over time: {ramp_steps} steps")
        }
    }
}

fn speeds(request: &TableRequest) -> String {
    let motor = request.motor;
    let rpm = match request.top_speed {
        Speed::Rpm(rpm) => format!(
            " ({rpm} rpm at {} degrees, {} microsteps)",
            motor.step_angle_deg, motor.microsteps
        ),
        Speed::StepsPerSecond(_) => String::new(),
    };
    format!("from {} to {} steps/s{rpm}", request.start_frequency, request.top_frequency())
}

fn timer(request: &TableRequest) -> String {
    let timer = &request.timer;
    let mode = match timer.mode {
        TimerMode::Ctc => "clear on compare: a period is the value + 1",
        TimerMode::FreeRunning => "free-running: add the value to the compare register",
    };
    format!("{} bits, {} Hz / {}, {mode}", timer.width.bits(), timer.clock_hz, timer.prescaler)
}

fn pulses(request: &TableRequest) -> String {
    match &request.pulses {
        Pulses::One => "one".to_owned(),
        Pulses::ByGroup(groups) => format!("{} groups of entries", groups.len()),
        Pulses::ByTime(seconds) => format!("at least {seconds} s"),
    }
}

/// Formats the values, twelve on a line.
fn rows(values: &[u16]) -> String {
    let mut text = String::new();
    for row in values.chunks(12) {
        text.push_str("\n    ");
        for value in row {
            // Writing to a String cannot fail.
            let _ = write!(text, "{value:>5},");
        }
    }
    text
}
