//! Timing presets of stepper drivers, from `data/drivers.toml`.

use serde::Deserialize;
use std::collections::BTreeMap;
use std::sync::LazyLock;

const DATA: &str = include_str!("../data/drivers.toml");

/// What one driver asks of its STEP and DIR inputs, in ns.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Driver {
    /// STEP high, ns.
    pub step_ns: u64,
    /// STEP low, ns.
    pub gap_ns: u64,
    /// DIR stable before a rising STEP, ns.
    pub setup_ns: u64,
    /// DIR stable after a rising STEP, ns.
    pub hold_ns: u64,
    /// What the figures rest on.
    pub evidence: String,
}

/// All presets by lower-case name.
pub fn drivers() -> &'static BTreeMap<String, Driver> {
    static DRIVERS: LazyLock<BTreeMap<String, Driver>> =
        LazyLock::new(|| toml::from_str(DATA).unwrap_or_else(|error| unreachable!("data/drivers.toml: {error}")));
    &DRIVERS
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_preset_is_usable() {
        assert_eq!(drivers().len(), 8);
        for (name, driver) in drivers() {
            assert_eq!(name, &name.to_lowercase());
            assert!(driver.step_ns > 0 && driver.gap_ns > 0, "{name}");
            assert!(driver.setup_ns > 0 && driver.hold_ns > 0, "{name}");
        }
    }
}
