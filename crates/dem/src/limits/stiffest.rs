//! The stiffest contact of two materials, and the step that it bears.

use crate::dem::Dem;
use crate::law::LawLimits;
use crate::material::PairProperties;
use crate::setup::ContactModel;
use granular_core::{Dim, Linear};
use std::f64::consts::PI;

/// Overlap over effective radius up to which a Hertz contact must be stable at least, whatever
/// the speeds.
const LEAST_OVERLAP: f64 = 1e-4;

/// The stiffest contact that a scene allows between two materials.
pub(super) struct Stiffest {
    pub(super) oscillator: Oscillator,
    /// Stiffness along the normal \[N/m\].
    pub(super) stiffness: f64,
    /// Shortest contact time \[s\].
    pub(super) contact_time: f64,
    /// Shorter Rayleigh time of two spheres in Hertz contact \[s\]; else infinite.
    pub(super) rayleigh_time: f64,
    /// Speed of the hardest impact \[m/s\], and its overlap \[m\].
    pub(super) speed: f64,
    pub(super) deepest: f64,
    /// Whether it is one with a wall.
    pub(super) on_wall: bool,
    pub(super) names: String,
    /// What was assumed.
    pub(super) assumed: String,
}

/// Two grains on springs.
#[derive(Clone, Copy, Debug)]
pub(super) struct Oscillator {
    /// Stiffness over effective mass \[1/s^2\].
    normal: f64,
    tangential: f64,
    /// Damping over effective mass \[1/s\].
    normal_damping: f64,
    tangential_damping: f64,
}

/// Two grains that may meet: materials, radii and masses of the lightest, or infinite for a wall.
#[derive(Clone, Copy)]
struct Couple {
    properties: PairProperties,
    /// Damping ratio; found once, since that takes longer than all the rest.
    zeta: f64,
    effective_mass: f64,
    effective_radius: f64,
    /// Of the lighter grain \[kg\].
    mass: f64,
    on_wall: bool,
}

impl Oscillator {
    pub(super) fn linear(pair: &PairProperties, effective_mass: f64, zeta: f64) -> Self {
        let normal = pair.normal_stiffness / effective_mass;
        let of_restitution = || 2.0 * zeta * normal.sqrt();
        let normal_damping = pair.normal_damping.map_or_else(of_restitution, |given| given / effective_mass);
        Self {
            normal,
            tangential: pair.tangential_stiffness / effective_mass,
            normal_damping,
            tangential_damping: pair
                .tangential_damping
                .map_or(pair.damping_ratio * normal_damping, |given| given / effective_mass),
        }
    }

    /// The Hertz contact about an overlap \[m\]: slope of the force `2 E* a`, damping `2
    /// sqrt(5/6) zeta sqrt(slope m)`, tangential stiffness `8 G* a`.
    fn hertz(couple: &Couple, overlap: f64) -> Self {
        let area = (couple.effective_radius * overlap).sqrt();
        let normal = 2.0 * couple.properties.effective_modulus * area / couple.effective_mass;
        let normal_damping = 2.0 * (5.0_f64 / 6.0).sqrt() * couple.zeta * normal.sqrt();
        Self {
            normal,
            tangential: 8.0 * couple.properties.effective_shear_modulus * area / couple.effective_mass,
            normal_damping,
            tangential_damping: couple.properties.damping_ratio * normal_damping,
        }
    }

    /// Largest stable step \[s\]: see [`stability_step`](crate::stability_step).
    /// `turns` holds the largest ratio of `mass radius^2` to the moment of inertia, if grains turn.
    pub(super) fn largest_step(&self, neighbours: usize, turns: Option<f64>) -> f64 {
        let gain = 1.0 + turns.unwrap_or(0.0);
        let share = neighbours as f64;
        let limit = |stiffness: f64, damping: f64| {
            let (w2, c) = (stiffness * share, damping * share);
            // w2 dt^2 + 4 c dt = 4 with c = 2 zeta w.
            2.0 * ((c * c + w2).sqrt() - c) / w2
        };
        let along = limit(self.normal, self.normal_damping);
        if turns.is_none() || self.tangential <= 0.0 {
            return along;
        }
        along.min(limit(gain * self.tangential, gain * self.tangential_damping))
    }
}

impl<D: Dim> Dem<D> {
    /// For every pair of materials that can touch, the lightest grains. `with_times` works out contact times and Rayleigh
    /// times, which takes far longer than the rest; else they are infinite.
    pub(super) fn stiffest_pairs(&self, with_times: bool) -> Vec<Stiffest> {
        let count = self.materials.len();
        let mut lightest = vec![(f64::INFINITY, f64::INFINITY); count];
        for index in 0..self.len() {
            let place = &mut lightest[self.grains.material_of(index)];
            if self.grains.mass[index] < place.0 {
                *place = (self.grains.mass[index], self.grains.radius[index]);
            }
        }
        for inlet in self.inlets.inlets() {
            let density = self.materials.get(inlet.material).density;
            let place = &mut lightest[inlet.material.0 as usize];
            for &radius in &inlet.radii {
                let mass = density * D::ball_volume(radius);
                if mass < place.0 {
                    *place = (mass, radius);
                }
            }
        }
        let walls: Vec<usize> = self.walls.iter().map(|wall| wall.material.0 as usize).collect();
        let (present_speed, fall) = self.fastest_speeds();
        let stack = self.extent_along_gravity();
        let is_hertz = self.options.contact == ContactModel::Hertz;
        let present = if is_hertz { self.deepest_overlap() } else { 0.0 };
        let mut pairs = Vec::new();
        let mut add = |couple: Couple, (a, b): (usize, usize), names: &str, smaller: f64| {
            let of_materials = match self.options.contact {
                ContactModel::Linear => self.linear(&couple, present_speed.max(fall), names, with_times),
                ContactModel::Hertz => {
                    // Two grains may meet head-on.
                    let closing = if couple.on_wall { present_speed } else { 2.0 * present_speed };
                    self.hertz(&couple, closing.max(fall), (stack, present * smaller), names, with_times)
                }
            };
            pairs.push(match self.pairs.limits(a, b, couple.effective_mass) {
                Some(limits) => of_materials.of_law(&limits, couple.effective_mass),
                None => of_materials,
            });
        };
        for (a, b, properties) in self.materials.pairs() {
            let ((m, r), (n, s)) = (lightest[a], lightest[b]);
            let zeta = properties.zeta(self.options.tension);
            if m.is_finite() && n.is_finite() {
                let couple = Couple {
                    properties,
                    zeta,
                    effective_mass: m * n / (m + n),
                    effective_radius: r * s / (r + s),
                    mass: m.min(n),
                    on_wall: false,
                };
                add(couple, (a, b), "grain on grain", r.min(s));
            }
            let at_wall = |wall: usize, grain: (f64, f64)| {
                if walls.contains(&wall) { grain } else { lightest_of_none() }
            };
            let (first, second) = (at_wall(b, (m, r)), at_wall(a, (n, s)));
            let (mass, radius) = if first.0 <= second.0 { first } else { second };
            if mass.is_finite() {
                let couple = Couple {
                    properties,
                    zeta,
                    effective_mass: mass,
                    effective_radius: radius,
                    mass,
                    on_wall: true,
                };
                add(couple, (a, b), "grain on wall", radius);
            }
        }
        pairs
    }

    fn linear(&self, couple: &Couple, speed: f64, names: &str, with_times: bool) -> Stiffest {
        let (properties, tension) = (&couple.properties, self.options.tension);
        let contact_time = || properties.contact_time(couple.effective_mass, tension);
        Stiffest {
            oscillator: Oscillator::linear(properties, couple.effective_mass, couple.zeta),
            stiffness: properties.normal_stiffness,
            contact_time: if with_times { contact_time() } else { f64::INFINITY },
            rayleigh_time: f64::INFINITY,
            speed,
            deepest: speed * (couple.effective_mass / properties.normal_stiffness).sqrt(),
            on_wall: couple.on_wall,
            names: names.to_owned(),
            assumed: "lightest grains".to_owned(),
        }
    }

    /// A Hertz contact is stiffest where it is deepest: at the hardest impact, or under the weight
    /// of a stack of grains as high as the sample, or as it is now. `reach` holds the height of
    /// the sample and the present overlap \[m\].
    fn hertz(
        &self,
        couple: &Couple,
        speed: f64,
        reach: (f64, f64),
        names: &str,
        with_times: bool,
    ) -> Stiffest {
        let (properties, tension) = (&couple.properties, self.options.tension);
        let radius = couple.effective_radius;
        let impact = properties.hertz_impact(radius, couple.effective_mass, speed);
        let deepest = impact.largest_overlap();
        let grains = 1.0 + reach.0 / self.smallest_radius();
        let weight = couple.mass * self.gravity.length() * grains;
        let pressed = (0.75 * weight / (properties.effective_modulus * radius.sqrt())).powf(2.0 / 3.0);
        let resting = pressed.max(reach.1).max(LEAST_OVERLAP * radius);
        let half_period = PI / Oscillator::hertz(couple, resting).normal.sqrt();
        let contact_time = || impact.duration(couple.zeta, tension).min(half_period);
        let overlap = deepest.max(resting);
        Stiffest {
            oscillator: Oscillator::hertz(couple, overlap),
            stiffness: Oscillator::hertz(couple, overlap).normal * couple.effective_mass,
            contact_time: if with_times { contact_time() } else { f64::INFINITY },
            rayleigh_time: if D::TWISTS && with_times { self.rayleigh_time() } else { f64::INFINITY },
            speed,
            deepest,
            on_wall: couple.on_wall,
            names: names.to_owned(),
            assumed: format!("lightest grains, impact at {speed:.3} m/s, overlap up to {overlap:.2e} m"),
        }
    }

    /// Shortest Rayleigh time of a grain \[s\].
    fn rayleigh_time(&self) -> f64 {
        let time = |index: usize| {
            let material = self.materials.get(crate::MaterialId(self.grains.material_of(index) as u8));
            let elasticity = material.elasticity?;
            Some(elasticity.rayleigh_time(self.grains.radius[index], material.density))
        };
        let of_inlets = self.inlets.inlets().flat_map(|inlet| {
            let material = self.materials.get(inlet.material);
            let times =
                move |&radius: &f64| Some(material.elasticity?.rayleigh_time(radius, material.density));
            inlet.radii.iter().filter_map(times)
        });
        (0..self.len()).filter_map(time).chain(of_inlets).fold(f64::INFINITY, f64::min)
    }
}

impl Stiffest {
    /// The same with what a law of the caller's own says of itself.
    fn of_law(self, limits: &LawLimits, effective_mass: f64) -> Self {
        let per_mass = |value: f64| value / effective_mass;
        let normal = per_mass(limits.normal_stiffness);
        Self {
            oscillator: Oscillator {
                normal,
                tangential: per_mass(limits.tangential_stiffness),
                normal_damping: per_mass(limits.normal_damping),
                tangential_damping: per_mass(limits.tangential_damping),
            },
            stiffness: limits.normal_stiffness,
            contact_time: PI / normal.sqrt(),
            rayleigh_time: f64::INFINITY,
            deepest: self.speed / normal.sqrt(),
            ..self
        }
    }
}

/// Mass and radius where there is no grain.
fn lightest_of_none() -> (f64, f64) {
    (f64::INFINITY, f64::INFINITY)
}
