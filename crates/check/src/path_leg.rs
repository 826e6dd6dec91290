//! A straight leg of a programmed path, and which part of it is near a place.

/// Number of letters: x, y, z in mm, then a, b, c in degrees.
pub(crate) const LETTERS: usize = 6;
/// Number of letters in mm, which come first.
pub(crate) const LINEAR: usize = 3;

/// A place, mm and degrees.
pub(crate) type Place = [f64; LETTERS];

/// A straight leg of a programmed path, from the end of the leg before it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathLeg {
    /// Its end: x, y, z in mm, a, b, c in degrees.
    pub to: [f64; LETTERS],
    /// How far the tool may be from the path, mm, Euclidean over x, y and z.
    pub tolerance_mm: f64,
    /// The same for each of a, b and c, degrees.
    pub tolerance_deg: f64,
    /// How far the leg itself may be from the path, mm: greater than 0 for a chord of an arc.
    pub off_mm: f64,
    /// Line of the program.
    pub line: u64,
}

/// A leg with its start and with what is near.
#[derive(Debug, Clone)]
pub(crate) struct Leg {
    pub from: Place,
    pub leg: PathLeg,
    /// How far the tool may be from this leg.
    pub near: Reach,
    /// How far the path between two places of the tool may be from the tool.
    pub far: Reach,
}

/// Distances around a place.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Reach {
    /// Euclidean over x, y, z, mm.
    pub linear: f64,
    /// For each of a, b, c, degrees.
    pub rotary: [f64; LETTERS - LINEAR],
}

impl Leg {
    /// The part of the leg, from 0 to 1, that is within these distances of a place.
    pub fn within(&self, place: &Place, reach: &Reach) -> Option<(f64, f64)> {
        let (mut low, mut high) = (0.0_f64, 1.0_f64);
        // |s + u d|^2 <= r^2 for the distance s at the start and the direction d.
        let (mut dd, mut sd, mut ss) = (0.0, 0.0, 0.0);
        for ((to, from), place) in self.leg.to.iter().zip(&self.from).zip(place).take(LINEAR) {
            let (d, s) = (to - from, from - place);
            dd += d * d;
            sd += s * d;
            ss += s * s;
        }
        let square = reach.linear * reach.linear;
        if dd > 0.0 {
            let root = sd * sd - dd * (ss - square);
            if root < 0.0 {
                return None;
            }
            let root = root.sqrt();
            low = low.max((-sd - root) / dd);
            high = high.min((-sd + root) / dd);
        } else if ss > square {
            return None;
        }
        for (k, most) in reach.rotary.iter().enumerate() {
            let i = LINEAR + k;
            let (d, s) = (self.leg.to[i] - self.from[i], self.from[i] - place[i]);
            if d == 0.0 {
                if s.abs() > *most {
                    return None;
                }
                continue;
            }
            let (a, b) = ((-most - s) / d, (most - s) / d);
            low = low.max(a.min(b));
            high = high.min(a.max(b));
        }
        (low <= high).then_some((low, high))
    }

    /// The least distance from a place to this part of the leg: over x, y and z in mm, and the
    /// greatest of a, b and c in degrees there.
    pub fn distance(&self, place: &Place, low: f64, high: f64) -> (f64, f64) {
        let (mut dd, mut sd) = (0.0, 0.0);
        let letters = if (0..LINEAR).any(|i| self.leg.to[i] != self.from[i]) {
            0..LINEAR
        } else {
            LINEAR..LETTERS
        };
        for i in letters {
            let (d, s) = (self.leg.to[i] - self.from[i], self.from[i] - place[i]);
            dd += d * d;
            sd += s * d;
        }
        let u = if dd > 0.0 { (-sd / dd).clamp(low, high) } else { low };
        let at = |i: usize| self.from[i] + u * (self.leg.to[i] - self.from[i]) - place[i];
        let linear = (0..LINEAR).map(|i| at(i) * at(i)).sum::<f64>().sqrt();
        let rotary = (LINEAR..LETTERS).map(|i| at(i).abs()).fold(0.0, f64::max);
        (linear + self.leg.off_mm, rotary)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn leg(from: Place, to: Place) -> Leg {
        let reach = Reach { linear: 1.0, rotary: [1.0; 3] };
        let leg = PathLeg { to, tolerance_mm: 0.0, tolerance_deg: 0.0, off_mm: 0.0, line: 1 };
        Leg { from, leg, near: reach, far: reach }
    }

    proptest! {
        #[test]
        fn part_of_a_leg_is_within_reach_and_the_rest_is_not(
            from in prop::array::uniform6(-2.0..2.0_f64),
            to in prop::array::uniform6(-2.0..2.0_f64),
            place in prop::array::uniform6(-2.0..2.0_f64),
            linear in 0.1..3.0_f64,
        ) {
            let leg = leg(from, to);
            let reach = Reach { linear, rotary: [1.5, 2.0, 2.5] };
            let found = leg.within(&place, &reach);
            for k in 0..=100 {
                let u = f64::from(k) / 100.0;
                let at = |i: usize| from[i] + u * (to[i] - from[i]) - place[i];
                let off = (0..3).map(|i| at(i) * at(i)).sum::<f64>().sqrt();
                let margin = (3..6).map(|i| at(i).abs() - reach.rotary[i - 3])
                    .fold(off - linear, f64::max);
                let inside = found.is_some_and(|(low, high)| (low..=high).contains(&u));
                prop_assert!(margin.abs() < 1e-9 || inside == (margin < 0.0), "{u} {margin} {found:?}");
            }
        }
    }
}
