//! Reads a `promises.sv`: its labels, and the signals inside the module that it refers to.

/// The text of a `promises.sv`, which follows a few conventions.
pub struct Promises {
    /// The whole text.
    pub text: &'static str,
}

impl Promises {
    /// Labels of what must hold: `promise_3_dir_setup: assert (...)`.
    pub fn labels(&self) -> Vec<&'static str> {
        self.labelled("assert (").filter(|label| !label.starts_with("invariant_")).collect()
    }

    /// Labels of what must be reached: `cover_3_tightest_dir_setup: cover (...)`.
    pub fn covers(&self) -> Vec<&'static str> {
        self.labelled("cover (").collect()
    }

    /// The text with each cover replaced by the assertion that it is never reached, which must
    /// fail.
    pub fn covers_as_assertions(&self) -> String {
        let turned = |line: &str| match line.split_once(": cover (").zip(line.strip_suffix(");")) {
            Some(((label, what), _)) => {
                format!("{label}: assert (!({}));\n", &what[..what.len() - 2])
            }
            None => format!("{line}\n"),
        };
        self.text.lines().map(turned).collect()
    }

    /// The numbers of the promises that are proved here.
    pub fn numbers(&self) -> Vec<u32> {
        let mut numbers: Vec<u32> = self.labels().into_iter().filter_map(number).collect();
        numbers.sort_unstable();
        numbers.dedup();
        numbers
    }

    /// Names that stand for a signal inside the module, with that signal, as declared by
    /// `(* inside = "dut.busy" *) wire [16:0] busy;`. A star stands for all axes and a `#` for all
    /// lanes, the highest first.
    pub fn inside(&self, axes: usize, lanes: usize) -> Vec<(&'static str, String)> {
        let declared = self
            .text
            .lines()
            .filter_map(|line| line.trim().strip_prefix("(* inside = \"")?.split_once('"'));
        declared
            .map(|(signal, rest)| {
                let name = rest.trim_end_matches(';').rsplit(' ').next().unwrap_or(rest);
                let each = |number: usize| {
                    format!("\\{}", signal.replace(['*', '#'], &number.to_string()))
                };
                let count = match (signal.contains('*'), signal.contains('#')) {
                    (true, _) => axes,
                    (false, true) => lanes,
                    (false, false) => 1,
                };
                let all: Vec<String> = (0..count).rev().map(each).collect();
                (name, all.join(","))
            })
            .collect()
    }

    /// Signals inside the module that may have any value in any clock, so that their drivers are
    /// left out: `// (* free = "dut.word" *)`; a `#` stands for each lane. A promise that holds without
    /// the drivers also holds with them.
    pub fn free(&self, lanes: usize) -> Vec<String> {
        let told = self
            .text
            .lines()
            .filter_map(|line| line.trim().strip_prefix("// (* free = \"")?.split_once('"'));
        let each = |signal: &str| -> Vec<String> {
            let lanes = if signal.contains('#') { lanes } else { 1 };
            (0..lanes).map(|lane| signal.replace('#', &lane.to_string())).collect()
        };
        told.flat_map(|(signal, _)| each(signal)).collect()
    }

    fn labelled(&self, kind: &'static str) -> impl Iterator<Item = &'static str> {
        self.text.lines().filter_map(move |line| {
            let (label, rest) = line.trim().split_once(": ")?;
            rest.starts_with(kind).then_some(label)
        })
    }
}

/// The number of the promise to which a label belongs.
pub fn number(label: &str) -> Option<u32> {
    label.strip_prefix("promise_")?.split('_').next()?.parse().ok()
}
