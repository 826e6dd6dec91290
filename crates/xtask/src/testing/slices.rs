//! Splits the tests of long binaries, so that none of them keeps one core busy at the end.

use super::binaries::Binary;
use super::memory::TestTimes;

/// A slice is split where it is expected to take more seconds than this.
pub const LONGEST: f64 = 40.0;

/// Binaries that are not split, because their tests share something that takes long to make, or start
/// a worker for each core by themselves.
const TOGETHER: [&str; 3] = [
    "carrystep-tests::rung_6_netlist_and_bitstream_equal_verilog",
    "carrystep-tests::rung_7_promises_are_proved",
    "carrystep-tests::rung_8_mutants_are_caught",
];

/// Tests that mostly wait for a board or a line that runs in real time: the binary, and how the names
/// of such tests begin.
const WAITING: [(&str, &[&str]); 3] = [
    (
        "carrystep-cli::command_line",
        &["boards::wrong_peer_on_the_port_is_named", "stops::line_that_is_lost_during_a_run"],
    ),
    ("carrystep-virtual-board::virtual_board", &["late_host::"]),
    ("carrystep-linuxcnc::spidev", &["what_is_wrong_with_an_spi_is_named"]),
];

/// Binaries that wait for a good part of their time, each in all of its slices: two of them share a
/// core.
const HALF: [&str; 5] = [
    "carrystep-cli::clusters",
    "carrystep-cli::command_line",
    "carrystep-linuxcnc::component",
    "carrystep-linuxcnc::hal",
    "carrystep-linuxcnc::spidev",
];

/// What a slice needs of the computer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Needs {
    /// One core.
    OneCore,
    /// Half of one core.
    HalfACore,
    /// Hardly anything: it runs beside others.
    Patience,
}

impl Needs {
    /// What the tests of a binary need that do not wait.
    fn of(binary: &str) -> Self {
        if HALF.contains(&binary) { Self::HalfACore } else { Self::OneCore }
    }

    /// What a test needs.
    fn of_test(binary: &str, test: &str) -> Self {
        let names = WAITING.iter().find(|(name, _)| *name == binary).map(|(_, names)| *names);
        match names {
            Some(names) if names.iter().any(|name| test.starts_with(name)) => Self::Patience,
            _ => Self::of(binary),
        }
    }
}

/// Tests of a binary that run in one process, one after the other.
#[derive(Debug, Clone, PartialEq)]
pub struct Slice {
    /// Which binary.
    pub binary: usize,
    /// The tests, by name; none: all, without asking for their names.
    pub names: Vec<String>,
    /// How many tests it has, where that is known.
    pub count: Option<usize>,
    /// What it needs.
    pub needs: Needs,
    /// How long it is expected to take.
    pub seconds: f64,
}

/// The slices of a binary; none where it has no tests.
pub fn of(place: usize, binary: &Binary, tests: &[String], memory: &TestTimes) -> Vec<Slice> {
    let id = binary.id.as_str();
    if !binary.lists {
        let seconds = memory.expect(id, &[String::new()]).into_iter().sum();
        let needs = Needs::of(id);
        return vec![Slice { binary: place, names: Vec::new(), count: None, needs, seconds }];
    }
    let expected = memory.expect(id, tests);
    let mut slices = Vec::new();
    for needs in [Needs::OneCore, Needs::HalfACore, Needs::Patience] {
        let own: Vec<usize> =
            (0..tests.len()).filter(|&test| Needs::of_test(id, &tests[test]) == needs).collect();
        let seconds: f64 = own.iter().map(|&test| expected[test]).sum();
        let is_one = TOGETHER.contains(&id);
        let parts = if is_one { 1.0 } else { (seconds / LONGEST).ceil().max(1.0) };
        let parts = split(&own, &expected, (parts as usize).min(own.len()));
        slices.extend(parts.into_iter().map(|part| Slice {
            binary: place,
            names: if part.len() == tests.len() {
                Vec::new()
            } else {
                part.iter().map(|&test| tests[test].clone()).collect()
            },
            count: Some(part.len()),
            needs,
            seconds: part.iter().map(|&test| expected[test]).sum(),
        }));
    }
    slices
}

/// So many parts of these tests, of nearly equal length: each test, the longest first, goes to the
/// part that is the shortest so far.
fn split(tests: &[usize], seconds: &[f64], parts: usize) -> Vec<Vec<usize>> {
    let mut order = tests.to_vec();
    order.sort_by(|&one, &other| seconds[other].total_cmp(&seconds[one]));
    let mut all = vec![(0.0_f64, Vec::new()); parts];
    for test in order {
        let shortest = all.iter_mut().min_by(|one, other| one.0.total_cmp(&other.0));
        if let Some((sum, part)) = shortest {
            // A test of no time would leave parts without any.
            *sum += seconds[test].max(1e-3);
            part.push(test);
        }
    }
    all.into_iter().map(|(_, part)| part).collect()
}

#[cfg(test)]
mod tests {
    use super::{Binary, LONGEST, Needs, TOGETHER, TestTimes, WAITING, of, split};

    fn binary(id: &str) -> Binary {
        let (program, folder) = (id.into(), ".".into());
        Binary {
            id: id.to_owned(),
            program,
            arguments: vec![],
            folder,
            environment: vec![],
            lists: true,
        }
    }

    fn memory(id: &str, tests: &[(&str, f64)]) -> (TestTimes, Vec<String>) {
        let mut memory = TestTimes::default();
        let tests: Vec<(String, f64)> =
            tests.iter().map(|(name, seconds)| ((*name).to_owned(), *seconds)).collect();
        memory.learn(id, &tests);
        (memory, tests.into_iter().map(|(name, _)| name).collect())
    }

    #[test]
    fn a_long_binary_is_split_and_no_test_is_lost() {
        let seconds = [0.0, LONGEST, 1.0, 2.0, LONGEST, 30.0];
        let named: Vec<(String, f64)> = (0..).map(|n: u32| format!("t{n}")).zip(seconds).collect();
        let named: Vec<(&str, f64)> =
            named.iter().map(|(name, seconds)| (name.as_str(), *seconds)).collect();
        let (memory, tests) = memory("a", &named);
        let slices = of(3, &binary("a"), &tests, &memory);
        assert_eq!(slices.len(), 3);
        let mut names: Vec<String> = slices.iter().flat_map(|slice| slice.names.clone()).collect();
        names.sort();
        assert_eq!(names, tests);
        assert!(
            slices.iter().all(|slice| slice.binary == 3 && slice.count == Some(slice.names.len()))
        );
        assert!(slices.iter().all(|slice| slice.seconds <= LONGEST + 2.0));
    }

    #[test]
    fn short_binaries_and_those_that_share_stay_whole() {
        for (id, seconds) in [("a", 1.0), (TOGETHER[0], 1000.0)] {
            let (memory, tests) = memory(id, &[("x", seconds), ("y", seconds)]);
            let slices = of(0, &binary(id), &tests, &memory);
            assert_eq!(slices.len(), 1);
            assert_eq!((slices[0].names.len(), slices[0].count), (0, Some(2)));
        }
    }

    #[test]
    fn a_binary_without_tests_has_no_slice() {
        assert!(of(0, &binary("a"), &[], &TestTimes::default()).is_empty());
    }

    #[test]
    fn tests_that_wait_have_slices_of_their_own() {
        let (id, names) = WAITING[0];
        let waiting = format!("{}one", names[0]);
        let (memory, tests) =
            memory(id, &[(&*waiting, LONGEST), ("a::one", 1.0), ("a::two", LONGEST)]);
        let slices = of(0, &binary(id), &tests, &memory);
        let needs: Vec<_> = slices.iter().map(|slice| (slice.needs, slice.names.len())).collect();
        assert_eq!(needs, [(Needs::HalfACore, 1), (Needs::HalfACore, 1), (Needs::Patience, 1)]);
        assert_eq!(slices[2].names, [waiting]);
    }

    #[test]
    fn no_part_is_empty() {
        let tests: Vec<usize> = (0..5).collect();
        assert!(split(&tests, &[0.0; 5], 5).iter().all(|part| part.len() == 1));
        assert!(split(&[], &[], 0).is_empty());
    }
}
