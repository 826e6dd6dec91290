//! Conversations, byte for byte: the clients in Rust and C must send and accept exactly these
//! bytes. In `tests/conversations/*.txt` a line with `>` is a command for the client (commands:
//! support/client.rs), and a line with `<` is its expected reply. A new conversation is a new file.
#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches unit tests only")]

mod support;

use std::path::Path;
use support::c_library::CClient;
use support::client::RustClient;
use support::conversation::{converse, scripts};
use support::device::crc;
use support::unhex;

#[test]
fn rust_client_follows_every_conversation() {
    for (name, text) in scripts() {
        converse(&mut RustClient::default(), &text)
            .unwrap_or_else(|words| panic!("{name}: {words}"));
    }
}

#[test]
fn c_client_follows_every_conversation() {
    for (name, text) in scripts() {
        converse(&mut CClient::shared(), &text).unwrap_or_else(|words| panic!("{name}: {words}"));
    }
}

/// Every frame of docs/protocol.md occurs in a conversation of both clients, in that order, and has
/// a correct CRC by an independent implementation.
#[test]
fn frames_of_the_page_occur_in_a_conversation() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let page = std::fs::read_to_string(root.join("../../docs/protocol.md")).unwrap();
    let (_, rest) = page.split_once("```frames\n").expect("a block of frames");
    let (block, _) = rest.split_once("```").expect("the end of the block");
    let shown: Vec<(char, Vec<u8>)> = block
        .lines()
        .filter(|line| !line.starts_with('#') && !line.starts_with("<x"))
        .filter_map(|line| Some((line.chars().next()?, unhex(line.split_once(' ')?.1))))
        .collect();
    let script =
        std::fs::read_to_string(root.join("tests/conversations/example_frames.txt")).unwrap();
    let mut said = Vec::new();
    let mut sending = false;
    for line in script.lines() {
        if let Some(("take", rest)) =
            line.strip_prefix("> ").and_then(|words| words.split_once(' '))
        {
            said.push(('<', unhex(rest.split_once(' ').unwrap().1)));
        }
        if let Some(bytes) = line.strip_prefix("< c0").filter(|_| sending) {
            said.push(('>', unhex(&format!("c0{bytes}"))));
        }
        sending = line.starts_with("> send");
    }
    assert_eq!(shown.len(), 26);
    assert_eq!(shown, said);
    for (_, line) in shown {
        let mut frame = Vec::new();
        let mut bytes = line[1..line.len() - 1].iter();
        while let Some(&byte) = bytes.next() {
            frame.push(match (byte, if byte == 0xdb { bytes.next() } else { None }) {
                (0xdb, Some(0xdc)) => 0xc0,
                (0xdb, Some(0xdd)) => 0xdb,
                (0xdb, other) => panic!("{other:?} after db"),
                (byte, _) => byte,
            });
        }
        let (content, sum) = frame.split_last_chunk::<4>().unwrap();
        assert_eq!(crc(content).to_le_bytes(), *sum, "{line:02x?}");
    }
}
