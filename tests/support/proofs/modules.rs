//! The part of an exported text that a question needs.

use std::collections::BTreeSet;

/// The modules of an exported text that `names` mentions and all modules below them, in the order of
/// the text and with its directives. Comments between the modules are left out.
///
/// Most questions are about one of the engine's 26 modules, and yosys reads the whole engine in
/// 0.2 s. An answer that is kept also outlasts a change of a module that it does not need.
pub(super) fn mentioned(verilog: &str, names: &str) -> String {
    let parts = parts(verilog);
    let mut wanted = BTreeSet::new();
    let mut texts = vec![names];
    while let Some(text) = texts.pop() {
        for word in words(text) {
            let of_name = parts.iter().filter(|(name, _)| *name == Some(word));
            texts.extend(of_name.filter(|_| wanted.insert(word)).map(|(_, text)| *text));
        }
    }
    let is_wanted = |name: Option<&str>| name.is_none_or(|name| wanted.contains(name));
    parts.iter().filter(|(name, _)| is_wanted(*name)).map(|(_, text)| *text).collect()
}

/// The modules with their names, and the directives between them, line by line.
fn parts(verilog: &str) -> Vec<(Option<&str>, &str)> {
    let (mut parts, mut rest) = (Vec::new(), verilog);
    while !rest.is_empty() {
        let name = rest.strip_prefix("module ").and_then(|module| words(module).next());
        let last = if name.is_some() { "endmodule\n" } else { "\n" };
        let end = rest.find(last).map_or(rest.len(), |at| at + last.len());
        let (part, behind) = rest.split_at(end);
        if name.is_some() || part.starts_with('`') {
            parts.push((name, part));
        }
        rest = behind;
    }
    parts
}

/// The names and keywords of a text, and whatever else is written with their letters.
fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|letter: char| !letter.is_ascii_alphanumeric() && letter != '_')
}

#[cfg(test)]
mod tests {
    use super::super::builds::shipped_engine;
    use super::mentioned;

    fn modules(verilog: &str) -> Vec<&str> {
        verilog.lines().filter(|line| line.starts_with("module ")).collect()
    }

    #[test]
    fn a_module_has_those_below_it_and_no_others() {
        let engine = shipped_engine().1;
        let queue = mentioned(&engine, "`DUT: carrystep_queue dut (.*);");
        assert_eq!(
            modules(&queue),
            ["module carrystep_control (", "module carrystep_lasts (", "module carrystep_queue #("]
        );
        assert!(queue.starts_with("`default_nettype none\nmodule "));
        assert!(queue.ends_with("endmodule\n`default_nettype wire\n"));
    }

    #[test]
    fn an_engine_has_all_its_modules() {
        let engine = shipped_engine().1;
        assert_eq!(modules(&mentioned(&engine, "carrystep_engine")), modules(&engine));
    }
}
