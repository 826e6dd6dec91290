//! Polar coordinates: `@` is the distance from the origin of the program coordinates, `^` the angle
//! in degrees. With G91 both are added to those of the present place.

use crate::canon::Plane;
use crate::circle::Polar;
use crate::error::{ErrorKind, Fault};
use crate::motion::Mover;

impl Mover<'_> {
    /// Whether the line has `@` or `^`.
    pub(crate) fn has_polar_words(&self) -> bool {
        self.request.has(b'@') || self.request.has(b'^')
    }

    /// The polar words of the line, if there are any: the place that they give, and how far it is
    /// from the present one, which is zero with G90.
    pub(crate) fn polar_words(&mut self) -> Result<Option<(Polar, Polar)>, Fault> {
        let letter = if self.request.has(b'@') { b'@' } else { b'^' };
        let [radius, angle] = [b'@', b'^'].map(|letter| self.request.take(letter));
        if radius.is_none() && angle.is_none() {
            return Ok(None);
        }
        if self.request.has(b'x') || self.request.has(b'y') {
            return Err(self.request.fault(letter, ErrorKind::PolarAndAxes));
        }
        if self.state.modal.plane != Plane::Xy {
            return Err(self.request.fault(letter, ErrorKind::PolarPlane));
        }
        let [x, y, ..] = self.state.program;
        let incremental = self.state.modal.incremental;
        if x == 0.0 && y == 0.0 && (incremental || angle.is_none()) {
            return Err(self.request.fault(letter, ErrorKind::PolarOrigin));
        }
        let present = Polar { radius: x.hypot(y), angle: y.atan2(x).to_degrees() };
        let radius = radius.map(|radius| radius * self.state.unit());
        if incremental {
            let by = Polar { radius: radius.unwrap_or(0.0), angle: angle.unwrap_or(0.0) };
            let radius = present.radius + by.radius;
            return Ok(Some((Polar { radius, angle: present.angle + by.angle }, by)));
        }
        let radius = radius.unwrap_or(present.radius);
        let angle = angle.unwrap_or(present.angle);
        Ok(Some((Polar { radius, angle }, Polar { radius: 0.0, angle: 0.0 })))
    }
}
