//! Finds the phase of its tick in which a step falls, without a divider, by bisection with
//! additions only. The results must equal docs/clock-by-clock.md bit by bit.

/// True if adding `v` to `p` passes a whole step: the addition carries (forward) or borrows
/// (backward).
pub const fn crosses(p: u64, v: i64) -> bool {
    let (_, carry) = p.overflowing_add(v.cast_unsigned());
    carry != (v < 0)
}

/// Returns the phase (0 to 2^bits - 1) of a tick that crosses a step, from its initial `p` and `v`.
///
/// The function halves the tick `bits` times and keeps each half that does not yet cross the step.
/// The halves kept are the time before the edge, in units of 2^-bits tick. Like the gateware it
/// uses only the top 32 bits of both registers.
///
/// ```text
/// p |          kept: 1/4        crossing
///   |------|----:----|------------/-----|  q = 0100b of Q = 16
///   0     1/4       1/2                 1 tick
/// ```
pub const fn bisect(p: u64, v: i64, bits: u32) -> u32 {
    let mut p = (p >> 32) as u32;
    let v = (v >> 32) as i32;
    let mut q = 0;
    let mut k = 1;
    while k <= bits {
        let half = v >> k;
        let (moved, carry) = p.overflowing_add(half.cast_unsigned());
        let keep = carry == (half < 0);
        // Branch-free: the processor cannot predict which half crosses.
        p = if keep { moved } else { p };
        q = q << 1 | keep as u32;
        k += 1;
    }
    q
}

/// [`bisect`] for `N` ticks at once. The loops are arranged so that the compiler vectorizes them.
pub fn bisect_all<const N: usize>(p: &[u64; N], v: &[i64; N], bits: u32) -> [u32; N] {
    let (mut top_p, mut top_v, mut q) = ([0; N], [0; N], [0; N]);
    for i in 0..N {
        (top_p[i], top_v[i]) = ((p[i] >> 32) as u32, (v[i] >> 32) as i32);
    }
    for k in 1..=bits {
        for i in 0..N {
            let half = top_v[i] >> k;
            let moved = top_p[i].wrapping_add(half.cast_unsigned());
            let keep = (moved < top_p[i]) == (half < 0);
            top_p[i] = if keep { moved } else { top_p[i] };
            q[i] = q[i] << 1 | u32::from(keep);
        }
    }
    q
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn step_in_mid_tick_has_the_middle_phase() {
        let v = 1 << 62; // This is a quarter step per tick.
        let p = u64::MAX - (1 << 61); // This is just over half of that below the step.
        assert!(crosses(p, v));
        assert_eq!(bisect(p, v, 4), 8);
        assert_eq!(bisect(p, v, 2), 2);
        assert_eq!(bisect(p, v, 0), 0);
    }

    #[test]
    fn bisect_all_equals_bisect_for_each_tick() {
        let mut seed = 1_u64;
        let mut next = || {
            seed = seed
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            seed ^ seed >> 29
        };
        for _ in 0..1000 {
            let p: [u64; 16] = std::array::from_fn(|_| next());
            let v: [i64; 16] = std::array::from_fn(|_| next().cast_signed());
            for bits in [0, 2, 4] {
                assert_eq!(
                    bisect_all(&p, &v, bits),
                    std::array::from_fn(|i| bisect(p[i], v[i], bits))
                );
            }
        }
    }

    #[test]
    fn backward_addition_steps_if_it_borrows() {
        assert!(crosses(0, -1), "from zero, any move back steps at once");
        assert!(!crosses(1, -1));
        assert!(!crosses(u64::MAX, 0));
        assert!(crosses(u64::MAX, 1));
        assert_eq!(bisect(0, -(1 << 62), 4), 0);
    }
}
