//! What a run or a table holds.

use crate::failure::Failure;
use crate::folder::RunFolder;
use crate::parts;
use crate::records::RecordedStage;
use crate::scene::{Scene, Writer};
use crate::scene_file::SceneText;
use granular_io::vtk::{GridFields, read_vti};
use granular_io::{Collection, Table, read_table};
use std::path::Path;

/// A run, or a table from elsewhere.
#[derive(Clone, Debug)]
pub(super) struct Source {
    pub(super) label: String,
    pub(super) is_table: bool,
    pub(super) curves: Vec<Curve>,
    pub(super) grids: Vec<Grid>,
}

/// Numbers over time, along a line, or over the first column of a table.
#[derive(Clone, Debug)]
pub(super) struct Curve {
    pub(super) over: String,
    pub(super) over_unit: String,
    pub(super) name: String,
    pub(super) unit: String,
    pub(super) points: Vec<[f64; 2]>,
}

/// A field in the cells of a grid, as it is last.
#[derive(Clone, Debug)]
pub(super) struct Grid {
    pub(super) name: String,
    /// Where the cells are; its list of fields is empty.
    pub(super) frame: GridFields,
    pub(super) values: Vec<f64>,
}

impl Grid {
    /// Whether both are the same field on the same cells, up to round-off.
    pub(super) fn is_like(&self, other: &Self) -> bool {
        let near = |a: f64, b: f64, cell: f64| (a - b).abs() <= 1e-6 * cell;
        let (one, two) = (&self.frame, &other.frame);
        let is_same = |k: usize| {
            let cell = one.spacing[k];
            near(one.origin[k], two.origin[k], cell) && near(cell, two.spacing[k], cell)
        };
        self.name == other.name && one.cells == two.cells && (0..3).all(is_same)
    }
}

impl Curve {
    pub(super) fn key(&self) -> (String, String) {
        (self.over.clone(), self.name.clone())
    }
}

impl Source {
    pub(super) fn curve(&self, (over, name): &(String, String)) -> Option<&Curve> {
        self.curves.iter().find(|curve| curve.over == *over && curve.name == *name)
    }

    /// What it holds, for messages.
    pub(super) fn describe(&self) -> String {
        let curves = self.curves.iter().map(|curve| format!("{} over {}", curve.name, curve.over));
        let grids = self.grids.iter().map(|grid| format!("{} on {:?} cells", grid.name, grid.frame.cells));
        let all: Vec<String> = curves.chain(grids).collect();
        format!("{}: {}", self.label, if all.is_empty() { "nothing".to_owned() } else { all.join(", ") })
    }
}

/// The sources behind a path: a run, the runs in a folder of several, or a table.
pub(super) fn read(path: &Path, stage: Option<&str>) -> Result<Vec<Source>, Failure> {
    if path.is_file() {
        let table = read_table(path)?;
        let over = table.columns.first().map_or(String::new(), |(name, _)| name.clone());
        let curves = curves_of(&table, &over, 0.0);
        let label = path.display().to_string();
        return Ok(vec![Source { label, is_table: true, curves, grids: Vec::new() }]);
    }
    let folder = RunFolder::open(path)?;
    let text = SceneText::read(folder.scene_path())?;
    let parts = parts::of(&text)?;
    if parts.len() == 1 {
        return Ok(vec![of_run(&folder, &text, stage)?]);
    }
    parts.iter().map(|part| of_run(&RunFolder::open(&path.join(&part.name))?, &part.text, stage)).collect()
}

fn of_run(folder: &RunFolder, text: &SceneText, stage: Option<&str>) -> Result<Source, Failure> {
    let scene = Scene::of(text)?;
    let start = start_of(folder, stage)?;
    let (mut curves, mut grids) = (Vec::new(), Vec::new());
    for output in &scene.outputs {
        let path = folder.path().join(output.write.path());
        match &output.write {
            Writer::Table { .. } => curves.extend(curves_of(&read_table(&path)?, "time", start)),
            Writer::Profile { .. } => {
                curves.extend(curves_of(&last_profile(&read_table(&path)?), "distance", 0.0));
            }
            Writer::Fields { .. } => grids.extend(last_grid(&path)?),
            Writer::Contacts { .. } | Writer::Tracks { .. } | Writer::Hdf5 { .. } => {}
        }
    }
    let label = folder.path().display().to_string();
    Ok(Source { label, is_table: false, curves, grids })
}

/// When time begins to count \[s\].
fn start_of(folder: &RunFolder, stage: Option<&str>) -> Result<f64, Failure> {
    let Some(stage) = stage else { return Ok(0.0) };
    let path = folder.path().display();
    let stages: Vec<RecordedStage> = serde_json::from_value(folder.facts()?["stages"].clone())
        .map_err(|error| Failure::io(&path, format!("run.json has no stages: {error}")))?;
    let found = stages.iter().find(|record| record.name == stage);
    let known = || stages.iter().map(|record| record.name.clone()).collect::<Vec<_>>().join(", ");
    let reason = || format!("has run no stage `{stage}`; known: {}", known());
    found.map(|record| record.start).ok_or_else(|| Failure::io(&path, reason()))
}

/// All columns over one of them, from a start on.
fn curves_of(table: &Table, over: &str, start: f64) -> Vec<Curve> {
    let (x, over_unit) = (table.column(over).unwrap_or_default(), table.unit(over).unwrap_or_default());
    let places = ["x", "y", "z", "time"];
    let others = table.columns.iter().filter(|(name, _)| name != over && !places.contains(&name.as_str()));
    let curve = |(name, unit): &(String, String)| {
        let values = table.column(name).unwrap_or_default();
        let points = x.iter().zip(values).filter(|(x, _)| **x >= start).map(|(x, y)| [x - start, y]);
        Curve {
            over: over.to_owned(),
            over_unit: over_unit.to_owned(),
            name: name.clone(),
            unit: unit.clone(),
            points: points.filter(|point| point[1].is_finite()).collect(),
        }
    };
    others.map(curve).filter(|curve| !curve.points.is_empty()).collect()
}

/// The rows of the last time.
fn last_profile(table: &Table) -> Table {
    let time = table.column("time").unwrap_or_default();
    let last = time.last().copied().unwrap_or(f64::NAN);
    let rows = table.rows.iter().zip(&time).filter(|(_, time)| **time == last);
    Table { columns: table.columns.clone(), rows: rows.map(|(row, _)| row.clone()).collect() }
}

/// The fields of the last file of an output, if it is of a grid.
fn last_grid(stem: &Path) -> Result<Vec<Grid>, Failure> {
    let mut list = stem.as_os_str().to_owned();
    list.push(".pvd");
    let files = Collection::open(Path::new(&list))?;
    let Some((_, file)) = files.entries().last().filter(|(_, file)| file.ends_with(".vti")) else {
        return Ok(Vec::new());
    };
    let grid = read_vti(&stem.with_file_name(file))?;
    let frame = GridFields { fields: Vec::new(), ..grid.clone() };
    let names = grid.fields.iter().map(|(name, ..)| name.clone());
    let field = |name: String| {
        let values = grid.magnitude(&name)?;
        Some(Grid { name, frame: frame.clone(), values })
    };
    Ok(names.filter_map(field).collect())
}

/// Leaves out what all labels begin with.
pub(super) fn shorten(sources: &mut [Source]) {
    let labels: Vec<Vec<&str>> = sources.iter().map(|source| source.label.split('/').collect()).collect();
    let least = labels.iter().map(Vec::len).min().unwrap_or(1) - 1;
    let shared = (0..least).take_while(|&k| labels.iter().all(|label| label[k] == labels[0][k])).count();
    let short: Vec<String> = labels.iter().map(|label| label[shared..].join("/")).collect();
    for (source, label) in sources.iter_mut().zip(short) {
        source.label = label;
    }
}
