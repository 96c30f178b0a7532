//! Words for messages.

/// The candidate that was perhaps meant.
pub(super) fn nearest<'a, S: AsRef<str>>(written: &str, candidates: &'a [S]) -> Option<&'a str> {
    let lower = written.to_lowercase();
    let most = (written.chars().count() / 3).max(1);
    candidates
        .iter()
        .map(AsRef::as_ref)
        .map(|name| (strsim::damerau_levenshtein(&lower, &name.to_lowercase()), name))
        .filter(|(distance, name)| *distance <= most && *distance < name.chars().count())
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, name)| name)
}

/// Names with commas; a long list is cut.
pub(super) fn listed<S: AsRef<str>>(names: &[S]) -> String {
    const MOST: usize = 16;
    let shown: Vec<&str> = names.iter().take(MOST).map(AsRef::as_ref).collect();
    match names.len().saturating_sub(MOST) {
        0 => shown.join(", "),
        more => format!("{} and {more} more", shown.join(", ")),
    }
}

/// The name of a type in words with an article, such as `a contact law` for `ContactLawSpec`.
pub(super) fn with_article(type_name: &str) -> String {
    let mut words = String::new();
    let name = type_name.strip_suffix("Spec").filter(|name| !name.is_empty()).unwrap_or(type_name);
    for (at, c) in name.chars().enumerate() {
        if c.is_uppercase() && at > 0 && !words.ends_with(|before: char| before.is_numeric()) {
            words.push(' ');
        }
        words.extend(c.to_lowercase());
    }
    let vowel = words.starts_with(['a', 'e', 'i', 'o', 'u']);
    format!("{} {words}", if vowel { "an" } else { "a" })
}

/// At most 60 characters, on one line.
pub(super) fn shortened(text: &str) -> String {
    const MOST: usize = 60;
    let line = text.lines().next().unwrap_or_default();
    if line.chars().count() <= MOST && line.len() == text.len() {
        return line.to_owned();
    }
    line.chars().take(MOST).chain(['…']).collect()
}

/// Text for a terminal: control characters become visible, tabs become blanks.
pub(super) fn visible(text: &str) -> String {
    text.chars()
        .map(|c| match c {
            '\t' => ' ',
            '\n' => c,
            c if c.is_control() => '\u{FFFD}',
            c => c,
        })
        .collect()
}
