//! Random expressions, units, offsets and feeds, compared with a small model of their own.

use crate::support::{canons, is_apart, point, steps, words};
use carrystep_gcode::{Canon, Pace, Point};
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::select;

/// An expression of the model: its text and its value are computed from the same tree.
#[derive(Debug, Clone)]
enum Tree {
    /// A number with this many thousandths.
    Number(i32),
    /// `#n`, which is set to n / 4 before.
    Parameter(u8),
    Negative(Box<Tree>),
    Function(&'static str, Box<Tree>),
    Binary(&'static str, Box<Tree>, Box<Tree>),
}

const FUNCTIONS: [&str; 6] = ["ABS", "Cos", "sin", "FIX", "fup", "Round"];
/// By precedence, those that bind most first.
const OPERATORS: [&[&str]; 4] =
    [&["*"], &["+", "-"], &["EQ", "ne", "GT", "ge", "LT", "le"], &["AND", "or", "XOR"]];

fn tree() -> impl Strategy<Value = Tree> {
    let leaf = prop_oneof![
        (-9_999_999..9_999_999).prop_map(Tree::Number),
        (1_u8..=200).prop_map(Tree::Parameter),
    ];
    leaf.prop_recursive(6, 40, 2, |inner| {
        let one = inner.clone().prop_map(Box::new);
        let other = inner.prop_map(Box::new);
        prop_oneof![
            one.clone().prop_map(Tree::Negative),
            (select(&FUNCTIONS[..]), one.clone()).prop_map(|(name, of)| Tree::Function(name, of)),
            (select(OPERATORS.concat()), one, other)
                .prop_map(|(name, left, right)| Tree::Binary(name, left, right)),
        ]
    })
}

impl Tree {
    /// Its text, with brackets only where the precedence needs them.
    fn text(&self) -> String {
        match self {
            Self::Number(thousandths) => {
                let sign = if *thousandths < 0 { "-" } else { "" };
                let number = thousandths.unsigned_abs();
                format!("{sign}{} . {:03}", number / 1000, number % 1000)
            }
            Self::Parameter(number) => format!("#{number}"),
            Self::Negative(of) => format!("-[{}]", of.text()),
            Self::Function(name, of) => format!("{name}[{}]", of.text()),
            Self::Binary(name, left, right) => {
                let level = precedence(name);
                let side = |tree: &Self, is_right: bool| match tree {
                    Self::Binary(inner, ..)
                        if precedence(inner) > level || is_right && precedence(inner) == level =>
                    {
                        format!("[{}]", tree.text())
                    }
                    _ => tree.text(),
                };
                format!("{} {name} {}", side(left, false), side(right, true))
            }
        }
    }

    /// Whether all angles are small enough for their sines to be exact to 1e-9.
    fn has_small_angles(&self) -> bool {
        match self {
            Self::Number(_) | Self::Parameter(_) => true,
            Self::Negative(of) => of.has_small_angles(),
            Self::Function(name, of) => {
                let is_angle = matches!(*name, "Cos" | "sin");
                of.has_small_angles() && (!is_angle || of.value().abs() < 1e5)
            }
            Self::Binary(_, left, right) => left.has_small_angles() && right.has_small_angles(),
        }
    }

    fn value(&self) -> f64 {
        let truth = |holds| if holds { 1.0 } else { 0.0 };
        match self {
            Self::Number(thousandths) => f64::from(*thousandths) / 1000.0,
            Self::Parameter(number) => f64::from(*number) / 4.0,
            Self::Negative(of) => -of.value(),
            Self::Function(name, of) => {
                let value = of.value();
                let whole = value.floor();
                match *name {
                    "ABS" => value.max(-value),
                    "Cos" => (value * std::f64::consts::PI / 180.0).cos(),
                    "sin" => (value * std::f64::consts::PI / 180.0).sin(),
                    "FIX" => whole,
                    "fup" => -(-value).floor(),
                    _ if value < 0.0 => -(0.5 - value).floor(),
                    _ => (value + 0.5).floor(),
                }
            }
            Self::Binary(name, left, right) => {
                let (left, right) = (left.value(), right.value());
                let equal = (left - right).abs() < 0.0001;
                match *name {
                    "*" => left * right,
                    "+" => left + right,
                    "-" => left - right,
                    "EQ" => truth(equal),
                    "ne" => truth(!equal),
                    "GT" => truth(left > right),
                    "ge" => truth(left >= right),
                    "LT" => truth(left < right),
                    "le" => truth(left <= right),
                    "AND" => truth(left != 0.0 && right != 0.0),
                    "or" => truth(left != 0.0 || right != 0.0),
                    _ => truth((left != 0.0) != (right != 0.0)),
                }
            }
        }
    }
}

fn precedence(name: &str) -> usize {
    OPERATORS.iter().position(|level| level.contains(&name)).expect("an operator")
}

/// Lines that set `#n` to n / 4.
fn quarters() -> String {
    (1..=200).map(|n| format!("#{n}=[{n}/4]\n")).collect()
}

/// A change of the frame, or a move, as text and in the model.
#[derive(Debug, Clone)]
enum Change {
    Inches(bool),
    Incremental(bool),
    System(usize),
    Origin(usize, Point),
    Set(Point),
    Clear,
    Tool(f64),
    Move(Point),
    Machine(Point),
}

fn change() -> impl Strategy<Value = Change> {
    prop_oneof![
        1 => any::<bool>().prop_map(Change::Inches),
        1 => any::<bool>().prop_map(Change::Incremental),
        1 => (1_usize..=9).prop_map(Change::System),
        1 => (1_usize..=9, point()).prop_map(|(system, to)| Change::Origin(system, to)),
        1 => point().prop_map(Change::Set),
        1 => Just(Change::Clear),
        1 => (-50.0..50.0).prop_map(Change::Tool),
        4 => point().prop_map(Change::Move),
        1 => point().prop_map(Change::Machine),
    ]
}

/// The model: every offset is kept in mm, and a program place is never kept.
#[derive(Default)]
struct Model {
    inches: bool,
    incremental: bool,
    system: usize,
    origins: [Point; 9],
    g92: Point,
    tool: f64,
    machine: Point,
}

impl Model {
    fn millimetres(&self, point: &Point) -> Point {
        let unit = if self.inches { 25.4 } else { 1.0 };
        std::array::from_fn(|axis| if axis < 3 { unit * point[axis] } else { point[axis] })
    }

    fn offset(&self, axis: usize) -> f64 {
        let tool = if axis == 2 { self.tool } else { 0.0 };
        self.origins[self.system][axis] + self.g92[axis] + tool
    }

    /// Applies a change. The results are the line of the program and, for a move, its end.
    fn apply(&mut self, change: &Change) -> (String, Option<Point>) {
        let at = self.machine;
        match change {
            Change::Inches(is) => {
                self.inches = *is;
                (if *is { "G20" } else { "G21" }.to_owned(), None)
            }
            Change::Incremental(is) => {
                self.incremental = *is;
                (if *is { "G91" } else { "G90" }.to_owned(), None)
            }
            Change::System(system) => {
                self.system = system - 1;
                let code =
                    if *system <= 6 { 53.0 + *system as f64 } else { 58.4 + *system as f64 / 10.0 };
                (format!("G{code}"), None)
            }
            Change::Origin(system, to) => {
                self.origins[system - 1] = self.millimetres(to);
                (format!("G10 L2 P{system} {}", words(to)), None)
            }
            Change::Set(to) => {
                let to_mm = self.millimetres(to);
                let new: Point = std::array::from_fn(|axis| {
                    at[axis] - self.offset(axis) + self.g92[axis] - to_mm[axis]
                });
                self.g92 = new;
                (format!("G92 {}", words(to)), None)
            }
            Change::Clear => {
                self.g92 = Point::default();
                ("G92.1".to_owned(), None)
            }
            Change::Tool(length) => {
                self.tool = self.millimetres(&[*length; 6])[2];
                (format!("G43.1 Z{length}"), None)
            }
            Change::Move(to) => {
                let to_mm = self.millimetres(to);
                self.machine = std::array::from_fn(|axis| {
                    let from = if self.incremental { at[axis] } else { self.offset(axis) };
                    from + to_mm[axis]
                });
                (format!("G0 {}", words(to)), Some(self.machine))
            }
            Change::Machine(to) => {
                if !self.incremental {
                    self.machine = self.millimetres(to);
                }
                let text =
                    if self.incremental { String::new() } else { format!("G53 G0 {}", words(to)) };
                (text, (!self.incremental).then_some(self.machine))
            }
        }
    }
}

proptest! {
    #[test]
    fn a_printed_expression_has_the_value_of_its_tree(tree in tree()) {
        let value = tree.value();
        prop_assume!(value.abs() < 1e8 && tree.has_small_angles());
        let text = format!("{}G4 P0\nG0 X[{}]\nG4 P1", quarters(), tree.text());
        let found = canons(&text);
        let x = match &found[1] {
            Canon::Traverse { to } => to[0],
            // A move of no length is left out.
            _ => 0.0,
        };
        prop_assert!((x - value).abs() <= 1e-9 * value.abs().max(1.0), "{x} {value} {text}");
    }

    #[test]
    fn units_and_offsets_follow_the_model(changes in vec(change(), 1..40)) {
        let mut model = Model::default();
        let mut text = String::new();
        let mut expected = Vec::new();
        for change in &changes {
            let before = model.machine;
            let (line, to) = model.apply(change);
            text += &(line + "\n");
            expected.extend(to.filter(|to| is_apart(to, &before)));
        }
        let mut found: Vec<Point> = Vec::new();
        for step in steps(&text).map_err(|error| TestCaseError::fail(format!("{error}\n{text}")))? {
            if let Canon::Traverse { to } = step.canon {
                let before = found.last().copied().unwrap_or_default();
                if is_apart(&to, &before) {
                    found.push(to);
                }
            }
        }
        prop_assert_eq!(found.len(), expected.len(), "{}", text);
        for (found, expected) in found.iter().zip(&expected) {
            let same = (0..6).all(|axis| (found[axis] - expected[axis]).abs() < 1e-9);
            prop_assert!(same, "{found:?} {expected:?}\n{text}");
        }
    }

    #[test]
    fn feed_is_in_units_per_minute_or_one_over_the_time(
        feed in 1_u32..100_000, inches: bool, linear: bool, inverse: bool,
    ) {
        let text = format!(
            "{} {}\nG1 {} F{feed}",
            if inches { "G20" } else { "G21" },
            if inverse { "G93" } else { "G94" },
            if linear { "X1 A1" } else { "A1 B2" },
        );
        let Canon::Feed { pace, .. } = canons(&text)[0] else { panic!("{text}") };
        let feed = f64::from(feed);
        let expected = match (inverse, linear && inches) {
            (true, _) => Pace::Seconds(60.0 / feed),
            (false, true) => Pace::PerSecond(feed * 25.4 / 60.0),
            (false, false) => Pace::PerSecond(feed / 60.0),
        };
        prop_assert_eq!(pace, expected);
    }
}
