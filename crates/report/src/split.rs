//! Exact parts of segments, and segments of axes with ticks of their own as rows of common ticks.

use carrystep_core::Segment;

/// The part of a segment that begins `from` ticks after its start and is `ticks` long. It makes the
/// same V, A and J in each tick.
pub(crate) fn part(segment: &Segment, from: u32, ticks: u32) -> Segment {
    let k = i128::from(from);
    let (v, a, j) = (i128::from(segment.v), i128::from(segment.a), i128::from(segment.j));
    // Registers of the gateware hold all three values in each tick of the segment.
    Segment {
        ticks,
        v: (v + k * a + k * (k - 1) / 2 * j) as i64,
        a: (a + k * j) as i64,
        j: segment.j,
        last: segment.last && from + ticks == segment.ticks,
    }
}

/// Cuts the segments of axes at all their ends, so that each row has one segment for each axis and
/// all of a row have the same ticks. Where an axis has no more segments, it rests.
pub fn common_rows(axes: &[&[Segment]]) -> impl Iterator<Item = (u32, Vec<Segment>)> {
    // Of each axis, the number of the next segment and the ticks of it that are done.
    let mut at = vec![(0_usize, 0_u32); axes.len()];
    std::iter::from_fn(move || {
        let left = axes.iter().zip(&at).filter_map(|(segments, &(number, done))| {
            segments.get(number).map(|segment| segment.ticks - done)
        });
        let ticks = left.min()?;
        let row = axes.iter().zip(&mut at).map(|(segments, (number, done))| {
            let Some(segment) = segments.get(*number) else {
                return Segment { ticks, v: 0, a: 0, j: 0, last: false };
            };
            let now = part(segment, *done, ticks);
            *done += ticks;
            if *done == segment.ticks {
                (*number, *done) = (*number + 1, 0);
            }
            now
        });
        Some((ticks, row.collect()))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use carrystep_plan::exact::travel;
    use proptest::prelude::*;

    fn segment() -> impl Strategy<Value = Segment> {
        (1..1000_u32, -1000..1000_i64, -50..50_i64, -3..3_i64)
            .prop_map(|(ticks, v, a, j)| Segment { ticks, v, a, j, last: false })
    }

    proptest! {
        #[test]
        fn parts_make_the_same_distance(whole in segment(), at in 0..1000_u32) {
            let at = at % whole.ticks;
            let first = travel(&part(&whole, 0, at), at.into());
            let rest = part(&whole, at, whole.ticks - at);
            prop_assert_eq!(first + travel(&rest, rest.ticks.into()), travel(&whole, whole.ticks.into()));
        }

        #[test]
        fn rows_have_common_ticks_and_the_same_distances(
            axes in prop::collection::vec(prop::collection::vec(segment(), 0..5), 1..4),
        ) {
            let lists: Vec<&[Segment]> = axes.iter().map(Vec::as_slice).collect();
            let mut found = vec![0; axes.len()];
            let mut ticks = 0_u64;
            for (length, row) in common_rows(&lists) {
                ticks += u64::from(length);
                for (distance, segment) in found.iter_mut().zip(&row) {
                    prop_assert_eq!(segment.ticks, length);
                    *distance += travel(segment, length.into());
                }
            }
            let whole = |list: &Vec<Segment>| list.iter().map(|s| travel(s, s.ticks.into())).sum();
            prop_assert_eq!(found, axes.iter().map(whole).collect::<Vec<i128>>());
            let length = |list: &Vec<Segment>| list.iter().map(|s| u64::from(s.ticks)).sum::<u64>();
            prop_assert_eq!(ticks, axes.iter().map(length).max().unwrap());
        }
    }
}
