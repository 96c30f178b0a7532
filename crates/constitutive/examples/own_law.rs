//! A law of your own, a Maxwell solid, and an element test of it.
//!
//! ```sh
//! cargo run --release -p granular-constitutive --example own_law
//! ```

use granular_constitutive::element::{Path, run};
use granular_constitutive::granular_core::SymmetricTensor;
use granular_constitutive::{Axes, ConstitutiveLaw, Increment, Kept, LinearElastic, Response};
use std::error::Error;

/// Linear elasticity whose shear stress relaxes with time, after Maxwell: a solid in fast loads, a fluid in slow ones.
#[derive(Clone, Copy, Debug)]
struct Maxwell {
    elastic: LinearElastic,
    relaxation_time: f64,
}

impl ConstitutiveLaw for Maxwell {
    /// The shear strain by which it has flowed.
    type Memory = [f64; 1];

    const KEPT: &'static [Kept] = &[Kept { name: "creep_strain", unit: "1" }];

    fn start(&self) -> [f64; 1] {
        [0.0]
    }

    // What loops over particles is inlined, and chooses between values without a branch.
    #[inline(always)]
    fn respond<A: Axes>(
        &self,
        stress: SymmetricTensor,
        memory: &mut [f64; 1],
        increment: &Increment,
    ) -> Response {
        let trial = stress + self.elastic.stress_of(increment.strain);
        // Implicit in time, so stable for any step.
        let share = increment.dt / (self.relaxation_time + increment.dt);
        let lost = trial.deviator() * share;
        let stress = trial - lost;
        let creep = lost * (0.5 / self.elastic.shear());
        memory[0] += (2.0 * creep.contract(creep)).sqrt();
        Response { stress, viscous_work: stress.contract(creep), ..Response::default() }
    }

    fn stored_energy(&self, stress: SymmetricTensor, _: &[f64; 1]) -> f64 {
        self.elastic.energy_at(stress)
    }

    fn wave_speed(&self, density: f64) -> f64 {
        self.elastic.compression_speed(density)
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let law = Maxwell { elastic: LinearElastic::new(1e6, 0.3)?, relaxation_time: 0.5 };
    // Sheared by 1 in 10 s: long enough that the stress is that of a fluid, shear modulus times relaxation time times rate.
    let test = run(&law, &Path::simple_shear_of_constant_volume(0.0, 1.0).over(10.0))?;
    let last = test.last();
    let viscosity = law.elastic.shear() * law.relaxation_time;
    println!("shear stress {:.1} Pa, creep {:.4}", last.stress.xy, last.memory[0]);
    assert!((last.stress.xy / (viscosity * 0.1) - 1.0).abs() < 1e-6);
    let balance = last.work - last.stored_energy - last.viscous_work;
    assert!(balance.abs() < 1e-2 * last.work, "{balance} of {}", last.work);
    Ok(())
}

#[test]
fn the_example_runs() -> Result<(), Box<dyn Error>> {
    main()
}
