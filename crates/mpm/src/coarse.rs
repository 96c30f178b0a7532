//! Particles averaged over the cells of a grid, see [`granular_core::coarse`].

use crate::mpm::Mpm;
use granular_core::coarse::{CoarseFields, CoarseGrid, CoarseSource, Constituents, Sizes};
use granular_core::{Dim, FieldSink};

impl<D: Dim> Mpm<D> {
    /// Shows fields on a grid; sums only what the sink wants, and nothing when it wants none. With `grains` there are a solid
    /// fraction and an inertial number; [`CoarseFields::catalogue_of_continuum`] lists all.
    pub fn show_coarse(&self, grid: &CoarseGrid<D>, grains: Option<Constituents>, sink: &mut dyn FieldSink) {
        CoarseFields::show_of(|| self.coarse_source(grains), grid, sink);
    }

    fn coarse_source(&self, constituents: Option<Constituents>) -> CoarseSource<'_, D> {
        CoarseSource {
            position: &self.particles.position,
            velocity: (&*self.particles.velocity).into(),
            mass: &self.particles.mass,
            size: Sizes::Volumes(&self.particles.volume),
            periods: None,
            // Positive in compression on grids.
            stress: (0..self.len()).map(|k| self.particles.stress(k) * -1.0).collect(),
            constituents,
            visit_branches: &|_| {},
            longest_branch: 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Mpm2, Particle, Setup};
    use granular_constitutive::LinearElastic;
    use granular_core::{D2, FieldRef, SymmetricTensor, glam::DVec2};
    use std::collections::BTreeMap;

    /// Fields of numbers.
    #[derive(Default)]
    struct Scalars(BTreeMap<String, Vec<f64>>);

    impl FieldSink for Scalars {
        fn wants(&self, _: &str) -> bool {
            true
        }
        fn number(&mut self, name: &str, _: &str, value: f64) {
            self.0.insert(name.to_owned(), vec![value]);
        }
        fn field(&mut self, name: &str, _: &str, values: FieldRef<'_>) {
            if let FieldRef::Scalar(values) = values {
                self.0.insert(name.to_owned(), values.to_vec());
            }
        }
    }

    /// A block of 1000 kg/m^3 under 1 kPa, of grains of 2500 kg/m^3 and 1 mm.
    #[test]
    fn a_pressed_block_shows_its_density_its_pressure_and_its_grains() {
        let mut mpm = Mpm2::new(Setup::new(0.1)).unwrap();
        let mut block = Particle::<D2>::filling(DVec2::ZERO, DVec2::splat(1.0), 0.05);
        let rate = 0.3;
        for particle in &mut block {
            particle.stress = SymmetricTensor::IDENTITY * -1000.0;
            particle.velocity = DVec2::new(rate * particle.position.y, 0.0);
        }
        mpm.body(LinearElastic::new(1e5, 0.2).unwrap(), 1000.0, &block).unwrap();
        let grid = CoarseGrid::<D2>::new(DVec2::ZERO, DVec2::splat(1.0), 0.1, 1).unwrap();
        let grains = Constituents { density: 2500.0, diameter: 1e-3 };
        let mut shown = Scalars::default();
        mpm.show_coarse(&grid, Some(grains), &mut shown);
        // In the middle the kernels reach no side.
        let middle = |name: &str| shown.0[name][55];
        let near = |found: f64, value: f64| assert!((found - value).abs() < 1e-9 * value, "{found} {value}");
        near(middle("density"), 1000.0);
        near(middle("solid_fraction"), 0.4);
        near(middle("mean_diameter"), 1e-3);
        near(middle("shear_rate"), rate);
        let spread = middle("granular_temperature") * 1000.0;
        near(middle("pressure"), 1000.0 + spread);
        near(middle("inertial_number"), rate * 1e-3 * (2500.0 / (1000.0 + spread)).sqrt());
        assert!(!shown.0.contains_key("coordination"));
        let mut unknown = Scalars::default();
        mpm.show_coarse(&grid, None, &mut unknown);
        assert!(!unknown.0.contains_key("inertial_number") && unknown.0.contains_key("pressure"));
    }
}
