//! Fields of a continuum from grains, see [`granular_core::coarse`].
//!
//! ```
//! use granular_core::glam::DVec2;
//! use granular_dem::{CoarseGrid, Dem2, Grain, Material, Materials, Options, Setup};
//!
//! let mut materials = Materials::new();
//! let glass = materials.add(Material::default())?;
//! let grain = Grain::at(DVec2::new(0.0123, 0.0045), 1e-3, glass).moving(DVec2::X);
//! let gravity = DVec2::ZERO;
//! let dem = Dem2::new(Setup { materials, grains: vec![grain], walls: vec![], gravity, options: Options::default() })?;
//! let grid = CoarseGrid::new(DVec2::ZERO, DVec2::splat(0.02), 1e-3, 2)?;
//! let fields = dem.coarse_fields(&grid);
//! let mass: f64 = fields.density().iter().map(|density| density * grid.cell_volume()).sum();
//! assert!((mass / (2650.0 * std::f64::consts::PI * 1e-6) - 1.0).abs() < 1e-14);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use crate::contact::{Contact, Partner};
use crate::dem::Dem;
use granular_core::coarse::{
    CoarseFields, CoarseGrid, CoarseSource, ForceBranch, Periods, Sizes, VisitBranches,
};
use granular_core::{Dim, FieldSink, Shown};
use std::borrow::Cow;

impl<D: Dim> Dem<D> {
    /// All fields on a grid.
    pub fn coarse_fields(&self, grid: &CoarseGrid<D>) -> CoarseFields<D> {
        CoarseFields::of(&self.coarse_source(&|visit| self.visit_branches(visit)), grid)
    }

    /// Shows fields on a grid; sums only what the sink wants, and nothing when it wants none.
    pub fn show_coarse(&self, grid: &CoarseGrid<D>, sink: &mut dyn FieldSink) {
        let branches = |visit: &mut dyn FnMut(ForceBranch<D>)| self.visit_branches(visit);
        CoarseFields::show_of(|| self.coarse_source(&branches), grid, sink);
    }

    /// Everything that [`Dem::show_coarse`] can show.
    pub fn coarse_catalogue() -> Vec<Shown> {
        CoarseFields::<D>::catalogue()
    }

    fn coarse_source<'a>(&'a self, visit_branches: &'a VisitBranches<'a, D>) -> CoarseSource<'a, D> {
        let grains = &self.grains;
        CoarseSource {
            position: &grains.position,
            velocity: self.laboratory_velocities().map_or(Cow::Borrowed(&grains.velocity), Cow::Owned),
            mass: &grains.mass,
            size: Sizes::Radii(&grains.radius),
            periods: self.cell().map(|cell| Periods {
                edges: *cell.edges(),
                is_periodic: std::array::from_fn(|axis| axis < D::N && cell.is_periodic(axis)),
                gradient: *cell.gradient(),
            }),
            stress: Cow::Borrowed(&[]),
            constituents: None,
            visit_branches,
            longest_branch: 2.0 * grains.radius_range().1,
        }
    }

    fn visit_branches(&self, visit: &mut dyn FnMut(ForceBranch<D>)) {
        self.visit_contacts(&mut |contact: Contact<D>| {
            let Contact { first, normal, force, overlap, .. } = contact;
            let radius = self.grains.radius[first];
            let (length, second) = match contact.partner {
                Partner::Grain(second) => (radius + self.grains.radius[second] - overlap, Some(second)),
                // The point of contact lies on the wall, which does not give way.
                Partner::Wall(_) => (radius - overlap, None),
            };
            visit(ForceBranch { first, second, normal, length, force });
        });
    }
}
