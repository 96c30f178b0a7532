//! Invariance under a change of frame: samples in a cell that is shifted, turned, or turning.

use super::lattices::{Touching, name, refused};
use crate::validate::Effort;
use crate::validate::{Measure, Rows, Tier};
use granular_core::random::Chance;
use granular_core::{D2, D3, Dim, Linear, Solver, Vector};
use granular_dem::{CellControl, ContactModel, Control, Dem, Matrix};
use granular_driver::failure::Failure;
use granular_packing::scattered;

/// Rate at which it is squeezed along every axis, and sheared twice as fast \[1/s\].
const RATE: f64 = 0.1;
/// Strain along every axis until it is dense. Not more: in a dense flow round-off grows to all there is.
const DENSE: f64 = 0.12;
/// Steps in which a frame turns by a radian.
const STEPS: u32 = 20_000;

/// An axis of rotation; the plane takes z only.
fn axis<D: Dim>() -> [f64; 3] {
    if D::TWISTS { [2.0 / 7.0, 3.0 / 7.0, 6.0 / 7.0] } else { [0.0, 0.0, 1.0] }
}

/// The matrix that takes the cross product with an axis.
fn cross<D: Dim>(axis: [f64; 3]) -> Matrix<D> {
    let [x, y, z] = axis;
    Matrix::from_fn(|i, j| [[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]][i][j])
}

/// Rotation by an angle about the axis, after Rodrigues.
fn rotation_by<D: Dim>(angle: f64) -> Matrix<D> {
    let turn = cross::<D>(axis::<D>());
    Matrix::unit().plus(&turn, angle.sin()).plus(&turn.times(&turn), 1.0 - angle.cos())
}

fn turned<D: Dim>(turn: &Matrix<D>, matrix: &Matrix<D>) -> Matrix<D> {
    turn.times(matrix).times(&Matrix::from_fn(|i, j| turn.at(j, i)))
}

fn rates<D: Dim>(gradient: &Matrix<D>) -> CellControl {
    let mut control = CellControl::default();
    for row in 0..D::N {
        for column in 0..D::N {
            control = control.with(row, column, Control::Rate(gradient.at(row, column)));
        }
    }
    control
}

/// A random sample that is squeezed and sheared, shifted by `offset` and turned.
fn sample<D: Dim>(contact: ContactModel, offset: D::Vec, turn: &Matrix<D>) -> Result<Dem<D>, Failure> {
    let (count, fraction) = if D::TWISTS { (216, 0.45) } else { (196, 0.7) };
    let side = (f64::from(count) * D::ball_volume(0.5) / fraction).powf(1.0 / D::N as f64);
    let size = D::Vec::splat(side);
    let places = scattered::<D>(&vec![0.5; count as usize], size, 1);
    let places = places.map_err(|error| Failure::Io(error.to_string()))?;
    let places = places.into_iter().map(|place| turn.apply(place) + offset);
    let edges = Matrix::zero().plus(turn, side);
    let mut dem = Touching { contact, ..Touching::default() }.in_cell(places, edges, &[true; 3][..D::N])?;
    let gradient = Matrix::<D>::from_fn(|i, j| match (i, j) {
        _ if i == j => -RATE,
        (0, 1) => 2.0 * RATE,
        _ => 0.0,
    });
    dem.control_cell(rates(&turned(turn, &gradient))).map_err(refused)?;
    Ok(dem)
}

/// The step \[s\]: Hertz contacts stiffen with their overlap, of which a gas at rest knows nothing.
fn step<D: Dim>(dem: &Dem<D>, contact: ContactModel) -> f64 {
    match contact {
        ContactModel::Linear => dem.recommended_step(),
        ContactModel::Hertz => 5e-4,
    }
}

/// Steps until such a sample is dense.
fn until_dense(dt: f64) -> u64 {
    (DENSE / (RATE * dt)) as u64
}

/// Largest difference of velocities, those of the second sample turned back, over the largest velocity.
fn difference<D: Dim>(a: &Dem<D>, b: &Dem<D>, back: &Matrix<D>) -> f64 {
    let pairs = (0..a.len() as u32).map(|id| (a.grain(id).velocity, back.apply(b.grain(id).velocity)));
    let (worst, largest) = pairs.fold((0.0_f64, 0.0_f64), |(worst, largest), (a, b)| {
        (worst.max((a - b).length()), largest.max(a.length()))
    });
    worst / largest
}

fn contacts_per_grain<D: Dim>(dem: &Dem<D>) -> f64 {
    f64::from(dem.coordination().iter().sum::<u32>()) / dem.len() as f64
}

fn mean_pressure<D: Dim>(stress: &Matrix<D>) -> f64 {
    (0..D::N).map(|axis| stress.at(axis, axis)).sum::<f64>() / D::N as f64
}

pub(super) fn shifts(rows: &mut Rows, effort: Effort) -> Result<(), Failure> {
    let shifts = if effort == Effort::Full { 5 } else { 2 };
    for contact in [ContactModel::Linear, ContactModel::Hertz] {
        shifted::<D2>(rows, contact, shifts)?;
        shifted::<D3>(rows, contact, shifts)?;
        // As long as all the others together.
        if contact == ContactModel::Linear || effort == Effort::Full {
            at_rest::<D2>(rows, contact)?;
            at_rest::<D3>(rows, contact)?;
        }
    }
    Ok(())
}

fn shifted<D: Dim>(rows: &mut Rows, contact: ContactModel, shifts: usize) -> Result<(), Failure> {
    let mut chance = Chance::new(5);
    let unit = Matrix::unit();
    let mut here = sample::<D>(contact, D::Vec::ZERO, &unit)?;
    let dt = step(&here, contact);
    let steps = until_dense(dt);
    here.advance(dt, steps)?;
    let stress = here.cell_stress().unwrap_or_default();
    let pressure = mean_pressure(&stress);
    let mut worst = (0.0_f64, 0.0_f64);
    for _ in 0..shifts {
        let offset = (0..D::N)
            .fold(D::Vec::ZERO, |offset, axis| offset + D::Vec::along(axis, chance.between(-30.0, 30.0)));
        let mut there = sample(contact, offset, &unit)?;
        there.advance(dt, steps)?;
        worst.0 = worst.0.max(difference(&here, &there, &unit));
        let other = there.cell_stress().unwrap_or_default();
        worst.1 = worst.1.max(stress.plus(&other, -1.0).norm() / pressure);
    }
    let law = format!("{} {}s", name(contact), D::BALL);
    let metric = format!("{law}: largest difference of velocities after {steps} steps under {shifts} shifts");
    rows.add(Measure::absolute(Tier::Identity, metric, worst.0, 0.0, 1e-8));
    let metric = format!("{law}: difference of stress after {steps} steps over pressure");
    let contacts = contacts_per_grain(&here);
    let measure = Measure::absolute(Tier::Identity, metric, worst.1, 0.0, 1e-8);
    rows.add(measure.note(format!("{contacts:.2} contacts per grain")));
    Ok(())
}

/// A packing at rest under a stress: it is that stress, and symmetric.
fn at_rest<D: Dim>(rows: &mut Rows, contact: ContactModel) -> Result<(), Failure> {
    let target = 1e3;
    let mut dem = sample::<D>(contact, D::Vec::ZERO, &Matrix::unit())?;
    dem.control_cell(CellControl::isotropic::<D>(target)).map_err(refused)?;
    let dt = step(&dem, contact);
    for _ in 0..60 {
        dem.advance(dt, 1000)?;
        let moving = dem.energies().translational() + dem.energies().rotational;
        // A gas that the servo has just begun to squeeze is nearly at rest too.
        let pressed = mean_pressure(&dem.cell_stress().unwrap_or_default()) > 0.9 * target;
        if pressed && moving < 1e-9 * target {
            break;
        }
    }
    let stress = dem.cell_stress().unwrap_or_default();
    let law = format!("{} {}s", name(contact), D::BALL);
    let off = (0..D::N).map(|axis| (stress.at(axis, axis) / target - 1.0).abs()).fold(0.0, f64::max);
    let metric = format!("{law}: normal stresses under a servo of 1 kPa, largest error");
    rows.add(Measure::absolute(Tier::Identity, metric, off, 0.0, 1e-2));
    let skew = stress.plus(&Matrix::from_fn(|i, j| stress.at(j, i)), -1.0).norm() / target;
    let largest = (0..D::N)
        .flat_map(|i| (0..i).map(move |j| (i, j)))
        .map(|(i, j)| stress.at(i, j).abs() / target)
        .fold(0.0, f64::max);
    let metric = format!("{law}: skew part of the stress at rest over pressure");
    let measure = Measure::absolute(Tier::Conservation, metric, skew, 0.0, 1e-3);
    rows.add(measure.note(format!("largest shear stress {largest:.4} of the pressure")));
    Ok(())
}

pub(super) fn rotation(rows: &mut Rows, _: Effort) -> Result<(), Failure> {
    for contact in [ContactModel::Linear, ContactModel::Hertz] {
        rotated::<D2>(rows, contact)?;
        rotated::<D3>(rows, contact)?;
        turning::<D2>(rows, contact, |grains| grains.hexagonal(4, 3))?;
        turning::<D3>(rows, contact, |grains| grains.face_centred(2))?;
    }
    Ok(())
}

fn rotated<D: Dim>(rows: &mut Rows, contact: ContactModel) -> Result<(), Failure> {
    let mut here = sample::<D>(contact, D::Vec::ZERO, &Matrix::unit())?;
    let dt = step(&here, contact);
    let steps = until_dense(dt);
    here.advance(dt, steps)?;
    for degrees in [17.0_f64, 45.0, 90.0] {
        let angle = degrees.to_radians();
        let mut there = sample::<D>(contact, D::Vec::ZERO, &rotation_by(angle))?;
        there.advance(dt, steps)?;
        let law = format!("{} {}s", name(contact), D::BALL);
        let metric = format!("{law}, frame turned by {degrees} degrees: difference of velocities");
        let found = difference(&here, &there, &rotation_by(-angle));
        let measure = Measure::absolute(Tier::Identity, metric, found, 0.0, 1e-8);
        let contacts = contacts_per_grain(&here);
        rows.add(measure.note(format!("after {steps} steps, with {contacts:.2} contacts per grain")));
    }
    Ok(())
}

/// Stress of a lattice, seen by its frame, that is sheared a little while the frame turns by an angle.
fn sheared_while_turning<D: Dim>(
    grains: &Touching,
    build: fn(&Touching) -> Result<Dem<D>, Failure>,
    angle: f64,
) -> Result<Matrix<D>, Failure> {
    let dt = build(grains)?.recommended_step();
    let time = f64::from(STEPS) * dt;
    let rate = angle / time;
    // Grains turn with the frame from the start: a spring would have to set them in motion else.
    let mut dem = build(&Touching { spin: axis::<D>().map(|component| component * rate), ..*grains })?;
    let strain = Matrix::<D>::from_fn(|i, j| match (i, j) {
        (0, 0) => 2e-5,
        (1, 1) => -2e-5,
        (0, 1) | (1, 0) => 4e-5,
        _ => 0.0,
    });
    let spin = cross::<D>(axis::<D>());
    for step in 0..STEPS {
        // The rate of strain follows the frame at the middle of the step.
        let now = rotation_by(rate * dt * (f64::from(step) + 0.5));
        let gradient = Matrix::zero().plus(&turned(&now, &strain), 1.0 / time).plus(&spin, rate);
        dem.control_cell(rates(&gradient)).map_err(refused)?;
        dem.advance(dt, 1)?;
    }
    Ok(turned(&rotation_by(-angle), &dem.cell_stress().unwrap_or_default()))
}

/// Tangential springs turn with the frame.
fn turning<D: Dim>(
    rows: &mut Rows,
    contact: ContactModel,
    build: fn(&Touching) -> Result<Dem<D>, Failure>,
) -> Result<(), Failure> {
    let grains = Touching { contact, friction: 10.0, ..Touching::default() };
    let still = sheared_while_turning(&grains, build, 0.0)?;
    let turning = sheared_while_turning(&grains, build, 1.0)?;
    let pressure = mean_pressure(&still);
    let error = still.plus(&turning, -1.0).norm() / pressure;
    let law = format!("{} {}s", name(contact), D::BALL);
    let metric = format!("{law}, frame turns by 1 rad in {STEPS} steps: difference of stress over pressure");
    let shear = still.at(0, 1) / pressure;
    let measure = Measure::absolute(Tier::Identity, metric, error, 0.0, 1e-3);
    let measure = measure.note(format!("shear stress {shear:.3} of the pressure"));
    rows.add(measure);
    Ok(())
}
