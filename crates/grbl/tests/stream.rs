//! The stream of a sender: whatever comes, lines and real-time characters are kept apart, bytes are
//! counted as the sender counts them, and the memory is bounded.

use carrystep_grbl::{
    INPUT_BOUND, Input, LONGEST_LINE, Line, OverrideStep, RECEIVE_BUFFER, Realtime, Received,
};
use proptest::prelude::*;

/// All lines and real-time characters of some bytes.
fn split(bytes: &[u8]) -> (Vec<Line>, Vec<Realtime>) {
    let mut input = Input::default();
    let realtime = bytes.iter().filter_map(|&byte| input.take(byte)).collect();
    (std::iter::from_fn(|| input.next_line()).collect(), realtime)
}

fn text(line: &str) -> Line {
    Line::Text(line.to_owned())
}

/// What Grbl keeps of a line, written in another way.
fn stripped(line: &str) -> String {
    let (mut out, mut rest) = (String::new(), line);
    while let Some(at) = rest.find(['(', ';']) {
        out.push_str(&rest[..at]);
        let is_rest = rest[at..].starts_with(';');
        rest = rest[at..].split_once(')').filter(|_| !is_rest).map_or("", |(_, after)| after);
    }
    out.push_str(rest);
    out.chars().filter(|&c| c > ' ' && c != '/').collect::<String>().to_ascii_uppercase()
}

#[test]
fn lines_are_kept_without_blanks_and_comments() {
    let (lines, _) = split(b"g1 x1 (here) y2\n/g0 z3 ; there\r(a\n\nG4 P1\n");
    let want = [text("G1X1Y2"), text("G0Z3"), text(""), text(""), text("G4P1")];
    assert_eq!(lines, want);
}

#[test]
fn each_real_time_character_has_its_meaning() {
    let step = |step| Received::Realtime(Realtime::Override(step));
    let table = [
        (b'?', Received::Realtime(Realtime::Report)),
        (b'!', Received::Realtime(Realtime::Hold)),
        (b'~', Received::Realtime(Realtime::Resume)),
        (0x18, Received::Realtime(Realtime::Reset)),
        (0x84, Received::Realtime(Realtime::Door)),
        (0x85, Received::Realtime(Realtime::JogCancel)),
        (0x90, step(OverrideStep::FeedReset)),
        (0x91, step(OverrideStep::Feed(10))),
        (0x92, step(OverrideStep::Feed(-10))),
        (0x93, step(OverrideStep::Feed(1))),
        (0x94, step(OverrideStep::Feed(-1))),
        (0x95, step(OverrideStep::RapidFull)),
        (0x96, step(OverrideStep::RapidHalf)),
        (0x97, step(OverrideStep::RapidQuarter)),
        (0x99, step(OverrideStep::SpindleReset)),
        (0x9a, step(OverrideStep::Spindle(10))),
        (0x9b, step(OverrideStep::Spindle(-10))),
        (0x9c, step(OverrideStep::Spindle(1))),
        (0x9d, step(OverrideStep::Spindle(-1))),
        (0x9e, Received::Realtime(Realtime::SpindleStop)),
        (0xa0, Received::Realtime(Realtime::Flood)),
        (0xa1, Received::Realtime(Realtime::Mist)),
    ];
    for byte in 0..=u8::MAX {
        let known = table.iter().find(|(known, _)| *known == byte).map(|(_, meaning)| *meaning);
        let other = if byte < 0x80 { Received::Text(byte) } else { Received::Unknown };
        assert_eq!(Received::of(byte), known.unwrap_or(other), "{byte:#x}");
    }
}

#[test]
fn ten_megabytes_without_a_newline_are_one_refused_line() {
    let mut input = Input::default();
    for _ in 0..10_000_000 {
        assert_eq!(input.take(b'X'), None);
        assert!(!input.is_full());
    }
    assert_eq!((input.next_line(), input.free()), (None, 0));
    input.take(b'\n');
    "G0X1\n".bytes().for_each(|byte| assert_eq!(input.take(byte), None));
    assert_eq!(input.next_line(), Some(Line::TooLong));
    assert_eq!((input.next_line(), input.next_line()), (Some(text("G0X1")), None));
    assert_eq!(input.free(), RECEIVE_BUFFER);
}

#[test]
fn longest_line_is_taken_and_a_longer_one_refused() {
    for (count, want) in [(LONGEST_LINE, text(&"X".repeat(LONGEST_LINE)))]
        .into_iter()
        .chain([(LONGEST_LINE + 1, Line::TooLong)])
    {
        // Blanks and comments do not count.
        let line = format!("( {} ){}\n", "-".repeat(500), "x ".repeat(count));
        assert_eq!(split(line.as_bytes()).0, [want]);
    }
}

#[test]
fn sender_that_counts_nothing_is_stopped_and_loses_nothing() {
    let mut input = Input::default();
    let mut sent = 0_usize;
    while !input.is_full() {
        format!("G1X{sent}\n").bytes().for_each(|byte| assert_eq!(input.take(byte), None));
        sent += 1;
    }
    assert_eq!(input.free(), 0);
    for number in 0..sent {
        assert_eq!(input.next_line(), Some(text(&format!("G1X{number}"))));
    }
    assert!(input.next_line().is_none() && !input.is_full() && sent < INPUT_BOUND);
    input.take(b'G');
    input.clear();
    assert_eq!((input.has_line(), input.free()), (false, RECEIVE_BUFFER));
}

proptest! {
    #[test]
    fn real_time_characters_leave_the_lines_as_they_are(
        lines in prop::collection::vec("[ -~]{0,60}", 0..20),
        inserted in prop::collection::vec((any::<prop::sample::Index>(), 0_usize..22), 0..40),
    ) {
        const CHARACTERS: [u8; 22] = [
            b'?', b'!', b'~', 0x18, 0x84, 0x85, 0x90, 0x91, 0x92, 0x93, 0x94, 0x95, 0x96, 0x97,
            0x99, 0x9a, 0x9b, 0x9c, 0x9d, 0x9e, 0xa0, 0xa1,
        ];
        let is_text = |c: &char| !matches!(c, '?' | '!' | '~');
        let lines: Vec<String> =
            lines.iter().map(|line| line.chars().filter(is_text).collect()).collect();
        let plain: Vec<u8> = lines.iter().flat_map(|line| format!("{line}\n").into_bytes()).collect();
        let mut mixed = plain.clone();
        let mut count = 0;
        for (place, character) in &inserted {
            mixed.insert(place.index(mixed.len() + 1), CHARACTERS[*character]);
            count += 1;
        }
        let (found, realtime) = split(&mixed);
        let want: Vec<Line> = lines.iter().map(|line| text(&stripped(line))).collect();
        prop_assert_eq!(found, want);
        prop_assert_eq!(realtime.len(), count);
        let order: Vec<Realtime> = mixed
            .iter()
            .filter_map(|&byte| match Received::of(byte) {
                Received::Realtime(realtime) => Some(realtime),
                _ => None,
            })
            .collect();
        prop_assert_eq!(realtime, order);
    }

    #[test]
    fn waiting_bytes_are_those_that_the_sender_counts(
        bytes in prop::collection::vec(any::<u8>(), 0..RECEIVE_BUFFER),
    ) {
        let mut input = Input::default();
        let mut counted = 0;
        for &byte in &bytes {
            input.take(byte);
            counted += usize::from(matches!(Received::of(byte), Received::Text(_)));
            prop_assert_eq!(input.free(), RECEIVE_BUFFER - counted);
        }
        // Only the line that is not whole still waits when all lines were taken.
        while input.next_line().is_some() {}
        let text = |&&byte: &&u8| matches!(Received::of(byte), Received::Text(_));
        let open = bytes.iter().rev().filter(text).take_while(|byte| !matches!(byte, b'\n' | b'\r'));
        prop_assert_eq!(input.free(), RECEIVE_BUFFER - open.count());
    }
}
