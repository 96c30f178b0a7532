//! A wall of half the height of a channel: thesis figures 5.9 to 5.11.

use super::{advance, fluid};
use crate::validate::Effort;
use crate::validate::{Measure, Rows, Tier};
use granular_core::D2;
use granular_core::glam::DVec2;
use granular_driver::failure::Failure;
use granular_lbm::{Block, D2Q9, Face, Flow, Lbm2, Obstacle, OpenScheme, Profile, Setup, WallScheme};

/// Speed of the stream between the walls over that of the jets beside it, in figure 5.11.
const FIGURE: f64 = -0.31;
/// Mean speed \[cells per step\].
const SPEED: f64 = 0.02;

pub(crate) fn run(rows: &mut Rows, effort: Effort) -> Result<(), Failure> {
    // The finest last: the others show how far it is from its limit.
    let heights: &[usize] = if effort == Effort::Full { &[80, 160] } else { &[40] };
    let mut before: Option<f64> = None;
    for &height in heights {
        let ratio = stream_back(height)?;
        if let Some(before) = before {
            let metric = format!("{height} cells high: stream back over the jets, against half as many");
            rows.add(Measure::relative(Tier::Order, metric, ratio, before, 0.05));
        }
        before = Some(ratio);
        let metric =
            format!("{height} cells high: stream back over the jets one height of the wall behind it");
        let measure = Measure::judged(Tier::Identity, metric, [ratio, 0.0], ratio, -0.01);
        rows.add(measure.note("the stream turns back where it is below zero; the error is the value itself"));
        let metric = format!("{height} cells high: the same, figure 5.11");
        let measure = Measure::relative(Tier::Thesis, metric, ratio, FIGURE, 0.1).claim();
        rows.add(measure.note("the thesis gives neither Reynolds number (here 100) nor place"));
    }
    Ok(())
}

/// Lowest over highest speed along the channel, on a line across it one height of the wall behind the wall.
fn stream_back(height: usize) -> Result<f64, Failure> {
    let (h, length) = (height as f64, 4 * height);
    let mut setup = Setup::<D2>::new([length + 1, height, 1], 1.0, SPEED * h / 100.0, 1.0);
    setup.time_step = 1.0;
    setup.density = 1.0;
    setup.origin = DVec2::new(-0.5, 0.0);
    let stream = DVec2::new(SPEED, 0.0);
    let inlet = Face::Velocity(Profile::uniform(stream), OpenScheme::Regularised);
    setup.faces[0] = [inlet, Face::absorbing(0.0)];
    setup.faces[1] = [Face::REST, Face::REST];
    let block = Block { low: DVec2::new(0.95 * h, 0.25 * h), high: DVec2::new(h, 0.75 * h) };
    setup.obstacles.push(Obstacle { wall: WallScheme::HalfWay, ..Obstacle::new("wall", block) });
    let mut lbm: Lbm2 = fluid::<D2Q9, 9>(setup);
    lbm.set_flow(|_| Flow { pressure: 0.0, velocity: stream });
    advance(&mut lbm, (9.0 * h / SPEED) as u64)?;
    let speeds = (0..height).filter_map(|y| lbm.flow([3 * height / 2, y, 0]).map(|flow| flow.velocity.x));
    let [low, high] = speeds.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], u| [a.min(u), b.max(u)]);
    Ok(low / high)
}
