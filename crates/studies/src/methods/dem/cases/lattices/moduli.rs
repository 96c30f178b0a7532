//! Elastic moduli of lattices: the change of stress under a small strain.

use super::{Touching, name, refused};
use crate::validate::Effort;
use crate::validate::{Measure, Rows, Tier};
use granular_core::{D2, D3, Dim, Linear, Solver, Vector};
use granular_dem::{CellControl, ContactModel, Control, Dem, Matrix};
use granular_driver::failure::Failure;

/// Strain of the probe: far below the overlap over the diameter, on which the stiffness of Hertz contacts depends.
const SMALL: f64 = 1e-8;

/// A lattice by the directions of half of its contacts and the share of volume of a grain, for touching grains of
/// diameter 1 m.
struct Lattice<D: Dim> {
    name: &'static str,
    directions: Vec<D::Vec>,
    volume: f64,
    build: fn(&Touching) -> Result<Dem<D>, Failure>,
}

fn direction<D: Dim>(components: &[f64]) -> D::Vec {
    let sum = (0..D::N).fold(D::Vec::ZERO, |sum, axis| sum + D::Vec::along(axis, components[axis]));
    sum * (1.0 / sum.length())
}

fn hexagonal() -> Lattice<D2> {
    let half = 3.0_f64.sqrt();
    let directions = [[1.0, 0.0], [1.0, half], [-1.0, half]].map(|n| direction::<D2>(&n)).to_vec();
    Lattice { name: "hexagonal", directions, volume: 0.5 * half, build: |grains| grains.hexagonal(4, 3) }
}

fn simple_cubic() -> Lattice<D3> {
    let directions = (0..3).map(|axis| <D3 as Dim>::Vec::along(axis, 1.0)).collect();
    Lattice { name: "simple cubic", directions, volume: 1.0, build: |grains| grains.simple_cubic(3) }
}

fn face_centred() -> Lattice<D3> {
    let all = [[1, 1, 0], [1, -1, 0], [1, 0, 1], [1, 0, -1], [0, 1, 1], [0, 1, -1]];
    let directions = all.map(|n| direction::<D3>(&n.map(f64::from))).to_vec();
    let volume = 0.5_f64.sqrt();
    Lattice { name: "face-centred cubic", directions, volume, build: |grains| grains.face_centred(2) }
}

impl<D: Dim> Lattice<D> {
    /// Change of stress per strain, positive in compression, when all grains follow the strain and none turns.
    ///
    /// The stress is `sum F r / V`. Along a contact with the normal `n` the force falls by `kn d (n strain n)`, and
    /// across it by `kt d` times the rest of `strain n`; force, branch and volume also turn and grow with the strain,
    /// which counts because the contacts carry a force already.
    fn response(&self, grains: &Touching, strain: &Matrix<D>) -> Matrix<D> {
        let (force, normal, across) = grains.contact();
        let d = grains.spacing();
        let volume = self.volume * d.powi(D::N as i32);
        let trace: f64 = (0..D::N).map(|axis| strain.at(axis, axis)).sum();
        let mut sum = Matrix::zero();
        for &n in &self.directions {
            let moved = strain.apply(n);
            let stretch = moved.dot(n);
            let turn = moved - n * stretch;
            let change = n * (-normal * d * stretch) + turn * (force - across * d);
            sum = sum.plus(&Matrix::dyad(change, n), d).plus(&Matrix::dyad(n, moved), force * d);
            sum = sum.plus(&Matrix::dyad(n, n), -force * d * trace);
        }
        Matrix::zero().plus(&sum, 1.0 / volume)
    }
}

/// Change of stress over a small strain.
fn probe<D: Dim>(mut dem: Dem<D>, strain: &Matrix<D>) -> Result<Matrix<D>, Failure> {
    const STEPS: u64 = 200;
    let dt = dem.recommended_step();
    let rate = SMALL / (STEPS as f64 * dt);
    let before = dem.cell_stress().unwrap_or_default();
    let mut control = CellControl::default();
    for row in 0..D::N {
        for column in 0..D::N {
            control = control.with(row, column, Control::Rate(rate * strain.at(row, column)));
        }
    }
    dem.control_cell(control).map_err(refused)?;
    dem.advance(dt, STEPS)?;
    // Held still, dashpots are at rest.
    dem.control_cell(CellControl::default()).map_err(refused)?;
    dem.advance(dt, 20)?;
    let change = dem.cell_stress().unwrap_or_default().plus(&before, -1.0);
    Ok(Matrix::zero().plus(&change, 1.0 / SMALL))
}

/// Squeezed along the upward axis, and sheared: the components that are looked at, and their closed forms as a multiple
/// of `kn d^(2 - N)` without overlap.
struct Closed {
    along: f64,
    beside: f64,
    shear: f64,
}

fn add<D: Dim>(
    rows: &mut Rows,
    lattice: &Lattice<D>,
    grains: &Touching,
    closed: &Closed,
) -> Result<(), Failure> {
    let up = D::UP;
    let squeeze = Matrix::<D>::from_fn(|i, j| if (i, j) == (up, up) { -1.0 } else { 0.0 });
    let shear = Matrix::<D>::from_fn(|i, j| if (i.min(j), i.max(j)) == (0, up) { -0.5 } else { 0.0 });
    let (squeezed, sheared) =
        (probe((lattice.build)(grains)?, &squeeze)?, probe((lattice.build)(grains)?, &shear)?);
    let (along, across) = (lattice.response(grains, &squeeze), lattice.response(grains, &shear));
    let (_, normal, tangential) = grains.contact();
    let law = format!("{}, {}, kt/kn {:.3}", lattice.name, name(grains.contact), tangential / normal);
    let names = if D::N == 2 { ["C11", "C12", "C66"] } else { ["C11", "C12", "C44"] };
    let found = [squeezed.at(up, up), squeezed.at(0, 0), sheared.at(0, up)];
    let exact = [along.at(up, up), along.at(0, 0), across.at(0, up)];
    for (((name, found), exact), closed) in
        names.into_iter().zip(found).zip(exact).zip([closed.along, closed.beside, closed.shear])
    {
        let metric = format!("{law}: {name} [kn]");
        let error = (found - exact).abs() / normal;
        let measure =
            Measure::judged(Tier::ClosedForm, metric, [found / normal, exact / normal], error, 1e-4);
        rows.add(measure.note(format!("error over kn; {closed:.4} without overlap")));
    }
    Ok(())
}

fn closed_hexagonal(ratio: f64) -> Closed {
    let unit = 3.0_f64.sqrt() / 4.0;
    Closed { along: unit * (3.0 + ratio), beside: unit * (1.0 - ratio), shear: unit * (1.0 + ratio) }
}

fn closed_simple_cubic(ratio: f64) -> Closed {
    Closed { along: 1.0, beside: 0.0, shear: 0.5 * ratio }
}

fn closed_face_centred(ratio: f64) -> Closed {
    let unit = 0.5_f64.sqrt();
    Closed { along: 2.0 * unit * (1.0 + ratio), beside: unit * (1.0 - ratio), shear: unit * (1.0 + ratio) }
}

/// Both laws: linear with these ratios of stiffness, Hertz with two ratios of Poisson.
fn laws() -> Vec<Touching> {
    let linear = [0.0, 0.4, 1.0].map(|ratio| Touching {
        ratio,
        friction: if ratio == 0.0 { 0.0 } else { 0.5 },
        ..Touching::default()
    });
    let hertz = [0.0, 0.25].map(|poisson_ratio| Touching {
        contact: ContactModel::Hertz,
        poisson_ratio,
        ..Touching::default()
    });
    linear.into_iter().chain(hertz).collect()
}

pub(in super::super) fn run(rows: &mut Rows, _: Effort) -> Result<(), Failure> {
    for grains in laws() {
        let (_, normal, tangential) = grains.contact();
        let ratio = tangential / normal;
        add(rows, &hexagonal(), &grains, &closed_hexagonal(ratio))?;
        add(rows, &simple_cubic(), &grains, &closed_simple_cubic(ratio))?;
        add(rows, &face_centred(), &grains, &closed_face_centred(ratio))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The sum over contacts without overlap is the closed form.
    fn agrees<D: Dim>(lattice: &Lattice<D>, closed: fn(f64) -> Closed) {
        for ratio in [0.0, 0.3, 1.0] {
            let grains = Touching { ratio, overlap: 0.0, ..Touching::default() };
            let up = D::UP;
            let squeeze = Matrix::<D>::from_fn(|i, j| if (i, j) == (up, up) { -1.0 } else { 0.0 });
            let shear = Matrix::<D>::from_fn(|i, j| if (i.min(j), i.max(j)) == (0, up) { -0.5 } else { 0.0 });
            let (squeezed, sheared) =
                (lattice.response(&grains, &squeeze), lattice.response(&grains, &shear));
            let (_, normal, _) = grains.contact();
            let expected = closed(ratio);
            for (found, expected) in [
                (squeezed.at(up, up), expected.along),
                (squeezed.at(0, 0), expected.beside),
                (sheared.at(0, up), expected.shear),
            ] {
                assert!((found / normal - expected).abs() < 1e-12, "{}: {found} {expected}", lattice.name);
            }
        }
    }

    #[test]
    fn closed_forms_are_the_sums_over_contacts() {
        agrees(&hexagonal(), closed_hexagonal);
        agrees(&simple_cubic(), closed_simple_cubic);
        agrees(&face_centred(), closed_face_centred);
    }

    /// \[DuffyMindlin1957\] for spheres in contact: c12 / c11 = nu / (2 (4 - 3 nu)), c11 = 2 c44.
    #[test]
    fn face_centred_cubic_agrees_with_duffy_and_mindlin() {
        for nu in [0.0, 0.2, 0.5] {
            let closed = closed_face_centred(2.0 * (1.0 - nu) / (2.0 - nu));
            assert!((closed.beside / closed.along - nu / (2.0 * (4.0 - 3.0 * nu))).abs() < 1e-12);
            assert!((closed.along - 2.0 * closed.shear).abs() < 1e-12);
        }
    }
}
