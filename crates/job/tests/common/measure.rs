//! Plans a program and compares its time with the references.

use super::reader;
use super::reference::{Limits, Sample, grbl, least_time};
use carrystep_files::Machine;
use carrystep_job::{Item, Planner, Row, rows};

/// Grbl's junction distance, mm.
const JUNCTION: f64 = 0.01;
/// Samples of each row for the lower bound.
const SAMPLES: u32 = 8;
/// Rows at both ends of a job that belong to its start and stop.
const STOPS: usize = 40;

/// Times of one program, seconds.
#[derive(Debug)]
pub struct Times {
    pub ours: f64,
    pub grbl: f64,
    pub rest_to_rest: f64,
    /// Our time without start and stop, and the least time of the same curve without a jerk limit.
    pub inner: f64,
    pub least: f64,
}

/// The rows of a program.
pub fn planned(machine: &Machine, items: &[Item]) -> Vec<Row> {
    let planner = Planner::new(machine, 3, &[0.0; 3]).unwrap();
    rows(planner, items.to_vec()).collect::<Result<_, _>>().unwrap()
}

/// Plans and compares. The tick is 1 us.
pub fn times(machine: &Machine, items: &[Item]) -> Times {
    let limits = limits(machine);
    let rows = planned(machine, items);
    let ticks: u64 = rows.iter().map(|row| u64::from(row.ticks)).sum();
    let inner = &rows[STOPS..rows.len() - STOPS];
    let samples = samples(machine, items, inner);
    let h = f64::from(inner[0].ticks) * 1e-6 / f64::from(SAMPLES);
    Times {
        ours: ticks as f64 * 1e-6,
        grbl: grbl(items, &limits, JUNCTION),
        rest_to_rest: grbl(items, &limits, 0.0),
        inner: (samples.len() - 1) as f64 * h,
        least: least_time(&samples, h, &limits),
    }
}

fn limits(machine: &Machine) -> Limits {
    let value = |x: &carrystep_files::BigDecimal| x.to_string().parse::<f64>().unwrap();
    let of = |limit: fn(&carrystep_files::Axis) -> &carrystep_files::BigDecimal| {
        machine.axes.iter().map(|axis| value(limit(axis)) / value(&axis.steps_per_unit)).collect()
    };
    Limits {
        speed: of(|axis| &axis.speed_limit.steps),
        acceleration: of(|axis| &axis.accel_limit.steps),
    }
}

/// The emitted curve: speeds and accelerations in mm and seconds, from the integers.
fn samples(machine: &Machine, items: &[Item], rows: &[Row]) -> Vec<Sample> {
    let per_unit: Vec<f64> =
        machine.axes.iter().map(|a| a.steps_per_unit.to_string().parse().unwrap()).collect();
    // The feed of each source line.
    let feed = |line: u64| {
        let of = |item: &Item| match item {
            Item::Move(element) if element.line == line => element.feed,
            _ => None,
        };
        items.iter().find_map(of).unwrap_or(f64::MAX)
    };
    let (mut line, mut known) = (0, f64::MAX);
    let mut samples = Vec::new();
    for row in rows {
        if row.line != line {
            (line, known) = (row.line, feed(row.line));
        }
        for k in 0..SAMPLES {
            let t = f64::from(row.ticks / SAMPLES * k);
            let derivatives = row.segments.iter().zip(&per_unit).map(|(s, per_unit)| {
                let unit = 2_f64.powi(-64) / per_unit;
                let (v, a, j) = (s.v as f64, s.a as f64, s.j as f64);
                // The continuous cubic through the ticks: A = a + j and V = v + a/2 + j/6.
                let (a, v) = (a - j, v - (a - j) / 2.0 - j / 6.0);
                ((v + a * t + j * t * t / 2.0) * unit * 1e6, (a + j * t) * unit * 1e12)
            });
            let (first, second) = derivatives.unzip();
            samples.push(Sample { first, second, feed: known });
        }
    }
    samples
}

/// A program of `sim/jobs/`, or of a path.
pub fn program(name: &str) -> Vec<Item> {
    let text = if name.starts_with('/') {
        std::fs::read_to_string(name).unwrap()
    } else {
        reader::file(name)
    };
    reader::read(&text)
}

/// The least multiple of the tolerance that the rows keep.
pub fn deviation(machine: &Machine, items: &[Item], rows: &[Row]) -> f64 {
    super::follow::deviation(machine, &programmed(machine, items), rows, &|motors| motors)
}

/// The path of a program, whose end is rounded to whole steps.
pub fn programmed(machine: &Machine, items: &[Item]) -> super::free_space::Programmed {
    let steps: Vec<f64> =
        machine.axes.iter().map(|a| a.steps_per_unit.to_string().parse().unwrap()).collect();
    let landed =
        |letters: &[f64]| letters.iter().zip(&steps).map(|(x, s)| (x * s).round() / s).collect();
    super::free_space::Programmed::new(&[0.0; 3], items, 3, landed)
}
