//! Outputs whose names exist already: inputs, links, devices, pipes, and results of an earlier run.

use crate::command::{Folder, GOOD};
use std::fs;
use std::io::Read as _;
use std::os::unix::fs::{MetadataExt as _, symlink};
use std::process::{Command, Stdio};

const OPTIONS: [&str; 5] = ["--vcd", "--fst", "--csv", "--plot", "--report"];

/// The machine and the moves of [`GOOD`] in two files, each of which also has other names.
fn folder() -> Folder {
    let folder = Folder::new();
    let (machine, moves) = GOOD.split_at(GOOD.find("[[move]]").unwrap());
    folder.write("shop/machine.toml", machine);
    folder.write("shop/move.toml", format!("machine_file = \"machine.toml\"\n{moves}"));
    symlink("shop", folder.path("linked")).unwrap();
    symlink("shop/machine.toml", folder.path("link.toml")).unwrap();
    fs::hard_link(folder.path("shop/machine.toml"), folder.path("hard.toml")).unwrap();
    fs::hard_link(folder.path("shop/move.toml"), folder.path("hard-move.toml")).unwrap();
    folder
}

/// Every file with its text.
fn texts(folder: &Folder) -> Vec<(String, Option<String>)> {
    folder
        .files()
        .into_iter()
        .map(|name| (name.clone(), fs::read_to_string(folder.path(&name)).ok()))
        .collect()
}

#[test]
fn an_output_that_is_an_input_is_refused() {
    let folder = folder();
    let before = texts(&folder);
    let refused = |arguments: &str, says: &str| {
        folder.run(arguments).refuses(says);
        assert_eq!(texts(&folder), before, "{arguments}");
    };
    for option in OPTIONS {
        for (name, input) in [
            ("shop/machine.toml", "shop/machine.toml"),
            ("./shop/../shop/machine.toml", "shop/machine.toml"),
            ("linked/machine.toml", "shop/machine.toml"),
            ("linked/move.toml", "shop/move.toml"),
            ("link.toml", "shop/machine.toml"),
            ("hard.toml", "shop/machine.toml"),
            ("hard-move.toml", "shop/move.toml"),
        ] {
            let other = if option == "--csv" { "--vcd" } else { "--csv" };
            let says = format!("cannot write {name}: it is the input {input}");
            refused(&format!("simulate shop/move.toml {other} new/other {option} {name}"), &says);
        }
    }
    refused(
        "simulate shop/move.toml --vcd a --save link.toml",
        "cannot write link.toml: it is the input",
    );
    refused(
        "virtual-board --machine shop/machine.toml --vcd hard.toml",
        "cannot write hard.toml: it is the input",
    );
}

/// The command chooses the names of these outputs itself.
#[test]
fn verilog_does_not_replace_its_machine_file() {
    let folder = folder();
    fs::create_dir(folder.path("out")).unwrap();
    for (link, options) in
        [("carrystep_parallel_1.v", "--core parallel"), ("carrystep_engine.v", "--core engine")]
    {
        fs::hard_link(folder.path("shop/machine.toml"), folder.path("out").join(link)).unwrap();
        let before = texts(&folder);
        let ran = folder.run(&format!("verilog {options} --machine shop/machine.toml --out out"));
        ran.refuses(&format!("cannot write out/{link}: it is the input shop/machine.toml"));
        assert_eq!(texts(&folder), before);
        fs::remove_file(folder.path("out").join(link)).unwrap();
    }
}

#[test]
fn two_outputs_that_are_one_file_are_refused() {
    let folder = folder();
    folder.write("old", "");
    fs::hard_link(folder.path("old"), folder.path("hard")).unwrap();
    symlink("new/a", folder.path("dangling")).unwrap();
    let before = texts(&folder);
    for (one, other) in
        [("a", "./a"), ("old", "hard"), ("new/a", "dangling"), ("new/a", "shop/../new/a")]
    {
        let ran = folder.run(&format!("simulate shop/move.toml --vcd {one} --csv {other}"));
        ran.refuses(&format!("cannot write {other}: it is also the output {one}"));
        let ran = folder.run(&format!(
            "profile ranade --steps 1000 --time 1 --accel 1e5 --csv {one} --plot {other}"
        ));
        ran.refuses(&format!("cannot write {other}: it is also the output {one}"));
        assert_eq!(texts(&folder), before);
    }
}

#[test]
fn a_link_is_followed_and_stays() {
    let folder = folder();
    folder.write("results/old.csv", "old");
    symlink("results/old.csv", folder.path("to-old.csv")).unwrap();
    symlink("to-old.csv", folder.path("to-link.csv")).unwrap();
    symlink("results/new.csv", folder.path("dangling.csv")).unwrap();
    for (link, target) in [("to-link.csv", "results/old.csv"), ("dangling.csv", "results/new.csv")]
    {
        let ran = folder.run(&format!("simulate shop/move.toml --csv {link}"));
        assert_eq!(ran.status, 0, "{}", ran.stderr);
        assert!(ran.stdout.contains(&format!("wrote {link}\n")), "{}", ran.stdout);
        assert!(fs::read_to_string(folder.path(target)).unwrap().starts_with("axis,pulse,time_s,"));
        assert!(fs::symlink_metadata(folder.path(target)).unwrap().is_file());
        assert!(fs::symlink_metadata(folder.path(link)).unwrap().is_symlink());
    }
    assert!(fs::symlink_metadata(folder.path("to-old.csv")).unwrap().is_symlink());
    symlink("loop-b", folder.path("loop-a")).unwrap();
    symlink("loop-a", folder.path("loop-b")).unwrap();
    let before = folder.files();
    folder
        .run("simulate shop/move.toml --csv loop-a")
        .refuses("cannot write loop-a: too many symbolic links");
    assert_eq!(folder.files(), before);
}

#[test]
fn results_of_an_earlier_run_are_replaced_whole() {
    let folder = folder();
    let run = "simulate shop/move.toml --vcd out/a.vcd --fst out/a.fst --save out/a.gtkw --csv out/a.csv --plot out/a.svg";
    assert_eq!(folder.run(run).status, 0);
    let (files, first) = (folder.files(), fs::read(folder.path("out/a.csv")).unwrap());
    let inode = |name: &str| fs::metadata(folder.path(name)).unwrap().ino();
    let before = inode("out/a.csv");
    // A reader of the earlier file can read it to its end.
    let mut reader = fs::File::open(folder.path("out/a.csv")).unwrap();
    fs::hard_link(folder.path("out/a.csv"), folder.path("kept")).unwrap();
    assert_eq!(folder.run(&run.replace("shop/move.toml", "linked/move.toml")).status, 0);
    let mut old = Vec::new();
    reader.read_to_end(&mut old).unwrap();
    assert_eq!(old, first);
    assert_ne!(inode("out/a.csv"), before);
    assert_eq!(fs::read(folder.path("out/a.csv")).unwrap(), first);
    fs::remove_file(folder.path("kept")).unwrap();
    assert_eq!(folder.files(), files);
}

/// A result is an ordinary file: the user's mask determines who may read it, and scripts are
/// executable.
#[test]
fn results_have_the_permissions_of_any_new_file() {
    let folder = folder();
    folder.write("plain", "");
    let mode = |name: &str| fs::metadata(folder.path(name)).unwrap().mode() & 0o777;
    assert_eq!(folder.run("simulate shop/move.toml --csv a.csv").status, 0);
    assert_eq!(mode("a.csv"), mode("plain"));
    assert_eq!(folder.run("verilog --board papilio-one --out board").status, 0);
    assert_eq!(
        (mode("board/build.sh") & 0o100, mode("board/carrystep_engine.v")),
        (0o100, mode("plain"))
    );
}

#[test]
fn devices_and_pipes_are_written_and_not_replaced() {
    let folder = folder();
    assert_eq!(folder.run("simulate shop/move.toml --vcd /dev/null --csv /dev/null").status, 0);
    assert!(fs::metadata("/dev/null").unwrap().rdev() != 0);

    assert!(Command::new("mkfifo").arg(folder.path("fifo")).status().unwrap().success());
    let fifo = folder.path("fifo");
    let reader = std::thread::spawn(move || fs::read_to_string(fifo).unwrap());
    assert_eq!(folder.run("simulate shop/move.toml --csv fifo").status, 0);
    assert!(reader.join().unwrap().starts_with("axis,pulse,time_s,"));

    folder
        .run("simulate shop/move.toml --csv /dev/stdout --vcd /proc/self/fd/1")
        .refuses("it is also the output");
    folder.run("simulate shop/move.toml --csv shop/").refuses("cannot write shop/: is a directory");
}

/// `carrystep ... --csv /dev/stdout > all`: the file contains the CSV and then the report.
#[test]
fn redirected_standard_output_holds_csv_and_report() {
    let folder = folder();
    let run = |csv: &str| {
        let all = fs::File::create(folder.path("all")).unwrap();
        let mut command = Command::new(env!("CARGO_BIN_EXE_carrystep"));
        command
            .args(["simulate", "shop/move.toml", "--csv", csv])
            .current_dir(folder.path(""))
            .stdout(all);
        let output = command.stderr(Stdio::piped()).output().unwrap();
        (
            output.status.code(),
            String::from_utf8(output.stderr).unwrap(),
            fs::read_to_string(folder.path("all")).unwrap(),
        )
    };
    let (status, stderr, all) = run("/dev/stdout");
    assert_eq!(status, Some(0), "{stderr}");
    assert!(all.starts_with("axis,pulse,time_s,") && all.ends_with("ALL HOLDS\n"), "{all}");
    let (status, stderr, all) = run("all");
    assert_eq!((status, all.as_str()), (Some(2), ""));
    assert!(stderr.contains("cannot write all: standard output goes there already"), "{stderr}");
}
