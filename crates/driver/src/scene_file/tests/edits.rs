use super::*;

fn set(assignments: &[&str]) -> SceneText {
    let mut scene = sample();
    for assignment in assignments {
        scene.set(assignment).unwrap_or_else(|problem| panic!("{problem}"));
    }
    scene
}

#[test]
fn paths_lead_through_structs_maps_lists_and_variants() {
    let scene = sample();
    let cases = [
        ("version", "1"),
        ("gravity.1", "-9.81"),
        ("materials.glass.friction", "0.53"),
        ("materials.\"glass\".friction", "0.53"),
        ("sample.width", "\"68 mm\""),
        ("sample.Column.width", "\"68 mm\""),
        ("sample.grading.max", "\"1.38 mm\""),
        ("sample.packing.Ballistic", "Ballistic"),
        ("walls.2.opens", "\"collapse\""),
        ("walls[2].opens", "\"collapse\""),
        ("stages[1][1]", "For(\"0.45 s\")"),
        ("stages.1.1", "For(\"0.45 s\")"),
        ("stages.1.1.0", "\"0.45 s\""),
        ("stages.1.1.For.0", "\"0.45 s\""),
        ("stages.0.1.kinetic_over_potential", "1e-6"),
        ("solvers.grains", "Dem((contact: Linear))"),
        ("solvers.grains.contact", "Linear"),
        ("solvers.grains.Dem.contact", "Linear"),
        ("solvers.grains.0.contact", "Linear"),
        ("outputs.0.every", "Time(\"0.01 s\")"),
        ("outputs.0.write.probes.1", "\"height\""),
    ];
    for (path, text) in cases {
        assert_eq!(written(&scene, path), Some(text), "{path}");
    }
    for path in [
        "",
        ".",
        "a",
        "sample.",
        "walls.3",
        "gravity.x",
        "version.1",
        "stages.1.1.1",
        "a=b",
        "\"",
        "sample.width.x",
    ] {
        assert_eq!(written(&scene, path), None, "{path}");
    }
}

#[test]
fn comments_strings_and_attributes_do_not_mislead() {
    let text = "#![enable(implicit_some)] /* ( /* nested [ */ */ S(a: \"x, b: 2)\", // b: 3\n r#b: r#\"\"{\"#, c: ['(', '\\'', ')'], d: b\"]\")";
    let scene = SceneText::new("scene.ron", text);
    assert_eq!(written(&scene, "b"), Some("r#\"\"{\"#"));
    assert_eq!(written(&scene, "c.1"), Some("'\\''"));
    assert_eq!(written(&scene, "d"), Some("b\"]\""));
}

#[test]
fn assignments_change_what_is_read() {
    let scene = set(&[
        "sample.width=12 cm",
        "materials.glass.friction = 0.3",
        "gravity.0=-1",
        "sample.packing=Lattice",
        "sample.material=steel",
        "stages.1.1=For(2)",
        "solvers.grains.contact=Hertz",
        "walls=[]",
        "materials.steel=(density: \"7800 kg/m^3\", friction: 0.1)",
        "solvers.grains.step=1e-6",
        "outputs.0.every.0=5 ms",
        "outputs.0.write.path=a \"b\" \\c",
    ]);
    let read = scene.parse::<Scene>().unwrap_or_else(|problem| panic!("{problem}"));
    let Sample::Column { width, packing, material, .. } = read.sample else { panic!("a column") };
    assert_eq!((width, packing, material.as_str()), (Length::from(0.12), Packing::Lattice, "steel"));
    assert_eq!(read.materials["glass"].friction, 0.3);
    assert_eq!(read.materials["steel"].density.value(), 7800.0);
    assert_eq!(read.gravity, [-1.0, -9.81]);
    assert_eq!(read.stages[1].1, Ending::For(Time::from(2.0)));
    assert_eq!(read.walls, []);
    assert_eq!(
        read.solvers["grains"],
        SolverSpec::Dem(DemSpec { contact: Contact::Hertz, step: Some(1e-6.into()) })
    );
    assert_eq!(read.outputs[0].every, Every::Time(Time::from(5e-3)));
    let Write::Table { path, .. } = &read.outputs[0].write;
    assert_eq!(path, "a \"b\" \\c");
}

#[test]
fn a_value_with_a_comment_cannot_hide_the_rest() {
    let scene = set(&["version=2 // next"]);
    assert_eq!(written(&scene, "version"), Some("\"2 // next\""));
    assert!(written(&scene, "dimension").is_some());
}

#[test]
fn keys_are_added_after_comments_and_commas_too() {
    for (text, path) in [
        ("(a: 1)", "b"),
        ("(a: 1,)", "b"),
        ("(a: 1 // one\n)", "b"),
        ("(a: 1, // one\n)", "b"),
        ("()", "b"),
        ("S()", "b"),
        ("S( /* none */ )", "b"),
        ("{}", "b"),
        ("{\"x.y\": (a: 1)}", "\"x.y\".b"),
        ("Some((a: 1))", "b"),
        ("[(a: ())]", "0.a.b"),
    ] {
        let mut scene = SceneText::new("scene.ron", text);
        scene.set(&format!("{path}=7")).unwrap();
        assert_eq!(written(&scene, path), Some("7"), "{}", scene.text());
        assert!(scene.parse::<ron::Value>().is_ok(), "{}", scene.text());
    }
}

#[test]
fn an_assignment_that_cannot_be_made_says_why() {
    let cases = [
        ("sample.width", "an assignment is a path, `=` and a value", "for example"),
        ("=3", "an assignment is a path, `=` and a value", "for example"),
        ("sample.width=", "an assignment is a path, `=` and a value", "for example"),
        ("materials.glas.friction=1", "`materials` has no `glas`", "did you mean `glass`?"),
        ("smaple.width=1", "the scene has no `smaple`", "did you mean `sample`?"),
        (
            "walls.7.material=1",
            "`walls` has 3 values without keys, and no `7`",
            "its values are called 0 to 2",
        ),
        ("walls.7=1", "`walls` has 3 values without keys, and no `7`", "its values are called 0 to 2"),
        (
            "sample.packing.depth=1",
            "`sample.packing` is `Ballistic`, which has no keys",
            "write it with keys first: `Ballistic(...)`",
        ),
        ("sample.width.x=1", "`sample.width` is `\"68 mm\"`, which has no keys", ""),
    ];
    for (assignment, message, hint) in cases {
        let mut scene = sample();
        let problem = scene.set(assignment).unwrap_err();
        assert_eq!(problem.message, message);
        assert!(problem.hint.as_deref().unwrap_or_default().starts_with(hint), "{problem}");
        assert!(problem.to_string().contains(&format!("--> --set {assignment}")), "{problem}");
        assert_eq!(scene, sample());
    }
}

#[test]
fn a_problem_in_an_assigned_value_names_the_assignment() {
    let scene =
        set(&["gravity=[0, 0]", "materials.glass.frictoin=0.4", "version=12345", "sample.width=1 mm"]);
    let problem = scene.parse::<Scene>().unwrap_err();
    assert_eq!(problem.notes, ["written by `--set materials.glass.frictoin=0.4`"], "{problem}");
    assert_eq!(problem.hint.as_deref(), Some("did you mean `friction`?"));
    let wrong = set(&["version=1", "sample.width=3 kg", "sample.seed=5", "gravity.0=1"])
        .parse::<Scene>()
        .unwrap_err();
    assert_eq!(wrong.notes, ["written by `--set sample.width=3 kg`"], "{wrong}");
}
