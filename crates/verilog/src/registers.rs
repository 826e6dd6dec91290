//! Generates the register map for clients from the table in `spec`: Rust constants, a C header, and
//! a page of documentation.

use crate::ExportError;
use carrystep_core::engine::{CAUSES, Cause};
use carrystep_core::link::registers::{self, REGISTERS};
use carrystep_core::link::{
    self, ANSWER, ANSWER_DATA, Field, LinkConstant, REFUSALS, Refusal, WRITE,
};
use minijinja::{Environment, Value, context};

/// The generated files: path in the workspace, and template.
const FILES: [(&str, &str); 3] = [
    ("crates/link/src/registers.rs", include_str!("../templates/registers.rs")),
    ("crates/link/c/carrystep_registers.h", include_str!("../templates/registers.h")),
    ("docs/registers.md", include_str!("../templates/registers.md")),
];

/// The files of the register map: path in the workspace, and text.
///
/// # Errors
/// [`ExportError::Template`] if a template uses a value that does not exist.
pub(crate) fn files() -> Result<Vec<(&'static str, String)>, ExportError> {
    let environment = Environment::new();
    let values = context! {
        constants => link::CONSTANTS.iter().chain(registers::CONSTANTS).map(constant).collect::<Vec<_>>(),
        registers => REGISTERS.iter().map(|row| context! {
            name => row.name,
            address => format!("{:#04x}", row.address),
            access => row.access.to_string(),
            per_axis => row.per_axis,
            what => row.what,
        }).collect::<Vec<_>>(),
        fields => ANSWER.iter().map(field).collect::<Vec<_>>(),
        causes => CAUSES.map(Cause::name),
        reasons => REFUSALS.map(reason),
        data => ANSWER_DATA,
        write => format!("`{WRITE:#04x}`"),
    };
    let render = |(path, template)| Ok((path, environment.render_str(template, &values)? + "\n"));
    FILES.into_iter().map(render).collect()
}

/// The values of a constant. Lengths are decimal, all other values hexadecimal.
fn constant(row: &LinkConstant) -> Value {
    let (rust, c) = match row.kind {
        "u8" => (format!("{:#04x}", row.value), format!("{:#04x}u", row.value)),
        "u32" => {
            let (high, low) = (row.value >> 16, row.value & 0xffff);
            (format!("{high:#06x}_{low:04x}"), format!("UINT32_C({:#010x})", row.value))
        }
        _ => (row.value.to_string(), format!("{}u", row.value)),
    };
    context! { name => row.name, kind => row.kind, what => row.what, rust, c }
}

fn reason(refusal: Refusal) -> Value {
    context! { name => refusal.to_string(), number => refusal.number(), what => refusal.what() }
}

fn field(row: &Field) -> Value {
    let Field { name, byte, bit, bits, what } = *row;
    let mask = (1_u32 << bits) - 1;
    let rust = match (bit, bits) {
        (_, 8) => format!("answer[{byte}]"),
        (0, 1) => format!("answer[{byte}] & 1 == 1"),
        (_, 1) => format!("answer[{byte}] >> {bit} & 1 == 1"),
        (0, _) => format!("answer[{byte}] & {mask}"),
        _ if bit + bits == 8 => format!("answer[{byte}] >> {bit}"),
        _ => format!("answer[{byte}] >> {bit} & {mask}"),
    };
    let c = format!("((uint8_t)((answer)[{byte}] >> {bit} & {mask}u))");
    let range = match bits {
        8 => String::new(),
        1 => bit.to_string(),
        _ => format!("{}..{bit}", bit + bits - 1),
    };
    context! { name, byte, bits, what, rust, c, range }
}
