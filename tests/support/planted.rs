//! Plants bugs as changes of text in the exported Verilog of an engine. Each of them must be
//! caught.

/// A bug: its description, the original text of the Verilog, and the replacement.
pub type Bug = (&'static str, &'static str, &'static str);

/// Plants one bug after the other.
///
/// # Panics If an original text no longer exists, or if `caught` returns false for the changed
/// Verilog.
pub fn assert_all_caught(bugs: &[Bug], caught: impl Fn(&dyn Fn(String) -> String) -> bool) {
    for &(name, text, becomes) in bugs {
        let plant = |verilog: String| {
            assert!(verilog.contains(text), "{name}: the text is gone");
            verilog.replace(text, becomes)
        };
        assert!(caught(&plant), "nobody catches: {name}");
    }
}
