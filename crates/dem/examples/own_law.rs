//! A contact law of one's own: a linear spring with an attraction that reaches beyond contact. A sphere that is lighter than
//! the pull-off force hangs from a ceiling; a heavier one falls.
//!
//! ```sh
//! cargo run --release -p granular-dem --example own_law
//! ```

use granular_dem::granular_core::{D3, Dim, Solver, glam::DVec3};
use granular_dem::{
    ContactLaw, ContactLoad, Dem, Grain, Kinematics, LawLimits, Material, Materials, Options, Setup, Tally,
    Wall,
};
use std::error::Error;

const GRAVITY: f64 = 9.81;
const RADIUS: f64 = 1e-3;
/// Stiffness \[N/m\], pull-off force \[N\] and range \[m\] of the attraction.
const STICKY: Sticky = Sticky { stiffness: 1e4, pull_off: 1e-4, range: 1e-5 };

/// `F = k overlap - F_0 (1 - gap / range)`: what holds two surfaces that just touch is the pull-off force `F_0`.
#[derive(Clone, Copy, Debug)]
struct Sticky {
    stiffness: f64,
    pull_off: f64,
    range: f64,
}

impl Sticky {
    /// Attraction \[N\] over the gap, which is negative in contact.
    #[inline(always)]
    fn pull(&self, gap: f64) -> f64 {
        self.pull_off * (1.0 - gap.max(0.0) / self.range).max(0.0)
    }
}

// One source for disks and spheres.
impl<D: Dim> ContactLaw<D> for Sticky {
    /// Nothing to remember between steps.
    type Memory = ();
    const TANGENTIAL: bool = false;
    const REACHES: bool = true;
    const NAME: &'static str = "linear with an attraction";

    fn reach(&self) -> f64 {
        self.range
    }

    fn limits(&self, _: f64) -> Option<LawLimits> {
        Some(LawLimits { normal_stiffness: self.stiffness, ..LawLimits::default() })
    }

    #[inline(always)]
    fn load<const LEDGER: bool>(
        &self,
        m: &Kinematics<D>,
        (): &mut (),
        _: &mut Tally<LEDGER>,
    ) -> ContactLoad<D> {
        ContactLoad::along_normal(self.stiffness * m.overlap - self.pull(m.gap))
    }

    fn reversed((): ()) {}

    fn at_rest(&self, m: &Kinematics<D>, (): ()) -> (ContactLoad<D>, f64) {
        let (overlap, share) = ((-m.gap).max(0.0), self.pull(m.gap) / self.pull_off);
        let attraction = -0.5 * self.pull_off * self.range * share * share - self.pull_off * overlap;
        let force = self.stiffness * overlap - self.pull(m.gap);
        (ContactLoad::along_normal(force), 0.5 * self.stiffness * overlap * overlap + attraction)
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    for share in [0.9, 1.1] {
        let weight = share * STICKY.pull_off;
        let gap = gap_after(0.02, weight)?;
        let said = if gap < STICKY.range { "hangs" } else { "falls" };
        println!("a sphere of {share} times the pull-off force {said}: {gap:.2e} m below the ceiling");
        assert_eq!(said, if share < 1.0 { "hangs" } else { "falls" });
    }
    Ok(())
}

/// Distance \[m\] from a ceiling after some seconds, of a sphere of this weight \[N\] that just touches it at first.
fn gap_after(seconds: f64, weight: f64) -> Result<f64, Box<dyn Error>> {
    let volume = 4.0 / 3.0 * std::f64::consts::PI * RADIUS.powi(3);
    let mut materials = Materials::new();
    let density = weight / GRAVITY / volume;
    let glass = materials.add(Material { density, ..Material::default() })?;
    let setup = Setup::<D3> {
        materials,
        grains: vec![Grain::at(DVec3::new(0.0, -RADIUS, 0.0), RADIUS, glass)],
        walls: vec![Wall::plane("ceiling", DVec3::ZERO, DVec3::NEG_Y, glass)?],
        gravity: DVec3::NEG_Y * GRAVITY,
        options: Options::default(),
    };
    let mut dem = Dem::with_law(setup, STICKY)?;
    let steps = (seconds / dem.recommended_step()).ceil();
    dem.advance(seconds / steps, steps as u64)?;
    Ok(-dem.grain(0).position.y - RADIUS)
}

#[test]
fn the_example_runs() -> Result<(), Box<dyn Error>> {
    main()
}
