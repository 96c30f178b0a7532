//! What is known of a flow beforehand: how long sound lasts, and which operator suits.

use crate::collision::Operator;
use crate::setup::{Face, Setup};
use crate::solver::borne;
use granular_core::Dim;

/// Where sound that goes to and fro between faces counts as gone: share of its amplitude.
const GONE: f64 = 0.01;
/// Operators to turn to, the better at walls first.
const CHOICES: [Operator; 3] = [Operator::DEFAULT, Operator::Regularised, Operator::KUMAR];

/// Sound that goes to and fro along an axis, in the longest wave that fits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sloshing {
    /// 0 for x, 1 for y, 2 for z.
    pub axis: usize,
    /// Period \[s\].
    pub period: f64,
    /// Share of the amplitude that both faces together throw back.
    pub returned: f64,
    /// Until a hundredth of the amplitude is left \[s\]; obstacles, which damp it more, left aside.
    pub lasts: f64,
}

impl<D: Dim> Setup<D> {
    /// How long sound goes to and fro along each axis that has an open face, after a sudden start or a change.
    ///
    /// Faces with a velocity, a pressure or a wall throw all of it back; an absorbing one the share that is said at
    /// [`Face::absorbing`]. Between them viscosity damps it, and so does friction in thin layers at walls along the way, by
    /// `sqrt(w nu / 2) / H` per time in a channel of height `H`.
    pub fn sloshing(&self) -> Vec<Sloshing> {
        let is_open = |axis: &usize| self.faces[*axis].iter().any(Face::is_open);
        (0..D::N).filter(is_open).map(|axis| self.sloshing_along(axis)).collect()
    }

    fn sloshing_along(&self, axis: usize) -> Sloshing {
        let (length, sound) = (self.cells[axis] as f64 * self.spacing, self.lattice_speed() / 3.0_f64.sqrt());
        let holds_pressure = |face: &Face<D>| face.pressure().is_some();
        let [low, high] = &self.faces[axis];
        // A quarter of a wave between ends of two kinds, a half between ends of one.
        let waves = if holds_pressure(low) == holds_pressure(high) { 0.5 } else { 0.25 };
        let wave_number = std::f64::consts::TAU * waves / length;
        let frequency = sound * wave_number;
        let mut returned = 1.0;
        let mut settling = f64::INFINITY;
        for face in [low, high] {
            if let Face::Absorbing { relaxation, .. } = face {
                let held = relaxation * sound / length;
                returned /= (1.0 + (frequency / held).powi(2)).sqrt();
                settling = settling.min(2.0 * held);
            }
        }
        let walls = |across: usize| {
            let count = self.faces[across].iter().filter(|face| face.is_wall()).count();
            count as f64 / (self.cells[across] as f64 * self.spacing)
        };
        let walls: f64 = (0..D::N).filter(|across| *across != axis).map(walls).sum();
        // Share of the section that layers of friction take, to second order.
        let layers = 0.5 * walls * (2.0 * self.viscosity / frequency).sqrt();
        let rubbed = 0.5 * frequency * layers * (1.0 + layers);
        let damped = self.sound_diffusivity() * wave_number * wave_number + rubbed;
        // What absorbs cannot be faster than the level of pressure settles.
        let rate = damped + (-returned.ln() * sound / (2.0 * length)).min(settling);
        let period = std::f64::consts::TAU / frequency;
        Sloshing { axis, period, returned, lasts: -GONE.ln() / rate }
    }

    /// Half of the sum of longitudinal and bulk viscosity \[m^2/s\], by which sound decays.
    fn sound_diffusivity(&self) -> f64 {
        let rate = match self.operator {
            Operator::SingleRelaxation | Operator::TwoRelaxation { .. } => 1.0 / self.tau(),
            Operator::MultipleRelaxation { ghosts, .. } => ghosts[0],
            Operator::Regularised => 1.0,
        };
        let axes = D::N as f64;
        let bulk = 2.0 / (3.0 * axes) * (1.0 / rate - 0.5) * self.spacing * self.spacing / self.time_step;
        0.5 * (2.0 * (axes - 1.0) / axes * self.viscosity + bulk)
    }

    /// What is worth knowing before the first step, at a largest speed \[m/s\].
    pub(crate) fn advice(&self, speed: f64) -> Vec<String> {
        let mut advice: Vec<String> =
            self.sloshing().into_iter().map(|sloshing| self.of_sound(sloshing)).collect();
        advice.push(self.of_operator(speed));
        advice
    }

    fn of_sound(&self, sloshing: Sloshing) -> String {
        let Sloshing { axis, period, returned, lasts } = sloshing;
        let name = ["x", "y", "z"][axis];
        let mut text = format!(
            "sound along {name}: {:.0} % comes back from the faces with a period of {period:.3} s; after a sudden start a \
             hundredth is left after about {lasts:.3} s, and forces before that may look like shedding",
            100.0 * returned
        );
        let mut absorbing = self.clone();
        for face in &mut absorbing.faces[axis] {
            if let Face::Pressure(pressure, _) | Face::PressureAlong(pressure, ..) = face {
                *face = Face::absorbing(*pressure);
            }
        }
        let shorter = absorbing.sloshing_along(axis).lasts;
        if shorter < 0.9 * lasts {
            text += &format!("; Absorbing in place of Outflow makes that {shorter:.3} s");
        }
        text
    }

    /// Which operator suits, and why.
    fn of_operator(&self, speed: f64) -> String {
        let reynolds = speed * self.spacing / self.viscosity;
        let bears = |operator: Operator| borne(self, operator)[0];
        let is_borne = |operator: &Operator| reynolds <= bears(*operator);
        let name = named(self.operator);
        if !is_borne(&self.operator) {
            let told = format!(
                "operator {name} is stable up to a grid Reynolds number of {:.0} here, and this flow has {reynolds:.1}",
                bears(self.operator)
            );
            let Some(better) = CHOICES.into_iter().find(is_borne) else {
                return format!(
                    "{told}: take smaller cells, or Regularised with a closure, such as smagorinsky: 0.1"
                );
            };
            return format!(
                "{told}; {} is stable up to {:.0}{}",
                named(better),
                bears(better),
                self.at_walls(better)
            );
        }
        let has_walls =
            !self.obstacles.is_empty() || self.faces.iter().take(D::N).flatten().any(|face| face.is_wall());
        if !has_walls {
            let free = Operator::KUMAR;
            return match self.operator {
                Operator::KUMAR | Operator::SingleRelaxation => {
                    format!(
                        "operator {name} suits: there are no walls, and it is among the most accurate in free flow"
                    )
                }
                _ if is_borne(&free) => format!(
                    "operator {name} is stable here, but there are no walls: {} is more accurate in free flow and more stable in a stream",
                    named(free)
                ),
                _ => format!("operator {name} suits: {} is not stable in this scene", named(free)),
            };
        }
        let best = Operator::DEFAULT;
        if self.operator == best {
            return format!(
                "operator {name} suits: flat walls along the lattice lie exactly half-way (no operator does that for others), and \
                 it is stable up to a grid Reynolds number of {:.0} here",
                bears(best)
            );
        }
        if is_borne(&best) {
            let at_walls = self.at_walls(self.operator);
            return format!(
                "operator {name} is stable here{at_walls}; {} is exact at flat walls and stable up to a grid Reynolds number \
                 of {:.0} instead of {:.0}",
                named(best),
                bears(best),
                bears(self.operator)
            );
        }
        format!(
            "operator {name} suits: {} is not stable in this scene{}",
            named(best),
            self.at_walls(self.operator)
        )
    }

    /// How flat walls lie with an operator, in the narrowest channel between faces.
    fn at_walls(&self, operator: Operator) -> String {
        let magic = operator.magic(self.tau());
        let between = |axis: &usize| self.faces[*axis].iter().all(|face| face.is_wall());
        let narrowest = (0..D::N).filter(between).map(|axis| self.cells[axis]).min();
        // Pores are narrower than the box.
        let cells = if self.obstacles.is_empty() { narrowest.unwrap_or(8) } else { 8 };
        let slip = 100.0 * (16.0 * magic - 3.0) / (3.0 * (cells * cells) as f64);
        if slip.abs() < 1e-9 {
            return "; flat walls along the lattice stay exact".to_owned();
        }
        format!("; in a gap of {cells} cells it slips at flat walls by {slip:.2} % of the largest speed")
    }
}

/// An operator in the words of a scene.
fn named(operator: Operator) -> String {
    match operator {
        Operator::SingleRelaxation => "SingleRelaxation".to_owned(),
        Operator::TwoRelaxation { magic } => format!("TwoRelaxation({magic})"),
        Operator::EXACT_WALLS => "ExactWalls".to_owned(),
        Operator::KUMAR => "Kumar".to_owned(),
        Operator::MultipleRelaxation { .. } => "MultipleRelaxation".to_owned(),
        Operator::Regularised => "Regularised".to_owned(),
    }
}
