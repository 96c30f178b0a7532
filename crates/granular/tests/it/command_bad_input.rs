//! Bad input: the exit code, a message that names the place and what is allowed, and no trace on
//! the disk.

use crate::support::{SMALL, Scratch, files};
use std::fs;

/// What is replaced by what in the small scene, the exit code, and parts of the message. The
/// message must also name the line of what was replaced, unless a part says another place.
type Case<'a> = (&'a str, &'a str, i32, &'a [&'a str]);

const SCENE_CASES: &[Case<'_>] = &[
    // Keys.
    (
        "friction: 0.5",
        "frictoin: 0.5",
        2,
        &["unknown key `frictoin`", "allowed: density, normal_stiffness", "did you mean `friction`?"],
    ),
    (
        "restitution: 0.75, friction: 0.5",
        "restitution: 0.75, friction: 0.5, friction: 0.6",
        2,
        &["key `friction` is written twice", "the first is at small.ron:"],
    ),
    (
        "\"wall\": (normal",
        "\"glass\": (normal",
        2,
        &["key `glass` is written twice", "leave out one of them"],
    ),
    ("Floor(material: \"wall\")", "Floor()", 2, &["missing key `material`", "add `material: ...`"]),
    // Values.
    (
        "\"2650 kg/m^3\"",
        "\"2650 kg\"",
        2,
        &["`2650 kg` is a mass, but a density such as `2650 kg/m^3` is expected"],
    ),
    ("min: \"0.92 mm\"", "min: \"-0.92 mm\"", 2, &["`sample.grading.min` is -0.00092 m", "above 0"]),
    ("aspect_ratio: 0.8", "aspect_ratio: NaN", 2, &["`NaN` is not a finite number"]),
    ("\"0.1 s\"", "\"nan s\"", 2, &["`nan s` is not finite", "a time such as"]),
    ("friction: 0.5)", "friction: -0.5)", 2, &["`materials.glass.friction` is -0.5", "zero or more"]),
    // What makes a contact stiff.
    (
        "normal_stiffness: \"1e5 N/m\", ",
        "",
        2,
        &["`materials.glass.normal_stiffness` is missing", "young_modulus and poisson_ratio", "small.ron:"],
    ),
    (
        "normal_stiffness: \"1e5 N/m\"",
        "young_modulus: \"1 GPa\", typical_load: \"10 N/m\"",
        2,
        &["`materials.glass.poisson_ratio` is missing", "beside young_modulus"],
    ),
    (
        "normal_stiffness: \"1e5 N/m\"",
        "young_modulus: \"1 GPa\", poisson_ratio: 0.7",
        2,
        &["`materials.glass.typical_load` is missing", "a load per metre of depth"],
    ),
    (
        "normal_stiffness: \"1e5 N/m\"",
        "young_modulus: \"1 GPa\", poisson_ratio: 0.7, typical_load: \"10 N/m\"",
        2,
        &["`materials.glass.poisson_ratio` is 0.7", "above -1 and at most 0.5"],
    ),
    (
        "normal_stiffness: \"1e5 N/m\"",
        "normal_stiffness: \"1e5 N/m\", typical_load: \"10 N/m\"",
        2,
        &["`materials.glass.typical_load` is 10 N/m", "nothing, since normal_stiffness is given"],
    ),
    ("gravity: [0.0, -9.81]", "gravity: [0.0]", 2, &["`gravity` is a list of 1", "2 values, one per axis"]),
    ("Grains(120)", "Grains(0)", 2, &["`sample.extent` is a column of 0 grains", "at least one grain"]),
    (
        "Grains(120)",
        "Width(\"1 km\")",
        2,
        &["`sample.extent` is a column of 636239373623 grains", "at most 1e8 grains"],
    ),
    (
        "Grains(120)",
        "Width(\"1 um\")",
        2,
        &["`sample.extent` is too narrow a column: its width is 0.000001 m", "at least 0.0012"],
    ),
    ("\"0.05 s\"", "\"0 s\"", 2, &["`stages.0.end.within` is 0 s", "a positive time"]),
    ("1e-4", "0", 2, &["`stages.0.end.kinetic_over_potential` is 0", "above 0"]),
    // Names.
    (
        "Floor(material: \"wall\")",
        "Floor(material: \"wal\")",
        2,
        &["`walls.0.material` is `wal`", "a material of this scene: glass, wall", "did you mean `wall`?"],
    ),
    (
        "opens: \"collapse\"",
        "opens: \"colapse\"",
        2,
        &["`walls.2.opens` is `colapse`", "settle, collapse", "did you mean `collapse`?"],
    ),
    (
        "\"front\", \"height\"",
        "\"frnt\", \"height\"",
        2,
        &["`outputs.0.write.probes.0` is `frnt`, which nothing shows", "did you mean `front`?"],
    ),
    ("\"front\", \"height\"", "\"front\", \"height\", \"height\"", 2, &["`height` again", "each name once"]),
    (
        "\"front\", \"height\"",
        "\"front\"",
        2,
        &[
            "--> small.ron:37:",
            "`series.csv`, which does not hold \"height\"",
            "add \"height\" to the output `series.csv`",
        ],
    ),
    (
        "color: \"speed\"",
        "color: \"spin\"",
        2,
        &["which does not hold \"spin\"", "a Fields with radius, spin"],
    ),
    (
        "table: \"series.csv\"",
        "table: \"grains\"",
        2,
        &["`grains`, which no Table writes", "the path of a Table: series.csv"],
    ),
    (
        "contacts: \"contacts\", stage: \"collapse\"",
        "contacts: \"contacts\", stage: \"fall\"",
        2,
        &["`figures.3.stage` is `fall`, which is not a stage of this scene"],
    ),
    // Files.
    ("path: \"series.csv\"", "path: \"../series.csv\"", 2, &["`../series.csv`", "inside the run folder"]),
    ("path: \"series.csv\"", "path: \"/series.csv\"", 2, &["`/series.csv`", "inside the run folder"]),
    ("path: \"runout\"", "path: \"../runout\"", 2, &["`figures.0.path` is `../runout`", "inside the run"]),
    ("path: \"series.csv\"", "path: \"run.json\"", 2, &["`run.json`, which the run itself writes"]),
    ("path: \"grains\"", "path: \"snapshots/a\"", 2, &["`snapshots/a`, which the run itself writes"]),
    ("path: \"energies\"", "path: \"runout\"", 2, &["`figures.1.path` is `runout` again"]),
    (
        "path: \"grains\"",
        "path: \"series.csv/a\"",
        2,
        &["`series.csv/a` again", "`outputs.0.write.path` writes it"],
    ),
    (
        "path: \"contacts\"",
        "path: \".//grains\"",
        2,
        &["`.//grains`", "a relative path inside the run folder"],
    ),
    ("path: \"energies\"", "path: \"a//../runout\"", 2, &["inside the run folder"]),
    ("path: \"series.csv\"", "path: \"series.csv.tmp\"", 2, &["as files are called while they are written"]),
    // Stability.
    (
        "Dem(())",
        "Dem((time_step: \"1 ms\"))",
        3,
        &["small.ron: `solvers.grains.time_step`: a step of 1.0000e-3 s", "allowed: at most", "stability"],
    ),
    (
        "name: \"settle\",",
        "name: \"settle\", time_step: \"1 ms\",",
        3,
        &["small.ron: `stages.0.time_step`: a step of 1.0000e-3 s in stage `settle`"],
    ),
];

fn line_of(text: &str, part: &str) -> usize {
    1 + text[..text.find(part).expect("the part was put in")].matches('\n').count()
}

/// Runs a text as a scene; it must fail and leave nothing.
fn fails(scratch: &Scratch, text: &[u8], arguments: &[&str], code: i32, parts: &[&str]) -> String {
    fs::write(scratch.path("small.ron"), text).unwrap();
    let before = files(&scratch.path(""));
    let arguments = [&["run", "small.ron", "--out", "out"], arguments].concat();
    let outcome = scratch.granular(&arguments).expect(code).says(parts);
    println!("{}\n", outcome.err);
    assert_eq!(outcome.out, "", "nothing but results goes to standard output");
    assert!(!scratch.path("out").exists(), "a run folder appeared");
    assert!(files(&scratch.path("")) == before, "files changed");
    outcome.err
}

/// `cargo test -p granular bad_input -- --nocapture` prints all messages.
#[test]
fn a_bad_scene_is_refused_with_its_place_and_leaves_nothing() {
    let scratch = Scratch::new("bad");
    for &(from, to, code, parts) in SCENE_CASES {
        assert!(SMALL.contains(from), "`{from}` is not in the scene");
        let text = SMALL.replacen(from, to, 1);
        let message = fails(&scratch, text.as_bytes(), &[], code, parts);
        if code == 2 {
            // What follows from an error is not told: one mistake, one message.
            assert_eq!(message.matches("error:").count(), 1, "{message}");
            let place = format!("--> small.ron:{}:", line_of(SMALL, from));
            let elsewhere = parts.iter().any(|part| part.starts_with("-->"));
            assert!(elsewhere || message.contains(&place), "{place} is not in:\n{message}");
        }
    }
}

#[test]
fn hertz_contacts_ask_every_material_for_its_elastic_constants() {
    let scratch = Scratch::new("hertz");
    let parts = [
        "`materials.glass.young_modulus` is missing",
        "`materials.wall.young_modulus` is missing",
        "young_modulus and poisson_ratio, since contacts are Hertz",
    ];
    fails(&scratch, SMALL.as_bytes(), &["--set", "solvers.grains.contact=Hertz"], 2, &parts);
    // With them the same scene runs, its linear stiffness unused.
    let text = SMALL
        .replace("restitution: 0.75", "young_modulus: \"20 GPa\", poisson_ratio: 0.25, restitution: 0.75");
    fs::write(scratch.path("small.ron"), text).unwrap();
    scratch.granular(&["check", "small.ron", "--set", "solvers.grains.contact=Hertz"]).expect(0);
}

#[test]
fn grains_one_by_one_are_checked_at_their_place() {
    let scratch = Scratch::new("grains");
    let (start, end) = (SMALL.find("    sample:").unwrap(), SMALL.find("    stages:").unwrap());
    let scene = |grains: &str| {
        let sample = format!("    sample: Grains([\n{grains}]),\n    walls: [Floor(material: \"wall\")],\n");
        let figures = SMALL.find("    figures:").unwrap();
        format!("{}{sample}{})", &SMALL[..start], &SMALL[end..figures])
    };
    let one = "        (position: [\"1 mm\", \"1 mm\"], radius: \"1 mm\", material: \"glass\"),\n";
    let negative = one.replace("radius: \"1 mm\"", "radius: \"-1 mm\"");
    let text = scene(&format!("{one}{negative}"));
    let place = format!("--> small.ron:{}:", line_of(&text, &negative));
    let parts = ["`sample.Grains.1.radius` is -0.001 m", "a positive length", place.as_str()];
    fails(&scratch, text.as_bytes(), &[], 2, &parts);
    fails(&scratch, scene("").as_bytes(), &[], 2, &["`sample` is empty", "at least one grain"]);
    let near = one.replacen("\"1 mm\"", "\"2.8 mm\"", 1);
    let parts = [
        "small.ron: overlap at the start is 20.0000 % of the radius; allowed: at most 5 %",
        "grain 0 at (0.001000, 0.001000) m and grain 1 at (0.002800, 0.001000) m overlap by 2.000e-4 m",
    ];
    fails(&scratch, scene(&format!("{one}{near}")).as_bytes(), &[], 3, &parts);
    let beside = scene(one).replace("Floor(", "Right(");
    fails(&scratch, beside.as_bytes(), &[], 2, &["a wall beside a column", "write a Plane instead"]);
}

#[test]
fn what_is_no_scene_is_named() {
    let scratch = Scratch::new("none");
    fails(&scratch, b"", &[], 2, &["the file is empty", "--> small.ron", "a scene begins with `Scene(`"]);
    // Noise from a fixed generator: some of it is UTF-8 by chance, none is a scene.
    let mut state = 1_u32;
    for length in 1..40 {
        let noise: Vec<u8> = (0..length * length)
            .map(|_| {
                state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                (state >> 24) as u8 & if length % 2 == 0 { 0xff } else { 0x7f }
            })
            .collect();
        fails(&scratch, &noise, &[], 2, &["error: ", "--> small.ron"]);
    }
    let missing = scratch.granular(&["run", "smal.ron", "--out", "out"]).expect(2);
    missing.says(&["there is no such file", "--> smal.ron", "did you mean `small.ron`?"]);
    fs::create_dir(scratch.path("folder")).unwrap();
    fs::write(scratch.path("folder/scene.ron"), SMALL).unwrap();
    let folder = scratch.granular(&["run", "folder", "--out", "out"]).expect(2);
    folder.says(&["this is a folder, not a scene file", "did you mean `folder/scene.ron`?"]);
    assert!(!scratch.path("out").exists());
}

#[test]
fn wrong_assignments_are_explained() {
    let scratch = Scratch::new("set");
    let cases: &[(&str, &[&str])] = &[
        ("nonsense", &["an assignment is a path, `=` and a value", "--set nonsense"]),
        ("sampel.seed=2", &["the scene has no `sampel`", "did you mean `sample`?"]),
        ("walls.7.material=wall", &["`walls` has 3 values", "0 to 2"]),
        ("materials.glass.frictoin=1", &["unknown key `frictoin`", "written by `--set materials.glass.fric"]),
        ("sample.seed=1.5", &["expected a whole number", "written by `--set sample.seed=1.5`"]),
        ("materials.glass.friction=-1", &["is -1", "written by `--set materials.glass.friction=-1`"]),
        ("stages.1.end=For", &["`For` needs values in round brackets"]),
    ];
    for (assignment, parts) in cases {
        fails(&scratch, SMALL.as_bytes(), &["--set", assignment], 2, parts);
    }
}

#[test]
fn what_is_in_the_way_stays_as_it_is() {
    let scratch = Scratch::with_scene("folders");
    let short = ["--quiet", "--set", "stages.0.end=For(\"2 ms\")", "--set", "stages.1.end=For(\"2 ms\")"];
    let run = |more: &[&str]| scratch.granular(&[&["run", "small.ron"], &short[..], more].concat());
    run(&["--out", "done"]).expect(0);
    fs::create_dir(scratch.path("foreign")).unwrap();
    fs::write(scratch.path("foreign/thesis.tex"), "years of work").unwrap();
    fs::write(scratch.path("file"), "a file").unwrap();
    let before = files(&scratch.path(""));

    run(&["--out", "done"]).expect(5).says(&["done: holds a run already", "--force", "--out"]);
    for force in [&[][..], &["--force"]] {
        let refused = run(&[&["--out", "foreign"], force].concat()).expect(5);
        refused.says(&["foreign: is not empty and holds no run", "choose another folder with --out"]);
        run(&[&["--out", "file"], force].concat()).expect(5).says(&["file: is a file"]);
    }
    // A scene that is wrong must not cost the run that it would replace.
    run(&["--out", "done", "--force", "--set", "version=2"]).expect(2);
    run(&["--out", "done", "--force", "--set", "solvers.grains=Dem((time_step: \"1 s\"))"]).expect(3);
    assert!(files(&scratch.path("")) == before, "files changed");

    scratch.granular(&["resume", "done"]).expect(5).says(&["done: this run is done", "nothing to resume"]);
    scratch.granular(&["resume", "foreign"]).expect(5).says(&["it lacks scene.ron and run.json"]);
    scratch.granular(&["resume", "nowhere"]).expect(5).says(&["nowhere: there is no such folder"]);
    scratch.granular(&["plot", "file"]).expect(5).says(&["file: is a file"]);
    scratch.granular(&["info", "foreign"]).expect(5).says(&["foreign: is not a run folder"]);
    scratch.granular(&["new", "colum-collapse"]).expect(5).says(&["no template", "column-collapse"]);
    assert!(files(&scratch.path("")) == before, "files changed");

    run(&["--out", "done", "--force", "--set", "sample.seed=2"]).expect(0);
    assert!(files(&scratch.path("done")) != before, "the run was replaced");
}
