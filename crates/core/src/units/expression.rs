//! Reading a number with a product of units.

use super::dimension::Dimension;
use super::error::UnitError;
use super::symbols::{Scale, find, nearest};

/// Longest unit that is read; bounds the nesting of parentheses. Longer texts are cut in messages.
const LONGEST: usize = 100;
/// Largest power of a unit.
const LARGEST_POWER: i32 = 9;

/// Reads a number with its unit and returns it in SI units.
///
/// Units are multiplied by `*`, `.`, `·` or a space, divided by `/`, raised by `^2` and grouped
/// by parentheses; `kg/m s` is refused since it can be read in two ways. Prefixes go from `p` to
/// `T`. The result has the bits of the same number written in SI units, unless the unit is no
/// power of ten (`deg`, `min`, `h`, `rpm`).
///
/// # Errors
/// When there is no finite number, a unit is unknown, or the unit measures something else.
pub fn parse(text: &str, dimension: Dimension) -> Result<f64, UnitError> {
    let trimmed = text.trim();
    let syntax = |problem| UnitError::Syntax { text: shortened(trimmed), problem };
    let (number, unit) = split_number(trimmed);
    if number.is_empty() {
        let lower = trimmed.trim_start_matches(['+', '-']).to_lowercase();
        return Err(if ["inf", "infinity", "nan"].iter().any(|word| lower.starts_with(word)) {
            UnitError::OutOfRange { text: shortened(trimmed), expected: dimension }
        } else {
            UnitError::NoNumber { text: shortened(trimmed), expected: dimension }
        });
    }
    if unit.len() > LONGEST {
        return Err(syntax("too long for a number with a unit"));
    }
    if unit.starts_with(',') {
        return Err(syntax("decimals follow a point, not a comma"));
    }
    let scale = Units { rest: unit, expected: dimension }.read().map_err(|problem| match problem {
        Problem::Syntax(problem) => syntax(problem),
        Problem::Unknown(error) => error,
    })?;
    let mut found = [0; 4];
    for (narrow, wide) in found.iter_mut().zip(scale.powers) {
        *narrow = i8::try_from(wide).map_err(|_| syntax("powers as high as this measure nothing"))?;
    }
    if found != dimension.powers {
        return Err(UnitError::WrongDimension { text: shortened(trimmed), found, expected: dimension });
    }
    in_si(number, scale)
        .ok_or_else(|| UnitError::OutOfRange { text: shortened(trimmed), expected: dimension })
}

/// The number times its scale; none when it cannot be held by a double.
fn in_si(number: &str, scale: Scale) -> Option<f64> {
    let (mantissa, exponent) = number.split_once(['e', 'E']).unwrap_or((number, "0"));
    let exponent = exponent.parse::<i32>().ok()?.checked_add(scale.decimals)?;
    // Shifting the written exponent rounds once, where a product would round again.
    let value = format!("{mantissa}e{exponent}").parse::<f64>().ok()? * scale.factor;
    let lost = value == 0.0 && mantissa.contains(|c: char| ('1'..='9').contains(&c));
    (value.is_finite() && !lost).then_some(value)
}

/// Splits `1.6e6 N/m` into `1.6e6` and `N/m`.
fn split_number(text: &str) -> (&str, &str) {
    let bytes = text.as_bytes();
    let digits = |from: usize| bytes[from..].iter().take_while(|byte| byte.is_ascii_digit()).count();
    let start = usize::from(text.starts_with(['+', '-']));
    let whole = digits(start);
    let mut end = start + whole;
    if bytes.get(end) == Some(&b'.') {
        let decimals = digits(end + 1);
        if whole + decimals == 0 {
            return ("", text);
        }
        end += 1 + decimals;
    } else if whole == 0 {
        return ("", text);
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        let exponent = digits((end + 1 + sign).min(bytes.len()));
        if exponent > 0 {
            end += 1 + sign + exponent;
        }
    }
    (&text[..end], text[end..].trim_start())
}

enum Problem {
    Syntax(&'static str),
    Unknown(UnitError),
}

struct Units<'a> {
    rest: &'a str,
    expected: Dimension,
}

impl Units<'_> {
    fn read(mut self) -> Result<Scale, Problem> {
        if self.rest.is_empty() {
            return Ok(NOTHING);
        }
        let scale = self.product()?;
        if self.rest.is_empty() {
            Ok(scale)
        } else {
            Err(Problem::Syntax("a parenthesis is closed that was not opened"))
        }
    }

    fn product(&mut self) -> Result<Scale, Problem> {
        let mut product = self.factor()?;
        let mut divided = false;
        loop {
            let spaced = self.rest.starts_with(char::is_whitespace);
            self.rest = self.rest.trim_start();
            if self.rest.is_empty() || self.rest.starts_with(')') {
                return Ok(product);
            }
            if self.take(&['/']) {
                divided = true;
                product = combined(product, raised(self.factor()?, -1)?)?;
            } else if self.take(&['*', '.', '·', '⋅', '×']) || spaced {
                if divided {
                    return Err(Problem::Syntax(
                        "a product after `/` can be read in two ways; use parentheses, as in `kg/(m s)`",
                    ));
                }
                product = combined(product, self.factor()?)?;
            } else {
                return Err(Problem::Syntax("units are multiplied by `*` or a space and divided by `/`"));
            }
        }
    }

    fn factor(&mut self) -> Result<Scale, Problem> {
        self.rest = self.rest.trim_start();
        let scale = if self.take(&['(']) {
            let inner = self.product()?;
            if !self.take(&[')']) {
                return Err(Problem::Syntax("a parenthesis is not closed"));
            }
            inner
        } else {
            self.unit()?
        };
        match self.power()? {
            Some(power) => raised(scale, power),
            None => Ok(scale),
        }
    }

    fn unit(&mut self) -> Result<Scale, Problem> {
        let part = |c: char| c.is_alphabetic() || matches!(c, '%' | '‰' | '°' | '_');
        let letters = self.rest.find(|c| !part(c)).unwrap_or(self.rest.len());
        let length = if self.rest.starts_with('1') { 1 } else { letters };
        let (name, rest) = self.rest.split_at(length);
        if name.is_empty() {
            return Err(Problem::Syntax("a unit is missing, or is not written with letters"));
        }
        self.rest = rest;
        find(name).ok_or_else(|| {
            Problem::Unknown(UnitError::UnknownUnit {
                unit: name.to_owned(),
                nearest: nearest(name, self.expected),
                expected: self.expected,
            })
        })
    }

    fn power(&mut self) -> Result<Option<i32>, Problem> {
        for (sign, power) in [('²', 2), ('³', 3)] {
            if self.take(&[sign]) {
                return Ok(Some(power));
            }
        }
        if !self.rest.trim_start().starts_with('^') {
            return Ok(None);
        }
        self.rest = self.rest.trim_start()[1..].trim_start();
        let negative = self.take(&['-']);
        let digits = self.rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(self.rest.len());
        let (digits, rest) = self.rest.split_at(digits);
        self.rest = rest;
        match digits.parse::<i32>() {
            Ok(power) if power <= LARGEST_POWER => Ok(Some(if negative { -power } else { power })),
            _ => Err(Problem::Syntax("a power is a whole number from -9 to 9, as in `m^3`")),
        }
    }

    fn take(&mut self, any_of: &[char]) -> bool {
        let rest = self.rest.strip_prefix(any_of);
        self.rest = rest.unwrap_or(self.rest);
        rest.is_some()
    }
}

const NOTHING: Scale = Scale { powers: [0; 4], decimals: 0, factor: 1.0 };
const TOO_HIGH: Problem = Problem::Syntax("powers as high as this measure nothing");

fn combined(a: Scale, b: Scale) -> Result<Scale, Problem> {
    let mut powers = a.powers;
    for (power, other) in powers.iter_mut().zip(b.powers) {
        *power += other;
    }
    bounded(Scale { powers, decimals: a.decimals + b.decimals, factor: a.factor * b.factor })
}

fn raised(scale: Scale, power: i32) -> Result<Scale, Problem> {
    bounded(Scale {
        powers: scale.powers.map(|old| old * power),
        decimals: scale.decimals * power,
        factor: scale.factor.powi(power),
    })
}

/// Refuses what nobody means; keeps every sum and product of powers far from overflow.
fn bounded(scale: Scale) -> Result<Scale, Problem> {
    let fits = scale.powers.iter().all(|power| power.abs() <= 99) && scale.decimals.abs() <= 999;
    if fits && scale.factor.is_finite() && scale.factor > 0.0 { Ok(scale) } else { Err(TOO_HIGH) }
}

/// Messages quote the text; one that goes on for pages is cut.
fn shortened(text: &str) -> String {
    if text.chars().count() <= LONGEST {
        return text.to_owned();
    }
    text.chars().take(LONGEST).chain(['…']).collect()
}
