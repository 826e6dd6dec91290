//! What a test binary's output says: how many tests passed, and how many answers of tools were
//! kept.

/// Numbers of tests.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Counts {
    /// Tests that passed.
    pub passed: usize,
    /// Tests that failed, and those that did not come to an end.
    pub failed: usize,
    /// Tests that libtest counts as ignored. The runner prints their number.
    pub ignored: usize,
}

impl Counts {
    /// The sum of two.
    pub fn and(self, other: Self) -> Self {
        Self {
            passed: self.passed + other.passed,
            failed: self.failed + other.failed,
            ignored: self.ignored + other.ignored,
        }
    }

    /// What libtest's lines `test result:` say; rustdoc prints one for each crate.
    fn told(output: &str) -> Self {
        let lines = output.lines().filter_map(|line| line.strip_prefix("test result: "));
        lines.fold(Self::default(), |sum, line| {
            let number = |what: &str| {
                let part = line.split([';', '.']).find_map(|part| part.trim().strip_suffix(what));
                part.and_then(|number| number.trim().parse().ok()).unwrap_or(0)
            };
            sum.and(Self {
                passed: number("passed"),
                failed: number("failed"),
                ignored: number("ignored"),
            })
        })
    }

    /// The counts of a binary that has ended. A test that should have run and is not in the output
    /// counts as failed, and so does a bad exit status that no failed test explains.
    pub fn of(output: &str, success: bool, expected: Option<usize>) -> Self {
        let mut counts = Self::told(output);
        let ran = counts.passed + counts.failed + counts.ignored;
        counts.failed += expected.unwrap_or(0).saturating_sub(ran);
        if !success && counts.failed == 0 {
            counts.failed = 1;
        }
        counts
    }
}

/// How many answers of tools a rung used, as it prints them (`carrystep_tools::kept::summary`).
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Answers {
    /// All answers.
    pub all: usize,
    /// Those that were kept from an earlier run.
    pub kept: usize,
}

impl Answers {
    /// The last line `N answers of tools, M of them kept from an earlier run`: the counts of a
    /// process only grow.
    pub fn of(output: &str) -> Self {
        let parse = |line: &str| {
            let (all, rest) = line.split_once(" answers of tools, ")?;
            let kept = rest.strip_suffix(" of them kept from an earlier run")?;
            Some(Self { all: all.rsplit(' ').next()?.parse().ok()?, kept: kept.parse().ok()? })
        };
        output.lines().rev().find_map(parse).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::{Answers, Counts};

    const OUTPUT: &str = "
running 3 tests
test a ... 12 answers of tools, 3 of them kept from an earlier run
ok
test b ... ok
20 answers of tools, 10 of them kept from an earlier run
test c ... ignored

test result: ok. 2 passed; 0 failed; 1 ignored; 0 measured; 5 filtered out; finished in 0.50s
";

    #[test]
    fn counts_are_those_of_libtest() {
        let counts = |passed, failed, ignored| Counts { passed, failed, ignored };
        assert_eq!(Counts::of(OUTPUT, true, Some(3)), counts(2, 0, 1));
        let twice = OUTPUT.repeat(2);
        assert_eq!(Counts::of(&twice, true, None), counts(4, 0, 2));
        let failed = OUTPUT.replace("ok. 2 passed; 0 failed", "FAILED. 1 passed; 1 failed");
        assert_eq!(Counts::of(&failed, false, Some(3)), counts(1, 1, 1));
    }

    #[test]
    fn tests_that_did_not_run_are_failures() {
        assert_eq!(Counts::of(OUTPUT, true, Some(5)).failed, 2);
        // The binary was killed before it printed a result, or after it.
        assert_eq!(Counts::of("running 3 tests\ntest a ... ", false, Some(3)).failed, 3);
        assert_eq!(Counts::of(OUTPUT, false, Some(3)).failed, 1);
        assert_eq!(Counts::of("error: could not compile", false, None).failed, 1);
    }

    #[test]
    fn the_last_line_about_answers_counts() {
        assert_eq!(Answers::of(OUTPUT), Answers { all: 20, kept: 10 });
        assert_eq!(Answers::of("test a ... ok"), Answers::default());
    }
}
