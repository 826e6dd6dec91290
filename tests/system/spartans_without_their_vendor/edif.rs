//! The EDIF of Spartan boards, read by spydrnet.

use carrystep_boards::Board;
use carrystep_tests::{effort, jobs};
use carrystep_tools::clock_modules::spartans;
use carrystep_tools::kept;
use carrystep_tools::xilinx::{self, Compared, Mismatch, ReadTwice};
use carrystep_verilog::Gateware;

/// Two outputs, of which one is a bus, behind buffers.
const SMALL: &str = r#"(edif top (edifVersion 2 0 0) (edifLevel 0) (keywordMap (keywordLevel 0))
  (external LIB (edifLevel 0) (technology (numberDefinition))
    (cell OBUF (cellType GENERIC) (view VIEW (viewType NETLIST) (interface
      (port I (direction INPUT)) (port O (direction OUTPUT))))))
  (library DESIGN (edifLevel 0) (technology (numberDefinition))
    (cell top (cellType GENERIC) (view VIEW (viewType NETLIST) (interface
      (port oscillator (direction INPUT))
      (port (array (rename step "step[1:0]") 2) (direction OUTPUT)))
    (contents
      (instance (rename id1 "a.b") (viewRef VIEW (cellRef OBUF (libraryRef LIB))))
      (instance (rename id2 "a.c") (viewRef VIEW (cellRef OBUF (libraryRef LIB))))
      (net oscillator (joined (portRef oscillator) (portRef I (instanceRef id1)) (portRef I (instanceRef id2))))
      (net (rename id3 "step[0]") (joined (portRef (member step 1)) (portRef O (instanceRef id1))))
      (net (rename id4 "step[1]") (joined (portRef (member step 0)) (portRef O (instanceRef id2))))))))
  (design top (cellRef top (libraryRef DESIGN))))"#;

const UCF: &str = "# Pins.
NET \"oscillator\" LOC = \"P1\" | IOSTANDARD = LVTTL;
NET \"oscillator\" TNM_NET = \"oscillator\";
TIMESPEC \"TS_oscillator\" = PERIOD \"oscillator\" 20.000 ns HIGH 50 %;
NET \"step<0>\" LOC = \"P2\" | IOSTANDARD = LVCMOS33;
NET \"step<1>\" LOC = \"P3\" | IOSTANDARD = LVCMOS33;
";

fn read(edif: &str) -> ReadTwice {
    ReadTwice::of(edif).unwrap_or_else(|error| panic!("{error}"))
}

/// One thing changed in the constraints or in the EDIF of the small design.
fn changed(text: &str, what: &str, other: &str) -> String {
    let changed = text.replacen(what, other, 1);
    assert_ne!(changed, text, "{what} is not there");
    changed
}

#[test]
fn faults_in_names_are_seen() {
    let port = |port: &str| port.to_owned();
    let small = read(SMALL);
    assert_eq!(small.against(UCF), Ok(Compared { cells: 2, nets: 3, ports: 3 }));
    // A name misspelt in the constraints.
    assert_eq!(
        small.against(&changed(UCF, "step<1>", "setp<1>")),
        Err(vec![
            Mismatch::NoPort { port: port("setp[1]") },
            Mismatch::NoPin { port: port("step[1]") }
        ])
    );
    // A port that the EDIF does not have, and one without a pin.
    let without = changed(SMALL, "(port oscillator (direction INPUT))", "");
    let without = changed(&without, "(portRef oscillator) ", "");
    assert_eq!(
        read(&without).against(UCF),
        Err(vec![Mismatch::NoPort { port: port("oscillator") }])
    );
    let (line, _) = UCF.split_once("NET \"step<1>").expect("two bits");
    assert_eq!(small.against(line), Err(vec![Mismatch::NoPin { port: port("step[1]") }]));
    // The net at a port has another name: without `clean -purge` yosys keeps an inner one.
    let renamed = changed(SMALL, "\"step[0]\"", "\"engine.step[0]\"");
    assert_eq!(
        read(&renamed).against(UCF),
        Err(vec![Mismatch::Net { port: port("step[0]"), net: Some(port("engine.step[0]")) }])
    );
    // The bits of a bus the other way round.
    let turned =
        changed(&changed(SMALL, "\"step[0]\"", "\"step[2]\""), "\"step[1]\"", "\"step[0]\"");
    let turned = changed(&turned, "\"step[2]\"", "\"step[1]\"");
    assert_eq!(read(&turned).against(UCF).map_err(|all| all.len()), Err(2));
    // No period: the group of the net is another one.
    let found = small.against(&changed(UCF, "PERIOD \"oscillator\"", "PERIOD \"clock\""));
    assert!(
        matches!(found.as_ref().map_err(Vec::as_slice), Err([Mismatch::Line { number: 4, .. }])),
        "{found:?}"
    );
    let (no_period, _) = UCF.split_once("TIMESPEC").expect("a period");
    let rest: String = UCF.lines().skip(4).map(|line| format!("{line}\n")).collect();
    assert_eq!(small.against(&(no_period.to_owned() + &rest)), Err(vec![Mismatch::NoClock]));
}

/// The EDIF of a board's shipped gateware, with what spydrnet and our own reader find in it.
fn read_twice(board: &'static Board) -> Compared {
    let gateware = Gateware::shipped(board, &board.parts[0]).expect("gateware");
    let files = gateware.files().expect("its files");
    let texts = |end: &str| -> String {
        files
            .iter()
            .filter(|file| file.name.ends_with(end))
            .map(|file| file.text.as_str())
            .collect()
    };
    let family = board.family.facts();
    let constraints = texts(family.toolchain().constraints_end());
    let yosys = family.yosys().expect("a Spartan");
    let edif = xilinx::to_edif(&texts(".v"), &gateware.top(), yosys).expect("EDIF");
    kept::say();
    let compared = read(&edif).against(&constraints);
    let name = &board.name;
    let counts = compared.unwrap_or_else(|found| panic!("{name}: {found:?}"));
    effort::say(&format!("{name}: {counts:?}"));
    counts
}

#[test]
fn edif_of_every_board_has_the_names_of_its_constraints() {
    if !effort::is_every_board() {
        return effort::say("no whole board: `cargo xtask long spartans` reads the EDIF of all");
    }
    let boards: Vec<_> = spartans().collect();
    let all = jobs::each(&boards, |board| read_twice(board));
    let range = |of: fn(&Compared) -> usize| {
        let counts = || all.iter().map(of);
        format!("{} to {}", counts().min().unwrap_or(0), counts().max().unwrap_or(0))
    };
    effort::figures(&format!(
        "{} boards: EDIF of {} cells and {} nets, read alike by spydrnet and by us, each of {} ports \
         with its net and its pin",
        all.len(),
        range(|one| one.cells),
        range(|one| one.nets),
        range(|one| one.ports)
    ));
}
