//! Bugs that are planted in the text of an engine's modules. All of them are in one text, and an
//! argument of the simulation selects one, as it selects a mutant: so the text is compiled once.

use std::collections::BTreeMap;
use std::fmt::Write as _;

/// A change of an expression.
#[derive(Clone, Debug)]
pub struct Planted {
    /// Description for a person.
    pub name: String,
    /// The module, without the prefix `carrystep_`.
    pub module: &'static str,
    /// Text that stands in the module once. The expression is at the place of `{}`.
    pub around: String,
    /// The expression.
    pub right: String,
    /// What it becomes.
    pub wrong: String,
}

impl Planted {
    /// A change in a module.
    pub fn new(
        name: impl Into<String>,
        module: &'static str,
        around: impl Into<String>,
        right: impl Into<String>,
        wrong: impl Into<String>,
    ) -> Self {
        let (name, around) = (name.into(), around.into());
        Self { name, module, around, right: right.into(), wrong: wrong.into() }
    }
}

/// The Verilog with all of these changes, of which `+mutant=N` selects the one with the number N
/// from 1 on.
///
/// # Panics If a text does not stand in its module exactly once.
pub fn plant(verilog: &str, planted: &[Planted]) -> String {
    let mut modules: BTreeMap<&str, Vec<(usize, &Planted)>> = BTreeMap::new();
    for (number, change) in (1..).zip(planted) {
        modules.entry(change.module).or_default().push((number, change));
    }
    let mut verilog = verilog.to_owned();
    for (module, changes) in modules {
        let heads = [" (", " #("].map(|head| format!("module carrystep_{module}{head}\n"));
        let begin = heads.iter().find_map(|head| verilog.find(head)).expect("the module");
        let end = begin + verilog[begin..].find("endmodule").expect("its end");
        let text = changed(module, &verilog[begin..end], &changes);
        verilog.replace_range(begin..end, &text);
    }
    verilog
}

/// The text of a module with the changes in it. Several changes of one expression are nested.
fn changed(module: &str, text: &str, changes: &[(usize, &Planted)]) -> String {
    let mut places: BTreeMap<(&str, &str), String> = BTreeMap::new();
    for (number, Planted { around, right, wrong, .. }) in changes {
        let expression = places.entry((around, right)).or_insert_with(|| right.clone());
        *expression = format!("((planted == {number}) ? ({wrong}) : ({expression}))");
    }
    let mut text = text.to_owned();
    for ((around, right), expression) in places {
        let original = around.replace("{}", right);
        let count = text.matches(&original).count();
        assert_eq!(count, 1, "'{original}' stands {count} times in {module}, not once");
        text = text.replace(&original, &around.replace("{}", &expression));
    }
    let body = text.find("\n);\n").expect("the end of its ports") + "\n);\n".len();
    let mut choice = String::from("    integer planted;\n");
    // Writing to a string cannot fail.
    let _ =
        writeln!(choice, "    initial if (!$value$plusargs(\"mutant=%d\", planted)) planted = 0;");
    text.insert_str(body, &choice);
    text
}
