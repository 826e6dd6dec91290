//! Shards that are stopped and started again, and the merge of their reports. The judge is a
//! function of the number of the case, so that a run takes no time.

#![allow(clippy::unwrap_used)] // Tests may panic.

mod merges;
mod restarts;
mod support;
