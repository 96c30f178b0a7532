//! One point of Mohr-Coulomb along paths whose ends are known.

use crate::methods::mpm::names::said;
use crate::validate::{Effort, Measure, Rows, Tier};
use granular_constitutive::element::{ElementState, Path, run as lead};
use granular_constitutive::{LinearElastic, MohrCoulomb, Strength};
use granular_driver::failure::Failure;

/// Young's modulus \[Pa\], Poisson's ratio, angle of friction \[degrees\], pressure on the sides \[Pa\].
const YOUNG: f64 = 1.98e6;
const POISSON: f64 = 0.23;
const FRICTION: f64 = 23.2;
const PRESSURE: f64 = 100e3;

pub(super) fn run(rows: &mut Rows, _: Effort) -> Result<(), Failure> {
    let elastic = LinearElastic::new(YOUNG, POISSON).map_err(said)?;
    let sand = MohrCoulomb::new(elastic, Strength::of_friction(FRICTION.to_radians())).map_err(said)?;
    let last = |path: Path| -> Result<ElementState, Failure> {
        Ok(lead(&sand, &path.in_increments(400)).map_err(said)?.last().clone())
    };
    let sine = FRICTION.to_radians().sin();
    let k = (1.0 + sine) / (1.0 - sine);
    let mut exact = |metric: &str, value: f64, reference: f64, tolerance: f64| {
        rows.add(Measure::relative(Tier::ClosedForm, metric, value, reference, tolerance));
    };
    let triaxial = last(Path::triaxial_compression(PRESSURE, 0.1))?;
    let strength = (k - 1.0) * PRESSURE;
    exact("deviator stress at failure, triaxial [Pa]", triaxial.deviator_stress, strength, 1e-10);
    // Elastic until failure; without dilation the volume then stays.
    let elastic_volume = -strength * (1.0 - 2.0 * POISSON) / YOUNG;
    exact("volumetric strain at the end, triaxial", triaxial.volumetric_strain, elastic_volume, 1e-10);
    let biaxial = last(Path::biaxial_compression(PRESSURE, 0.1))?;
    let stresses = [biaxial.stress.xx, biaxial.stress.yy, biaxial.stress.zz];
    let largest = stresses.iter().fold(0.0_f64, |most, stress| most.max(-stress));
    exact("axial stress at failure, plane strain [Pa]", largest, k * PRESSURE, 1e-10);
    let confined = last(Path::oedometer(0.0, 0.01))?;
    let stresses = [confined.stress.xx, confined.stress.yy, confined.stress.zz];
    let (least, most) = stresses.iter().fold((f64::INFINITY, 0.0_f64), |(a, b), s| (a.min(-s), b.max(-s)));
    exact("lateral over axial stress, oedometer", least / most, 1.0 / k, 1e-8);
    let bulk = YOUNG / (3.0 * (1.0 - 2.0 * POISSON));
    exact("axial stress, oedometer [Pa]", most, 3.0 * bulk / (1.0 + 2.0 / k) * 0.01, 1e-8);
    Ok(())
}
