//! Names of units and prefixes, and the one that was perhaps meant.

use super::dimension::Dimension;

/// A product of powers of base units with its size in SI: `factor * 10^decimals`.
///
/// Powers of ten are kept apart so that `1.15 mm` can be read as `1.15e-3` without rounding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Scale {
    pub(super) powers: [i32; 4],
    pub(super) decimals: i32,
    pub(super) factor: f64,
}

struct Symbol {
    name: &'static str,
    takes_prefix: bool,
    scale: Scale,
}

const fn symbol(
    name: &'static str,
    takes_prefix: bool,
    powers: [i32; 4],
    decimals: i32,
    factor: f64,
) -> Symbol {
    Symbol { name, takes_prefix, scale: Scale { powers, decimals, factor } }
}

const DEGREE: f64 = std::f64::consts::PI / 180.0;

const SYMBOLS: [Symbol; 18] = [
    symbol("m", true, [0, 1, 0, 0], 0, 1.0),
    symbol("s", true, [0, 0, 1, 0], 0, 1.0),
    symbol("g", true, [1, 0, 0, 0], -3, 1.0),
    symbol("N", true, [1, 1, -2, 0], 0, 1.0),
    symbol("Pa", true, [1, -1, -2, 0], 0, 1.0),
    symbol("J", true, [1, 2, -2, 0], 0, 1.0),
    symbol("W", true, [1, 2, -3, 0], 0, 1.0),
    symbol("Hz", true, [0, 0, -1, 0], 0, 1.0),
    symbol("rad", true, [0, 0, 0, 1], 0, 1.0),
    symbol("deg", false, [0, 0, 0, 1], 0, DEGREE),
    symbol("°", false, [0, 0, 0, 1], 0, DEGREE),
    symbol("rpm", false, [0, 0, -1, 1], 0, std::f64::consts::PI / 30.0),
    symbol("min", false, [0, 0, 1, 0], 0, 60.0),
    symbol("h", false, [0, 0, 1, 0], 0, 3600.0),
    symbol("t", false, [1, 0, 0, 0], 3, 1.0),
    symbol("%", false, [0, 0, 0, 0], -2, 1.0),
    symbol("‰", false, [0, 0, 0, 0], -3, 1.0),
    symbol("1", false, [0, 0, 0, 0], 0, 1.0),
];

/// Prefixes with their power of ten; the last two are micro sign and Greek letter.
const PREFIXES: [(&str, i32); 13] = [
    ("p", -12),
    ("n", -9),
    ("u", -6),
    ("m", -3),
    ("c", -2),
    ("d", -1),
    ("h", 2),
    ("k", 3),
    ("M", 6),
    ("G", 9),
    ("T", 12),
    ("\u{b5}", -6),
    ("\u{3bc}", -6),
];

/// Words that are often written for units.
const WORDS: [(&str, &str); 22] = [
    ("metre", "m"),
    ("meter", "m"),
    ("millimetre", "mm"),
    ("millimeter", "mm"),
    ("micron", "um"),
    ("sec", "s"),
    ("second", "s"),
    ("minute", "min"),
    ("hour", "h"),
    ("hr", "h"),
    ("gram", "g"),
    ("kilogram", "kg"),
    ("newton", "N"),
    ("pascal", "Pa"),
    ("joule", "J"),
    ("watt", "W"),
    ("hertz", "Hz"),
    ("radian", "rad"),
    ("degree", "deg"),
    ("percent", "%"),
    ("tonne", "t"),
    ("ton", "t"),
];

/// The unit with this name, with or without a prefix.
pub(super) fn find(name: &str) -> Option<Scale> {
    // Whole names come first: `min` is a minute and `m` a metre.
    if let Some(symbol) = SYMBOLS.iter().find(|symbol| symbol.name == name) {
        return Some(symbol.scale);
    }
    PREFIXES.iter().find_map(|(prefix, decimals)| {
        let rest = name.strip_prefix(prefix)?;
        let symbol = SYMBOLS.iter().find(|symbol| symbol.takes_prefix && symbol.name == rest)?;
        Some(Scale { decimals: symbol.scale.decimals + decimals, ..symbol.scale })
    })
}

/// The unit that was perhaps meant by `name`; units of the expected dimension come first.
pub(super) fn nearest(name: &str, expected: Dimension) -> Option<String> {
    let lower = name.to_lowercase();
    let singular = lower.strip_suffix('s').unwrap_or(&lower);
    if let Some((_, unit)) = WORDS.iter().find(|(word, _)| *word == lower || *word == singular) {
        return Some((*unit).to_owned());
    }
    let length = name.chars().count();
    if length > 8 {
        return None;
    }
    let most = if length <= 3 { 2 } else { 4 };
    let mut best: Option<(usize, String)> = None;
    for unit in every_unit() {
        let cost = edits(name, &unit);
        // A unit of one letter is one edit away from anything short.
        if cost > most || cost >= 2 * length {
            continue;
        }
        let rank =
            2 * cost + if fits(&unit, expected) { 0 } else { 3 } + usize::from(unit.len() != name.len());
        if best.as_ref().is_none_or(|(lowest, _)| rank < *lowest) {
            best = Some((rank, unit));
        }
    }
    best.map(|(_, unit)| unit)
}

fn fits(unit: &str, expected: Dimension) -> bool {
    find(unit).is_some_and(|scale| scale.powers == expected.powers.map(i32::from))
}

fn every_unit() -> impl Iterator<Item = String> {
    SYMBOLS.iter().filter(|symbol| symbol.name != "1").flat_map(|symbol| {
        // The spellings of micro beyond `u` are for reading only.
        let prefixes = if symbol.takes_prefix { &PREFIXES[..11] } else { &[] };
        let prefixed = prefixes.iter().map(|(prefix, _)| format!("{prefix}{}", symbol.name));
        std::iter::once(symbol.name.to_owned()).chain(prefixed)
    })
}

/// Levenshtein's distance with 2 for an edit and 1 for a letter in the wrong case.
fn edits(from: &str, to: &str) -> usize {
    let to: Vec<char> = to.chars().collect();
    let mut row: Vec<usize> = (0..=to.len()).map(|length| 2 * length).collect();
    for (i, a) in from.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = 2 * (i + 1);
        for (j, b) in to.iter().enumerate() {
            let change = match () {
                () if a == *b => 0,
                () if a.eq_ignore_ascii_case(b) => 1,
                () => 2,
            };
            let cost = (diagonal + change).min(row[j] + 2).min(row[j + 1] + 2);
            diagonal = row[j + 1];
            row[j + 1] = cost;
        }
    }
    row[to.len()]
}
