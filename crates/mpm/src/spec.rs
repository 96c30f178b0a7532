//! What a scene says of this method (feature `serde`).

use crate::setup::{ObjectiveRate, Options, Scheme, ShapeFunctions, VelocityUpdate};
use granular_core::units::{Frequency, Length, Time, Velocity};
use schemars::JsonSchema;
use serde::Deserialize;

/// The material point method; only the cell must be given: `Mpm((cell: "2 mm"))`.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MpmSpec {
    /// Edge of a cell of the grid. A node lies at the origin; walls act at nodes, so those that lie through nodes are where they
    /// are said to be.
    pub cell: Length,
    /// Particles in a full cell: a square number in the plane, a cube in space.
    #[serde(default = "sixteen")]
    pub particles_per_cell: usize,
    /// How a particle is spread over nodes.
    #[serde(default)]
    pub shape: ShapeSpec,
    /// When in a step stresses follow strains.
    #[serde(default)]
    pub scheme: SchemeSpec,
    /// How particles take their velocities from the nodes.
    #[serde(default)]
    pub velocity_update: VelocityUpdateSpec,
    /// How stress turns with the material.
    #[serde(default)]
    pub objective_rate: ObjectiveRateSpec,
    /// What walls do; by default all are rough with the friction of their material.
    #[serde(default)]
    pub walls: std::collections::BTreeMap<String, ConditionSpec>,
    /// Bodies that may part and slide along one another: contacts between all bodies of two continua, or among those of one. Bodies that are in
    /// no contact stick where they meet.
    #[serde(default)]
    pub contacts: Vec<BodyContactSpec>,
    /// Horizontal over vertical stress at the start, where the weight above makes the vertical one; without it there is no
    /// stress at the start.
    #[serde(default)]
    pub earth_pressure_at_rest: Option<f64>,
    /// Share of the stable step that is taken, above 0 and at most 1.
    #[serde(default = "half")]
    pub courant: f64,
    /// The step; by default it follows from `courant`.
    #[serde(default)]
    pub time_step: Option<Time>,
}

fn sixteen() -> usize {
    16
}

fn half() -> f64 {
    Options::default().courant
}

/// How a particle is spread over the nodes of its cell and of those around.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
pub enum ShapeSpec {
    /// Hat functions of a point: the standard material point method, the least work, and noise when particles cross cells.
    Linear,
    /// Hat functions averaged over a block as large as the particle (GIMP).
    #[default]
    UniformGimp,
    /// Quadratic B-splines.
    QuadraticBspline,
}

/// When in a step stresses follow strains.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
pub enum SchemeSpec {
    /// After the motion; takes energy out of waves that are poorly resolved, and needs short steps.
    StressLast,
    /// Before forces are taken; keeps energy, and may gain some.
    StressFirst,
    /// After the motion, with velocities that particles handed back to the nodes.
    #[default]
    ModifiedStressLast,
}

/// How particles take their velocities.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
pub enum VelocityUpdateSpec {
    /// The change of velocity of the nodes; `pic_rate` is the rate at which motion that the nodes do not see is given up, 0 for
    /// none.
    Flip {
        /// Rate of the damping.
        pic_rate: Frequency,
    },
    /// The velocity of the nodes and its moment, both given back (affine particle in cell): quiet, and angular momentum is kept. Not for the
    /// shape `Linear`.
    Apic,
}

impl Default for VelocityUpdateSpec {
    fn default() -> Self {
        Self::Flip { pic_rate: 0.0.into() }
    }
}

/// How stress turns with the material.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
pub enum ObjectiveRateSpec {
    /// By an exact rotation (Hughes and Winget).
    #[default]
    HughesWinget,
    /// To first order in the step (Jaumann), as in the thesis.
    Jaumann,
}

/// What a wall does to the material at it.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
pub enum ConditionSpec {
    /// The material moves with the wall.
    Fixed,
    /// The material keeps to the wall and slides along it freely: a roller, or a plane of symmetry.
    Slip,
    /// Waves leave through the wall, as if the material went on behind it; for waves about a state without stress.
    Absorbing {
        /// Speed of compression waves of the material.
        compression_speed: Velocity,
        /// Speed of its shear waves.
        shear_speed: Velocity,
    },
    /// Coulomb friction; what moves away from the wall is free.
    Frictional {
        /// Coefficient of friction of what slides.
        friction: f64,
        /// Coefficient of friction of what sticks; that of what slides by default.
        #[serde(default)]
        static_friction: Option<f64>,
    },
}

/// A contact between bodies: `(between: ("sand", "block"), friction: 0.4)`.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BodyContactSpec {
    /// Names of the two continua, which may be the same.
    pub between: (String, String),
    /// Coefficient of friction; 0 for none.
    pub friction: f64,
}

impl MpmSpec {
    /// The choices of the method; `ledger` when an output asks for losses of energy.
    pub fn options(&self, ledger: bool) -> Options {
        let velocity_update = match self.velocity_update {
            VelocityUpdateSpec::Flip { pic_rate } => VelocityUpdate::Flip { pic_rate: pic_rate.value() },
            VelocityUpdateSpec::Apic => VelocityUpdate::Apic,
        };
        Options {
            shape: match self.shape {
                ShapeSpec::Linear => ShapeFunctions::Linear,
                ShapeSpec::UniformGimp => ShapeFunctions::UniformGimp,
                ShapeSpec::QuadraticBspline => ShapeFunctions::QuadraticBspline,
            },
            scheme: match self.scheme {
                SchemeSpec::StressLast => Scheme::StressLast,
                SchemeSpec::StressFirst => Scheme::StressFirst,
                SchemeSpec::ModifiedStressLast => Scheme::ModifiedStressLast,
            },
            velocity_update,
            objective_rate: match self.objective_rate {
                ObjectiveRateSpec::HughesWinget => ObjectiveRate::HughesWinget,
                ObjectiveRateSpec::Jaumann => ObjectiveRate::Jaumann,
            },
            courant: self.courant,
            ledger,
            ..Options::default()
        }
    }

    /// Particles along the edge of a full cell in this many dimensions; none when their number is no power.
    pub fn particles_along_edge(&self, dimensions: usize) -> Option<usize> {
        let edge = (self.particles_per_cell as f64).powf(1.0 / dimensions as f64).round() as usize;
        (edge > 0 && edge.pow(dimensions as u32) == self.particles_per_cell).then_some(edge)
    }
}
