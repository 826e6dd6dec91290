//! Lists the files of `data/boards/`, so that a new board needs its file and no entry in a list.

use std::error::Error;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::{env, fs};

const FOLDER: &str = "data/boards";

fn main() -> Result<(), Box<dyn Error>> {
    // Cargo runs this script again when a file in the folder is added, changed or removed.
    println!("cargo::rerun-if-changed={FOLDER}");
    let folder = Path::new(&env::var("CARGO_MANIFEST_DIR")?).join(FOLDER);
    let entries = fs::read_dir(&folder)?.collect::<Result<Vec<_>, _>>()?;
    let mut files: Vec<PathBuf> = entries.into_iter().map(|entry| entry.path()).collect();
    files.retain(|file| file.extension().is_some_and(|extension| extension == "toml"));
    files.sort();
    let mut list = "[\n".to_owned();
    for file in &files {
        let path = file.to_str().ok_or_else(|| format!("{} is not UTF-8", file.display()))?;
        let name = file.file_name().and_then(|name| name.to_str()).unwrap_or(path);
        writeln!(list, "    (\"{FOLDER}/{name}\", include_str!({path:?})),")?;
    }
    fs::write(Path::new(&env::var("OUT_DIR")?).join("boards.rs"), list + "]\n")?;
    Ok(())
}
