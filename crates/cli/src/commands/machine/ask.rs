//! The questions of `carrystep machine new`: each is one line on standard error, and the answer is
//! read from standard input.

use super::axis::AxisKeys;
use super::{ClockSource, Wishes};
use crate::commands::boards;
use crate::failure::Failure;
use carrystep_files::BigDecimal;
use std::io::{BufRead as _, Write as _};

/// Asks for everything that the options leave open.
pub fn complete(wishes: &mut Wishes) -> Result<(), Failure> {
    if wishes.clock.is_none() {
        let answer = ask(
            "Board (see `carrystep boards`), or the FPGA's clock in MHz",
            Some("80"),
            |text| clock(text).map(|_| ()),
        )?;
        wishes.clock = clock(&answer).ok();
    }
    if wishes.limits.is_none() {
        let known = ["pair", "each", "one", "none"];
        let limits = ask(
            "Limit switches: pair (two an axis), each (one an axis), one (for all), none",
            Some("each"),
            |text| {
                if known.contains(&text) {
                    Ok(())
                } else {
                    Err(format!("one of {} is expected", known.join(", ")))
                }
            },
        )?;
        wishes.limits = Some(limits);
    }
    let new = wishes.axes.is_empty();
    if new {
        let names = ask("Names of the axes, with blanks between", Some("x y z"), |text| {
            if text.split_whitespace().count() > 0 {
                Ok(())
            } else {
                Err("a name is expected".to_owned())
            }
        })?;
        wishes.axes = names.split_whitespace().map(AxisKeys::named).collect();
    }
    wishes.axes.iter_mut().try_for_each(|axis| of_axis(axis, new))
}

/// Parses a board's name or a clock in MHz.
fn clock(text: &str) -> Result<ClockSource, String> {
    let hz = |mhz: BigDecimal| {
        let hz = mhz * BigDecimal::from(1_000_000);
        hz.is_integer().then(|| hz.normalized().to_plain_string().parse().ok()).flatten()
    };
    match carrystep_files::decimal::parse(text) {
        Some(mhz) => hz(mhz)
            .map(ClockSource::Hz)
            .ok_or_else(|| format!("{text} MHz is no whole number of Hz")),
        None => boards::find(text)
            .map(|board| ClockSource::Board(Box::new(board)))
            .map_err(|failure| failure.message()),
    }
}

fn of_axis(axis: &mut AxisKeys, new: bool) -> Result<(), Failure> {
    let name = axis.name.clone();
    if new {
        put(axis, "unit", &format!("Axis {name}: unit of length"), Some("mm"))?;
    }
    for (keys, _) in axis.missing() {
        for key in keys {
            let unit = axis.unit().to_owned();
            let (question, default) = match key {
                "lead" => (
                    format!(
                        "{unit} that one turn of the motor moves (belt: teeth x pitch; screw: lead)"
                    ),
                    None,
                ),
                "steps_per_rev" => ("full steps of a turn".to_owned(), Some("200")),
                "microsteps" => ("microsteps of the driver".to_owned(), Some("16")),
                "speed_limit" => (format!("greatest speed in {unit}/s, or as in 900/min"), None),
                "accel_limit" => (format!("greatest acceleration in {unit}/s^2"), None),
                _ => (
                    "driver (a4988, dm542, drv8825, tb6600, tmc2209, ...)".to_owned(),
                    Some("a4988"),
                ),
            };
            put(axis, key, &format!("Axis {name}: {question}"), default)?;
        }
    }
    Ok(())
}

/// Asks until the answer is valid for this key.
fn put(
    axis: &mut AxisKeys,
    key: &str,
    question: &str,
    default: Option<&str>,
) -> Result<(), Failure> {
    let mut done = axis.clone();
    ask(question, default, |text| {
        let mut trial = axis.clone();
        match text.strip_suffix("/min").filter(|_| key == "speed_limit") {
            Some(per_minute) => trial.set("speed_limit_per_min", per_minute.trim())?,
            None => trial.set(key, text.strip_suffix("/s").unwrap_or(text).trim())?,
        }
        done = trial;
        Ok(())
    })?;
    *axis = done;
    Ok(())
}

/// Asks one question. An empty answer selects the default; a refused answer repeats the question.
fn ask(
    question: &str,
    default: Option<&str>,
    mut take: impl FnMut(&str) -> Result<(), String>,
) -> Result<String, Failure> {
    loop {
        let shown = default.map_or_else(String::new, |default| format!(" [{default}]"));
        let mut out = std::io::stderr().lock();
        // If this write fails, the user sees no question and the answer will be missing.
        let _ = write!(out, "{question}{shown}: ").and_then(|()| out.flush());
        let mut line = String::new();
        let read = std::io::stdin().lock().read_line(&mut line);
        if !matches!(read, Ok(1..)) {
            let _ = writeln!(out);
            return Err(Failure::input(
                "the answers ended before the questions: nothing is written",
            ));
        }
        let answer = match (line.trim(), default) {
            ("", Some(default)) => default,
            (text, _) => text,
        };
        match take(answer) {
            Ok(()) => return Ok(answer.to_owned()),
            Err(why) => {
                let _ = writeln!(out, "  {why}");
            }
        }
    }
}
