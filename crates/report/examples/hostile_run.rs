//! Makes a run folder whose names are all HTML that must not be read as such, for tests of pages: `hostile_run FOLDER`.

use granular_core::glam::DVec2;
use granular_core::{FieldRef, FieldSink, Location};
use granular_io::{Collection, Frame, write_fields};
use std::fs;
use std::path::PathBuf;

const HOSTILE: &str = "</script><script>window.hostile = 1</script><img src=x onerror='window.hostile = 2'>";
/// Names of files cannot have a slash.
const NAME: &str = "<img src=x onerror='window.hostile = 3'>";

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = PathBuf::from(std::env::args().nth(1).ok_or("usage: hostile_run FOLDER")?);
    fs::create_dir_all(&folder)?;
    fs::write(folder.join("run.json"), FACTS.replace("HOSTILE", HOSTILE))?;
    fs::write(
        folder.join("scene.ron"),
        format!("// {HOSTILE}\nScene(title: \"{HOSTILE}\", walls: [Floor(\"{HOSTILE}\")])"),
    )?;
    fs::write(folder.join(format!("{NAME}.csv")), format!("time [s],{NAME} [<b>J</b>]\n0,1\n1,2\n2,0\n"))?;
    // A drawing with a script of its own.
    let drawing = "<svg xmlns='http://www.w3.org/2000/svg' width='9' height='9'><script>parent.hostile = 4</script></svg>";
    fs::write(folder.join(format!("{NAME}.svg")), drawing)?;
    let mut list = Collection::create(&folder.join(format!("{NAME}.pvd")))?;
    for step in 0..3 {
        let places = [DVec2::ZERO, DVec2::new(f64::from(step), 1.0)];
        let mut frame = Frame::wanting_all();
        frame.field(HOSTILE, "<i>m</i>", FieldRef::Scalar(&[f64::from(step), f64::NAN]));
        let stem = format!("points_{step}");
        write_fields(&folder, &stem, &Location::Points(FieldRef::Vector2(&places)), &frame, f64::from(step))?;
        list.push(f64::from(step), &format!("{stem}.vtp"))?;
    }
    Ok(())
}

const FACTS: &str = r#"{ "exit": "failed", "reason": "HOSTILE", "solver": "HOSTILE", "solvers": { "HOSTILE": "HOSTILE" },
  "simulated_seconds": 2, "steps": 3, "wall_seconds": 1, "item": "HOSTILE", "rate": 1e6, "state_hash": "HOSTILE",
  "metrics": { "HOSTILE": 1 }, "units": { "HOSTILE": "HOSTILE" }, "sizes": { "HOSTILE": { "count": 2, "item": "HOSTILE" } },
  "stages": [{ "name": "HOSTILE", "start": 0, "end": 1, "dt": 0.1, "ended": "HOSTILE" }, { "name": "HOSTILE", "start": 1, "dt": 0.1 }],
  "limits": [{ "name": "HOSTILE", "value": 1, "bound": 2, "unit": "HOSTILE", "binds": true, "why": "HOSTILE" }],
  "built": { "version": "HOSTILE", "commit": "HOSTILE", "methods": ["HOSTILE"], "target": "HOSTILE", "cpu": "HOSTILE", "cores": 2, "threads": 2 },
  "checksums": { "HOSTILE": "HOSTILE" } }"#;
