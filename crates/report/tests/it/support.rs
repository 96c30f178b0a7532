//! Run folders of a few grains and cells.

use granular_core::glam::DVec2;
use granular_core::{FieldRef, FieldSink, Location};
use granular_io::{Collection, Frame, TableWriter, write_fields};
use granular_report::{Request, Written};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};

/// A folder that is gone at the end.
pub(crate) struct Scratch(PathBuf);

impl Scratch {
    pub(crate) fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("granular-report-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    /// A folder with what marks it as a run and nothing else.
    pub(crate) fn bare(&self, name: &str) -> PathBuf {
        let folder = self.path(name);
        fs::create_dir_all(&folder).unwrap();
        fs::write(folder.join("run.json"), r#"{"exit": "done", "solver": "dem", "simulated_seconds": 0.5}"#)
            .unwrap();
        folder
    }

    /// A folder with a scene, a table and three frames of grains.
    pub(crate) fn run(&self, name: &str) -> PathBuf {
        let folder = self.bare(name);
        fs::write(folder.join("scene.ron"), "Scene(version: 1, title: \"Two grains\")").unwrap();
        let mut table =
            TableWriter::create(&folder.join("series.csv"), &[("time", "s"), ("height", "m")]).unwrap();
        for row in [[0.0, 1.0], [0.25, f64::NAN], [0.5, 0.1 + 0.2]] {
            table.row(&row).unwrap();
        }
        grains(&folder, 3, |k| DVec2::new(0.1 * k as f64, -0.3));
        folder
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Speeds of the two grains in a frame.
pub(crate) fn speeds(step: usize) -> [f64; 2] {
    [0.125 + step as f64 / 3.0, 7.0 - step as f64]
}

/// Frames of two grains that change their order in each frame; one stays at the origin.
pub(crate) fn grains(folder: &Path, frames: usize, place: impl Fn(usize) -> DVec2) {
    let mut list = Collection::create(&folder.join("grains.pvd")).unwrap();
    for step in 0..frames {
        let order: [usize; 2] = if step % 2 == 0 { [0, 1] } else { [1, 0] };
        let places = order.map(|k| [DVec2::ZERO, place(step)][k]);
        let mut frame = Frame::wanting_all();
        frame.field("radius", "m", FieldRef::Scalar(&order.map(|k| [1e-3, 2e-3][k])));
        frame.field("speed", "m/s", FieldRef::Scalar(&order.map(|k| speeds(step)[k])));
        frame.field("id", "1", FieldRef::Index(&order.map(|k| k as u32)));
        let time = 0.25 * step as f64;
        let location = Location::Points(FieldRef::Vector2(&places));
        let path = write_fields(folder, &format!("grains_{step}"), &location, &frame, time).unwrap();
        list.push(time, &path.file_name().unwrap().to_string_lossy()).unwrap();
    }
}

/// A page, with what was written.
pub(crate) struct Page {
    pub(crate) html: String,
    pub(crate) written: Written,
}

impl Page {
    pub(crate) fn of(scratch: &Scratch, folders: &[PathBuf]) -> Self {
        Self::within(scratch, folders, u64::MAX)
    }

    /// A page whose animations take at most so many bytes.
    pub(crate) fn within(scratch: &Scratch, folders: &[PathBuf], largest_bytes: u64) -> Self {
        let request = Request { largest_bytes, ..Request::new(folders, scratch.path("page.html")) };
        let written = granular_report::write(&request).unwrap();
        let html = fs::read_to_string(&written.path).unwrap();
        assert_eq!(html.len() as u64, written.bytes);
        Self { html, written }
    }

    /// What the scripts of the page read.
    pub(crate) fn data(&self) -> Value {
        let start = "<script type=\"application/json\" id=\"data\">";
        serde_json::from_str(between(&self.html, start, "</script>")).unwrap()
    }

    /// The bytes of an array.
    pub(crate) fn bytes(&self, number: &Value) -> Vec<u8> {
        use base64::engine::{Engine, general_purpose::STANDARD};
        let start = format!("<script type=\"text/plain\" id=\"a{number}\">");
        STANDARD.decode(between(&self.html, &start, "</script>")).unwrap()
    }

    /// The numbers of a column of a table.
    pub(crate) fn doubles(&self, number: &Value) -> Vec<f64> {
        self.bytes(number).chunks(8).map(|chunk| f64::from_le_bytes(chunk.try_into().unwrap())).collect()
    }

    /// The values of a channel in a frame, and by how much they may be off.
    pub(crate) fn values(&self, channel: &Value, frame: usize) -> (Vec<f64>, f64) {
        let bytes = self.bytes(&channel["arrays"][frame]);
        let levels: Vec<u16> = match channel["bytes"].as_u64() {
            Some(1) => bytes.iter().map(|byte| u16::from(*byte)).collect(),
            _ => bytes.chunks(2).map(|pair| u16::from_le_bytes([pair[0], pair[1]])).collect(),
        };
        let number = |key: &str| channel[key].as_f64().unwrap();
        (
            levels.iter().map(|level| number("low") + f64::from(*level) * number("step")).collect(),
            number("error"),
        )
    }
}

fn between<'a>(text: &'a str, start: &str, end: &str) -> &'a str {
    let from = text.find(start).unwrap_or_else(|| panic!("no {start}")) + start.len();
    &text[from..from + text[from..].find(end).unwrap()]
}
