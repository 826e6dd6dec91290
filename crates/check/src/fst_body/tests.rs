//! The blocks are those of the library, byte for byte.

use super::*;
use fst_writer::{
    FstBodyWriter, FstFileType, FstHeaderWriter, FstInfo, FstScopeType, FstSignalId, FstSignalType,
    FstVarDirection, FstVarType,
};
use proptest::prelude::*;
use std::io::Cursor;

const KINDS: [Kind; 6] =
    [Kind::Bits(1), Kind::Bits(32), Kind::Real, Kind::Bits(64), Kind::Bits(1), Kind::Bits(13)];

/// The library, its numbers of the signals, and the length of what stands before the changes.
fn library() -> (FstBodyWriter<Cursor<Vec<u8>>>, Vec<FstSignalId>, usize) {
    let header = || {
        let info = FstInfo {
            start_time: 0,
            timescale_exponent: -12,
            version: String::new(),
            date: String::new(),
            file_type: FstFileType::Verilog,
        };
        let mut header = FstHeaderWriter::write_to_mem(&info).unwrap();
        header.scope("s", "", FstScopeType::Module).unwrap();
        let ids = KINDS.map(|kind| {
            let signal = match kind {
                Kind::Bits(bits) => FstSignalType::bit_vec(bits),
                Kind::Real => FstSignalType::real(),
            };
            let (kind, direction) = (FstVarType::Wire, FstVarDirection::Output);
            header.var("v", signal, kind, direction, None).unwrap()
        });
        header.up_scope().unwrap();
        (header.finish().unwrap(), ids.to_vec())
    };
    let empty = header().0.finish().unwrap().into_inner();
    let (mut body, ids) = header();
    body.set_deduplicate(false);
    (body, ids, crate::fst_out::before_changes(empty).len())
}

/// A value as the library takes it.
fn told(kind: Kind, value: u64) -> Vec<u8> {
    match kind {
        Kind::Real => value.to_le_bytes().into(),
        Kind::Bits(bits) => (0..bits).rev().map(|bit| b'0' + (value >> bit & 1) as u8).collect(),
    }
}

#[derive(Debug, Clone)]
enum Act {
    Later(u64),
    Change(usize, u64),
    /// The block ends before the next time.
    Ends,
}

fn acts() -> impl Strategy<Value = Vec<Act>> {
    // Numbers of every length, and runs of equal ones, which are compressed.
    let number = (any::<u64>(), 0..64_u32).prop_map(|(number, shift)| number >> shift);
    let act = prop_oneof![
        4 => (1..=40_u32, any::<u64>()).prop_map(|(bits, x)| Act::Later(1 + (x >> (64 - bits)))),
        8 => (0..KINDS.len(), number).prop_map(|(signal, value)| Act::Change(signal, value)),
        1 => Just(Act::Ends),
    ];
    proptest::collection::vec(act, 1..400)
}

/// The changes of both files.
fn both(acts: &[Act]) -> [Vec<u8>; 2] {
    let (mut body, ids, before) = library();
    let (mut ours, mut out, mut now, mut ends) = (Body::new(KINDS), Vec::new(), 0, false);
    for act in acts {
        match *act {
            Act::Ends => ends = now > 0,
            Act::Later(more) => {
                if std::mem::take(&mut ends) {
                    body.flush().unwrap();
                    ours.write_block(&mut out).unwrap();
                }
                now += more;
                body.time_change(now).unwrap();
                ours.time(now).unwrap();
            }
            Act::Change(signal, value) => {
                body.signal_change(ids[signal], &told(KINDS[signal], value)).unwrap();
                ours.change(signal, value).unwrap();
            }
        }
    }
    // The library has no values to begin with if there is no time at all.
    body.time_change(now + 1).unwrap();
    ours.time(now + 1).unwrap();
    ours.write_block(&mut out).unwrap();
    let file = body.finish().unwrap().into_inner();
    [file[before..].to_vec(), out]
}

proptest! {
    #[test]
    fn blocks_are_those_of_the_library(acts in acts()) {
        let [library, ours] = both(&acts);
        prop_assert!(library == ours, "{library:02x?}\n{ours:02x?}");
    }
}

#[test]
fn equal_changes_are_compressed_as_the_library_does() {
    let acts: Vec<Act> = (0..5000_u64)
        .flat_map(|k| [Act::Later(1000), Act::Change(0, k), Act::Change(1, k), Act::Change(2, 7)])
        .collect();
    let [library, ours] = both(&acts);
    assert!(library == ours);
    // They have 17 bytes a time before that.
    assert!(ours.len() < 5000 * 5, "{}", ours.len());
}

#[test]
fn times_may_not_decrease_and_signals_must_be_known() {
    let mut body = Body::new(KINDS);
    body.time(5).unwrap();
    assert!(body.time(4).is_err());
    assert!(body.change(KINDS.len(), 0).is_err());
}
