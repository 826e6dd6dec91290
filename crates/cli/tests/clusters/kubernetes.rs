//! The files for Kubernetes: what a reader of YAML finds in them, and what their scripts do in a
//! shell. No cluster runs them.

use crate::folder::{CARRYSTEP, Folder, kept, shown, succeeded};
use saphyr::{LoadableYamlNode as _, Yaml};
use std::path::Path;
use std::process::{Command, Output};

const IMAGE: &str = "registry.example/it's:\"1\"";

fn read(folder: &Folder, name: &str) -> Vec<Yaml<'static>> {
    let text: &'static str = folder.read(name).leak();
    Yaml::load_from_str(text).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// Runs the command of a container. The folders of the container are folders here.
fn contain(folder: &Folder, job: &Yaml<'_>, index: u64) -> Output {
    let container = &job["spec"]["template"]["spec"]["containers"][0];
    assert_eq!(container["image"].as_str(), Some(IMAGE));
    let command: Vec<&str> =
        container["command"].as_vec().unwrap().iter().map(|word| word.as_str().unwrap()).collect();
    let script = folder.path(command[1].strip_prefix("/carrystep/").unwrap());
    let bin = Path::new(CARRYSTEP).parent().unwrap().display();
    let path = std::env::var("PATH").unwrap();
    Command::new(command[0])
        .arg(script)
        .env("PATH", format!("{bin}:{path}"))
        .env("JOB_COMPLETION_INDEX", index.to_string())
        .current_dir(folder.path(""))
        .output()
        .unwrap()
}

#[test]
fn kubernetes_files_are_yaml_and_their_scripts_merge_to_one_run() {
    let folder = Folder::new(&[100, 110, 120], &["a4988", "none"], "60");
    let text = folder.read("the sweep.toml") + "# \u{e9}\u{1f980} \"\\ \t: {{ }} %\n";
    std::fs::write(folder.path("the sweep.toml"), &text).unwrap();
    let arguments =
        ["sweep", "the sweep.toml", "--kubernetes", "k8s", "--shards", "4", "--image", IMAGE];
    succeeded(&folder.carrystep(&arguments).output().unwrap());
    let documents = read(&folder, "k8s/sweep.yaml");
    let kinds: Vec<&str> = documents.iter().map(|one| one["kind"].as_str().unwrap()).collect();
    assert_eq!(kinds, ["ConfigMap", "PersistentVolumeClaim", "Job"]);
    let (files, job) = (&documents[0]["data"], &documents[2]);
    assert_eq!(files["sweep.toml"].as_str(), Some(text.as_str()));
    let spec = &job["spec"];
    assert_eq!(spec["completionMode"].as_str(), Some("Indexed"));
    assert_eq!(spec["completions"].as_integer(), Some(4));
    let merge = &read(&folder, "k8s/merge.yaml")[0];
    // Every name of a volume leads to an object of the same file.
    let name = documents[0]["metadata"]["name"].as_str().unwrap();
    assert_eq!(documents[1]["metadata"]["name"].as_str(), Some(name));
    for job in [job, merge] {
        let pod = &job["spec"]["template"]["spec"];
        assert_eq!(pod["volumes"][0]["configMap"]["name"].as_str(), Some(name));
        assert_eq!(pod["volumes"][1]["persistentVolumeClaim"]["claimName"].as_str(), Some(name));
        let mounts = &pod["containers"][0]["volumeMounts"];
        assert_eq!(mounts[0]["mountPath"].as_str(), Some("/carrystep"));
        assert_eq!(mounts[1]["mountPath"].as_str(), Some("/shards"));
    }
    // The container's folders are this one.
    for script in ["shard.sh", "merge.sh", "sweep.toml"] {
        let text = files[script].as_str().unwrap();
        let text = text.replace("/carrystep/", "./").replace("/shards/", "./");
        std::fs::write(folder.path(script), text).unwrap();
    }
    assert_eq!(contain(&folder, merge, 0).status.code(), Some(2), "nothing to merge yet");
    for index in 0..4 {
        let output = contain(&folder, job, index);
        assert!(output.status.success(), "{}", shown(&output));
        let (done, all) = kept(&folder.path(&format!("shard-{}.kept", index + 1))).unwrap();
        assert_eq!(done, all);
    }
    let output = contain(&folder, merge, 0);
    assert_eq!(output.status.code(), Some(1), "{}", shown(&output));
    let whole = folder.carrystep(&["sweep", "./sweep.toml", "--json"]).output().unwrap();
    assert_eq!(folder.read("report.json"), String::from_utf8(whole.stdout).unwrap());
}

#[test]
fn sweeps_that_a_config_map_cannot_hold_are_refused() {
    let folder = Folder::new(&[100], &["a4988"], "60");
    let run = || {
        let arguments = ["sweep", "the sweep.toml", "--kubernetes", "k8s", "--image", "i"];
        folder.carrystep(&arguments).output().unwrap()
    };
    let text = folder.read("the sweep.toml");
    let (head, rest) = text.split_once("[machine]").unwrap();
    let (machine, rest) = rest.split_once("[[move]]").unwrap();
    let machine = format!("[machine]{machine}").replace("{{ driver }}", "a4988");
    std::fs::write(folder.path("m.toml"), machine).unwrap();
    let named = format!("{head}machine_file = \"m.toml\"\n[[move]]{rest}");
    let long = format!("{text}# {}\n", "long ".repeat(200_000));
    for (text, says) in [(named, "its moves name a machine file"), (long, "and a ConfigMap")] {
        std::fs::write(folder.path("the sweep.toml"), text).unwrap();
        let output = run();
        assert_eq!(output.status.code(), Some(2), "{}", shown(&output));
        assert!(shown(&output).contains(says), "{}", shown(&output));
        assert!(!folder.path("k8s").exists());
    }
}
