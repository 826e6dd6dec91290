//! Draws speed, acceleration, jerk and delay of several profiles against time, as an SVG.
//!
//! This file holds the page and its styles; `picture/panel.rs` draws the four panels, and
//! `picture/sampled.rs` computes the points. The look may change freely.

use crate::reference::curve::Reference;
use crate::reference::length::Length;
use carrystep_core::ProfileKind;
use panel::Panel;
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use sampled::Sampled;
use std::fmt::Display;
use thiserror::Error;

mod panel;
mod sampled;

type Area<'b> = DrawingArea<SVGBackend<'b>, Shift>;

/// Width and height of the picture, pixels. The drawing library accepts whole pixels only;
/// everything is therefore drawn larger by the factor `FINE`.
const SIZE: (u32, u32) = (1180, 860);
const FINE: u32 = 5;
const HEAD: u32 = 74;
const FONT: &str = "sans-serif";
const INK: RGBColor = RGBColor(38, 44, 52);
const GREY: RGBColor = RGBColor(110, 118, 128);
const GRID: RGBColor = RGBColor(228, 231, 235);

/// The unit in which speeds, accelerations and jerks are drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scale {
    /// The unit of length.
    pub unit: Length,
    /// Steps in one unit.
    pub steps: f64,
}

impl Scale {
    /// The scale that draws in steps.
    pub const STEPS: Self = Self { unit: Length::Step, steps: 1.0 };
}

/// The error of a drawing library that fails.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("cannot draw the plot: {0}")]
pub struct PictureError(String);

fn failed(error: impl Display) -> PictureError {
    PictureError(error.to_string())
}

/// Draws the profiles in one picture and returns the SVG text.
///
/// # Errors
/// A [`PictureError`] if the drawing library fails.
pub fn picture(references: &[Reference], scale: Scale) -> Result<String, PictureError> {
    let span = references.iter().map(|r| r.figures().seconds).fold(0.0, f64::max);
    let sampled: Vec<Sampled> =
        references.iter().map(|r| Sampled::new(r, span, scale.steps)).collect();
    let mut text = String::new();
    {
        let size = (SIZE.0 * FINE, SIZE.1 * FINE);
        let root = SVGBackend::with_string(&mut text, size).into_drawing_area();
        root.fill(&WHITE).map_err(failed)?;
        let (head, body) = root.split_vertically(HEAD * FINE);
        heading(&head, &title(references, scale), &sampled)?;
        let clock = Clock::for_span(span);
        let areas = body.margin(0, px(10), px(10), px(20)).split_evenly((2, 2));
        for (area, panel) in areas.iter().zip(Panel::ALL) {
            panel.draw(area, &sampled, &clock, scale.unit)?;
        }
        root.present().map_err(failed)?;
    }
    Ok(shown_small(&text))
}

/// Replaces the size of the drawing by the size of the picture.
fn shown_small(text: &str) -> String {
    let ((width, height), size) = (SIZE, |pixels: u32| pixels * FINE);
    let drawn = format!("width=\"{}\" height=\"{}\"", size(width), size(height));
    text.replacen(&drawn, &format!("width=\"{width}\" height=\"{height}\""), 1)
}

/// Converts pixels of the picture to pixels of the drawing.
fn px(pixels: i32) -> i32 {
    pixels * FINE.cast_signed()
}

/// The style of a line of `tenths` tenths of a pixel.
fn stroke(colour: impl Into<ShapeStyle>, tenths: u32) -> ShapeStyle {
    colour.into().stroke_width(tenths * FINE / 10)
}

/// The title: the distance or speed and the greatest acceleration of all profiles.
fn title(references: &[Reference], scale: Scale) -> String {
    let unit = scale.unit;
    let several = if references.len() == 1 { "" } else { "s" };
    let most = |of: fn(&Reference) -> f64| {
        number(references.iter().map(of).fold(0.0, f64::max) / scale.steps)
    };
    let acceleration = most(|r| r.figures().peak_acceleration);
    if references.iter().all(Reference::is_ramp) {
        let speed = most(|r| r.figures().top_speed);
        return format!("Ramp{several} to {speed} {unit}/s, at most {acceleration} {unit}/s\u{b2}");
    }
    let distance = most(|r| r.figures().steps);
    format!("Move{several} of {distance} {unit}, at most {acceleration} {unit}/s\u{b2}")
}

/// Draws the title, and below it the names of the profiles in their colours.
fn heading(area: &Area<'_>, title: &str, sampled: &[Sampled]) -> Result<(), PictureError> {
    area.draw(&Text::new(title.to_owned(), (px(28), px(14)), label(21, INK))).map_err(failed)?;
    for (index, curve) in (0..).zip(sampled) {
        let (x, y) = (28 + 188 * index, 58);
        let ends = vec![(px(x), px(y)), (px(x + 22), px(y))];
        area.draw(&PathElement::new(ends, stroke(colour(curve.kind), 40))).map_err(failed)?;
        area.draw(&Text::new(curve.legend.clone(), (px(x + 30), px(y - 9)), label(15, INK)))
            .map_err(failed)?;
    }
    Ok(())
}

/// The style of a text of `size` pixels.
fn label(size: u32, colour: RGBColor) -> TextStyle<'static> {
    (FONT, size * FINE).into_font().color(&colour)
}

/// The style of a text that ends at its position.
fn right_label(size: u32, colour: RGBColor) -> TextStyle<'static> {
    label(size, colour).pos(Pos::new(HPos::Right, VPos::Top))
}

/// The colours of the kinds, in their order; the last two are spare. They can be distinguished with
/// every kind of colour vision (Okabe and Ito).
const COLOURS: [RGBColor; 8] = [
    RGBColor(230, 159, 0),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(160, 60, 140),
    RGBColor(0, 114, 178),
    RGBColor(90, 98, 108),
    RGBColor(86, 180, 233),
    RGBColor(240, 228, 66),
];

const _: () = assert!(ProfileKind::ALL.len() <= COLOURS.len());

fn colour(kind: ProfileKind) -> RGBColor {
    COLOURS[kind as usize]
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

/// Formats a number: 12000 as 12 000, numbers from 10^6 on as 1.5e6, and small numbers with as many
/// digits as they need.
fn number(value: f64) -> String {
    let size = value.abs();
    if size >= 1e6 {
        let power = size.log10().floor();
        let mantissa = (value / 10_f64.powf(power) * 100.0).round() / 100.0;
        return format!("{mantissa}e{power}");
    }
    if size >= 1000.0 {
        let (thousands, rest) = ((size / 1000.0).floor(), size % 1000.0);
        return format!("{}{thousands}\u{2009}{rest:03.0}", if value < 0.0 { "-" } else { "" });
    }
    let digits = if size >= 1.0 || size == 0.0 { 2 } else { 2 - size.log10().floor() as usize };
    let text = format!("{value:.digits$}");
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}
