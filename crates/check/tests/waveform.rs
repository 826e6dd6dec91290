//! Tests with an independent reader that the VCD contains the pins and values that were written,
//! that the FST is equal to it, and that every name of the save file is in the VCD.

use crate::common::*;
use carrystep_check::*;
use carrystep_core::StartPhase;
use std::collections::BTreeMap;
use std::io::Cursor;
use wellen::simple::Waveform;
use wellen::{SignalRef, SignalValueRef};

/// The signals by their full name with range.
fn open(bytes: Vec<u8>) -> (Waveform, BTreeMap<String, SignalRef>) {
    let waveform = wellen::simple::read_from_reader(Cursor::new(bytes)).unwrap();
    let hierarchy = waveform.hierarchy();
    let name = |var: &wellen::Var| {
        let range = var.index().map_or(String::new(), |i| format!("[{}:{}]", i.msb(), i.lsb()));
        (format!("{}{range}", var.full_name(hierarchy)), var.signal_ref())
    };
    let signals = hierarchy.all_vars().map(|var| name(&hierarchy[var])).collect();
    (waveform, signals)
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Shown {
    Bits(u64),
    Real(f64),
    Unknown,
}

fn changes(waveform: &mut Waveform, signal: SignalRef) -> Vec<(u64, Shown)> {
    waveform.load_signals(&[signal]);
    let shown = |value: SignalValueRef<'_>| match value {
        SignalValueRef::Real(x) => Shown::Real(x),
        unknown if unknown.to_bit_string().is_some_and(|bits| bits.contains('x')) => Shown::Unknown,
        other => Shown::Bits(u64::from_str_radix(&other.to_bit_string().unwrap(), 2).unwrap()),
    };
    let found = waveform.get_signal(signal).unwrap();
    found
        .iter_changes()
        .map(|(at, value)| (waveform.time_table()[at as usize], shown(value)))
        .collect()
}

#[test]
fn another_reader_sees_the_same_edges_and_values() {
    let machine = Machine::there_and_back(3);
    let train = machine.train();
    let (mut waveform, signals) = open(machine.vcd(&train));
    assert_eq!(signals.len(), 21);
    for (index, timeline) in machine.timelines.iter().enumerate() {
        let mut get = |name: &str| {
            changes(&mut waveform, signals[&format!("carrystep.{}.{name}", NAMES[index])])
        };
        for pin in [Pin::Step, Pin::Dir] {
            let mut expected = vec![(0, Shown::Bits(0))];
            let of_pin = train.iter().filter(|c| c.pin == pin && usize::from(c.axis) == index);
            expected.extend(of_pin.map(|c| (c.ps, Shown::Bits(c.level.into()))));
            assert_eq!(get(&pin.to_string()), expected);
        }

        let mut follower = Follower::new(timeline, StartPhase::Half, &machine.timebase, ORIGIN_PS);
        let pulses: Vec<Pulse> = train
            .iter()
            .filter(|c| usize::from(c.axis) == index)
            .filter_map(|&c| follower.change(c))
            .collect();
        let positions: Vec<_> = pulses
            .iter()
            .map(|p| (p.ps, Shown::Bits(u64::from(p.position as i32 as u32))))
            .collect();
        assert_eq!(get("position[31:0]")[1..], positions);
        for ((ps, shown), pulse) in get("error_ns")[1..].iter().zip(&pulses) {
            let Shown::Real(error) = *shown else { panic!("no real") };
            assert_eq!(*ps, pulse.ps);
            assert!(
                (error - pulse.error_ns.unwrap()).abs() < 1e-6 && (-62.5..0.1).contains(&error),
                "{error}"
            );
        }

        // The reader leaves out values that do not change.
        for (name, least) in
            [("profile_position", pulses.len() + 450), ("profile_speed", pulses.len() / 2 + 300)]
        {
            let samples = get(name);
            assert!(samples.len() > least, "{} {least}", samples.len());
            let mut walk = timeline.walk();
            for &(ps, shown) in &samples[1..] {
                let (position, speed) = walk.at((ps as f64 - ORIGIN_PS as f64) / 1e6);
                let expected = if name == "profile_speed" { speed } else { position };
                let Shown::Real(found) = shown else { panic!("no real") };
                assert!(
                    (found - expected).abs() < 1e-6 * (1.0 + expected.abs()),
                    "{name} {ps}: {found} {expected}"
                );
            }
        }

        // V tick by tick, as the register adds.
        let mut register = Vec::new();
        for (_, segment) in machine.segments() {
            let (mut v, mut a) = (segment.v, segment.a);
            for _ in 0..segment.ticks {
                register.push(v);
                v = v.wrapping_add(a);
                a = a.wrapping_add(segment.j);
            }
        }
        let v = get("v[63:0]");
        assert!(v.len() > pulses.len());
        for &(ps, shown) in v.iter().filter(|&&(ps, _)| ps >= ORIGIN_PS as u64) {
            let tick = (ps - ORIGIN_PS as u64) / 1_000_000;
            let expected = register.get(tick as usize).copied().unwrap_or(0);
            assert_eq!(shown, Shown::Bits(expected as u64), "tick {tick}");
        }
    }
}

/// The second machine makes an FST of many blocks.
#[test]
fn fst_contains_the_same_changes_as_the_vcd() {
    for machine in [Machine::there_and_back(6), Machine::steady(60_000)] {
        let train = machine.train();
        let (vcd, fst) = (machine.vcd(&train), machine.fst(&train));
        assert!(fst.len() < vcd.len() / 2, "{} bytes of FST, {} of VCD", fst.len(), vcd.len());
        let ((mut vcd, of_vcd), (mut fst, of_fst)) = (open(vcd), open(fst));
        assert!(of_vcd.keys().eq(of_fst.keys()), "{:?} {:?}", of_vcd.keys(), of_fst.keys());
        assert_eq!(vcd.hierarchy().timescale(), fst.hierarchy().timescale());
        for (name, signal) in of_vcd {
            assert_eq!(changes(&mut fst, of_fst[&name]), changes(&mut vcd, signal), "{name}");
        }
    }
}

/// The value of a signal at a time.
fn at(changes: &[(u64, Shown)], ps: u64) -> Option<Shown> {
    changes.iter().rev().find(|(time, _)| *time <= ps).map(|(_, value)| *value)
}

/// Part of a run as VCD and as FST.
fn parts(machine: &Machine, train: &[PinChange], view: &View) -> [Vec<u8>; 2] {
    let (mut vcd, mut fst) = (Vec::new(), Cursor::new(Vec::new()));
    let waves = || Waves { view: view.clone(), ..machine.waves() };
    play(train, &mut *vcd_writer(&mut vcd, waves()));
    play(train, &mut *fst_writer(&mut fst, waves()));
    [vcd, fst.into_inner()]
}

#[test]
fn window_shows_what_the_whole_waveform_shows_there() {
    let machine = Machine::there_and_back(3);
    let train = machine.train();
    let (mut whole, of_whole) = open(machine.vcd(&train));
    let last = train.last().unwrap().ps + 1_000_000;
    let rise = train[rise(&train, 2, 100)].ps;
    let origin = ORIGIN_PS as u64;
    let windows = [
        (Some(0), Some(1)),
        (Some(origin / 2), Some(origin + 1_000_000)),
        (Some(rise), Some(rise + 10_000_000_000)),
        (Some(rise + 1), None),
        (None, Some(rise)),
        (Some(last - 1), None),
    ];
    for (from, to) in windows {
        let view = View::default().between(from, to).of_axes(vec![0, 2]);
        for (bytes, is_fst) in parts(&machine, &train, &view).into_iter().zip([false, true]) {
            let (mut part, of_part) = open(bytes);
            assert_eq!(of_part.len(), 14);
            let (begin, end) = (from.unwrap_or(0), to.unwrap_or(last));
            // The FST says from 0 on that nothing is known.
            let first = if is_fst { 0 } else { begin };
            assert_eq!(part.time_table().first(), Some(&first), "{view:?}");
            assert_eq!(part.time_table().last(), Some(&end), "{view:?}");
            let rises = train.iter().filter(|c| c.axis != 1 && c.pin == Pin::Step && c.level);
            let rises: Vec<u64> =
                rises.map(|c| c.ps).filter(|ps| (begin..=end).contains(ps)).collect();
            for (name, signal) in of_part {
                let (seen, wanted) =
                    (changes(&mut part, signal), changes(&mut whole, of_whole[&name]));
                let is_pin_or_position =
                    !["v[", "profile", "error"].iter().any(|n| name.contains(n));
                if is_pin_or_position {
                    assert_eq!(at(&seen, begin), at(&wanted, begin), "{name} {view:?}");
                    let within = |all: &[(u64, Shown)]| -> Vec<(u64, Shown)> {
                        all.iter().copied().filter(|(ps, _)| *ps > begin && *ps <= end).collect()
                    };
                    assert_eq!(within(&seen), within(&wanted), "{name} {view:?}");
                }
                // V and the profile are also sampled on a grid of the window; they are the same at
                // the pulses of their axis.
                let axis = NAMES.iter().position(|axis| name.contains(&format!(".{axis}.")));
                let own = train.iter().filter(|c| Some(usize::from(c.axis)) == axis);
                for pulse in own.filter(|c| rises.contains(&c.ps) && c.pin == Pin::Step && c.level)
                {
                    assert_eq!(at(&seen, pulse.ps), at(&wanted, pulse.ps), "{name} {view:?}");
                }
            }
        }
        let [vcd, _] = parts(&machine, &train, &view);
        let refused = VcdReader::new(vcd.as_slice(), machine.names(), &SignalMap::default());
        assert!(matches!(refused, Err(ReadError::Part)), "{view:?}");
    }
}

#[test]
fn every_name_of_the_save_file_is_in_the_vcd() {
    let machine = Machine::there_and_back(6);
    let (_, signals) = open(machine.vcd(&machine.train()));
    let save = save_file("run.vcd", machine.names(), 500_000_000_000).unwrap();
    let is_name = |line: &&str| !line.starts_with(['[', '*', '@', '-']) && !line.is_empty();
    let names: Vec<&str> = save.lines().filter(is_name).collect();
    assert_eq!(names.len(), 42);
    for name in &names {
        assert!(signals.contains_key(*name), "{name} is not in {signals:?}");
    }
    assert!(names.contains(&"carrystep.x.position[31:0]"));
    // GTKWave finds the VCD beside the save file, in whatever folder it is started.
    assert!(
        save.contains(
            "[dumpfile] \"/carrystep/run.vcd\"\n[savefile] \"/carrystep/carrystep.gtkw\"\n"
        )
    );
    let absolute = save_file("/a/run.vcd", machine.names(), 500_000_000_000).unwrap();
    assert!(absolute.contains("[dumpfile] \"/a/run.vcd\"\n[timestart]"));
}

#[test]
fn carrystep_capture_is_recognised_and_passes() {
    let machine = Machine::there_and_back(6);
    let bytes = machine.vcd(&machine.train());
    let reader = VcdReader::new(bytes.as_slice(), machine.names(), &SignalMap::default()).unwrap();
    let own = reader.own().unwrap();
    assert_eq!(
        own,
        OwnCapture { origin_ps: ORIGIN_PS, timebase: machine.timebase, is_part: false }
    );
    let mut checker = Checker::new(machine.setup(Origin::Known { ps: own.origin_ps }));
    let played = reader.play(&mut checker).unwrap();
    let report = checker.finish();
    assert!(report.passed(), "{report}");
    assert_eq!(played.unknown, 0);
    assert_eq!(report, machine.check(&machine.train(), KNOWN));
}
