//! `carrystep selftest`: the files that it writes, what it refuses, and its report.

use crate::command::Folder;
use crate::repeats;
use serde_json::Value;
use std::process::Command;

/// The pins of the iCEstick's SPI.
const SPI: &str =
    "spi_cs_n = \"PMOD1\"\nspi_sck = \"PMOD4\"\nspi_mosi = \"PMOD2\"\nspi_miso = \"PMOD3\"\n";

/// A file of a board of the user's own, made from the iCEstick's.
fn own(was: &str, becomes: &str) -> Folder {
    let text = include_str!("../../../boards/data/boards/icestick.toml");
    let changed = text.replace(was, becomes);
    assert_ne!(changed, text, "{was} is not there");
    let folder = Folder::new();
    folder.write("own.toml", changed);
    folder
}

#[test]
fn folder_of_a_board_that_is_built_by_hand_is_whole_and_the_same_twice() {
    let folder = Folder::new();
    let run = || {
        let ran = folder.run("selftest --board papilio-one --out out");
        assert_eq!((ran.status, ran.stdout.as_str()), (3, ""), "{}", ran.stderr);
        let read = |name: &String| std::fs::read(folder.path(name)).unwrap_or_default();
        let files = folder.files();
        files.iter().map(|name| (name.clone(), read(name))).collect::<Vec<_>>()
    };
    let first = run();
    let names: Vec<&str> = first.iter().map(|(name, _)| name.as_str()).collect();
    let top = "out/carrystep_papilio_one_selftest";
    assert_eq!(
        names,
        [
            "out",
            "out/README.md",
            "out/build.sh",
            "out/carrystep_clock.v",
            &format!("{top}.prj"),
            &format!("{top}.ucf"),
            &format!("{top}.v"),
            &format!("{top}.xst"),
            "out/carrystep_self_test.v",
            "out/files.f",
        ]
    );
    assert!(run() == first, "a second run writes other files");
}

#[test]
fn what_a_board_cannot_do_is_refused_and_nothing_is_written() {
    let named = |name: &str| format!("[connectors.\"{name}\"]");
    let long = named("a name that is much too long for the line of text that a self-test sends");
    let foreign = named("Stift für X");
    for (was, becomes, options, says) in [
        ("uart_rx = \"9\"\nuart_tx = \"8\"\n", "", "", "icestick has no pin for uart_rx"),
        (SPI, "", " --spi", "icestick has no pin for spi_miso"),
        ("[connectors.J1]", &long, "", "bytes: a self-test sends at most 62 in a line"),
        (
            "[connectors.J1]",
            &foreign,
            "",
            "is not plain ASCII, which is all that a self-test sends",
        ),
    ] {
        let folder = own(was, becomes);
        let ran = folder.run(&format!("selftest --board own.toml --out out{options}"));
        ran.refuses(says);
        assert_eq!(folder.files(), ["own.toml"], "{says}");
    }
    let folder = Folder::new();
    folder.run("selftest --board icestik --out out").refuses("did you mean 'icestick'?");
    folder.run("selftest --board icestick --part up5k --out out").refuses("no part 'up5k'");
    folder.write("file", "");
    folder.run("selftest --board icestick --out file").refuses("file");
    assert_eq!(folder.files(), ["file"]);
}

/// With the tools: the bitstream, and a report with stable names.
#[test]
fn self_test_of_the_icestick_becomes_a_bitstream_with_a_report() {
    let folder = Folder::new();
    let ran = folder.run("selftest --board icestick --out out --json");
    assert_eq!((ran.status, ran.stderr.as_str()), (0, ""));
    let report: Value = serde_json::from_str(&ran.stdout).unwrap();
    let fields = report.as_object().unwrap().keys().map(String::as_str);
    let mut names: Vec<&str> = fields.filter(|name| *name != "schema").collect();
    names.sort_unstable();
    assert_eq!(
        names.join(" "),
        "baud bitstream block_rams board clock_hz icetime_mhz inputs load logic_cells mhz outputs part passed seed tried_on_hardware"
    );
    assert_eq!((&report["baud"], &report["board"]), (&115_200.into(), &"icestick".into()));
    assert_eq!((&report["outputs"][0], &report["inputs"][0]), (&"step[0]".into(), &"estop".into()));
    let bitstream = "out/carrystep_icestick_selftest.bin";
    assert_eq!(report["bitstream"], bitstream);
    let made = std::fs::read(folder.path(bitstream)).unwrap();
    assert!(made.len() > 30_000);
    // The script of the folder makes the same. It is a script as each board has one, and those are run
    // in every test run.
    if repeats::in_full() {
        std::fs::remove_file(folder.path(bitstream)).unwrap();
        let script = Command::new("sh").arg(folder.path("out/build.sh")).output().unwrap();
        assert!(script.status.success(), "{}", String::from_utf8_lossy(&script.stderr));
        let again = std::fs::read(folder.path(bitstream)).unwrap();
        assert!(again == made, "build.sh makes another one");
    }
    // People see what to disconnect before they see the command that loads the bitstream.
    let page = std::fs::read_to_string(folder.path("out/README.md")).unwrap();
    let (warning, load) = (page.find("**Disconnect motors"), page.find("Load the bitstream with"));
    assert!(warning.is_some() && warning < load, "{page}");
}
