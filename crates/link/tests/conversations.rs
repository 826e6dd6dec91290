//! Conversations, byte for byte: the clients in Rust and C must send and accept exactly these
//! bytes. In `tests/conversations/*.txt` a line with `>` is a command for the client (commands:
//! support/client.rs), and a line with `<` is its expected reply. A new conversation is a new file.

use crate::support::c_library::CClient;
use crate::support::client::{Client as _, RustClient};
use crate::support::conversation::{converse, scripts};
use crate::support::device::crc;
use crate::support::{hex, unhex};
use carrystep_link::Request;
use carrystep_link::registers::LONGEST_REQUEST;
use carrystep_link::slip::{self, Decoder, Received};
use std::path::Path;

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

/// The frames of docs/protocol.md: their CRCs are correct by an independent implementation, the
/// client in Rust encodes each request as it is shown, and both clients read each answer alike. The
/// conversations show that both clients encode alike.
#[test]
fn frames_of_the_page_are_those_of_the_clients() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let page = std::fs::read_to_string(root.join("../../docs/protocol.md")).unwrap();
    let (_, rest) = page.split_once("```frames\n").expect("a block of frames");
    let (block, _) = rest.split_once("```").expect("the end of the block");
    let shown = block.lines().filter(|line| !line.starts_with('#'));
    let (mut rust, mut c) = (RustClient::default(), CClient::shared());
    let (mut requests, mut answers) = (0, 0);
    for line in shown {
        let (direction, bytes) = line.split_once(' ').expect("a frame");
        let bytes = unhex(bytes);
        let mut decoder = Decoder::<LONGEST_REQUEST>::default();
        let frame = bytes.iter().fold(None, |frame, &byte| match decoder.push(byte) {
            Received::Frame(whole) => Some(whole.to_vec()),
            Received::Nothing | Received::Broken => frame,
        });
        let frame = frame.unwrap_or_else(|| panic!("{line} is no frame"));
        let (content, sum) = frame.split_last_chunk::<4>().unwrap();
        assert_eq!(crc(content).to_le_bytes(), *sum, "{line}");
        if direction.starts_with('>') {
            let request = Request::from_bytes(&frame).unwrap();
            assert!(slip::encode(request.to_bytes().as_slice()).eq(bytes), "{line}: {request:?}");
            requests += 1;
        } else {
            let take = format!("take 0 {}", hex(&bytes));
            let said = rust.say(&take);
            assert_eq!(said, c.say(&take), "{line}");
            assert!(said.contains(':'), "{line}: {said}");
            answers += 1;
        }
    }
    assert!(requests > 12 && answers > 12, "{requests} requests, {answers} answers");
}
