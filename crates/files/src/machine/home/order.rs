//! `home_order`: the groups of axes that home one after the other; the axes of a group home
//! together.

use crate::error::{InputError, SourceText};
use crate::machine::Axis;
use toml::Spanned;

/// Names of axes in groups, in homing order.
pub(in crate::machine) type RawOrder = Spanned<Vec<Vec<Spanned<String>>>>;

/// The order of a file. It must name every axis that homes exactly once.
pub(super) fn of(
    source: &SourceText,
    axes: &[Axis],
    order: RawOrder,
) -> Result<Vec<Vec<usize>>, InputError> {
    let span = order.span();
    let mut seen = vec![false; axes.len()];
    let mut groups = Vec::new();
    for names in order.into_inner() {
        let mut group = Vec::new();
        for name in names {
            let at = |message: String| InputError::at(source, name.span(), message);
            let Some(axis) = axes.iter().position(|axis| axis.letter == *name.as_ref()) else {
                let mut known: Vec<&str> = axes.iter().map(|axis| axis.letter.as_str()).collect();
                known.dedup();
                let message = format!("home_order names '{}', which is no axis", name.as_ref());
                return Err(at(message).help(format!("the axes are {}", known.join(", "))));
            };
            if axes[axis].home.is_none() {
                return Err(at(format!(
                    "home_order names axis '{}', which has no home table",
                    name.as_ref()
                )));
            }
            if seen[axis] {
                return Err(at(format!("home_order names axis '{}' twice", name.as_ref())));
            }
            // All motors of a letter home together.
            let motors = (axis..axes.len()).filter(|&motor| axes[motor].letter == *name.as_ref());
            for motor in motors {
                seen[motor] = true;
                group.push(motor);
            }
        }
        if !group.is_empty() {
            groups.push(group);
        }
    }
    if let Some((axis, _)) = axes.iter().zip(seen).find(|(axis, seen)| axis.home.is_some() && !seen)
    {
        let message =
            format!("home_order leaves out axis '{}', which has a home table", axis.letter);
        return Err(InputError::at(source, span, message).help("name every axis that homes"));
    }
    Ok(groups)
}

/// The default order, as in grbl: z first, because the tool must be raised before the table moves;
/// then all other axes together.
pub(super) fn usual(axes: &[Axis]) -> Vec<Vec<usize>> {
    let homes = (0..axes.len()).filter(|&axis| axes[axis].home.is_some());
    let (first, rest): (Vec<usize>, Vec<usize>) =
        homes.partition(|&axis| axes[axis].letter.eq_ignore_ascii_case("z"));
    [first, rest].into_iter().filter(|group| !group.is_empty()).collect()
}
