//! Scenes of several methods that nothing joins: the same problem solved in several ways, each as a run of its own.

use crate::failure::Failure;
use crate::methods::{self, couplings};
use crate::problems::Problems;
use crate::scene::{Change, Scene};
use crate::scene_file::SceneText;

/// A scene of solvers that share a simulation.
#[derive(Clone, Debug)]
pub struct Part {
    /// Names of its solvers, joined by `+`.
    pub name: String,
    /// The scene with these solvers alone.
    pub text: SceneText,
}

/// The scenes that a scene stands for; itself alone, without a name, when all its solvers are joined.
///
/// A part keeps the outputs that are `of` its solvers or of none by name, the figures of these, and what its methods use of the
/// scene.
///
/// # Errors
/// When the scene cannot be read.
pub fn of(text: &SceneText) -> Result<Vec<Part>, Failure> {
    let scene = Scene::of(text)?;
    let groups = groups(&scene);
    if groups.len() < 2 {
        return Ok(vec![Part { name: String::new(), text: text.clone() }]);
    }
    let part = |group: &Vec<&str>| Part { name: group.join("+"), text: alone(text, &scene, group) };
    Ok(groups.iter().map(part).collect())
}

/// Solvers that laws join, by their names.
pub(crate) fn groups(scene: &Scene) -> Vec<Vec<&str>> {
    let mut groups: Vec<Vec<&str>> = scene.solvers.keys().map(|name| vec![name.as_str()]).collect();
    let mut problems = Problems::default();
    couplings::check(scene, &mut problems);
    if !problems.0.is_empty() {
        // What is meant is not known: the whole is built, and refused.
        return vec![groups.concat()];
    }
    for law in &scene.couplings {
        let ends = law.ends();
        let place = |name: &str, groups: &[Vec<&str>]| groups.iter().position(|group| group.contains(&name));
        let (Some(a), Some(b)) = (place(ends.slow.1, &groups), place(ends.fast.1, &groups)) else { continue };
        if a != b {
            let moved = groups.remove(a.max(b));
            groups[a.min(b)].extend(moved);
        }
    }
    groups.iter_mut().for_each(|group| group.sort_unstable());
    groups
}

/// The text with these solvers alone.
fn alone(text: &SceneText, scene: &Scene, group: &[&str]) -> SceneText {
    let mut out: Vec<String> = Vec::new();
    let stays = |name: &str| group.contains(&name);
    let outputs = scene.outputs.iter().enumerate();
    let elsewhere = outputs.filter(|(_, output)| output.of.as_deref().is_some_and(|of| !stays(of)));
    let elsewhere: Vec<(usize, &str)> = elsewhere.map(|(k, output)| (k, output.write.path())).collect();
    out.extend(elsewhere.iter().map(|(k, _)| format!("outputs.{k}")));
    for (k, figure) in scene.figures.iter().enumerate() {
        let mut drawn = std::iter::once(figure.needs("front")).chain(figure.also_needs());
        if drawn.any(|need| elsewhere.iter().any(|(_, path)| *path == need.output)) {
            out.push(format!("figures.{k}"));
        }
    }
    for (k, stage) in scene.stages.iter().enumerate() {
        let elsewhere = |change: &Change| matches!(change, Change::Push { of: Some(of), .. } if !stays(of));
        let changes = stage.changes.iter().enumerate().filter(|(_, change)| elsewhere(change));
        out.extend(changes.map(|(c, _)| format!("stages.{k}.changes.{c}")));
    }
    let laws = scene.couplings.iter().enumerate().filter(|(_, law)| !stays(law.ends().slow.1));
    out.extend(laws.map(|(k, _)| format!("couplings.{k}")));
    out.extend(scene.solvers.keys().filter(|name| !stays(name)).map(|name| format!("solvers.\"{name}\"")));
    let uses = |wanted: bool, part| {
        let mut solvers = scene.solvers.iter().filter(|(name, _)| stays(name) == wanted);
        solvers.any(|(_, solver)| solver.parts().contains(&part))
    };
    let unused = methods::unused::given(scene)
        .into_iter()
        .filter(|given| !uses(true, given.part) && uses(false, given.part));
    out.extend(unused.map(|given| given.path));
    // Items of a list move up when one before them goes.
    let number = |part: &str| (part.parse::<usize>().unwrap_or(0), part.to_owned());
    out.sort_by_key(|path| path.split('.').map(number).collect::<Vec<_>>());
    out.dedup();
    let mut alone = text.clone();
    out.iter().rev().for_each(|path| alone.remove(path));
    alone
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCENE: &str = r#"Scene(
    version: 1,
    dimension: Plane,
    stages: [(name: "run", end: For("1 s"))],
    // Two plates.
    solvers: {
        "cold": Heat((size: "0.1 m", cells: 16, diffusivity: 1e-4)),
        "warm": Heat((size: "0.1 m", cells: 16, diffusivity: 2e-4)), // the other
    },
    outputs: [
        (every: Time("0.1 s"), write: Table(path: "series.csv", probes: ["largest_temperature"])),
        (every: Time("0.1 s"), of: "cold", write: Table(path: "cold.csv", probes: ["largest_temperature"])),
        (every: Time("0.1 s"), of: "warm", write: Table(path: "warm.csv", probes: ["largest_temperature"]))
    ],
    figures: [
        Series(path: "cold", table: "cold.csv", columns: ["largest_temperature"]),
        Series(path: "all", table: "series.csv", columns: ["largest_temperature"]),
    ],
)"#;

    #[test]
    fn each_part_keeps_its_solver_its_outputs_and_their_figures() {
        let parts = of(&SceneText::new("scene.ron", SCENE)).unwrap();
        let names: Vec<&str> = parts.iter().map(|part| part.name.as_str()).collect();
        assert_eq!(names, ["cold", "warm"]);
        for (part, figures) in parts.iter().zip([2, 1]) {
            let scene: Scene = part.text.parse().unwrap();
            assert_eq!(scene.solvers.keys().collect::<Vec<_>>(), [&part.name]);
            let paths: Vec<&str> = scene.outputs.iter().map(|output| output.write.path()).collect();
            assert_eq!(paths, ["series.csv", &format!("{}.csv", part.name)]);
            assert_eq!(scene.figures.len(), figures);
        }
    }

    #[test]
    fn a_scene_whose_solvers_are_joined_is_one() {
        let text = include_str!("../../../examples/ch5_carried_grains/scene.ron");
        let parts = of(&SceneText::new("scene.ron", text)).unwrap();
        assert_eq!((parts.len(), parts[0].name.as_str()), (1, ""));
        // Apart, each keeps what its method uses.
        let mut apart = SceneText::new("scene.ron", text);
        apart.set("couplings=[]").unwrap();
        let parts = of(&apart).unwrap();
        let scenes: Vec<Scene> = parts.iter().map(|part| part.text.parse().unwrap()).collect();
        assert!(scenes[0].fluid.is_none() && scenes[0].walls.len() == 3 && scenes[0].sample.is_some());
        assert!(scenes[1].fluid.is_some() && scenes[1].walls.is_empty() && scenes[1].sample.is_none());
        assert!(
            scenes[1].materials.is_empty() && scenes[1].outputs.len() == 2 && scenes[1].figures.len() == 2
        );
    }
}
