//! Grains that a fluid moves.

use crate::methods::contract::Building;
use crate::problems::Problems;
use crate::scene::Scene;
use crate::scene::coupling::{CouplingSpec, HeldLoadSpec};
use granular_core::NodeKey;
use granular_coupling::{HeldLoad, ResolvedGrains, ResolvedOptions};
use granular_dem::Dem;
use granular_lbm::{Lattice, Lbm, Real};

/// Couples grains to the fluid of a name, for all laws of the scene that say so.
pub(crate) fn couple<L: Lattice<Q>, T: Real, const Q: usize>(
    scene: &Scene,
    name: &str,
    water: NodeKey<Lbm<L, Q, T>>,
    simulation: &mut Building,
    problems: &mut Problems,
) -> Option<()> {
    for (k, law) in scene.couplings.iter().enumerate() {
        let CouplingSpec::Resolved { grains, fluid, radius, held } = law else { continue };
        if fluid != name {
            continue;
        }
        let place = format!("couplings.{k}");
        if !(*radius > 0.0 && *radius <= 1.0) {
            problems.add(format!("{place}.radius"), radius, "above 0 and at most 1", "");
            return None;
        }
        if scene.cell.is_some() {
            let hint = "let walls bound the grains, and leave `cell` out";
            problems.add(place, "Resolved", "a scene without a cell of the grains", hint);
            return None;
        }
        // It was built before, or there are problems already.
        let key = simulation.find::<Dem<L::Dim>>(grains)?;
        let held = match held {
            HeldLoadSpec::OneStep => HeldLoad::OneStep,
            HeldLoadSpec::TwoSteps => HeldLoad::TwoSteps,
        };
        let options = ResolvedOptions { radius_factor: *radius, held, ..ResolvedOptions::default() };
        let coupled = simulation.simulation().couple(water, key, ResolvedGrains::<L::Dim>::new(options));
        let refused = |error: granular_core::CouplingError| {
            problems.add(place, error.to_string(), "grains that fit the fluid", "");
        };
        coupled.map_err(refused).ok()?;
    }
    Some(())
}

#[cfg(test)]
mod tests {
    use crate::check;
    use crate::model::Model;
    use crate::scene_file::SceneText;
    use granular_core::{FieldRef, FieldSink};
    use granular_dem::Dem2;
    use granular_lbm::Lbm2;
    use granular_tessellate::FREE_SURFACE;

    const SCENE: &str = r#"Scene(version: 1, dimension: Plane, gravity: [0.0, -9.81],
        materials: { "glass": (density: 2650, normal_stiffness: "1e5 N/m", restitution: 0.5, friction: 0.4) },
        sample: Grains([(position: ["5 mm", "8 mm"], radius: "1 mm", material: "glass")]),
        fluid: (
            size: ["10 mm", "12 mm"], viscosity: "1e-5 m^2/s", largest_speed: "0.2 m/s",
            faces: (left: Wall, right: Wall, bottom: Wall, top: Wall),
        ),
        stages: [(name: "sink", end: For("20 ms"))],
        solvers: { "grains": Dem(()), "water": Lbm((spacing: "0.2 mm")) },
        couplings: [Resolved(grains: "grains", fluid: "water", radius: 0.9)])"#;

    /// A grain of this density in the water, and its step.
    fn started(density: &str) -> (Model, f64) {
        let text = SceneText::new("scene.ron", SCENE.replace("density: 2650", density));
        let (_, mut model) = check::read(&text).unwrap();
        let water = model.simulation.find::<Lbm2>("water").unwrap();
        let dt = model.simulation.get(water).setup().time_step;
        model.simulation.begin_segment(dt).unwrap();
        (model, dt)
    }

    /// Forces at grains.
    struct Forces(Vec<f64>);

    impl FieldSink for Forces {
        fn wants(&self, name: &str) -> bool {
            name == "fluid_force"
        }

        fn number(&mut self, _: &str, _: &str, _: f64) {}

        fn field(&mut self, name: &str, unit: &str, field: FieldRef<'_>) {
            assert_eq!((name, unit), ("fluid_force", "N"));
            let FieldRef::Vector2(forces) = field else { panic!("{field:?}") };
            self.0.extend(forces.iter().map(|force| force.y));
        }
    }

    #[test]
    fn the_force_of_the_fluid_is_shown_at_grains() {
        let (mut model, _) = started("density: 1000");
        let member = model.member(Some("grains")).clone();
        assert!(member.shown(&model.simulation).iter().any(|shown| shown.name == "fluid_force"));
        model.simulation.advance(3).unwrap();
        let mut forces = Forces(Vec::new());
        member.show(&model.simulation, FREE_SURFACE, &mut forces);
        // The weight of a disk as dense as the fluid.
        let weight = 1000.0 * std::f64::consts::PI * 1e-6 * 9.81;
        assert!((forces.0[0] / weight - 1.0).abs() < 1e-9, "{:?} of {weight}", forces.0);
    }

    /// How far the grain has come after 20 ms, over the height of a free fall.
    fn share_of_free_fall(density: &str) -> f64 {
        let (mut model, dt) = started(density);
        let steps = (0.02 / dt).round();
        model.simulation.advance(steps as u64).unwrap();
        let grains = model.simulation.find::<Dem2>("grains").unwrap();
        let fallen = 8e-3 - model.simulation.get(grains).grain(0).position.y;
        fallen / (0.5 * 9.81 * (steps * dt).powi(2))
    }

    /// Buoyancy and the mass of the water that it takes along alone would leave (2.65 - 1)/(2.65 + 1).
    #[test]
    fn a_fluid_carries_and_brakes_a_grain() {
        let heavy = share_of_free_fall("density: 2650");
        assert!(heavy > 0.1 && heavy < 1.65 / 3.65, "{heavy}");
        let light = share_of_free_fall("density: 900");
        assert!(light < 0.0, "it rises: {light}");
        let same = share_of_free_fall("density: 1000");
        assert!(same.abs() < 1e-9, "it stays where it is: {same}");
    }

    #[test]
    fn what_does_not_fit_is_told_at_its_place() {
        let cases = [
            ("radius: 0.9", "radius: 1.2", ["`couplings.0.radius` is 1.2", "above 0 and at most 1"]),
            (r#"grains: "grains""#, r#"grains: "grain""#, ["`couplings.0.grains` is `grain`", "`grains`"]),
            (r#""0.2 mm""#, r#""1 mm""#, ["hydrodynamic radius of grain 0", "couplings.0"]),
            ("gravity:", "cell: (periodic: [true, false]), gravity:", ["couplings.0", "`cell`"]),
        ];
        for (from, to, parts) in cases {
            assert!(SCENE.contains(from));
            let text = SceneText::new("scene.ron", SCENE.replace(from, to));
            let said = check::read(&text).map(|_| ()).unwrap_err().to_string();
            for part in parts {
                assert!(said.contains(part), "`{part}` is not in:\n{said}");
            }
        }
    }
}
