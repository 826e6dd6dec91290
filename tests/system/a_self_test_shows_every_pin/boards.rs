//! The self-test of each board from its own top level: every output becomes active once a round,
//! alone, with its name on the UART; every input that a jumper pulls to ground is reported; a byte
//! from the terminal comes back with a list of all pins; `enable_n` is high in every clock.

use carrystep_boards::{Board, Family, Placer, board, boards};
use carrystep_tests::self_test_board::SelfTestSession;
use carrystep_tests::{board_clock, effort, jobs};
use carrystep_tools::board::{BuildJob, build};
use carrystep_tools::ice40::{self, NextpnrPart};
use carrystep_tools::{ecp5, gowin, kept, xilinx};
use carrystep_verilog::SelfTestGateware;

/// A whole session; every assertion is about the recorded pins.
fn session(board: &'static Board, spi: bool) -> SelfTestSession {
    let name = &board.name;
    let mut session = SelfTestSession::new(board, spi);
    let test = session.test.clone();
    let last_output = test.last_output();
    let line = session.longest_line();

    // The first round: every output, and then the heading again.
    session.run_until_active(0, 2);
    session.run(line);
    let rounds: String = (0..=last_output).chain([0]).map(|row| test.line(row, true)).collect();
    assert_eq!(session.text(), rounds, "{name}");
    for (row, (active, clocks)) in session.walk[..=last_output].iter().enumerate() {
        assert_eq!(*active, 1 << row, "{name}");
        assert!(*clocks >= 2 * u64::from(test.half_clocks()), "{name}: {row} for {clocks} clocks");
    }

    // A jumper at each input, one after the other. A line of the walk may come first.
    for row in session.inputs() {
        for level in [false, true] {
            session.jumper(row, level);
            let said = test.line(row, level);
            let text = session.run_until_said(&said, 2 * line + 200);
            assert!(text.ends_with(&said), "{name}: {said} is not in\n{text}");
        }
    }

    // The terminal: the byte comes back, and all rows follow without a gap. Meanwhile the same
    // output stays active.
    session.jumper(test.last_input(), false);
    session.run(2 * line + 200);
    session.text();
    session.send(b"?");
    session.run((test.last_row() as u64 + 3) * line);
    let said = session.text();
    let list = |slot: usize| {
        let level = |row| if row > last_output { row != test.last_input() } else { row == slot };
        (0..=test.last_row()).map(|row| test.line(row, level(row))).collect::<String>()
    };
    let is_said = |slot| said.contains(&format!("?{}", list(slot)));
    assert!((0..=last_output).any(is_said), "{name}: no echo with\n{}in\n{said}", list(0));
    session
}

/// Verilog of a board with the bench's model of its clock manager.
fn simulated(board: &Board, verilog: &str) -> String {
    match board.family {
        Family::Ice40 => board_clock::with_bench_pll(verilog),
        Family::Ecp5 => ecp5::simulated(verilog).expect("models of its cells"),
        Family::Gowin => gowin::simulated(verilog).expect("models of its cells"),
        _ => xilinx::simulated(verilog).expect("models of its cells"),
    }
}

/// What the tools make of a session's Verilog: the bitstream of an iCE40 and the EDIF of a
/// Spartan's cells, read back, and the netlist of an ECP5 or a Gowin part.
fn read_back(board: &Board, session: &SelfTestSession) -> String {
    if let Some(family) = board.family.facts().yosys() {
        let edif = xilinx::to_edif(&session.verilog, &session.top(), family).expect("EDIF");
        return xilinx::from_edif(&edif).expect("EDIF");
    }
    if board.family == Family::Ecp5 {
        return ecp5::FLOW.synthesise(&session.verilog, &session.top()).expect("a netlist").verilog;
    }
    if board.family == Family::Gowin {
        return gowin::FLOW
            .synthesise(&session.verilog, &session.top())
            .expect("a netlist")
            .verilog;
    }
    let part = &board.parts[0];
    let netlist = ice40::synthesise(&session.verilog, &session.top(), &part.name);
    let netlist = netlist.expect("a netlist");
    let part = NextpnrPart { device: &part.name, package: &part.package };
    let placed = netlist.place_on(part, &session.pcf(), session.clock_hz(), 1).expect("a design");
    placed.read_back(&netlist, &placed.asc).expect("a bitstream")
}

/// Compares the session with the board's Verilog and with what the tools make of it, in every
/// clock, and plants faults. An ordinary run plants them on the iCEstick: they are in what all
/// boards have in common.
fn on_the_pins(board: &'static Board, spi: bool) {
    let session = session(board, spi);
    let compare = |verilog: &str| session.difference(&simulated(board, verilog));
    let name = &board.name;
    effort::say(&format!("{name}: {} cycles on every pin", session.cycles()));
    assert_eq!(compare(&session.verilog), None, "{name}: the Verilog");
    let is_netlist = matches!(board.family, Family::Ecp5 | Family::Gowin);
    if effort::is_every_board() || name == "icestick" || is_netlist {
        assert_eq!(compare(&read_back(board, &session)), None, "{name}: read back");
    }
    if !effort::is_every_board() && (name != "icestick" || spi) {
        return kept::say();
    }
    let last_input = format!("assign pins[{}]", session.test.last_input());
    for (wire, other) in [
        ("enable_n = 1'b1", "enable_n = 1'b0"),
        ("= active[1];", "= active[2];"),
        (&last_input, &last_input.replace("pins[", "unconnected[")),
    ] {
        let planted = session.verilog.replace(wire, other);
        assert!(planted != session.verilog, "{name}: {wire} is not there");
        let planted = planted.replace("wire clock;", "wire clock; wire [63:0] unconnected;");
        assert!(compare(&planted).is_some(), "{name}: {other} is not seen");
    }
    kept::say();
}

/// The self-test of an iCE40 or ECP5 board, with its real times, fits and reaches its clock.
#[test]
fn self_test_of_a_board_becomes_a_bitstream() {
    become_bitstreams(|board| {
        let is_placed = board.family.facts().placer().is_some_and(|placer| placer != Placer::Gowin);
        is_placed && (effort::is_every_board() || board.name == "icestick")
    });
}

/// The same for Gowin boards, in a long run.
#[test]
fn gowin_self_tests_become_bitstreams() {
    become_bitstreams(|board| board.family == Family::Gowin && effort::is_every_board());
}

fn become_bitstreams(is_chosen: impl Fn(&Board) -> bool) {
    let placed: Vec<&'static Board> = boards().iter().filter(|board| is_chosen(board)).collect();
    if placed.is_empty() {
        return effort::say("none: the long runs cover all");
    }
    jobs::each(&placed, |board| {
        let part = &board.parts[0];
        let gateware = SelfTestGateware::new(board, part, false).expect("a self-test");
        let files = gateware.files().expect("its files");
        let texts = |end: &str| {
            let of_kind = files.iter().filter(|file| file.name.ends_with(end));
            of_kind.map(|file| file.text.as_str()).collect::<String>()
        };
        let job = BuildJob {
            verilog: &texts(".v"),
            top: &gateware.top(),
            constraints: &texts(board.family.facts().toolchain().constraints_end()),
            part,
            clock_hz: gateware.clock_hz(),
        };
        let built = build(&job, &mut |_| ()).expect("a bitstream");
        let (name, size, clock_hz) = (&board.name, built.size, gateware.clock_hz());
        assert!(built.reaches(clock_hz), "{name}: {} MHz for {clock_hz} Hz", built.mhz);
        assert!(built.bitstream.len() > 30_000, "{name}");
        effort::say(&format!(
            "{name}: {} logic cells, {} block RAMs, {:.1} MHz",
            size.logic_cells, size.block_rams, built.mhz
        ));
    });
    effort::figures(&format!("{} self-tests as bitstreams, each in time", placed.len()));
    kept::say();
}

/// An ordinary run has a board of each family whose bitstream or netlist it reads back; the
/// self-tests of Spartans are left to the long run.
#[test]
fn every_pin_of_a_board_is_what_its_self_test_says() {
    let some = ["icestick", "orangecrab"];
    show_every_pin(|board| {
        let is_asked = effort::is_every_board() && board.family != Family::Gowin;
        is_asked || some.contains(&&*board.name)
    });
}

#[test]
fn gowin_self_tests_show_every_pin() {
    show_every_pin(|board| {
        let is_asked = effort::is_every_board() || board.name == "tang-nano-9k";
        board.family == Family::Gowin && is_asked
    });
}

fn show_every_pin(is_chosen: impl Fn(&Board) -> bool) {
    let chosen: Vec<&'static Board> = boards().iter().filter(|board| is_chosen(board)).collect();
    jobs::each(&chosen, |board| on_the_pins(board, false));
    let line = format!(
        "{} self-tests from their pins, as Verilog and as bitstream, EDIF or netlist",
        chosen.len()
    );
    if effort::is_every_board() {
        effort::figures(&format!("{line}, three planted faults seen on each"));
    } else {
        effort::say(&line);
    }
}

/// With a host at the SPI, the pins of both are those of the SPI.
#[test]
fn shared_pins_are_those_of_the_spi_if_a_host_is_wired_to_it() {
    let icestick = board("icestick").expect("a board");
    let lists = |spi| {
        let rows = icestick.self_test(48_000_000, spi).expect("a self-test");
        (rows.outputs.join(" "), rows.inputs.join(" "))
    };
    let (outputs, inputs) = lists(false);
    assert!(outputs.ends_with("dir[5] outputs[0] outputs[1]"), "{outputs}");
    assert!(inputs.contains("probe interlock") && !inputs.contains("spi"), "{inputs}");
    let (outputs, inputs) = lists(true);
    assert!(outputs.ends_with("dir[5] spi_miso"), "{outputs}");
    assert!(inputs.ends_with("spi_cs_n spi_sck spi_mosi"), "{inputs}");
    on_the_pins(icestick, true);
}

/// The lines on the page are those of the iCEstick.
#[test]
fn lines_on_the_page_are_those_of_the_icestick() {
    let page = include_str!("../../../docs/self-test.md");
    let (_, rest) = page.split_once("```text\ncarrystep self-test").expect("a block of lines");
    let (block, _) = rest.split_once("```").expect("its end");
    let rows = board("icestick").expect("a board").self_test(48_000_000, false).expect("its rows");
    let known: Vec<String> = (0..=rows.test.last_row())
        .flat_map(|row| [false, true].map(|level| rows.test.line(row, level)))
        .collect();
    for line in format!("carrystep self-test{block}").lines() {
        assert!(known.iter().any(|row| row.trim_end() == line), "{line} is not sent:\n{known:#?}");
    }
}
