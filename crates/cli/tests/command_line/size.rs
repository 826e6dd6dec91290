//! The size of the released command.

/// The most bytes that it may have. The aim is 15 000 000 (docs/decisions/0106).
#[cfg(not(debug_assertions))]
const MOST: u64 = 16_300_000;

#[cfg(not(debug_assertions))]
#[test]
fn released_command_is_no_larger_than_it_was() {
    let command = env!("CARGO_BIN_EXE_carrystep");
    let bytes = std::fs::metadata(command).unwrap().len();
    assert!(
        bytes < MOST,
        "{command} has {bytes} bytes: docs/decisions/0106 says what makes it large"
    );
}
