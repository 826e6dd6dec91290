//! Speed, acceleration, jerk and delay of several profiles against time, as an SVG.

use crate::kind::Kind;
use crate::quantity::Length;
use crate::reference::Reference;
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

const SIZE: (u32, u32) = (1180, 860);
const HEAD: u32 = 74;
const FONT: &str = "sans-serif";
const INK: RGBColor = RGBColor(38, 44, 52);
const GREY: RGBColor = RGBColor(110, 118, 128);
const GRID: RGBColor = RGBColor(228, 231, 235);

/// The unit that speeds, accelerations and jerks are drawn in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scale {
    /// Its name.
    pub unit: Length,
    /// Steps in one.
    pub steps: f64,
}

impl Scale {
    /// In steps.
    pub const STEPS: Self = Self { unit: Length::Step, steps: 1.0 };
}

/// The drawing library failed.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("cannot draw the plot: {0}")]
pub struct PictureError(String);

fn failed(error: impl Display) -> PictureError {
    PictureError(error.to_string())
}

/// Draws the profiles under `title`.
///
/// # Errors
/// The drawing library fails.
pub fn picture(title: &str, references: &[Reference], scale: Scale) -> Result<String, PictureError> {
    let span = references.iter().map(|r| r.figures().seconds).fold(0.0, f64::max);
    let sampled: Vec<Sampled> = references.iter().map(|r| Sampled::new(r, span, scale.steps)).collect();
    let mut text = String::new();
    {
        let root = SVGBackend::with_string(&mut text, SIZE).into_drawing_area();
        root.fill(&WHITE).map_err(failed)?;
        let (head, body) = root.split_vertically(HEAD);
        heading(&head, title, &sampled)?;
        let clock = Clock::for_span(span);
        let areas = body.margin(0, 10, 10, 20).split_evenly((2, 2));
        for (area, panel) in areas.iter().zip(Panel::ALL) {
            panel.draw(area, &sampled, &clock, scale.unit)?;
        }
        root.present().map_err(failed)?;
    }
    Ok(text)
}

/// Title, then the names in their colours.
fn heading(area: &Area<'_>, title: &str, sampled: &[Sampled]) -> Result<(), PictureError> {
    area.draw(&Text::new(title.to_owned(), (28, 16), label(21, INK))).map_err(failed)?;
    let place = |index: usize| 28 + 188 * index as i32;
    for (index, curve) in sampled.iter().enumerate() {
        let (x, y) = (place(index), 58);
        let colour = colour(curve.kind);
        area.draw(&PathElement::new(vec![(x, y), (x + 22, y)], colour.stroke_width(4))).map_err(failed)?;
        area.draw(&Text::new(curve.legend.clone(), (x + 30, y - 8), label(15, INK))).map_err(failed)?;
    }
    Ok(())
}

fn label(size: u32, colour: RGBColor) -> TextStyle<'static> {
    (FONT, size).into_font().color(&colour)
}

/// That ends at its place.
fn right_label(size: u32, colour: RGBColor) -> TextStyle<'static> {
    label(size, colour).pos(Pos::new(HPos::Right, VPos::Top))
}

/// Colours that differ for every eye (Okabe and Ito).
fn colour(kind: Kind) -> RGBColor {
    match kind {
        Kind::Trapezoid => RGBColor(213, 94, 0),
        Kind::Ranade => RGBColor(230, 159, 0),
        Kind::Scurve => RGBColor(0, 158, 115),
        Kind::Sine => RGBColor(0, 114, 178),
        Kind::Logistic => RGBColor(160, 60, 140),
        Kind::Constant => RGBColor(90, 98, 108),
    }
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
