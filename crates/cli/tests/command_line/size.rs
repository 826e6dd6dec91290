//! The size of the released command.

/// The most bytes that it may have (docs/decisions/0106).
#[cfg(not(debug_assertions))]
const MOST: u64 = 15_000_000;

#[cfg(not(debug_assertions))]
#[test]
fn released_command_has_less_than_15_mb() {
    let command = env!("CARGO_BIN_EXE_carrystep");
    let bytes = std::fs::metadata(command).unwrap().len();
    assert!(
        bytes < MOST,
        "{command} has {bytes} bytes: docs/decisions/0106 says what makes it large"
    );
}
