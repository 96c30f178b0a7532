//! Stress ratio of lattices that slide: disks \[Rowe1962\] and spheres \[Thornton1979\].

use super::{Touching, name, refused};
use crate::validate::Effort;
use crate::validate::{Measure, Rows, Tier};
use granular_core::{D2, D3, Dim, Solver};
use granular_dem::{CellControl, ContactModel, Control, Dem, Matrix, PeriodicCell};
use granular_driver::failure::Failure;

/// Strain at which strength is looked at: contacts slide by then, and the lattice, which is not stable, still holds.
const CRUSHED: f64 = 1.6e-3;

/// Crushes a packing along the upward axis under its own stress sideways, slowly, until it slides. Returns the stress
/// ratio and the edges of the cell.
fn crush<D: Dim>(mut dem: Dem<D>) -> Result<(f64, Matrix<D>), Failure> {
    const STEPS: u64 = 8000;
    let dt = dem.recommended_step();
    let side = dem.cell_stress().unwrap_or_default().at(0, 0);
    let mut control = CellControl::isotropic::<D>(side);
    control.component[D::UP][D::UP] = Control::Rate(-CRUSHED / (STEPS as f64 * dt));
    dem.control_cell(control).map_err(refused)?;
    dem.advance(dt, STEPS)?;
    let stress = dem.cell_stress().unwrap_or_default();
    let edges = *dem.cell().map(PeriodicCell::edges).unwrap_or(&Matrix::zero());
    Ok((stress.at(D::UP, D::UP) / stress.at(0, 0), edges))
}

fn hexagonal(rows: &mut Rows, grains: &Touching) -> Result<(), Failure> {
    let (columns, layers) = (4, 3);
    let (ratio, edges) = crush::<D2>(grains.hexagonal(columns, layers)?)?;
    // Contacts between rows lean by this angle, 60 degrees at first; it changes a little on the way.
    let lean = (edges.at(1, 1) / layers as f64 / (edges.at(0, 0) / columns as f64)).atan();
    let expected = |lean: f64| lean.tan() * (lean + grains.friction.atan()).tan();
    let law = name(grains.contact);
    let metric = format!("hexagonal disks, {law}, friction {}: stress ratio", grains.friction);
    let measure = Measure::relative(Tier::ClosedForm, metric, ratio, expected(lean), 5e-3);
    let at_first = expected(std::f64::consts::FRAC_PI_3);
    rows.add(measure.note(format!("{at_first:.4} in the lattice before it leans")));
    Ok(())
}

fn face_centred(rows: &mut Rows, grains: &Touching) -> Result<(), Failure> {
    let (ratio, edges) = crush::<D3>(grains.face_centred(2)?)?;
    let mu = grains.friction;
    let lean = (edges.at(2, 2) / edges.at(0, 0)).atan();
    let expected = 2.0 * lean.tan() * (lean + mu.atan()).tan();
    let law = name(grains.contact);
    let metric = format!("face-centred cubic spheres, {law}, friction {mu}: stress ratio");
    let measure = Measure::relative(Tier::ClosedForm, metric, ratio, expected, 5e-3);
    let at_first = 2.0 * (1.0 + mu) / (1.0 - mu);
    rows.add(measure.note(format!("{at_first:.4} in the lattice before it leans")));
    Ok(())
}

pub(in super::super) fn run(rows: &mut Rows, _: Effort) -> Result<(), Failure> {
    for contact in [ContactModel::Linear, ContactModel::Hertz] {
        for friction in [0.0, 0.1, 0.2, 0.3] {
            let grains = Touching { contact, friction, ..Touching::default() };
            hexagonal(rows, &grains)?;
            face_centred(rows, &grains)?;
        }
    }
    Ok(())
}
