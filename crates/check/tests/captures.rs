//! Tests the reader with captures of all kinds: by carrystep, by other simulators, by logic
//! analysers, and broken ones.

use crate::common::*;
use carrystep_check::*;
use proptest::prelude::*;

fn read(
    text: &[u8],
    axes: &[&str],
    map: &SignalMap,
) -> Result<(Vec<PinChange>, Played), TraceError> {
    let mut changes = Vec::new();
    let played = VcdReader::new(text, axes, map)?.play(&mut changes)?;
    Ok((changes, played))
}

fn read_error(text: &str, axes: &[&str], map: &SignalMap) -> String {
    read(text.as_bytes(), axes, map).unwrap_err().to_string()
}

fn at(ps: u64, axis: u8, pin: Pin, level: bool) -> PinChange {
    PinChange { ps, axis, pin, level }
}

#[test]
fn logic_analyser_capture_is_read_through_a_signal_map() {
    let text = "$date today $end\n$version libsigrok $end\n$timescale 10 ns $end\n\
        $scope module la $end\n$var wire 1 ! D0 $end\n$var wire 1 \" D1 $end\n$upscope $end\n\
        $enddefinitions $end\n#0 1! 0\"\n#7 0!\n#12 1!\n#13 1\"\n#20\n";
    let map = SignalMap::parse(["x.step=la.D0", "x.dir = la.D1"]).unwrap();
    let (changes, played) = read(text.as_bytes(), &["x"], &map).unwrap();
    let expected = [
        at(70_000, 0, Pin::Step, false),
        at(120_000, 0, Pin::Step, true),
        at(130_000, 0, Pin::Dir, true),
    ];
    assert_eq!(changes, expected);
    assert_eq!(played, Played { end_ps: 200_000, changes: 3, unknown: 0 });
}

#[test]
fn simulator_capture_with_vectors_and_unknown_values_is_read() {
    let text = "$timescale 1fs $end\n$scope module bench $end\n$var reg 6 s step [5:0] $end\n\
        $var wire 6 d dir[5:0] $end\n$scope module dut $end\n$var wire 6 s step [5:0] $end\n\
        $var wire 6 e dir [5:0] $end\n$upscope $end\n$upscope $end\n$enddefinitions $end\n\
        $dumpvars\nbx s\nbx d\n$end\n#1000\nb0 s\nb0 d\n#2499\nb10 s\n#3501\nb100000 d\nb100010 s\n\
        #4000\nbz00010 s\n#5000\nb0 s\n";
    let (changes, played) =
        read(text.as_bytes(), &["x", "y", "z", "a", "b", "c"], &SignalMap::default()).unwrap();
    let expected = [
        at(2, 1, Pin::Step, true),
        at(4, 5, Pin::Dir, true),
        at(4, 5, Pin::Step, true),
        at(5, 1, Pin::Step, false),
        at(5, 5, Pin::Step, false),
    ];
    assert_eq!(changes, expected);
    assert_eq!(played.unknown, 1);
}

#[test]
fn signal_map_can_name_single_bits_of_vectors() {
    let text = "$timescale 1 us $end\n$scope module t $end\n$var wire 4 a up [0:3] $end\n\
        $var wire 1 b dn [2] $end\n$upscope $end\n$enddefinitions $end\n#0 b0000 a 0b\n#1 b0100 a 1b\n";
    let map = SignalMap::parse(["x.step=t.up[1]", "x.dir=t.dn[2]"]).unwrap();
    let (changes, _) = read(text.as_bytes(), &["x"], &map).unwrap();
    assert_eq!(changes, [at(1_000_000, 0, Pin::Step, true), at(1_000_000, 0, Pin::Dir, true)]);
}

#[test]
fn errors_name_the_missing_signal_and_those_that_exist() {
    let head = "$timescale 1 ns $end\n$scope module la $end\n$var wire 1 ! D0 $end\n$var wire 1 # D1 $end\n$upscope $end\n";
    let good = format!("{head}$enddefinitions $end\n#0 0!\n");
    let none = SignalMap::default();
    let map = SignalMap::parse(["x.step=la.D7", "x.dir=la.D1"]).unwrap();
    let cases: [(&str, &SignalMap, &str); 8] = [
        (
            &good,
            &none,
            "the capture has no signal x.step (nor a vector step with a bit 0); it has la.D0, la.D1",
        ),
        (&good, &map, "the capture has no signal la.D7 for x.step; it has la.D0, la.D1"),
        (head, &none, "the capture is cut off at line 6: the header has no end"),
        (
            "$enddefinitions $end\n",
            &none,
            "the capture has no $timescale: its unit of time is unknown",
        ),
        ("hello\n", &none, "line 1 of the capture: unexpected character at start of command"),
        ("", &none, "the capture is cut off at line 1: the header has no end"),
        (
            "$timescale 1 ns $end $var wire 1 ! x.step $end $var wire 1 # x.step $end $enddefinitions $end\n",
            &none,
            "several signals of the capture could be x.step: x.step, x.step; name one",
        ),
        (
            "$timescale 1 ns $end $var wire 2 ! s $end $enddefinitions $end\n",
            &SignalMap::parse(["x.step=s"]).unwrap(),
            "signal map 'x.step=s': the signal has 2 bits: name one, as in s[0]",
        ),
    ];
    for (text, map, wanted) in cases {
        assert_eq!(read_error(text, &["x"], map), wanted);
    }
    let stray = SignalMap::parse(["q.step=la.D0"]).unwrap();
    assert!(read_error(&good, &["x"], &stray).contains("there is no axis 'q'; the axes are x"));
    for line in ["", "x.step", "x.clock=a", "step=a", ".step=a", "x.step="] {
        assert!(SignalMap::parse([line]).is_err(), "{line}");
    }
    assert!(SignalMap::parse(["x.step=a", "x.step=b"]).is_err());
}

#[test]
fn broken_times_and_cut_files_are_errors() {
    let head = "$timescale 1 ns $end $var wire 1 ! x.step $end $var wire 1 # x.dir $end $enddefinitions $end\n";
    let fail = |body: &str| read_error(&format!("{head}{body}"), &["x"], &SignalMap::default());
    assert_eq!(fail("#5 1!\n#4 0!\n"), "line 3 of the capture: time goes back from 5 to 4");
    assert_eq!(
        fail("#5 1!\n#12 b"),
        "the capture is cut off at line 3: a value or a time is incomplete"
    );
    assert_eq!(fail("#5 1"), "the capture is cut off at line 2: a value or a time is incomplete");
    assert!(fail("#99999999999999999\n").contains("more than half a year"));
    assert!(fail("#999999999999999999999\n").starts_with("line 2 of the capture: "));
    let deep = "$scope module a $end\n".repeat(100_000);
    assert!(read_error(&deep, &["x"], &SignalMap::default()).contains("nested deeper than 256"));
}

#[test]
fn foreign_capture_may_lack_the_end_of_its_last_line() {
    let head = "$timescale 1 ns $end $var wire 1 ! x.step $end $var wire 1 # x.dir $end $enddefinitions $end\n";
    for (body, end_ps, changes) in [("#0 0!\n#5 1!", 5000, 1), ("#0 0!\n#5 1!\n#12", 12_000, 1)] {
        let (_, played) =
            read(format!("{head}{body}").as_bytes(), &["x"], &SignalMap::default()).unwrap();
        assert_eq!((played.end_ps, played.changes), (end_ps, changes), "{body}");
    }
}

#[test]
fn carrystep_capture_that_is_cut_anywhere_is_refused() {
    let machine = Machine::there_and_back(1);
    let train = machine.train();
    let bytes = machine.vcd(&train[..40]);
    assert!(read(&bytes, &["x"], &SignalMap::default()).is_ok());
    let end = bytes.len() - 1; // The end of the last line may be missing.
    for cut in 0..end {
        let error = read(&bytes[..cut], &["x"], &SignalMap::default()).unwrap_err();
        let TraceError::Read(error) = error else { panic!("{error}") };
        assert!(!matches!(error, ReadError::Io(_)), "{cut}: {error}");
    }
}

/// Random changes of two axes. Each change toggles a pin, at times that never decrease.
fn trains() -> impl Strategy<Value = Vec<PinChange>> {
    proptest::collection::vec((0_u64..5_000_000_000, 0_u8..2, any::<bool>()), 0..60).prop_map(
        |steps| {
            let mut levels = [[false; 2]; 2];
            let mut ps = 0;
            let toggle = |(gap, axis, dir): (u64, u8, bool)| {
                ps += gap;
                let slot = &mut levels[usize::from(axis)][usize::from(dir)];
                *slot = !*slot;
                at(ps, axis, if dir { Pin::Dir } else { Pin::Step }, *slot)
            };
            steps.into_iter().map(toggle).collect()
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn random_pulse_trains_read_back_unchanged(train in trains()) {
        let machine = Machine::there_and_back(2);
        let bytes = machine.vcd(&train);
        let (changes, played) = read(&bytes, machine.names(), &SignalMap::default()).unwrap();
        prop_assert_eq!(&changes, &train);
        prop_assert_eq!(played.end_ps, train.last().map_or(0, |c| c.ps) + 1_000_000);
    }

    #[test]
    fn no_bytes_make_the_reader_panic(
        train in trains(),
        edits in proptest::collection::vec((any::<prop::sample::Index>(), any::<u8>(), 0_u8..4), 1..20),
        noise in proptest::collection::vec(any::<u8>(), 0..300),
    ) {
        let machine = Machine::there_and_back(2);
        let mut bytes = machine.vcd(&train);
        bytes.truncate(6000);
        for (index, byte, kind) in edits {
            let place = index.index(bytes.len());
            match kind {
                0 => bytes[place] = byte,
                1 => bytes.insert(place, byte),
                2 => drop(bytes.remove(place)),
                _ => bytes[place] = b"$#01xzbr \n"[usize::from(byte % 10)],
            }
        }
        for text in [&bytes, &noise] {
            // Whatever the reader makes of the bytes, the sinks must accept it.
            let mut checker = Checker::new(machine.setup(Origin::Midpoint));
            let mut copy = Vec::new();
            let mut writer = vcd_writer(&mut copy, machine.waves());
            let mut tee = Tee::new();
            tee.add(&mut checker);
            tee.add(&mut *writer);
            if let Ok(reader) = VcdReader::new(text.as_slice(), machine.names(), &SignalMap::default()) {
                let _ = reader.play(&mut tee);
            }
            let _ = checker.finish().to_string();
        }
    }
}
