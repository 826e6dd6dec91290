//! Compares two ways to compute ticks where edges are dense: one axis after the other, as the fast
//! model does, and all axes side by side.

use crate::stopwatch;
use carrystep_core::AXES;

/// Time for which each way is measured, seconds.
const BUDGET: f64 = 0.2;

/// Number of ticks of a run, so small that its edges stay in the cache.
const TICKS: usize = 4096;

/// The registers of all axes.
#[derive(Clone, Copy)]
struct Axes {
    p: [u64; AXES],
    v: [u64; AXES],
    a: [u64; AXES],
    j: [u64; AXES],
}

/// The ticks in which each axis steps, with the values of P and V before them. The last element is
/// room for one more entry.
struct Found {
    steps: Vec<[(u32, u64, u64); TICKS + 1]>,
    count: [usize; AXES],
}

/// The time per tick of all axes, ns: one axis after the other, and side by side.
pub fn measure() -> Result<[f64; 2], String> {
    // Each axis steps in about one tick of four, at a speed of its own that rises slowly.
    let speed = |axis: usize| (1 << 62) + ((axis as u64) << 57);
    let axes = Axes {
        p: [1 << 63; AXES],
        v: std::array::from_fn(speed),
        a: [1 << 44; AXES],
        j: [1 << 20; AXES],
    };
    let mut found =
        [(); 2].map(|()| Found { steps: vec![[(0, 0, 0); TICKS + 1]; AXES], count: [0; AXES] });
    let ns = |seconds: f64| seconds * 1e9 / TICKS as f64;
    let [after, beside] = &mut found;
    let times = [
        ns(stopwatch::least_of(BUDGET, 50, || after.one_after_the_other(axes))),
        ns(stopwatch::least_of(BUDGET, 50, || beside.side_by_side(axes))),
    ];
    let same = after.count == beside.count
        && (0..AXES).all(|axis| {
            after.steps[axis][..after.count[axis]] == beside.steps[axis][..beside.count[axis]]
        });
    if same {
        Ok(times)
    } else {
        Err("axes side by side do not step as they do one after the other".to_owned())
    }
}

impl Found {
    fn one_after_the_other(&mut self, axes: Axes) {
        for (axis, steps) in self.steps.iter_mut().enumerate() {
            let (mut p, mut v, mut a, j) = (axes.p[axis], axes.v[axis], axes.a[axis], axes.j[axis]);
            let mut count = 0;
            for tick in 0..TICKS {
                // There is no branch: an entry for a tick without a step is overwritten by the next
                // one.
                steps[count] = (tick as u32, p, v);
                let (next, carry) = p.overflowing_add(v);
                count += usize::from(carry);
                (p, v, a) = (next, v.wrapping_add(a), a.wrapping_add(j));
            }
            self.count[axis] = count;
        }
    }

    fn side_by_side(&mut self, mut axes: Axes) {
        let mut count = [0; AXES];
        for tick in 0..TICKS {
            let before = axes;
            for axis in 0..AXES {
                axes.p[axis] = before.p[axis].wrapping_add(before.v[axis]);
                axes.v[axis] = before.v[axis].wrapping_add(before.a[axis]);
                axes.a[axis] = before.a[axis].wrapping_add(before.j[axis]);
            }
            for (axis, steps) in self.steps.iter_mut().enumerate() {
                steps[count[axis]] = (tick as u32, before.p[axis], before.v[axis]);
                count[axis] += usize::from(axes.p[axis] < before.p[axis]);
            }
        }
        self.count = count;
    }
}
