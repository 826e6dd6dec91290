//! The golden engine vectors: programs of one axis, and a hash of all their edges.

use carrystep_core::{Segment, StartPhase};
use serde::Deserialize;
use sha2::{Digest, Sha256};

/// One case of `golden/engine_vectors.json`.
#[derive(Debug, Deserialize)]
pub struct Case {
    /// Description of the case.
    pub name: String,
    #[serde(rename = "P0")]
    p0: String,
    segments: Vec<GoldenSegment>,
    /// Ticks of all segments together.
    pub total_ticks: u64,
    /// Number of edges.
    pub pulses: usize,
    first8: Vec<Edge>,
    last8: Vec<Edge>,
    #[serde(rename = "P_end")]
    p_end: String,
    sha256_ticks_csv: String,
    sha256_edges_csv: String,
}

/// An edge: tick from 1, phase, direction +1 or -1.
pub type Edge = (u64, u32, i8);

#[derive(Debug, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
struct GoldenSegment {
    #[serde(rename = "ticks")]
    ticks: u32,
    v: String,
    a: String,
    j: String,
}

/// All cases.
pub fn engine_vectors() -> Vec<Case> {
    #[derive(Deserialize)]
    struct File {
        cases: Vec<Case>,
    }
    let file: File =
        serde_json::from_str(include_str!("../golden/engine_vectors.json")).expect("golden file");
    file.cases
}

impl Case {
    /// P before the first tick, in 2^-64 step.
    pub fn p0(&self) -> u64 {
        self.p0.parse().expect("P0")
    }

    /// P after the last tick, in 2^-64 step.
    pub fn p_end(&self) -> u64 {
        self.p_end.parse().expect("P_end")
    }

    /// The start phase of the case.
    pub fn phase(&self) -> StartPhase {
        let phase = if self.p0() == 0 { StartPhase::Zero } else { StartPhase::Half };
        assert_eq!(phase.start_value(), self.p0(), "{}: a start value that builds have", self.name);
        phase
    }

    /// The segments. The last one is marked `last`, which stops the axis after the edges that
    /// count.
    pub fn segments(&self) -> Vec<Segment> {
        let number = |text: &String| text.parse().expect("a 64-bit number");
        let count = self.segments.len();
        let segment = |(i, s): (usize, &GoldenSegment)| Segment {
            ticks: s.ticks,
            v: number(&s.v),
            a: number(&s.a),
            j: number(&s.j),
            last: i + 1 == count,
        };
        self.segments.iter().enumerate().map(segment).collect()
    }

    /// Panics with the first difference unless these are all edges of the case in order.
    pub fn assert_edges(&self, edges: &[Edge]) {
        let name = &self.name;
        let head = self.first8.len().min(edges.len());
        assert_eq!(edges[..head], self.first8[..head], "{name}: first edges");
        assert_eq!(edges.len(), self.pulses, "{name}: number of edges");
        assert_eq!(edges[edges.len() - self.last8.len()..], self.last8, "{name}: last edges");
        let join = |of: fn(&Edge) -> String| edges.iter().map(of).collect::<Vec<_>>().join(",");
        let ticks = join(|(tick, ..)| tick.to_string());
        let full = join(|(tick, phase, direction)| format!("{tick}:{phase}:{direction}"));
        let signed = join(|(tick, phase, direction)| format!("{tick}:{phase}:{direction:+}"));
        let hash = |text: &str| {
            Sha256::digest(text).iter().map(|byte| format!("{byte:02x}")).collect::<String>()
        };
        assert_eq!(hash(&ticks), self.sha256_ticks_csv, "{name}: hash of the ticks");
        assert!(
            [hash(&full), hash(&signed)].contains(&self.sha256_edges_csv),
            "{name}: hash of the edges with phase and direction"
        );
    }
}
