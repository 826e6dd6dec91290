//! How many seconds each test took when it ran last.

use crate::shell::{self, TaskResult};
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// Binaries, and modules of binaries, that take long where nothing is remembered, with their seconds
/// on one core.
const KNOWN: [(&str, f64); 29] = [
    ("carrystep-cli::command_line", 600.0),
    ("carrystep-tests::rung_7_promises_are_proved", 320.0),
    ("carrystep-tests::rung_6_netlist_and_bitstream_equal_verilog", 180.0),
    ("carrystep-tests::rung_8_mutants_are_caught", 60.0),
    ("carrystep-tests::a_board_is_its_verilog", 150.0),
    ("carrystep-tests::rung_4_model_equals_rust_hdl", 80.0),
    ("carrystep-tests::rung_5_model_equals_verilog", 190.0),
    ("carrystep-tests::engine_fits_its_budget", 260.0),
    ("carrystep-virtual-board::virtual_board::bad_line", 40.0),
    ("carrystep-tools::boards", 60.0),
    ("carrystep-tests::rung_3_fast_model_equals_model", 45.0),
    ("carrystep-tests::engine_stops", 30.0),
    ("carrystep-tests::the_link_talks_as_its_page_says", 30.0),
    ("carrystep-virtual-board::virtual_board::c_library", 10.0),
    ("carrystep-virtual-board::virtual_board::talk", 5.0),
    ("carrystep-virtual-board::virtual_board::bus", 8.0),
    ("carrystep-cli::clusters", 30.0),
    ("carrystep-virtual-board::virtual_board::homing", 60.0),
    ("carrystep-tests::a_self_test_shows_every_pin", 120.0),
    ("carrystep-virtual-board::virtual_board::clocks", 30.0),
    ("carrystep-linuxcnc::component", 55.0),
    ("carrystep-runner::runner::runs_over_spi", 25.0),
    ("carrystep-virtual-board::virtual_board::corexy_homing", 35.0),
    ("carrystep-linuxcnc::spidev", 30.0),
    ("carrystep-linuxcnc::replay", 30.0),
    ("carrystep-runner::runner::holds_on_a_board", 25.0),
    ("carrystep-runner::runner::pulses_of_simulate", 25.0),
    ("carrystep-virtual-board::virtual_board::gantry_homing", 20.0),
    ("carrystep-runner::runner::late_hosts", 15.0),
];

/// The seconds for which a test is taken whose binary is in no list. A long binary with many tests
/// is then split even where nobody has added it to the list.
const UNKNOWN: f64 = 1.0;

/// Seconds of each test, by binary.
#[derive(Debug, Default)]
pub struct TestTimes(BTreeMap<String, BTreeMap<String, f64>>);

impl TestTimes {
    /// What the last runs left behind. A file that is not there or not understood is no memory.
    pub fn read(path: &Path) -> Self {
        let text = fs::read_to_string(path).unwrap_or_default();
        Self::parse(&text).unwrap_or_default()
    }

    fn parse(text: &str) -> Option<Self> {
        let all: Map<String, Value> = serde_json::from_str(text).ok()?;
        let tests = |tests: &Value| -> Option<BTreeMap<String, f64>> {
            tests
                .as_object()?
                .iter()
                .map(|(test, seconds)| Some((test.clone(), seconds.as_f64()?)))
                .collect()
        };
        all.iter().map(|(id, all)| Some((id.clone(), tests(all)?))).collect::<Option<_>>().map(Self)
    }

    /// Remembers what tests of a binary have taken.
    pub fn learn(&mut self, id: &str, seconds: &[(String, f64)]) {
        let tests = self.0.entry(id.to_owned()).or_default();
        tests.extend(seconds.iter().cloned());
    }

    /// Writes the file, whole or not at all.
    ///
    /// # Errors
    /// The system's.
    pub fn write(&self, path: &Path) -> TaskResult {
        let next = path.with_extension("new");
        fs::write(&next, format!("{:#}\n", json!(self.0)))
            .and_then(|()| fs::rename(&next, path))
            .map_err(|error| shell::cannot("write", path, &error))
    }

    /// The expected seconds of some tests of a binary, one for each.
    pub fn expect(&self, id: &str, tests: &[String]) -> Vec<f64> {
        let known = self.0.get(id);
        let expected = |test: &String| {
            let each = listed(id, test, tests).unwrap_or(UNKNOWN);
            // A test that is new among known ones is taken for a short one.
            known.map_or(each, |known| known.get(test).copied().unwrap_or(each.min(UNKNOWN)))
        };
        tests.iter().map(expected).collect()
    }
}

/// What [`KNOWN`] has for one of the tests of a binary: the seconds of its module, or else of the
/// binary, divided by their number of tests.
fn listed(id: &str, test: &str, tests: &[String]) -> Option<f64> {
    let seconds = |name: &str| KNOWN.iter().find(|(of, _)| *of == name).map(|(_, all)| *all);
    let of_module = module(test).and_then(|own| {
        let all = seconds(&format!("{id}::{own}"))?;
        Some((all, tests.iter().filter(|test| module(test) == Some(own)).count()))
    });
    let (all, count) = of_module.or_else(|| Some((seconds(id)?, tests.len())))?;
    Some(all / count as f64)
}

/// The module of a test, if it is in one.
fn module(test: &str) -> Option<&str> {
    test.split_once("::").map(|(module, _)| module)
}

#[cfg(test)]
mod tests {
    use super::{TestTimes, UNKNOWN};

    fn tests(names: &[&str]) -> Vec<String> {
        names.iter().map(|&name| name.to_owned()).collect()
    }

    #[test]
    fn what_is_learned_is_expected() {
        let mut memory = TestTimes::default();
        memory.learn("a", &[("x".to_owned(), 7.5)]);
        let text = serde_json::json!(memory.0).to_string();
        let memory = TestTimes::parse(&text).unwrap();
        assert_eq!(memory.expect("a", &tests(&["x"])), [7.5]);
        assert_eq!(memory.expect("a", &tests(&["x", "y"])), [7.5, UNKNOWN]);
    }

    #[test]
    fn known_binaries_are_long_without_memory() {
        let memory = TestTimes::default();
        assert_eq!(
            memory.expect("carrystep-virtual-board::virtual_board::bad_line", &tests(&["x", "y"])),
            [20.0; 2]
        );
        assert_eq!(memory.expect("unheard of", &tests(&["x", "y"])), [UNKNOWN; 2]);
    }

    #[test]
    fn a_damaged_memory_is_none() {
        for text in ["", "{", "[]", r#"{"a": 1}"#, r#"{"a": {"x": "long"}}"#] {
            assert!(TestTimes::parse(text).is_none(), "{text}");
        }
    }
}
