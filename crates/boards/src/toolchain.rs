//! The tools that make a family's bitstreams, as data: their programs, and the templates of the
//! files that they read.

use std::fmt;

/// The tools that make a bitstream. Names of templates are those of
/// `crates/verilog/templates/board`.
#[derive(Debug, PartialEq, Eq)]
pub struct Toolchain {
    /// Name for messages and pages.
    pub title: &'static str,
    /// Template of the constraints. Their file has its extension.
    pub constraints: &'static str,
    /// Scripts: name of the file, in which `TOP` becomes the name of the top module, and template.
    pub scripts: &'static [(&'static str, &'static str)],
    /// The commands that build a bitstream in the board's directory, for its readme.
    pub commands: &'static [&'static str],
    /// The programs that the scripts start.
    pub programs: &'static [&'static str],
    /// How the user starts the tools, if carrystep does not run them itself.
    pub by_hand: Option<&'static str>,
}

/// The tools of Xilinx for all Spartans up to Spartan-6.
pub static ISE: Toolchain = Toolchain {
    title: "ISE 14.7",
    constraints: "top.ucf",
    scripts: &[("build.sh", "ise.sh"), ("TOP.xst", "top.xst"), ("TOP.prj", "top.prj")],
    commands: &[". /opt/Xilinx/14.7/ISE_DS/settings64.sh     # where ISE is", "./build.sh"],
    programs: &["xst"],
    by_hand: Some("./build.sh, with ISE's settings64.sh read"),
};

impl Toolchain {
    /// The end of the name of a board's constraints, such as `.pcf`.
    pub fn constraints_end(&self) -> &'static str {
        self.constraints.strip_prefix("top").unwrap_or(self.constraints)
    }
}

impl fmt::Display for Toolchain {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.title)
    }
}
