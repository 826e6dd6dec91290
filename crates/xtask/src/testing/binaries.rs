//! The test binaries of the workspace, as cargo builds and describes them.

use super::SEED;
use crate::shell;
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// A test binary, or `cargo test --doc`.
#[derive(Debug, Clone)]
pub struct Binary {
    /// `package` for its unit tests, `package::name` for an integration test, and
    /// `package::bin/name` for the unit tests of a command.
    pub id: String,
    /// What is started.
    pub program: PathBuf,
    /// Arguments that come first.
    pub arguments: Vec<String>,
    /// The folder in which it is started: that of its package.
    pub folder: PathBuf,
    /// The variables that cargo sets for it, and the seed of random cases.
    pub environment: Vec<(String, String)>,
    /// Whether it takes libtest's `--list`. The documentation's tests do not.
    pub lists: bool,
}

/// Everything that `cargo test` has built.
#[derive(Debug)]
pub struct Workspace {
    /// All test binaries, and the tests in the documentation.
    pub binaries: Vec<Binary>,
    /// Cargo's target folder.
    pub target: PathBuf,
}

/// Builds all test binaries in one call of cargo.
///
/// # Errors
/// Something does not compile.
pub fn build() -> Result<Workspace, String> {
    let metadata = shell::read("cargo", &["metadata", "--no-deps", "--format-version", "1"])?;
    let metadata: Value =
        serde_json::from_str(&metadata).map_err(|error| format!("cargo metadata: {error}"))?;
    let build = [
        "test",
        "--release",
        "--workspace",
        "--no-run",
        "--message-format=json-render-diagnostics",
    ];
    shell::say(&format!("$ cargo {}", build.join(" ")));
    let messages = shell::read_stdout("cargo", &build)?;
    let mut binaries = binaries(&messages, &packages(&metadata))?;
    command(&messages).iter().for_each(|built| shell::use_carrystep(built));
    if binaries.is_empty() {
        return Err("cargo built no test binary".to_owned());
    }
    binaries.push(documentation());
    let target =
        metadata["target_directory"].as_str().ok_or("cargo metadata names no target folder")?;
    Ok(Workspace { binaries, target: target.into() })
}

/// The command that was built for the tests of the command line.
fn command(messages: &str) -> Option<PathBuf> {
    let messages = messages.lines().filter_map(|line| serde_json::from_str::<Value>(line).ok());
    let mut commands = messages.filter(|message| {
        message["target"]["name"] == "carrystep" && message["profile"]["test"] == false
    });
    commands.find_map(|message| message["executable"].as_str().map(PathBuf::from))
}

/// The tests in the documentation, which rustdoc compiles and runs by itself.
fn documentation() -> Binary {
    Binary {
        id: "documentation".to_owned(),
        program: "cargo".into(),
        arguments: ["test", "--release", "--workspace", "--doc", "--"].map(str::to_owned).into(),
        folder: shell::root(),
        environment: vec![owned(SEED)],
        lists: false,
    }
}

/// The variables that cargo sets for the tests of each package, by the package's id.
fn packages(metadata: &Value) -> BTreeMap<String, Vec<(String, String)>> {
    let packages = metadata["packages"].as_array().into_iter().flatten();
    packages.map(|package| (text(&package["id"]), variables(package))).collect()
}

/// `CARGO_MANIFEST_*` and `CARGO_PKG_*` of a package.
fn variables(package: &Value) -> Vec<(String, String)> {
    let manifest = text(&package["manifest_path"]);
    let folder = Path::new(&manifest).parent().unwrap_or(Path::new("")).display().to_string();
    let version = text(&package["version"]);
    let (numbers, pre) = version.split_once('-').unwrap_or((&version, ""));
    let mut numbers = numbers.split('+').next().unwrap_or_default().split('.');
    let mut number = || numbers.next().unwrap_or_default().to_owned();
    let (major, minor, patch) = (number(), number(), number());
    let authors: Vec<String> =
        package["authors"].as_array().into_iter().flatten().map(text).collect();
    let mut all = vec![
        ("CARGO_MANIFEST_DIR", folder),
        ("CARGO_MANIFEST_PATH", manifest),
        ("CARGO_PKG_AUTHORS", authors.join(":")),
        ("CARGO_PKG_VERSION_MAJOR", major),
        ("CARGO_PKG_VERSION_MINOR", minor),
        ("CARGO_PKG_VERSION_PATCH", patch),
        ("CARGO_PKG_VERSION_PRE", pre.split('+').next().unwrap_or_default().to_owned()),
        ("CARGO_PKG_VERSION", version.clone()),
    ];
    let named = [
        ("CARGO_PKG_NAME", "name"),
        ("CARGO_PKG_DESCRIPTION", "description"),
        ("CARGO_PKG_HOMEPAGE", "homepage"),
        ("CARGO_PKG_REPOSITORY", "repository"),
        ("CARGO_PKG_LICENSE", "license"),
        ("CARGO_PKG_LICENSE_FILE", "license_file"),
        ("CARGO_PKG_RUST_VERSION", "rust_version"),
        ("CARGO_PKG_README", "readme"),
    ];
    all.extend(named.map(|(variable, key)| (variable, text(&package[key]))));
    all.into_iter().map(owned).collect()
}

/// The binaries in cargo's messages, one JSON document a line.
fn binaries(
    messages: &str,
    packages: &BTreeMap<String, Vec<(String, String)>>,
) -> Result<Vec<Binary>, String> {
    let parse = |line: &str| {
        serde_json::from_str(line).map_err(|error| format!("cargo's messages: {error}"))
    };
    // Other lines are printed by build scripts and compilers of other languages.
    let lines = messages.lines().filter(|line| line.starts_with('{'));
    let messages: Vec<Value> = lines.map(parse).collect::<Result<_, _>>()?;
    let of =
        |reason: &'static str| messages.iter().filter(move |message| message["reason"] == reason);
    let mut scripts: BTreeMap<String, Vec<(String, String)>> = BTreeMap::new();
    for script in of("build-script-executed") {
        let variables = scripts.entry(text(&script["package_id"])).or_default();
        variables.push(("OUT_DIR".to_owned(), text(&script["out_dir"])));
        let set = script["env"].as_array().into_iter().flatten();
        variables.extend(set.map(|pair| (text(&pair[0]), text(&pair[1]))));
    }
    let mut binaries = Vec::new();
    for message in of("compiler-artifact") {
        let (Some(program), Some(true)) =
            (message["executable"].as_str(), message["profile"]["test"].as_bool())
        else {
            continue;
        };
        let package = text(&message["package_id"]);
        let variables = packages
            .get(&package)
            .ok_or_else(|| format!("cargo metadata has no package {package}"))?;
        let value = |name: &str| {
            variables.iter().find(|(key, _)| key == name).map(|(_, value)| value.clone())
        };
        let more = scripts.get(&package).into_iter().flatten().cloned();
        binaries.push(Binary {
            id: id(&value("CARGO_PKG_NAME").unwrap_or_default(), &message["target"]),
            program: program.into(),
            arguments: Vec::new(),
            folder: value("CARGO_MANIFEST_DIR").unwrap_or_default().into(),
            environment: variables.iter().cloned().chain(more).chain([owned(SEED)]).collect(),
            lists: true,
        });
    }
    binaries.sort_by(|one, other| one.id.cmp(&other.id));
    Ok(binaries)
}

fn id(package: &str, target: &Value) -> String {
    let name = text(&target["name"]);
    match target["kind"][0].as_str().unwrap_or_default() {
        "test" => format!("{package}::{name}"),
        kind @ ("bin" | "example" | "bench") => format!("{package}::{kind}/{name}"),
        _ => package.to_owned(),
    }
}

/// A string of JSON; empty where there is none.
fn text(value: &Value) -> String {
    value.as_str().unwrap_or_default().to_owned()
}

fn owned<T: Into<String>>((name, value): (&str, T)) -> (String, String) {
    (name.to_owned(), value.into())
}

#[cfg(test)]
mod tests {
    use super::{binaries, packages};
    use serde_json::json;

    #[test]
    fn a_binary_is_started_as_cargo_starts_it() {
        let metadata = json!({"packages": [{
            "id": "path+file:///w/crates/a#0.1.0", "name": "a", "version": "0.1.2-rc.1", "authors": ["A", "B"],
            "manifest_path": "/w/crates/a/Cargo.toml", "license": "MIT"
        }]});
        let artifact = |name: &str, kind: &str, test: bool| {
            let executable = format!("/w/target/release/deps/{name}");
            json!({"reason": "compiler-artifact", "package_id": "path+file:///w/crates/a#0.1.0",
                "target": {"name": name, "kind": [kind]}, "profile": {"test": test}, "executable": executable})
            .to_string()
        };
        let script = json!({"reason": "build-script-executed", "package_id": "path+file:///w/crates/a#0.1.0",
            "out_dir": "/w/target/out", "env": [["MADE", "1"]]});
        let lines = [
            artifact("a", "lib", true),
            artifact("command", "bin", false),
            artifact("command", "bin", true),
            "a build script prints this".to_owned(),
            artifact("holds", "test", true),
            script.to_string(),
        ];
        let found = binaries(&lines.join("\n"), &packages(&metadata)).unwrap();
        let ids: Vec<&str> = found.iter().map(|binary| binary.id.as_str()).collect();
        assert_eq!(ids, ["a", "a::bin/command", "a::holds"]);
        assert!(found.iter().all(|binary| binary.folder.ends_with("crates/a")));
        let value = |name: &str| {
            let variable = found[0].environment.iter().find(|(key, _)| key == name);
            variable.map(|(_, value)| value.as_str()).unwrap()
        };
        assert_eq!(
            [value("CARGO_PKG_VERSION_PATCH"), value("CARGO_PKG_VERSION_PRE")],
            ["2", "rc.1"]
        );
        assert_eq!([value("CARGO_PKG_AUTHORS"), value("CARGO_PKG_HOMEPAGE")], ["A:B", ""]);
        assert_eq!([value("OUT_DIR"), value("MADE")], ["/w/target/out", "1"]);
    }

    #[test]
    fn an_unknown_package_is_an_error() {
        let artifact = json!({"reason": "compiler-artifact", "package_id": "b", "target": {"name": "b"},
            "profile": {"test": true}, "executable": "/b"});
        assert!(
            binaries(&artifact.to_string(), &packages(&json!({})))
                .unwrap_err()
                .contains("no package b")
        );
    }
}
