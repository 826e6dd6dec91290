//! Where inside its tick a step falls, without a divider: add-only bisection.

/// Whether adding `v` to `p` passes a whole step: carry forward, no carry (borrow) backward.
pub const fn crosses(p: u64, v: i64) -> bool {
    let (_, carry) = p.overflowing_add(v.cast_unsigned());
    carry != (v < 0)
}

/// Phase (0 .. 2^bits - 1) of a tick that crosses, from the position and speed it began with.
///
/// Halve the tick `bits` times and keep each half that does not cross yet; what is kept is the time
/// before the edge. On the top 32 bits of both registers, as the gateware has it.
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
        if carry == (half < 0) {
            p = moved;
            q |= 1 << (bits - k);
        }
        k += 1;
    }
    q
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_in_mid_tick_has_the_middle_phase() {
        let v = 1 << 62; // a quarter step per tick
        let p = u64::MAX - (1 << 61); // just over half of that below the step
        assert!(crosses(p, v));
        assert_eq!(bisect(p, v, 4), 8);
        assert_eq!(bisect(p, v, 2), 2);
        assert_eq!(bisect(p, v, 0), 0);
    }

    #[test]
    fn backward_steps_where_the_borrow_is() {
        assert!(crosses(0, -1), "from zero, any move back steps at once");
        assert!(!crosses(1, -1));
        assert!(!crosses(u64::MAX, 0));
        assert!(crosses(u64::MAX, 1));
        assert_eq!(bisect(0, -(1 << 62), 4), 0);
    }
}
