//! How far a board's queues reach ahead of the motion.

/// Eight successive rows of a planned program last at least so long, ms. A hold may add a shorter
/// row at its place of rest.
const EIGHT_ROWS_MS: u64 = 32;

/// The shortest horizon that is not reported with a warning, ms.
const COMFORTABLE_MS: u64 = 100;

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
}
