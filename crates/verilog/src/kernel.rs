//! Sorts the statements of a module's kernel by the Verilog construct that expresses them.
//!
//! Rust-HDL has one combinational block per module. Here, a signal that is assigned once becomes a
//! continuous assignment, and a statement that writes only registers moves into the clocked block.
//! The remaining statements (defaults with overrides) stay combinational, in one block for each set
//! of signals that are written together. Statements that write the same signal keep their order, so
//! that the result is equivalent to the kernel.

use crate::ExportError;
use crate::expression::Translator;
use crate::names::{Name, Names, Role};
use crate::netlist::Module;
use rust_hdl_core::prelude::Verilog;
use rust_hdl_core::prelude::ast::{
    VerilogBlock, VerilogBlockOrConditional as Otherwise, VerilogConditional, VerilogExpression,
    VerilogStatement as Statement,
};
use std::collections::BTreeSet;

/// A translated statement.
#[derive(Debug, Clone)]
pub(crate) enum Step {
    Assign { target: Name, value: String },
    If { test: String, then: Vec<Step>, otherwise: Vec<Step> },
}

/// A sorted kernel; each list has the order of the kernel.
#[derive(Debug, Default)]
pub(crate) struct Kernel {
    /// Continuous assignments of signals that are assigned once.
    pub(crate) wires: Vec<(Name, String)>,
    /// Combinational blocks.
    pub(crate) blocks: Vec<Vec<Step>>,
    /// Statements of the clocked block.
    pub(crate) clocked: Vec<Step>,
}

impl Kernel {
    pub(crate) fn new(module: &Module, names: &Names) -> Result<Self, ExportError> {
        let translator = Translator { module: &module.instance, names, counter: None };
        let Verilog::Combinatorial(code) = &module.code else {
            return Err(translator.unsupported("a module without a kernel"));
        };
        let steps = without_overwritten(block(translator, code)?);
        let mut kernel = Self::default();
        let mut clocked = Vec::new();
        let groups = groups(steps);
        if let Some(signal) = read_between_writes(&groups) {
            return Err(translator.unsupported(&format!("a read of {signal} between two writes")));
        }
        for group in groups {
            let registers = group
                .iter()
                .all(|(_, step)| step.targets().iter().all(|name| name.role == Role::Next));
            match group.as_slice() {
                _ if registers => clocked.extend(group),
                [(_, Step::Assign { target, value })] => {
                    kernel.wires.push((target.clone(), value.clone()));
                }
                _ if group
                    .iter()
                    .any(|(_, step)| step.targets().iter().any(|name| name.role == Role::Next)) =>
                {
                    return Err(
                        translator.unsupported("an `if` that drives registers and other signals")
                    );
                }
                _ => kernel.blocks.push(group.into_iter().map(|(_, step)| step).collect()),
            }
        }
        clocked.sort_by_key(|(place, _)| *place);
        kernel.clocked =
            clocked.into_iter().map(|(_, step)| step).filter(|step| !step.is_hold()).collect();
        Ok(kernel)
    }

    /// The expression that drives a signal that is assigned once.
    pub(crate) fn wire(&self, signal: &str) -> Option<&str> {
        self.wires.iter().find(|(target, _)| target.text == signal).map(|(_, value)| value.as_str())
    }

    /// Whether a combinational block writes the signal.
    pub(crate) fn in_block(&self, signal: &str) -> bool {
        self.blocks.iter().flatten().any(|step| step.writes(signal))
    }

    /// Whether anything reads the signal.
    pub(crate) fn reads(&self, signal: &str) -> bool {
        let steps = self.blocks.iter().flatten().chain(&self.clocked);
        self.wires.iter().any(|(_, value)| mentions(value, signal))
            || steps.into_iter().any(|s| s.reads(signal))
    }

    /// The signals that the combinational blocks write.
    pub(crate) fn block_targets(&self) -> Vec<Name> {
        let mut seen = BTreeSet::new();
        let all = self.blocks.iter().flatten().flat_map(Step::targets);
        all.filter(|name| seen.insert(name.text.clone())).collect()
    }
}

impl Step {
    /// The signals that this statement can write.
    fn targets(&self) -> Vec<Name> {
        match self {
            Self::Assign { target, .. } => vec![target.clone()],
            Self::If { then, otherwise, .. } => {
                then.iter().chain(otherwise).flat_map(Self::targets).collect()
            }
        }
    }

    fn writes(&self, signal: &str) -> bool {
        self.targets().iter().any(|target| target.text == signal)
    }

    fn reads(&self, signal: &str) -> bool {
        match self {
            Self::Assign { value, .. } => mentions(value, signal),
            Self::If { test, then, otherwise } => {
                mentions(test, signal)
                    || then.iter().chain(otherwise).any(|step| step.reads(signal))
            }
        }
    }

    /// Whether this is a register's default, by which it keeps its value. A clocked block does not
    /// need it.
    fn is_hold(&self) -> bool {
        matches!(self, Self::Assign { target, value } if target.text == format!("{value}_next"))
    }
}

/// Whether the text contains the signal's name.
pub(crate) fn mentions(text: &str, signal: &str) -> bool {
    // By bytes: a large module is searched for each of its signals.
    let is_of_name = |byte: &u8| byte.is_ascii_alphanumeric() || *byte == b'_';
    text.as_bytes().split(|byte| !is_of_name(byte)).any(|word| word == signal.as_bytes())
}

fn block(translator: Translator<'_>, code: &VerilogBlock) -> Result<Vec<Step>, ExportError> {
    let mut steps = Vec::new();
    for statement in code {
        match statement {
            Statement::Assignment(target, value) => {
                steps.extend(assignment(translator, target, value)?);
            }
            Statement::If(condition) => steps.push(conditional(translator, condition)?),
            Statement::Macro(inner) => steps.extend(block(translator, inner)?),
            Statement::Loop(counted) => {
                for value in counted.from.as_usize()..counted.to.as_usize() {
                    let counter = Some((counted.index.as_str(), value));
                    steps.extend(block(Translator { counter, ..translator }, &counted.block)?);
                }
            }
            Statement::Comment(_) => {}
            Statement::SliceAssignment { .. } => {
                return Err(translator.unsupported("assignment to some bits"));
            }
            Statement::Match(_) => return Err(translator.unsupported("match")),
            Statement::Link(_) => return Err(translator.unsupported("link or join")),
        }
    }
    Ok(steps)
}

/// Translates an assignment; `None` for a clock, which is connected and not computed.
fn assignment(
    translator: Translator<'_>,
    target: &VerilogExpression,
    value: &VerilogExpression,
) -> Result<Option<Step>, ExportError> {
    let VerilogExpression::Signal(signal) = target else {
        return Err(translator.unsupported("assignment to an expression"));
    };
    let target = translator.names.get(translator.module, &translator.flat(signal))?;
    let value = translator.expression(value)?;
    if target.role == Role::Clock {
        return if value.text == "clock" {
            Ok(None)
        } else {
            Err(translator.unsupported("a derived clock"))
        };
    }
    if target.width != value.width {
        return Err(translator.unsupported(&format!(
            "{} ({} bits) = {} ({} bits)",
            target.text, target.width, value.text, value.width
        )));
    }
    Ok(Some(Step::Assign { target: target.clone(), value: value.text }))
}

fn conditional(
    translator: Translator<'_>,
    condition: &VerilogConditional,
) -> Result<Step, ExportError> {
    let otherwise = match &condition.otherwise {
        Otherwise::Block(code) => block(translator, code)?,
        Otherwise::Conditional(statement) => match statement.as_ref() {
            Statement::If(inner) => vec![conditional(translator, inner)?],
            _ => return Err(translator.unsupported("else")),
        },
        Otherwise::None => Vec::new(),
    };
    let test = translator.expression(&condition.test)?.text;
    Ok(Step::If { test, then: block(translator, &condition.then)?, otherwise })
}

/// Removes defaults that are always overwritten before they are read.
fn without_overwritten(steps: Vec<Step>) -> Vec<Step> {
    let dead = |place: usize, signal: &str| {
        for step in &steps[place + 1..] {
            match step {
                _ if step.reads(signal) => return false,
                Step::Assign { target, .. } if target.text == signal => return true,
                Step::If { .. } if step.writes(signal) => return false,
                _ => {}
            }
        }
        false
    };
    let keep: Vec<bool> = steps
        .iter()
        .enumerate()
        .map(|(place, step)| !matches!(step, Step::Assign { target, .. } if dead(place, &target.text)))
        .collect();
    steps.into_iter().zip(keep).filter_map(|(step, keep)| keep.then_some(step)).collect()
}

/// Statements with their positions in the kernel.
type Group = Vec<(usize, Step)>;

/// Groups the statements that write a common signal, directly or by way of other statements.
fn groups(steps: Vec<Step>) -> Vec<Group> {
    let mut groups: Vec<(BTreeSet<String>, Group)> = Vec::new();
    for (place, step) in steps.into_iter().enumerate() {
        let mut written: BTreeSet<String> =
            step.targets().into_iter().map(|name| name.text).collect();
        let mut group = vec![(place, step)];
        groups.retain_mut(|(other_written, other)| {
            let apart = other_written.is_disjoint(&written);
            if !apart {
                written.append(other_written);
                group.append(other);
            }
            apart
        });
        group.sort_by_key(|(place, _)| *place);
        groups.push((written, group));
    }
    groups.sort_by_key(|(_, group)| group[0].0);
    groups.into_iter().map(|(_, group)| group).collect()
}

/// The groups become parallel blocks, so a group may read a signal of another one only after its
/// last write. Returns a signal for which this is not so.
fn read_between_writes(groups: &[Group]) -> Option<String> {
    let last_write = |group: &Group, signal: &str| {
        group.iter().rev().find(|(_, step)| step.writes(signal)).map(|(place, _)| *place)
    };
    for (owner, group) in groups.iter().enumerate() {
        let signals: BTreeSet<String> =
            group.iter().flat_map(|(_, step)| step.targets()).map(|name| name.text).collect();
        for signal in signals {
            let last = last_write(group, &signal);
            let others = groups
                .iter()
                .enumerate()
                .filter(|(other, _)| *other != owner)
                .flat_map(|(_, group)| group);
            if others.into_iter().any(|(place, step)| Some(*place) < last && step.reads(&signal)) {
                return Some(signal);
            }
        }
    }
    None
}
