//! Bugs planted in the modules of the engine, of the kinds that an independent bench found alive
//! and of the modules that the shipped machine does not have. The recordings of the mutants must
//! catch each of them.

use carrystep_core::{EngineBuild, PinTiming};
use carrystep_simulators::engine::replay::difference_of_mutant;
use carrystep_tests::mutants::planted::{Planted, plant};
use carrystep_tests::mutants::stimuli::{self, Engine};
use carrystep_tests::{effort, jobs};

/// Bugs of the pulser of one axis: description, text around the expression, expression, and what
/// it becomes.
const PULSER: [(&str, &str, &str, &str); 8] = [
    (
        "a step that comes as another rises is lost",
        "due <= {};",
        "(pending & !rise & !frozen) | second",
        "pending & !rise & !frozen",
    ),
    (
        "a step stays due in a freeze",
        "due <= {};",
        "(pending & !rise & !frozen) | second",
        "(pending & !rise) | second",
    ),
    (
        "a step is due for one clock",
        "due <= {};",
        "(pending & !rise & !frozen) | second",
        "(request & !rise & !frozen) | second",
    ),
    ("no step is a second one", "wire second = {};", "due & request", "1'b0"),
    ("the second step has the direction of the first", "if ({}) begin", "!due | rise", "!due"),
    (
        "a step that comes as another rises is late",
        "wire late_now = {};",
        "second & !rise & !frozen",
        "second & !frozen",
    ),
    (
        "a late step is not counted as discarded",
        "if ({}) begin",
        "(frozen & pending) | late_now",
        "frozen & pending",
    ),
    (
        "the wanted direction is taken before it is latched",
        "aim = {};\n        if (pending)",
        "want",
        "has_sign ? sign_back : want",
    ),
];

/// Bugs of other modules: description, module, text around the expression, expression, and what it
/// becomes.
const ELSEWHERE: [(&str, &str, &str, &str, &str); 4] = [
    (
        "a segment that ends in the ramp of a seek is an underrun",
        "queue",
        "assign dry = {};",
        "moves & ended & !last_one & none & !ramp",
        "moves & ended & !last_one & none",
    ),
    (
        "no limit is found in the tick in which the axis stops",
        "engine",
        ".goes({}),",
        "queue_moves & !adder_still",
        "queue_goes_on & !adder_still",
    ),
    ("a clear does not wait for the pins", "stops", "!wiping & {} &", "!pins_busy", "1'b1"),
    ("warm for a clock without power", "supervisor", "assign warm = {};", "is_warm & power", "is_warm"),
];

/// Bugs of what the shipped machine does not have.
const NEW: [(&str, &str, &str, &str, &str); 16] = [
    ("a start changes no output", "output_control", "begun <= {};", "starts | follower", "follower"),
    ("all outputs change", "output_control", "(levels & {})", "~mask", "8'd0"),
    (
        "a duty of another axis is stored",
        "output_control",
        "wire stores = {};",
        "commits & first",
        "commits",
    ),
    (
        "another axis may switch outputs",
        "output_control",
        "| {});",
        "(!first & (of_others != 32'd0))",
        "(!first & (of_others[11:0] != 12'd0))",
    ),
    ("a ramp leaves outputs on", "engine", "stops_frozen | {} |", "(stops_fault & (OFF_AT_RAMPS != 1'b0))", "1'b0"),
    ("the PWM is on one step longer", "pulse_width", "high <= {};", "(count < width) & !off", "(count <= width) & !off"),
    ("the PWM's pin stays on", "pulse_width", "high <= {};", "(count < width) & !off", "count < width"),
    ("a cut keeps no running segment", "queue", "wire keeps = {};", "waits | (is_live & stays & !follows)", "waits"),
    ("a cut keeps a segment that ends", "queue", "wire keeps = {};", "waits | (is_live & stays & !follows)", "waits | (is_live & stays)"),
    ("a cut ignores a half-written segment", "queue", "(!keeps | {});", "(next_due != 3'd0)", "1'b0"),
    ("a cut is not refused", "cut_control", "assign cuts = closing & {};", "!denied", "1'b1"),
    ("the count of edges wraps", "edge_latch", "if (!waits & {}) begin", "(further != MOST)", "1'b1"),
    ("an axis that does not seek slows", "seek_control", "slowing <= slowing | {};", "waiting", "(waiting | (waiting << 1))"),
    ("the last axis does not hit", "seek_control", "slowing <= slowing | {};", "axis_one_hot", "(axis_one_hot & 6'd31)"),
    (
        "a snapshot takes the tick of the latch",
        "readout",
        "(swept & latches) | {};",
        "comes",
        "1'b0",
    ),
    ("an input of row 3 is the interlock", "switches", "inputs & row[0] & {} &", "axis_one_hot[0]", "axis_one_hot[1]"),
];

/// The bugs that can be planted in an engine, one for each axis where it is about one axis.
fn planted(build: &EngineBuild, is_full: bool) -> Vec<Planted> {
    let mut all = Vec::new();
    for (name, module, around, right, wrong) in ELSEWHERE.into_iter().chain(NEW.into_iter().filter(|_| is_full)) {
        all.push(Planted::new(name, module, around, right, wrong));
    }
    for (axis, pins) in build.pins.iter().enumerate() {
        let PinTiming { step_high, step_low, .. } = pins;
        for (name, around, right, wrong) in PULSER {
            // A pulser does not know its axis, but its timing.
            let wrong = format!("(STEP_HIGH == 32'd{step_high} && STEP_LOW == 32'd{step_low}) ? ({wrong}) : ({right})");
            all.push(Planted::new(format!("axis {axis}: {name}"), "pulser", around, right, wrong));
        }
        for (name, pin) in [("held back", "held_back"), ("high", "step")] {
            let right = format!("pulser_{axis}_{pin}");
            let around = if pin == "step" { "| {};" } else { "| {} |" };
            let name = format!("axis {axis}: rests while a step is {name}");
            all.push(Planted::new(name, "engine", around, right, "1'b0"));
        }
    }
    all
}

/// The bugs that no recording catches.
fn alive(engine: &Engine, is_full: bool) -> Vec<String> {
    let Engine { built: (build, verilog), stimuli } = engine;
    if std::env::var("R8TIME").is_ok() {
        let n: u64 = stimuli.iter().map(|s| s.recording.clocks).sum();
        effort::say(&format!("clocks {n} in {} stimuli", stimuli.len()));
        for s in stimuli {
            effort::say(&format!("{} {}", s.recording.clocks, s.name));
            if s.recording.clocks == 2_000_000 {
                for x in s.recording.outputs.iter().filter(|x| x.1.started || x.1.fault.is_some()).rev().take(1) {
                    effort::say(&format!("   {x:?}"));
                }
                effort::say(&format!("   {:?}\n   {:?}", s.recording.outputs.last(), s.recording.stimuli.last()));
            }
        }
        return Vec::new();
    }
    let planted = planted(build, is_full);
    let verilog = plant(verilog, &planted);
    let differs = |number: usize, recording| {
        difference_of_mutant(&verilog, number, recording).expect("the tools").is_some()
    };
    assert!(!differs(0, &stimuli[0].recording), "without a bug nothing differs");
    let numbers: Vec<usize> = (1..=planted.len()).collect();
    let found = jobs::each(&numbers, |number| {
        let name = &planted[number - 1].name;
        // Recordings of the axis that the bug is about come first, and those of what all axes have.
        let axis = name.split_once(':').map_or("", |(axis, _)| axis);
        let (own, others): (Vec<_>, Vec<_>) =
            stimuli.iter().partition(|stimulus| !axis.is_empty() && stimulus.name.contains(axis));
        let mut all = own.into_iter().chain(others);
        let catcher = all.find(|stimulus| differs(*number, &stimulus.recording));
        effort::say(&format!("{name}: {}", catcher.map_or("ALIVE", |stimulus| &stimulus.name)));
        catcher.is_none().then(|| name.clone())
    });
    found.into_iter().flatten().collect()
}

#[test]
fn bugs_in_the_engine_with_everything_are_caught() {
    assert_eq!(alive(&stimuli::full(), true), [""; 0], "no recording catches these");
}

#[test]
fn bugs_in_the_shipped_engine_are_caught() {
    assert_eq!(alive(&stimuli::shipped(), false), [""; 0], "no recording catches these");
}
