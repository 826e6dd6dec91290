//! `travel`: the range of machine coordinates that an axis can reach.

use super::MOST_STEPS;
use crate::decimal;
use crate::error::{InputError, SourceText};
use crate::machine::Axis;
use crate::number::exact;
use toml::Spanned;

/// Lowest and highest machine coordinate of an axis, steps.
pub(super) fn of(
    source: &SourceText,
    axis: &Axis,
    travel: &Spanned<Vec<Spanned<f64>>>,
) -> Result<[i64; 2], InputError> {
    let span = travel.span();
    let [low, high] = travel.as_ref().as_slice() else {
        return Err(InputError::at(
            source,
            span,
            "travel has two numbers: the lowest and the highest coordinate",
        )
        .help("as in travel = [0, 300]"));
    };
    let coordinate = |value: &Spanned<f64>| -> Result<i64, InputError> {
        let steps = exact(source, value, "travel")? * &axis.steps_per_unit;
        decimal::round_half_away(&steps).filter(|steps| steps.abs() <= MOST_STEPS).ok_or_else(
            || {
                InputError::at(
                    source,
                    value.span(),
                    format!("travel reaches over {MOST_STEPS} steps from zero"),
                )
            },
        )
    };
    let (low, high) = (coordinate(low)?, coordinate(high)?);
    if low >= high {
        return Err(InputError::at(source, span, "travel ends where it begins, or before")
            .help("the lowest coordinate comes first, as in travel = [0, 300]"));
    }
    if high - low > MOST_STEPS {
        return Err(InputError::at(
            source,
            span,
            format!("travel is over {MOST_STEPS} steps long"),
        ));
    }
    Ok([low, high])
}
