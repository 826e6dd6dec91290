//! Tests the profiles against the golden numbers of the literature (`tests/golden/*.json`, 20
//! digits), with a relative tolerance of 10^-12 unless a test says otherwise.

mod logistic;
mod sinusoid;
mod trapezoid;

use serde_json::Value;

/// The relative error that a few operations in f64 may accumulate.
const TIGHT: f64 = 1e-12;

/// One file of golden numbers.
struct Golden(Value);

impl Golden {
    fn read(name: &str) -> Self {
        let path = format!("{}/../../tests/golden/{name}.json", env!("CARGO_MANIFEST_DIR"));
        let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"));
        Self(serde_json::from_str(&text).unwrap())
    }

    /// The number at a JSON pointer. The file may contain it as a number or as a string.
    fn number(&self, pointer: &str) -> f64 {
        let value = self.0.pointer(pointer).unwrap_or_else(|| panic!("no {pointer}"));
        value.as_f64().unwrap_or_else(|| value.as_str().unwrap().parse().unwrap())
    }

    /// Asserts that `actual` is the number at `pointer`, within a relative `tolerance`.
    #[track_caller]
    fn check(&self, pointer: &str, actual: f64, tolerance: f64) {
        let golden = self.number(pointer);
        let error = (actual - golden).abs() / golden.abs().max(f64::MIN_POSITIVE);
        assert!(error <= tolerance, "{pointer}: {actual:?}, golden {golden:?}, off by {error:e}");
    }
}
