//! Tests of frames as bytes: encoding and decoding are inverse, agree with an independent CRC and
//! escaping, and never panic.

use crate::support::device::on_the_line;
use carrystep_link::slip::{self, Decoder, Received};
use carrystep_link::{Answer, Body, FrameError, OutputChange, Request, Segment, WideSegment};
use proptest::prelude::*;

fn request() -> impl Strategy<Value = Request> {
    let outputs = || any::<u32>().prop_map(OutputChange::of_word);
    let segment = (0..8_u8, 1..=u32::MAX, any::<[i64; 3]>(), any::<bool>(), outputs()).prop_map(
        |(axis, ticks, [v, a, j], last, outputs)| Body::Segment {
            axis,
            segment: Segment { ticks, v, a, j, last },
            outputs,
        },
    );
    let wide = (1..=u8::MAX, 1..=u32::MAX, any::<[[i64; 3]; 8]>(), any::<bool>(), outputs())
        .prop_map(|(mask, ticks, mut cubics, last, outputs)| {
            let others = (0..8).zip(&mut cubics).filter(|(axis, _)| mask >> axis & 1 == 0);
            others.for_each(|(_, cubic)| *cubic = [0; 3]);
            Body::Segments(WideSegment { mask, ticks, cubics, last, outputs })
        });
    let body = prop_oneof![
        any::<u8>().prop_map(|address| Body::Read { address }),
        (0..0x40_u8, any::<u32>()).prop_map(|(address, word)| Body::Write { address, word }),
        segment,
        wide,
    ];
    let numbers = (any::<u8>(), any::<u16>());
    (numbers, body).prop_map(|((sequence, session), body)| Request { sequence, session, body })
}

/// Random bytes in which END, ESC and the escaped codes are frequent.
fn byte() -> impl Strategy<Value = u8> {
    prop_oneof![any::<u8>(), prop::sample::select(vec![0xc0, 0xdb, 0xdc, 0xdd])]
}

/// Decodes these bytes: `Some` for each frame, `None` for each broken one.
fn received<const N: usize>(line: &[u8]) -> Vec<Option<Vec<u8>>> {
    let mut decoder = Decoder::<N>::default();
    let frame = |byte: &u8| match decoder.push(*byte) {
        Received::Nothing => None,
        Received::Frame(frame) => Some(Some(frame.to_vec())),
        Received::Broken => Some(None),
    };
    line.iter().filter_map(frame).collect()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn request_is_decoded_as_it_was_encoded(request in request()) {
        let bytes = request.to_bytes();
        prop_assert_eq!(Request::from_bytes(bytes.as_slice()), Ok(request));
        let (content, _) = bytes.as_slice().split_last_chunk::<4>().unwrap();
        let line: Vec<u8> = slip::encode(bytes.as_slice()).collect();
        prop_assert!(line.len() <= slip::line_bytes(bytes.as_slice().len()));
        prop_assert_eq!(&line, &on_the_line(content));
        prop_assert_eq!(received::<212>(&line), [Some(bytes.as_slice().to_vec())]);
    }

    #[test]
    fn frame_after_noise_is_decoded(noise in prop::collection::vec(byte(), 0..100), frame in prop::collection::vec(byte(), 1..38)) {
        let line: Vec<u8> = noise.into_iter().chain(slip::encode(&frame)).collect();
        prop_assert_eq!(received::<38>(&line).pop(), Some(Some(frame)));
    }

    #[test]
    fn decoder_never_panics_and_a_flipped_bit_is_detected(request in request(), bit: u16, bytes in prop::collection::vec(byte(), 0..220)) {
        let _ = Request::from_bytes(&bytes);
        let _ = Answer::from_bytes(&bytes);
        let mut changed = request.to_bytes().as_slice().to_vec();
        let place = usize::from(bit >> 3) % changed.len();
        changed[place] ^= 1 << (bit & 7);
        prop_assert!(Request::from_bytes(&changed).is_err());
    }
}

#[test]
fn frames_that_no_address_allows_are_refused() {
    let with = |content: &[u8]| {
        let line = on_the_line(content);
        Request::from_bytes(&received::<60>(&line)[0].clone().unwrap()).unwrap_err()
    };
    assert_eq!(with(&[0; 3]), FrameError::Length(7));
    assert_eq!(with(&[0, 0x42, 0, 0, 0, 0, 0, 0]), FrameError::Length(12));
    assert_eq!(with(&[0, 0xc0, 0, 0, 0, 0, 0, 0]), FrameError::Length(12));
    // Two axes in the mask, and the words of one.
    let mut wide = [0; 40];
    (wide[1], wide[4]) = (0xc8, 0b11);
    assert_eq!(with(&wide), FrameError::Length(44));
    assert_eq!(with(&[0, 0xc9, 0, 0, 0, 0, 0, 0]), FrameError::Address(0xc9));
    assert_eq!(Request::from_bytes(&[]), Err(FrameError::Length(0)));
    assert_eq!(Answer::from_bytes(&[0; 16]), Err(FrameError::Crc));
}
