//! The pull-ups that pins have before the FPGA is configured.

/// Level below which an LVTTL or LVCMOS33 input reads 0, mV.
const LOW_MILLIVOLTS: u32 = 800;

/// What a family's user pins are until the FPGA is configured. All are inputs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PullUps {
    /// Every pin has a weak pull-up.
    Always,
    /// Every pin has a pull-up if a pin of the FPGA is low.
    ChosenBy {
        /// Name of that pin.
        pin: &'static str,
        /// The strongest pull-up, where a data sheet could be read.
        strongest: Option<PullUp>,
    },
    /// No source was found.
    Unknown,
}

/// A pull-up, by a data sheet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PullUp {
    /// Greatest current into a pin at 0 V with a supply of 3.3 V, uA.
    pub most_ua: u32,
    /// The data sheet.
    pub source: &'static str,
}

impl PullUp {
    /// The greatest resistor to ground that keeps a pin low against it, in Ohm, rounded down to two
    /// digits.
    pub fn resistor_ohm(self) -> u32 {
        let exact = LOW_MILLIVOLTS * 1000 / self.most_ua.max(1);
        let digit = 10_u32.pow(exact.max(10).ilog10() - 1);
        exact / digit * digit
    }
}

#[cfg(test)]
mod tests {
    use super::PullUp;

    #[test]
    fn resistor_keeps_a_pin_low() {
        for (most_ua, ohm) in [(2350, 340), (1240, 640), (500, 1600), (0, 800_000), (80_000, 10)] {
            assert_eq!(PullUp { most_ua, source: "" }.resistor_ohm(), ohm);
        }
    }
}
