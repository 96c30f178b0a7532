//! Element tests: one point of a material led along a path of strains and stresses.
//!
//! ```
//! use granular_constitutive::element::{Path, run};
//! use granular_constitutive::{LinearElastic, MohrCoulomb, Strength};
//!
//! let elastic = LinearElastic::new(1.98e6, 0.23)?;
//! let sand = MohrCoulomb::new(elastic, Strength::of_friction(23.2_f64.to_radians()))?;
//! // Confined by 100 kPa and compressed by 10 %.
//! let test = run(&sand, &Path::triaxial_compression(100e3, 0.1))?;
//! let last = test.last();
//! let k = (1.0 + 23.2_f64.to_radians().sin()) / (1.0 - 23.2_f64.to_radians().sin());
//! assert!((last.deviator_stress / (100e3 * (k - 1.0)) - 1.0).abs() < 1e-10);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod path;
mod solve;
#[cfg(test)]
mod tests;

pub use path::{Control, Leg, Path};

use crate::axes::InSpace;
use crate::law::{ConstitutiveLaw, Increment, Kept, Response};
use crate::measures;
use granular_core::SymmetricTensor;
use solve::Unreached;
use std::fmt;

/// Names of components in the order in which a path prescribes them.
pub const COMPONENTS: [&str; 6] = ["xx", "yy", "zz", "xy", "yz", "xz"];

/// A tensor as its components in the order of [`COMPONENTS`].
fn components(tensor: SymmetricTensor) -> [f64; 6] {
    [tensor.xx, tensor.yy, tensor.zz, tensor.xy, tensor.yz, tensor.xz]
}

fn tensor([xx, yy, zz, xy, yz, xz]: [f64; 6]) -> SymmetricTensor {
    SymmetricTensor { xx, yy, zz, xy, yz, xz }
}

/// A point of the material at an instant of a test.
#[derive(Clone, Debug, PartialEq)]
pub struct ElementState {
    /// Time \[s\] since the start.
    pub time: f64,
    /// Strain \[-\] since the start, positive when the material lengthens. Increments add up, as logarithms do when directions stay.
    pub strain: SymmetricTensor,
    /// Stress \[Pa\], positive in tension.
    pub stress: SymmetricTensor,
    /// Volumetric strain \[-\], positive when the material dilates.
    pub volumetric_strain: f64,
    /// Mean pressure p \[Pa\].
    pub mean_pressure: f64,
    /// Deviator stress q \[Pa\].
    pub deviator_stress: f64,
    /// Mobilised friction, `sin(phi_m)`.
    pub mobilised_friction: f64,
    /// Work per volume \[J/m^3\] of the stress since the start, by the mean stress of each increment.
    pub work: f64,
    /// Energy per volume \[J/m^3\] that is stored.
    pub stored_energy: f64,
    /// Work per volume \[J/m^3\] lost to plastic strain.
    pub plastic_work: f64,
    /// Work per volume \[J/m^3\] lost to viscosity.
    pub viscous_work: f64,
    /// What the law remembers, as listed in [`ElementTest::kept`].
    pub memory: Vec<f64>,
}

/// The states that a material went through, from the start to the end of a path.
#[derive(Clone, Debug, PartialEq)]
pub struct ElementTest {
    /// One state before the first and one after each increment; never empty.
    pub states: Vec<ElementState>,
    /// Names and units of the numbers that the law remembers.
    pub kept: &'static [Kept],
}

impl ElementTest {
    /// The state at the end.
    pub fn last(&self) -> &ElementState {
        &self.states[self.states.len() - 1]
    }

    /// Names and units of the columns of a table.
    pub fn columns(&self) -> Vec<(String, &'static str)> {
        let mut columns = vec![("time".to_owned(), "s")];
        columns.extend(COMPONENTS.iter().map(|name| (format!("strain_{name}"), "1")));
        columns.extend(COMPONENTS.iter().map(|name| (format!("stress_{name}"), "Pa")));
        let measures = [
            ("volumetric_strain", "1"),
            ("mean_pressure", "Pa"),
            ("deviator_stress", "Pa"),
            ("mobilised_friction", "1"),
            ("work", "J/m^3"),
            ("stored_energy", "J/m^3"),
            ("plastic_work", "J/m^3"),
            ("viscous_work", "J/m^3"),
        ];
        columns.extend(measures.map(|(name, unit)| (name.to_owned(), unit)));
        columns.extend(self.kept.iter().map(|kept| (kept.name.to_owned(), kept.unit)));
        columns
    }

    /// The numbers of a state in the order of [`ElementTest::columns`].
    pub fn row(&self, state: &ElementState) -> Vec<f64> {
        let mut row = vec![state.time];
        row.extend(components(state.strain));
        row.extend(components(state.stress));
        row.extend([
            state.volumetric_strain,
            state.mean_pressure,
            state.deviator_stress,
            state.mobilised_friction,
            state.work,
            state.stored_energy,
            state.plastic_work,
            state.viscous_work,
        ]);
        row.extend(&state.memory);
        row
    }
}

/// Why a path cannot be followed.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ElementError {
    /// A stress that is prescribed is not reached, mostly since it is beyond the strength.
    Unreached {
        /// Number of the leg, from 0.
        leg: usize,
        /// Number of the increment in the leg, from 0.
        increment: usize,
        /// Component, such as `xx`.
        component: &'static str,
        /// Stress \[Pa\] that is prescribed.
        wanted: f64,
        /// Nearest stress \[Pa\] that was found.
        found: f64,
    },
    /// The stress is not finite.
    NotFinite {
        /// Number of the leg, from 0.
        leg: usize,
        /// Number of the increment in the leg, from 0.
        increment: usize,
    },
}

impl fmt::Display for ElementError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unreached { leg, increment, component, wanted, found } => write!(
                f,
                "stress {component} should be {wanted} Pa in leg {leg}, increment {increment}, but the material comes \
                 no nearer than {found} Pa; prescribe a stress within its strength, or a strain"
            ),
            Self::NotFinite { leg, increment } => write!(
                f,
                "the stress is not finite in leg {leg}, increment {increment}; start from a stress that the law can \
                 have, and strain less"
            ),
        }
    }
}

impl std::error::Error for ElementError {}

/// Leads a material along a path.
///
/// # Errors
/// When a stress that is prescribed cannot be reached, or the stress is not finite.
pub fn run<L: ConstitutiveLaw>(law: &L, path: &Path) -> Result<ElementTest, ElementError> {
    let mut point = Point::new(law, path.start);
    let mut states = vec![point.state()];
    for (number, leg) in path.legs.iter().enumerate() {
        let from = components(point.stress);
        for increment in 0..leg.increments {
            point.advance(leg, from, increment).map_err(|error| error.at(number, increment))?;
            states.push(point.state());
        }
    }
    Ok(ElementTest { states, kept: L::KEPT })
}

/// A point on its way.
struct Point<'a, L: ConstitutiveLaw> {
    law: &'a L,
    time: f64,
    strain: SymmetricTensor,
    stress: SymmetricTensor,
    memory: L::Memory,
    work: f64,
    lost: [f64; 2],
    /// The last increment of strain, from which the search for the next one starts.
    last: [f64; 6],
}

impl<'a, L: ConstitutiveLaw> Point<'a, L> {
    fn new(law: &'a L, stress: SymmetricTensor) -> Self {
        let (memory, strain) = (law.start(), SymmetricTensor::ZERO);
        Self { law, time: 0.0, strain, stress, memory, work: 0.0, lost: [0.0; 2], last: [0.0; 6] }
    }

    /// The answer to an increment, and the memory after it.
    fn respond(&self, strain: [f64; 6], dt: f64) -> (Response, L::Memory) {
        let strain = tensor(strain);
        let mut memory = self.memory;
        let volume_ratio = (self.strain.trace() + strain.trace()).exp();
        let response =
            self.law.respond::<InSpace>(self.stress, &mut memory, &Increment { strain, dt, volume_ratio });
        (response, memory)
    }

    fn advance(&mut self, leg: &Leg, from: [f64; 6], increment: usize) -> Result<(), Unreached> {
        let dt = leg.duration / leg.increments as f64;
        let targets = leg.targets(from, increment);
        let answer = |strain: [f64; 6]| components(self.respond(strain, dt).0.stress);
        let strain = solve::strain_for(answer, &leg.controls, &targets, self.last)?;
        let (response, memory) = self.respond(strain, dt);
        let added = tensor(strain);
        self.work += 0.5 * (self.stress + response.stress).contract(added);
        self.lost[0] += response.plastic_work;
        self.lost[1] += response.viscous_work;
        self.time += dt;
        self.strain += added;
        (self.stress, self.memory, self.last) = (response.stress, memory, strain);
        Ok(())
    }

    fn state(&self) -> ElementState {
        ElementState {
            time: self.time,
            strain: self.strain,
            stress: self.stress,
            volumetric_strain: self.strain.trace(),
            mean_pressure: measures::mean_pressure(self.stress),
            deviator_stress: measures::deviator_stress(self.stress),
            mobilised_friction: measures::mobilised_friction::<InSpace>(self.stress),
            work: self.work,
            stored_energy: self.law.stored_energy(self.stress, &self.memory),
            plastic_work: self.lost[0],
            viscous_work: self.lost[1],
            memory: self.memory.as_ref().to_vec(),
        }
    }
}
