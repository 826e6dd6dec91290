//! Reads the conversations of `tests/conversations`, and plays them to a client.

use super::client::Client;
use std::path::Path;

/// Name and text of each conversation.
pub fn scripts() -> Vec<(String, String)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/conversations");
    let mut paths: Vec<_> = std::fs::read_dir(folder)
        .expect("conversations")
        .map(|entry| entry.expect("a file").path())
        .collect();
    paths.sort();
    assert!(paths.len() >= 9, "{paths:?}");
    let read = |path: &std::path::PathBuf| {
        (path.display().to_string(), std::fs::read_to_string(path).expect("a conversation"))
    };
    paths.iter().map(read).collect()
}

/// Sends every `>` line to the client, and compares its replies with the `<` lines. An error names
/// the first line that differs.
pub fn converse(client: &mut dyn Client, text: &str) -> Result<(), String> {
    let mut said = String::new();
    for (number, line) in text.lines().enumerate() {
        if let Some(words) = line.strip_prefix("> ") {
            said = client.say(words);
        } else if let Some(expected) = line.strip_prefix('<') {
            let expected = expected.trim();
            if said != expected {
                return Err(format!("line {}: {said:?}, not {expected:?}", number + 1));
            }
        }
    }
    Ok(())
}
