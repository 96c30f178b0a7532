//! Methods, and what each is measured by.
//!
//! A method is one folder here and one line in [`METHODS`]; an analysis that belongs to no method, such as samples or Voronoi cells, is
//! listed in the same way. Outside its folder no file names its crate: all verbs, their flags and help, the report and the tests follow from
//! the table.

#[cfg(feature = "dem")]
mod dem;
#[cfg(feature = "lbm")]
mod lbm;
#[cfg(feature = "mpm")]
mod mpm;
mod packing;
mod tessellate;

use crate::bench::{Comparison, Precision, Throughput};
use crate::validate::Case;
use crate::validate::stability::Stability;

/// All methods of this program.
pub const METHODS: &[Method] = &[
    #[cfg(feature = "dem")]
    dem::METHOD,
    #[cfg(feature = "lbm")]
    lbm::METHOD,
    #[cfg(feature = "mpm")]
    mpm::METHOD,
    packing::METHOD,
    tessellate::METHOD,
];

/// A method and what it is measured by.
#[derive(Clone, Copy, Debug)]
pub struct Method {
    /// Name in commands and in rows.
    pub name: &'static str,
    /// What it is, in a few words.
    pub about: &'static str,
    /// Validation cases.
    pub cases: &'static [Case],
    /// Where it fails, beside where it says that it will.
    pub stability: Option<Stability>,
    /// Studies of error against run time.
    pub precision: &'static [Precision],
    /// Variants side by side.
    pub comparisons: &'static [Comparison],
    /// How fast it is.
    pub speed: Option<Throughput>,
}

impl Method {
    /// A method that nothing measures yet.
    const fn named(name: &'static str, about: &'static str) -> Self {
        Self { name, about, cases: &[], stability: None, precision: &[], comparisons: &[], speed: None }
    }
}

#[cfg(test)]
mod tests {
    use super::METHODS;
    use std::collections::BTreeSet;

    /// Each name once.
    fn differ<'a>(names: impl Iterator<Item = &'a str>) {
        let mut known = BTreeSet::new();
        names.for_each(|name| assert!(known.insert(name), "two are called `{name}`"));
        assert!(!known.is_empty());
    }

    #[test]
    fn no_two_of_a_kind_have_the_same_name() {
        differ(METHODS.iter().map(|method| method.name));
        differ(METHODS.iter().flat_map(|method| method.cases).map(|case| case.name));
        let comparisons = METHODS.iter().flat_map(|method| method.comparisons).map(|one| one.name);
        // They are verbs beside these.
        differ(comparisons.chain(["precision", "speed"]));
        let sizes = METHODS.iter().filter_map(|method| method.speed).flat_map(|speed| speed.sizes);
        differ(sizes.map(|sizes| sizes.flag).chain(["pools", "repeats", "state", "write-state"]));
        let choices = METHODS.iter().filter_map(|method| method.stability).flat_map(|study| study.choices);
        differ(choices.map(|choice| choice.flag).chain(["full"]));
    }

    #[test]
    fn studies_of_precision_have_names_of_their_own() {
        let names: Vec<&str> =
            METHODS.iter().flat_map(|method| method.precision).map(|one| one.name).collect();
        assert_eq!(names.iter().collect::<BTreeSet<_>>().len(), names.len(), "{names:?}");
    }
}
