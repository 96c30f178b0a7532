//! A fluid as a member of a simulation.

use crate::methods::contract::Claims;
use crate::methods::member::{Member, Notes};
use crate::methods::parts::Part;
use granular_core::{Dim, NodeKey, Simulation, Solver, Spin, Vector};
use granular_lbm::spec::LbmSpec;
use granular_lbm::{Lattice, Lbm, Real};

/// A change of the fluid at the start of a stage.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Action<D: Dim> {
    /// Gravity \[m/s^2\].
    Gravity(D::Vec),
    /// Velocity of a face by its name \[m/s\].
    FaceVelocity(String, Vec<f64>),
    /// Spin of an obstacle by its name \[1/s\], about x, y and z.
    ObstacleSpin(String, [f64; 3]),
}

/// What happens at the start of each stage, in their order.
pub(super) type Stages<D> = Vec<Vec<Action<D>>>;

/// Numbers whose last value belongs to the result, by how their names begin.
const METRICS: [&str; 6] = [
    "largest_speed",
    "mass_excess",
    "drag_coefficient_of_",
    "lift_coefficient_of_",
    "pressure_at_",
    "velocity_at_",
];

/// The fluid of a scene.
pub(super) struct Water<L: Lattice<Q>, T: Real, const Q: usize> {
    pub(super) name: String,
    pub(super) key: NodeKey<Lbm<L, Q, T>>,
    pub(super) stages: Stages<L::Dim>,
}

impl<L: Lattice<Q>, T: Real, const Q: usize> Member for Water<L, T, Q> {
    fn name(&self) -> &str {
        &self.name
    }

    fn solver<'a>(&self, simulation: &'a Simulation) -> &'a dyn Solver {
        simulation.get::<Lbm<L, Q, T>>(self.key)
    }

    fn offers(&self, part: Part) -> bool {
        LbmSpec::PARTS.contains(&part)
    }

    fn begin(&self, simulation: &mut Simulation, stage: usize) -> Notes {
        let lbm = simulation.get_mut(self.key);
        self.stages[stage].iter().for_each(|action| apply(lbm, action));
        Notes::default()
    }

    fn progress(&self, simulation: &Simulation) -> String {
        let speed = self.number(simulation, "largest_speed");
        speed.map_or(String::new(), |speed| format!("largest speed {speed:.3e} m/s"))
    }

    fn is_metric(&self, number: &str) -> bool {
        METRICS.iter().any(|begin| number.starts_with(begin))
    }
}

fn apply<L: Lattice<Q>, T: Real, const Q: usize>(lbm: &mut Lbm<L, Q, T>, action: &Action<L::Dim>) {
    match action {
        Action::Gravity(gravity) => {
            lbm.set_acceleration(*gravity).expect("numbers of a scene are finite");
        }
        Action::FaceVelocity(face, velocity) => {
            let velocity = Vector::from_slice(velocity).expect("the number of axes was checked at build");
            lbm.set_face_velocity(face, velocity).expect("the face was checked at build");
        }
        Action::ObstacleSpin(name, spin) => {
            let mut motion = lbm.obstacle_motion(name).expect("the name was checked at build");
            motion.spin = Spin::of_components(*spin);
            // A surface as fast as sound is refused by the Mach number, before the start.
            lbm.set_obstacle_motion(name, motion).expect("the speed was checked at build");
        }
    }
}
