//! Grains that another scene prepared: cut, shifted, and given the materials of this scene.

use super::super::materials::NamedMaterials;
use super::super::region::Region;
use super::super::sample_file::{BadSample, SavedSample};
use super::BuiltSample;
use crate::column::ColumnSize;
use crate::problems::Problems;
use crate::scene::Sample;
use granular_core::{Dim, Linear, Vector};
use granular_dem::{Grain, MaterialId};
use std::path::Path;

/// Part of the width of a column by which its corner may miss the origin: round-off of a shift.
const CORNER: f64 = 1e-9;

/// The grains of a file, or what is wrong with it.
pub(super) fn of_file<D: Dim>(
    sample: &Sample,
    folder: &Path,
    materials: &NamedMaterials,
    problems: &mut Problems,
) -> Option<BuiltSample<D>> {
    let Sample::File { path, cut, shift, moving } = sample else { return None };
    let regions: Vec<Option<Region<D>>> = cut
        .iter()
        .enumerate()
        .map(|(k, spec)| Region::of(&format!("sample.cut.{k}"), spec, problems))
        .collect();
    let offset =
        if shift.is_empty() { Some(D::Vec::ZERO) } else { problems.vector::<D, _>("sample.shift", shift) };
    let saved = match SavedSample::<D>::read(&folder.join(path)) {
        Ok(saved) => saved,
        Err(BadSample { value, allowed }) => {
            problems.add("sample.path", value, allowed, "");
            return None;
        }
    };
    let ids: Vec<Option<MaterialId>> =
        saved.materials.iter().map(|name| materials.find("sample.path", name, problems)).collect();
    let ids = ids.into_iter().collect::<Option<Vec<_>>>()?;
    let (regions, offset) = (regions.into_iter().collect::<Option<Vec<_>>>()?, offset?);
    let inside = |grain: &Grain<D>| regions.iter().all(|region| region.holds(grain.position, grain.radius));
    let grains: Vec<Grain<D>> = saved
        .grains
        .into_iter()
        .filter(inside)
        .map(|grain| {
            let position = if shift.is_empty() { grain.position } else { grain.position + offset };
            let placed = Grain::at(position, grain.radius, ids[grain.material.index()]);
            if *moving { placed.moving(grain.velocity).turning(grain.spin) } else { placed }
        })
        .collect();
    if grains.is_empty() {
        problems.add("sample.cut", "regions without a grain", "regions that hold grains of the file", "");
        return None;
    }
    let whole = cut.is_empty() && shift.is_empty();
    let column = if whole { saved.column } else { regions.iter().find_map(|region| column(region, offset)) };
    Some(BuiltSample { grains, column, cell: None })
}

/// The column that a cut makes: a box with its lowest corner at the origin.
fn column<D: Dim>(region: &Region<D>, offset: D::Vec) -> Option<ColumnSize> {
    let Region::Box { low, high } = *region else { return None };
    let size = high - low;
    let (width, height) = (size.component(0), size.component(D::UP));
    let depth = (D::N == 3).then(|| size.component(1));
    ((low + offset).length() <= CORNER * width).then_some(ColumnSize { width, height, depth, round: None })
}

#[cfg(test)]
mod tests;
