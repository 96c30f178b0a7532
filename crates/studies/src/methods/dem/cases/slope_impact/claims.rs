//! What the thesis says of piles that are pushed.

use super::{Blow, Plan, Strength, Struck};
use crate::validate::reference::named;
use crate::validate::{Measure, Rows, Tier};
use granular_driver::statistics::{PowerLaw, mean_and_error};
use granular_validation_data::SLOPE_IMPACT;

/// Why numbers of small piles differ.
const SMALL: &str =
    "the thesis has 13 000 disks, and does not state restitution, stiffness or resistance to rolling";
/// Energy over the potential energy at which the thesis sees another regime: 40 of 26.5 m g d for each grain.
const CROSSOVER: f64 = 1.5;

/// One number of each push of the sweep over energies, against the energy over the potential energy.
struct Sweep<'a> {
    rows: &'a mut Rows,
    plan: &'a Plan,
    struck: &'a [Struck],
}

pub(super) fn add(rows: &mut Rows, plan: &Plan, slenderness: &[f64], struck: &[Struck]) {
    let mut sweep = Sweep { rows, plan, struck };
    sweep.lengths(slenderness);
    sweep.durations();
    sweep.decay();
    sweep.profile();
    sweep.friction();
}

fn is_usual(blow: &Blow) -> bool {
    blow.profile == "Gradient" && blow.base_friction == 0.4
}

fn energy_of(blow: &Blow) -> f64 {
    if let Strength::Energy(energy) = blow.strength { energy } else { f64::NAN }
}

impl Sweep<'_> {
    /// Pushes of the sweep over energies, with their energies.
    fn points(&self, of: impl Fn(&Struck) -> Option<f64>) -> Vec<(f64, f64)> {
        let usual = self.struck.iter().filter(|one| is_usual(&one.blow));
        usual.filter_map(|one| Some((energy_of(&one.blow), of(one)?))).filter(|p| p.0.is_finite()).collect()
    }

    fn claim(&mut self, metric: &str, value: f64, reference: &str, tolerance: f64, note: &str) {
        let metric = format!("{} disks: {metric}", self.plan.grains);
        let reference = named(SLOPE_IMPACT, reference, "value");
        let measure = Measure::absolute(Tier::Thesis, metric, value, reference, tolerance).claim();
        self.rows.add(measure.note(note).note(SMALL));
    }

    fn lengths(&mut self, slenderness: &[f64]) {
        let points = self.points(|one| Some(one.impact.length_ratio()));
        let [low, high] = split(&points);
        let piles: Vec<String> = slenderness.iter().map(|value| format!("{value:.2}")).collect();
        let note = format!(
            "L_f/L_0 over E_0/E_p0: {}; L_0/H of the piles {} (4.0 in the thesis)",
            listed(&points),
            piles.join(" ")
        );
        let note = format!("{}; {note}", of_fit(&low));
        self.claim(
            "exponent of L_f over E_0 below the crossover",
            low.exponent,
            "length exponent low",
            0.03,
            &note,
        );
        let metric = "exponent of L_f over E_0 above the crossover";
        self.claim(metric, high.exponent, "length exponent high", 0.05, &of_fit(&high));
        let meet = low.meets(&high).unwrap_or(f64::NAN);
        let note = "energy over potential energy where both laws meet; the thesis has 40 +- 15 m g d";
        self.claim("crossover of the run-out", meet, "crossover", CROSSOVER * 15.0 / 40.0, note);
    }

    fn durations(&mut self) {
        let points = self.points(|one| Some(one.impact.duration_over_fall()));
        let low: Vec<f64> = points.iter().filter(|p| p.0 < CROSSOVER).map(|p| p.1).collect();
        let (mean, _) = mean_and_error(&low);
        let (least, most) = low.iter().fold((f64::INFINITY, 0.0_f64), |(a, b), &t| (a.min(t), b.max(t)));
        let note = format!("units of sqrt(H/g): {}", listed(&points));
        self.claim("mean duration below the crossover", mean, "duration low", 0.67, &note);
        let note = "half of the difference between longest and shortest, over the mean";
        let spread = 0.5 * (most - least) / mean;
        self.claim("spread of durations below the crossover", spread, "duration spread", 0.1, note);
        let ends = self.points(|one| Some(one.impact.rise()?[1] / one.impact.fall()));
        let (mean, _) = mean_and_error(&ends.iter().map(|p| p.1).collect::<Vec<_>>());
        let note = format!("energy across at a tenth of its peak, units of sqrt(H/g): {}", listed(&ends));
        self.claim("end of the transient", mean, "transient", 0.17, &note);
    }

    fn decay(&mut self) {
        let above = |p: &(f64, f64)| p.0 > CROSSOVER;
        let of = |sweep: &Self, number: &dyn Fn(&Struck) -> Option<f64>| {
            let usual = sweep.struck.iter().filter(|one| is_usual(&one.blow));
            let left = |one: &Struck| Some((one.impact.energy_left()?, number(one)?, energy_of(&one.blow)));
            let all = usual.filter_map(left).filter(|(.., energy)| energy.is_finite());
            let all = all.filter(|&(_, value, energy)| above(&(energy, value)));
            all.map(|(left, value, _)| (left, value)).collect::<Vec<_>>()
        };
        let half_lives = of(self, &|one| one.impact.half_life());
        let left = of(self, &|one| Some(one.impact.duration_left()));
        let note = "over the energy along x that is left then, above the crossover";
        let [tau, duration] = [&half_lives, &left].map(|points| PowerLaw::through(points));
        let of = |law: &PowerLaw| format!("{}; {note}", of_fit(law));
        let metric = "exponent of the half-life after the transient";
        self.claim(metric, tau.exponent, "half-life exponent", 0.03, &of(&tau));
        let metric = "exponent of the duration after the transient";
        self.claim(metric, duration.exponent, "duration exponent", 0.02, &of(&duration));
        let ratios: Vec<f64> = left.iter().zip(&half_lives).map(|(t, tau)| t.1 / tau.1).collect();
        let (ratio, _) = mean_and_error(&ratios);
        self.claim("duration after the transient over half-life", ratio, "duration over half-life", 0.4, "");
    }

    /// Mean of a number over pushes with the least energy.
    fn mean_of_least(&self, keeps: impl Fn(&Blow) -> bool, of: impl Fn(&Struck) -> f64) -> Option<f64> {
        let least = self.plan.energies[0];
        let chosen = self.struck.iter().filter(|one| energy_of(&one.blow) == least && keeps(&one.blow));
        let values: Vec<f64> = chosen.map(of).collect();
        (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
    }

    fn profile(&mut self) {
        let of = |keeps: &dyn Fn(&Blow) -> bool| self.mean_of_least(keeps, run_out);
        let uniform = |blow: &Blow| blow.profile == "Uniform";
        let (Some(gradient), Some(uniform)) = (of(&is_usual), of(&uniform)) else { return };
        let note = format!(
            "at the lowest energy: {gradient:.3} over {uniform:.3}; the thesis has it from a continuum only"
        );
        let metric = "run-out of a gradient over that of a uniform push";
        self.claim(metric, gradient / uniform, "gradient over uniform", 0.13, &note);
    }

    /// Base friction, which the quick form leaves at one value.
    fn friction(&mut self) {
        let of = |friction: f64, number: fn(&Struck) -> f64| {
            let keeps = move |blow: &Blow| blow.profile == "Gradient" && blow.base_friction == friction;
            self.mean_of_least(keeps, number)
        };
        let lengths: Option<Vec<f64>> =
            [0.1, 0.2, 0.3, 0.4].iter().map(|&friction| of(friction, run_out)).collect();
        let times = of(0.1, duration).zip(of(0.2, duration));
        let (Some(lengths), Some((slippery, rough))) = (lengths, times) else { return };
        let list: Vec<String> = lengths.iter().map(|value| format!("{value:.3}")).collect();
        let note = format!(
            "at the lowest energy; for 0.1, 0.2, 0.3, 0.4: {}; the thesis has these from a continuum only",
            list.join(", ")
        );
        let metric = "run-out at base friction 0.1 over that at 0.2";
        self.claim(metric, lengths[0] / lengths[1], "run-out over friction", 0.41, &note);
        let note = "at the lowest energy; the thesis has it from a continuum only";
        let metric = "duration at base friction 0.1 over that at 0.2";
        self.claim(metric, slippery / rough, "duration over friction", 0.24, note);
    }
}

fn run_out(one: &Struck) -> f64 {
    one.impact.length_ratio() - 1.0
}

fn duration(one: &Struck) -> f64 {
    one.impact.duration_over_fall()
}

/// Power laws below and above the crossover.
fn split(points: &[(f64, f64)]) -> [PowerLaw; 2] {
    let (low, high): (Vec<_>, Vec<_>) = points.iter().partition(|point| point.0 < CROSSOVER);
    [low, high].map(|points| PowerLaw::through(&points))
}

/// The uncertainty of a fitted exponent, for notes.
fn of_fit(law: &PowerLaw) -> String {
    format!("standard error of the fit {:.3}", law.error)
}

fn listed(points: &[(f64, f64)]) -> String {
    points.iter().map(|(x, y)| format!("{x:.2}: {y:.2}")).collect::<Vec<_>>().join(", ")
}
