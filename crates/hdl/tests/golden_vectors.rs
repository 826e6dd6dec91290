//! Checks that the axis module produces the first edges of the golden vectors, with tick, phase and
//! direction. Rung 4 of the verification ladder compares all edges.
#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches unit tests only")]

use carrystep_core::{Segment, StartPhase};
use carrystep_hdl::AxisSim;
use serde_json::Value;

const VECTORS: &str = include_str!("../../../tests/golden/engine_vectors.json");

fn number<T: std::str::FromStr<Err: std::fmt::Debug>>(value: &Value) -> T {
    value.as_str().unwrap().parse().unwrap()
}

fn segments(case: &Value) -> Vec<Segment> {
    let field = |segment: &Value, name: &str| number(&segment[name]);
    let list = case["segments"].as_array().unwrap();
    list.iter()
        .map(|s| Segment {
            ticks: s["ticks"].as_u64().unwrap().try_into().unwrap(),
            v: field(s, "V"),
            a: field(s, "A"),
            j: field(s, "J"),
            last: false,
        })
        .collect()
}

/// Runs a case for a number of ticks. Returns the edges as `tick:phase:direction`.
fn run(case: &Value, ticks: u64) -> Vec<String> {
    let start = if number::<u64>(&case["P0"]) == 0 { StartPhase::Zero } else { StartPhase::Half };
    let mut axis = AxisSim::new(16, start).unwrap();
    let mut segments = segments(case).into_iter();
    assert!(axis.offer(&segments.next().unwrap()));
    axis.tick(true); // the strobe that loads
    let mut edges = Vec::new();
    for tick in 1..=ticks {
        if !axis.waiting()
            && let Some(segment) = segments.next()
        {
            assert!(axis.offer(&segment));
        }
        let now = axis.tick(false);
        if now.crossed {
            edges.push(format!("{tick}:{}:{}", now.q, if now.back { "-1" } else { "+1" }));
        }
    }
    edges
}

#[test]
fn axis_produces_the_first_edges_of_the_golden_vectors() {
    let vectors: Value = serde_json::from_str(VECTORS).unwrap();
    for case in vectors["cases"].as_array().unwrap() {
        let first = case["first8"].as_array().unwrap();
        let edges = run(case, first.last().unwrap()[0].as_u64().unwrap());
        let expected = first
            .iter()
            .map(|edge| format!("{}:{}:{:+}", edge[0], edge[1], edge[2].as_i64().unwrap()));
        assert_eq!(edges, expected.collect::<Vec<_>>(), "{}", case["name"]);
    }
}
