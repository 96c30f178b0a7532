//! Collision operators against one another: walls, pores, free flow, moving frames, vortices in space, cost.

use super::cases::bodies::Array;
use crate::bench::{Comparison, Printed};
use crate::validate::reference::columns;
use granular_core::glam::{DVec2, DVec3};
use granular_core::{D2, D3, Solver};
use granular_driver::failure::Failure;
use granular_driver::parallel;
use granular_lbm::{Face, Flow, Lbm2, Lbm3, Operator, Setup, WallScheme};
use granular_validation_data::SQUARE_ARRAY;
use serde::Serialize;
use std::f64::consts::TAU;
use std::fmt;
use std::time::Instant;

pub(super) const COMPARISON: Comparison = Comparison {
    name: "operators",
    about: "Collision operators side by side: walls, pores, free flow, moving frames, cost; takes a minute",
    run: || {
        let found = operators()?;
        Ok(Printed::new(&found, found.to_string()))
    },
};

const FITS: &str = "the flow of the study is in range";
/// Operators by name; the first is the default.
const OPERATORS: [(&str, Operator); 6] = [
    ("two, Lambda 3/16", Operator::DEFAULT),
    ("two, Lambda 1/4", Operator::TwoRelaxation { magic: 0.25 }),
    ("multiple, Lambda 3/16", Operator::EXACT_WALLS),
    ("multiple, KUMAR", Operator::KUMAR),
    ("single", Operator::SingleRelaxation),
    ("regularised", Operator::Regularised),
];
/// Relaxation times of the flows at walls.
const TAUS: [f64; 2] = [0.55, 2.0];
/// Cells of the flat channel, and between centres of the array.
const CHANNEL: usize = 8;
const ARRAY: usize = 24;
/// Share of the plane that the disks of the array take.
const FRACTION: f64 = 0.5;
/// Speed of the shear layers and of the vortices in space, in cells per step.
const SPEED: f64 = 0.05;
/// Rounds of the measurement of speed.
const ROUNDS: usize = 5;
/// Speed of the frame in which the milder layers move.
const FRAME: f64 = 0.08;

/// What one operator does.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct Row {
    /// Name among [`OPERATORS`].
    operator: &'static str,
    /// Slip at flat walls of a channel of 8 cells over its largest speed, at each of [`TAUS`].
    slip: [f64; 2],
    /// Error of the drag of disks that take half of the plane, 24 cells between centres, half-way walls, at each of [`TAUS`].
    halfway: [f64; 2],
    /// The same with interpolated walls.
    interpolated: [f64; 2],
    /// Step at which two shear layers blow up, Reynolds number 10 000 on 128 cells; none where they pass.
    layers: Option<u64>,
    /// The same for milder ones, 2000 on 64 cells, that move at 0.08 cells per step.
    moving: Option<u64>,
    /// Largest error of the dissipation of the vortices of Taylor and Green in space over its peak, Reynolds number 100 on
    /// 32 cells.
    dissipation: f64,
    /// Millions of cell updates per second in the plane, the best of five.
    rate: f64,
}

/// What the operators do.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct Operators {
    /// One row per operator.
    rows: Vec<Row>,
}

/// Runs all; takes seconds on a quiet machine.
///
/// # Errors
/// When a flow fails that every operator bears.
fn operators() -> Result<Operators, Failure> {
    let mut rows = parallel::each(&OPERATORS, |&(name, operator)| row(name, operator))?;
    // One after another, and in turn, so that nothing of this program runs beside.
    for _ in 0..ROUNDS {
        for (row, (_, operator)) in rows.iter_mut().zip(OPERATORS) {
            row.rate = row.rate.max(rate(operator)?);
        }
    }
    Ok(Operators { rows })
}

fn row(name: &'static str, operator: Operator) -> Result<Row, Failure> {
    let known = columns(SQUARE_ARRAY, ["solid_fraction", "F_over_muU_table"]);
    let drag = known.iter().find(|row| row[0] == FRACTION).map_or(f64::NAN, |row| row[1]);
    let array = |tau, wall| {
        let array = Array { side: ARRAY, fraction: FRACTION, tau, operator, wall };
        array.drag().map(|found| found / drag - 1.0)
    };
    let [low, high] = TAUS;
    Ok(Row {
        operator: name,
        slip: [slip(operator, low)?, slip(operator, high)?],
        halfway: [array(low, WallScheme::HalfWay)?, array(high, WallScheme::HalfWay)?],
        interpolated: [array(low, WallScheme::Bouzidi)?, array(high, WallScheme::Bouzidi)?],
        layers: Layers { side: 128, reynolds: 1e4, frame: 0.0 }.fails(operator),
        moving: Layers { side: 64, reynolds: 2e3, frame: FRAME }.fails(operator),
        dissipation: dissipation(operator)?,
        rate: 0.0,
    })
}

/// Slip at the walls of a flat channel, over the largest speed.
fn slip(operator: Operator, tau: f64) -> Result<f64, Failure> {
    let mut setup = Setup::<D2>::new([3, CHANNEL, 1], 1.0, 1.0, tau);
    setup.operator = operator;
    setup.faces[1] = [Face::REST, Face::REST];
    let height = CHANNEL as f64;
    setup.acceleration = DVec2::new(1e-6, 0.0);
    let peak = 1e-6 * height * height / 8.0;
    let mut lbm = Lbm2::new(setup).expect(FITS);
    let dt = lbm.setup().time_step;
    lbm.advance(dt, (3.0 * height * height / dt) as u64)?;
    let y = 0.5 / height;
    let speed = lbm.flow([1, 0, 0]).map_or(f64::NAN, |flow| flow.velocity.x);
    Ok(speed / peak - 4.0 * y * (1.0 - y))
}

/// Two shear layers in a doubly periodic box, with a kick across \[MinionBrown1997\].
struct Layers {
    side: usize,
    /// On the side and the speed of a layer.
    reynolds: f64,
    /// Speed of the frame along the layers, in cells per step.
    frame: f64,
}

impl Layers {
    /// The step at which they blow up while the layers move by one side.
    fn fails(&self, operator: Operator) -> Option<u64> {
        let side = self.side as f64;
        let viscosity = SPEED * side / self.reynolds;
        let mut setup = Setup::<D2>::new([self.side, self.side, 1], 1.0, viscosity, 0.5 + 3.0 * viscosity);
        setup.operator = operator;
        let mut lbm = Lbm2::new(setup).expect(FITS);
        let frame = DVec2::new(self.frame, 0.0);
        lbm.set_flow(|point| {
            let (x, y) = (point.x / side, point.y / side);
            let along = (30.0 * if y < 0.5 { y - 0.25 } else { 0.75 - y }).tanh();
            let across = 0.05 * (TAU * (x + 0.25)).sin();
            Flow { pressure: 0.0, velocity: SPEED * DVec2::new(along, across) + frame }
        });
        let dt = lbm.setup().time_step;
        (1..=(side / SPEED) as u64).find(|_| lbm.advance(dt, 1).is_err())
    }
}

/// Kinetic energy of the vortices in space at Reynolds number 100, over density and the square of the speed, at every half
/// unit of time (length `1/k` over speed): Fourier modes, 48 across, our own.
const ENERGY: [f64; 17] = [
    0.12500000, 0.12127471, 0.11748093, 0.11345340, 0.10904761, 0.10416699, 0.09879146, 0.09297550,
    0.08681938, 0.08044129, 0.07396432, 0.06751807, 0.06123973, 0.05526032, 0.04968486, 0.04458060,
    0.03997614,
];

/// Largest error of the dissipation over its peak.
fn dissipation(operator: Operator) -> Result<f64, Failure> {
    let (side, reynolds) = (32, 100.0);
    let k = TAU / side as f64;
    let viscosity = SPEED / k / reynolds;
    let mut setup = Setup::<D3>::new([side, side, side], 1.0, viscosity, 0.5 + 3.0 * viscosity);
    setup.operator = operator;
    let density = setup.density;
    let mut lbm = Lbm3::new(setup).expect(FITS);
    lbm.set_flow(|point| {
        let [x, y, z] = (point * k).to_array();
        let velocity = DVec3::new(x.sin() * y.cos() * z.cos(), -x.cos() * y.sin() * z.cos(), 0.0);
        let pressure = ((2.0 * x).cos() + (2.0 * y).cos()) * ((2.0 * z).cos() + 2.0) / 16.0;
        Flow { pressure: density * SPEED * SPEED * pressure, velocity: SPEED * velocity }
    });
    let energy = |lbm: &Lbm3| {
        let velocities = lbm.velocities();
        let squares: f64 = velocities.iter().map(|v| v.length_squared()).sum();
        0.5 * squares / velocities.len() as f64 / (SPEED * SPEED)
    };
    let dt = lbm.setup().time_step;
    let at = |index: usize| (0.5 * index as f64 / (k * SPEED)).round() as u64;
    let (mut worst, mut peak, mut before) = (0.0_f64, 0.0_f64, energy(&lbm));
    for index in 1..ENERGY.len() {
        lbm.advance(dt, at(index) - at(index - 1))?;
        let now = energy(&lbm);
        let expected = ENERGY[index - 1] - ENERGY[index];
        worst = worst.max((before - now - expected).abs());
        peak = peak.max(expected);
        before = now;
    }
    Ok(worst / peak)
}

/// Millions of cell updates per second in a periodic square, on one thread.
fn rate(operator: Operator) -> Result<f64, Failure> {
    let (side, steps) = (256, 100);
    let mut setup = Setup::<D2>::new([side, side, 1], 1.0, 1.0, 0.6);
    setup.operator = operator;
    let mut lbm = Lbm2::new(setup).expect(FITS);
    let dt = lbm.setup().time_step;
    parallel::pool(1)?.install(|| {
        let begun = Instant::now();
        lbm.advance(dt, steps)?;
        Ok((side * side) as f64 * steps as f64 * 1e-6 / begun.elapsed().as_secs_f64())
    })
}

impl fmt::Display for Operators {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [low, high] = TAUS;
        writeln!(
            f,
            "| operator | slip at a flat wall, relaxation time {low} and {high} \\[%\\] | drag of an array, half-way | \
             drag, interpolated | shear layers | moving layers | dissipation \\[%\\] | MLUPS |"
        )?;
        writeln!(f, "|---|---|---|---|---|---|---|---|")?;
        let pair = |[a, b]: [f64; 2]| format!("{:+.2}, {:+.2}", 100.0 * a, 100.0 * b);
        let end = |step: Option<u64>| step.map_or("pass".to_owned(), |step| format!("step {step}"));
        for row in &self.rows {
            writeln!(
                f,
                "| {} | {} | {} | {} | {} | {} | {:.2} | {:.0} |",
                row.operator,
                pair(row.slip),
                pair(row.halfway),
                pair(row.interpolated),
                end(row.layers),
                end(row.moving),
                100.0 * row.dissipation,
                row.rate
            )?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What made it the default.
    #[test]
    fn the_default_is_exact_at_flat_walls_alike_in_pores_at_any_viscosity_and_bears_shear_layers() {
        let default = row(OPERATORS[0].0, OPERATORS[0].1).unwrap();
        assert!(default.slip.iter().all(|slip| slip.abs() < 1e-6), "{default:?}");
        assert!((default.halfway[0] - default.halfway[1]).abs() < 1e-3, "{default:?}");
        assert_eq!([default.layers, default.moving], [None; 2], "{default:?}");
    }
}
