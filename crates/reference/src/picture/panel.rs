//! The four panels.

use super::sampled::{Point, Sampled};
use super::{Area, Clock, GREY, GRID, INK, PictureError, colour, failed, label, right_label};
use crate::quantity::Length;
use plotters::coord::ranged1d::{AsRangedCoord, ValueFormatter};
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

/// What a panel shows against time.
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
        let unit = unit.name();
        match self {
            Self::Speed => format!("speed, {unit}/s"),
            Self::Acceleration => format!("acceleration, {unit}/s\u{b2}"),
            Self::Jerk => format!("jerk, {unit}/s\u{b3}"),
            Self::Delay => "time from step to step, ms".to_owned(),
        }
    }

    fn note(self, sampled: &[Sampled]) -> &'static str {
        match self {
            Self::Speed if sampled.iter().any(|curve| curve.cruise.is_some()) => "dashed: the cruise after the ramp",
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

    pub fn draw(self, area: &Area<'_>, sampled: &[Sampled], clock: &Clock, unit: Length) -> Result<(), PictureError> {
        let (caption, body) = area.margin(6, 4, 12, 10).split_vertically(24);
        caption.draw(&Text::new(self.caption(unit), (8, 2), label(16, INK))).map_err(failed)?;
        let edge = caption.dim_in_pixel().0 as i32 - 4;
        caption.draw(&Text::new(self.note(sampled), (edge, 4), right_label(13, GREY))).map_err(failed)?;
        let ends = sampled.iter().flat_map(|curve| curve.speed.last().into_iter().chain(curve.delay.last()));
        let span = 0.0..1.02 * clock.per_second * ends.map(|p| p.0).fold(0.0, f64::max);
        let mut builder = ChartBuilder::on(&body);
        builder.x_label_area_size(36).y_label_area_size(84);
        let values = || sampled.iter().flat_map(|curve| self.line(curve)).map(|p| p.1);
        if self == Self::Delay {
            let (low, high) = values().fold((f64::INFINITY, 0.0_f64), |(a, b), v| (a.min(v), b.max(v)));
            let range = (0.8e3 * low..1.3e3 * high).log_scale();
            let mut chart = builder.build_cartesian_2d(span, range).map_err(failed)?;
            mesh(&mut chart, clock)?;
            return sampled.iter().try_for_each(|curve| delays(&mut chart, curve, clock));
        }
        let (low, high) = values().fold((0.0_f64, 0.0_f64), |(a, b), v| (a.min(v), b.max(v)));
        // Where jerk is nothing but impulses they still have a scale.
        let (low, high) = if self == Self::Jerk && high - low <= 0.0 { (-1.0, 1.0) } else { (low, high) };
        let room = 0.09 * (high - low).max(f64::MIN_POSITIVE);
        let bottom = if low < 0.0 { low - room } else { low - room / 4.0 };
        let mut chart = builder.build_cartesian_2d(span, bottom..high + room).map_err(failed)?;
        mesh(&mut chart, clock)?;
        for curve in sampled {
            self.curve(&mut chart, curve, clock)?;
            if self == Self::Jerk {
                impulses(&mut chart, curve, sampled, clock, (low, high))?;
            }
        }
        Ok(())
    }

    fn curve(
        self,
        chart: &mut Chart<'_, '_, RangedCoordf64>,
        curve: &Sampled,
        clock: &Clock,
    ) -> Result<(), PictureError> {
        let style = colour(curve.kind).stroke_width(2);
        let scaled = |&(t, v): &Point| (t * clock.per_second, v);
        chart.draw_series(LineSeries::new(self.line(curve).iter().map(scaled), style)).map_err(failed)?;
        if let Some(cruise) = curve.cruise.filter(|_| self == Self::Speed) {
            let thin = colour(curve.kind).mix(0.6).stroke_width(1);
            chart.draw_series(DashedLineSeries::new(cruise.iter().map(scaled), 4, 4, thin)).map_err(failed)?;
        }
        Ok(())
    }
}

/// Grid, labels and the name of the time axis.
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
        .axis_style(GREY.stroke_width(1))
        .bold_line_style(GRID)
        .light_line_style(TRANSPARENT)
        .draw()
        .map_err(failed)
}

/// A line, and a dot for each step where steps can be told apart.
fn delays<Y: Ranged<ValueType = f64>>(
    chart: &mut Chart<'_, '_, Y>,
    curve: &Sampled,
    clock: &Clock,
) -> Result<(), PictureError> {
    let colour = colour(curve.kind);
    let points: Vec<Point> = curve.delay.iter().map(|&(t, c)| (t * clock.per_second, c * 1e3)).collect();
    let apart: Vec<Point> = points.iter().copied().take(12).collect();
    chart.draw_series(LineSeries::new(points, colour.stroke_width(2))).map_err(failed)?;
    chart.draw_series(apart.into_iter().map(|p| Circle::new(p, 3, colour.filled()))).map_err(failed)?;
    Ok(())
}

/// An arrow for each impulse; the greatest reaches the edge of the panel.
fn impulses(
    chart: &mut Chart<'_, '_, RangedCoordf64>,
    curve: &Sampled,
    all: &[Sampled],
    clock: &Clock,
    (low, high): (f64, f64),
) -> Result<(), PictureError> {
    let greatest = all.iter().flat_map(|curve| &curve.impulses).map(|p| p.1.abs()).fold(0.0, f64::max);
    let reach = high.max(-low);
    for &(t, jump) in &curve.impulses {
        let (x, y) = (t * clock.per_second, reach * jump / greatest);
        let y = y.clamp(low.min(-0.2 * reach), high.max(0.2 * reach));
        let style = colour(curve.kind).stroke_width(2);
        chart.draw_series([PathElement::new(vec![(x, 0.0), (x, y)], style)]).map_err(failed)?;
        let (half, length) = (4, if jump > 0.0 { 9 } else { -9 });
        let head = Polygon::new(vec![(-half, length), (half, length), (0, 0)], style.filled());
        chart.draw_series([EmptyElement::at((x, y)) + head]).map_err(failed)?;
    }
    Ok(())
}

/// 12000 as 12 000; millions and over as 1.5e6; small numbers with what digits they need.
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
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}
