//! Profiles of a collapsing cylinder over the distance from its axis.

use super::{Units, title};
use crate::column::ColumnSize;
use crate::failure::Failure;
use crate::records::StageRecord;
use crate::scene::Scene;
use crate::scene::outputs::LawSpec;
use core::f64::consts::TAU;
use granular_io::figure::{Axis, Chart, Series, Style};
use granular_io::vtk::{Points, read_vtp};
use std::path::PathBuf;

/// Sectors about the axis.
const SECTORS: usize = 12;

/// The surface at several times, with the edges and heights of laws.
pub(super) fn profile(
    scene: &Scene,
    files: &[PathBuf],
    release: &StageRecord,
    (column, laws): (Option<ColumnSize>, &[LawSpec]),
    units: Units,
) -> Result<Chart, Failure> {
    let unit = column.map_or(release.front, |column| column.width);
    let axes = [Axis::linear("distance from the axis, r / r₀ [-]"), Axis::linear("height, h / r₀ [-]")];
    let [x, y] = axes;
    let mut chart = Chart::new(title(scene, "profiles"), x, y);
    for file in files {
        let frame = read_vtp(file)?;
        let points = surface(&frame).into_iter().map(|[r, h]| [r / unit, h / unit]).collect();
        chart = chart.with(Series::new(units.label(frame.time), points, Style::Line));
    }
    let aspect = release.height / unit;
    for law in laws {
        let value = law.at(aspect);
        // A height stands on the axis, an edge on the floor.
        let at = if law.of_height { [0.0, value] } else { [1.0 + value, 0.0] };
        chart = chart.with(Series::new(law.label.clone(), vec![at], Style::Markers).colour(7));
    }
    Ok(chart)
}

/// Distance from the axis and height of the surface, ring by ring.
fn surface(frame: &Points) -> Vec<[f64; 2]> {
    let radii = frame.magnitude("radius").unwrap_or_default();
    let ring = 2.0 * radii.iter().sum::<f64>() / radii.len().max(1) as f64;
    let mut highest: Vec<[f64; SECTORS]> = Vec::new();
    let mut met = [false; SECTORS];
    for ([x, y, z], radius) in frame.points.iter().zip(&radii) {
        let index = (x.hypot(*y) / ring) as usize;
        let sector = (((y.atan2(*x) / TAU + 0.5) * SECTORS as f64) as usize).min(SECTORS - 1);
        if highest.len() <= index {
            highest.resize(index + 1, [0.0; SECTORS]);
        }
        highest[index][sector] = highest[index][sector].max(z + radius);
        met[sector] = true;
    }
    // Half a cylinder leaves half of the sectors empty.
    let count = met.iter().filter(|met| **met).count().max(1) as f64;
    // Sectors of the innermost rings are narrower than a grain: there the highest point of the ring stands for all.
    let mean = |index: usize, heights: &[f64; SECTORS]| {
        if TAU * (index as f64 + 0.5) < SECTORS as f64 {
            heights.iter().copied().fold(0.0, f64::max)
        } else {
            heights.iter().sum::<f64>() / count
        }
    };
    let rings = highest.iter().enumerate();
    rings.map(|(index, heights)| [(index as f64 + 0.5) * ring, mean(index, heights)]).collect()
}
