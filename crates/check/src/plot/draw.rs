//! Draws the plot: a panel for each axis, with the speed above and the error below.
//!
//! The look may change freely.

use super::{Curves, Plot};
use crate::error::TraceError;
use crate::report::{AxisReport, CheckReport};
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::fmt::Display;

type Area<'b> = DrawingArea<SVGBackend<'b>, Shift>;

/// Size of a panel in pixels: of a single one, and of one among several.
const ALONE: (u32, u32) = (960, 560);
const PANEL: (u32, u32) = (560, 400);
const HEAD: u32 = 64;
const FONT: &str = "sans-serif";
const INK: RGBColor = RGBColor(38, 44, 52);
const GREY: RGBColor = RGBColor(110, 118, 128);
const GRID: RGBColor = RGBColor(228, 231, 235);
const SPEED: RGBColor = RGBColor(46, 134, 222);
const ERROR: RGBColor = RGBColor(22, 150, 110);
const BOUND: RGBColor = RGBColor(214, 69, 65);

fn failed(error: impl Display) -> TraceError {
    TraceError::Plot(error.to_string())
}

/// A unit of time that gives short labels.
struct Clock {
    per_second: f64,
    unit: &'static str,
}

impl Clock {
    fn for_span(span_s: f64) -> Self {
        let (per_second, unit) = match span_s {
            long if long >= 2.0 => (1.0, "s"),
            medium if medium >= 2e-3 => (1e3, "ms"),
            _ => (1e6, "us"),
        };
        Self { per_second, unit }
    }
}

pub(super) fn svg(plot: &Plot<'_>, report: &CheckReport) -> Result<String, TraceError> {
    let count = plot.axes.len().max(1);
    let columns = match count {
        1 => 1,
        2..=4 => 2,
        _ => 3,
    };
    let rows = count.div_ceil(columns);
    let (width, height) = if count == 1 { ALONE } else { PANEL };
    let size = (width * columns as u32, height * rows as u32 + HEAD);
    let mut text = String::new();
    {
        let root = SVGBackend::with_string(&mut text, size).into_drawing_area();
        root.fill(&WHITE).map_err(failed)?;
        let (head, body) = root.split_vertically(HEAD);
        heading(&head, plot, report)?;
        let clock = Clock::for_span(plot.span_s);
        for (area, (index, curves)) in
            body.split_evenly((rows, columns)).iter().zip(plot.axes.iter().enumerate())
        {
            panel(area, plot, curves, report.axes.get(index), &clock)?;
        }
        root.present().map_err(failed)?;
    }
    Ok(text)
}

fn label(size: u32, colour: RGBColor) -> TextStyle<'static> {
    (FONT, size).into_font().color(&colour)
}

fn heading(area: &Area<'_>, plot: &Plot<'_>, report: &CheckReport) -> Result<(), TraceError> {
    area.draw(&Text::new(plot.title.to_owned(), (24, 14), label(22, INK))).map_err(failed)?;
    let (verdict, colour) = if report.passed { ("passed", ERROR) } else { ("FAILED", BOUND) };
    let right = label(18, colour).pos(Pos::new(HPos::Right, VPos::Top));
    let edge = area.dim_in_pixel().0 as i32 - 24;
    area.draw(&Text::new(verdict, (edge, 16), right)).map_err(failed)?;
    // The legend is drawn once for all panels.
    let y = 50;
    let dot = |x, colour: RGBColor| Circle::new((x, y), 3, colour.filled());
    let dash = |from, to, style: ShapeStyle| PathElement::new(vec![(from, y), (to, y)], style);
    let word = |x, text: &'static str| Text::new(text, (x, y - 7), label(14, GREY));
    area.draw(&dot(30, SPEED)).map_err(failed)?;
    area.draw(&word(40, "speed of one period on the pins")).map_err(failed)?;
    area.draw(&dash(258, 282, INK.stroke_width(2))).map_err(failed)?;
    area.draw(&word(288, "profile")).map_err(failed)?;
    area.draw(&dot(352, ERROR)).map_err(failed)?;
    area.draw(&word(362, "edge less profile")).map_err(failed)?;
    for x in [486, 496, 506] {
        area.draw(&dash(x, x + 6, BOUND.stroke_width(2))).map_err(failed)?;
    }
    area.draw(&word(518, "bound")).map_err(failed)
}

fn panel(
    area: &Area<'_>,
    plot: &Plot<'_>,
    curves: &Curves<'_>,
    report: Option<&AxisReport>,
    clock: &Clock,
) -> Result<(), TraceError> {
    let (caption, charts) = area.margin(6, 2, 14, 16).split_vertically(26);
    let passed = report.is_none_or(|axis| axis.passed);
    caption
        .draw(&Text::new(
            curves.name.to_owned(),
            (8, 2),
            label(20, if passed { INK } else { BOUND }),
        ))
        .map_err(failed)?;
    let (above, below) = charts.split_vertically(charts.dim_in_pixel().1 * 58 / 100);
    let (metrics, below) = below.split_vertically(20);
    if let Some(axis) = report {
        let right = label(14, GREY).pos(Pos::new(HPos::Right, VPos::Top));
        let edge = caption.dim_in_pixel().0 as i32;
        caption.draw(&Text::new(summary(axis), (edge, 5), right.clone())).map_err(failed)?;
        metrics.draw(&Text::new(of_allowed(axis), (edge, 4), right)).map_err(failed)?;
    }
    speed(&above, plot, curves, clock)?;
    error(&below, plot, curves, report, clock)
}

fn summary(axis: &AxisReport) -> String {
    let pulses = format!("{} of {} pulses", axis.pulses_found, axis.pulses_expected);
    match (axis.error_min_ns, axis.error_max_ns) {
        // Adding zero turns minus zero into plus zero.
        (Some(least), Some(greatest)) => {
            let [least, greatest] = [least, greatest].map(|ns| (ns * 10.0).round() / 10.0 + 0.0);
            format!("{pulses}, error {least:.1} to {greatest:.1} ns")
        }
        _ => pulses,
    }
}

/// Jitter and ripple, each beside its allowed value.
fn of_allowed(axis: &AxisReport) -> String {
    let of = |found: Option<f64>, most: f64| {
        found.map_or("none".to_owned(), |x| format!("{x:.3} of {most:.3}"))
    };
    let [jitter_most, ripple_most] = allowed(axis);
    let jitter = of(axis.period_jitter_max_ns, jitter_most);
    let ripple = of(axis.speed_ripple_max_percent, ripple_most);
    format!("jitter {jitter} ns, speed ripple {ripple} %")
}

/// The greatest jitter, ns, and ripple, percent, of edges within their bound. In addition to the
/// phase grid and the curvature, a fit may shift both edges of a period by its tolerance, one early
/// and one late.
fn allowed(axis: &AxisReport) -> [f64; 2] {
    let jitter_ns = axis.period_jitter_theory_ns + 2.0 * axis.error_fit_ns;
    let phase_ns = axis.error_std_theory_ns * 12_f64.sqrt();
    let shortest_ns = 100.0 * phase_ns / axis.speed_ripple_theory_percent;
    [jitter_ns, 100.0 * jitter_ns / (shortest_ns - jitter_ns).max(0.0)]
}

/// A range around all values with some room; never empty.
fn roomy(values: impl Iterator<Item = f64>, least_room: f64) -> (f64, f64) {
    let (low, high) =
        values.filter(|v| v.is_finite()).fold((0.0_f64, 0.0_f64), |(a, b), v| (a.min(v), b.max(v)));
    let room = (0.08 * (high - low)).max(least_room);
    (if low < 0.0 { low - room } else { -room / 3.0 }, high + room)
}

fn speed(
    area: &Area<'_>,
    plot: &Plot<'_>,
    curves: &Curves<'_>,
    clock: &Clock,
) -> Result<(), TraceError> {
    let line = curves.line.points();
    let points: Vec<_> = curves.speed.points().collect();
    let (low, high) = roomy(line.iter().chain(&points).map(|p| p.1), 1.0);
    let span = plot.span_s * clock.per_second;
    let mut chart = ChartBuilder::on(area)
        .x_label_area_size(10)
        .y_label_area_size(76)
        .build_cartesian_2d(0.0..span, low..high)
        .map_err(failed)?;
    chart
        .configure_mesh()
        .x_labels(7)
        .y_labels(6)
        .x_label_formatter(&|_| String::new())
        .y_label_formatter(&|v| thousands(*v))
        .y_desc("steps/s")
        .label_style(label(13, GREY))
        .axis_desc_style(label(13, GREY))
        .axis_style(GREY.stroke_width(1))
        .bold_line_style(GRID)
        .light_line_style(TRANSPARENT)
        .draw()
        .map_err(failed)?;
    let scale = |(t, v): (f64, f64)| (t * clock.per_second, v);
    let dot = |p| Circle::new(scale(p), 2, SPEED.mix(0.55).filled());
    chart.draw_series(points.into_iter().map(dot)).map_err(failed)?;
    chart
        .draw_series(LineSeries::new(line.into_iter().map(scale), INK.stroke_width(1)))
        .map_err(failed)?;
    Ok(())
}

fn error(
    area: &Area<'_>,
    plot: &Plot<'_>,
    curves: &Curves<'_>,
    report: Option<&AxisReport>,
    clock: &Clock,
) -> Result<(), TraceError> {
    let bound = report.map(|axis| axis.error_bound_ns);
    let points: Vec<_> = curves.error.points().collect();
    let bounds = bound.into_iter().flat_map(|b| [-b, b]);
    let (low, high) = roomy(points.iter().map(|p| p.1).chain(bounds.clone()), 0.1);
    let span = plot.span_s * clock.per_second;
    let mut chart = ChartBuilder::on(area)
        .x_label_area_size(38)
        .y_label_area_size(76)
        .margin_top(8)
        .build_cartesian_2d(0.0..span, low..high)
        .map_err(failed)?;
    chart
        .configure_mesh()
        .x_labels(7)
        .y_labels(5)
        .x_label_formatter(&|t| thousands(*t))
        .y_label_formatter(&|v| thousands(*v))
        .x_desc(format!("time, {}", clock.unit))
        .y_desc("error, ns")
        .label_style(label(13, GREY))
        .axis_desc_style(label(13, GREY))
        .axis_style(GREY.stroke_width(1))
        .bold_line_style(GRID)
        .light_line_style(TRANSPARENT)
        .draw()
        .map_err(failed)?;
    let dot =
        |(t, v): (f64, f64)| Circle::new((t * clock.per_second, v), 2, ERROR.mix(0.55).filled());
    chart.draw_series(points.into_iter().map(dot)).map_err(failed)?;
    for level in bounds {
        let ends = [(0.0, level), (span, level)];
        chart
            .draw_series(DashedLineSeries::new(ends, 6, 4, BOUND.stroke_width(1)))
            .map_err(failed)?;
    }
    Ok(())
}

/// Formats a number: 12000 as 12 000, and small numbers with as many digits as they need.
fn thousands(value: f64) -> String {
    if value.abs() < 1000.0 {
        let rounded = (value * 100.0).round() / 100.0;
        return format!("{}", if rounded == 0.0 { 0.0 } else { rounded });
    }
    let digits = format!("{:.0}", value.abs());
    let mut text = String::new();
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            text.push('\u{2009}');
        }
        text.push(digit);
    }
    if value < 0.0 { format!("-{text}") } else { text }
}
