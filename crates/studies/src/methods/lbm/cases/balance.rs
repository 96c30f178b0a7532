//! Mass between walls, and a fluid at rest under gravity.

use super::{OPERATORS, advance, fluid};
use crate::validate::Effort;
use crate::validate::{Measure, Rows, Tier};
use granular_core::D2;
use granular_core::glam::DVec2;
use granular_driver::failure::Failure;
use granular_lbm::{Ball, D2Q9, Face, Obstacle, Setup, WallScheme};

pub(crate) fn mass(rows: &mut Rows, effort: Effort) -> Result<(), Failure> {
    let steps = if effort == Effort::Full { 100_000 } else { 20_000 };
    for wall in [WallScheme::HalfWay, WallScheme::Bouzidi, WallScheme::Yu] {
        let mut setup = Setup::<D2>::new([48, 40, 1], 1.0, 1.0, 0.56);
        let lid = DVec2::new(0.1 * setup.lattice_speed(), 0.0);
        setup.faces[0] = [Face::REST, Face::REST];
        setup.faces[1] = [Face::REST, Face::Wall(lid)];
        let mut disk = Obstacle::new("disk", Ball { centre: DVec2::new(20.2, 17.9), radius: 6.3 });
        disk.wall = wall;
        setup.obstacles.push(disk);
        let mut lbm = fluid::<D2Q9, 9>(setup);
        let before = lbm.excess();
        advance(&mut lbm, steps)?;
        let drift = (lbm.excess() - before).abs() / (48.0 * 40.0);
        let metric = format!("{wall:?}: change of mass in {steps} steps, over the mass");
        // What an interpolated wall keeps in a step it gives back in the next one: that much is on the way.
        let allowed = if wall == WallScheme::HalfWay { 1e-12 } else { 1e-6 };
        rows.add(Measure::absolute(Tier::Conservation, metric, drift, 0.0, allowed));
    }
    Ok(())
}

pub(crate) fn hydrostatic(rows: &mut Rows, _: Effort) -> Result<(), Failure> {
    for (name, operator) in OPERATORS {
        let height = 24;
        let mut setup = Setup::<D2>::new([3, height, 1], 1.0, 1.0, 0.8);
        setup.operator = operator;
        setup.faces[1] = [Face::REST, Face::REST];
        setup.acceleration = DVec2::new(0.0, -1e-4 * setup.lattice_speed().powi(2));
        let (density, fall) = (setup.density, -setup.acceleration.y);
        let mut lbm = fluid::<D2Q9, 9>(setup);
        advance(&mut lbm, 60_000)?;
        let pressure = |k: usize| lbm.flow([1, k, 0]).map_or(f64::NAN, |flow| flow.pressure);
        let whole = density * fall * height as f64;
        let bottom = pressure(0);
        let error = |k: usize| (bottom - pressure(k) - density * fall * k as f64).abs() / whole;
        let worst = (0..height).map(error).fold(0.0, f64::max);
        let metric = format!("{name}: pressure over depth, over that of the whole depth");
        rows.add(Measure::absolute(Tier::ClosedForm, metric, worst, 0.0, 1e-8));
    }
    Ok(())
}
