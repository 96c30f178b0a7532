//! Vortex streets: a disk in the short channel of thesis section 5.3, and the square of the paper to which its table 5.2
//! compares.

use super::{advance, fluid};
use crate::validate::Effort;
use crate::validate::{Measure, Rows, Tier};
use granular_core::D2;
use granular_core::glam::DVec2;
use granular_driver::failure::Failure;
use granular_driver::figures::spectrum::spectrum;
use granular_driver::parallel;
use granular_lbm::{
    Ball, Block, D2Q9, Face, Flow, Obstacle, OpenScheme, Operator, Profile, Setup, WallScheme,
};

/// Strouhal numbers of table 5.2 by Reynolds number.
const TABLE: [(f64, f64); 3] = [(55.0, 0.117), (75.0, 0.128), (112.0, 0.141)];
/// Largest speed at the inlet \[cells per step\].
const SPEED: f64 = 0.06;

/// A body in a channel; lengths in cells.
#[derive(Clone, Copy)]
struct Street {
    is_square: bool,
    /// Diameter or side.
    width: f64,
    cells: [usize; 2],
    /// Where its centre is along the channel.
    at: f64,
    /// Reynolds number on the width and the largest speed at the inlet.
    reynolds: f64,
    /// Times `width / speed` before and within the series.
    times: [f64; 2],
}

impl Street {
    /// The disk of the thesis in a channel of so many cells; its Reynolds number is on the mean speed.
    fn disk(height: usize, reynolds: f64) -> Self {
        Self {
            is_square: false,
            width: 0.27 * height as f64,
            cells: [5 * height / 2, height],
            at: 0.6 * height as f64,
            reynolds: 1.5 * reynolds,
            times: [100.0, 100.0],
        }
    }

    /// A square at a blockage of 1/8, so many cells wide.
    fn square(width: usize, reynolds: f64) -> Self {
        Self {
            is_square: true,
            width: width as f64,
            cells: [36 * width, 8 * width],
            at: 12.5 * width as f64,
            reynolds,
            times: [160.0, 140.0],
        }
    }

    fn setup(&self) -> Setup<D2> {
        let (height, [nx, ny]) = (self.cells[1] as f64, self.cells);
        let viscosity = SPEED * self.width / self.reynolds;
        let mut setup = Setup::<D2>::new([nx + 1, ny, 1], 1.0, viscosity, 1.0);
        setup.time_step = 1.0;
        setup.density = 1.0;
        // The only operator that bears ten cells to the side at these Reynolds numbers.
        setup.operator = Operator::Regularised;
        setup.origin = DVec2::new(-0.5, 0.0);
        let parabola = move |point: DVec2| {
            DVec2::new(4.0 * SPEED * point.y * (height - point.y) / (height * height), 0.0)
        };
        let inlet = Face::Velocity(Profile::new(parabola), OpenScheme::Regularised);
        setup.faces[0] = [inlet, Face::absorbing(0.0)];
        setup.faces[1] = [Face::REST, Face::REST];
        // Half a cell off the middle starts the street.
        let centre = DVec2::new(self.at, 0.5 * height + if self.is_square { 0.0 } else { 0.5 });
        let half = DVec2::splat(0.5 * self.width);
        setup.obstacles.push(if self.is_square {
            let block = Block { low: centre - half, high: centre + half };
            Obstacle { wall: WallScheme::HalfWay, ..Obstacle::new("body", block) }
        } else {
            Obstacle::new("body", Ball { centre, radius: half.x })
        });
        setup
    }

    /// Strouhal number of the lift on the largest speed, and how much its amplitude grows from one half of the series to
    /// the other.
    fn strouhal(&self) -> Result<[f64; 2], Failure> {
        let mut lbm = fluid::<D2Q9, 9>(self.setup());
        let aslant = DVec2::new(2.0 / 3.0 * SPEED, 0.05 * SPEED);
        lbm.set_flow(|_| Flow { pressure: 0.0, velocity: aslant });
        let unit = self.width / SPEED;
        advance(&mut lbm, (self.times[0] * unit) as u64)?;
        let every = (unit / 20.0) as u64;
        let mut lift = Vec::new();
        for _ in 0..(self.times[1] * unit) as u64 / every {
            advance(&mut lbm, every)?;
            lift.push(lbm.force_on(0).y);
        }
        let times: Vec<f64> = (0..lift.len()).map(|k| k as f64 * every as f64).collect();
        let frequency = spectrum(&times, &lift).and_then(|found| found.peak).unwrap_or(f64::NAN);
        let (first, second) = lift.split_at(lift.len() / 2);
        Ok([frequency * unit, amplitude(second) / amplitude(first)])
    }
}

fn amplitude(values: &[f64]) -> f64 {
    let [low, high] =
        values.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| [a.min(*x), b.max(*x)]);
    high - low
}

pub(crate) fn run(rows: &mut Rows, effort: Effort) -> Result<(), Failure> {
    let (height, numbers): (usize, &[f64]) = match effort {
        Effort::Full => (100, &[55.0, 75.0, 112.0]),
        _ => (50, &[75.0, 112.0]),
    };
    let disks = parallel::each(numbers, |&reynolds| Street::disk(height, reynolds).strouhal())?;
    let shedding: Vec<(f64, f64)> = numbers
        .iter()
        .zip(&disks)
        .filter(|(_, [_, growth])| *growth > 0.9)
        .map(|(re, [st, _])| (*re, *st))
        .collect();
    for pair in shedding.windows(2) {
        let [(slow, low), (fast, high)] = [pair[0], pair[1]];
        let metric = format!("disk: Strouhal number at Re {fast} above that at Re {slow}");
        let measure = Measure::judged(Tier::Thesis, metric, [high, low], low / high, 0.9999);
        rows.add(measure.note("the error is the lower over the higher one"));
    }
    for (reynolds, [strouhal, growth]) in numbers.iter().zip(&disks) {
        let note = if *growth > 0.9 { "blockage 0.27" } else { "the oscillation dies away: no street" };
        claim(rows, "disk", *reynolds, *strouhal, note);
    }
    if effort == Effort::Full {
        let squares = parallel::each(&[75.0, 112.0], |&reynolds| Street::square(10, reynolds).strouhal())?;
        for (reynolds, [strouhal, _]) in [75.0, 112.0].into_iter().zip(squares) {
            claim(
                rows,
                "square at a blockage of 1/8",
                reynolds,
                strouhal,
                "on the largest speed, as the paper cited",
            );
        }
    }
    Ok(())
}

/// A row of table 5.2.
fn claim(rows: &mut Rows, body: &str, reynolds: f64, strouhal: f64, note: &str) {
    let table = TABLE.iter().find(|(number, _)| *number == reynolds).map_or(f64::NAN, |(_, value)| *value);
    let metric = format!("{body}: Strouhal number at Re {reynolds}, table 5.2");
    let measure = Measure::relative(Tier::Thesis, metric, strouhal, table, 0.02);
    rows.add(measure.claim().note(note));
}
