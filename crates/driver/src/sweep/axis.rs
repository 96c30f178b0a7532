//! What changes from run to run of a sweep: `--set` with several values.

use crate::machine::room_for;
use crate::scene_file::{SceneProblem, split_assignment};
use std::collections::BTreeSet;

/// Decimal digits of the values within a range; its ends are kept as they are.
const DIGITS_EVEN: usize = 12;
/// The same for even steps of the logarithm, where round values are rare.
const DIGITS_LOG: usize = 6;
/// More values, or runs, than anybody means.
const MOST: usize = 100_000;
/// Memory that a run takes beside its text, of which it holds two \[bytes\].
const BYTES_PER_RUN: f64 = 2000.0;

/// A place of the scene and the values that it takes; a plain `--set` has one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Axis {
    /// The place, and the name of its column in the table.
    pub path: String,
    /// The values as they are written.
    pub values: Vec<String>,
}

impl Axis {
    /// The axis of `path=v1,v2,...`, where each item is a value or a range.
    ///
    /// Commas within brackets, braces and double quotes belong to a value. A range is `1..5` (whole
    /// numbers, both ends included), `0.2..1:5` (five values in even steps) or `0.1..10:log5` (five
    /// values in even ratios); a unit may follow the count: `10..30:3 mm`.
    ///
    /// # Errors
    /// When it does not read so, or a value stands there twice.
    pub fn of(text: &str) -> Result<Self, SceneProblem> {
        let wrong = |message: String, hint: &str| {
            SceneProblem::of_file(format!("--set {text}"), message).with_hint(hint)
        };
        let usage = "for example `--set sample.aspect_ratio=0.4,0.8,2` or `--set sample.seed=1..5`";
        let Some((path, list)) = split_assignment(text) else {
            return Err(wrong("an axis of a sweep is a path, `=` and values".to_owned(), usage));
        };
        let mut values = Vec::new();
        for item in items(list).map_err(|message| wrong(message.to_owned(), usage))? {
            if item.is_empty() {
                return Err(wrong("a value is missing".to_owned(), usage));
            }
            match range(item) {
                None => values.push(item.to_owned()),
                Some(Ok(several)) => values.extend(several),
                Some(Err(message)) => {
                    let hint = "a range is `1..5` for whole numbers, `0.2..1:5` for five values in even steps, or \
                                `0.1..10:log5` for five in even ratios";
                    return Err(wrong(format!("`{item}`: {message}"), hint));
                }
            }
        }
        let mut known = BTreeSet::new();
        if let Some(twice) = values.iter().find(|value| !known.insert(*value)) {
            let message = format!("`{twice}` is given twice; allowed: each value once");
            return Err(wrong(message, "leave one of them out"));
        }
        Ok(Self { path: path.to_owned(), values })
    }

    /// Whether the value differs from run to run.
    pub fn varies(&self) -> bool {
        self.values.len() > 1
    }
}

/// A value as tables show it: a text without its quotes.
pub(super) fn label_of(value: &str) -> String {
    let inner = value.strip_prefix('"').and_then(|rest| rest.strip_suffix('"'));
    inner.filter(|inner| !inner.contains(['"', '\\'])).unwrap_or(value).to_owned()
}

/// Refuses a grid of more runs than anybody means, or than the memory of this machine holds with scenes of this length
/// \[bytes\].
pub(super) fn refuse_many(axes: &[Axis], length: usize) -> Result<(), SceneProblem> {
    let count: f64 = axes.iter().map(|axis| axis.values.len() as f64).product();
    let allowed = if count > MOST as f64 {
        Err(format!("at most {MOST} runs"))
    } else {
        room_for(count, BYTES_PER_RUN + 2.0 * length as f64)
    };
    allowed.map_err(|allowed| {
        let counts: Vec<String> =
            axes.iter().filter(|axis| axis.varies()).map(|axis| axis.values.len().to_string()).collect();
        let message = format!("the axes make {} = {count:.0} runs; allowed: {allowed}", counts.join(" x "));
        SceneProblem::of_file("--set", message).with_hint("give fewer values, or several sweeps")
    })
}

/// The values of every point of the grid, one per axis; the last axis is the fastest.
pub(super) fn grid(axes: &[Axis]) -> Vec<Vec<String>> {
    let mut points = vec![Vec::new()];
    for axis in axes {
        let longer = points.iter().flat_map(|point: &Vec<String>| {
            axis.values.iter().map(move |value| point.iter().chain([value]).cloned().collect())
        });
        points = longer.collect();
    }
    points
}

/// Parts between the commas that stand in no brackets and no text.
fn items(list: &str) -> Result<Vec<&str>, &'static str> {
    let (mut found, mut start, mut open, mut in_text, mut escaped) =
        (Vec::new(), 0, Vec::new(), false, false);
    for (at, mark) in list.char_indices() {
        if in_text {
            in_text = escaped || mark != '"';
            escaped = mark == '\\' && !escaped;
            continue;
        }
        match mark {
            '"' => in_text = true,
            '(' => open.push(')'),
            '[' => open.push(']'),
            '{' => open.push('}'),
            ')' | ']' | '}' if open.pop() != Some(mark) => {
                return Err("a bracket closes that was not opened");
            }
            ',' if open.is_empty() => {
                found.push(list[start..at].trim());
                start = at + 1;
            }
            _ => {}
        }
    }
    match (in_text, open.is_empty()) {
        (true, _) => Err("a text in double quotes does not end"),
        (_, false) => Err("a bracket is not closed"),
        _ => {
            found.push(list[start..].trim());
            Ok(found)
        }
    }
}

/// The values of a range; `None` when the item is none.
fn range(item: &str) -> Option<Result<Vec<String>, String>> {
    let (from, rest) = item.split_once("..")?;
    let from: f64 = from.trim().parse().ok().filter(|number: &f64| number.is_finite())?;
    Some(match rest.split_once(':') {
        None => whole_numbers(from, rest),
        Some((to, count)) => counted(from, to, count.trim()),
    })
}

fn end_of(to: &str) -> Result<f64, String> {
    let number = to.trim().parse().ok().filter(|number: &f64| number.is_finite());
    number.ok_or_else(|| format!("it ends at `{}`, which is not a number", to.trim()))
}

fn whole_numbers(from: f64, to: &str) -> Result<Vec<String>, String> {
    let to = end_of(to)?;
    if from.fract() != 0.0 || to.fract() != 0.0 || from.abs().max(to.abs()) > 1e15 {
        return Err("between numbers that are not whole it needs a count".to_owned());
    }
    let (from, to) = (from as i64, to as i64);
    if to < from || (to - from) as usize >= MOST {
        return Err(format!("it goes up from a number to a larger one, in fewer than {MOST} steps"));
    }
    Ok((from..=to).map(|number| number.to_string()).collect())
}

fn counted(from: f64, to: &str, count: &str) -> Result<Vec<String>, String> {
    let to = end_of(to)?;
    let (log, count) = count.strip_prefix("log").map_or((false, count), |rest| (true, rest.trim_start()));
    let digits = count.find(|c: char| !c.is_ascii_digit()).unwrap_or(count.len());
    let (number, unit) = (&count[..digits], count[digits..].trim());
    let number = number.parse().ok().filter(|number| (2..=MOST).contains(number));
    let number: usize = number.ok_or_else(|| format!("the count of values is from 2 to {MOST}"))?;
    if log && (from <= 0.0 || to <= 0.0) {
        return Err("even ratios need ends above zero".to_owned());
    }
    let value = |k: usize| {
        let share = k as f64 / (number - 1) as f64;
        match k {
            0 => from,
            k if k + 1 == number => to,
            _ if log => rounded(from * (to / from).powf(share), DIGITS_LOG),
            _ => rounded(from + (to - from) * share, DIGITS_EVEN),
        }
    };
    let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
    Ok((0..number).map(|k| format!("{}{unit}", value(k))).collect())
}

/// Rounded to decimal digits, so that 0.1 + 0.2 reads 0.3.
fn rounded(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits - 1).parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(text: &str) -> Vec<String> {
        Axis::of(text).unwrap().values
    }

    #[test]
    fn values_may_be_lists_texts_and_variants() {
        let axis = Axis::of(r#"a."b.c"=1, [2, 3],"68 mm", Box(low: [0, 1], name: "a, \"b"), 4 mm"#).unwrap();
        assert_eq!(axis.path, r#"a."b.c""#);
        assert_eq!(axis.values, ["1", "[2, 3]", r#""68 mm""#, r#"Box(low: [0, 1], name: "a, \"b")"#, "4 mm"]);
        assert_eq!(label_of(&axis.values[2]), "68 mm");
        assert!(!Axis::of("gravity=[0, -9.81]").unwrap().varies());
    }

    #[test]
    fn ranges_are_written_out() {
        assert_eq!(values("a=1..4"), ["1", "2", "3", "4"]);
        assert_eq!(values("a=-1..1,7"), ["-1", "0", "1", "7"]);
        assert_eq!(values("a=0.1..0.3:3"), ["0.1", "0.2", "0.3"]);
        assert_eq!(values("a=2..1:3"), ["2", "1.5", "1"]);
        assert_eq!(values("a=0.01..1:log3"), ["0.01", "0.1", "1"]);
        assert_eq!(values("a=10..30:3 mm"), ["10 mm", "20 mm", "30 mm"]);
        // No range: a path of a file.
        assert_eq!(values("a=../grains.stl"), ["../grains.stl"]);
    }

    #[test]
    fn what_does_not_read_as_values_is_refused() {
        let cases = [
            ("a", "a path, `=` and values"),
            ("=1", "a path, `=` and values"),
            ("a=", "a value is missing"),
            ("a=1,,2", "a value is missing"),
            ("a=1,2,1", "`1` is given twice"),
            ("a=[1", "not closed"),
            ("a=1]", "not opened"),
            ("a=\"x", "does not end"),
            ("a=0.2..1", "needs a count"),
            ("a=5..1", "goes up"),
            ("a=1..x", "is not a number"),
            ("a=0.2..1:1", "from 2 to"),
            ("a=0..1:log3", "above zero"),
        ];
        for (text, part) in cases {
            let problem = Axis::of(text).unwrap_err().to_string();
            assert!(problem.contains(part), "{text}: {problem}");
        }
    }

    #[test]
    fn the_last_axis_is_the_fastest() {
        let axes = [Axis::of("a=1,2").unwrap(), Axis::of("b=x").unwrap(), Axis::of("c=y,z").unwrap()];
        let points: Vec<String> = grid(&axes).iter().map(|values| values.join("")).collect();
        assert_eq!(points, ["1xy", "1xz", "2xy", "2xz"]);
    }
}
