//! Laws between solvers of a scene.

use crate::problems::{Problems, nearest};
use crate::scene::Scene;

/// Names of the solvers of a scene in the order in which they are built: those with short steps first, for the others may ask
/// what they hold.
pub(crate) fn order(scene: &Scene) -> Vec<&str> {
    let mut names: Vec<&str> = scene.solvers.keys().map(String::as_str).collect();
    names.sort_by_key(|name| scene.couplings.iter().any(|law| law.ends().slow.1 == *name));
    names
}

/// Whether laws name solvers that there are, of methods that they are for.
pub(crate) fn check(scene: &Scene, problems: &mut Problems) {
    for (k, law) in scene.couplings.iter().enumerate() {
        let ends = law.ends();
        let wanted = [(ends.slow, "Lbm"), (ends.fast, "Dem")];
        for ((key, name), method) in wanted {
            let solver = scene.solvers.get(name);
            if solver.is_some_and(|solver| solver.name() == method) {
                continue;
            }
            let fitting = scene.solvers.iter().filter(|(_, solver)| solver.name() == method);
            let fitting: Vec<&str> = fitting.map(|(name, _)| name.as_str()).collect();
            let value = match solver {
                Some(solver) => format!("`{name}`, which is {}", solver.name()),
                None => format!("`{name}`, which is no solver of this scene"),
            };
            let allowed = match fitting.as_slice() {
                [] => format!("the name of a solver that is {method}; add one to `solvers`"),
                _ => format!("a solver that is {method}: {}", fitting.join(", ")),
            };
            problems.add(format!("couplings.{k}.{key}"), value, allowed, nearest(name, fitting));
        }
    }
}
