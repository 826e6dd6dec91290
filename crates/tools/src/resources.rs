//! What the engine costs: the rows of `hdl-out/resources.md`, as data, with their budgets.
//!
//! `cargo xtask resources` measures all of it and writes the page; `tests/system/engine_fits_its_budget.rs` measures what is quick in
//! every test run, and fails where a change goes over budget.

mod link;
mod measure;
mod page;
mod peers;
mod rows;

pub use link::{LINES, LINK_BUDGET, links};
pub(crate) use measure::failed;
pub use measure::{Measured, placed, verilog};
pub use page::{PAGE, check, page};
pub use rows::{EIGHT_TO_SIX, FAMILIES, Family, ROWS, Row, SEEDS};
