//! What the person at the terminal is shown: a line for each binary that has ended, and the whole
//! output of those that failed.

use super::binaries::Binary;
use super::outcome::{Answers, Counts};
use super::process::EndedProcess;
use super::slices::{LONGEST, Slice};
use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// All that has ended so far.
pub struct TestReport<'a> {
    binaries: &'a [Binary],
    slices: &'a [Slice],
    outputs: &'a Path,
    /// What each slice came to.
    ended: Vec<Option<EndedProcess>>,
}

/// A line on the standard output.
pub fn line(text: &str) {
    // Nobody is left to tell if this fails.
    let _ = writeln!(std::io::stdout(), "{text}");
}

/// The file for the output of a slice.
pub fn part(outputs: &Path, binary: &Binary, slice: usize) -> PathBuf {
    outputs.join(format!("{}.{slice}.part", file_name(&binary.id)))
}

/// A binary's id without what a file's name cannot have.
fn file_name(id: &str) -> String {
    id.replace("::", ".").replace('/', ".")
}

impl<'a> TestReport<'a> {
    /// Of nothing that has ended yet.
    pub fn new(binaries: &'a [Binary], slices: &'a [Slice], outputs: &'a Path) -> Self {
        Self { binaries, slices, outputs, ended: slices.iter().map(|_| None).collect() }
    }

    /// A slice has ended; the last one of a binary has its line printed.
    pub fn add(&mut self, slice: usize, ended: EndedProcess) {
        self.ended[slice] = Some(ended);
        let place = self.slices[slice].binary;
        let own = || (0..self.slices.len()).filter(|&other| self.slices[other].binary == place);
        let parts: Option<Vec<&EndedProcess>> =
            own().map(|slice| self.ended[slice].as_ref()).collect();
        let Some(parts) = parts else { return };
        let binary = &self.binaries[place];
        let expected: f64 = own().map(|slice| self.slices[slice].seconds).sum();
        line(&(summary(&binary.id, &parts) + &surprise(&parts, expected)));
        let output: String = parts.iter().map(|part| part.output.as_str()).collect();
        let path = self.outputs.join(format!("{}.txt", file_name(&binary.id)));
        if let Err(error) = fs::write(&path, &output) {
            line(&format!("cannot write {}: {error}", path.display()));
        }
        for slice in own() {
            // A file that stays is no harm: the next run empties the folder.
            let _ = fs::remove_file(part(self.outputs, binary, slice));
        }
        if parts.iter().any(|part| part.counts.failed > 0) {
            line(&output);
        }
    }

    /// The tests of all binaries. A slice that has not ended was not run: that is a failure.
    pub fn counts(&self) -> Counts {
        let of = |(ended, slice): (&Option<EndedProcess>, &Slice)| match ended {
            Some(ended) => ended.counts,
            None => Counts { failed: slice.count.unwrap_or(1), ..Counts::default() },
        };
        self.ended.iter().zip(self.slices).map(of).fold(Counts::default(), Counts::and)
    }
}

/// `  12.3 s  5 passed, 0 failed, 0 ignored  carrystep-tests::rung_3, 11.9 s of a processor`
fn summary(id: &str, parts: &[&EndedProcess]) -> String {
    let seconds: f64 = parts.iter().map(|part| part.took.as_secs_f64()).sum();
    let counts = parts.iter().map(|part| part.counts).fold(Counts::default(), Counts::and);
    let Counts { passed, failed, ignored } = counts;
    let mut text =
        format!("{seconds:>7.1} s  {passed} passed, {failed} failed, {ignored} ignored  {id}");
    if parts.len() > 1 {
        text += &format!(", in {} slices", parts.len());
    }
    let worked: Option<Duration> = parts.iter().map(|part| part.worked).sum();
    if let Some(worked) = worked {
        text += &format!(", {:.1} s of a processor", worked.as_secs_f64());
    }
    let answers: Vec<Answers> = parts.iter().map(|part| Answers::of(&part.output)).collect();
    let all: usize = answers.iter().map(|answers| answers.all).sum();
    if all > 0 {
        let kept: usize = answers.iter().map(|answers| answers.kept).sum();
        text += &format!("; {all} answers of tools, {kept} of them kept from an earlier run");
    }
    text
}

/// Says that a binary took much longer than expected: it may have been alone at the end.
fn surprise(parts: &[&EndedProcess], expected: f64) -> String {
    let seconds: f64 = parts.iter().map(|part| part.took.as_secs_f64()).sum();
    if seconds > 3.0 * expected + LONGEST {
        format!("; {expected:.1} s were expected")
    } else {
        String::new()
    }
}

#[cfg(test)]
mod tests {
    use super::{EndedProcess, LONGEST, file_name, summary, surprise};
    use crate::testing::outcome::Counts;
    use std::time::Duration;

    #[test]
    fn a_line_says_all_of_a_binary() {
        let ended = |output: &str, worked| EndedProcess {
            counts: Counts { passed: 2, failed: 0, ignored: 1 },
            took: Duration::from_millis(1500),
            worked,
            seconds: Vec::new(),
            output: output.to_owned(),
        };
        let plain = ended("", None);
        assert_eq!(summary("a::b", &[&plain]), "    1.5 s  2 passed, 0 failed, 1 ignored  a::b");
        let worked = Some(Duration::from_millis(200));
        let with_answers =
            ended("9 answers of tools, 4 of them kept from an earlier run\n", worked);
        let line = summary("a::b", &[&with_answers, &with_answers]);
        assert!(
            line.contains(
                "    3.0 s  4 passed, 0 failed, 2 ignored  a::b, in 2 slices, 0.4 s of a"
            ),
            "{line}"
        );
        assert!(
            line.ends_with("; 18 answers of tools, 8 of them kept from an earlier run"),
            "{line}"
        );
    }

    #[test]
    fn a_binary_that_takes_long_unexpectedly_is_named() {
        let took = Duration::from_secs_f64(3.0 * LONGEST);
        let counts = Counts::default();
        let ended =
            EndedProcess { counts, took, worked: None, seconds: Vec::new(), output: String::new() };
        assert_eq!(surprise(&[&ended], LONGEST), "");
        assert_eq!(surprise(&[&ended], 2.0), "; 2.0 s were expected");
    }

    #[test]
    fn an_id_becomes_a_file() {
        assert_eq!(file_name("a::bin/b"), "a.bin.b");
    }
}
