//! Tests of valid move files: distances are exact decimals, and the steps follow their sum.

use carrystep_core::ProfileKind;
use carrystep_files::{MoveFile, SourceText};

const MACHINE: &str = "[machine]\n[[machine.axis]]\nname = \"x\"\nsteps_per_unit = 5\nspeed_limit = 1000\n\
    accel_limit = 5000\ndriver = \"a4988\"\n[[machine.axis]]\nname = \"y\"\nsteps_per_unit = 1\nspeed_limit = 1000\n\
    accel_limit = 5000\ndriver = \"a4988\"\n";

fn file(moves: &str) -> MoveFile {
    let text = format!("{MACHINE}{moves}");
    MoveFile::from_source(SourceText { path: "move.toml".into(), text: text.into() }).unwrap()
}

/// A file of moves of the axis x alone, one for each distance.
fn along_x(distances: &[&str]) -> MoveFile {
    let to =
        |distance: &&str| format!("[[move]]\nprofile = \"ranade\"\nto = {{ x = {distance} }}\n");
    file(&distances.iter().map(to).collect::<String>())
}

fn steps(file: &MoveFile) -> Vec<i64> {
    file.moves.iter().map(|m| m.steps[0]).collect()
}

#[test]
fn ten_moves_of_half_a_step_are_five_steps() {
    let file = along_x(&["0.1"; 10]);
    // Targets 0.5, 1, 1.5 ... 5 steps; halves are rounded away from zero.
    assert_eq!(steps(&file), [1, 0, 1, 0, 1, 0, 1, 0, 1, 0]);
    let rounding: Vec<f64> = file.moves.iter().map(|m| m.rounding[0]).collect();
    assert_eq!(rounding, [-0.5, 0.0].repeat(5));
    assert_eq!(steps(&along_x(&["-0.1"; 10])), [-1, 0, -1, 0, -1, 0, -1, 0, -1, 0]);
}

#[test]
fn rounding_of_targets_does_not_accumulate() {
    let file = along_x(&["0.07"; 100]); // 0.35 steps each, 35 steps in total
    assert_eq!(steps(&file).iter().sum::<i64>(), 35);
    assert!(file.moves.iter().all(|m| m.rounding[0].abs() <= 0.5));
    assert_eq!(file.moves[99].rounding[0], 0.0);
    let back = along_x(&["0.07", "0.07", "-0.14"]);
    assert_eq!(steps(&back).iter().sum::<i64>(), 0);
}

#[test]
fn axis_without_a_distance_does_not_move() {
    let file = file(
        "[[move]]\nprofile = \"constant\"\ntime = 0.5\nto = { y = -3 }\n[[move]]\nprofile = \"trapezoid\"\nto = {}\n",
    );
    assert_eq!(file.moves[0].steps, [0, -3]);
    assert_eq!(file.moves[1].steps, [0, 0]);
    assert_eq!(file.moves[0].time, Some("0.5".parse().unwrap()));
    assert_eq!(file.moves[1].time, None);
    assert_eq!(
        (file.moves[0].profile, file.moves[1].profile),
        (ProfileKind::Constant, ProfileKind::Trapezoid)
    );
}

#[test]
fn all_number_forms_of_toml_are_accepted() {
    assert_eq!(steps(&along_x(&["1_0.0", "+1e1", "0x0a", "0b1010", "1.0E+1"])), [50; 5]);
}

#[test]
fn whole_range_of_the_position_register_can_be_used() {
    let file = along_x(&["429496729.4", "-858993458.8", "429496729.4"]);
    assert_eq!(steps(&file), [2_147_483_647, -4_294_967_294, 2_147_483_647]);
}

#[test]
fn machine_file_is_resolved_from_the_move_file() {
    let folder = tempfile::tempdir().unwrap();
    let here = |name: &str| folder.path().join(name);
    std::fs::create_dir(here("machines")).unwrap();
    std::fs::write(here("machines/two.toml"), MACHINE).unwrap();
    let moves = "machine_file = \"machines/two.toml\"\n[[move]]\nprofile = \"ranade\"\nto = { x = 1, y = 2 }\n";
    std::fs::write(here("move.toml"), moves).unwrap();
    let file = MoveFile::load(&here("move.toml")).unwrap();
    assert_eq!(file.machine.axis_names(), "x, y");
    assert_eq!(file.moves[0].steps, [5, 2]);
}

#[test]
fn error_of_a_move_points_at_the_move() {
    let file = along_x(&["1", "2"]);
    let error = file.move_error(1, "too far");
    assert_eq!(error.line_column(), Some((17, 1)));
    assert_eq!(error.to_string(), "move.toml:17:1: too far");
    assert_eq!(file.move_error(2, "no such move").to_string(), "no such move");
}
