//! Bugs planted as text in the exported Verilog of an engine: each must be caught.

/// What is wrong then, the text of the Verilog, what it becomes.
pub type Bug = (&'static str, &'static str, &'static str);

/// Plants one after the other.
///
/// # Panics
/// Where a text is gone, or `caught` says no of the changed Verilog.
pub fn assert_all_caught(bugs: &[Bug], caught: impl Fn(&dyn Fn(String) -> String) -> bool) {
    for &(name, text, becomes) in bugs {
        let plant = |verilog: String| {
            assert!(verilog.contains(text), "{name}: the text is gone");
            verilog.replace(text, becomes)
        };
        assert!(caught(&plant), "nobody catches: {name}");
    }
}
