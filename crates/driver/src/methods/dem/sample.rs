//! Grains of a scene.

mod cylinder;
mod saved;

use super::materials::NamedMaterials;
use crate::column::{ColumnSize, Outline, check_grading, grading_of, volume};
use crate::machine;
use crate::problems::Problems;
use crate::scene::{Extent, GradingSpec, PackingSpec, Sample};
use granular_core::{Dim, Linear, Spin, Vector};
use granular_dem::spec::GrainSpec;
use granular_dem::{Grain, MaterialId};
use granular_packing::{Grading, GradingError, Lattice, PackingError, Sides, ballistic, loose_lattice};
use std::path::Path;

/// Part of a ballistic deposit that is taken off so that its surface is level.
const TAKEN_OFF: f64 = 0.15;
/// Gap between grains of a loose lattice over the largest diameter.
const LOOSE_GAP: f64 = 0.1;
/// More grains than this are a slip of the pen.
const MOST_GRAINS: f64 = 1e8;
/// Memory that a grain takes from its placing to the end of a run \[bytes\]: plane and space. A check of 300 000 grains took 230 and 460;
/// the rest is a margin for contacts and outputs of a run.
const BYTES_PER_GRAIN: [f64; 2] = [700.0, 1100.0];

/// The grains and, for a column, its size.
pub(crate) struct BuiltSample<D: Dim> {
    pub(crate) grains: Vec<Grain<D>>,
    pub(crate) column: Option<ColumnSize>,
    /// Size of the cell that the sample fills \[m\].
    pub(crate) cell: Option<D::Vec>,
}

pub(crate) fn grains<D: Dim>(
    sample: &Sample,
    folder: &Path,
    materials: &NamedMaterials,
    problems: &mut Problems,
) -> Option<BuiltSample<D>> {
    match sample {
        Sample::Column { material, .. } => {
            let material = materials.find("sample.material", material, problems);
            let column = Column::of::<D>(sample, problems)?;
            column.build(material?, problems)
        }
        Sample::Cylinder { material, .. } => {
            let material = materials.find("sample.material", material, problems);
            cylinder::build(sample, material, problems)
        }
        Sample::Cell { .. } => super::cell::fill(sample, materials, problems),
        Sample::Grains(list) => {
            if list.is_empty() {
                problems.add("sample", "empty", "at least one grain", "");
            }
            let grains: Vec<Option<Grain<D>>> =
                list.iter().enumerate().map(|(k, spec)| grain(k, spec, materials, problems)).collect();
            let grains = grains.into_iter().collect::<Option<Vec<_>>>()?;
            Some(BuiltSample { grains, column: None, cell: None })
        }
        Sample::Bodies(_) => {
            let allowed = "grains: Column, Cylinder, Cell, Grains or File";
            problems.add("sample", "Bodies", allowed, "bodies by their outlines are for a continuum");
            None
        }
        Sample::File { .. } => saved::of_file(sample, folder, materials, problems),
    }
}

fn grain<D: Dim>(
    index: usize,
    spec: &GrainSpec,
    materials: &NamedMaterials,
    problems: &mut Problems,
) -> Option<Grain<D>> {
    let path = format!("sample.Grains.{index}");
    let material = materials.find(&format!("{path}.material"), &spec.material, problems);
    let position = problems.vector::<D, _>(&format!("{path}.position"), &spec.position);
    let velocity = if spec.velocity.is_empty() {
        Some(D::Vec::ZERO)
    } else {
        problems.vector::<D, _>(&format!("{path}.velocity"), &spec.velocity)
    };
    let spin: Vec<f64> = spec.spin.iter().map(|value| value.value()).collect();
    let spin = match (D::N, spin.as_slice()) {
        (_, []) => D::Spin::ZERO,
        (2, [z]) => D::Spin::about_z(*z),
        (3, [x, y, z]) => D::Spin::of_components([*x, *y, *z]),
        _ => {
            let allowed = if D::N == 2 { "one value, about z" } else { "three values" };
            problems.add(format!("{path}.spin"), format!("a list of {}", spin.len()), allowed, "");
            return None;
        }
    };
    if spec.radius.value() <= 0.0 {
        problems.add(format!("{path}.radius"), spec.radius, "a positive length", "");
        return None;
    }
    Some(Grain::at(position?, spec.radius.value(), material?).moving(velocity?).turning(spin))
}

/// A column before its grains are placed.
struct Column<'a> {
    outline: Outline,
    grading: &'a GradingSpec,
    packing: PackingSpec,
}

impl<'a> Column<'a> {
    fn of<D: Dim>(sample: &'a Sample, problems: &mut Problems) -> Option<Self> {
        let before = problems.0.len();
        let outline = Outline::of::<D>(sample, problems);
        let (grading, packing) = grains_of(sample, problems)?;
        if packing == PackingSpec::Ballistic && D::N == 3 {
            problems.add("sample.packing", "Ballistic", "Loose or Hexagonal in space", "");
        }
        check_sizes(packing, grading, problems);
        let column = Self { outline: outline?, grading, packing };
        (problems.0.len() == before).then_some(column)
    }

    fn build<D: Dim>(&self, material: MaterialId, problems: &mut Problems) -> Option<BuiltSample<D>> {
        match self.place::<D>() {
            Ok((radii, positions, column)) => {
                let pairs = positions.into_iter().zip(radii);
                let grains = pairs.map(|(position, radius)| Grain::at(position, radius, material)).collect();
                Some(BuiltSample { grains, column: Some(column), cell: None })
            }
            Err(Refusal { path, value, allowed }) => {
                problems.add(path, value, allowed, "");
                None
            }
        }
    }

    /// Radii, places and the size of the column.
    #[allow(clippy::type_complexity)]
    fn place<D: Dim>(&self) -> Result<(Vec<f64>, Vec<D::Vec>, ColumnSize), Refusal> {
        let grading = grading_of(self.grading);
        let outline = &self.outline;
        let count = count_of::<D>(outline, &grading)?;
        let radii = grading.sample::<D>(count, outline.seed)?;
        let width = outline.given_width().unwrap_or_else(|| outline.width_for::<D>(volume::<D>(&radii)));
        let size = outline.size::<D>(width);
        let (radii, positions) = match self.packing {
            PackingSpec::Ballistic => self.level_deposit::<D>(&grading, count, size)?,
            PackingSpec::Hexagonal => {
                let depth = size.depth.map_or(D::Vec::ZERO, |depth| D::Vec::along(1, depth));
                let high = D::Vec::along(0, size.width) + depth + D::Vec::along(D::UP, size.height);
                let sites = Lattice::Hexagonal.fill::<D>(radii[0], D::Vec::ZERO, high);
                let sites = sites?;
                (vec![radii[0]; sites.len()], sites)
            }
            PackingSpec::Loose => {
                let base: Vec<f64> = std::iter::once(size.width).chain(size.depth).collect();
                let sites = loose_lattice::<D>(&radii, D::Vec::ZERO, &base, LOOSE_GAP, self.outline.seed);
                (radii, sites?)
            }
        };
        Ok((radii, positions, size))
    }

    /// The lowest `count` disks of a larger ballistic deposit: its rough surface is taken off.
    fn level_deposit<D: Dim>(
        &self,
        grading: &Grading,
        count: usize,
        size: ColumnSize,
    ) -> Result<(Vec<f64>, Vec<D::Vec>), Refusal> {
        let more = (count as f64 / (1.0 - TAKEN_OFF)).ceil() as usize;
        let radii = grading.sample::<D>(more, self.outline.seed)?;
        let deposit = ballistic(&radii, size.width, Sides::Walls, self.outline.seed)?;
        let mut order: Vec<usize> = (0..more).collect();
        let top = |&index: &usize| deposit.positions[index].y + radii[index];
        order.sort_by(|a, b| top(a).total_cmp(&top(b)));
        order.truncate(count);
        order.sort_unstable();
        let place = |index: &usize| {
            let position = deposit.positions[*index];
            D::Vec::along(0, position.x) + D::Vec::along(1, position.y)
        };
        Ok((order.iter().map(|&index| radii[index]).collect(), order.iter().map(place).collect()))
    }
}

/// Number of grains of a column or cylinder.
fn count_of<D: Dim>(outline: &Outline, grading: &Grading) -> Result<usize, Refusal> {
    let count = match (outline.extent, outline.given_width()) {
        (Extent::Width(_), Some(width)) => {
            let probe = grading.sample::<D>(1000, outline.seed)?;
            let mean = volume::<D>(&probe) / probe.len() as f64;
            let solid = outline.solid::<D>() * outline.shape::<D>();
            (solid * width.powi(D::N as i32) / mean).round().max(1.0)
        }
        (Extent::Grains(count), _) => count as f64,
        (Extent::Width(_), None) => f64::NAN,
    };
    refuse_many::<D>(count).map_err(|allowed| {
        let what = if outline.round.is_some() { "cylinder" } else { "column" };
        let value = format!("a {what} of {count:.0} grains");
        Refusal { path: "sample.extent", value, allowed }
    })?;
    Ok(count as usize)
}

/// The sizes and the packing of grains, which other methods need not have.
fn grains_of<'a>(sample: &'a Sample, problems: &mut Problems) -> Option<(&'a GradingSpec, PackingSpec)> {
    let (Sample::Column { grading, packing, .. } | Sample::Cylinder { grading, packing, .. }) = sample else {
        return None;
    };
    if grading.is_none() {
        let allowed = "sizes of the grains, such as Single(\"1 mm\")";
        problems.add("sample.grading", "missing", allowed, "only a continuum needs none");
    }
    if packing.is_none() {
        let allowed = "Ballistic, Hexagonal or Loose";
        problems.add("sample.packing", "missing", allowed, "only a continuum needs none");
    }
    grading.as_ref().zip(*packing)
}

/// Refuses more grains than anybody means, or than the memory of this machine holds; says what is allowed.
pub(crate) fn refuse_many<D: Dim>(count: f64) -> Result<(), String> {
    if count > MOST_GRAINS {
        return Err(format!("at most {MOST_GRAINS:e} grains"));
    }
    machine::room_for(count, BYTES_PER_GRAIN[D::N - 2])
}

/// Checks a grading, and that the packing can hold it.
fn check_sizes(packing: PackingSpec, grading: &GradingSpec, problems: &mut Problems) {
    if packing == PackingSpec::Hexagonal && !matches!(grading, GradingSpec::Single(_)) {
        problems.add("sample.packing", "Hexagonal", "a grading of one size: Single(\"1 mm\")", "");
    }
    check_grading(grading, problems);
}

/// Why a column cannot be filled.
struct Refusal {
    path: &'static str,
    value: String,
    allowed: String,
}

impl From<GradingError> for Refusal {
    fn from(error: GradingError) -> Self {
        let value = format!("a grading whose {} is {}", error.what, error.value);
        Self { path: "sample.grading", value, allowed: error.allowed }
    }
}

impl From<PackingError> for Refusal {
    fn from(error: PackingError) -> Self {
        match error {
            PackingError::OutOfRange { what, value, allowed } if what.starts_with("edge") => {
                let value = format!("too narrow a sample: an edge of its base is {value} m");
                Self { path: "sample.extent", value, allowed }
            }
            PackingError::OutOfRange { what, value, allowed } if what.starts_with("width") => {
                let value = format!("too narrow a column: its width is {value} m");
                Self { path: "sample.extent", value, allowed }
            }
            PackingError::OutOfRange { what, value, allowed } => {
                let value = format!("a sample that cannot be filled: {what} is {value}");
                Self { path: "sample", value, allowed }
            }
            other => {
                let value = format!("a sample that cannot be filled: {other}");
                Self { path: "sample", value, allowed: "a wider column or another seed".to_owned() }
            }
        }
    }
}
