//! Mutations of scenes: values, entries, names and plain text.

use super::text::{Entry, Kind, Token, entries, tokens};

/// A scene to start from.
pub(super) struct Base {
    name: String,
    text: String,
}

/// A scene to try.
pub(super) struct Case {
    pub(super) name: String,
    pub(super) text: String,
    /// Assignments, as `--set` gives them.
    pub(super) set: Vec<String>,
    /// Axes of a sweep.
    pub(super) axes: Vec<String>,
}

/// Grains of a scene to start from, at most.
const MOST_GRAINS: u64 = 300;

impl Base {
    /// A scene with few grains, so that thousands are tried in a minute.
    pub(super) fn of(name: String, text: &str) -> Self {
        let mut text = text.to_owned();
        if text.contains("Lbm(") && text.contains("dimension: Space") {
            // Lattices in space are the only slow ones.
            text = text.replace("spacing: \"1 mm\"", "spacing: \"2 mm\"");
            text = text.replace("spacing: \"0.5 mm\"", "spacing: \"1 mm\"");
        }
        for begin in ["Grains(", "grains: "] {
            let mut from = 0;
            while let Some(found) = text[from..].find(begin) {
                let at = from + found + begin.len();
                let end = at + text[at..].find(|c: char| !c.is_ascii_digit()).unwrap_or(0);
                if text[at..end].parse::<u64>().is_ok_and(|count| count > MOST_GRAINS) {
                    text.replace_range(at..end, &MOST_GRAINS.to_string());
                }
                from = at;
            }
        }
        Self { name, text }
    }
}

/// Random numbers from a seed (splitmix64).
pub(super) struct Chance(u64);

impl Chance {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn below(&mut self, count: usize) -> usize {
        (self.next() % count.max(1) as u64) as usize
    }

    fn of<'a, T: ?Sized>(&mut self, list: &[&'a T]) -> &'a T {
        list[self.below(list.len())]
    }

    fn is(&mut self, percent: usize) -> bool {
        self.below(100) < percent
    }
}

/// Numbers at the edges of what numbers can be.
const NUMBERS: &[&str] = &[
    "0",
    "-0.0",
    "1",
    "-1",
    "2",
    "0.5",
    "1e-3",
    "1e3",
    "3",
    "7",
    "100",
    "1000",
    "5e-324",
    "1e-310",
    "2.2250738585072014e-308",
    "1e-300",
    "1e-200",
    "1e-160",
    "1e-100",
    "1e-30",
    "1e-16",
    "1e-9",
    "1e9",
    "1e16",
    "1e30",
    "1e100",
    "1e154",
    "1e155",
    "1e200",
    "1e300",
    "1.7976931348623157e308",
    "-1.7976931348623157e308",
    "1e309",
    "-1e300",
    "-1e-300",
    "NaN",
    "inf",
    "-inf",
    "0.1",
    "0.9999999999999999",
    "1.0000000000000002",
    "255",
    "256",
    "257",
    "65535",
    "65536",
    "100000",
    "1000000",
    "2147483647",
    "2147483648",
    "4294967295",
    "4294967296",
    "4000000000",
    "9007199254740993",
    "9223372036854775807",
    "9223372036854775808",
    "18446744073709551615",
    "18446744073709551616",
    "0x10",
    "1_000",
    "1.",
    ".5",
    "+1",
    "--1",
    "1e",
    "0b11",
    "1u8",
    "100000000",
    "100000001",
    "1e-5",
    "1e5",
    "12345.678",
    "60",
    "1e-12",
    "1e12",
];
const UNITS: &[&str] = &[
    "m", "mm", "um", "nm", "km", "s", "ms", "us", "h", "kg", "g", "t", "kg/m^3", "g/cm^3", "N", "kN", "N/m",
    "MN/m", "Pa", "MPa", "GPa", "m/s", "mm/s", "m/s^2", "Hz", "kHz", "1/s", "rad/s", "rpm", "deg", "rad",
    "J", "m^2/s", "m^2", "W", "1", "", "kg m/s", "m^-300", "m^999",
];
const TEXTS: &[&str] = &[
    "",
    " ",
    "a",
    "floor",
    "left",
    "right",
    "gate",
    "glass",
    "front",
    "height",
    "\u{e4}\u{f6}\u{1f642}",
    "../x",
    "/",
    "a/b",
    "a//b",
    "a/../b",
    ".",
    "..",
    "run.json",
    "series.csv",
    "a\\nb",
    "\\u{0}",
    "velocity",
    "x",
    "kinetic_energy",
    "1 mm mm",
    "1e400 m",
    "mm",
    "loss_",
    "force_on__x",
    "force_on_floor_y",
    "1 / 0 m",
    "(1 m",
    "-",
    "10000000000000000000000000000000000000000000 m",
    "1 m^2 / m",
    "scene.ron",
    "pyramid.stl",
    "sample.csv",
    "/dev/zero",
    "/dev/null",
    "/proc/self/mem",
];
const ODD: &[&str] = &[
    "(",
    ")",
    "[",
    "]",
    "{",
    "}",
    ",",
    ":",
    "\"",
    "//",
    "/*",
    "*/",
    "#",
    "Some(",
    "None",
    "r#\"",
    "'",
    "\u{feff}",
    "\u{200e}",
    "\0",
    "\u{e9}",
    "#![enable(implicit_some)]",
    "()",
    "[]",
    "{}",
    "((((((((((((((((((((",
    "[[[[[[[[[[[[[[[[[[[[[[[[[[",
    "true",
    "false",
    "\r\n",
    "\\",
    "-",
    "..",
    "=",
];

/// The scene of a number.
pub(super) fn case(bases: &[Base], number: u64) -> Case {
    let mut chance = Chance(number.wrapping_mul(0x2545_f491_4f6c_dd1d) ^ 0x5eed);
    let base = &bases[chance.below(bases.len())];
    let mut text = base.text.clone();
    let mut changes = [1, 1, 1, 1, 2, 2, 3][chance.below(7)];
    // Some scenes are hit hard.
    changes += if chance.is(5) { chance.below(20) } else { 0 };
    changes *= usize::from(!chance.is(8));
    for _ in 0..changes {
        mutate(&mut text, bases, &mut chance);
        if text.len() > 200_000 {
            break;
        }
    }
    let mut set = Vec::new();
    let count = if chance.is(40) { 1 + chance.below(3) } else { 0 };
    for _ in 0..count {
        set.push(assignment(&text, bases, &mut chance));
    }
    let axes = if chance.is(5) { vec![axis(&text, &mut chance)] } else { Vec::new() };
    Case { name: base.name.clone(), text, set, axes }
}

fn mutate(text: &mut String, bases: &[Base], chance: &mut Chance) {
    match chance.below(100) {
        0..45 => replace_value(text, chance),
        45..53 => remove_entry(text, chance),
        53..59 => repeat_entry(text, chance),
        59..75 => take_value(text, bases, chance),
        75..85 => take_entry(text, bases, chance),
        85..91 => swap_names(text, bases, chance),
        _ => spoil(text, chance),
    }
}

/// A number or text becomes another.
fn replace_value(text: &mut String, chance: &mut Chance) {
    let slots: Vec<Token> =
        tokens(text).into_iter().filter(|token| matches!(token.kind, Kind::Number | Kind::Text)).collect();
    if slots.is_empty() {
        return;
    }
    let Token { kind, span } = slots[chance.below(slots.len())].clone();
    let old = text[span.clone()].to_owned();
    let new = match kind {
        Kind::Number => number(&old, chance),
        _ => quantity(old.trim_matches('"'), chance),
    };
    text.replace_range(span, &new);
}

fn number(old: &str, chance: &mut Chance) -> String {
    match (old.parse::<f64>(), chance.below(10)) {
        (Ok(value), 0..2) => format!("{:e}", value * 10.0_f64.powi(chance.below(13) as i32 - 6)),
        (Ok(value), 6..8) => format!("{:e}", value * [0.5, 0.9, 1.1, 2.0, 3.0, 10.0][chance.below(6)]),
        (Ok(value), 2) => format!("{}", -value),
        (Ok(value), 3) => format!("{}", value + [1.0, -1.0, 0.5, 1e-9][chance.below(4)]),
        // A whole number stays one.
        (Ok(value), 4) if value.fract() == 0.0 && !old.contains(['.', 'e']) => {
            format!("{}", (value as i64).saturating_mul([2, 3, 10, 1000, -1][chance.below(5)]))
        }
        (_, 5) => format!("\"{} {}\"", chance.of(NUMBERS), chance.of(UNITS)),
        _ => chance.of(NUMBERS).to_owned(),
    }
}

fn quantity(old: &str, chance: &mut Chance) -> String {
    let is_quantity = old.split_once(' ').filter(|(value, _)| value.parse::<f64>().is_ok());
    match (is_quantity, chance.below(10)) {
        (Some((value, unit)), 0..7) => format!("\"{} {unit}\"", number(value, chance).trim_matches('"')),
        (Some((value, _)), 7) => format!("\"{value} {}\"", chance.of(UNITS)),
        (Some((value, _)), 8) => value.to_owned(),
        _ => format!("\"{}\"", chance.of(TEXTS)),
    }
}

fn some_entry(text: &str, chance: &mut Chance) -> Option<Entry> {
    let all: Vec<Entry> = entries(text).into_iter().filter(|entry| !entry.value.is_empty()).collect();
    (!all.is_empty()).then(|| all[chance.below(all.len())].clone())
}

fn remove_entry(text: &mut String, chance: &mut Chance) {
    if let Some(entry) = some_entry(text, chance) {
        let end = entry.whole.end + usize::from(text[entry.whole.end..].starts_with(','));
        text.replace_range(entry.whole.start..end, "");
    }
}

fn repeat_entry(text: &mut String, chance: &mut Chance) {
    if let Some(entry) = some_entry(text, chance) {
        let times = [1, 1, 1, 2, 5, 40, 300][chance.below(7)];
        let again = text[entry.whole.clone()].to_owned() + ", ";
        if again.len() * times < 60_000 {
            text.insert_str(entry.whole.start, &again.repeat(times));
        }
    }
}

/// A value becomes what another scene has under the same key.
fn take_value(text: &mut String, bases: &[Base], chance: &mut Chance) {
    let Some(entry) = some_entry(text, chance) else { return };
    for _ in 0..20 {
        let from = &bases[chance.below(bases.len())].text;
        let same: Vec<Entry> = entries(from).into_iter().filter(|other| other.key == entry.key).collect();
        if !same.is_empty() {
            let other = &same[chance.below(same.len())];
            text.replace_range(entry.value.clone(), &from[other.value.clone()]);
            return;
        }
    }
}

/// An entry of another scene comes beside one of this.
fn take_entry(text: &mut String, bases: &[Base], chance: &mut Chance) {
    let Some(entry) = some_entry(text, chance) else { return };
    let from = &bases[chance.below(bases.len())].text;
    let place = |path: &str| path.rsplit_once('.').map_or("", |(parent, _)| parent).to_owned();
    let (wanted, all) = (place(&entry.path), entries(from));
    // Most often from the same place, where it may make sense.
    let anywhere = chance.is(20);
    let fitting: Vec<&Entry> = all
        .iter()
        .filter(|other| other.key.is_some() == entry.key.is_some())
        .filter(|other| anywhere || place(&other.path) == wanted)
        .collect();
    if !fitting.is_empty() {
        let other = fitting[chance.below(fitting.len())];
        text.insert_str(entry.whole.start, &format!("{}, ", &from[other.whole.clone()]));
    }
}

/// A name becomes one that some scene uses.
fn swap_names(text: &mut String, bases: &[Base], chance: &mut Chance) {
    let of_kind = |text: &str, kind: Kind| -> Vec<Token> {
        tokens(text).into_iter().filter(|token| token.kind == kind).collect()
    };
    let kind = if chance.is(50) { Kind::Word } else { Kind::Text };
    let from = &bases[chance.below(bases.len())].text;
    let (here, there) = (of_kind(text, kind), of_kind(from, kind));
    if !here.is_empty() && !there.is_empty() {
        let (old, new) = (&here[chance.below(here.len())], &there[chance.below(there.len())]);
        text.replace_range(old.span.clone(), &from[new.span.clone()]);
    }
}

/// The text itself is damaged.
fn spoil(text: &mut String, chance: &mut Chance) {
    let all = tokens(text);
    if all.is_empty() {
        return;
    }
    let Token { span, .. } = all[chance.below(all.len())].clone();
    match chance.below(6) {
        0 => text.replace_range(span, ""),
        1 => text.insert_str(span.start, &chance.of(ODD).repeat([1, 1, 2, 200][chance.below(4)])),
        2 => text.replace_range(span, chance.of(ODD)),
        3 => text.truncate(span.end),
        4 => {
            let other = text[all[chance.below(all.len())].span.clone()].to_owned();
            text.replace_range(span, &other);
        }
        _ => text.insert_str(span.start, &text[span.clone()].repeat(2)),
    }
}

/// A path of the scene, or near one, and a value.
fn assignment(text: &str, bases: &[Base], chance: &mut Chance) -> String {
    let source = if chance.is(80) { text } else { &bases[chance.below(bases.len())].text };
    let mut path = some_entry(source, chance).map_or("version".to_owned(), |entry| entry.path);
    if chance.is(15) {
        let more = chance.of(&[
            ".0",
            ".x",
            ".moves",
            ".",
            "..",
            ".99999999999999999999",
            "=",
            ".\"a.b\"",
            "[0]",
            ".time_step",
        ]);
        path += more;
    }
    let value = match chance.below(6) {
        0 => chance.of(TEXTS).to_owned(),
        1 => format!("{} {}", chance.of(NUMBERS), chance.of(UNITS)),
        2 => chance.of(ODD).to_owned(),
        3 => some_entry(text, chance).map_or(String::new(), |entry| text[entry.value].to_owned()),
        _ => chance.of(NUMBERS).to_owned(),
    };
    if chance.is(3) { path } else { format!("{path}={value}") }
}

fn axis(text: &str, chance: &mut Chance) -> String {
    let path = some_entry(text, chance).map_or("version".to_owned(), |entry| entry.path);
    let mut numbers = || chance.of(NUMBERS).to_owned();
    let (a, b, c) = (numbers(), numbers(), numbers());
    let odd = chance.of(ODD);
    let list = match chance.below(5) {
        0 => format!("{a},{b},{c}"),
        1 => format!("{a}..{b}"),
        2 => format!("{a}..{b}:{c}"),
        3 => format!("{a}..{b}:log{c} mm"),
        _ => format!("{a}{odd},{b}..{c}"),
    };
    format!("{path}={list}")
}
