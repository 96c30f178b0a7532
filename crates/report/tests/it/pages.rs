//! The page as a text.

use crate::support::{Page, Scratch, grains};
use granular_core::glam::DVec2;
use serde_json::json;
use std::fs;

const HOSTILE: &str = "</script><script>window.hostile = 1</script><img src=x onerror=alert(1)> & \" '<!--";

#[test]
fn names_of_a_run_are_text_wherever_they_stand() {
    let scratch = Scratch::new("hostile");
    let folder = scratch.run("a");
    let quoted = serde_json::to_string(HOSTILE).unwrap();
    let scene = format!("Scene(title: {quoted}, walls: [Floor(name: {quoted})])");
    fs::write(folder.join("scene.ron"), &scene).unwrap();
    let facts = json!({ "exit": HOSTILE, "reason": HOSTILE, "metrics": { HOSTILE: 1.0 }, "units": { HOSTILE: HOSTILE },
        "stages": [{ "name": HOSTILE, "start": 0.0, "dt": 1.0, "ended": HOSTILE }], "built": { "cpu": HOSTILE } });
    fs::write(folder.join("run.json"), facts.to_string()).unwrap();
    fs::write(folder.join("walls.csv"), "time [s],force on </script><b> [N]\n0,1\n").unwrap();
    let page = Page::of(&scratch, std::slice::from_ref(&folder));
    let data = page.data();
    let run = &data["runs"][0];
    assert_eq!((&run["title"], &run["scene"]), (&json!(HOSTILE), &json!(scene)));
    assert_eq!(run["tables"][1]["columns"][1]["name"], json!("force on </script><b>"));
    // But for the title of the page, where they are escaped, names stand in the data alone, without a sign that HTML knows.
    assert!(!page.html.contains("<img src=x") && !page.html.contains("window.hostile = 1</script>"));
    let whole = page.html.matches("</script>").count();
    let plain = Page::of(&scratch, &[scratch.run("b")]);
    let more = 2; // The other table has two columns.
    assert_eq!(whole, plain.html.matches("</script>").count() + more, "no text ends a script");
}

#[test]
fn the_page_is_whole_and_fetches_nothing() {
    let scratch = Scratch::new("whole");
    let page = Page::of(&scratch, &[scratch.run("a")]);
    let html = &page.html;
    assert!(html.starts_with("<!doctype html>") && html.trim_end().ends_with("</html>"));
    assert!(html.contains("<title>Two grains</title>") && html.contains("prefers-color-scheme: dark"));
    assert!(html.contains("default-src 'none'"), "the browser is told to fetch nothing");
    for part in
        [" src=\"", "@import", "url(", "fetch(", "XMLHttpRequest", "import(", "<link rel=\"stylesheet\""]
    {
        assert!(!html.contains(part), "{part}");
    }
    assert!(!html.contains("{title}") && !html.contains("{style}"));
}

#[test]
fn tables_keep_all_digits() {
    let scratch = Scratch::new("digits");
    let page = Page::of(&scratch, &[scratch.run("a")]);
    let data = page.data();
    let table = &data["runs"][0]["tables"][0];
    assert_eq!(
        (&table["name"], &table["rows"], &table["every"]),
        (&json!("series.csv"), &json!(3), &json!(1))
    );
    let height = page.doubles(&table["columns"][1]["array"]);
    assert!(height[0] == 1.0 && height[1].is_nan() && height[2] == 0.1 + 0.2, "{height:?}");
    assert_eq!(table["columns"][1]["unit"], json!("m"));
}

#[test]
fn long_tables_are_thinned_and_keep_their_last_row() {
    let scratch = Scratch::new("long");
    let folder = scratch.bare("a");
    let rows: String = (0..250_001).map(|k| format!("{k},{k}\n")).collect();
    fs::write(folder.join("long.csv"), format!("time [s],height [m]\n{rows}")).unwrap();
    fs::write(folder.join("words.csv"), "name\nglass\n").unwrap();
    let page = Page::of(&scratch, &[folder]);
    let data = page.data();
    let table = &data["runs"][0]["tables"][0];
    assert_eq!((&table["rows"], &table["every"]), (&json!(250_001), &json!(3)));
    let time = page.doubles(&table["columns"][0]["array"]);
    assert_eq!((time[1], *time.last().unwrap(), time.len()), (3.0, 250_000.0, 83_335));
    assert!(page.written.left_out.iter().any(|said| said.contains("words.csv") && said.contains("line 2")));
}

#[test]
fn figures_are_in_the_page_each_once() {
    let scratch = Scratch::new("figures");
    let folder = scratch.bare("a");
    fs::write(folder.join("flow.svg"), "<svg/>").unwrap();
    fs::write(folder.join("flow.png"), "pixels").unwrap();
    fs::write(folder.join("large.svg"), "x".repeat(500_000)).unwrap();
    fs::write(folder.join("large.png"), "pixels").unwrap();
    fs::write(folder.join("only.png"), "other").unwrap();
    let page = Page::of(&scratch, &[folder]);
    let data = page.data();
    let figures = data["runs"][0]["figures"].as_array().unwrap();
    let files: Vec<&str> = figures.iter().map(|figure| figure["file"].as_str().unwrap()).collect();
    assert_eq!(files, ["flow.svg", "large.png", "only.png"]);
    assert_eq!(page.bytes(&figures[0]["array"]), b"<svg/>");
}

#[test]
fn the_same_folder_makes_the_same_bytes() {
    let scratch = Scratch::new("same");
    let folder = scratch.run("a");
    grains(&folder, 5, |k| DVec2::new(0.3, k as f64));
    let first = Page::of(&scratch, std::slice::from_ref(&folder)).html;
    assert!(first == Page::of(&scratch, &[folder]).html);
}
