//! Columns and cylinders before anything is in them.

use super::{ColumnSize, Round};
use crate::problems::Problems;
use crate::scene::{Extent, GradingSpec, PackingSpec, Sample};
use core::f64::consts::PI;
use granular_core::Dim;
use granular_packing::{Grading, GradingError, Lattice};

/// Solid fraction that a deposit comes to rest at, to estimate sizes: plane and space.
const SETTLED: [f64; 2] = [0.815, 0.60];

/// A column or cylinder of a scene before anything is in it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Outline {
    pub(crate) extent: Extent,
    aspect_ratio: f64,
    depth_ratio: Option<f64>,
    pub(crate) round: Option<Round>,
    pub(crate) packing: Option<PackingSpec>,
    pub(crate) seed: u64,
}

impl Outline {
    /// The outline of a sample that is a column or cylinder. None where it is neither, or when there are problems.
    pub(crate) fn of<D: Dim>(sample: &Sample, problems: &mut Problems) -> Option<Self> {
        let before = problems.0.len();
        let outline = match sample {
            Sample::Column { extent, aspect_ratio, depth_ratio, packing, seed, .. } => Self {
                extent: *extent,
                aspect_ratio: *aspect_ratio,
                depth_ratio: *depth_ratio,
                round: None,
                packing: *packing,
                seed: *seed,
            },
            Sample::Cylinder { extent, aspect_ratio, half, packing, seed, .. } => Self {
                extent: *extent,
                aspect_ratio: *aspect_ratio,
                depth_ratio: None,
                round: Some(if *half { Round::Half } else { Round::Whole }),
                packing: *packing,
                seed: *seed,
            },
            _ => return None,
        };
        outline.check::<D>(problems);
        (problems.0.len() == before).then_some(outline)
    }

    fn check<D: Dim>(&self, problems: &mut Problems) {
        let what = if self.round.is_some() { "cylinder" } else { "column" };
        if self.round.is_some() && D::N == 2 {
            problems.add("sample", "Cylinder", "a scene in space", "in the plane write a Column");
        }
        let positive = |value: f64| value > 0.0 && value.is_finite();
        if !positive(self.aspect_ratio) {
            problems.add("sample.aspect_ratio", self.aspect_ratio, "a positive number", "");
        }
        match (D::N, self.depth_ratio) {
            (2, Some(ratio)) => problems.add("sample.depth_ratio", ratio, "nothing: the scene is plane", ""),
            (3, None) if self.round.is_none() => {
                problems.add("sample.depth_ratio", "missing", "a positive number", "");
            }
            (_, Some(ratio)) if !positive(ratio) => {
                problems.add("sample.depth_ratio", ratio, "a positive number", "");
            }
            _ => {}
        }
        match self.extent {
            Extent::Grains(0) => {
                problems.add("sample.extent", format!("a {what} of 0 grains"), "at least one grain", "");
            }
            Extent::Width(width) if width.value() <= 0.0 => {
                problems.add("sample.extent", width, "a positive length", "");
            }
            _ => {}
        }
    }

    /// Volume of the column over its width (of a cylinder: its radius) to the power of the dimension.
    pub(crate) fn shape<D: Dim>(&self) -> f64 {
        match self.round {
            Some(Round::Whole) => PI * self.aspect_ratio,
            Some(Round::Half) => 0.5 * PI * self.aspect_ratio,
            None if D::N == 3 => self.aspect_ratio * self.depth_ratio.unwrap_or(1.0),
            None => self.aspect_ratio,
        }
    }

    /// Share of the volume that grains fill once they are at rest.
    pub(crate) fn solid<D: Dim>(&self) -> f64 {
        match self.packing {
            Some(PackingSpec::Hexagonal) => Lattice::Hexagonal.density::<D>(),
            _ => SETTLED[D::N - 2],
        }
    }

    /// Width \[m\] (of a cylinder: its radius) that was asked for.
    pub(crate) fn given_width(&self) -> Option<f64> {
        match self.extent {
            Extent::Width(width) => Some(width.value() * if self.round.is_some() { 0.5 } else { 1.0 }),
            Extent::Grains(_) => None,
        }
    }

    /// Width that grains of this volume \[m^D\] fill.
    pub(crate) fn width_for<D: Dim>(&self, volume: f64) -> f64 {
        (volume / (self.solid::<D>() * self.shape::<D>())).powf(1.0 / D::N as f64)
    }

    /// Size of the column at a width.
    pub(crate) fn size<D: Dim>(&self, width: f64) -> ColumnSize {
        let depth = (D::N == 3 && self.round.is_none()).then(|| self.depth_ratio.unwrap_or(1.0) * width);
        ColumnSize { width, height: self.aspect_ratio * width, depth, round: self.round }
    }
}

/// Volume of grains \[m^D\].
pub(crate) fn volume<D: Dim>(radii: &[f64]) -> f64 {
    radii.iter().map(|&radius| D::ball_volume(radius)).sum()
}

/// The grading of a scene.
pub(crate) fn grading_of(spec: &GradingSpec) -> Grading {
    match *spec {
        GradingSpec::Single(diameter) => Grading::Single { diameter: diameter.value() },
        GradingSpec::Beta { min, max, a, b } => Grading::Beta { min: min.value(), max: max.value(), a, b },
        GradingSpec::EqualMass { min, max } => Grading::EqualMass { min: min.value(), max: max.value() },
    }
}

/// Says of a grading that it cannot be.
pub(crate) fn check_grading(spec: &GradingSpec, problems: &mut Problems) {
    let Err(GradingError { what, value, allowed, .. }) = grading_of(spec).check() else { return };
    let key = match what {
        what if what.starts_with("smallest") => ".min",
        what if what.starts_with("largest") => ".max",
        _ => "",
    };
    let key = if matches!(spec, GradingSpec::Single(_)) { "" } else { key };
    let value =
        if key.is_empty() { format!("a grading whose {what} is {value}") } else { format!("{value} m") };
    problems.add(format!("sample.grading{key}"), value, allowed, "");
}
