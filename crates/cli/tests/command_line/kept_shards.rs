//! `carrystep sweep --keep`: a shard that is killed, interrupted or stopped by a full disk
//! continues where it stopped, and its report has the same bytes.

use crate::command::{Folder, GOOD, Ran};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// A sweep of 24 cases that take up to 0.2 s each on one core. Moves that are too fast are refused,
/// and a driver of an unknown name fails.
fn sweep() -> Folder {
    let folder = Folder::new();
    let (head, _) = GOOD.split_once("[[move]]").unwrap();
    let head = head.replace("\"a4988\"", "\"{{ driver }}\"");
    let moves = "[[move]]\nprofile = \"constant\"\ntime = {{ time }}\nto = { x = {{ to }} }\n";
    let vary = "driver = [\"a4988\", \"tmc2209\", \"none\"]\ntime = [12_000, 14_000]\nto = [170_000, 180_000, 190_000, 10_000_000]\n";
    folder.write("sweep.toml", format!("move_file = '''\n{head}{moves}'''\n[vary]\n{vary}"));
    folder
}

/// The command with these arguments, on one core, so that a run takes a known time.
fn command(folder: &Folder, arguments: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_carrystep"));
    command.args(arguments.split(' ')).current_dir(folder.path("")).env("RAYON_NUM_THREADS", "1");
    command
}

fn run(folder: &Folder, arguments: &str) -> Ran {
    folder.output(&mut command(folder, arguments))
}

/// Starts the command, sends it a signal when `now`, and waits for its end.
fn ended(
    folder: &Folder,
    arguments: &str,
    signal: &str,
    now: impl Fn() -> bool,
) -> std::process::Output {
    let mut command = command(folder, arguments);
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    while child.try_wait().unwrap().is_none() {
        if now() {
            // The process may end before the signal; it is not reaped yet, so its number is not
            // used again.
            Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap();
            break;
        }
        std::thread::sleep(Duration::from_millis(1));
    }
    child.wait_with_output().unwrap()
}

/// The number of judged cases in a kept file; null while there is none.
fn done(path: &Path) -> u64 {
    let Ok(text) = std::fs::read_to_string(path) else { return 0 };
    let (_, body) = text.split_once('\n').unwrap();
    let body: serde_json::Value = serde_json::from_str(body).unwrap();
    let ranges = body["done"].as_array().unwrap();
    ranges.iter().map(|range| range[1].as_u64().unwrap() - range[0].as_u64().unwrap()).sum()
}

#[test]
fn killed_shard_continues_and_its_report_has_the_same_bytes() {
    let folder = sweep();
    let whole = run(&folder, "sweep sweep.toml --json");
    assert_eq!(whole.status, 1, "{}", whole.stdout);
    let path = folder.path("out/a.kept");
    let mut kept = vec![0];
    for millis in (0..).map(|n: u64| 40 + n * 277 % 611) {
        let arguments = "sweep sweep.toml --json --keep out/a.kept";
        let begun = Instant::now();
        let passed = || Duration::from_millis(millis) <= begun.elapsed();
        let output = ended(&folder, arguments, "-KILL", passed);
        if output.status.code().is_some() {
            assert_eq!(String::from_utf8(output.stdout).unwrap(), whole.stdout);
            break;
        }
        kept.push(done(&path));
    }
    assert!(kept.is_sorted(), "a restart loses nothing: {kept:?}");
    assert!(kept.iter().any(|&done| 0 < done && done < 24), "never killed in between: {kept:?}");
    assert_eq!(done(&path), 24);
    let before = std::fs::metadata(&path).unwrap().modified().unwrap();
    let again = run(&folder, "sweep sweep.toml --json --keep out/a.kept");
    assert_eq!((again.status, &again.stdout), (1, &whole.stdout));
    let after = std::fs::metadata(&path).unwrap().modified().unwrap();
    assert_eq!(after, before, "a finished shard is not written again");
    assert_eq!(run(&folder, "sweep --merge out/a.kept --json").stdout, whole.stdout);
}

#[test]
fn interrupted_shard_keeps_its_progress_and_says_so() {
    let folder = sweep();
    let path = folder.path("a.kept");
    let whole = run(&folder, "sweep sweep.toml --json");
    for signal in ["-INT", "-TERM"] {
        let arguments = "sweep sweep.toml --keep a.kept";
        let output = ended(&folder, arguments, signal, || 0 < done(&path));
        let (cases, text) = (done(&path), String::from_utf8(output.stderr).unwrap());
        assert!(0 < cases && cases < 24, "{text}");
        assert_eq!(
            text,
            format!(
                "error: interrupted: {cases} of 24 cases are kept in a.kept; the same command continues with the others\n"
            )
        );
        assert_eq!((output.status.code(), output.stdout), (Some(1), Vec::new()));
        let merged = folder.run("sweep --merge a.kept");
        merged.refuses(&format!("1/1 has {cases} of 24 cases in a.kept"));
        assert_eq!(run(&folder, &format!("{arguments} --json")).stdout, whole.stdout);
        std::fs::remove_file(&path).unwrap();
    }
}

/// No file may get longer than the limit. For the writer this is the same as a full disk: an error
/// in the middle of a file.
#[test]
fn full_disk_ends_the_run_and_later_it_continues() {
    let folder = sweep();
    let limited = |blocks: u32, arguments: &str| {
        let script = format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$0\" \"$@\"");
        let mut command = Command::new("sh");
        command.args(["-c", &script, env!("CARGO_BIN_EXE_carrystep")]);
        folder.output(command.args(arguments.split(' ')).env("RAYON_NUM_THREADS", "1"))
    };
    let arguments = "sweep sweep.toml --keep a.kept --json";
    limited(0, arguments).refuses("cannot write a.kept: File too large");
    assert_eq!(folder.files(), ["sweep.toml"]);
    // Blocks of 512 bytes: there is room for the first cases.
    limited(3, arguments).refuses("cannot write a.kept: File too large");
    assert_eq!(folder.files(), ["a.kept", "sweep.toml"]);
    let kept = done(&folder.path("a.kept"));
    assert!(kept < 24, "{kept}");
    let whole = run(&folder, "sweep sweep.toml --json");
    assert_eq!(run(&folder, arguments).stdout, whole.stdout);
    limited(0, "sweep --merge a.kept --report r.json").refuses("cannot write r.json");
    assert_eq!(folder.files(), ["a.kept", "sweep.toml"]);
}

#[test]
fn progress_of_another_run_is_refused_and_stays() {
    let folder = sweep();
    let sample = "sweep sweep.toml --sample 4 --shard 1/2 --keep a.kept";
    assert!(folder.run(sample).status < 2);
    let kept = std::fs::read(folder.path("a.kept")).unwrap();
    let text = std::fs::read_to_string(folder.path("sweep.toml")).unwrap();
    folder.write("other.toml", text.replace("170_000", "170_001"));
    for (old, new, says) in [
        ("--sample 4", "--sample 6", "in which --sample was 4 and not 6"),
        ("--sample 4", "--sample 4 --seed 2", "in which --seed was 1 and not 2"),
        ("--sample 4 ", "", "in which --sample was 4 and not none"),
        ("--shard 1/2", "--shard 2/2", "in which the shard was 1/2 and not 2/2"),
        ("--shard 1/2", "--core parallel", "in which the core was engine and not parallel"),
        ("sweep.toml", "other.toml", "in which the hash of the sweep file and these options was "),
    ] {
        folder.run(&sample.replace(old, new)).refuses(says);
        assert_eq!(std::fs::read(folder.path("a.kept")).unwrap(), kept, "{new}");
    }
    assert!(folder.run(sample).status < 2, "the same command still works");
}

#[test]
fn keep_replaces_no_file_that_keeps_no_progress() {
    let folder = sweep();
    let notes = "carrystep-sweep-shard notes\nof mine\n";
    folder.write("notes.txt", notes);
    folder.write("later.kept", "carrystep-sweep-shard 2 abc\n{}");
    folder.write("empty.kept", "");
    std::fs::create_dir(folder.path("folder")).unwrap();
    std::os::unix::fs::symlink("/dev/null", folder.path("null")).unwrap();
    let before = folder.files();
    for (file, says) in [
        ("empty.kept", "this file does not keep the progress of a shard"),
        ("notes.txt", "the kept progress is damaged or cut off"),
        ("later.kept", "the kept progress has version 2, and this carrystep reads version 1"),
        ("sweep.toml", "it is the input sweep.toml"),
        ("folder", "is a directory"),
        ("null", "it is not a regular file"),
    ] {
        folder.run(&format!("sweep sweep.toml --keep {file}")).refuses(says);
    }
    assert_eq!(folder.files(), before);
    assert_eq!(std::fs::read_to_string(folder.path("notes.txt")).unwrap(), notes);
}

/// A scheduler asks only whether the shard must be started again.
#[test]
fn without_a_verdict_the_status_says_whether_all_cases_were_judged() {
    let folder = sweep();
    let vary = "time = [60]\nto = [170, 1_000_000]\ndriver = [\"a4988\", \"none\"]\n";
    let text = std::fs::read_to_string(folder.path("sweep.toml")).unwrap();
    let (head, _) = text.split_once("driver = [").unwrap();
    folder.write("sweep.toml", format!("{head}{vary}"));
    for (shard, status) in [(1, 0), (2, 1), (3, 4), (4, 1), (5, 4)] {
        let arguments = format!("sweep sweep.toml --shard {shard}/5 --keep {shard}.kept");
        assert_eq!(folder.run(&arguments).status, status, "{shard}");
        assert_eq!(folder.run(&format!("{arguments} --no-verdict")).status, 0, "{shard}");
    }
    assert_eq!(folder.run("sweep sweep.toml --no-verdict").status, 2);
    let all = "sweep --merge 1.kept 2.kept 3.kept 4.kept 5.kept";
    let merged = folder.run(&format!("{all} --report report.json"));
    assert_eq!(merged.status, 1);
    let whole = folder.run("sweep sweep.toml --json");
    assert_eq!(std::fs::read_to_string(folder.path("report.json")).unwrap(), whole.stdout);
}

#[test]
fn one_case_of_a_huge_sample_needs_no_memory() {
    let folder = sweep();
    let most = u64::MAX;
    let ran = folder.run(&format!("sweep sweep.toml --sample {most} --shard {most}/{most}"));
    assert!(ran.stdout.starts_with("sweep ") && ran.status != 2, "{}{}", ran.stdout, ran.stderr);
}
