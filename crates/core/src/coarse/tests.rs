use super::*;
use crate::dim::{D2, D3, Dim, Linear, Vector};
use crate::matrix::Matrix;
use crate::tensor::SymmetricTensor;
use glam::{DVec2, DVec3};

/// Particles that carry a stress fill a periodic square: every cell of the grid has that stress and density.
#[test]
fn a_continuum_with_one_stress_everywhere_shows_it_in_every_cell() {
    let (side, pitch) = (6, 0.5);
    let position: Vec<DVec2> = (0..side * side)
        .map(|k| DVec2::new((k % side) as f64 + 0.3, (k / side) as f64 + 0.7) * pitch)
        .collect();
    let stress = SymmetricTensor::dyad(DVec3::new(2.0, 1.0, 0.0), DVec3::new(2.0, 1.0, 0.0));
    let count = position.len();
    let source = CoarseSource::<D2> {
        position: &position,
        velocity: vec![DVec2::new(3.0, 0.0); count].into(),
        mass: &vec![2.0; count],
        size: Sizes::Volumes(&vec![pitch * pitch; count]),
        periods: Some(Periods {
            edges: Matrix::from_fn(|row, column| if row == column { side as f64 * pitch } else { 0.0 }),
            is_periodic: [true, true, false],
            gradient: Matrix::zero(),
        }),
        stress: vec![stress; count].into(),
        constituents: None,
        visit_branches: &|_| {},
        longest_branch: 0.0,
    };
    let grid = CoarseGrid::new(DVec2::ZERO, DVec2::splat(side as f64 * pitch), pitch, 1).unwrap();
    let fields = CoarseFields::of(&source, &grid);
    for (found, density) in fields.stress().iter().zip(fields.density()) {
        let missed = *found + stress * -1.0;
        assert!(missed.contract(missed).sqrt() < 1e-12 * stress.trace());
        assert!((density - 2.0 / (pitch * pitch)).abs() < 1e-12 * density);
    }
    assert!(fields.solid_fraction().iter().all(|share| (share - 1.0).abs() < 1e-12));
    let diameter = 2.0 * pitch / std::f64::consts::PI.sqrt();
    assert!(fields.mean_diameter().iter().all(|found| (found - diameter).abs() < 1e-12));
    assert!(fields.coordination().iter().all(|contacts| *contacts == 0.0));
}

/// The sum of stress over all cells is that of force times branch, whatever the place: also for a wall, whose force is shown.
fn branches_are_kept<D: Dim>() {
    let position = [D::Vec::splat(1.1), D::Vec::splat(1.1) + D::Vec::along(0, 0.4)];
    let force = D::Vec::along(0, 5.0) + D::Vec::along(1, 2.0);
    let source = CoarseSource::<D> {
        position: &position,
        velocity: vec![D::Vec::ZERO; 2].into(),
        mass: &[1.0, 2.0],
        size: Sizes::Radii(&[0.2, 0.2]),
        periods: None,
        stress: vec![].into(),
        constituents: None,
        visit_branches: &|visit| {
            visit(ForceBranch {
                first: 1,
                second: Some(0),
                normal: D::Vec::along(0, 1.0),
                length: 0.4,
                force,
            });
            visit(ForceBranch { first: 0, second: None, normal: D::Vec::along(1, 1.0), length: 0.2, force });
        },
        longest_branch: 0.4,
    };
    let grid = CoarseGrid::<D>::new(D::Vec::ZERO, D::Vec::splat(3.0), 0.25, 1).unwrap();
    let fields = CoarseFields::of(&source, &grid);
    let volume = grid.cell_volume();
    let sum =
        fields.contact_stress().iter().fold(SymmetricTensor::ZERO, |sum, stress| sum + *stress * volume);
    let arms = [D::Vec::along(0, 0.4), D::Vec::along(1, 0.2)];
    let exact = arms.iter().fold(SymmetricTensor::ZERO, |sum, arm| {
        sum + SymmetricTensor::dyad(DVec3::from(force.padded()), DVec3::from(arm.padded()))
    });
    let missed = sum + exact * -1.0;
    assert!(missed.contract(missed).sqrt() < 1e-13, "{sum:?} {exact:?}");
    let on_walls = fields.wall_force().iter().fold(D::Vec::ZERO, |sum, push| sum + *push * volume);
    assert!((on_walls - force).length() < 1e-13);
    let contacts: f64 = fields
        .coordination()
        .iter()
        .zip(fields.number_density())
        .filter(|(c, _)| c.is_finite())
        .map(|(contacts, number)| contacts * number * volume)
        .sum();
    assert!((contacts - 3.0).abs() < 1e-12, "one particle has two contacts, the other one");
}

#[test]
fn forces_times_branches_are_kept_in_plane_and_space() {
    branches_are_kept::<D2>();
    branches_are_kept::<D3>();
}
