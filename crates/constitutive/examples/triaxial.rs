//! Dense and loose sand in triaxial compression: NorSand peaks and dilates, or contracts, and ends at the critical state.
//!
//! ```sh
//! cargo run --release -p granular-constitutive --example triaxial
//! ```

use granular_constitutive::element::{Path, run};
use granular_constitutive::{NorSand, NorSandConstants, NorSandState, PressureElastic};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let constants = NorSandConstants {
        critical_ratio: 1.25,
        critical_void_ratio: 0.82,
        critical_slope: 0.015,
        coupling: 0.3,
        dilation_limit: 3.5,
        hardening: 150.0,
    };
    let elastic = PressureElastic::new(30e6, 100e3, 0.2, 0.5, 1e6)?;
    let mut peaks = Vec::new();
    for void_ratio in [0.6, 0.8] {
        let image_pressure = NorSand::image_pressure(100e3, constants.coupling);
        let sand = NorSand::new(elastic, constants, NorSandState { void_ratio, image_pressure })?;
        let test = run(&sand, &Path::triaxial_compression(100e3, 0.2).in_increments(200))?;
        println!("void ratio {void_ratio}\naxial strain, q [kPa], volumetric strain");
        for state in test.states.iter().step_by(20) {
            let (axial, q) = (-state.strain.yy, state.deviator_stress / 1e3);
            println!("{axial:.3} {q:7.1} {:+.4}", state.volumetric_strain);
        }
        peaks.push(test.states.iter().map(|state| state.deviator_stress).fold(0.0, f64::max));
    }
    assert!(peaks[0] > 1.3 * peaks[1], "dense sand is stronger: {peaks:?}");
    Ok(())
}

#[test]
fn the_example_runs() -> Result<(), Box<dyn Error>> {
    main()
}
