//! Files with which other programs start the shards of a sweep on many machines, and merge them.
//!
//! Each scheduler starts the same two scripts, `shard.sh` and `merge.sh`. The files are templates
//! in `templates/`.

use crate::error::SweepError;
use crate::file::SweepFile;
use minijinja::{Environment, UndefinedBehavior, Value, context};

/// The longest sweep file for Kubernetes, bytes. A ConfigMap holds at most 1 MiB, scripts included.
const MOST_IN_CONFIG_MAP: usize = 1_000_000;

/// How often Kubernetes starts each shard again, on average over all shards.
const RETRIES: u64 = 3;

/// A file for a scheduler.
#[derive(Debug)]
pub struct ClusterFile {
    /// The name of the file.
    pub name: &'static str,
    /// Its text.
    pub text: String,
}

/// The commands that run the shards of a sweep. All paths are absolute.
pub struct Cluster<'a> {
    /// The sweep.
    pub sweep: &'a SweepFile,
    /// The path of the sweep file.
    pub file: &'a str,
    /// The folder of the scripts, in which the shards also keep their progress.
    pub folder: &'a str,
    /// The path of the executable.
    pub carrystep: &'a str,
    /// The version of carrystep.
    pub version: &'a str,
    /// The gateware: engine or parallel.
    pub core: &'a str,
    /// Number of shards, at least 1.
    pub shards: u64,
}

impl Cluster<'_> {
    /// A job array for Slurm, and the job that merges.
    ///
    /// # Errors
    /// A path that cannot be quoted for a shell.
    pub fn slurm(&self) -> Result<Vec<ClusterFile>, SweepError> {
        let mut files = self.scripts()?;
        files.push(self.filled("shards.sbatch", include_str!("../templates/shards.sbatch"))?);
        files.push(self.filled("merge.sbatch", include_str!("../templates/merge.sbatch"))?);
        Ok(files)
    }

    /// A script for GNU parallel.
    ///
    /// # Errors
    /// As [`Cluster::slurm`].
    pub fn parallel(&self) -> Result<Vec<ClusterFile>, SweepError> {
        let mut files = self.scripts()?;
        files.push(self.filled("run.sh", include_str!("../templates/run.sh"))?);
        Ok(files)
    }

    /// An indexed Job for Kubernetes whose containers run this image, and the Job that merges. The
    /// sweep file is a part of these files; the paths in `self` are not used.
    ///
    /// # Errors
    /// The sweep file is too long for a ConfigMap, or its moves name a machine file.
    pub fn kubernetes(&self, image: &str) -> Result<Vec<ClusterFile>, SweepError> {
        let refused =
            |why: String| SweepError::NotMade(format!("{}: {why}", self.sweep.path().display()));
        let length = self.sweep.text().len();
        if length > MOST_IN_CONFIG_MAP {
            return Err(refused(format!(
                "it has {length} bytes, and a ConfigMap of Kubernetes has room for {MOST_IN_CONFIG_MAP}"
            )));
        }
        if self.sweep.case(0).machine_file.is_some() {
            return Err(refused(
                "its moves name a machine file, which the containers do not have\n  help: describe the [machine] in the sweep file".to_owned(),
            ));
        }
        let inside = Self {
            file: "/carrystep/sweep.toml",
            folder: "/shards",
            carrystep: "carrystep",
            ..*self
        };
        let shard = inside.shard("", "$((JOB_COMPLETION_INDEX + 1))")?.text;
        let merge = inside.merge()?.text;
        let more = context! {
            name => format!("sweep-{}", self.sweep.fingerprint(self.core)),
            text => self.sweep.text(),
            retries => self.shards.saturating_mul(RETRIES),
            image, shard, merge,
        };
        let all = context! { ..more, ..self.context() };
        Ok(vec![
            filled("sweep.yaml", include_str!("../templates/sweep.yaml"), &all)?,
            filled("merge.yaml", include_str!("../templates/merge.yaml"), &all)?,
        ])
    }

    /// The scripts that every scheduler starts.
    fn scripts(&self) -> Result<Vec<ClusterFile>, SweepError> {
        Ok(vec![self.shard(": sh shard.sh NUMBER", "\"$1\"")?, self.merge()?])
    }

    fn shard(&self, usage: &str, number: &str) -> Result<ClusterFile, SweepError> {
        let all = context! { usage, number, ..self.context() };
        filled("shard.sh", include_str!("../templates/shard.sh"), &all)
    }

    fn merge(&self) -> Result<ClusterFile, SweepError> {
        self.filled("merge.sh", include_str!("../templates/merge.sh"))
    }

    fn filled(&self, name: &'static str, template: &str) -> Result<ClusterFile, SweepError> {
        filled(name, template, &self.context())
    }

    fn context(&self) -> Value {
        let sample = self.sweep.sample().map_or(String::new(), |n| format!(" --sample {n}"));
        let options = format!("--core {}{sample} --seed {}", self.core, self.sweep.seed());
        let Self { file, folder, carrystep, version, shards, .. } = *self;
        context! { file, folder, carrystep, version, shards, options }
    }
}

fn filled(name: &'static str, template: &str, values: &Value) -> Result<ClusterFile, SweepError> {
    let mut environment = Environment::new();
    environment.set_undefined_behavior(UndefinedBehavior::Strict);
    environment.add_filter("sh", sh);
    environment.add_filter("yaml", yaml);
    let text = environment
        .render_str(template, values)
        .map_err(|error| SweepError::NotMade(format!("cannot make {name}: {error:#}")))?;
    // The template engine drops the newline at the end.
    Ok(ClusterFile { name, text: text + "\n" })
}

/// A text as one word of a POSIX shell.
fn sh(text: &str) -> Result<String, minijinja::Error> {
    shlex::try_quote(text).map(String::from).map_err(|error| {
        minijinja::Error::new(minijinja::ErrorKind::InvalidOperation, error.to_string())
    })
}

/// A text as a double-quoted scalar of YAML. Everything that is not printable ASCII is escaped,
/// because readers of YAML refuse some characters and change others.
fn yaml(text: &str) -> String {
    let mut quoted = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => quoted.extend(['\\', c]),
            '\n' => quoted.push_str("\\n"),
            ' '..='~' => quoted.push(c),
            c => quoted.push_str(&format!("\\U{:08X}", u32::from(c))),
        }
    }
    quoted + "\""
}

#[cfg(test)]
mod tests {
    use super::{sh, yaml};
    use proptest::prelude::*;
    use saphyr::{LoadableYamlNode, Yaml};
    use std::process::Command;

    proptest! {
        #[test]
        fn yaml_reads_back_what_was_quoted(text in any::<String>()) {
            let line = format!("key: {}\n", yaml(&text));
            let read = Yaml::load_from_str(&line).expect("YAML");
            prop_assert_eq!(read[0]["key"].as_str(), Some(text.as_str()));
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(50))]
        #[test]
        fn a_shell_reads_back_what_was_quoted(text in "[^\0]*") {
            let word = sh(&text).expect("no null byte");
            let script = format!("printf %s {word}");
            let output = Command::new("sh").args(["-c", &script]).output().expect("a shell");
            prop_assert_eq!(output.stdout, text.as_bytes());
            // GNU parallel passes each word to a second shell.
            let twice = format!("sh -c {}", sh(&script).expect("no null byte"));
            let output = Command::new("sh").args(["-c", &twice]).output().expect("a shell");
            prop_assert_eq!(output.stdout, text.as_bytes());
        }
    }

    #[test]
    fn a_word_with_a_null_byte_is_refused() {
        assert!(sh("a\0b").is_err());
    }
}
