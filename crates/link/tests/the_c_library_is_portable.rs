//! Portability of the C library and of its example for a microcontroller. The code must compile as
//! strict C99 and as C++, use no library functions but memset and memcpy, and have no undefined
//! behaviour. The example must execute its move.

use crate::support::c_library::{CClient, Folder};
use crate::support::conversation::{converse, scripts};
use crate::support::device::{Device, Done};
use crate::support::random::{Random, program};
use crate::support::soak::{Soak, TICKS, soak};
use crate::support::wire::Faults;
use crate::support::{self, hex, unhex};
use carrystep_link::C_LIBRARY;
use std::io::{BufRead, BufReader, Write};
use std::process::{Command, Stdio};

const EXAMPLE: &str = include_str!("../c/examples/rp2040_spi.c");
const STUBS: [(&str, &str); 3] = [
    ("hardware/gpio.h", include_str!("stubs/hardware/gpio.h")),
    ("hardware/spi.h", include_str!("stubs/hardware/spi.h")),
    ("pico/stdlib.h", include_str!("stubs/pico/stdlib.h")),
];

fn as_it_is(_: &str, text: &str) -> String {
    text.to_owned()
}

/// Runs the example on a PC with a gateware in miniature behind its bus. Returns the exit status
/// and the gateware.
fn example(change: impl FnOnce(&mut Device)) -> (Option<i32>, Device) {
    let folder = Folder::new(as_it_is);
    STUBS.iter().for_each(|(name, text)| folder.write(name, text));
    folder.write("rp2040_spi.c", EXAMPLE);
    let program = folder
        .compile(&[
            "rp2040_spi.c",
            "carrystep_feeder.c",
            "carrystep_session.c",
            "carrystep_frame.c",
        ])
        .unwrap();
    let mut child =
        Command::new(program).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
    let mut to = child.stdin.take().unwrap();
    let mut device = Device::new(6, 0x77);
    change(&mut device);
    let mut back = std::collections::VecDeque::new();
    for line in BufReader::new(child.stdout.take().unwrap()).lines() {
        let mut bytes = Vec::new();
        for byte in unhex(&line.unwrap()) {
            bytes.push(back.pop_front().unwrap_or(0xc0));
            back.extend(device.byte(byte));
        }
        device.elapse(200);
        if writeln!(to, "{}", hex(&bytes)).is_err() {
            break;
        }
    }
    (child.wait().unwrap().code(), device)
}

#[test]
fn example_moves_exactly_2500_steps() {
    let (status, device) = example(|_| ());
    assert_eq!((status, device.fault), (Some(0), None));
    let segments = device
        .log
        .iter()
        .filter_map(|done| if let Done::Segment(0, words) = done { Some(words) } else { None });
    let long =
        |low: u32, high: u32| i128::from((u64::from(high) << 32 | u64::from(low)).cast_signed());
    let way: i128 = segments
        .map(|&[ticks, v0, v1, a0, a1, ..]| {
            let n = i128::from(ticks) + 1;
            n * long(v0, v1) + n * (n - 1) / 2 * long(a0, a1)
        })
        .sum();
    assert_eq!(way, 2500 << 64);
    let writes = [Done::Write(0x20, 1), Done::Write(0x21, 1), Done::Write(0x20, 0)];
    assert_eq!(
        device.log.iter().filter(|done| matches!(done, Done::Write(..))).collect::<Vec<_>>(),
        writes.each_ref()
    );
}

#[test]
fn example_writes_nothing_to_another_build() {
    let (status, device) = example(|device| device.facts[2] ^= 1);
    assert_eq!((status, device.log.len(), device.session), (Some(1), 0, 0));
}

#[test]
fn example_leaves_another_hosts_motion_alone() {
    let (status, device) = example(|device| {
        device.session = 7;
        device.load(3, 1 << 30);
    });
    assert_eq!((status, device.log.len(), device.session), (Some(1), 0, 7));
}

#[test]
fn example_ends_when_the_machine_stops() {
    let (status, device) = example(|device| device.fault = Some(0));
    assert_eq!(status, Some(1));
    assert_eq!(device.log.first(), Some(&Done::Write(0x20, 1)));
}

#[test]
fn library_needs_only_memset_and_memcpy() {
    let folder = Folder::new(as_it_is);
    let arguments = ["-c", "-ffreestanding", "-fno-builtin"];
    let copies = &["memset", "memcpy"][..];
    for (file, allowed) in [
        ("carrystep_frame.c", &[][..]),
        ("carrystep_session.c", copies),
        ("carrystep_feeder.c", copies),
        ("carrystep_time.c", copies),
    ] {
        let object = folder.compile(&[&arguments[..], &[file]].concat()).unwrap();
        let symbols = Command::new("nm").arg("-u").arg(object).output().unwrap();
        let text = String::from_utf8(symbols.stdout).unwrap();
        let foreign =
            text.split_whitespace().filter(|&word| word != "U" && !word.starts_with("carrystep_"));
        let foreign: Vec<&str> =
            foreign.filter(|word| !word.starts_with('_') && !allowed.contains(word)).collect();
        assert!(foreign.is_empty(), "{file}: {foreign:?}");
    }
    for (name, text) in C_LIBRARY {
        let mut words = text.split(|letter: char| !letter.is_ascii_alphanumeric());
        assert!(words.all(|word| !["float", "double", "malloc"].contains(&word)), "{name}");
    }
    let both = "#include \"carrystep_feeder.h\"\n#include \"carrystep_time.h\"\nint main() { return carrystep_crc(0, 0) == 0 ? 0 : 1; }\n";
    folder.write("both.cpp", both);
    folder.compile(&["-std=c++11", "-Wno-error", "-fsyntax-only", "both.cpp"]).unwrap();
}

#[test]
fn library_has_no_undefined_behaviour_on_noise() {
    let arguments = ["-g", "-fsanitize=address,undefined", "-fno-sanitize-recover=all"];
    let mut client = CClient::with(&arguments, as_it_is);
    for (name, text) in scripts() {
        converse(&mut client, &text).unwrap_or_else(|words| panic!("{name}: {words}"));
    }
    let commands = program(&mut Random::new(21), 8, 1000, 20 * TICKS);
    let how = Soak { faults: Faults::BAD, seed: 21, axes: 8, bugs: Default::default() };
    assert_eq!(soak(&mut client, &commands, how).unwrap().fault, None);
    // A long run of noise.
    let mut random = Random::new(22);
    for _ in 0..300 {
        let noise: Vec<u8> = (0..200)
            .map(|_| [random.next() as u8, 0xc0, 0xdb][(random.next() % 3) as usize])
            .collect();
        use support::client::Client as _;
        client.say(&format!("take 1 {}", hex(&noise)));
    }
}
