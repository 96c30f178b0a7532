//! NorSand: sand that knows how dense it is.
//!
//! Symbols inside: pressure `p` and volumetric strain `v` positive in compression, deviator stress `q`, stress ratio `eta = q / p`,
//! image pressure `p_i`, void ratio `e`.

mod elastic;
mod root;
#[cfg(test)]
mod tests;

pub use elastic::PressureElastic;

use crate::axes::Axes;
use crate::gap;
use crate::law::{ConstitutiveLaw, Increment, Kept, Response};
use crate::measures;
use elastic::Strained;
use granular_core::{SetupError, SymmetricTensor};

/// Modified NorSand: critical state plasticity with the void ratio as a state \[Jefferies1993\], \[Robert2010\].
///
/// ```text
/// yield      q / p = (M / N) (1 - (1 - N) (p / p_i)^(N / (1 - N))),   M (1 + ln(p_i / p)) for N = 0
/// flow       D = d eps_v / d eps_q = (M - q / p) / (1 - N)
/// hardening  d p_i = H (p_i,max - p_i) d eps_q
/// p_i,max    = p (1 + N chi psi_i / M)^((N - 1) / N),                  p exp(-chi psi_i / M) for N = 0
/// state      psi_i = e - e_c(p_i),  e_c(p) = Gamma - lambda ln(p / 1 kPa)
/// ```
///
/// M depends on the Lode angle, from triaxial compression to extension \[JefferiesShuttle2011\]. Elasticity has an energy ([`PressureElastic`]),
/// so nothing is gained on closed paths. The void ratio follows from the volume since the start of the run. The image pressure that acts is at most
/// `p_i,max`, which bounds the stress ratio when sand is unloaded.
///
/// An increment is cut into steps of 2e-5 of strain and a rest, 200 at most; each ends on the yield surface, found between bounds, with
/// the dilation at its end. Not vectorised: a step costs some 3 microseconds, 300 times as
/// much as an update of Mohr-Coulomb.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NorSand {
    elastic: PressureElastic,
    constants: NorSandConstants,
    start: NorSandState,
}

/// Constants of a sand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NorSandConstants {
    /// Critical stress ratio M in triaxial compression, from 0 to 3.
    pub critical_ratio: f64,
    /// Critical void ratio Gamma at a pressure of 1 kPa.
    pub critical_void_ratio: f64,
    /// Slope lambda of the critical void ratio over the natural logarithm of pressure, 0 or more.
    pub critical_slope: f64,
    /// Coupling N of work, from 0 to less than 1; mostly 0.2 to 0.4.
    pub coupling: f64,
    /// Limit chi of dilation over the state, 0 or more; mostly 3.5.
    pub dilation_limit: f64,
    /// Plastic hardening H, above 0; mostly 50 to 500.
    pub hardening: f64,
}

/// State of a sand at the start of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NorSandState {
    /// Void ratio, above 0.
    pub void_ratio: f64,
    /// Image pressure \[Pa\], above 0; see [`NorSand::image_pressure`].
    pub image_pressure: f64,
}

fn within(what: &str, value: f64, right: bool, allowed: &'static str) -> Result<(), SetupError> {
    if right && value.is_finite() { Ok(()) } else { Err(SetupError::new(what, value, allowed)) }
}

impl NorSandConstants {
    fn check(&self) -> Result<(), SetupError> {
        let Self { critical_ratio: m, critical_void_ratio: gamma, critical_slope: lambda, .. } = *self;
        let Self { coupling: n, dilation_limit: chi, hardening: h, .. } = *self;
        within("critical stress ratio", m, m > 0.0 && m < 3.0, "above 0 and less than 3")?;
        within("critical void ratio", gamma, gamma > 0.0, "above 0, and finite")?;
        within("slope of the critical void ratio", lambda, lambda >= 0.0, "0 or more, and finite")?;
        within("coupling of work", n, (0.0..1.0).contains(&n), "0 or more, and less than 1")?;
        within("limit of dilation", chi, chi >= 0.0, "0 or more, and finite")?;
        within("hardening", h, h > 0.0, "above 0, and finite")
    }
}

impl NorSandState {
    fn check(&self) -> Result<(), SetupError> {
        within("void ratio", self.void_ratio, self.void_ratio > 0.0, "above 0, and finite")?;
        within("image pressure", self.image_pressure, self.image_pressure > 0.0, "above 0 Pa, and finite")
    }
}

/// Pressure \[Pa\] for which the critical void ratio is given.
const REFERENCE: f64 = 1e3;
/// Strain of a step, and most steps of an increment.
const STEP: f64 = 2e-5;
const MOST_STEPS: f64 = 200.0;
/// Bound of the state parameter in exponents.
const WIDEST_STATE: f64 = 0.5;

impl NorSand {
    /// By elasticity, constants and the state at the start.
    ///
    /// # Errors
    /// When a number is out of its range.
    pub fn new(
        elastic: PressureElastic,
        constants: NorSandConstants,
        start: NorSandState,
    ) -> Result<Self, SetupError> {
        constants.check()?;
        start.check()?;
        Ok(Self { elastic, constants, start })
    }

    /// The image pressure \[Pa\] of sand that was pressed from all sides by at most a pressure \[Pa\]; the yield surface then ends there.
    pub fn image_pressure(greatest_pressure: f64, coupling: f64) -> f64 {
        let exponent = (1.0 - coupling) / coupling;
        let share = if coupling > 0.0 { (1.0 - coupling).powf(exponent) } else { (-1.0_f64).exp() };
        greatest_pressure * share
    }

    /// The elastic law below the yield surface.
    pub const fn elastic(&self) -> &PressureElastic {
        &self.elastic
    }

    /// Void ratio at a volume over that at the start of the run.
    pub fn void_ratio(&self, volume_ratio: f64) -> f64 {
        (1.0 + self.start.void_ratio) * volume_ratio - 1.0
    }

    /// Critical void ratio at a pressure \[Pa\].
    pub fn critical_void_ratio(&self, pressure: f64) -> f64 {
        self.constants.critical_void_ratio - self.constants.critical_slope * (pressure / REFERENCE).ln()
    }

    /// Critical stress ratio of the Lode angle of a stress.
    pub fn critical_ratio<A: Axes>(&self, stress: SymmetricTensor) -> f64 {
        let m = self.constants.critical_ratio;
        let angle = 1.5 * measures::lode_angle::<A>(stress) + std::f64::consts::FRAC_PI_4;
        m - m * m / (3.0 + m) * angle.cos()
    }
}

/// The yield surface of one step: its direction of shear and its density stay.
struct Surface<'a> {
    law: &'a NorSand,
    /// Critical stress ratio M of the direction of shear.
    m: f64,
    void_ratio: f64,
}

impl Surface<'_> {
    /// The largest image pressure at a pressure, for the state at an image pressure.
    fn hardest(&self, p: f64, image: f64) -> f64 {
        let NorSandConstants { coupling: n, dilation_limit: chi, .. } = self.law.constants;
        let state = self.void_ratio - self.law.critical_void_ratio(image);
        let dilation = chi * state.clamp(-WIDEST_STATE, WIDEST_STATE) / self.m;
        if n > 0.0 { p * (1.0 + n * dilation).max(1e-2).powf((n - 1.0) / n) } else { p * (-dilation).exp() }
    }

    /// Stress ratio of the surface at a pressure; negative beyond its tip.
    fn ratio(&self, p: f64, image: f64) -> f64 {
        let n = self.law.constants.coupling;
        let acting = image.min(self.hardest(p, image));
        if n > 0.0 {
            self.m / n * (1.0 - (1.0 - n) * (p / acting).powf(n / (1.0 - n)))
        } else {
            self.m * (1.0 + (acting / p).ln())
        }
    }

    /// `D` on the surface at a pressure.
    fn dilation(&self, p: f64, image: f64) -> f64 {
        (self.m - self.ratio(p, image)) / (1.0 - self.law.constants.coupling)
    }

    /// Image pressure after plastic shear, towards the hardest there.
    fn hardened(&self, p: f64, image: f64, shear: f64) -> f64 {
        let hardest = self.hardest(p, image);
        let left = (-self.law.constants.hardening * shear).exp();
        (hardest + (image - hardest) * left).max(1e-6 * REFERENCE)
    }

    /// How far \[Pa\] a stress is beyond the surface.
    fn excess(&self, p: f64, q: f64, image: f64) -> f64 {
        if p > 0.0 { q - p * self.ratio(p, image) } else { q }
    }
}

/// A point of the path of an increment.
#[derive(Clone, Copy)]
struct Point {
    strained: Strained,
    image: f64,
}

impl Surface<'_> {
    /// The point after plastic shear from a trial, with a given dilation.
    fn sheared(&self, trial: Point, shear: f64, dilation: f64) -> Point {
        let strained = Strained {
            volumetric: (trial.strained.volumetric - dilation * shear).max(0.0),
            shear: (trial.strained.shear - shear).max(0.0),
        };
        let (p, _) = self.law.elastic.invariants(strained);
        let image = if p > 0.0 { self.hardened(p, trial.image, shear) } else { trial.image };
        Point { strained, image }
    }

    fn excess_at(&self, point: Point) -> f64 {
        let (p, q) = self.law.elastic.invariants(point.strained);
        self.excess(p, q, point.image)
    }

    /// The plastic shear that leads to the surface with a given dilation: between bounds, so that it is always found.
    fn shear_to(&self, trial: Point, dilation: f64) -> f64 {
        let excess = |shear: f64| self.excess_at(self.sheared(trial, shear, dilation));
        let (mut low, mut at_low) = (0.0, excess(0.0));
        let mut high = trial.strained.shear.max(1e-3 * STEP);
        let mut at_high = excess(high);
        // Beyond the tip only contraction leads back.
        for _ in 0..60 {
            if at_high <= 0.0 {
                break;
            }
            (low, at_low) = (high, at_high);
            high *= 2.0;
            at_high = excess(high);
        }
        let (p, q) = self.law.elastic.invariants(trial.strained);
        root::between((low, at_low), (high, at_high), 1e-14 * (p + q), excess)
    }

    /// The point on the surface to which a trial returns, with the dilation there.
    fn returned(&self, trial: Point) -> (Point, f64) {
        let (p, _) = self.law.elastic.invariants(trial.strained);
        let mut dilation = self.dilation(p, trial.image);
        let mut shear = 0.0;
        let mut point = trial;
        for _ in 0..3 {
            shear = self.shear_to(trial, dilation);
            point = self.sheared(trial, shear, dilation);
            let (p, _) = self.law.elastic.invariants(point.strained);
            if p <= 0.0 {
                break;
            }
            dilation = self.dilation(p, point.image);
        }
        (point, shear)
    }
}

const GAP: usize = 0;
const PLASTIC: usize = 1;
const IMAGE: usize = 2;

impl NorSand {
    /// One step: elastic strain and memory after it, and the work that is lost.
    fn step<A: Axes>(
        &self,
        elastic_strain: SymmetricTensor,
        memory: &mut [f64; 3],
        void_ratio: f64,
    ) -> (SymmetricTensor, f64) {
        let strained = Strained::of(elastic_strain);
        if strained.volumetric <= 0.0 || strained.volumetric.is_nan() {
            memory[GAP] = -strained.volumetric;
            // The product keeps what is not finite.
            return (elastic_strain * 0.0, 0.0);
        }
        // Strain has the Lode angle of the stress: one is a multiple of the other.
        let surface = Surface { law: self, m: self.critical_ratio::<A>(elastic_strain), void_ratio };
        let trial = Point { strained, image: memory[IMAGE] };
        let excess = surface.excess_at(trial);
        if excess <= 0.0 || excess.is_nan() {
            return (elastic_strain, 0.0);
        }
        let (point, shear) = surface.returned(trial);
        let (p, q) = self.elastic.invariants(point.strained);
        let lost_shear = strained.shear - point.strained.shear;
        let lost_volume = strained.volumetric - point.strained.volumetric;
        let keep = if strained.shear > 0.0 { point.strained.shear / strained.shear } else { 1.0 };
        memory[IMAGE] = point.image;
        memory[PLASTIC] += shear.min(strained.shear) * 3.0_f64.sqrt();
        let after =
            elastic_strain.deviator() * keep + SymmetricTensor::IDENTITY * (-point.strained.volumetric / 3.0);
        (after, p * lost_volume + q * lost_shear)
    }
}

impl ConstitutiveLaw for NorSand {
    type Memory = [f64; 3];

    /// The gap, the plastic shear strain, that of simple shear, and the image pressure.
    const KEPT: &'static [Kept] = &[
        Kept { name: "gap_strain", unit: "1" },
        Kept { name: "plastic_strain", unit: "1" },
        Kept { name: "image_pressure", unit: "Pa" },
    ];

    fn start(&self) -> [f64; 3] {
        [0.0, 0.0, self.start.image_pressure]
    }

    fn respond<A: Axes>(
        &self,
        stress: SymmetricTensor,
        memory: &mut [f64; 3],
        increment: &Increment,
    ) -> Response {
        let strain = increment.strain;
        let mut elastic_strain = self.elastic.strain_of(stress);
        // Steps of one length and a rest: so the stress is a continuous function of the strain. What is not finite comes out so after
        // however many steps.
        let length = (strain.contract(strain).sqrt() / STEP).clamp(f64::MIN_POSITIVE, MOST_STEPS);
        let steps = if length.is_nan() { 1 } else { length.ceil() as u32 };
        let mut plastic_work = 0.0;
        for step in 1..=steps {
            let done = if step == steps { 1.0 } else { f64::from(step) / length };
            let share = done - f64::from(step - 1) / length;
            let (acts, gap) = gap::close(memory[GAP], strain * share);
            memory[GAP] = gap;
            let to_come = strain.trace() * (1.0 - done);
            let void_ratio = self.void_ratio(increment.volume_ratio / (1.0 + to_come));
            elastic_strain += acts;
            if gap > 0.0 {
                continue;
            }
            let (after, lost) = self.step::<A>(elastic_strain, memory, void_ratio);
            elastic_strain = after;
            plastic_work += lost;
        }
        Response { stress: self.elastic.stress_of(elastic_strain), plastic_work, viscous_work: 0.0 }
    }

    fn stored_energy(&self, stress: SymmetricTensor, _memory: &[f64; 3]) -> f64 {
        self.elastic.energy_at(stress)
    }

    fn wave_speed(&self, density: f64) -> f64 {
        self.elastic.greatest_wave_speed(density)
    }
}
