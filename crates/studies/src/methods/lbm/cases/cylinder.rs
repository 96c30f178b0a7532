//! The cylinder of Schäfer and Turek: a channel 2.2 m long and 0.41 m high with a cylinder of 0.1 m at (0.2, 0.2) m,
//! kinematic viscosity 1e-3 m^2/s, a parabola entering.

use super::{FITS, advance};
use crate::validate::Effort;
use crate::validate::reference::named;
use crate::validate::{Measure, Rows, Tier};
use granular_core::D2;
use granular_core::glam::DVec2;
use granular_driver::failure::Failure;
use granular_driver::parallel;
use granular_lbm::{Ball, D2Q9, Face, Lbm, Lbm2, Obstacle, OpenScheme, Operator, Profile, Real, Setup};
use granular_validation_data::CYLINDER;

const HEIGHT: f64 = 0.41;
const DIAMETER: f64 = 0.1;
/// Largest speed that enters in the periodic case \[m/s\].
const SHEDDING: f64 = 1.5;

pub(crate) fn run(rows: &mut Rows, effort: Effort) -> Result<(), Failure> {
    let sizes: &[usize] = if effort == Effort::Full { &[40, 20] } else { &[10] };
    let found = parallel::each(sizes, |&cells| steady(cells))?;
    for (&cells, [drag, lift, fall]) in sizes.iter().zip(found) {
        for (name, value, tolerance) in [
            ("drag coefficient", drag, 0.01),
            ("lift coefficient", lift, 0.05),
            ("pressure difference", fall, 0.01),
        ] {
            let reference = named(CYLINDER, &format!("2D-1 {name}"), "value");
            let metric = format!("2D-1, {cells} cells across: {name}");
            let measure = Measure::relative(Tier::OtherCode, metric, value, reference, tolerance);
            // Lift is a small difference of large forces: the finest cells decide.
            let decides = cells == sizes[0] && (effort == Effort::Full || name == "drag coefficient");
            rows.add(if decides { measure } else { measure.claim().note("coarse") });
        }
    }
    if effort == Effort::Full {
        shedding(rows, 40)?;
    }
    Ok(())
}

/// The channel and how it is resolved.
pub(crate) struct Channel {
    pub(crate) operator: Operator,
    /// Cells across the cylinder.
    pub(crate) cells: usize,
    /// Cells per step at the largest speed that enters.
    pub(crate) lattice: f64,
}

/// What the periodic case is judged by.
pub(crate) const SHED: [&str; 3] =
    ["largest drag coefficient", "lift coefficient, peak to peak", "Strouhal number"];

impl Channel {
    fn exact_walls(cells: usize, lattice: f64) -> Self {
        Self { operator: Operator::EXACT_WALLS, cells, lattice }
    }

    /// Step of the periodic case \[s\].
    pub(crate) fn dt(&self) -> f64 {
        self.lattice * DIAMETER / (self.cells as f64 * SHEDDING)
    }

    /// The channel with a largest speed \[m/s\].
    fn build<T: Real>(&self, speed: f64) -> Lbm<D2Q9, 9, T> {
        let Self { operator, cells, lattice } = *self;
        let h = DIAMETER / cells as f64;
        let (nx, ny) = ((2.2 / h).round() as usize + 1, (HEIGHT / h).round() as usize);
        let mut setup = Setup::<D2>::new([nx, ny, 1], h, 1e-3, 0.6);
        setup.operator = operator;
        setup.time_step = lattice * h / speed;
        setup.density = 1.0;
        // Velocity and pressure are given at the centres of the first and last cells.
        setup.origin = DVec2::new(-0.5 * h, 0.0);
        let parabola = move |point: DVec2| {
            DVec2::new(4.0 * speed * point.y * (HEIGHT - point.y) / (HEIGHT * HEIGHT), 0.0)
        };
        setup.faces[0] = [
            Face::Velocity(Profile::new(parabola), OpenScheme::ZouHe),
            Face::Pressure(0.0, OpenScheme::Regularised),
        ];
        setup.faces[1] = [Face::REST, Face::REST];
        setup
            .obstacles
            .push(Obstacle::new("cylinder", Ball { centre: DVec2::new(0.2, 0.2), radius: 0.5 * DIAMETER }));
        let mut lbm = Lbm::new(setup).expect(FITS);
        lbm.set_flow(|point| granular_lbm::Flow { pressure: 0.0, velocity: parabola(point) });
        lbm
    }

    /// Largest drag coefficient, lift coefficient from peak to peak, and Strouhal number at Reynolds number 100.
    pub(crate) fn shed<T: Real>(&self) -> Result<[f64; 3], Failure> {
        let mut lbm = self.build::<T>(SHEDDING);
        let dt = lbm.setup().time_step;
        // The cylinder stands off the middle, which starts the shedding.
        advance(&mut lbm, (8.0 / dt) as u64)?;
        let mut series = Vec::new();
        for _ in 0..(2.0 / dt) as u64 {
            advance(&mut lbm, 1)?;
            series.push(coefficients(&lbm, 1.0));
        }
        // The mean of two steps is free of the staggered momentum of the start.
        let smooth: Vec<[f64; 2]> =
            series.windows(2).map(|two| std::array::from_fn(|i| 0.5 * (two[0][i] + two[1][i]))).collect();
        let highest = |i: usize| smooth.iter().map(|value| value[i]).fold(f64::NEG_INFINITY, f64::max);
        let lowest = |i: usize| smooth.iter().map(|value| value[i]).fold(f64::INFINITY, f64::min);
        Ok([highest(0), highest(1) - lowest(1), DIAMETER / period(&smooth, dt)])
    }
}

/// References of [`SHED`].
pub(crate) fn shed_references() -> [f64; 3] {
    SHED.map(|name| named(CYLINDER, &format!("2D-2 {}", name.replace(',', "")), "value"))
}

/// Drag and lift coefficients and pressure difference \[Pa\] at Reynolds number 20. The mean of two steps is free of
/// the staggered momentum that a sudden start leaves.
fn steady(cells: usize) -> Result<[f64; 3], Failure> {
    let mut lbm: Lbm2 = Channel::exact_walls(cells, 0.02).build(0.3);
    let dt = lbm.setup().time_step;
    advance(&mut lbm, (15.0 / dt) as u64)?;
    let mut sum = [0.0; 3];
    for _ in 0..2 {
        let [drag, lift] = coefficients(&lbm, 0.2);
        for (sum, value) in sum.iter_mut().zip([drag, lift, front_and_back(&lbm)]) {
            *sum += 0.5 * value;
        }
        advance(&mut lbm, 1)?;
    }
    Ok(sum)
}

/// Drag and lift coefficients on a mean velocity \[m/s\].
fn coefficients<T: Real>(lbm: &Lbm<D2Q9, 9, T>, mean: f64) -> [f64; 2] {
    let force = lbm.force_on(0);
    let scale = 2.0 / (lbm.setup().density * mean * mean * DIAMETER);
    [force.x * scale, force.y * scale]
}

/// Pressure at the front of the cylinder less that at its back \[Pa\], each extrapolated from three cells.
fn front_and_back(lbm: &Lbm2) -> f64 {
    let h = lbm.setup().spacing;
    let at = |x: f64, way: f64| {
        let value = |k: f64| pressure_at(lbm, DVec2::new(x + way * k * h, 0.2));
        // The parabola through points 1, 2 and 3 cells away.
        3.0 * value(1.0) - 3.0 * value(2.0) + value(3.0)
    };
    at(0.15, -1.0) - at(0.25, 1.0)
}

/// Pressure at a point between cell centres \[Pa\].
fn pressure_at(lbm: &Lbm2, point: DVec2) -> f64 {
    let setup = lbm.setup();
    let place = (point - setup.origin) / setup.spacing - DVec2::splat(0.5);
    let (low, share) = (place.floor(), place - place.floor());
    let of = |x: usize, y: usize| {
        let cell = [low.x as usize + x, low.y as usize + y, 0];
        lbm.flow(cell).map_or(f64::NAN, |flow| flow.pressure)
    };
    (of(0, 0) * (1.0 - share.x) + of(1, 0) * share.x) * (1.0 - share.y)
        + (of(0, 1) * (1.0 - share.x) + of(1, 1) * share.x) * share.y
}

/// The periodic case: Reynolds number 100.
fn shedding(rows: &mut Rows, cells: usize) -> Result<(), Failure> {
    let found = Channel::exact_walls(cells, 0.03).shed::<f64>()?;
    for ((name, value), reference) in SHED.into_iter().zip(found).zip(shed_references()) {
        let metric = format!("2D-2, {cells} cells across: {name}");
        rows.add(Measure::relative(Tier::OtherCode, metric, value, reference, 0.01));
    }
    Ok(())
}

/// Mean time between upward crossings of the mean lift \[s\].
fn period(series: &[[f64; 2]], dt: f64) -> f64 {
    let mean = series.iter().map(|value| value[1]).sum::<f64>() / series.len() as f64;
    let crossings: Vec<f64> = series
        .windows(2)
        .enumerate()
        .filter(|(_, two)| two[0][1] < mean && two[1][1] >= mean)
        .map(|(k, two)| k as f64 + (mean - two[0][1]) / (two[1][1] - two[0][1]))
        .collect();
    match crossings.as_slice() {
        [first, .., last] => (last - first) / (crossings.len() - 1) as f64 * dt,
        _ => f64::NAN,
    }
}
