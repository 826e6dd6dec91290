//! The option `--junit`: writes reports as the XML that CI systems display.

use crate::failure::Failure;
use crate::output::OutputFile;
use quick_junit::{NonSuccessKind, Report, TestCase, TestCaseStatus, TestSuite};
use std::path::Path;

/// A file of test cases. It is begun before the work whose result it holds.
pub struct JunitFile {
    file: OutputFile,
    suite: TestSuite,
}

impl JunitFile {
    /// Begins the file if a path is given; `suite` is the name of the test suite.
    pub fn begin(path: Option<&Path>, suite: impl Into<String>) -> Result<Option<Self>, Failure> {
        let suite = TestSuite::new(suite.into());
        path.map(|path| Ok(Self { file: OutputFile::create(path)?, suite })).transpose()
    }

    /// Adds a test case, which passes if there are no failures.
    pub fn case(&mut self, name: impl Into<String>, failures: &[String]) {
        let status = match failures.first() {
            None => TestCaseStatus::success(),
            Some(first) => {
                let mut status = TestCaseStatus::non_success(NonSuccessKind::Failure);
                status.set_message(first.clone()).set_description(failures.join("\n"));
                status
            }
        };
        self.suite.add_test_case(TestCase::new(name.into(), status));
    }

    /// Writes the file and lets it appear.
    pub fn keep(mut self) -> Result<(), Failure> {
        let mut report = Report::new("carrystep");
        report.add_test_suite(self.suite);
        let text = report
            .to_string()
            .map_err(|error| Failure::Run(format!("no JUnit report: {error}")))?;
        self.file.text(&text)?;
        self.file.keep().map(|_| ())
    }
}
