//! Builds the benchmarks and the released command that they measure, and runs them.

use crate::shell::{self, TaskResult};
use crate::tools;
use serde_json::Value;
use std::fs;

/// The page with the tables of jobs, and its marks.
const PAGE: &str = "docs/performance.md";
const BEGIN: &str = "<!-- `cargo xtask bench jobs` writes from here ... -->\n";
const END: &str = "<!-- ... to here -->\n";

/// The same for the benchmark of jobs.
const BUILD_JOBS: [&str; 10] = [
    "build",
    "--quiet",
    "--release",
    "-p",
    "carrystep-xtask",
    "-p",
    "carrystep-cli",
    "--bench=jobs",
    "--bin=carrystep",
    "--message-format=json-render-diagnostics",
];

/// One call of cargo for both, with all crates of the workspace: their features are then those of a
/// test run, which has compiled everything but the benchmark itself.
const BUILD: [&str; 9] = [
    "build",
    "--quiet",
    "--release",
    "--workspace",
    "--bench",
    "levels",
    "--bin",
    "carrystep",
    "--message-format=json-render-diagnostics",
];

/// Times everything. What is printed is the benchmark's own output.
pub fn run(json: bool, smoke: bool) -> TaskResult {
    tools::install()?;
    let messages = shell::read_stdout("cargo", &BUILD)?;
    let levels = executable(&messages, "levels", "bench")?;
    let carrystep = executable(&messages, "carrystep", "bin")?;
    let mut arguments = vec!["--carrystep", &carrystep];
    arguments.extend(json.then_some("--json"));
    arguments.extend(smoke.then_some("--smoke"));
    shell::run(&levels, &arguments)
}

/// Measures the planner of jobs, and writes its tables into the page; a smoke run writes nothing.
pub fn jobs(smoke: bool) -> TaskResult {
    tools::install()?;
    let messages = shell::read_stdout("cargo", &BUILD_JOBS)?;
    let jobs = executable(&messages, "jobs", "bench")?;
    let carrystep = executable(&messages, "carrystep", "bin")?;
    let mut arguments = vec!["--carrystep", &carrystep];
    arguments.extend(smoke.then_some("--smoke"));
    let tables = shell::read_stdout(&jobs, &arguments)?;
    shell::say(&tables);
    if smoke {
        return Ok(());
    }
    let path = shell::root().join(PAGE);
    let page = fs::read_to_string(&path).map_err(|error| shell::cannot("read", &path, &error))?;
    let (before, rest) = page.split_once(BEGIN).ok_or("the page has lost its mark for jobs")?;
    let (_, after) = rest.split_once(END).ok_or("the page has lost the end of its tables")?;
    fs::write(&path, format!("{before}{BEGIN}\n{tables}\n{END}{after}"))
        .map_err(|error| shell::cannot("write", &path, &error))
}

/// The path of an executable in cargo's messages, one JSON document a line.
///
/// # Errors
/// It was not built; or it was built without optimisation, and so were the generic functions of other
/// crates that it measures.
fn executable(messages: &str, name: &str, kind: &str) -> Result<String, String> {
    let messages = messages.lines().filter_map(|line| serde_json::from_str::<Value>(line).ok());
    let mut built = messages
        .filter(|message| message["target"]["name"] == name && message["target"]["kind"][0] == kind)
        .filter_map(|message| Some((message["executable"].as_str()?.to_owned(), message)));
    match built.next() {
        None => Err(format!("cargo has built no {kind} {name}")),
        Some((_, message)) if message["profile"]["opt_level"] == "0" => {
            Err(format!("{kind} {name} is not optimised: see [profile.release] in Cargo.toml"))
        }
        Some((path, _)) => Ok(path),
    }
}

#[cfg(test)]
mod tests {
    use super::executable;
    use serde_json::json;

    #[test]
    fn executable_is_found_by_name_and_kind() {
        let built = |name: &str, kind: &str, path: &str, level: &str| {
            json!({"target": {"name": name, "kind": [kind]}, "executable": path,
                "profile": {"opt_level": level}})
            .to_string()
        };
        let messages = [
            "a build script prints this".to_owned(),
            built("levels", "lib", "/lib", "3"),
            built("levels", "bench", "/bench", "3"),
            built("jobs", "bench", "/jobs", "0"),
        ]
        .join("\n");
        assert_eq!(executable(&messages, "levels", "bench"), Ok("/bench".to_owned()));
        assert!(executable(&messages, "carrystep", "bin").is_err());
        assert!(executable(&messages, "jobs", "bench").unwrap_err().contains("is not optimised"));
    }
}
