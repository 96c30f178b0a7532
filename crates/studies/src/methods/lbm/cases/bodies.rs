//! Forces on disks: in a square array, in a channel, and carried by a stream.

use super::{advance, fluid};
use crate::validate::Effort;
use crate::validate::reference::columns;
use crate::validate::{Measure, Rows, Tier};
use granular_core::D2;
use granular_core::glam::DVec2;
use granular_driver::failure::Failure;
use granular_driver::parallel;
use granular_lbm::{
    Ball, D2Q9, Face, Flow, Lbm2, Obstacle, OpenScheme, Operator, Profile, Setup, WallScheme,
};
use granular_validation_data::SQUARE_ARRAY;
use std::f64::consts::PI;

pub(crate) fn square_array(rows: &mut Rows, effort: Effort) -> Result<(), Failure> {
    let (side, fractions): (usize, &[f64]) =
        if effort == Effort::Full { (96, &[0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6]) } else { (48, &[0.2, 0.5]) };
    let known = columns(SQUARE_ARRAY, ["solid_fraction", "F_over_muU_table"]);
    let drags = parallel::each(fractions, |&fraction| drag_in_array(side, fraction))?;
    for (fraction, drag) in fractions.iter().zip(drags) {
        let reference = known.iter().find(|row| row[0] == *fraction).map_or(f64::NAN, |row| row[1]);
        let metric = format!("solid fraction {fraction}: drag over viscosity and superficial velocity");
        let measure = Measure::relative(Tier::OtherCode, metric, drag, reference, 0.02);
        rows.add(measure.note(format!("{side} cells between centres")));
    }
    Ok(())
}

/// A disk in a periodic square.
pub(crate) struct Array {
    /// Cells between centres.
    pub(crate) side: usize,
    /// Share of the plane that disks take.
    pub(crate) fraction: f64,
    /// Relaxation time in steps.
    pub(crate) tau: f64,
    pub(crate) operator: Operator,
    pub(crate) wall: WallScheme,
}

fn drag_in_array(side: usize, fraction: f64) -> Result<f64, Failure> {
    Array { side, fraction, tau: 0.8, operator: Operator::DEFAULT, wall: WallScheme::default() }.drag()
}

impl Array {
    /// Drag over viscosity and mean velocity, in creeping flow.
    pub(crate) fn drag(&self) -> Result<f64, Failure> {
        let Self { side, fraction, tau, operator, wall } = *self;
        let length = side as f64;
        let mut setup = Setup::<D2>::new([side, side, 1], 1.0, 1.0, tau);
        setup.operator = operator;
        let radius = length * (fraction / PI).sqrt();
        let acceleration = 1e-6;
        setup.acceleration = DVec2::new(acceleration, 0.0);
        let mut disk = Obstacle::new("disk", Ball { centre: DVec2::splat(0.5 * length), radius });
        disk.wall = wall;
        setup.obstacles.push(disk);
        let (density, dt) = (setup.density, setup.time_step);
        let mut lbm = fluid::<D2Q9, 9>(setup);
        let flux =
            |lbm: &Lbm2| lbm.velocities().iter().map(|velocity| velocity.x).sum::<f64>() / (length * length);
        // Until the flux does not change any more.
        let (mut before, leg) = (0.0, (0.02 * length * length / dt) as u64);
        for _ in 0..200 {
            advance(&mut lbm, leg)?;
            let now = flux(&lbm);
            if (now / before - 1.0_f64).abs() < 1e-6 {
                break;
            }
            before = now;
        }
        // The pressure gradient that the body force stands for acts on the disk as well.
        Ok(density * acceleration * length * length / (density * flux(&lbm)))
    }
}

/// A disk that moves along the middle of a channel, seen from the disk.
pub(crate) fn disk_in_channel(rows: &mut Rows, effort: Effort) -> Result<(), Failure> {
    let diameters: &[usize] = if effort == Effort::Full { &[10, 20] } else { &[10] };
    let drags = parallel::each(diameters, |&diameter| drag_in_channel(diameter))?;
    // Series of [Faxen1946] for a channel five diameters wide.
    let k = 5.0_f64;
    let series =
        k.ln() - 0.9157 + 1.7244 / k.powi(2) - 1.7302 / k.powi(4) + 2.4056 / k.powi(6) - 4.5913 / k.powi(8);
    for (diameter, (drag, reynolds)) in diameters.iter().zip(drags) {
        let metric = format!("{diameter} cells across: drag over viscosity and speed");
        let measure = Measure::relative(Tier::ClosedForm, metric, drag, 4.0 * PI / series, 0.01);
        rows.add(
            measure.note(format!("channel 5 diameters wide and 20 long, Reynolds number {reynolds:.3}")),
        );
    }
    Ok(())
}

fn drag_in_channel(diameter: usize) -> Result<(f64, f64), Failure> {
    let (width, length) = (5 * diameter, 20 * diameter);
    let mut setup = Setup::<D2>::new([length, width, 1], 1.0, 1.0, 1.4);
    let d = diameter as f64;
    let reynolds = 0.02;
    let speed = DVec2::new(reynolds / d, 0.0);
    setup.faces[0] =
        [Face::Velocity(Profile::uniform(speed), OpenScheme::ZouHe), Face::Pressure(0.0, OpenScheme::ZouHe)];
    setup.faces[1] = [Face::Wall(speed), Face::Wall(speed)];
    let centre = DVec2::new(0.5 * length as f64, 0.5 * width as f64);
    setup.obstacles.push(Obstacle::new("disk", Ball { centre, radius: 0.5 * d }));
    let dt = setup.time_step;
    let density = setup.density;
    let mut lbm = fluid::<D2Q9, 9>(setup);
    lbm.set_flow(|_| Flow { pressure: 0.0, velocity: speed });
    let mut before = 0.0;
    // The staggered momentum of a sudden start is gone from the mean of two steps.
    let drag = |lbm: &mut Lbm2| -> Result<f64, Failure> {
        let first = lbm.force_on(0).x;
        advance(lbm, 1)?;
        Ok(0.5 * (first + lbm.force_on(0).x))
    };
    for _ in 0..60 {
        advance(&mut lbm, (0.1 * (width * width) as f64 / dt) as u64)?;
        let now = drag(&mut lbm)?;
        if (now / before - 1.0_f64).abs() < 1e-5 {
            break;
        }
        before = now;
    }
    Ok((drag(&mut lbm)? / (density * speed.x), reynolds))
}

/// A disk whose surface moves with a uniform stream, and one at rest in it.
pub(crate) fn carried_disk(rows: &mut Rows, _: Effort) -> Result<(), Failure> {
    for wall in [WallScheme::HalfWay, WallScheme::Bouzidi, WallScheme::Yu] {
        let force = |share: f64| -> Result<DVec2, Failure> {
            let mut setup = Setup::<D2>::new([60, 60, 1], 1.0, 1.0, 0.7);
            let stream = DVec2::new(0.05, 0.02) * setup.lattice_speed();
            let mut disk = Obstacle::new("disk", Ball { centre: DVec2::new(30.3, 29.8), radius: 8.4 });
            disk.wall = wall;
            disk.velocity = stream * share;
            setup.obstacles.push(disk);
            let mut lbm = fluid::<D2Q9, 9>(setup);
            lbm.set_flow(|_| Flow { pressure: 0.0, velocity: stream });
            advance(&mut lbm, 400)?;
            Ok(lbm.force_on(0))
        };
        let share = force(1.0)?.length() / force(0.0)?.length();
        let metric = format!("{wall:?}: force on a disk carried by the stream, over that on one at rest");
        rows.add(Measure::absolute(Tier::Identity, metric, share, 0.0, 0.01));
    }
    Ok(())
}
