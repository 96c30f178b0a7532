//! Contacts between two materials that a scene states.

use super::materials::NamedMaterials;
use crate::problems::Problems;
use granular_dem::spec::{ContactSpec, PairSpec};

/// Gives the materials what the scene states of their pairs.
pub(super) fn state(
    pairs: &[PairSpec],
    contact: ContactSpec,
    named: &mut NamedMaterials,
    problems: &mut Problems,
) {
    let mut known: Vec<[&str; 2]> = Vec::new();
    for (k, spec) in pairs.iter().enumerate() {
        let path = format!("pairs.{k}");
        let [one, other] = spec.between.as_slice() else {
            let allowed = "names of two materials, such as [\"glass\", \"steel\"]";
            problems.add(format!("{path}.between"), format!("{} names", spec.between.len()), allowed, "");
            continue;
        };
        let mut find =
            |side: usize| named.find(&format!("{path}.between.{side}"), &spec.between[side], problems);
        let ids = [find(0), find(1)];
        let mut names = [one.as_str(), other.as_str()];
        names.sort_unstable();
        if let Some(first) = known.iter().position(|pair| *pair == names) {
            let value = format!("`{one}` and `{other}`, which pairs.{first} has already");
            let hint = "give all that matters of two materials in one place; their order does not matter";
            problems.add(format!("{path}.between"), value, "each pair once", hint);
        }
        known.push(names);
        says_something(&path, spec, contact, problems);
        if let [Some(a), Some(b)] = ids
            && let Err(error) = named.list.set_pair(a, b, spec.stated())
        {
            let key = error.what.replace(' ', "_");
            problems.add(format!("{path}.{key}"), error.value, error.allowed, "");
        }
    }
}

/// Refuses a pair that changes nothing.
fn says_something(path: &str, spec: &PairSpec, contact: ContactSpec, problems: &mut Problems) {
    let nothing = PairSpec { between: spec.between.clone(), ..PairSpec::default() };
    if *spec == nothing {
        let allowed = "at least one value beside `between`, such as friction";
        problems.add(path, "a pair without values", allowed, "leave it out: the materials are mixed then");
    }
    let instead = [
        ("restitution", spec.restitution, "normal_damping", spec.normal_damping),
        ("damping_ratio", spec.damping_ratio, "tangential_damping", spec.tangential_damping),
    ];
    for (ratio, given, damping, constant) in instead {
        if let (Some(given), Some(_)) = (given, constant) {
            let allowed = format!("nothing, since {damping} is given");
            problems.add(format!("{path}.{ratio}"), given, allowed, "give one of the two");
        }
    }
    if contact == ContactSpec::Hertz {
        dashpots_are_of_linear_contacts(path, spec, problems);
        let hint =
            "the stiffness of Hertz contacts follows from young_modulus and poisson_ratio of the materials";
        let allowed = "nothing, since contacts are Hertz";
        if let Some(given) = spec.normal_stiffness {
            problems.add(format!("{path}.normal_stiffness"), given, allowed, hint);
        }
        if let Some(given) = spec.stiffness_ratio {
            problems.add(format!("{path}.stiffness_ratio"), given, allowed, hint);
        }
    }
}

fn dashpots_are_of_linear_contacts(path: &str, spec: &PairSpec, problems: &mut Problems) {
    let dashpots = [("normal_damping", spec.normal_damping), ("tangential_damping", spec.tangential_damping)];
    for (key, given) in dashpots {
        if let Some(given) = given {
            let hint = "state `restitution` or `damping_ratio` instead";
            problems.add(format!("{path}.{key}"), given, "nothing, since contacts are Hertz", hint);
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::check;
    use crate::scene_file::SceneText;
    use granular_dem::Dem2;
    use std::any::Any;

    const SCENE: &str = r#"Scene(version: 1, dimension: Plane, gravity: [0.0, -9.81],
        materials: {
            "glass": (normal_stiffness: "1e5 N/m", restitution: 0.75, friction: 0.5),
            "steel": (normal_stiffness: "3e5 N/m", restitution: 0.9, friction: 0.3),
        },
        pairs: [
            (between: ["steel", "glass"], friction: 0.1, rolling_friction: 0.02),
            (between: ["glass", "glass"], restitution: 0.4, normal_stiffness: "4e5 N/m"),
        ],
        sample: Grains([(position: [0.0, "1 mm"], radius: "1 mm", material: "glass")]),
        walls: [Floor(material: "steel")],
        stages: [(name: "fall", end: For("1 ms"), changes: [Friction(material: "glass", value: 0.0)])],
        solvers: { "grains": Dem(()) })"#;

    #[test]
    fn what_a_scene_states_of_a_pair_holds_and_the_rest_is_mixed() {
        let (_, model) = check::read(&SceneText::new("scene.ron", SCENE)).unwrap();
        let solver: &dyn Any = model.simulation.solver();
        let materials = solver.downcast_ref::<Dem2>().unwrap().materials();
        let pair = materials.pair(0, 1);
        let found = (pair.friction, pair.rolling_friction, pair.restitution, pair.normal_stiffness);
        assert_eq!(found, (0.1, 0.02, 0.75, 1.5e5));
        let pair = materials.pair(0, 0);
        let found = (pair.restitution, pair.normal_stiffness, pair.tangential_stiffness, pair.friction);
        assert_eq!(found, (0.4, 4e5, 4e5, 0.5));
        assert_eq!(materials.pair(1, 1).friction, 0.3);
    }

    #[test]
    fn dashpots_may_be_constants() {
        let given = r#"friction: 0.1, normal_damping: "2 N s/m", tangential_damping: 0.5,"#;
        let text = SceneText::new("scene.ron", SCENE.replace("friction: 0.1,", given));
        let (_, model) = check::read(&text).unwrap();
        let solver: &dyn Any = model.simulation.solver();
        let pair = solver.downcast_ref::<Dem2>().unwrap().materials().pair(0, 1);
        assert_eq!((pair.normal_damping, pair.tangential_damping), (Some(2.0), Some(0.5)));
    }

    /// The scene with a part replaced; what is said of it.
    fn said(from: &str, to: &str) -> String {
        assert!(SCENE.contains(from));
        let text = SceneText::new("scene.ron", SCENE.replace(from, to));
        check::read(&text).map(|_| ()).unwrap_err().to_string()
    }

    #[test]
    fn wrong_pairs_are_told_with_their_place() {
        let cases = [
            (
                r#"["steel", "glass"]"#,
                r#"["steal", "glass"]"#,
                ["`pairs.0.between.0` is `steal`", "glass, steel", "`steel`?"],
            ),
            (
                r#"["steel", "glass"]"#,
                r#"["steel"]"#,
                ["`pairs.0.between` is 1 names", "names of two materials", ""],
            ),
            (
                r#"["steel", "glass"]"#,
                r#"["glass", "glass"]"#,
                ["`pairs.1.between`", "which pairs.0 has already", "each pair once"],
            ),
            (
                r#", restitution: 0.4, normal_stiffness: "4e5 N/m""#,
                "",
                ["`pairs.1` is a pair without values", "such as friction", ""],
            ),
            (
                "restitution: 0.4",
                "restitution: 1.4",
                ["`pairs.1.restitution` is 1.4", "above 0 and at most 1", ""],
            ),
            ("friction: 0.1,", "friction: -0.1,", ["`pairs.0.friction` is -0.1", "zero or more", ""]),
            (
                "Dem(())",
                "Dem((contact: Hertz))",
                ["`pairs.1.normal_stiffness`", "since contacts are Hertz", "young_modulus"],
            ),
            (
                "restitution: 0.4",
                r#"restitution: 0.4, normal_damping: "2 N s/m""#,
                ["`pairs.1.restitution` is 0.4", "nothing, since normal_damping is given", "one of the two"],
            ),
            (
                "friction: 0.1,",
                r#"normal_damping: "2 N/m","#,
                ["`2 N/m` is a stiffness", "a damping coefficient such as `0.2 N s/m`", ""],
            ),
            (
                "friction: 0.1,",
                "tangential_damping: -1.0,",
                ["`pairs.0.tangential_damping` is -1", "zero or more", ""],
            ),
            ("friction: 0.1,", "fricton: 0.1,", ["unknown key `fricton`", "did you mean `friction`?", ""]),
        ];
        for (from, to, parts) in cases {
            let said = said(from, to);
            for part in parts {
                assert!(said.contains(part), "`{part}` is not in:\n{said}");
            }
        }
    }
}
