//! Coarse graining: what is conserved, the balances, closed forms, bits, and that it costs nothing unless asked for.

use crate::sample::{Lattice, down, free};
use granular_core::testing::CountingAllocator;
use granular_core::{D2, D3, Dim, FieldRef, FieldSink, Linear, Solver, Spin, SymmetricTensor, Vector};
use granular_dem::{CoarseGrid, Dem, Grain, Material, Materials, Options, Partner, Setup, Wall};

/// Grains in motion under gravity between walls, many of them in touch.
fn moving<D: Dim>(side: usize) -> Dem<D> {
    rubbing(side, Material::default().friction)
}

fn rubbing<D: Dim>(side: usize, friction: f64) -> Dem<D> {
    let mut materials = Materials::new();
    let glass = materials.add(Material { normal_stiffness: 1e4, friction, ..Material::default() }).unwrap();
    let lattice = Lattice { side, radii: (0.48e-3, 0.51e-3), speed: 0.1, ..Lattice::default() };
    let (grains, walls) = (lattice.grains::<D>(&[glass]), lattice.walls::<D>(glass));
    let (gravity, options) = (down::<D>(9.81), Options::default());
    Dem::new(Setup { materials, grains, walls, gravity, options }).unwrap()
}

fn everywhere<D: Dim>(length: f64) -> D::Vec {
    (0..D::N).fold(D::Vec::ZERO, |sum, axis| sum + D::Vec::along(axis, length))
}

/// A grid that holds a lattice of so many grains with all that the kernel spreads.
fn around<D: Dim>(side: usize, spacing: f64, width: usize) -> CoarseGrid<D> {
    let margin = 3.0 * spacing * width as f64;
    let high = everywhere::<D>(1e-3 * side as f64 + margin);
    CoarseGrid::new(everywhere::<D>(-margin), high, spacing, width).unwrap()
}

fn total_mass<D: Dim>(dem: &Dem<D>) -> f64 {
    dem.grains().map(|(_, g)| 2650.0 * D::ball_volume(g.radius)).sum()
}

#[test]
fn mass_momentum_volume_and_number_in_cells_are_those_of_the_grains() {
    fn check<D: Dim>(side: usize) {
        let mut dem = moving::<D>(side);
        dem.advance(dem.recommended_step(), 50).unwrap();
        for (spacing, width) in [(0.4e-3, 1), (1e-3, 1), (1.7e-3, 1), (0.7e-3, 2)] {
            let grid = around::<D>(side, spacing, width);
            let fields = dem.coarse_fields(&grid);
            assert_eq!(fields.mass_outside(), 0.0);
            let sum = |values: Vec<f64>| values.iter().sum::<f64>() * grid.cell_volume();
            let mass = total_mass(&dem);
            assert!((sum(fields.density()) / mass - 1.0).abs() < 1e-12);
            assert!((sum(fields.solid_fraction()) * 2650.0 / mass - 1.0).abs() < 1e-12);
            assert!((sum(fields.number_density()) / dem.len() as f64 - 1.0).abs() < 1e-12);
            let momentum = fields.momentum().into_iter().fold(D::Vec::ZERO, |sum, p| sum + p);
            let scale: f64 =
                dem.grains().map(|(_, g)| 2650.0 * D::ball_volume(g.radius) * g.velocity.length()).sum();
            let missed = momentum * grid.cell_volume() - dem.momentum();
            assert!(missed.length() < 1e-12 * scale, "{missed:?} of {scale:e}");
        }
    }
    check::<D2>(12);
    check::<D3>(5);
}

#[test]
fn what_is_spread_beyond_the_grid_is_told() {
    let dem = moving::<D3>(6);
    let grid = CoarseGrid::<D3>::new(everywhere::<D3>(1.3e-3), everywhere::<D3>(4e-3), 0.9e-3, 1).unwrap();
    let fields = dem.coarse_fields(&grid);
    let inside = fields.density().iter().sum::<f64>() * grid.cell_volume();
    assert!(fields.mass_outside() > 0.1 * total_mass(&dem));
    assert!(((inside + fields.mass_outside()) / total_mass(&dem) - 1.0).abs() < 1e-12);
}

/// The product of force and branch, summed over contacts, is in the cells: the integral along a branch is exact.
#[test]
fn stress_in_cells_is_that_of_the_contacts() {
    fn check<D: Dim>(side: usize) {
        let dem = moving::<D>(side);
        let mut expected = SymmetricTensor::ZERO;
        let radii: Vec<f64> = dem.grains().map(|(_, g)| g.radius).collect();
        dem.visit_contacts(&mut |contact| {
            let own = radii[contact.first];
            let length = match contact.partner {
                Partner::Grain(second) => own + radii[second] - contact.overlap,
                Partner::Wall(_) => own - contact.overlap,
            };
            let [force, arm] = [contact.force, contact.normal * length].map(|v| v.padded().into());
            expected += SymmetricTensor::dyad(force, arm);
        });
        for (spacing, width) in [(0.3e-3, 1), (1.1e-3, 1), (0.55e-3, 2)] {
            let grid = around::<D>(side, spacing, width);
            let stress = dem.coarse_fields(&grid).contact_stress();
            let mut found = SymmetricTensor::ZERO;
            stress.iter().for_each(|&stress| found += stress);
            let missed = found * grid.cell_volume() - expected;
            assert!(missed.contract(missed).sqrt() < 1e-12 * expected.trace(), "{missed:?}");
        }
    }
    check::<D2>(12);
    check::<D3>(5);
}

/// Derivative of a field along an axis at the centre of every cell, from grids that are shifted by a little.
fn derivative<D: Dim>(
    grid: &CoarseGrid<D>,
    size: f64,
    axis: usize,
    field: impl Fn(&CoarseGrid<D>) -> Vec<f64>,
) -> Vec<f64> {
    let step = 1e-4 * grid.spacing();
    let shifted = |sign: f64| {
        let low = grid.centre([0; 3]) - everywhere::<D>(0.5 * grid.spacing());
        let low = low + D::Vec::along(axis, sign * step);
        field(&CoarseGrid::new(low, low + everywhere::<D>(size), grid.spacing(), grid.width()).unwrap())
    };
    let (low, high) = (shifted(-1.0), shifted(1.0));
    low.iter().zip(&high).map(|(low, high)| (high - low) / (2.0 * step)).collect()
}

fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|value| value * value).sum::<f64>() / values.len() as f64).sqrt()
}

#[test]
fn mass_is_balanced_at_every_point() {
    fn check<D: Dim>(side: usize) {
        let at = |time: f64| {
            let mut materials = Materials::new();
            let glass = materials.add(Material::default()).unwrap();
            let lattice = Lattice { side, ..Lattice::default() };
            let mut grains = lattice.grains::<D>(&[glass]);
            grains.iter_mut().for_each(|grain| grain.position += grain.velocity * time);
            free::<D>(materials, grains, Options::default())
        };
        let size = 1e-3 * side as f64;
        let grid = CoarseGrid::<D>::new(D::Vec::ZERO, everywhere::<D>(size), 1e-3, 1).unwrap();
        let time = 1e-7;
        let [before, now, after] = [-time, 0.0, time].map(at);
        let (old, new) = (before.coarse_fields(&grid).density(), after.coarse_fields(&grid).density());
        let mut balance: Vec<f64> = old.iter().zip(&new).map(|(a, b)| (b - a) / (2.0 * time)).collect();
        let scale = rms(&balance);
        for axis in 0..D::N {
            let along = derivative(&grid, size, axis, |grid| {
                now.coarse_fields(grid).momentum().iter().map(|p| p.component(axis)).collect()
            });
            balance.iter_mut().zip(along).for_each(|(sum, part)| *sum += part);
        }
        assert!(rms(&balance) < 1e-6 * scale, "{:e} of {scale:e}", rms(&balance));
    }
    check::<D2>(8);
    check::<D3>(4);
}

/// The contact stress balances the force density: -div s_c + t = sum F w. The right side is the momentum of the same
/// grains with the velocity F/m.
#[test]
fn contact_stress_and_the_force_of_walls_balance_the_forces_at_every_point() {
    fn check<D: Dim>(side: usize) {
        // Without friction the stress is symmetric, and only a symmetric one is kept.
        let dem = rubbing::<D>(side, 0.0);
        let mut force = vec![D::Vec::ZERO; dem.len()];
        dem.visit_contacts(&mut |contact| {
            force[contact.first] += contact.force;
            if let Partner::Grain(second) = contact.partner {
                force[second] -= contact.force;
            }
        });
        let mut materials = Materials::new();
        let glass = materials.add(Material::default()).unwrap();
        let pushed = dem.grains().zip(&force).map(|((_, grain), &force)| {
            let mass = 2650.0 * D::ball_volume(grain.radius);
            Grain::at(grain.position, grain.radius, glass).moving(force * (1.0 / mass))
        });
        let pushed = free::<D>(materials, pushed.collect(), Options::default());
        let size = 1e-3 * side as f64;
        let grid = CoarseGrid::<D>::new(D::Vec::ZERO, everywhere::<D>(size), 0.8e-3, 1).unwrap();
        let (forces, walls) = (pushed.coarse_fields(&grid).momentum(), dem.coarse_fields(&grid).wall_force());
        for component in 0..D::N {
            let mut balance: Vec<f64> =
                walls.iter().zip(&forces).map(|(t, f)| (*t - *f).component(component)).collect();
            let scale = rms(&walls.iter().map(|t| t.component(component)).collect::<Vec<_>>());
            for axis in 0..D::N {
                let along = derivative(&grid, size, axis, |grid| {
                    let stress = dem.coarse_fields(grid).contact_stress();
                    stress.iter().map(|s| entry(s, axis, component)).collect()
                });
                balance.iter_mut().zip(along).for_each(|(sum, part)| *sum -= part);
            }
            assert!(rms(&balance) < 1e-6 * scale, "{:e} of {scale:e}", rms(&balance));
        }
    }
    check::<D2>(6);
    check::<D3>(4);
}

fn entry(tensor: &SymmetricTensor, a: usize, b: usize) -> f64 {
    let t = tensor;
    [[t.xx, t.xy, t.xz], [t.xy, t.yy, t.yz], [t.xz, t.yz, t.zz]][a][b]
}

/// A lattice of equal grains that move as `velocity` says, and the grid of its cells.
fn regular<D: Dim>(
    side: usize,
    width: usize,
    velocity: impl Fn(D::Vec, usize) -> D::Vec,
) -> (Dem<D>, CoarseGrid<D>) {
    let mut materials = Materials::new();
    let glass = materials.add(Material::default()).unwrap();
    let lattice = Lattice { side, jitter: 0.0, radii: (0.5e-3, 0.5e-3), ..Lattice::default() };
    let mut grains = lattice.grains::<D>(&[glass]);
    for (index, grain) in grains.iter_mut().enumerate() {
        grain.velocity = velocity(grain.position, index);
    }
    let dem = free::<D>(materials, grains, Options::default());
    (dem, CoarseGrid::new(D::Vec::ZERO, everywhere::<D>(1e-3 * side as f64), 1e-3, width).unwrap())
}

/// Cells whose kernel lies within the lattice.
fn inner<D: Dim>(grid: &CoarseGrid<D>, width: usize) -> Vec<usize> {
    let [nx, ny, _] = grid.cells();
    let fits = |index: usize| {
        let cell = [index % nx, index / nx % ny, index / (nx * ny)];
        (0..D::N).all(|axis| cell[axis] >= 2 * width && cell[axis] + 2 * width < grid.cells()[axis])
    };
    (0..grid.cells().iter().product()).filter(|&index| fits(index)).collect()
}

#[test]
fn a_lattice_that_shears_and_turns_has_the_gradient_of_its_motion() {
    fn check<D: Dim>(side: usize) {
        let (shear, turn) = (3.0, D::Spin::about_z(20.0));
        let velocity = |x: D::Vec, _| D::Vec::along(0, shear * x.component(1)) + D::turn(turn, x);
        let (dem, grid) = regular::<D>(side, 1, velocity);
        let fields = dem.coarse_fields(&grid);
        let (rates, strains, curls) = (fields.shear_rate(), fields.strain_rate(), fields.vorticity());
        let (speeds, heat) = (fields.velocity(), fields.granular_temperature());
        let cells = inner(&grid, 1);
        assert!(!cells.is_empty());
        for cell in cells {
            assert!((rates[cell] - shear).abs() < 1e-9);
            assert!((strains[cell].xy - 0.5 * shear).abs() < 1e-9 && strains[cell].xx.abs() < 1e-9);
            assert!((curls[cell].z() - (2.0 * 20.0 - shear)).abs() < 1e-8, "{:?}", curls[cell]);
            let [nx, ny, _] = grid.cells();
            let centre = grid.centre([cell % nx, cell / nx % ny, cell / (nx * ny)]);
            assert!((speeds[cell] - velocity(centre, 0)).length() < 1e-12);
            // The spread of velocities within the kernel, of variance 1/3 cell: part of every gradient.
            assert!(heat[cell] > 0.0);
        }
    }
    check::<D2>(8);
    check::<D3>(6);
}

#[test]
fn streams_against_one_another_are_heat_and_kinetic_stress() {
    let speed = 0.3;
    let (dem, grid) = regular::<D2>(14, 2, |_, index| {
        granular_core::glam::DVec2::Y * if index % 2 == 0 { speed } else { -speed }
    });
    let fields = dem.coarse_fields(&grid);
    let (heat, stress, density) = (fields.granular_temperature(), fields.kinetic_stress(), fields.density());
    let velocity = fields.velocity();
    for cell in inner(&grid, 2) {
        assert!(velocity[cell].length() < 1e-13);
        assert!((heat[cell] - 0.5 * speed * speed).abs() < 1e-13);
        assert!((stress[cell].yy / (density[cell] * speed * speed) - 1.0).abs() < 1e-12);
        assert!(stress[cell].xx.abs() < 1e-9 && stress[cell].xy.abs() < 1e-9);
        assert!((density[cell] / (2650.0 * std::f64::consts::FRAC_PI_4) - 1.0).abs() < 1e-12);
    }
}

#[test]
fn the_bits_are_the_same_for_any_number_of_threads() {
    fn bits<D: Dim>(side: usize, threads: usize) -> Vec<u64> {
        let dem = moving::<D>(side);
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let fields = pool.install(|| dem.coarse_fields(&around::<D>(side, 0.6e-3, 2)));
        let mut bits: Vec<u64> = fields.density().iter().map(|value| value.to_bits()).collect();
        bits.extend(fields.pressure().iter().map(|value| value.to_bits()));
        bits.extend(fields.inertial_number().iter().map(|value| value.to_bits()));
        bits.extend(fields.coordination().iter().map(|value| value.to_bits()));
        bits
    }
    for threads in [2, 3, 8] {
        assert_eq!(bits::<D2>(16, 1), bits::<D2>(16, threads));
        assert_eq!(bits::<D3>(5, 1), bits::<D3>(5, threads));
    }
}

/// Wants some names, and counts what it is shown.
struct Asks(&'static [&'static str], Vec<String>);

impl FieldSink for Asks {
    fn wants(&self, name: &str) -> bool {
        self.0.contains(&name)
    }
    fn field(&mut self, name: &str, _: &str, _: FieldRef<'_>) {
        self.1.push(name.to_owned());
    }
    fn number(&mut self, name: &str, _: &str, _: f64) {
        self.1.push(name.to_owned());
    }
}

#[test]
fn nothing_is_computed_unless_it_is_asked_for() {
    let dem = moving::<D2>(8);
    let grid = around::<D2>(8, 1e-3, 1);
    let allocations = |names: &'static [&'static str]| {
        let mut sink = Asks(names, Vec::with_capacity(8));
        let before = CountingAllocator::on_this_thread();
        dem.show_coarse(&grid, &mut sink);
        let taken = CountingAllocator::on_this_thread() - before;
        assert_eq!(sink.1.len(), names.iter().filter(|name| **name != "radius").count());
        taken
    };
    assert!(CountingAllocator::is_installed());
    assert_eq!(allocations(&[]), 0);
    assert_eq!(allocations(&["radius"]), 0);
    let (density, stress) = (allocations(&["density"]), allocations(&["contact_stress"]));
    assert!(0 < density && density < stress, "{density} {stress}");
    // All that is listed is shown.
    for shown in Dem::<D3>::coarse_catalogue() {
        let name: &'static str = Box::leak(shown.name.into_boxed_str());
        allocations(Box::leak(Box::new([name])));
    }
}

#[test]
fn a_grain_that_was_shot_away_does_not_matter_and_grids_without_sense_are_refused() {
    let mut materials = Materials::new();
    let glass = materials.add(Material::default()).unwrap();
    let far = [1e6, -1e300].map(|x| Grain::at(D2_X * x, 1e-3, glass));
    let near = Grain::at(D2_X * 2e-3, 1e-3, glass);
    let floor = Wall::plane("floor", D2_X * -1.0, D2_X, glass).unwrap();
    let grains = vec![near, far[0]];
    let setup =
        Setup { materials, grains, walls: vec![floor], gravity: D2_X * 0.0, options: Options::default() };
    let dem = Dem::<D2>::new(setup).unwrap();
    let grid = CoarseGrid::<D2>::new(D2_X * 0.0, everywhere::<D2>(4e-3), 1e-3, 1).unwrap();
    let fields = dem.coarse_fields(&grid);
    assert!(fields.density().iter().all(|density| density.is_finite()));
    assert!(fields.mass_outside() >= 0.5 * total_mass(&dem));
    assert!(far[1].position.is_finite());
    let refused = |high: f64, spacing: f64, width: usize| {
        CoarseGrid::<D2>::new(D2_X * 0.0, everywhere::<D2>(high), spacing, width).unwrap_err().to_string()
    };
    assert!(refused(1.0, 0.0, 1).contains("spacing of the grid is 0"));
    assert!(refused(-1.0, 1.0, 1).contains("extent of the grid is -1"));
    assert!(refused(1.0, 0.1, 9).contains("width of the kernel is 9"));
    assert!(refused(1.0, 1e-5, 1).contains("at most 1e8"));
}

const D2_X: granular_core::glam::DVec2 = granular_core::glam::DVec2::X;
