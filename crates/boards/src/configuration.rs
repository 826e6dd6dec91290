//! Configuration pins: the functions that an FPGA itself gives to a pin while it loads its
//! bitstream. The tables of `data/packages.toml` list them for each package.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::LazyLock;
use strum::Display;

const DATA: &str = include_str!("../data/packages.toml");

/// How an FPGA loads its bitstream. JTAG is not listed, because it needs no user pin.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Display, JsonSchema, Serialize, Deserialize,
)]
#[serde(rename_all = "lowercase")]
pub enum ConfigurationMode {
    /// The pin has its function in every mode.
    #[strum(to_string = "every mode")]
    Any,
    /// Serially, from a PROM or a host.
    #[strum(to_string = "serial")]
    Serial,
    /// From an SPI flash.
    #[strum(to_string = "SPI")]
    Spi,
    /// By bytes: SelectMAP, or a parallel flash.
    #[strum(to_string = "parallel, 8 bits")]
    Parallel,
    /// The data lines beyond the first eight.
    #[strum(to_string = "parallel, over 8 bits")]
    Wide,
    /// The address lines of a parallel flash.
    #[strum(to_string = "addresses of a parallel flash")]
    Bpi,
}

/// The configuration pins of a package.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a [[package]] table")]
pub(super) struct Package {
    pub name: String,
    /// The parts to which this table applies in that package.
    pub parts: Vec<String>,
    /// Sources of the table.
    pub sources: Vec<String>,
    #[serde(default)]
    any: Functions,
    #[serde(default)]
    serial: Functions,
    #[serde(default)]
    spi: Functions,
    #[serde(default)]
    parallel: Functions,
    #[serde(default)]
    wide: Functions,
    #[serde(default)]
    bpi: Functions,
}

/// Functions, by pin.
type Functions = BTreeMap<String, String>;

impl Package {
    /// The function of a pin in each mode in which it has one.
    pub fn functions(&self, pin: &str) -> Vec<(ConfigurationMode, &str)> {
        let modes = [
            (ConfigurationMode::Any, &self.any),
            (ConfigurationMode::Serial, &self.serial),
            (ConfigurationMode::Spi, &self.spi),
            (ConfigurationMode::Parallel, &self.parallel),
            (ConfigurationMode::Wide, &self.wide),
            (ConfigurationMode::Bpi, &self.bpi),
        ];
        modes.into_iter().filter_map(|(mode, pins)| Some((mode, pins.get(pin)?.as_str()))).collect()
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Packages {
    package: Vec<Package>,
}

/// The tables that carrystep ships.
pub(super) fn packages() -> &'static [Package] {
    static PACKAGES: LazyLock<Vec<Package>> = LazyLock::new(|| {
        let read: Result<Packages, _> = toml::from_str(DATA);
        read.unwrap_or_else(|error| unreachable!("data/packages.toml: {error}")).package
    });
    &PACKAGES
}

/// A port on a configuration pin. The board's page lists all of them.
#[derive(Debug, Clone, PartialEq, Eq, JsonSchema, Serialize)]
pub struct Shared {
    /// The port, such as `step[0]`, or `the oscillator`.
    pub port: String,
    /// Pin of the package.
    pub pin: String,
    /// Function of the pin in configuration, such as `HSWAPEN`; several are separated by `/`.
    pub function: String,
    /// The modes in which the pin has this function.
    pub modes: Vec<ConfigurationMode>,
    /// Why this does no harm although the board is configured in one of these modes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub why: Option<String>,
}

/// An input that determines when some lines of the board may be driven.
///
/// The lines have high impedance until the input has been high for `wait_ns`, and become so again
/// as soon as it is low.
#[derive(Debug, Clone, PartialEq, Eq, JsonSchema, Serialize)]
pub struct Gate {
    /// Name of its port of the top level.
    pub port: String,
    /// Pin of the package.
    pub pin: String,
    /// Time for which the input must have been high, ns.
    pub wait_ns: u64,
    /// The outputs that wait for it.
    pub holds: Vec<String>,
    /// Purpose.
    pub why: String,
}

impl Gate {
    /// Width of a counter of this clock (Hz) whose highest bit is set after `wait_ns` or later.
    pub fn counter_bits(&self, clock_hz: u64) -> u32 {
        let clocks =
            (u128::from(self.wait_ns) * u128::from(clock_hz)).div_ceil(1_000_000_000).max(1);
        clocks.next_power_of_two().trailing_zeros() + 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gate_counter_runs_at_least_its_wait_time() {
        let gate = |wait_ns| Gate {
            port: "go".into(),
            pin: "P1".into(),
            wait_ns,
            holds: vec![],
            why: String::new(),
        };
        // The highest bit is set after 2^(bits - 1) clocks.
        for (wait_ns, clock_hz, bits) in
            [(400_000, 80_000_000, 16), (12_800, 80_000_000, 11), (12_801, 80_000_000, 12)]
        {
            assert_eq!(gate(wait_ns).counter_bits(clock_hz), bits, "{wait_ns} ns at {clock_hz} Hz");
        }
        assert_eq!(gate(0).counter_bits(80_000_000), 1);
    }

    #[test]
    fn every_package_table_has_pins_and_a_source() {
        assert!(packages().len() >= 11, "a table is gone");
        for (index, package) in packages().iter().enumerate() {
            let same = |other: &&Package| {
                other.name == package.name
                    && other.parts.iter().any(|part| package.parts.contains(part))
            };
            assert!(
                packages().iter().skip(index + 1).find(same).is_none(),
                "two tables: {}",
                package.name
            );
            assert!(!package.sources.is_empty() && !package.parts.is_empty(), "{}", package.name);
            assert!(!package.spi.is_empty() || !package.serial.is_empty(), "{}", package.name);
        }
        let mojo = packages().iter().find(|package| package.name == "tqg144").expect("a table");
        assert_eq!(mojo.functions("P144"), [(ConfigurationMode::Any, "HSWAPEN")]);
        assert_eq!(mojo.functions("P59"), [(ConfigurationMode::Wide, "D10")]);
        assert_eq!(mojo.functions("P8"), []);
    }
}
