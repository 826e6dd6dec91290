//! Timing presets of stepper drivers, from `data/drivers.toml`. A new preset is a new table there.

use serde::Deserialize;
use std::collections::BTreeMap;
use std::sync::LazyLock;

const DATA: &str = include_str!("../data/drivers.toml");

/// Minimum times that a stepper driver requires at its STEP and DIR inputs, in ns.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Driver {
    /// STEP high time, ns.
    pub step_high_ns: u64,
    /// STEP low time, ns.
    pub step_low_ns: u64,
    /// Set-up time: DIR is stable before a rising edge of STEP, ns.
    pub dir_setup_ns: u64,
    /// Hold time: DIR is stable after a rising edge of STEP, ns.
    pub dir_hold_ns: u64,
    /// The source of the figures, or how they were measured.
    pub evidence: String,
}

/// All presets, by lower-case name.
pub fn drivers() -> &'static BTreeMap<String, Driver> {
    static DRIVERS: LazyLock<BTreeMap<String, Driver>> = LazyLock::new(|| {
        toml::from_str(DATA).unwrap_or_else(|error| unreachable!("data/drivers.toml: {error}"))
    });
    &DRIVERS
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_preset_has_lower_case_name_and_positive_times() {
        assert_eq!(drivers().len(), 8);
        for (name, driver) in drivers() {
            assert_eq!(name, &name.to_lowercase());
            assert!(driver.step_high_ns > 0 && driver.step_low_ns > 0, "{name}");
            assert!(driver.dir_setup_ns > 0 && driver.dir_hold_ns > 0, "{name}");
        }
    }
}
