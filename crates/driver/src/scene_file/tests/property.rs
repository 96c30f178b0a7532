use super::*;
use proptest::prelude::*;

/// Everything that reads a text; none of it may panic.
fn try_all(text: &str, path: &str, value: &str) {
    let mut scene = SceneText::new("scene.ron", text);
    let show = |scene: &SceneText| {
        if let Err(problem) = scene.parse::<Scene>() {
            let _ = (problem.to_string(), serde_json::to_string(&problem));
        }
        let _ = scene.parse::<ron::Value>().map_err(|problem| problem.to_string());
    };
    show(&scene);
    if let Some(span) = scene.locate(path) {
        let _ = &scene.text()[span];
    }
    let _ = SceneProblem::at_path(path, value, "nothing", "").located_in(&scene).to_string();
    let _ = scene.set(&format!("{path}={value}")).map_err(|problem| problem.to_string());
    let _ = scene.set(value).map_err(|problem| problem.to_string());
    show(&scene);
}

fn paths() -> impl Strategy<Value = &'static str> {
    prop::sample::select(vec![
        "version",
        "gravity.0",
        "materials.glass.friction",
        "materials.steel",
        "sample.width",
        "sample.new",
        "walls.1",
        "stages.1.1.0",
        "solvers.grains.contact",
        "outputs.0.write.probes.1",
        "0",
        "é",
    ])
}

/// Bytes that matter in RON.
const PIECES: &[&str] = &[
    "(", ")", "[", "]", "{", "}", ",", ":", "\"", "'", "\\", "r#\"", "\"#", "//", "/*", "*/", "\n", "\r",
    "é", "Some(", "NaN", "-inf", "1e400", "b\"", "b'", "#![", "r#a", "\u{0}", "\u{2028}", "..", "0x", "_",
    "a: 1",
];

proptest! {
    #![proptest_config(ProptestConfig { cases: 512, ..ProptestConfig::default() })]

    #[test]
    fn no_bytes_panic(bytes in prop::collection::vec(any::<u8>(), 0..200), path in "\\PC{0,12}", value in "\\PC{0,12}") {
        let _ = SceneText::from_bytes("scene.ron", bytes.clone()).map_err(|problem| problem.to_string());
        try_all(&String::from_utf8_lossy(&bytes), &path, &value);
    }

    #[test]
    fn no_pieces_panic(pieces in prop::collection::vec(prop::sample::select(PIECES), 0..60), path in paths()) {
        let text = pieces.concat();
        try_all(&text, path, &text);
    }

    #[test]
    fn no_mutation_panics(
        changes in prop::collection::vec((any::<prop::sample::Index>(), 0..12_usize, prop::sample::select(PIECES)), 1..6),
        path in paths(),
    ) {
        let mut characters: Vec<char> = SAMPLE.chars().collect();
        for (at, removed, piece) in changes {
            let at = at.index(characters.len().max(1)).min(characters.len());
            let end = (at + removed).min(characters.len());
            characters.splice(at..end, piece.chars());
        }
        try_all(&characters.into_iter().collect::<String>(), path, "68 mm");
    }

    #[test]
    fn what_is_set_is_located(path in paths(), value in "[a-z0-9 .:/()\\[\\]\"\\\\é-]{1,12}") {
        // `For([..])`: once the only argument is a list, an index means one of its items.
        prop_assume!(path != "stages.1.1.0" || !value.trim().starts_with('['));
        let mut scene = sample();
        if scene.set(&format!("{path}={value}")).is_ok() {
            let text = written(&scene, path).unwrap();
            let ron: ron::Value = ron::from_str(text).unwrap();
            prop_assert!(text == value.trim() || ron == ron::Value::String(value.trim().to_owned()), "{text}");
            prop_assert!(scene.parse::<ron::Value>().is_ok() || text.contains("inf"), "{}", scene.text());
        }
    }

    #[test]
    fn places_and_bytes_agree(text in "[a-zé\n\r]{0,40}", at in any::<prop::sample::Index>()) {
        let scene = SceneText::new("scene.ron", text.clone());
        let boundaries: Vec<usize> = (0..=text.len()).filter(|byte| text.is_char_boundary(*byte)).collect();
        let byte = boundaries[at.index(boundaries.len())];
        let (line, column) = scene.line_and_column(byte);
        prop_assert_eq!(scene.byte_at(line, column), byte);
    }
}
