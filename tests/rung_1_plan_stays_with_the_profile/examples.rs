//! Plans that were once difficult: an hour, one step, the article's own moves, reversals, refusals.

use crate::verify::{STEP, edges_of, verify};
use carrystep_files::MoveFile;
use carrystep_plan::{Plan, PlanError, plan};
use carrystep_tests::random_moves::file;

/// A machine with one axis, x, and ticks of 1 us.
fn machine(start: &str, speed: &str, accel: &str, phase: &str) -> String {
    format!("[machine]\nphase = \"{phase}\"\n") + &axis_table("x", start, speed, accel)
}

fn axis_table(name: &str, start: &str, speed: &str, accel: &str) -> String {
    format!(
        "[[machine.axis]]\nname = \"{name}\"\nsteps_per_unit = 1.0\nstart_speed = {start}\nspeed_limit = {speed}\n\
         accel_limit = {accel}\nstep_high_ns = 100\nstep_low_ns = 100\ndir_setup_ns = 200\ndir_hold_ns = 200\n"
    )
}

fn moving(profile: &str, time: Option<&str>, steps: i64) -> String {
    let time = time.map_or(String::new(), |t| format!("time = {t}\n"));
    format!("[[move]]\nprofile = \"{profile}\"\n{time}to = {{ x = {steps} }}\n")
}

fn planned(text: &str) -> (MoveFile, Plan) {
    let file = file(text);
    let plan = plan::<f64>(&file).unwrap_or_else(|error| panic!("{error}"));
    verify(&file, &plan, Some(2e-9));
    (file, plan)
}

#[test]
fn an_hour_long_triangle_stays_within_nanoseconds() {
    let text =
        machine("0.0", "1000.0", "1000.0", "half") + &moving("ranade", Some("3600.0"), 1_000_000);
    let (_, plan) = planned(&text);
    let segments = plan.moves[0].axes[0].segments.len();
    println!("{segments} segments");
    assert!((300..3000).contains(&segments), "{segments}");
}

#[test]
fn one_step_moves_land_in_both_directions() {
    for phase in ["half", "zero"] {
        for profile in ["ranade", "trapezoid"] {
            let text = machine("0.0", "5000.0", "25000.0", phase)
                + &moving(profile, None, 1)
                + &moving(profile, None, -1);
            planned(&text);
        }
    }
}

#[test]
fn move_that_fails_in_the_article_lands_exactly() {
    let text =
        machine("100.0", "20000.0", "25000.0", "half") + &moving("ranade", Some("2.0"), 6000);
    let (file, plan) = planned(&text);
    assert_eq!(plan.moves[0].axes[0].shape, "triangle");
    assert_eq!(plan.moves[0].axes[0].segments.iter().map(|s| s.ticks).sum::<u32>(), 2_000_000);
    let (edges, p) = edges_of(plan.axis_segments(0), 1 << 63, 4);
    assert_eq!((edges.len(), p), (6000, (1 << 63) + 6000 * STEP));
    let last = edges.windows(2).map(|e| e[1].tick - e[0].tick).next_back().unwrap();
    assert!(last > 5000, "the last pulses come as slowly as the first: {last} ticks, not one");
    drop(file);
}

#[test]
fn edges_of_a_constant_move_equal_table_1_of_the_article() {
    let golden: serde_json::Value =
        serde_json::from_str(include_str!("../golden/ranade.json")).unwrap();
    let expected: Vec<u64> =
        serde_json::from_value(golden["table1"]["pulses_article"].clone()).unwrap();
    // 0.2 steps per tick of 1 us are 5 steps in 25 us.
    let text =
        machine("200000.0", "200000.0", "1.0e9", "zero") + &moving("constant", Some("25.0e-6"), 5);
    let (_, plan) = planned(&text);
    let (edges, _) = edges_of(plan.axis_segments(0), 0, 4);
    let ticks: Vec<u64> = edges.iter().map(|edge| edge.tick + 1).collect();
    assert_eq!(ticks, expected);
}

#[test]
fn phase_zero_refuses_a_time_of_fractional_ticks() {
    let text =
        machine("0.0", "5000.0", "25000.0", "zero") + &moving("ranade", Some("0.5000005"), 100);
    let error = plan::<f64>(&file(&text)).unwrap_err();
    assert!(matches!(error, PlanError::NotWholeTicks { .. }));
    assert!(error.to_string().contains("0.500001 s"), "{error}");
}

#[test]
fn refused_moves_can_be_planned_with_the_proposed_value() {
    fn text(profile: &str, start: &str, time: Option<&str>) -> String {
        machine(start, "5000.0", "25000.0", "half") + &moving(profile, time, 1000)
    }
    for (profile, start, time, limit) in [
        ("ranade", "1000.0", "0.32", "accel_limit"),
        ("ranade", "1000.0", "0.1", "speed_limit"),
        ("trapezoid", "1000.0", "0.39", "accel_limit"),
        ("trapezoid", "0.0", "0.2", "accel_limit"),
        ("constant", "1000.0", "0.999", "start_speed"),
    ] {
        let error = plan::<f64>(&file(&text(profile, start, Some(time)))).unwrap_err();
        let PlanError::Refused { least_time: Some(least), refusal, .. } = &error else {
            panic!("{error}")
        };
        assert_eq!(refusal.limit.to_string(), limit, "{error}");
        println!("{error}");
        planned(&text(profile, start, Some(&format!("{least:?}"))));
        let less = format!("{:.9}", least - 2e-6);
        assert!(plan::<f64>(&file(&text(profile, start, Some(&less)))).is_err());
    }
    let error = plan::<f64>(&file(&text("constant", "0.0", None))).unwrap_err();
    assert!(matches!(error, PlanError::Refused { least_time: None, .. }));
    assert!(error.to_string().starts_with("move 1, axis x: needs a start_speed over 0"), "{error}");
}

#[test]
fn reversals_rest_only_if_the_pin_timing_needs_it() {
    let slow = machine("0.0", "5000.0", "25000.0", "half");
    let back_and_forth =
        moving("ranade", None, 10) + &moving("ranade", None, -10) + &moving("ranade", None, 10);
    let (_, plan) = planned(&(slow + &back_and_forth));
    assert!(
        plan.moves.iter().all(|m| m.rest_ticks == 0),
        "milliseconds from rest are set-up enough"
    );

    for phase in ["half", "zero"] {
        let abrupt = machine("200000.0", "200000.0", "1.0e9", phase)
            .replace("dir_setup_ns = 200\n", "dir_setup_ns = 20000\n");
        let moves = ["constant", "constant", "constant", "constant"].iter().zip([-5, 5, 5, -5]);
        let moves: String = moves.map(|(profile, steps)| moving(profile, None, steps)).collect();
        let (_, plan) = planned(&(abrupt + &moves));
        let rests: Vec<u64> = plan.moves.iter().map(|m| m.rest_ticks).collect();
        assert!(
            rests[0] > 15 && rests[1] > 15 && rests[2] == 0 && rests[3] > 15,
            "{phase}: {rests:?}"
        );
    }
}

#[test]
fn program_lists_commands_in_the_order_in_which_they_are_needed() {
    use carrystep_core::Command;
    let moves = "[[move]]\nprofile = \"ranade\"\nto = { x = 300, y = -7 }\n[[move]]\nprofile = \"ranade\"\nto = { y = 30 }\n";
    let text = machine("0.0", "5000.0", "25000.0", "half")
        + &axis_table("y", "10.0", "700.0", "900.0")
        + moves;
    let file = file(&text);
    let plan = plan::<f64>(&file).unwrap();
    verify(&file, &plan, Some(2e-9));
    let (mut ticks, mut starts) = ([0_u64; 2], 0);
    let mut reached = 0;
    for command in plan.program() {
        match command {
            Command::Segment { axis, segment } => {
                let need = &mut ticks[usize::from(axis)];
                assert!(*need >= reached, "sent after it is needed");
                reached = *need;
                *need += u64::from(segment.ticks);
            }
            Command::Start { mask } => {
                starts += 1;
                assert_eq!(mask, 0b11);
                assert!(ticks.iter().all(|&t| t > reached), "all masked axes have a segment");
            }
            Command::Wait { .. } | Command::Clear | Command::Outputs(_) => panic!("{command:?}"),
        }
    }
    assert_eq!((starts, ticks), (2, [plan.total_ticks(); 2]));
}
