//! The tool table: its file format, and the codes that use it.

use crate::support::{self, point};
use carrystep_gcode::{Canon, GcodeError, Interpreter, Options, Step, Tool, ToolTable};
use proptest::prelude::*;
use std::io::Cursor;

const TABLE: &str = "\
; the tools of the mill
T1 P1 D3.175 Z12.5 ; end mill; 1/8 inch
t2 p2 x+.5 Y-1 z20 a5 B0 C-7 U0 I10 J20 Q3

T7
";

fn table(text: &str) -> Result<ToolTable, GcodeError> {
    ToolTable::read(Cursor::new(text.to_owned()), "tools.tbl")
}

/// Reads a program with [`TABLE`]. The results are its steps and the table after it.
fn run(text: &str) -> Result<(Vec<Step>, ToolTable), GcodeError> {
    let options = Options { tools: Some(table(TABLE)?), ..Options::default() };
    let mut program = Interpreter::new(Cursor::new(text.to_owned()), "p.ngc", &options)?;
    let steps = program.by_ref().collect::<Result<_, _>>()?;
    Ok((steps, program.tools().cloned().unwrap_or_default()))
}

/// The Z coordinates to which a program moves.
fn zs(text: &str) -> Vec<f64> {
    let z = |step: Step| match step.canon {
        Canon::Traverse { to } => Some(to[2]),
        _ => None,
    };
    run(text).unwrap_or_else(|error| panic!("{error}")).0.into_iter().filter_map(z).collect()
}

#[test]
fn tool_table_is_read_as_linuxcnc_writes_it() {
    let table = table(TABLE).unwrap();
    let tools: Vec<(u32, Tool)> = table.iter().map(|(number, tool)| (number, *tool)).collect();
    let tool = |offset, diameter| Tool { offset, diameter };
    let expected = [
        (1, tool([0.0, 0.0, 12.5, 0.0, 0.0, 0.0], 3.175)),
        (2, tool([0.5, -1.0, 20.0, 5.0, 0.0, -7.0], 0.0)),
        (7, Tool::default()),
    ];
    assert_eq!(tools, expected);
}

#[test]
fn malformed_tool_tables_are_refused_with_line_and_column() {
    let long = "x".repeat(70_000);
    for (text, place, words) in [
        ("T1 Z1\nT1", "2", "tool 1 is in the table twice"),
        ("T1\nZ1 P1", "2", "a tool needs T, its number"),
        ("T1  Zx", "1:5", "`x` is no number"),
        ("T1 Z1e5", "1:4", "`1e5` is no number"),
        ("T1 Znan", "1:4", "`nan` is no number"),
        ("T1 Z", "1:4", "`` is no number"),
        ("T1 Z99999999999", "1:4", "too great"),
        ("T1.5", "1:1", "not a whole number"),
        ("T100000", "1:1", "out of its range"),
        ("T1 Z1 Z2", "1:7", "Z occurs twice"),
        ("T1 U3", "1:4", "found `U3`"),
        ("1 1 0.5 3.175", "1:1", "found `1`"),
        ("T1 Z1\nT2 \u{e9}1", "2:4", "found"),
        (&long, "1", "longer than"),
    ] {
        let shown = table(text).unwrap_err().to_string();
        assert!(shown.starts_with(&format!("tools.tbl:{place}: ")), "{shown} {text}");
        assert!(shown.contains(words), "{shown} {words}");
    }
    let bytes = Cursor::new(b"T1 \xff".to_vec());
    let shown = ToolTable::read(bytes, "t").unwrap_err().to_string();
    assert!(shown.starts_with("t:1:4: byte 0xff"), "{shown}");
    let absent = ToolTable::open("/nowhere/tools.tbl".as_ref()).unwrap_err().to_string();
    assert!(absent.starts_with("/nowhere/tools.tbl: cannot read"), "{absent}");
}

#[test]
fn the_offset_of_a_tool_is_in_effect_from_g43_to_g49() {
    assert_eq!(zs("T1 M6\nG0 Z1\nG43\nZ1\nG49 Z2"), [1.0, 13.5, 2.0]);
    assert_eq!(zs("G43 H1 G0 Z1\nT2 M6\nZ2\nG43 Z3"), [13.5, 14.5, 23.0]);
    assert_eq!(zs("G43 H1\nG43.2 H2\nG0 Z1\nG43.2 Z0.5\nZ2\nG43\nZ3"), [33.5, 35.0, 3.0]);
    assert_eq!(zs("T1 M6 G20\nG43 G0 Z1"), [37.9]);
    // T alone does not change the tool.
    assert_eq!(zs("T1 M6\nT2\nG43 G0 Z1"), [13.5]);
}

#[test]
fn g10_changes_the_table_but_not_the_offset_in_effect() {
    let text = "T1 M6\nG43 G0 Z0\nG20\nG10 L1 P1 Z1 R0.5\nG21 Z1\nG43 Z1\nG10 L10 P7 Z-3\nG43 H7\n\
                (debug, #5400 #5403 #5410 #5422)";
    let (steps, table) = run(text).unwrap();
    assert!(zs(text).iter().zip([12.5, 13.5, 26.4]).all(|(z, wanted)| (z - wanted).abs() < 1e-12));
    assert_eq!(*table.get(1).unwrap(), Tool { offset: [0., 0., 25.4, 0., 0., 0.], diameter: 25.4 });
    assert!((table.get(7).unwrap().offset[2] - 29.4).abs() < 1e-12);
    let message = steps.into_iter().find_map(|step| match step.canon {
        Canon::Message(text) => Some(text),
        _ => None,
    });
    assert_eq!(message.as_deref(), Some("1.000000 25.400000 25.400000 -3.000000"));
}

#[test]
fn tools_that_are_not_in_the_table_are_refused() {
    for (text, place, words) in [
        ("G0 T3", "1:4", "the tool table has no tool 3"),
        ("G0 G43 H3", "1:8", "the tool table has no tool 3"),
        ("G43 H0", "1:5", "G43 with H0"),
        ("G43 H1.5", "1:5", "not a whole number"),
        ("G0 X1 H1", "1:7", "nothing in this line uses H"),
        ("G10 L1 P3 Z1", "1:8", "the tool table has no tool 3"),
        ("G10 L1 P0 Z1", "1:8", "P is 0"),
        ("G10 L1 Z1", "1:1", "G10 needs P"),
        ("G10 L11 P1 Z1", "1:5", "L is 11, out of its range"),
        ("G10 L1 P1 Q2", "1:11", "nothing in this line uses Q"),
        ("G10 L1 P1 Z9999999999", "1:11", "over 1000000000"),
        ("G43.2", "1:1", "G43.2 needs the offset"),
        ("G43.2 H1 Z3", "1:1", "H and axis words exclude"),
        ("G43.2 H1 G0 Z3", "1:10", "both use the axis words"),
        ("#5403=1", "1:1", "can only be read"),
    ] {
        let shown = run(text).unwrap_err().to_string();
        assert!(shown.starts_with(&format!("p.ngc:{place}: ")), "{shown} {text}");
        assert!(shown.contains(words), "{shown} {words}");
    }
    for text in ["G43", "G43 H1", "G43.2 H1", "G10 L1 P1 Z1", "G10 L10 P1 Z1"] {
        let shown = support::steps(text).unwrap_err().to_string();
        assert!(shown.contains("without a tool table"), "{shown}");
    }
}

proptest! {
    #[test]
    fn after_g10_l10_and_g43_the_present_place_has_the_wanted_coordinates(
        at in point(), wanted in point(), origin in point(), rotation in 0_i32..360, inches: bool,
    ) {
        let words = support::words;
        let text = format!(
            "G{}\nG10 L2 P1 {} R{rotation}\nG0 {}\nG43 H2\nG92 X7 Z5\nG10 L10 P7 {}\nG43 H7\n\
             (print,#5420 #5421 #5422 #5423 #5424 #5425)",
            if inches { 20 } else { 21 }, words(&origin), words(&at), words(&wanted),
        );
        let (steps, _) = run(&text).map_err(|error| TestCaseError::fail(error.to_string()))?;
        let shown = steps.into_iter().find_map(|step| match step.canon {
            Canon::Message(text) => Some(text),
            _ => None,
        });
        let expected: Vec<String> = wanted.iter().map(|value| format!("{value:.6}")).collect();
        let shown = shown.unwrap_or_default().replace("-0.000000", "0.000000");
        prop_assert_eq!(shown, expected.join(" ").replace("-0.000000", "0.000000"));
    }
}
