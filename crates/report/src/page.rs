//! The page: its parts in the order in which a browser reads them.

use crate::arrays::Arrays;
use crate::error::ReportError;
use crate::folder::Run;
use crate::movie::{Movie, Plan, movies_of};
use crate::{Request, Written, figures, scene, tables};
use granular_io::write_atomically;
use serde_json::{Value, json};
use std::fs;
use std::io::{self, Write};

const HEAD: &str = include_str!("page/head.html");
const BODY: &str = include_str!("page/body.html");
const STYLE: &str = include_str!("page/style.css");
/// Each uses only what those before it define.
const SCRIPTS: [(&str, &str); 14] = [
    ("elements", include_str!("page/elements.js")),
    ("numbers", include_str!("page/numbers.js")),
    ("colours", include_str!("page/colours.js")),
    ("arrays", include_str!("page/arrays.js")),
    ("plot", include_str!("page/plot.js")),
    ("series", include_str!("page/series.js")),
    ("energy", include_str!("page/energy.js")),
    ("summary", include_str!("page/summary.js")),
    ("scene", include_str!("page/scene.js")),
    ("movie", include_str!("page/movie.js")),
    ("points", include_str!("page/points.js")),
    ("plane", include_str!("page/plane.js")),
    ("viewer", include_str!("page/viewer.js")),
    ("main", include_str!("page/main.js")),
];

/// Writes the page about runs.
pub(crate) fn write(runs: &[Run], request: &Request) -> Result<Written, ReportError> {
    let mut lacks: Vec<Vec<String>> = runs.iter().map(|run| run.lacks.clone()).collect();
    let movies: Vec<Vec<Movie>> =
        runs.iter().zip(&mut lacks).map(|(run, lacks)| movies_of(run, lacks)).collect();
    let plan = Plan::for_size(&movies.concat(), request.largest_bytes);
    let path = &request.out;
    let written = write_atomically(path, |to| whole(runs, &movies, plan, &mut lacks, to));
    written.map_err(|error| {
        let fix = "choose another file with --out, or make room";
        ReportError::new(path, error.reason, "a file in a folder that can be written to", fix)
    })?;
    let bytes = fs::metadata(path).map_or(0, |data| data.len());
    let told = runs.iter().zip(lacks).flat_map(|(run, lacks)| {
        lacks.into_iter().map(move |said| format!("{}: {said}", run.path.display()))
    });
    Ok(Written { path: path.clone(), bytes, runs: runs.len(), left_out: told.collect() })
}

fn whole(
    runs: &[Run],
    movies: &[Vec<Movie>],
    plan: Plan,
    lacks: &mut [Vec<String>],
    to: &mut dyn Write,
) -> io::Result<()> {
    let titles: Vec<String> = runs.iter().map(title).collect();
    to.write_all(HEAD.replace("{title}", &escaped(&heading(&titles))).replace("{style}", STYLE).as_bytes())?;
    to.write_all(BODY.as_bytes())?;
    let mut arrays = Arrays::new(to);
    let mut shown = Vec::new();
    for (k, run) in runs.iter().enumerate() {
        shown.push(one(run, &titles[k], &movies[k], plan, &mut lacks[k], &mut arrays)?);
    }
    let data = json!({
        "heading": heading(&titles),
        "program": format!("granular-report {}", env!("CARGO_PKG_VERSION")),
        "plan": { "bits": 8 * plan.bits.bytes(), "every": plan.every },
        "runs": shown,
    });
    writeln!(to, "<script type=\"application/json\" id=\"data\">{}</script>", in_script(&data))?;
    for (name, text) in SCRIPTS {
        writeln!(to, "<script>\n// {name}.js\n{text}</script>")?;
    }
    writeln!(to, "</body>\n</html>")
}

/// What the page knows of a run.
fn one(
    run: &Run,
    title: &str,
    movies: &[Movie],
    plan: Plan,
    lacks: &mut Vec<String>,
    arrays: &mut Arrays<'_>,
) -> io::Result<Value> {
    let tables = tables::write(run, arrays, lacks)?;
    let figures = figures::write(run, arrays, lacks)?;
    let movies: Vec<Value> =
        movies.iter().map(|movie| movie.write(plan, arrays)).collect::<io::Result<_>>()?;
    Ok(json!({
        "name": run.name,
        "folder": run.path.display().to_string(),
        "title": title,
        "facts": run.facts,
        "limits": run.limits,
        "scene": run.scene,
        "tables": tables,
        "figures": figures,
        "movies": movies,
        "lacks": lacks,
    }))
}

/// The title of the scene, or the name of the folder.
fn title(run: &Run) -> String {
    let of_scene = run.scene.as_deref().and_then(scene::title);
    of_scene.filter(|title| !title.trim().is_empty()).unwrap_or_else(|| run.name.clone())
}

/// The heading of the page: all titles, each once.
fn heading(titles: &[String]) -> String {
    let mut different: Vec<&str> = Vec::new();
    for title in titles {
        if !different.contains(&title.as_str()) {
            different.push(title);
        }
    }
    match different.as_slice() {
        [one] if titles.len() > 1 => format!("{one}: {} runs", titles.len()),
        [first, second, _, ..] => format!("{first}, {second} and {} more", different.len() - 2),
        _ => different.join(" and "),
    }
}

/// Text that may stand in an element.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// JSON that may stand in a script element: no text in it can end the element or begin a comment.
fn in_script(data: &Value) -> String {
    data.to_string().replace('<', "\\u003c").replace('>', "\\u003e").replace('&', "\\u0026")
}
