//! Draws the four panels of the picture.
//!
//! The look may change freely.

use super::sampled::{Point, Sampled};
use super::{
    Area, Clock, GREY, GRID, INK, PictureError, colour, failed, label, number, px, right_label,
    stroke,
};
use crate::reference::length::Length;
use plotters::coord::ranged1d::{AsRangedCoord, ValueFormatter};
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

/// The quantity that a panel shows against time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Panel {
    Speed,
    Acceleration,
    Jerk,
    Delay,
}

type Chart<'a, 'b, Y> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, Y>>;

impl Panel {
    pub const ALL: [Self; 4] = [Self::Speed, Self::Acceleration, Self::Jerk, Self::Delay];

    fn caption(self, unit: Length) -> String {
        match self {
            Self::Speed => format!("speed, {unit}/s"),
            Self::Acceleration => format!("acceleration, {unit}/s\u{b2}"),
            Self::Jerk => format!("jerk, {unit}/s\u{b3}"),
            Self::Delay => "time from step to step, ms".to_owned(),
        }
    }

    fn note(self, sampled: &[Sampled]) -> &'static str {
        match self {
            Self::Speed if sampled.iter().any(|curve| curve.cruise.is_some()) => {
                "dashed: the cruise after the ramp"
            }
            Self::Jerk if sampled.iter().any(|curve| !curve.impulses.is_empty()) => {
                "arrows: impulses, where acceleration jumps"
            }
            Self::Delay => "logarithmic",
            _ => "",
        }
    }

    fn line(self, curve: &Sampled) -> &[Point] {
        match self {
            Self::Speed => &curve.speed,
            Self::Acceleration => &curve.acceleration,
            Self::Jerk => &curve.jerk,
            Self::Delay => &curve.delay,
        }
    }

    pub fn draw(
        self,
        area: &Area<'_>,
        sampled: &[Sampled],
        clock: &Clock,
        unit: Length,
    ) -> Result<(), PictureError> {
        let (caption, body) = area.margin(px(6), px(4), px(12), px(10)).split_vertically(px(24));
        caption
            .draw(&Text::new(self.caption(unit), (px(8), px(2)), label(16, INK)))
            .map_err(failed)?;
        let edge = caption.dim_in_pixel().0 as i32 - px(4);
        caption
            .draw(&Text::new(self.note(sampled), (edge, px(4)), right_label(13, GREY)))
            .map_err(failed)?;
        let ends = sampled
            .iter()
            .flat_map(|curve| curve.speed.last().into_iter().chain(curve.delay.last()));
        let span = 0.0..1.02 * clock.per_second * ends.map(|p| p.0).fold(0.0, f64::max);
        let mut builder = ChartBuilder::on(&body);
        builder.x_label_area_size(px(36)).y_label_area_size(px(84));
        let values = || sampled.iter().flat_map(|curve| self.line(curve)).map(|p| p.1);
        if self == Self::Delay {
            let (low, high) =
                values().fold((f64::INFINITY, 0.0_f64), |(a, b), v| (a.min(v), b.max(v)));
            let range = (0.8e3 * low..1.3e3 * high).log_scale();
            let mut chart = builder.build_cartesian_2d(span, range).map_err(failed)?;
            mesh(&mut chart, clock)?;
            let mut lines = sampled.iter().zip(widths(sampled.len()));
            return lines.try_for_each(|(curve, width)| delays(&mut chart, curve, width, clock));
        }
        let (low, high) = values().fold((0.0_f64, 0.0_f64), |(a, b), v| (a.min(v), b.max(v)));
        // A panel without any values but 0 gets a scale too.
        let (low, high) = if high > low { (low, high) } else { (-1.0, 1.0) };
        let room = 0.09 * (high - low);
        let bottom = if low < 0.0 { low - room } else { low - room / 4.0 };
        let mut chart = builder.build_cartesian_2d(span, bottom..high + room).map_err(failed)?;
        mesh(&mut chart, clock)?;
        for (curve, width) in sampled.iter().zip(widths(sampled.len())) {
            self.curve(&mut chart, curve, width, clock)?;
        }
        if self == Self::Jerk {
            impulses(&mut chart, sampled, clock, (low, high))?;
        }
        Ok(())
    }

    fn curve(
        self,
        chart: &mut Chart<'_, '_, RangedCoordf64>,
        curve: &Sampled,
        width: u32,
        clock: &Clock,
    ) -> Result<(), PictureError> {
        let style = stroke(colour(curve.kind), width);
        let scaled = |&(t, v): &Point| (t * clock.per_second, v);
        chart
            .draw_series(LineSeries::new(self.line(curve).iter().map(scaled), style))
            .map_err(failed)?;
        if let Some(cruise) = curve.cruise.filter(|_| self == Self::Speed) {
            let thin = stroke(colour(curve.kind), 10);
            chart
                .draw_series(DashedLineSeries::new(cruise.iter().map(scaled), px(4), px(4), thin))
                .map_err(failed)?;
        }
        Ok(())
    }
}

/// Line widths in tenths of a pixel, from wide to narrow, so that lines on top of each other stay
/// visible.
fn widths(lines: usize) -> impl Iterator<Item = u32> {
    (0..lines).rev().map(|under| 20 + 6 * under as u32)
}

/// Draws the grid, the labels and the name of the time axis.
fn mesh<Y>(chart: &mut Chart<'_, '_, Y>, clock: &Clock) -> Result<(), PictureError>
where
    Y: Ranged<ValueType = f64> + ValueFormatter<f64>,
    std::ops::Range<f64>: AsRangedCoord,
{
    chart
        .configure_mesh()
        .x_labels(8)
        .y_labels(6)
        .x_label_formatter(&|t| number(*t))
        .y_label_formatter(&|v| number(*v))
        .x_desc(format!("time, {}", clock.unit))
        .label_style(label(13, GREY))
        .axis_desc_style(label(13, GREY))
        .axis_style(stroke(GREY, 10))
        .bold_line_style(stroke(GRID, 10))
        .set_all_tick_mark_size(px(5))
        .light_line_style(TRANSPARENT)
        .draw()
        .map_err(failed)
}

/// Draws the line of the delays, and a dot for each of the first steps, which lie far apart.
fn delays<Y: Ranged<ValueType = f64>>(
    chart: &mut Chart<'_, '_, Y>,
    curve: &Sampled,
    width: u32,
    clock: &Clock,
) -> Result<(), PictureError> {
    let colour = colour(curve.kind);
    let points: Vec<Point> =
        curve.delay.iter().map(|&(t, c)| (t * clock.per_second, c * 1e3)).collect();
    let apart: Vec<Point> = points.iter().copied().take(12).collect();
    chart.draw_series(LineSeries::new(points, stroke(colour, width))).map_err(failed)?;
    chart
        .draw_series(apart.into_iter().map(|p| Circle::new(p, px(3), colour.filled())))
        .map_err(failed)?;
    Ok(())
}

/// Draws an arrow for each impulse. The greatest one reaches the edge of the panel.
fn impulses(
    chart: &mut Chart<'_, '_, RangedCoordf64>,
    sampled: &[Sampled],
    clock: &Clock,
    (low, high): (f64, f64),
) -> Result<(), PictureError> {
    let all = || {
        sampled
            .iter()
            .flat_map(|curve| curve.impulses.iter().map(|&(t, jump)| (curve.kind, t, jump)))
    };
    let greatest = all().map(|(_, _, jump)| jump.abs()).fold(0.0, f64::max);
    let reach = high.max(-low);
    for (kind, t, jump) in all() {
        let (x, share) = (t * clock.per_second, jump / greatest);
        let y = (reach * share).clamp(low.min(-0.2 * reach), high.max(0.2 * reach));
        let style = stroke(colour(kind), 20);
        chart.draw_series([PathElement::new(vec![(x, 0.0), (x, y)], style)]).map_err(failed)?;
        let size = share.abs().sqrt().max(0.6);
        let (half, length) = (f64::from(px(4)) * size, f64::from(px(9)) * size * share.signum());
        let (half, length) = (half as i32, length as i32);
        let head = Polygon::new(vec![(-half, length), (half, length), (0, 0)], style.filled());
        chart.draw_series([EmptyElement::at((x, y)) + head]).map_err(failed)?;
    }
    Ok(())
}
