//! Numbers in the docs are those that the product gives.

use carrystep_levels::{Job, Level, run};
use carrystep_tests::moves;
use std::fs;

fn page(name: &str) -> String {
    fs::read_to_string(moves::root().join("docs").join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// Whole numbers as the page writes them, in groups of three.
fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let groups = digits.as_bytes().rchunks(3).rev().map(|group| String::from_utf8_lossy(group).into_owned());
    groups.collect::<Vec<_>>().join(" ")
}

#[test]
fn the_flow_of_a_move_has_the_real_numbers() {
    let text = page("flow-of-a-move.md");
    let plan = moves::demo();
    let x = &plan.moves[0].axes[0];
    for segment in &x.segments {
        let wanted = [segment.ticks.to_string(), segment.v.to_string(), segment.a.to_string()];
        let there = text.lines().any(|line| line.split_whitespace().take(3).eq(wanted.iter()));
        assert!(there, "no line '{}'", wanted.join("  "));
    }
    assert!(text.contains(&format!("60.795 ms, {} ticks", plan.moves[0].ticks)));
    assert!(text.contains(&grouped(x.segments[0].a.unsigned_abs())));
    assert!(text.contains(&grouped(x.segments[0].v.unsigned_abs())));

    let program = plan.program();
    let mut first = None;
    let job = Job::new(&plan.build, &program, plan.total_ticks());
    run(Level::Model, &job, &mut |cycle, outputs| {
        if outputs.step & 1 == 1 && first.is_none() {
            first = Some(cycle);
        }
    })
    .expect("the model");
    let first = first.expect("a pulse on x");
    assert!(text.contains(&grouped(first)), "the first edge is in cycle {first}");
    assert!(text.contains(&grouped(plan.build.timebase.clock_to_ps(first))));
    let pulses: u64 = plan.moves.iter().flat_map(|m| &m.axes).map(|a| a.steps.unsigned_abs()).sum();
    assert!(text.contains(&format!("{pulses} edges")));
}
