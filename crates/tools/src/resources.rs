//! The resources of the engine: the rows of `hdl-out/resources.md` as data, with their budgets.
//!
//! `cargo xtask resources` measures all rows and writes the page. `tests/engine_fits_its_budget.rs`
//! measures the quick rows in every test run, and fails if a change exceeds the budget.

mod link;
mod measure;
mod page;
mod peers;
mod rows;

pub use link::{LINES, LINK_BUDGET, ecp5, gowin, links};
pub(crate) use measure::failed;
pub use measure::{RowMeasurement, placed, synthesised, verilog};
pub use page::{Measurements, PAGE, check, page};
pub use rows::{
    BESIDE_OTHERS, ECP5, EIGHT_TO_SIX, EngineRow, FAMILIES, FamilyRow, GOWIN, ROWS, SEEDS,
};
