//! How far a board's queues reach ahead of the motion.

/// Eight successive rows of a planned program last at least so long, ms. A hold may add a shorter
/// row at its place of rest.
const EIGHT_ROWS_MS: u64 = 32;

/// The shortest horizon that is not reported with a warning, ms.
const COMFORTABLE_MS: u64 = 100;

/// How much motion is enough where a hold comes behind all that waits, ms: a longer one would be
/// safer for a late computer, and would make holds later.
const ENOUGH_MS: u64 = COMFORTABLE_MS;

/// How long the motion of a program goes on at least if the host sends nothing more.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Horizon {
    ms: u64,
}

impl Horizon {
    /// The horizon of a board whose queues hold so many segments of each axis, besides the one that
    /// runs.
    pub const fn of_queue(segments: u64) -> Self {
        Self { ms: segments.saturating_mul(EIGHT_ROWS_MS) / 8 }
    }

    /// The horizon of a board whose queues a hold can cut or not: if it cannot, the queues are not
    /// filled, because a hold comes behind what waits in them.
    pub const fn of_board(segments: u64, cuts: bool) -> Self {
        let Self { ms } = Self::of_queue(segments);
        if cuts || ms < ENOUGH_MS { Self { ms } } else { Self { ms: ENOUGH_MS } }
    }

    /// How long the waiting rows last at most before another one is sent, if a hold cannot cut the
    /// queues, ticks.
    pub const fn enough_ticks(tick_ns: u64) -> u64 {
        (ENOUGH_MS * 1_000_000).div_ceil(tick_ns)
    }

    /// The shortest time that the waiting segments last, ms.
    pub const fn ms(self) -> u64 {
        self.ms
    }

    /// Whether a host that is loaded may well be late.
    pub const fn is_short(self) -> bool {
        self.ms < COMFORTABLE_MS
    }
}

#[cfg(test)]
mod tests {
    use super::Horizon;

    #[test]
    fn queue_of_31_segments_is_comfortable() {
        let [short, long] = [7, 31].map(Horizon::of_queue);
        assert_eq!([short.ms(), long.ms()], [28, 124]);
        assert!(short.is_short() && !long.is_short());
    }

    #[test]
    fn without_cuts_deep_queues_are_not_filled() {
        let of = |segments, cuts| Horizon::of_board(segments, cuts).ms();
        assert_eq!([of(31, true), of(31, false), of(7, true), of(7, false)], [124, 100, 28, 28]);
        assert!(!Horizon::of_board(31, false).is_short());
    }
}
