//! What is wrong with a scene, collected by its paths.

use crate::scene_file::SceneProblem;
use granular_core::units::{Measured, Unit};
use granular_core::{Dim, Vector};

/// Collects problems by scene path.
#[derive(Debug, Default)]
pub struct Problems(pub(crate) Vec<SceneProblem>);

impl Problems {
    /// Adds what stands at a place of the scene, what may, and how to put it right.
    pub fn add(
        &mut self,
        path: impl Into<String>,
        value: impl std::fmt::Display,
        allowed: impl Into<String>,
        hint: impl Into<String>,
    ) {
        self.0.push(SceneProblem::at_path(path, value, allowed, hint));
    }

    /// A vector of the right number of components.
    pub fn vector<D: Dim, U: Unit>(&mut self, path: &str, values: &[Measured<U>]) -> Option<D::Vec> {
        let numbers: Vec<f64> = values.iter().map(|value| value.value()).collect();
        let vector = D::Vec::from_slice(&numbers);
        if vector.is_none() {
            let allowed = format!("{} values, one per axis", D::N);
            self.add(path, format!("a list of {}", values.len()), allowed, "");
        }
        vector
    }
}

/// "did you mean" for the nearest of some names; empty when none is near.
pub fn nearest<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    let near = known
        .into_iter()
        .map(|other| (strsim::damerau_levenshtein(name, other), other))
        .filter(|&(distance, other)| distance <= 1 + other.len() / 3)
        .min();
    near.map_or(String::new(), |(_, other)| format!("did you mean `{other}`?"))
}

/// A key as a scene path writes it: one with a dot needs quotes.
pub(crate) fn quoted(key: &str) -> String {
    if key.contains(['.', '=', '[']) { format!("\"{key}\"") } else { key.to_owned() }
}
