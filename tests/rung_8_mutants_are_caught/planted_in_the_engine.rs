//! Bugs planted in the modules of the engine: of the kinds that an independent bench found alive,
//! and of the modules that the shipped machine does not have. The recordings of the mutants must
//! catch each of them.

use carrystep_core::{EngineBuild, PinTiming};
use carrystep_simulators::engine::replay::difference_of_mutant;
use carrystep_tests::mutants::planted::{Planted, plant};
use carrystep_tests::mutants::stimuli::{self, Engine};
use carrystep_tests::{effort, jobs};

/// A bug: description, module, text around the expression, the expression, and what it becomes. The
/// last text is part of the names of the recordings that are tried first.
type Bug = (&'static str, &'static str, &'static str, &'static str, &'static str, &'static str);

/// Bugs of the pulser of one axis.
const PULSER: [Bug; 8] = [
    (
        "a step that comes as another rises is lost",
        "pulser",
        "due <= {};",
        "(pending & !rise & !frozen) | second",
        "pending & !rise & !frozen",
        "is crowded",
    ),
    (
        "a step stays due in a freeze",
        "pulser",
        "due <= {};",
        "(pending & !rise & !frozen) | second",
        "(pending & !rise) | second",
        "rests with a step",
    ),
    (
        "a step is due for one clock",
        "pulser",
        "due <= {};",
        "(pending & !rise & !frozen) | second",
        "(request & !rise & !frozen) | second",
        "rests with a step",
    ),
    (
        "no step is a second one",
        "pulser",
        "wire second = {};",
        "due & request",
        "1'b0",
        "is crowded",
    ),
    (
        "the second step has the direction of the first",
        "pulser",
        "if ({}) begin",
        "!due | rise",
        "!due",
        "is crowded",
    ),
    (
        "a step that comes as another rises is late",
        "pulser",
        "wire late_now = {};",
        "second & !rise & !frozen",
        "second & !frozen",
        "is crowded",
    ),
    (
        "a late step is not counted as discarded",
        "pulser",
        "if ({}) begin",
        "(frozen & pending) | late_now",
        "frozen & pending",
        "is crowded",
    ),
    (
        "the wanted direction is taken before it is latched",
        "pulser",
        "aim = {};\n        if (pending)",
        "want",
        "has_sign ? sign_back : want",
        "is crowded",
    ),
];

/// Bugs of other modules, of the kinds that were found alive.
const KINDS: [Bug; 4] = [
    (
        "a segment that ends in the ramp of a seek is an underrun",
        "queue",
        "assign dry = {};",
        "moves & ended & !last_one & none & !ramp",
        "moves & ended & !last_one & none",
        "in the ramp of a seek",
    ),
    (
        "no limit is found in the tick in which the axis stops",
        "engine",
        ".goes({}),",
        "queue_moves & !adder_still",
        "queue_goes_on & !adder_still",
        "at the limit",
    ),
    (
        "a clear does not wait for the pins",
        "stops",
        "!wiping & {} &",
        "!pins_busy",
        "1'b1",
        "at a clear",
    ),
    (
        "warm for a clock without power",
        "supervisor",
        "assign warm = {};",
        "is_warm & power",
        "is_warm",
        "without power",
    ),
];

/// Bugs of what the shipped machine does not have.
const NEW: [Bug; 17] = [
    (
        "a start changes no output",
        "output_control",
        "begun <= {};",
        "starts | follower",
        "follower",
        "outputs",
    ),
    ("all outputs change", "output_control", "(levels & {})", "~mask", "8'd0", "outputs"),
    (
        "an output changes one segment late",
        "output_control",
        "place <= {};",
        "live",
        "live - 5'd1",
        "outputs",
    ),
    (
        "what another axis commits is stored",
        "output_control",
        "wire stores = {};",
        "commits & first",
        "commits",
        "outputs",
    ),
    (
        "another axis may switch outputs",
        "output_control",
        "| {});",
        "(!first & (of_others != 32'd0))",
        "(!first & (of_others[11:0] != 12'd0))",
        "stray bits",
    ),
    (
        "a ramp leaves outputs on",
        "engine",
        "stops_frozen | {} |",
        "(stops_fault & (OFF_AT_RAMPS != 1'b0))",
        "1'b0",
        "outputs in a ramp",
    ),
    (
        "the PWM is on one step longer",
        "pulse_width",
        "high <= {};",
        "(count < width) & !off",
        "(count <= width) & !off",
        "duties",
    ),
    (
        "the PWM stays on for a clock",
        "pulse_width",
        "high <= {};",
        "(count < width) & !off",
        "count < width",
        "outputs in a",
    ),
    (
        "a cut keeps no running segment",
        "queue",
        "wire keeps = {};",
        "waits | (is_live & stays & !follows)",
        "waits",
        "cuts",
    ),
    (
        "a cut keeps a segment that ends",
        "queue",
        "wire keeps = {};",
        "waits | (is_live & stays & !follows)",
        "waits | (is_live & stays)",
        "cuts",
    ),
    (
        "a cut ignores a segment that is partly written",
        "queue",
        "(!keeps | {});",
        "(next_due != 3'd0)",
        "1'b0",
        "cuts",
    ),
    (
        "a cut is not refused",
        "cut_control",
        "assign cuts = closing & {};",
        "!denied",
        "1'b1",
        "cuts",
    ),
    (
        "the count of edges wraps",
        "edge_latch",
        "if (!waits & {}) begin",
        "(further != MOST)",
        "1'b1",
        "edges",
    ),
    (
        "an axis that does not seek slows",
        "seek_control",
        "slowing <= slowing | {};",
        "waiting",
        "(waiting | (waiting << 1))",
        "seek of the switch",
    ),
    (
        "the last axis does not hit",
        "seek_control",
        "slowing <= slowing | {};",
        "axis_one_hot",
        "(axis_one_hot & 6'd31)",
        "seek of own",
    ),
    (
        "a snapshot takes the tick of the latch",
        "readout",
        "(swept & latches) | {};",
        "comes",
        "1'b0",
        "hits, latch",
    ),
    (
        "an input of row 3 is the interlock",
        "switches",
        "inputs & row[0] & {} &",
        "axis_one_hot[0]",
        "axis_one_hot[1]",
        "stop nothing",
    ),
];

/// The axes of the shipped machine whose drivers are so slow that the steps of a move in one
/// direction crowd. Where no step is due while another one comes, the bugs of a pulser that are
/// about it do no harm.
const SLOW: [usize; 2] = [3, 5];

/// The bugs of one axis: in its pulser, and in what `idle` and a clear wait for. Each has the text
/// that is part of the names of the recordings that are tried first.
fn of_axis(build: &EngineBuild, axis: usize) -> Vec<(Planted, String)> {
    let mut all = Vec::new();
    let PinTiming { step_high, step_low, .. } = build.pins[axis];
    for (name, module, around, right, wrong, by) in PULSER {
        // A pulser does not know its axis, but its timing.
        let wrong = format!(
            "(STEP_HIGH == 32'd{step_high} && STEP_LOW == 32'd{step_low}) ? ({wrong}) : ({right})"
        );
        let name = format!("axis {axis}: {name}");
        all.push((Planted::new(name, module, around, right, wrong), format!("axis {axis} {by}")));
    }
    for (pin, around, by) in [
        ("held_back", "| {} |", format!("axis {axis} rests with a step")),
        ("step", "| {};", format!("a pulse of axis {axis}")),
    ] {
        let name = format!("axis {axis}: rests in spite of {pin}");
        let right = format!("pulser_{axis}_{pin}");
        all.push((Planted::new(name, "engine", around, right, "1'b0"), by));
    }
    all
}

fn planted(bugs: &[Bug]) -> Vec<(Planted, String)> {
    let one = |&(name, module, around, right, wrong, by): &Bug| {
        (Planted::new(name, module, around, right, wrong), by.to_owned())
    };
    bugs.iter().map(one).collect()
}

/// The bugs that no recording catches.
fn alive(engine: &Engine, bugs: &[(Planted, String)]) -> Vec<String> {
    let Engine { built: (_, verilog), stimuli } = engine;
    let verilog = plant(verilog, &bugs.iter().map(|(bug, _)| bug.clone()).collect::<Vec<_>>());
    let differs = |number: usize, recording| {
        difference_of_mutant(&verilog, number, recording).expect("the tools").is_some()
    };
    let numbers: Vec<usize> = (1..=bugs.len()).collect();
    let found = jobs::each(&numbers, |number| {
        let (bug, by) = &bugs[number - 1];
        let (first, others): (Vec<_>, Vec<_>) =
            stimuli.iter().partition(|stimulus| stimulus.name.contains(by.as_str()));
        let mut all = first.into_iter().chain(others);
        let catcher = all.find(|stimulus| differs(*number, &stimulus.recording));
        // A recording that differs from the engine without a bug would catch everything.
        let catcher = catcher.filter(|stimulus| !differs(0, &stimulus.recording));
        let by = catcher.map_or("no recording", |stimulus| &stimulus.name);
        effort::say(&format!("{} is caught by {by}", bug.name));
        catcher.is_none().then(|| bug.name.clone())
    });
    found.into_iter().flatten().collect()
}

/// True if all mutants are run, and not only a few.
fn is_long() -> bool {
    std::env::var_os("CARRYSTEP_MUTANTS").is_some()
}

/// A test run plants the bugs of the last axis, a long one those of all axes.
#[test]
fn bugs_in_the_engine_with_everything_are_caught() {
    let engine = stimuli::full();
    let build = &engine.built.0;
    let first = if is_long() { 0 } else { build.axes() - 1 };
    let of_axes = (first..build.axes()).flat_map(|axis| of_axis(build, axis));
    let bugs: Vec<_> =
        [planted(&KINDS), planted(&NEW)].concat().into_iter().chain(of_axes).collect();
    assert_eq!(alive(&engine, &bugs), [""; 0], "no recording catches these");
}

/// Only in a long run: the recordings of the shipped engine take longer.
#[test]
fn bugs_in_the_shipped_engine_are_caught() {
    if !is_long() {
        return;
    }
    let engine = stimuli::shipped();
    let of_axes = SLOW.into_iter().flat_map(|axis| of_axis(&engine.built.0, axis));
    let bugs: Vec<_> = planted(&KINDS).into_iter().chain(of_axes).collect();
    assert_eq!(alive(&engine, &bugs), [""; 0], "no recording catches these");
}
