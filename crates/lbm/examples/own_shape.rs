//! An obstacle of a shape of your own: an ellipse in water that is driven past it through a periodic square.
//!
//! ```sh
//! cargo run --release -p granular-lbm --example own_shape
//! ```

use granular_lbm::granular_core::{D2, Solver, glam::DVec2};
use granular_lbm::{Lbm2, Obstacle, Setup, SolidShape};
use std::error::Error;

const CELLS: usize = 40;
const SPACING: f64 = 1e-3;
const DRIVE: f64 = 1e-7;

/// A shape says what lies inside and gives a box around it; where the surface cuts between two cells is then
/// found by bisection. An own [`SolidShape::crossing`] would be faster.
struct Ellipse {
    centre: DVec2,
    half_axes: DVec2,
}

impl SolidShape<D2> for Ellipse {
    fn contains(&self, point: DVec2) -> bool {
        ((point - self.centre) / self.half_axes).length_squared() <= 1.0
    }

    fn bounds(&self) -> (DVec2, DVec2) {
        (self.centre - self.half_axes, self.centre + self.half_axes)
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let along = flow_past(DVec2::new(8e-3, 4e-3))?;
    let across = flow_past(DVec2::new(4e-3, 8e-3))?;
    println!("mean speed, long axis along the flow: {along:.4e} m/s, across it: {across:.4e} m/s");
    assert!(along > across, "a slender body lets more water pass");
    Ok(())
}

/// Mean speed \[m/s\] of the water once the flow is steady.
fn flow_past(half_axes: DVec2) -> Result<f64, Box<dyn Error>> {
    let edge = CELLS as f64 * SPACING;
    let mut setup = Setup::new([CELLS, CELLS, 1], SPACING, 1e-6, 1.0);
    setup.acceleration = DVec2::new(DRIVE, 0.0);
    setup.obstacles.push(Obstacle::new("ellipse", Ellipse { centre: DVec2::splat(0.5 * edge), half_axes }));
    let (dt, density) = (setup.time_step, setup.density);
    let mut water = Lbm2::new(setup)?;
    water.advance(dt, 6000)?;

    // In a steady flow the drag takes all that the drive brings into the water.
    let fluid = (CELLS * CELLS - water.cells_in(0)) as f64;
    let drive = density * DRIVE * fluid * SPACING * SPACING;
    let drag = water.force_on(0).x;
    println!("drag {drag:.5e} N/m, drive {drive:.5e} N/m");
    assert!((drag / drive - 1.0).abs() < 1e-3);

    let cells = (0..CELLS).flat_map(|y| (0..CELLS).map(move |x| [x, y, 0]));
    let flux: f64 = cells.filter_map(|cell| water.flow(cell)).map(|flow| flow.velocity.x).sum();
    Ok(flux / fluid)
}

#[test]
fn the_example_runs() -> Result<(), Box<dyn Error>> {
    main()
}
