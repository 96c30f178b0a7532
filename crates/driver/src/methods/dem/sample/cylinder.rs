//! Grains in a cylinder that stands on the floor.

use super::super::region::Region;
use super::{BuiltSample, LOOSE_GAP, Refusal, check_sizes, count_of, grains_of};
use crate::column::{ColumnSize, Outline, Round, grading_of, volume};
use crate::problems::Problems;
use crate::scene::{GradingSpec, PackingSpec, Sample};
use granular_core::{Dim, Linear, Vector};
use granular_dem::{Grain, MaterialId};
use granular_packing::{Lattice, loose_lattice};

/// A cylinder before its grains are placed.
struct Cylinder<'a> {
    outline: Outline,
    round: Round,
    grading: &'a GradingSpec,
    packing: PackingSpec,
}

/// The cylinder of a scene, or what is wrong with it.
pub(super) fn build<D: Dim>(
    sample: &Sample,
    material: Option<MaterialId>,
    problems: &mut Problems,
) -> Option<BuiltSample<D>> {
    let before = problems.0.len();
    let outline = Outline::of::<D>(sample, problems);
    let (grading, packing) = grains_of(sample, problems)?;
    if packing == PackingSpec::Ballistic {
        problems.add("sample.packing", "Ballistic", "Loose or Hexagonal in space", "");
    }
    check_sizes(packing, grading, problems);
    if problems.0.len() > before {
        return None;
    }
    let outline = outline?;
    let cylinder = Cylinder { round: outline.round?, outline, grading, packing };
    match cylinder.place::<D>(material?) {
        Ok(built) => Some(built),
        Err(Refusal { path, value, allowed }) => {
            problems.add(path, value, allowed, "");
            None
        }
    }
}

impl Cylinder<'_> {
    fn place<D: Dim>(&self, material: MaterialId) -> Result<BuiltSample<D>, Refusal> {
        let grading = grading_of(self.grading);
        let hexagonal = self.packing == PackingSpec::Hexagonal;
        let outline = &self.outline;
        let count = count_of::<D>(outline, &grading)?;
        let mut radii = grading.sample::<D>(count, outline.seed)?;
        let radius = outline.given_width().unwrap_or_else(|| outline.width_for::<D>(volume::<D>(&radii)));
        let size = outline.size::<D>(radius);
        let sites =
            if hexagonal { self.lattice::<D>(size, radii[0])? } else { self.loose::<D>(size, &radii)? };
        radii.resize(sites.len(), radii[0]);
        let grains = sites.into_iter().zip(radii).map(|(site, radius)| Grain::at(site, radius, material));
        Ok(BuiltSample { grains: grains.collect(), column: Some(size), cell: None })
    }

    /// Lowest corner of the box around the cylinder \[m\].
    fn corner<D: Dim>(&self, size: ColumnSize) -> D::Vec {
        let across = D::Vec::along(0, -size.width);
        if self.round == Round::Half { across } else { across + D::Vec::along(1, -size.width) }
    }

    /// Whether a ball is inside, however high it is.
    fn holds<D: Dim>(&self, size: ColumnSize, site: D::Vec, radius: f64) -> bool {
        let (from, axis) = (D::Vec::ZERO, D::Vec::along(D::UP, 1.0));
        let cylinder = Region::<D>::Cylinder { from, axis, length: f64::INFINITY, radius: size.width };
        let half = Region::<D>::HalfSpace { point: D::Vec::ZERO, normal: D::Vec::along(1, 1.0) };
        cylinder.holds(site, radius) && (self.round == Round::Whole || half.holds(site, radius))
    }

    /// Sites of a hexagonal lattice inside.
    fn lattice<D: Dim>(&self, size: ColumnSize, radius: f64) -> Result<Vec<D::Vec>, Refusal> {
        let across = D::Vec::along(0, size.width) + D::Vec::along(1, size.width);
        let high = across + D::Vec::along(D::UP, size.height);
        let mut sites = Lattice::Hexagonal.fill::<D>(radius, self.corner::<D>(size), high)?;
        sites.retain(|&site| self.holds::<D>(size, site, radius));
        if sites.is_empty() { Err(narrow(size)) } else { Ok(sites) }
    }

    /// As many sites of a loose lattice inside as there are grains, from the floor up.
    fn loose<D: Dim>(&self, size: ColumnSize, radii: &[f64]) -> Result<Vec<D::Vec>, Refusal> {
        let largest = radii.iter().copied().fold(0.0, f64::max);
        let depth = if self.round == Round::Half { size.width } else { 2.0 * size.width };
        let mut count = 2 * radii.len();
        loop {
            let balls = vec![largest; count];
            let (low, base) = (self.corner::<D>(size), [2.0 * size.width, depth]);
            let mut sites = loose_lattice::<D>(&balls, low, &base, LOOSE_GAP, self.outline.seed)?;
            sites.retain(|&site| self.holds::<D>(size, site, largest));
            if sites.len() >= radii.len() {
                sites.truncate(radii.len());
                return Ok(sites);
            }
            // A quarter of a square is outside the circle; where far more is, nothing fits in.
            if count > 64 * radii.len() {
                return Err(narrow(size));
            }
            count *= 2;
        }
    }
}

fn narrow(size: ColumnSize) -> Refusal {
    let value = format!("too narrow a cylinder: its radius is {} m", size.width);
    Refusal { path: "sample.extent", value, allowed: "a radius of several grains".to_owned() }
}
