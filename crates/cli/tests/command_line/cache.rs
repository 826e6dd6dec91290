//! The cache of compiled simulations: no other user may be able to put anything there that the
//! command executes.

use crate::command::{Folder, GOOD, Ran};
use std::fs;
use std::os::unix::fs::{MetadataExt as _, PermissionsExt as _, chown, symlink};
use std::process::Command;

/// Replaces Verilator. Its simulations only record that they have run.
const VERILATOR: &str = "#!/bin/sh\ncase \"$*\" in *--version*) exit 0;; esac\nmkdir obj_dir\n\
    printf '#!/bin/sh\\necho ran >> \"$RAN\"\\n' > obj_dir/bench\nchmod 777 obj_dir/bench\n";

fn folder() -> Folder {
    let folder = Folder::with_move(GOOD);
    folder.write("bin/verilator", VERILATOR);
    fs::set_permissions(folder.path("bin/verilator"), fs::Permissions::from_mode(0o755)).unwrap();
    fs::create_dir(folder.path("tmp")).unwrap();
    folder
}

fn simulate(folder: &Folder, cache: (&str, &str)) -> Ran {
    let path = format!("{}:{}", folder.path("bin").display(), std::env::var("PATH").unwrap());
    let mut command = Command::new(env!("CARGO_BIN_EXE_carrystep"));
    command.args(["simulate", "move.toml", "--level", "verilator"]).env_remove("CARRYSTEP_CACHE");
    command.env("TMPDIR", folder.path("tmp")).env("RAN", folder.path("ran")).env("PATH", path);
    folder.output(command.env(cache.0, folder.path(cache.1)))
}

fn ran(folder: &Folder) -> usize {
    fs::read_to_string(folder.path("ran")).map_or(0, |text| text.lines().count())
}

#[test]
fn compiled_simulations_are_kept_where_only_the_user_can_write() {
    for (cache, kept) in
        [(("XDG_CACHE_HOME", "user"), "user/carrystep"), (("CARRYSTEP_CACHE", "mine"), "mine")]
    {
        let folder = folder();
        simulate(&folder, cache);
        simulate(&folder, cache);
        assert_eq!(ran(&folder), 2);
        let there = folder.files();
        let simulations: Vec<&String> =
            there.iter().filter(|name| name.contains("engine_")).collect();
        assert!(simulations.len() == 1 && simulations[0].starts_with(kept), "{there:?}");
        for name in [kept, simulations[0]] {
            assert_eq!(fs::metadata(folder.path(name)).unwrap().mode() & 0o777, 0o700, "{name}");
        }
        assert!(fs::read_dir(folder.path("tmp")).unwrap().next().is_none());
    }
}

#[test]
fn a_cache_that_others_can_write_is_refused() {
    let folder = folder();
    fs::create_dir(folder.path("open")).unwrap();
    for mode in [0o777, 0o1777, 0o770, 0o702] {
        fs::set_permissions(folder.path("open"), fs::Permissions::from_mode(mode)).unwrap();
        let ran = simulate(&folder, ("CARRYSTEP_CACHE", "open"));
        ran.refuses(&format!("{}: other users may write to it", folder.path("open").display()));
    }
    symlink("open", folder.path("link")).unwrap();
    simulate(&folder, ("CARRYSTEP_CACHE", "link")).refuses("it is no folder");

    fs::set_permissions(folder.path("open"), fs::Permissions::from_mode(0o700)).unwrap();
    simulate(&folder, ("CARRYSTEP_CACHE", "open"));
    assert_eq!(ran(&folder), 1);
    let planted = fs::read_dir(folder.path("open")).unwrap().next().unwrap().unwrap().path();
    fs::set_permissions(&planted, fs::Permissions::from_mode(0o720)).unwrap();
    simulate(&folder, ("CARRYSTEP_CACHE", "open"))
        .refuses(&format!("{}: other users may", planted.display()));
    assert_eq!(ran(&folder), 1);
}

/// Root can give a folder away; any other user needs a folder that belongs to someone else.
#[test]
fn a_cache_of_another_user_is_refused() {
    const NOBODY: u32 = 65_534;
    let folder = folder();
    fs::create_dir(folder.path("other")).unwrap();
    let other =
        if chown(folder.path("other"), Some(NOBODY), None).is_ok() { "other" } else { "/usr" };
    simulate(&folder, ("CARRYSTEP_CACHE", other)).refuses("another user owns it");
    assert_eq!(ran(&folder), 0);
}
