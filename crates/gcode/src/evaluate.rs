//! Computes the values of expressions.
//!
//! The functions are those of RS274/NGC (Kramer, Proctor, Messina 2000, section 3.3.2), as
//! LinuxCNC computes them: angles in degrees, `ROUND` half away from zero, `FIX` down, `FUP` up,
//! `MOD` at least zero, and `EQ` true for values that differ by less than 0.0001.

use crate::error::{ErrorKind, Fault};
use crate::syntax::{Expression, ExpressionKind, Function, Operator, Reference};

/// Two values that differ by less than this are equal (`EQ`, `NE`), and a number that differs from
/// a whole one by less than this is whole, as in LinuxCNC.
pub(crate) const EQUAL: f64 = 0.0001;

/// Number of the last parameter.
pub(crate) const LAST_PARAMETER: usize = 5602;

/// The values of parameters.
pub(crate) trait Values {
    /// The value of `#number`, with a number from 1 to [`LAST_PARAMETER`].
    fn numbered(&self, number: usize) -> f64;
    /// The value of `#<name>`, if it has one.
    fn named(&self, name: &str) -> Option<f64>;
}

/// Computes an expression. The result is finite.
///
/// # Errors
/// The place and kind of a value that is not defined.
pub(crate) fn evaluate(expression: &Expression, values: &impl Values) -> Result<f64, Fault> {
    let at = |kind| Fault::new(expression.column, kind);
    let result = match &expression.kind {
        ExpressionKind::Number(number) => *number,
        ExpressionKind::Parameter(Reference::Name(name)) => values
            .named(name)
            .ok_or_else(|| at(ErrorKind::Undefined(name.chars().take(40).collect())))?,
        ExpressionKind::Parameter(Reference::Number(number)) => {
            values.numbered(parameter_number(number, values)?)
        }
        ExpressionKind::Exists(Reference::Name(name)) => truth(values.named(name).is_some()),
        ExpressionKind::Exists(Reference::Number(number)) => {
            parameter_number(number, values)?;
            1.0
        }
        ExpressionKind::Negative(of) => -evaluate(of, values)?,
        ExpressionKind::Function(function, of) => {
            apply(*function, evaluate(of, values)?).map_err(at)?
        }
        ExpressionKind::Atan(y, x) => {
            let (y, x) = (evaluate(y, values)?, evaluate(x, values)?);
            y.atan2(x).to_degrees()
        }
        ExpressionKind::Chain(first, rest) => {
            let mut result = evaluate(first, values)?;
            for (column, operator, operand) in rest {
                let fault = |kind| Fault::new(*column, kind);
                result = combine(*operator, result, evaluate(operand, values)?).map_err(fault)?;
                if !result.is_finite() {
                    return Err(fault(ErrorKind::Overflow));
                }
            }
            result
        }
    };
    if result.is_finite() { Ok(result) } else { Err(at(ErrorKind::Overflow)) }
}

/// Computes the number of a parameter.
pub(crate) fn parameter_number(
    expression: &Expression,
    values: &impl Values,
) -> Result<usize, Fault> {
    let value = evaluate(expression, values)?;
    match whole(value) {
        Some(number) if (1.0..=LAST_PARAMETER as f64).contains(&number) => Ok(number as usize),
        _ => Err(Fault::new(expression.column, ErrorKind::ParameterNumber(value))),
    }
}

/// The whole number that a value is, if it is one.
pub(crate) fn whole(value: f64) -> Option<f64> {
    let nearest = value.round();
    ((value - nearest).abs() < EQUAL).then_some(nearest)
}

fn truth(holds: bool) -> f64 {
    f64::from(u8::from(holds))
}

fn apply(function: Function, value: f64) -> Result<f64, ErrorKind> {
    let within = |is_within: bool, function| {
        if is_within { Ok(value) } else { Err(ErrorKind::Domain { function, value }) }
    };
    Ok(match function {
        Function::Abs => value.abs(),
        Function::Acos => within((-1.0..=1.0).contains(&value), "ACOS")?.acos().to_degrees(),
        Function::Asin => within((-1.0..=1.0).contains(&value), "ASIN")?.asin().to_degrees(),
        Function::Cos => value.to_radians().cos(),
        Function::Exp => value.exp(),
        Function::Fix => value.floor(),
        Function::Fup => value.ceil(),
        Function::Ln => within(value > 0.0, "LN")?.ln(),
        Function::Round => value.round(),
        Function::Sin => value.to_radians().sin(),
        Function::Sqrt => within(value >= 0.0, "SQRT")?.sqrt(),
        Function::Tan => value.to_radians().tan(),
    })
}

fn combine(operator: Operator, left: f64, right: f64) -> Result<f64, ErrorKind> {
    Ok(match operator {
        Operator::Power if left < 0.0 && whole(right).is_none() => {
            return Err(ErrorKind::Domain { function: "a broken power", value: left });
        }
        Operator::Power if left == 0.0 && right < 0.0 => return Err(ErrorKind::DivisionByZero),
        Operator::Power => left.powf(if left < 0.0 { right.round() } else { right }),
        Operator::Times => left * right,
        Operator::Over | Operator::Mod if right == 0.0 => return Err(ErrorKind::DivisionByZero),
        Operator::Over => left / right,
        Operator::Mod => left.rem_euclid(right),
        Operator::Plus => left + right,
        Operator::Minus => left - right,
        Operator::Equal => truth((left - right).abs() < EQUAL),
        Operator::NotEqual => truth((left - right).abs() >= EQUAL),
        Operator::Greater => truth(left > right),
        Operator::GreaterOrEqual => truth(left >= right),
        Operator::Less => truth(left < right),
        Operator::LessOrEqual => truth(left <= right),
        Operator::And => truth(left != 0.0 && right != 0.0),
        Operator::Or => truth(left != 0.0 || right != 0.0),
        Operator::Xor => truth((left != 0.0) != (right != 0.0)),
    })
}
