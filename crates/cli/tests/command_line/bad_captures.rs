//! `carrystep check` refuses captures that cannot be read, that lack a signal, or that come from
//! gateware other than the machine's.

use crate::command::{Folder, GOOD};

/// A folder with `move.toml`, its capture `own.vcd`, and the bytes of that capture.
fn captured() -> (Folder, Vec<u8>) {
    let folder = Folder::with_move(GOOD);
    assert_eq!(folder.run("simulate move.toml --vcd own.vcd").status, 0);
    let bytes = std::fs::read(folder.path("own.vcd")).unwrap();
    (folder, bytes)
}

/// A capture as a logic analyser writes it; its last line has no newline.
const FOREIGN: &str = "$timescale 1 us $end\n$scope module la $end\n$var wire 1 ! D0 $end\n$var wire 1 \" D1 $end\n\
    $upscope $end\n$enddefinitions $end\n#0 0! 0\"\n#9 1!\n#11 0!\n#20";

#[test]
fn files_that_are_no_captures_are_refused() {
    let (folder, _) = captured();
    let check = |says: &str| folder.run("check c.vcd move.toml").refuses(says);
    check("c.vcd: No such file");
    folder.write("c.vcd", "");
    check("c.vcd: the capture is cut off at line 1: the header has no end");
    folder.write("c.vcd", b"\x89PNG\r\n\x1a\n\x00\x00");
    check("c.vcd: line 1 of the capture: ");
    folder.write("c.vcd", FOREIGN.replace("$timescale 1 us $end\n", ""));
    check("c.vcd: the capture has no $timescale");
    folder.write("c.vcd", FOREIGN.replace("1 us", "3 ps"));
    check("c.vcd: line 1 of the capture: a $timescale of 3; VCD has 1, 10 and 100");
    folder.write("c.vcd", FOREIGN.replace("#11", "#8"));
    folder
        .run("check c.vcd move.toml --map x.step=la.D0 --map x.dir=la.D1")
        .refuses("c.vcd: line 9 of the capture: time goes back from 9 to 8");
    folder.run("check . move.toml").refuses("cannot read .: it is a folder");
}

#[test]
fn truncated_captures_are_refused() {
    let (folder, bytes) = captured();
    let header = String::from_utf8_lossy(&bytes).find("$enddefinitions").unwrap();
    let end = bytes.len() - 1; // The last line need not have a newline.
    for cut in [
        1,
        header / 2,
        header,
        header + 14,
        header + 20,
        end / 2,
        end * 3 / 4,
        end - 30,
        end - 2,
        end - 1,
    ] {
        folder.write("c.vcd", &bytes[..cut]);
        folder.run("check c.vcd move.toml").refuses("c.vcd: the capture is cut off at line ");
    }
    folder.write("c.vcd", &bytes[..end]);
    assert_eq!(folder.run("check c.vcd move.toml").status, 0);
}

#[test]
fn captures_without_the_signals_are_refused_with_a_list_of_theirs() {
    let (folder, _) = captured();
    folder.write("c.vcd", FOREIGN);
    let check =
        |map: &str, says: &str| folder.run(&format!("check c.vcd move.toml{map}")).refuses(says);
    check(
        "",
        "the capture has no signal x.step (nor a vector step with a bit 0); it has la.D0, la.D1",
    );
    check(
        " --map x.step=la.D0",
        "the capture has no signal x.dir (nor a vector dir with a bit 0); it has la.D0, la.D1",
    );
    check(" --map x.step=la.D7", "the capture has no signal la.D7 for x.step; it has la.D0, la.D1");
    check(
        " --map x.step",
        "signal map 'x.step': write <axis>.step=<signal>, <axis>.dir=<signal>, output_<number>=<signal> or \
         pwm=<signal>",
    );
    check(" --map x.clock=la.D0", "signal map 'x.clock=la.D0': write <axis>.step=<signal>");
    check(" --map q.step=la.D0", "there is no axis 'q'; the axes are x");
    check(" --map x.step=la.D0 --map x.step=la.D1", "this pin is already mapped");
    check(" --slack-ns -1", "unexpected argument '-1'");
    check(" --origin-ps soon", "invalid value 'soon' for '--origin-ps <PS>'");
}

#[test]
fn pins_that_are_too_wide_are_refused() {
    let (folder, _) = captured();
    let check = |says: &str| folder.run("check c.vcd move.toml").refuses(says);
    let named = FOREIGN.replace("module la", "module x").replace("D0", "step").replace("D1", "dir");
    folder.write("c.vcd", named.replace("wire 1 ! step", "wire 2 ! step"));
    check(
        "c.vcd: the signal x.step of the capture has 2 bits, a pin has 1; name a bit of it with --map",
    );
    folder.write(
        "c.vcd",
        named.replace("module x", "module la").replace("wire 1 ! step", "wire 2 ! step"),
    );
    check(
        "c.vcd: the signal la.step of the capture has 2 bits, the machine has 1 axes; name a bit of it with --map",
    );
}

#[test]
fn offsets_and_uncertainties_that_check_nothing_are_refused() {
    let (folder, _) = captured();
    for origin in
        ["1000000000000000", "-1000000000000000", "9223372036854775807", "-9223372036854775808"]
    {
        let says = format!("own.vcd: with --origin-ps {origin} the moves last from {origin} to ");
        folder.run(&format!("check own.vcd move.toml --origin-ps {origin}")).refuses(&says);
    }
    for slack in ["100000000", "18446744073709551615"] {
        let says = format!("--slack-ns {slack} is over half of the shortest period; at most ");
        folder.run(&format!("check own.vcd move.toml --slack-ns {slack}")).refuses(&says);
    }
}

#[test]
fn a_check_ends_with_its_verdict() {
    let (folder, _) = captured();
    let good = folder.run("check own.vcd move.toml");
    assert!(good.status == 0 && good.stdout.ends_with("\nALL HOLDS\n"), "{}", good.stdout);
    let bad = folder.run("check own.vcd move.toml --origin-ps 0");
    assert!(bad.status == 1 && bad.stdout.ends_with("\nFAILED\n"), "{}", bad.stdout);
}

#[test]
fn foreign_capture_without_a_final_newline_is_read() {
    let (folder, _) = captured();
    folder.write("c.vcd", FOREIGN);
    let ran = folder.run("check c.vcd move.toml --map x.step=la.D0 --map x.dir=la.D1");
    assert_eq!(ran.status, 1, "{}", ran.stderr); // The capture is read, but it is not of this move.
    assert!(ran.stdout.contains("FAILED"), "{}", ran.stdout);
}

#[test]
fn our_own_capture_of_other_gateware_is_refused() {
    let (folder, _) = captured();
    let built = "recorded from gateware with clock_hz = 48000000, tick_ns = 1000, phases = 16";
    for (old, new) in [("phases = 16", "phases = 4"), ("tick_ns = 1000", "tick_ns = 2000")] {
        let other = GOOD.replace(old, new);
        folder.write("other.toml", &other);
        let ran = folder.run("check own.vcd other.toml");
        ran.refuses(built);
        ran.refuses("but the machine of other.toml has clock_hz = 48000000, ");
        ran.refuses(new);
    }
}
