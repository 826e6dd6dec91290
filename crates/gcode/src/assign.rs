//! Executes the assignments of a line, as in `#1 = 2` and `#<name> = 2`.

use crate::error::{ErrorKind, Fault};
use crate::evaluate::{evaluate, parameter_number};
use crate::state::State;
use crate::syntax::{Assignment, Reference};
use crate::values;

/// What is assigned to.
enum Target<'b> {
    Number(usize),
    Name(&'b str),
}

/// Sets the parameters of a line. They take effect after all values have been computed.
///
/// # Errors
/// A value that is not defined, a parameter that can only be read, or too many names.
pub(crate) fn assign(state: &mut State, assignments: &[Assignment]) -> Result<(), Fault> {
    if assignments.is_empty() {
        return Ok(());
    }
    let mut computed = Vec::with_capacity(assignments.len());
    for assignment in assignments {
        let read_only = |name| Fault::new(assignment.column, ErrorKind::ReadOnly(name));
        let target = match &assignment.reference {
            Reference::Number(number) => {
                let number = parameter_number(number, state)?;
                if values::is_read_only(number) {
                    return Err(read_only(number.to_string()));
                }
                Target::Number(number)
            }
            Reference::Name(name) => {
                if values::machine_name(state, name).is_some() {
                    return Err(read_only(format!("<{name}>")));
                }
                Target::Name(name)
            }
        };
        computed.push((target, evaluate(&assignment.value, state)?));
    }
    for (target, value) in computed {
        match target {
            Target::Number(number) => state.memory.set(number, value),
            Target::Name(name) => {
                let set = state.memory.set_name(name, value);
                set.map_err(|kind| Fault::new(0, kind))?;
            }
        }
    }
    Ok(())
}
