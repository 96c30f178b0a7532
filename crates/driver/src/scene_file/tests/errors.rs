use super::*;

#[test]
fn the_sample_is_read() {
    let scene = sample().parse::<Scene>().unwrap();
    assert_eq!(scene.materials["glass"].density, Density::from(2650.0));
    assert_eq!(scene.materials["glass"].normal_stiffness, Some(Stiffness::from(1.6e6)));
    assert_eq!(scene.stages[1].1, Ending::For(Time::from(0.45)));
}

#[test]
fn an_unknown_key_is_shown_with_the_allowed_ones() {
    let scene = SceneText::new("examples/x/scene.ron", "{\n    \"glass\": (frictoin: 0.5),\n}");
    let problem = scene.parse::<BTreeMap<String, Material>>().unwrap_err();
    let shown = r#"error: unknown key `frictoin` in a material
 --> examples/x/scene.ron:2:15
  |
2 |     "glass": (frictoin: 0.5),
  |               ^^^^^^^^ allowed: density, friction, restitution, normal_stiffness
  |
  = help: did you mean `friction`?"#;
    assert_eq!(problem.to_string(), shown);
    assert_eq!(problem.place.path.as_deref(), Some("glass.frictoin"));
}

/// What is replaced by what, the message, the underlined text and the hint.
type Case = (&'static str, &'static str, &'static str, &'static str, &'static str);

const CASES: &[Case] = &[
    (
        "Ballistic",
        "Balistic",
        "unknown choice `Balistic` for a packing",
        "Balistic",
        "did you mean `Ballistic`?",
    ),
    ("Column(", "Colum(", "unknown choice `Colum` for a sample", "Colum", "did you mean `Column`?"),
    ("contact", "law", "unknown key `law` in a dem", "law", ""),
    ("Scene(", "Scen(", "expected `Scene`, found `Scen`", "Scen", "did you mean `Scene`?"),
    (
        r#""68 mm""#,
        r#""68 kg""#,
        "`68 kg` is a mass, but a length such as `1 mm` is expected",
        r#""68 kg""#,
        "",
    ),
    (r#""0.45 s""#, r#""0.45 sec""#, "unknown unit `sec`; did you mean `s`?", r#""0.45 sec""#, ""),
    (
        "0.53",
        r#""0.53""#,
        "expected a number, found `\"0.53\"`",
        r#""0.53""#,
        "this number takes no unit; write it without quotes",
    ),
    (
        r#"material: "glass""#,
        "material: glass",
        "expected a text in double quotes, found `glass`",
        "glass",
        "write it in double quotes: \"glass\"",
    ),
    ("seed: 1", "seed: 1.5", "expected a whole number, found `1.5`", "1.5", ""),
    ("seed: 1", "seed: -1", "this whole number is out of range", "-1", ""),
    ("0.53, ", "0.53 ", "expected a comma, found `restitution`", "restitution", ""),
    (
        "[0.0, -9.81]",
        "(0.0, -9.81)",
        "expected a list in square brackets, found `(`",
        "(",
        "lists are written in square brackets: `[1.0, 2.0]`",
    ),
    (
        "version: 1",
        "version = 1",
        "expected `:` and a value, found `=`",
        "=",
        "a value is given by `key: value`",
    ),
    ("seed: 1", "size: 1", "unknown key `size` in a column", "size", ""),
    (", seed: 1", "", "missing key `seed` in a column", "Column", "add `seed: ...` between its brackets"),
    (
        "friction: 0.53, ",
        "",
        "missing key `friction` in a material",
        "\"glass\"",
        "add `friction: ...` between its brackets",
    ),
    (
        "(contact: Linear)",
        "(contact: Linear",
        "`(` is not closed",
        "(",
        "instead, `}` follows at scene.ron:7:48",
    ),
    (
        "Dem((contact: Linear))",
        "Dem((contact: Linear)))",
        "`{` is not closed",
        "{",
        "instead, `)` follows at scene.ron:7:48",
    ),
    ("-9.81", "NaN", "`NaN` is not a finite number", "NaN", ""),
    ("-9.81", "-1e400", "`-1e400` is not a finite number", "-1e400", ""),
    ("-9.81", "-inf", "`-inf` is not a finite number", "-inf", ""),
    (
        r#""68 mm""#,
        r#""nan mm""#,
        "`nan mm` is not finite, or too large or too small for a computer's number; a length such as `1 mm` is expected",
        r#""nan mm""#,
        "",
    ),
    (r#"("settle", "#, r#"("settle", 1, "#, "expected a name, found `1`", "1", ""),
    (
        r#""68 mm""#,
        "68 mm",
        "expected a comma, found `mm`",
        "mm",
        "a value with a unit is written in double quotes",
    ),
    ("For(\"0.45 s\")", "For", "`For` needs values in round brackets", "For", ""),
    (
        "packing: Ballistic",
        "packing: \"Ballistic\"",
        "expected a name, found `\"Ballistic\"`",
        "\"Ballistic\"",
        "names are written without quotes",
    ),
    ("seed: 1", "seed: 1, seed: 2", "key `seed` is written twice", "seed", "leave out one of them"),
];

#[test]
fn every_mistake_is_explained_at_its_place() {
    for (from, to, message, underlined, hint) in CASES {
        let problem = problem_with(from, to);
        let snippet = problem.snippet.as_deref().unwrap();
        let shown: String = snippet.text.chars().skip(snippet.before).take(snippet.width).collect();
        assert_eq!(
            (shown.as_str(), problem.hint.as_deref().unwrap_or_default()),
            (*underlined, *hint),
            "{problem}"
        );
        assert!(message.is_empty() || problem.message == *message, "{problem}");
    }
}

#[test]
fn keys_written_twice_are_shown_with_both_places() {
    let glass = r#""glass": (density: 1, friction: 0.5), "#;
    let problem = problem_with(r#"{ "glass""#, &format!("{{ {glass}\"glass\""));
    assert_eq!(problem.message, "key `glass` is written twice");
    assert_eq!(problem.notes, ["the first is at scene.ron:3:18"]);
    assert_eq!((problem.place.line, problem.place.column), (Some(3), Some(56)));
    assert_eq!(problem.place.path.as_deref(), Some("materials.glass"));
}

#[test]
fn a_value_without_sense_is_found_by_its_path() {
    let problem = SceneProblem::at_path("sample.aspect_ratio", -0.8, "above 0", "a column has a height");
    let bare = "error: `sample.aspect_ratio` is -0.8\n --> sample.aspect_ratio\n  = allowed: above 0\n  = help: a column has a height";
    assert_eq!(problem.to_string(), bare);
    let located = problem.located_in(&sample());
    assert_eq!((located.place.line, located.place.column), (Some(4), Some(50)));
    assert!(located.to_string().contains("^^^ allowed: above 0\n"), "{located}");

    let default =
        SceneProblem::at_path("solvers.grains.step", "1 s", "below 1e-5 s", "").located_in(&sample());
    assert_eq!((default.place.line, default.place.column), (Some(7), Some(16)), "{default}");
    assert_eq!(default.notes, ["`step` is not written there: its default is meant"]);
}

#[test]
fn a_problem_is_written_as_json() {
    let json = serde_json::to_value(problem_with("friction", "frictoin")).unwrap();
    assert_eq!(json["place"]["line"], 3);
    assert_eq!(json["place"]["path"], "materials.glass.frictoin");
    assert_eq!(json["hint"], "did you mean `friction`?");
    assert!(json["snippet"]["text"].as_str().unwrap().contains("frictoin"));
}

#[test]
fn long_lines_and_control_characters_stay_readable() {
    let text = format!("[{}x\u{1b}[31m]", "1.0, ".repeat(10_000));
    let problem = SceneText::new("scene.ron", text).parse::<Vec<f64>>().unwrap_err();
    let snippet = problem.snippet.as_deref().unwrap();
    assert!(snippet.text.chars().count() < 300 && snippet.text.starts_with('…'));
    assert!(!problem.to_string().contains('\u{1b}'));
    assert_eq!(snippet.text.chars().nth(snippet.before), Some('x'));
    // The line that is shown is cut, the place is that in the file.
    let shown = problem.to_string();
    assert!(shown.contains(" --> scene.ron:1:50002\n") && shown.contains("^"), "{shown}");
}

#[test]
fn wide_characters_and_colours_keep_the_mark_in_its_place() {
    let problem = SceneText::new("scene.ron", "{ \"ガラス\": (frictoin: 0.5) }");
    let problem = problem.parse::<BTreeMap<String, Material>>().unwrap_err();
    // Three characters of two columns each stand before the mark.
    let shown = problem.to_string();
    let column = |line: &str, mark: char| {
        let before = line.split(mark).next().unwrap();
        before.chars().map(|c| if c.is_ascii() { 1 } else { 2 }).sum::<usize>()
    };
    let lines: Vec<&str> = shown.lines().collect();
    assert_eq!(column(lines[4], '^'), column(lines[3], 'f'), "{shown}");
    let coloured = problem.in_colour();
    assert!(coloured.contains("\u{1b}[") && !shown.contains('\u{1b}'));
    // In colour it says the same.
    let mut bare = String::new();
    let mut rest = coloured.as_str();
    while let Some((text, code)) = rest.split_once('\u{1b}') {
        bare.push_str(text);
        rest = code.split_once('m').map_or("", |(_, after)| after);
    }
    assert_eq!(bare + rest, shown);
}

#[test]
fn deep_nesting_is_refused_without_harm() {
    let text = "(".repeat(100_000);
    let scene = SceneText::new("scene.ron", text);
    assert!(scene.parse::<Scene>().is_err());
    assert!(scene.parse::<ron::Value>().is_err());
    assert!(scene.locate("0.0.0").is_some());
}
